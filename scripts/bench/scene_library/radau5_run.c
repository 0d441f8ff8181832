/* Hairer and Wanner's RADAU5 on a scene of scripts/bench/scene_library/scene_library.f90, for scripts/bench/compare_integrators: its compiled
 * version in the R package deSolve (Debian's r-cran-desolve), without R.
 *
 *   cc -O2 -shared -fPIC scripts/bench/scene_library/radau5_run.c -o build/scene_library/radau5_run.so DESOLVE/deSolve.so -lm
 *
 * RADAU5 keeps its data in COMMON, and its functions have no argument for a context: one run at a time.
 */
#include <math.h>
#include <string.h>
#include "scene_run.h"

enum { most_states = 64, work_size = 4 * most_states * most_states + 12 * most_states + 20, whole_size = 3 * most_states + 20, places = 10 };

extern void radau5_(int *n, void (*rates)(int *, double *, double *, double *, double *, int *), double *t, double *y, double *t_end,
                    double *h, double *relative, double *absolute, int *by_state, void (*jacobian)(void), int *has_jacobian,
                    int *jacobian_lower, int *jacobian_upper, void (*mass)(void), int *has_mass, int *mass_lower, int *mass_upper,
                    void (*step_done)(int *, double *, double *, double *, double *, int *, int *, double *, int *, int *),
                    int *calls_step_done, double *work, int *work_length, int *whole, int *whole_length, double *real_data,
                    int *whole_data, int *outcome);
extern void contr5_(int *n, double *t, double *polynomials, int *length, double *y);

static run_t *run;
static double g_old[most_events], g_rate_old[most_events];   /* event functions and their rates at the beginning of a step */
static int was_negative[most_events];
static int event;                     /* event that was found, from 1; 0: none */
static double t_event, y_event[most_states];

/* RADAU5 reports faults by this function of R, which must not be called without R. */
void Rprintf(const char *form, ...) { (void)form; }

static void nothing(void) {}

static void rates(int *n, double *t, double *y, double *f, double *real_data, int *whole_data) {
  (void)real_data, (void)whole_data;
  run->n_rates++;
  if (run->n_rates > run->most_rates || run->rates(run->handle, *t, y, f) != 0)
    for (int i = 0; i < *n; i++) f[i] = 1e30;   /* Newton's method diverges, and the step is repeated with half its size */
}

/* Event function i (from 0) on the polynomial of the last step; its state is left in y_event. */
static double event_at(int i, double t, double *polynomials, int *length) {
  double g[most_events], g_rate[most_events];
  contr5_(&run->n, &t, polynomials, length, y_event);
  run->events(run->handle, t, y_event, g, g_rate);
  return g[i];
}

/* Whether a function that is negative at both ends of a step stays negative between them: whether both inner Bernstein coefficients of
 * its cubic Hermite interpolant are below 0 by more than their largest deviation from the straight line. */
static int stays_negative(double width, double left, double left_rate, double right, double right_rate) {
  if (left >= 0 || right >= 0) return 0;
  double first = left + width * left_rate / 3, second = right - width * right_rate / 3;
  double bend = fmax(fabs(first - (2 * left + right) / 3), fabs(second - (left + 2 * right) / 3));
  return fmax(first, second) + bend < 0;
}

/* Where event function i first rises to 0 in a step, by testing some places and bisection; t_end if it does not. */
static double rises_at(int i, double t_begin, double t_end, double *polynomials, int *length) {
  double left = t_begin, middle;
  for (int k = 1; k <= places; k++) {
    double right = k == places ? t_end : t_begin + (t_end - t_begin) * k / places;
    if (event_at(i, right, polynomials, length) < 0) {
      was_negative[i] = 1;
    } else if (was_negative[i]) {
      while ((middle = 0.5 * (left + right)) > left && middle < right) {
        if (event_at(i, middle, polynomials, length) < 0) left = middle;
        else right = middle;
      }
      event = i + 1;
      return right;
    }
    left = right;
  }
  return t_end;
}

/* Search for events in an accepted step. */
static void step_done(int *number, double *t_begin, double *t_end, double *y, double *polynomials, int *length, int *n, double *real_data,
                      int *whole_data, int *stop) {
  (void)n, (void)real_data, (void)whole_data;
  double g[most_events], g_rate[most_events], t_first = *t_end;
  int sizes[3], found = 0;
  run->sizes(run->handle, sizes);
  *stop = run->n_rates > run->most_rates ? -1 : 0;
  if (sizes[2] == 0) return;
  run->events(run->handle, *t_end, y, g, g_rate);
  for (int i = 0; i < sizes[2]; i++) {
    if (*number == 1) {   /* called at the beginning */
      was_negative[i] = g[i] < 0;
    } else if (!(was_negative[i] && stays_negative(*t_end - *t_begin, g_old[i], g_rate_old[i], g[i], g_rate[i]))) {
      event = 0;
      double t = rises_at(i, *t_begin, *t_end, polynomials, length);
      if (event > 0 && (found == 0 || t < t_first)) {
        t_first = t;
        found = event;
      }
    }
    g_old[i] = g[i];
    g_rate_old[i] = g_rate[i];
  }
  event = found;
  if (found == 0) return;
  t_event = t_first;
  event_at(found - 1, t_first, polynomials, length);
  *stop = -1;
}

/* Integrate y from 0 to t_end with difference Jacobians and, since all states are positions and their rates, the option for
 * equations of second order. absolute: n tolerances. The return value is RADAU5's if it is negative, otherwise 1 where an event ended
 * the run. The other arguments are those of cvode_run. */
int radau5_run(run_t *scene, int method, double relative, const double *absolute, double max_step, double t_end, double *y,
               double *instants) {
  static double work[work_size];
  static int whole[whole_size];
  double t = 0, h = 1e-6 * t_end, real_data, relative_of[most_states], absolute_of[most_states];
  int n = scene->n, half = n / 2, yes = 1, no = 0, outcome = 0, ends = 0, work_length = work_size, whole_length = whole_size, whole_data;
  (void)method;
  run = scene;
  if (n > most_states || n != 2 * half) return -1;

  double before = processor_time();
  while (!ends && t < t_end) {
    int lower = half, upper = 0, mass_lower = half, mass_upper = 0;
    for (int i = 0; i < n; i++) {
      relative_of[i] = relative;
      absolute_of[i] = absolute[i];
    }
    memset(work, 0, sizeof work);
    memset(whole, 0, sizeof whole);
    work[6] = max_step;
    whole[1] = run->most_rates;
    whole[8] = whole[9] = half;
    event = 0;
    radau5_(&n, rates, &t, y, &t_end, &h, relative_of, absolute_of, &yes, nothing, &no, &lower, &upper, nothing, &no, &mass_lower,
            &mass_upper, step_done, &yes, work, &work_length, whole, &whole_length, &real_data, &whole_data, &outcome);
    run->n_jacobians += whole[14];
    run->n_steps += whole[16];
    if (outcome == -3 && t_end - t < 1e-12 * t_end) outcome = 1;   /* RADAU5 may end a rounding error before t_end */
    if (run->n_rates > run->most_rates) outcome = -2;
    if (outcome < 0 || event == 0) break;
    t = t_event;
    memcpy(y, y_event, (size_t)n * sizeof *y);
    ends = accept_event(run, event, t, y, instants);
  }
  run->seconds = processor_time() - before;
  return outcome < 0 ? outcome : ends;
}
