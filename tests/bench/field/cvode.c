/* SUNDIALS' CVODE on the same systems: what a numerical analyst would take. It chooses steps and orders by itself.
 *
 *   bench_cvode CASE method=adams|bdf tolerance=X ...
 *
 * adams solves its equations by fixed-point iteration, bdf by Newton and GMRES without a matrix. tolerance is relative,
 * and absolute for places, m; for speeds ten times as much, m/s. */
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_spgmr.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <time.h>

#include "tests/bench/field/cases.h"

#define ASKED_EVERY 256 /* evaluations */

typedef struct Rates {
  System *s;
  Lanes *f;
  long evaluations;
  clock_t end;
} Rates;

/* y is x of all nodes, then v. */
static void unpack(System *s, const double *y) {
  size_t n = s->node_count;
  for (size_t i = 0; i < n; i++) {
    s->x[i] = (Lanes){y[3 * i], y[3 * i + 1], y[3 * i + 2], s->x[i][3]};
    s->v[i] = (Lanes){y[3 * (n + i)], y[3 * (n + i) + 1], y[3 * (n + i) + 2], 0};
  }
}

static int rates(realtype t, N_Vector state, N_Vector rate, void *data) {
  Rates *r = data;
  System *s = r->s;
  size_t n = s->node_count;
  double *to = N_VGetArrayPointer(rate);
  const double *y = N_VGetArrayPointer(state);
  (void)t;
  unpack(s, y);
  memset(r->f, 0, (n + 1) * sizeof *r->f);
  system_force(s, s->x, s->v, r->f);
  memcpy(to, y + 3 * n, 3 * n * sizeof *to);
  for (size_t i = 0; i < n; i++) {
    Lanes a = s->x[i][3] * r->f[i] + s->acceleration[i];
    for (size_t e = 0; e < 3; e++) to[3 * (n + i) + e] = a[e];
  }
  /* Within a frame too: where elements turn over its steps grow as short as it likes. To ask costs as much as a few
   * springs, so that it is seldom done. */
  return ++r->evaluations % ASKED_EVERY == 0 && clock() > r->end ? -1 : 0;
}

static void *begin(const CaseRun *run, SUNContext context, N_Vector y, Rates *r) {
  System *s = r->s;
  size_t n = s->node_count;
  bool stiff = !strcmp(case_word(run, "method", ""), "bdf");
  double tolerance = case_number(run, "tolerance", 1e-4), *start = N_VGetArrayPointer(y);
  N_Vector absolute = N_VClone(y);
  for (size_t i = 0; i < 3 * n; i++) {
    start[i] = s->x[i / 3][i % 3], start[3 * n + i] = s->v[i / 3][i % 3];
    N_VGetArrayPointer(absolute)[i] = tolerance, N_VGetArrayPointer(absolute)[3 * n + i] = 10 * tolerance;
  }
  void *cvode = CVodeCreate(stiff ? CV_BDF : CV_ADAMS, context);
  CVodeInit(cvode, rates, 0, y);
  CVodeSVtolerances(cvode, tolerance, absolute);
  CVodeSetUserData(cvode, r);
  CVodeSetMaxNumSteps(cvode, 100000000);
  if (stiff) CVodeSetLinearSolver(cvode, SUNLinSol_SPGMR(y, SUN_PREC_NONE, 30, context), NULL);
  else CVodeSetNonlinearSolver(cvode, SUNNonlinSol_FixedPoint(y, 0, context));
  return cvode;
}

/* What the solvers hold is left to the end of the program. */
int main(int argc, char **argv) {
  CaseRun run = case_begin(argc, argv);
  double limit_s = case_number(&run, "limit", 10);
  Rates r = {case_system(&run, argc > 1 ? argv[1] : ""), NULL, 0, clock() + (clock_t)(limit_s * CLOCKS_PER_SEC)};
  SUNContext context;
  if (!r.s || SUNContext_Create(NULL, &context)) return 2;
  r.f = clear_memory(r.s->node_count + 1, sizeof *r.f);
  N_Vector y = N_VNew_Serial((sunindextype)(6 * r.s->node_count), context);
  void *cvode = begin(&run, context, y, &r);
  while (case_next_frame(&run)) {
    realtype reached;
    int status = CVode(cvode, run.time * run.frame / run.frames, y, &reached, CV_NORMAL);
    case_stop(&run);
    if (status < 0) {
      fprintf(stderr, "status %d after %g s of work\n", status, run.cpu_s);
      return 1;
    }
    const double *x = N_VGetArrayPointer(y);
    for (size_t i = 0; i < r.s->node_count; i++) case_node(&run, x[3 * i], x[3 * i + 1], x[3 * i + 2]);
  }
  char more[64];
  snprintf(more, sizeof more, ", \"evaluations\": %ld", r.evaluations);
  case_end(&run, more);
  return 0;
}
