/* SUNDIALS CVODE on a scene of scripts/bench/scene_library/scene_library.f90, for scripts/bench/compare_integrators. Needs Debian's libsundials-dev (6.x):
 *
 *   cc -O2 -shared -fPIC scripts/bench/scene_library/cvode_run.c -o build/scene_library/cvode_run.so -lsundials_cvode -lsundials_nvecserial \
 *      -lsundials_sunmatrixdense -lsundials_sunlinsoldense -lm
 */
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include "scene_run.h"

static int rates(double t, N_Vector y, N_Vector f, void *data) {
  run_t *run = data;
  if (++run->n_rates > run->most_rates) return -1;
  return run->rates(run->handle, t, NV_DATA_S(y), NV_DATA_S(f)) == 0 ? 0 : 1;
}

static int events(double t, N_Vector y, double *g, void *data) {
  run_t *run = data;
  double rate[most_events];
  return run->events(run->handle, t, NV_DATA_S(y), g, rate);
}

/* The present directions of the events: all event functions change from negative to not negative. */
static int watch_events(void *cvode, run_t *run) {
  int sizes[3], upwards[most_events], status;
  run->sizes(run->handle, sizes);
  if ((status = CVodeRootInit(cvode, sizes[2], events)) < 0 || sizes[2] == 0) return status;
  for (int i = 0; i < sizes[2]; i++) upwards[i] = 1;
  if ((status = CVodeSetRootDirection(cvode, upwards)) < 0) return status;
  return CVodeSetNoInactiveRootWarn(cvode);
}

static void silent(int code, const char *module, const char *function, char *message, void *data) {
  (void)code, (void)module, (void)function, (void)message, (void)data;
}

/* Add the counts since CVODE's last start. */
static void add_counts(void *cvode, run_t *run) {
  long steps = 0, jacobians = 0;
  CVodeGetNumSteps(cvode, &steps);
  CVodeGetNumJacEvals(cvode, &jacobians);
  run->n_steps += (int)steps;
  run->n_jacobians += (int)jacobians;
}

/* Integrate y from 0 to t_end with Newton's method and numerical Jacobians; method: 1 Adams, 2 BDF. absolute: n tolerances. The
 * return value is CVODE's, or 1 where an event ended the run. */
int cvode_run(run_t *run, int method, double relative, const double *absolute, double max_step, double t_end, double *state,
              double *instants) {
  SUNContext context;
  double t = 0;
  int status, found[most_events], sizes[3], ends = 0;

  SUNContext_Create(NULL, &context);
  N_Vector y = N_VMake_Serial(run->n, state, context);
  N_Vector tolerances = N_VMake_Serial(run->n, (double *)absolute, context);
  SUNMatrix matrix = SUNDenseMatrix(run->n, run->n, context);
  SUNLinearSolver solver = SUNLinSol_Dense(y, matrix, context);
  void *cvode = CVodeCreate(method == 1 ? CV_ADAMS : CV_BDF, context);

  double before = processor_time();
  CVodeInit(cvode, rates, 0, y);
  CVodeSetErrHandlerFn(cvode, silent, NULL);
  CVodeSetUserData(cvode, run);
  CVodeSVtolerances(cvode, relative, tolerances);
  CVodeSetLinearSolver(cvode, solver, matrix);
  CVodeSetMaxNumSteps(cvode, run->most_rates);
  CVodeSetStopTime(cvode, t_end);
  if (max_step > 0) CVodeSetMaxStep(cvode, max_step);
  status = watch_events(cvode, run);
  while (status >= 0 && !ends && t < t_end) {
    status = CVode(cvode, t_end, y, &t, CV_NORMAL);
    if (status != CV_ROOT_RETURN) {
      if (status == CV_TSTOP_RETURN) break;
      continue;
    }
    add_counts(cvode, run);
    CVodeGetRootInfo(cvode, found);
    run->sizes(run->handle, sizes);
    int index = 0;
    while (index < sizes[2] - 1 && found[index] == 0) index++;
    ends = accept_event(run, index + 1, t, state, instants);
    if ((status = CVodeReInit(cvode, t, y)) < 0) break;
    CVodeSetStopTime(cvode, t_end);
    status = watch_events(cvode, run);
  }
  add_counts(cvode, run);
  run->seconds = processor_time() - before;
  CVodeFree(&cvode);
  SUNLinSolFree(solver);
  SUNMatDestroy(matrix);
  N_VDestroy(tolerances);
  N_VDestroy(y);
  SUNContext_Free(&context);
  return status < 0 ? status : ends;
}
