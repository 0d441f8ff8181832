/* The C interface as a host uses it: two cases, a paused run with saved states and inputs, a refused case, many instances.
 *
 *     test_c CASES       CASES: the folder with the shipped cases */
#include "gudgeon.h"
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int passed, failed;
static const char *folder;

static void check(int holds, const char *what) {
  if (holds) passed++;
  else failed++, printf("FAILED: %s\n", what);
}

static gudgeon_case *read_case(const char *name) {
  char path[500];
  char *text = malloc(100000);
  snprintf(path, sizeof path, "%s/%s.nml", folder, name);
  FILE *file = fopen(path, "r");
  if (!file) return printf("cannot read %s\n", path), exit(1), NULL;
  size_t length = fread(text, 1, 100000, file);
  fclose(file);
  gudgeon_case *it = gudgeon_case_new(text, length, name, folder);
  free(text);
  return it;
}

static double quantity(gudgeon_run *run, const char *wanted, char *word) {
  char name[100], unit[20], text[500];
  double value;
  for (int i = 0; i < gudgeon_quantities(run); i++) {
    gudgeon_quantity(run, i, &value, name, sizeof name, unit, sizeof unit, text, sizeof text);
    if (strcmp(name, wanted)) continue;
    if (word) strcpy(word, text);
    return value;
  }
  return NAN;
}

/* A run with pauses has the rows of one without, bit for bit; a state that is put back gives the same values again. */
static void pauses(void) {
  gudgeon_case *it = read_case("friction/coulomb_static");
  check(gudgeon_case_set(it, "integrator.revolutions", "2") == 0, "a key is set");
  gudgeon_run *whole = gudgeon_run_new(it, 0, 0, 0), *parts = gudgeon_run_new(it, 0, 0, 0);
  check(gudgeon_run_advance(whole, HUGE_VAL, 0) == 2, "a time that is not finite is refused");
  check(gudgeon_run_advance(whole, 1e300, 0) == 0, "a run reaches its end");
  int columns = gudgeon_columns(parts);
  double *now = calloc(columns, sizeof *now), *again = calloc(columns, sizeof *now), end = gudgeon_run_end(parts);
  for (int i = 1; i <= 50; i++) {
    check(gudgeon_run_advance(parts, end * i / 51, 0) == -1, "a run pauses");
    gudgeon_run *saved = gudgeon_run_copy(parts);
    gudgeon_run_advance(parts, end * (i + 1) / 51.5, 0);
    gudgeon_values(parts, now);
    gudgeon_run_assign(parts, saved);
    check(fabs(gudgeon_run_time(parts) - end * i / 51) < 1e-15, "a state is put back");
    gudgeon_run_advance(parts, end * (i + 1) / 51.5, 0);
    gudgeon_values(parts, again);
    check(!memcmp(now, again, columns * sizeof *now), "a state that is put back goes on as before");
    gudgeon_run_free(saved);
  }
  while (gudgeon_run_advance(parts, 1e300, 20) == -1) continue;
  check(gudgeon_run_finish(whole) == 0 && gudgeon_run_finish(parts) == 0, "runs are finished");
  int64_t n, m;
  const double *a = gudgeon_rows(whole, &n), *b = gudgeon_rows(parts, &m);
  check(n == m && n > 1000 && !memcmp(a, b, n * columns * sizeof *a), "pauses change nothing");
  check(gudgeon_events(whole) == gudgeon_events(parts) && gudgeon_events(whole) > 0, "events are the same");
  char word[500];
  quantity(whole, "status", word);
  check(!strcmp(word, "done"), "the summary says that the run is done");
  check(quantity(whole, "max_pin_force", NULL) == quantity(parts, "max_pin_force", NULL), "summaries are the same");
  gudgeon_run_free(whole), gudgeon_run_free(parts), gudgeon_case_free(it), free(now), free(again);
}

/* A torque that is set to its own value changes nothing; one that changes is felt. */
static void torques(void) {
  gudgeon_case *it = read_case("sim_II");
  gudgeon_case_set(it, "drive.kind", "free");
  gudgeon_case_set(it, "integrator.end_time", "0.05");
  gudgeon_run *a = gudgeon_run_new(it, 0, 0, 0), *b = gudgeon_run_new(it, 0, 0, 0), *c = gudgeon_run_new(it, 0, 0, 0);
  char name[40], unit[20];
  double value;
  check(gudgeon_inputs(b) == 1 && gudgeon_input(b, 0, &value, name, 40, unit, 20) == 0 && !strcmp(name, "drive.torque"),
        "the torque of a free crank is an input");
  gudgeon_run_advance(a, 1e300, 0);
  for (int i = 1; i < 40; i++) {
    gudgeon_input_set(b, 0, value);
    gudgeon_input_set(c, 0, value + 20);
    gudgeon_run_advance(b, 0.05 * i / 40, 0);
    gudgeon_run_advance(c, 0.05 * i / 40, 0);
  }
  gudgeon_run_advance(b, 1, 0), gudgeon_run_advance(c, 1, 0);
  int64_t n, m;
  const double *x = gudgeon_rows(a, &n), *y = gudgeon_rows(b, &m);
  check(n == m && !memcmp(x, y, n * gudgeon_columns(a) * sizeof *x), "an input with the value that it has changes nothing");
  gudgeon_run_finish(a), gudgeon_run_finish(c);
  check(quantity(c, "mean_crank_speed", NULL) > quantity(a, "mean_crank_speed", NULL) * 1.01, "a torque drives the crank");
  check(quantity(c, "max_energy_residual_relative", NULL) < 1e-4, "the work of an input is in the ledger");
  gudgeon_run_free(a), gudgeon_run_free(b), gudgeon_run_free(c), gudgeon_case_free(it);
}

/* Wrong cases say what is wrong, and stay as they were. */
static void refusals(void) {
  char text[5000];
  gudgeon_case *it = read_case("sim_I");
  check(gudgeon_case_set(it, "joint.clearence", "1e-5") == 3, "a wrong key is refused");
  gudgeon_message(it, text, sizeof text);
  check(strstr(text, "did you mean clearance") != NULL, "the message names what was meant");
  check(gudgeon_case_check(it) == 0, "a refused change leaves the case as it was");
  gudgeon_case_set(it, "joint.clearance", "-1");
  check(gudgeon_case_check(it) == 3 && !gudgeon_run_new(it, 0, 0, 0), "a wrong case has no run");
  check(gudgeon_message(it, text, 12) > 30 && strlen(text) == 11, "a text is cut where it does not fit");
  gudgeon_case_set(it, "joint.clearance", "1e-5");
  gudgeon_case_set(it, "drive.torque_table", "/etc/passwd");
  check(gudgeon_case_check(it) == 3, "a file outside the folder is not read");
  gudgeon_message(it, text, sizeof text);
  check(strstr(text, "must be a file in the folder") != NULL, "the message says so");
  gudgeon_case_free(it);
}

static int says(const void *handle, const char *words) {
  char text[2000];
  gudgeon_message(handle, text, sizeof text);
  return strstr(text, words) != NULL;
}

/* No handle is no crash, wrong indices and values have the statuses of the header, and every failure leaves its message. */
static void misuse(void) {
  double value, six[6];
  int ends;
  int64_t rows;
  char text[20];
  check(gudgeon_case_set(NULL, "joint.clearance", "1") == 2 && gudgeon_case_set_number(NULL, 0, 0, 1) == 2 &&
        gudgeon_case_accuracy(NULL, "draft") == 2 && gudgeon_case_check(NULL) == 2 && gudgeon_case_cache(NULL, "") == 2 &&
        gudgeon_case_column(NULL, 0, text, 20, text, 20, text, 20) == 2, "functions of a case without one have status 2");
  check(!gudgeon_case_get(NULL, "joint.clearance", text, 20) && !gudgeon_case_text(NULL, text, 20) && !gudgeon_case_given(NULL, 0) &&
        !gudgeon_case_notes(NULL, text, 20) && !gudgeon_case_columns(NULL) && !gudgeon_case_copy(NULL), "others give nothing");
  check(gudgeon_run_advance(NULL, 1, 0) == 2 && gudgeon_run_finish(NULL) == 2 && gudgeon_run_certify(NULL) == 2 &&
        gudgeon_run_save(NULL, "x") == 2 && gudgeon_run_assign(NULL, NULL) == 2 && gudgeon_input_set(NULL, 0, 1) == 2 &&
        gudgeon_input(NULL, 0, &value, text, 20, text, 20) == 2 && gudgeon_column(NULL, 0, text, 20, text, 20, text, 20) == 2 &&
        gudgeon_values(NULL, six) == 2 && gudgeon_event(NULL, 0, six, &ends, text, 20) == 2 &&
        gudgeon_quantity(NULL, 0, &value, text, 20, text, 20, text, 20) == 2, "functions of a run without one have status 2");
  check(!gudgeon_run_new(NULL, 0, 0, 0) && !gudgeon_run_copy(NULL) && gudgeon_run_time(NULL) == 0 && gudgeon_run_end(NULL) == 0 &&
        !gudgeon_inputs(NULL) && !gudgeon_columns(NULL) && !gudgeon_rows(NULL, &rows) && rows == 0 && gudgeon_events(NULL) == -1 &&
        !gudgeon_summary(NULL, text, 20) && !gudgeon_quantities(NULL), "others give nothing");
  check(says(NULL, "no handle"), "the message says so");
  gudgeon_case_free(NULL), gudgeon_run_free(NULL);

  gudgeon_case *it = read_case("sim_I"), *other = read_case("sim_II");
  check(gudgeon_case_set_number(it, 100000, 0, 1) == 2 && says(it, "no key 100000"), "a wrong index of a key has status 2");
  check(gudgeon_case_set_number(it, 0, 99, 1) == 2 && says(it, "no number 99"), "so has one of an element");
  check(gudgeon_case_column(it, -1, text, 20, text, 20, text, 20) == 2 && says(it, "no column -1"), "and one of a column");
  check(!gudgeon_run_new(it, 0, NAN, 0) && says(it, "finite"), "an end that is no number is refused");
  gudgeon_case_set(other, "joint.clearance", "-1");
  check(gudgeon_case_check(other) == 3 && gudgeon_case_set(other, "joint.nothing", "1") == 3 && gudgeon_case_check(other) == 3 &&
        says(other, "must be > 0"), "a case that is still wrong says why again");
  gudgeon_case_set(other, "joint.clearance", "1e-5");
  gudgeon_run *run = gudgeon_run_new(it, 0, 0.01, 0), *another = gudgeon_run_new(other, 0, 0.01, 0);
  check(gudgeon_run_assign(run, another) == 2 && says(run, "another case"), "a state of another case is refused");
  check(gudgeon_run_assign(run, NULL) == 2 && says(run, "no handle"), "so is none");
  check(gudgeon_run_advance(run, NAN, 0) == 2 && says(run, "finite"), "a time that is no number is refused");
  check(gudgeon_run_advance(run, 1, -1) == 2 && gudgeon_run_time(run) == 0, "so are steps below 0");
  check(gudgeon_summary(run, text, 20) == 0 && says(run, "only a finished run"), "a run that goes on has no summary");
  check(gudgeon_quantities(run) == 0 && gudgeon_run_save(run, "x") == 2 && gudgeon_run_certify(run) == 2, "and is not saved");
  check(gudgeon_input_set(run, 99, 1) == 2 && says(run, "no input 99"), "a wrong input has status 2");
  gudgeon_run_finish(run);
  check(gudgeon_event(run, 1 << 30, six, &ends, text, 20) == 2 && says(run, "no event"), "a wrong event has status 2");
  check(gudgeon_quantity(run, -1, &value, text, 20, text, 20, text, 20) == 2 && says(run, "no quantity"), "so has a wrong quantity");
  check(gudgeon_run_save(run, "") == 5 && says(run, "path"), "a run is not saved without a name");
  gudgeon_run_free(run), gudgeon_run_free(another), gudgeon_case_free(it), gudgeon_case_free(other);
}

static int column_of(gudgeon_run *run, const char *wanted) {
  char name[60], unit[20], meaning[200];
  for (int i = 0; gudgeon_column(run, i, name, 60, unit, 20, meaning, 200) == 0; i++)
    if (!strcmp(name, wanted)) return i;
  return 0;
}

/* A run that starts from another one begins with its motion; a number of it is changed. */
static void starts(void) {
  gudgeon_case *it = read_case("sim_I");
  gudgeon_run *first = gudgeon_run_new(it, 0, 0.01, 1);
  char name[60], unit[20], meaning[200];
  double value, *now = calloc(gudgeon_columns(first), sizeof *now), *on = calloc(gudgeon_columns(first), sizeof *now);
  int kind, i, angle = -1, totals = 0, at = column_of(first, "crank_angle"), speed = column_of(first, "crank_speed");
  check(gudgeon_states(it) == 0 && gudgeon_state(it, 0, &value, name, 60, unit, 20, meaning, 200, &kind) == 2 && says(it, "no state 0"),
        "a case has no states of its own");
  gudgeon_run_advance(first, 0.0033, 0);
  check(gudgeon_case_start(it, first) == 0 && gudgeon_states(it) > 6, "a case takes the state of a run, also inside a step");
  gudgeon_values(first, now);
  gudgeon_run *second = gudgeon_run_new(it, 0, 0.01, 1);
  gudgeon_values(second, on);
  check(gudgeon_run_time(second) == 0 && fabs(on[speed] - now[speed]) < 1e-7 * now[speed], "a run begins with its speed at t = 0");
  for (i = 0; gudgeon_state(it, i, &value, name, 60, unit, 20, meaning, 200, &kind) == 0; i++) {
    if (!strcmp(name, "crank_angle")) angle = i;
    totals += kind == 2;
  }
  check(i == gudgeon_states(it) && totals > 0 && angle >= 0, "states have names and kinds");
  check(gudgeon_state_set(it, angle, 0.5) == 0, "a number is changed");
  check(gudgeon_state_set(it, i, 0) == 2 && gudgeon_state_set(it, -1, 0) == 2 && says(it, "no state -1"), "a wrong index is refused");
  check(gudgeon_state_set(it, angle, NAN) == 2 && says(it, "finite"), "so is what is no number");
  gudgeon_run *third = gudgeon_run_new(it, 0, 0.01, 1);
  gudgeon_values(third, on);
  check(fabs(on[at] - 0.5) < 1e-15, "a run begins there");
  gudgeon_case *wrong = read_case("friction/coulomb_static");
  gudgeon_case_start(wrong, first);
  check(!gudgeon_run_new(wrong, 0, 0, 0) && says(wrong, "the start of the case"), "the state of another case is refused");
  check(gudgeon_case_start(it, NULL) == 0 && gudgeon_states(it) == 0, "a start is taken back");
  check(gudgeon_case_start(NULL, first) == 2 && !gudgeon_states(NULL) && gudgeon_state_set(NULL, 0, 1) == 2 &&
        gudgeon_state(NULL, 0, &value, name, 60, unit, 20, meaning, 200, &kind) == 2, "no case has no start");
  gudgeon_run_free(first), gudgeon_run_free(second), gudgeon_run_free(third), gudgeon_case_free(it), gudgeon_case_free(wrong);
  free(now), free(on);
}

/* Numbers set without texts give the bits of those set as texts. */
static void numbers(void) {
  int n = gudgeon_keys(), clearance = -1;
  struct gudgeon_key *keys = calloc(n, sizeof *keys);
  check(gudgeon_key(0, n, keys) == 0, "keys are described");
  for (int i = 0; i < n; i++)
    if (!strcmp(keys[i].group, "joint") && !strcmp(keys[i].name, "clearance")) clearance = i;
  check(clearance >= 0 && !strcmp(keys[clearance].unit, "m"), "a key has a unit");
  gudgeon_case *a = read_case("sim_I"), *b = read_case("sim_I");
  gudgeon_case_set(a, "output.columns", "none"), gudgeon_case_set(b, "output.columns", "none");
  for (int i = 1; i < 5; i++) {
    char text[30];
    snprintf(text, sizeof text, "%.17g", i * 1.1e-5);
    gudgeon_case_set(a, "joint.clearance", text);
    gudgeon_case_set_number(b, clearance, 0, i * 1.1e-5);
    gudgeon_run *x = gudgeon_run_new(a, 0, 0, 0), *y = gudgeon_run_new(b, 0, 0, 0);
    gudgeon_run_advance(x, 1e300, 0), gudgeon_run_advance(y, 1e300, 0);
    gudgeon_run_finish(x), gudgeon_run_finish(y);
    check(quantity(x, "max_pin_force", NULL) == quantity(y, "max_pin_force", NULL), "a number without text is the same number");
    check(gudgeon_columns(x) == 0, "no rows are made where none are asked for");
    gudgeon_run_free(x), gudgeon_run_free(y);
  }
  check(gudgeon_case_set_number(b, clearance, 0, NAN) == 3, "no number is refused");
  gudgeon_case_free(a), gudgeon_case_free(b), free(keys);
}

/* Threads that read wrong cases get their own messages, and runs give the bits of one thread. */
static double one_force;
static void *thread(void *argument) {
  long number = (long)argument, wrong = 0;
  char key[40], text[2000];
  for (int i = 0; i < 60; i++) {
    gudgeon_case *it = read_case("sim_I");
    snprintf(key, sizeof key, "joint.nothing_%ld_%d", number, i);
    gudgeon_case_set(it, key, "1");
    gudgeon_message(it, text, sizeof text);
    if (!strstr(text, key + 6)) wrong++;
    if (i % 10 == 0) {
      gudgeon_run *run = gudgeon_run_new(it, 0, 0, 0);
      gudgeon_run_advance(run, 1e300, 0);
      gudgeon_run_finish(run);
      if (quantity(run, "max_pin_force", NULL) != one_force) wrong++;
      gudgeon_run_free(run);
    }
    gudgeon_case_free(it);
  }
  return (void *)wrong;
}

static void threads(void) {
  gudgeon_case *it = read_case("sim_I");
  gudgeon_run *run = gudgeon_run_new(it, 0, 0, 0);
  gudgeon_run_advance(run, 1e300, 0), gudgeon_run_finish(run);
  one_force = quantity(run, "max_pin_force", NULL);
  gudgeon_run_free(run), gudgeon_case_free(it);
  pthread_t all[8];
  pthread_attr_t small;
  pthread_attr_init(&small), pthread_attr_setstacksize(&small, 256 * 1024);
  long wrong = 0;
  for (long i = 0; i < 8; i++) pthread_create(&all[i], &small, thread, (void *)i);
  for (int i = 0; i < 8; i++) {
    void *found;
    pthread_join(all[i], &found);
    wrong += (long)found;
  }
  check(wrong == 0, "threads do not disturb each other");
}

int main(int count, char **arguments) {
  if (count < 2) return printf("usage: test_c CASES\n"), 2;
  folder = arguments[1];
  pauses();
  torques();
  refusals();
  misuse();
  numbers();
  starts();
  if (count < 3) threads();   /* a second argument: without, for valgrind */
  printf("%d passed, %d failed\n", passed, failed);
  return failed > 0;
}
