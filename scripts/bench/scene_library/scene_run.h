/* A run of a scene of scripts/bench/scene_library/scene_library.f90 by a code in C, for scripts/bench/compare_integrators. */
#ifndef SCENE_RUN_H
#define SCENE_RUN_H
#include <time.h>

enum { most_events = 24 };

/* The scene, through the functions of scene_library.f90, which explains them. */
typedef struct {
  void *handle;
  int (*rates)(void *, double, const double *, double *);
  int (*events)(void *, double, const double *, double *, double *);
  int (*handle_event)(void *, int, double, double *, int *);
  void (*sizes)(void *, int *);
  int n;              /* states */
  int most_rates;     /* evaluations after which the run is given up */
  int n_rates;        /* evaluations so far */
  int n_jacobians;
  int n_steps;
  int n_instants;     /* number of contact events so far */
  int most_instants;  /* size of the array of their times */
  double seconds;     /* processor time */
} run_t;

/* Handle event `index` (from 1) at (t, y) and note its time if it is a contact. Returns 1 if it ends the run. */
static inline int accept_event(run_t *run, int index, double t, double *y, double *instants) {
  int is_contact;
  int ends = run->handle_event(run->handle, index, t, y, &is_contact);
  if (is_contact && run->n_instants < run->most_instants) instants[run->n_instants++] = t;
  return ends;
}

/* Processor time of this thread [s]. */
static inline double processor_time(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}
#endif
