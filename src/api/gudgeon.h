/* The C interface of gudgeon: the dynamics of a slider-crank mechanism with clearance in its joints. The manual's page "C" has an
 * example.
 *
 * Statuses: 0 done; -1 paused, more to come; 2 call out of turn, a wrong index or time, or no handle (NULL); 3 wrong case;
 * 4 the integration cannot go on; 5 a result could not be written. Every handle keeps the message of its last error
 * (gudgeon_message; that of NULL is "no handle"). Without a handle what is not a status is 0, NULL or empty (events: -1).
 *
 * Texts are UTF-8. They are copied into `text` of `size` bytes with a final 0, cut where they do not fit; the value is the whole
 * length. Times are in seconds, all other values in SI units. Indices begin at 0. A handle belongs to one thread at a time; there
 * may be any number of them. Nothing prints, installs a handler or stops the host. */
#ifndef GUDGEON_H
#define GUDGEON_H
#include <stddef.h>
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif

typedef struct gudgeon_case gudgeon_case;
typedef struct gudgeon_run gudgeon_run;

/* A case from the text of a case file. Its name stands in messages. Tables that it names are read in `folder` and below, nowhere
 * else; "": it may name none; "/": any. What is wrong is told by gudgeon_case_check. */
gudgeon_case *gudgeon_case_new(const char *text, size_t length, const char *name, const char *folder);
gudgeon_case *gudgeon_case_copy(const gudgeon_case *);
void gudgeon_case_free(gudgeon_case *);

/* "joint.clearance", "15e-6"; "crank_pin.joint.clearance", "15e-6". No value (NULL): the default again. A group alone is added, or
 * removed by the value "none". After an error the case is unchanged. */
int gudgeon_case_set(gudgeon_case *, const char *key, const char *value);
/* The same for a number, without a text: key is the index of gudgeon_key. Sets of the same few keys cost least. */
int gudgeon_case_set_number(gudgeon_case *, int key, int element, double value);
/* Levels of accuracy of the command line: "draft", "standard", "reference", "dissertation". */
int gudgeon_case_accuracy(gudgeon_case *, const char *level);
/* Complete the case and check it; the message has a line for each thing that is wrong. */
int gudgeon_case_check(gudgeon_case *);
/* The value of a key as a case file has it, with the default where it is not given; of a group "present" or "none". */
size_t gudgeon_case_get(gudgeon_case *, const char *key, char *text, size_t size);
int gudgeon_case_given(const gudgeon_case *, int key);   /* whether the case gives a key, and has its group */
size_t gudgeon_case_text(gudgeon_case *, char *text, size_t size);    /* with all defaults; empty if the case is wrong */
size_t gudgeon_case_notes(gudgeon_case *, char *text, size_t size);   /* implausible values, a line each */
/* Folder that keeps tables of films, instead of that of the user; "": nothing is written at all. */
int gudgeon_case_cache(gudgeon_case *, const char *folder);
/* The columns that a run of the case will have. */
int gudgeon_case_columns(gudgeon_case *);
int gudgeon_case_column(const gudgeon_case *, int i, char *name, size_t name_size, char *unit, size_t unit_size, char *meaning,
                        size_t meaning_size);

/* A run of the case, or of its ideal twin. end <= 0: the end that the case has; otherwise this instead, even where the case ends when
 * its motion repeats; a run cannot go beyond its end. Tables of films are computed here. without_rows: values are asked for at
 * pauses, and no rows are kept. NULL: the case has the message. */
gudgeon_run *gudgeon_run_new(gudgeon_case *, int ideal_twin, double end, int without_rows);
/* Runs of the case begin at t = 0 with the motion that a run has reached (as with initial.goes_on = .false.); NULL: as the case says.
 * The numbers of that state may be read and changed; several with one name follow each other. kind: 0 number, 1 whole number, 2 what
 * the run has counted, which has no effect here. What does not fit the case is told by gudgeon_run_new. */
int gudgeon_case_start(gudgeon_case *, gudgeon_run *from);
int gudgeon_states(const gudgeon_case *);
int gudgeon_state(gudgeon_case *, int i, double *value, char *name, size_t name_size, char *unit, size_t unit_size, char *meaning,
                  size_t meaning_size, int *kind);
int gudgeon_state_set(gudgeon_case *, int i, double value);
/* Go on to a time, or through so many steps (0: no limit; one that is rejected counts too), or to the end. The results do not depend on
 * the pauses. -1: paused. */
int gudgeon_run_advance(gudgeon_run *, double to, int64_t most_steps);
/* End the run here, unless it has reached its end, and make its summary. */
int gudgeon_run_finish(gudgeon_run *);
/* Estimate the accuracy of a finished run; the summary then has the rows of --certify. */
int gudgeon_run_certify(gudgeon_run *);
/* Write PATH.csv, PATH.events.csv, PATH.summary.csv, PATH.state.nml, ... of a finished run. */
int gudgeon_run_save(gudgeon_run *, const char *path);
void gudgeon_run_free(gudgeon_run *);
/* Saved states: a copy goes on independently; assign puts it back. That of a run of another case is refused. */
gudgeon_run *gudgeon_run_copy(const gudgeon_run *);
int gudgeon_run_assign(gudgeon_run *to, const gudgeon_run *from);
double gudgeon_run_time(const gudgeon_run *);
double gudgeon_run_end(const gudgeon_run *);   /* expected end */

/* Inputs change at the beginning of the next advance, and are then held; the prescribed speed of a crank changes linearly to its
 * new value until the end of that advance. */
int gudgeon_inputs(const gudgeon_run *);
int gudgeon_input(const gudgeon_run *, int i, double *value, char *name, size_t name_size, char *unit, size_t unit_size);
int gudgeon_input_set(gudgeon_run *, int i, double value);

int gudgeon_columns(const gudgeon_run *);
int gudgeon_column(const gudgeon_run *, int i, char *name, size_t name_size, char *unit, size_t unit_size, char *meaning,
                   size_t meaning_size);
/* Row after row, not a copy; valid until the next call with this handle. */
const double *gudgeon_rows(const gudgeon_run *, int64_t *rows);
/* All columns at the present time; no row is made. */
int gudgeon_values(gudgeon_run *, double *now);
/* Number of events; -1: the case has no contacts. values: time, crank angle, normal speed, and where a contact ends its duration,
 * largest penetration and largest normal force. */
int64_t gudgeon_events(const gudgeon_run *);
int gudgeon_event(const gudgeon_run *, int64_t i, double values[6], int *ends, char *place, size_t place_size);
/* The summary of a finished run as the text of NAME.summary.csv, and quantity by quantity (count them first). value: not a number where the quantity is a word. */
size_t gudgeon_summary(const gudgeon_run *, char *text, size_t size);
int gudgeon_quantities(gudgeon_run *);
int gudgeon_quantity(const gudgeon_run *, int i, double *value, char *name, size_t name_size, char *unit, size_t unit_size,
                     char *text, size_t text_size);

/* Groups and keys of case files. kind: 1 real, 2 whole number, 3 switch, 4 word, 5 text. laws: those of `choice` that have the key;
 * empty: all. */
struct gudgeon_key {
  int kind, count, required, is_path;
  char group[32], name[32], unit[16], range[32], usual[32], default_value[32], example[32], choice[32];
  char words[512], laws[512], meaning[256];
};
struct gudgeon_group {
  int is_model;
  char name[32], place[32], meaning[256];
};
int gudgeon_keys(void);
int gudgeon_key(int first, int count, struct gudgeon_key *);
int gudgeon_groups(int count, struct gudgeon_group *);   /* the value is the number of all groups */

/* "complete", or a kind of short case: "dry", "film", "engine", ...; empty if there is none of this kind. */
size_t gudgeon_template(const char *kind, char *text, size_t size);
size_t gudgeon_schema(char *text, size_t size);   /* a JSON Schema of cases */
size_t gudgeon_message(const void *handle, char *text, size_t size);
size_t gudgeon_version(char *text, size_t size);

#ifdef __cplusplus
}
#endif
#endif
