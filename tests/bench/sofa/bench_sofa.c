/* bench_sofa [--steps N] [--repeats N] [NAME]: SOFA's cases on our kernel, one line of JSON a case, those whose names
 * begin with NAME.
 *
 * Time is the thread's CPU time of a step: the least of some runs that are equal bit by bit, then the median over the
 * steps. Beside it stands what it bought: the worst residual, how many steps were not solved, and the distance from the
 * same steps solved to 1e-9. For SOFA's way (sofa_step.h) the same distance, by our own run of it. Of
 * piles: the distance from steps of a 64th, soon after the start, as later nobody's answer is more than chance. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "tests/bench/sofa/cases.h"
#include "tests/bench/sofa/hardware.h"
#include "tests/bench/sofa/sofa_step.h"

static unsigned repeats = 2, steps_at_most = 1000;

static double cpu_ms(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * (double)now.tv_sec + 1e-6 * (double)now.tv_nsec;
}

static Rig *unbuilt(const Case *self, double tolerance) {
  Rig *rig = rig_new();
  if (self->substeps > 0) rig->description.solver.substeps = self->substeps;
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator =
      self->substeps > 0 ? SPORE_INTEGRATOR_SYMPLECTIC_EULER : SPORE_INTEGRATOR_IMPLICIT_EULER;
  rig->description.solver.tolerance = tolerance;
  rig->description.solver.sleep_speed = 0; /* SOFA's bodies do not sleep either */
  self->build(rig, self);
  return rig;
}

static Rig *start(const Case *self, double tolerance) {
  Rig *rig = unbuilt(self, tolerance);
  rig_build(rig);
  return rig;
}

/* What a case's steps cost, and how well they were solved. */
typedef struct Outcome {
  double ms, residual, newton, linear, evaluations, contacts;
  unsigned unsolved; /* steps that missed their tolerance or had to be taken again */
  size_t dof, island_count;
  size_t blocks; /* of the bodies' own matrices */
} Outcome;

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return x < y ? -1 : x > y;
}

static void count(const SporeWorld *world, Outcome *outcome, double share) {
  SporeStepCounts counts = spore_world_counts(world);
  outcome->residual = fmax(outcome->residual, counts.residual);
  outcome->newton += share * (double)counts.newton_iterations;
  outcome->linear += share * (double)counts.linear_iterations;
  outcome->evaluations += share * (double)counts.force_evaluations;
  outcome->contacts += share * (double)counts.contacts;
  outcome->island_count = counts.islands;
}

static size_t matrix_blocks(const SporeModel *model) {
  SporeBlockPattern pattern;
  SporeBlockMatrix matrix;
  if (!model || !model->type->pattern) return 0;
  spore_block_pattern_init(&pattern, model->block_count);
  g_assert_true(model->type->pattern(model, &pattern) && spore_block_matrix_create(&matrix, &pattern));
  size_t blocks = matrix.row_start[matrix.block_count];
  spore_block_pattern_clear(&pattern);
  spore_block_matrix_clear(&matrix);
  return blocks;
}

/* The least time for the work that was counted, ms: what it must read and write through the cache that holds it, or its
 * operations, whichever takes longer. */
static double hardware_ms(const Case *self, const Outcome *outcome) {
  double dof = (double)outcome->dof, blocks = (double)outcome->blocks, elements = (double)self->elements;
  double matrix_bytes = 76 * blocks + 120 * outcome->contacts, vectors_bytes = 10 * 8 * dof;
  double bytes = outcome->linear * (matrix_bytes + vectors_bytes) + outcome->newton * 2 * matrix_bytes +
                 outcome->evaluations * (100 * elements + 4 * 8 * dof);
  double flops = outcome->linear * (18 * blocks + 60 * outcome->contacts + 15 * dof) +
                 outcome->evaluations * (self->force_flops * elements + 100 * outcome->contacts + 10 * dof) +
                 outcome->newton * (self->jacobian_flops * elements + 100 * outcome->contacts);
  double by_bytes = bytes / hardware_bandwidth((size_t)(matrix_bytes + vectors_bytes) + 1);
  return 1e-6 * fmax(by_bytes, flops / hardware_peak());
}

static unsigned troubles(const SporeWorld *world) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  return (unsigned)(monitor->not_converged + monitor->recoveries);
}

static Outcome measure(const Case *self, unsigned steps, double tolerance) {
  double *ms = g_new(double, steps);
  Outcome outcome = {0};
  for (unsigned i = 0; i < steps; i++) ms[i] = HUGE_VAL;
  for (unsigned repeat = 0; repeat < repeats; repeat++) {
    Rig *rig = start(self, tolerance);
    rig_run(rig->world, MIN(self->before, steps_at_most));
    unsigned before = troubles(rig->world);
    for (unsigned i = 0; i < steps; i++) {
      double begin = cpu_ms();
      spore_world_step(rig->world);
      ms[i] = fmin(ms[i], cpu_ms() - begin);
      if (repeat == 0) count(rig->world, &outcome, 1.0 / steps);
    }
    outcome.unsolved = troubles(rig->world) - before;
    outcome.dof = spore_world_dof(rig->world);
    outcome.blocks = 0;
    for (uint32_t b = 0; b < spore_world_body_count(rig->world); b++)
      outcome.blocks += matrix_blocks(spore_world_body_model(rig->world, b));
    rig_free(rig);
  }
  qsort(ms, steps, sizeof *ms, compare);
  outcome.ms = ms[steps / 2];
  g_free(ms);
  return outcome;
}

/* Where the one body of a case is after its steps. */
typedef struct End {
  size_t count;
  double *q;
  double height; /* mean y of its nodes, m */
} End;

static End end_of(size_t nodes, const double *q) {
  End end = {3 * nodes, g_memdup2(q, 3 * nodes * sizeof *q), 0};
  for (size_t i = 0; i < nodes; i++) end.height += q[3 * i + 1] / (double)nodes;
  return end;
}

static End solved(const Case *self, unsigned steps, double tolerance) {
  Rig *rig = start(self, tolerance);
  rig_run(rig->world, steps);
  End end = end_of(spore_world_body_model(rig->world, 0)->block_count, spore_world_q(rig->world, 0));
  rig_free(rig);
  return end;
}

static void mark_held(const Rig *rig, const double *q, size_t nodes, uint8_t *held) {
  for (guint i = 0; i < rig->links->len; i++) {
    const SporeLinkDescription *pin = &g_array_index(rig->links, SporeLinkDescription, i);
    for (size_t n = 0; n < nodes; n++)
      held[n] |= spore_vec3_distance(spore_vec3_load(q + 3 * n), pin->point_a) <= pin->radius;
  }
}

static End truncated(const Case *self, unsigned steps, double *residual) {
  Rig *rig = start(self, 1e-6);
  const SporeModel *model = spore_world_body_model(rig->world, 0);
  size_t nodes = model->block_count;
  double *q = g_memdup2(spore_world_q(rig->world, 0), 3 * nodes * sizeof *q);
  double *v = g_memdup2(spore_world_v(rig->world, 0), 3 * nodes * sizeof *v);
  uint8_t *held = g_new0(uint8_t, nodes);
  mark_held(rig, q, nodes, held);
  *residual =
      sofa_run(model, rig->description.gravity, held, rig->description.solver.time_step, steps, SOFA_ITERATIONS, q, v);
  End end = end_of(nodes, q);
  g_free(q);
  g_free(v);
  g_free(held);
  rig_free(rig);
  return end;
}

/* Root mean square distance of the nodes over the size of the body. */
static double distance(const End *a, const End *b) {
  double sum = 0, lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < a->count; i++) {
    sum += (a->q[i] - b->q[i]) * (a->q[i] - b->q[i]);
    lower[i % 3] = fmin(lower[i % 3], b->q[i]);
    upper[i % 3] = fmax(upper[i % 3], b->q[i]);
  }
  double size = spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
  return sqrt(3 * sum / (double)a->count) / size;
}

static void print_number(const char *name, double value) {
  if (isfinite(value)) printf(", \"%s\": %.6g", name, value);
  else printf(", \"%s\": null", name);
}

/* Ours stopped as soon as its error is no larger than SOFA's: the loosest tolerance that keeps to that, and what its
 * steps cost. */
static void compare_stopped(const Case *self, unsigned steps, const End *exact, double error_peer) {
  for (double tolerance = 0.1; tolerance > 1e-6; tolerance /= 2) {
    End stopped = solved(self, steps, tolerance);
    double error = distance(&stopped, exact);
    g_free(stopped.q);
    if (error > error_peer) continue;
    Outcome outcome = measure(self, steps, tolerance);
    print_number("stopped_ours", outcome.ms);
    print_number("stopped_tolerance", tolerance);
    print_number("stopped_error", error);
    print_number("stopped_hardware", hardware_ms(self, &outcome));
    print_number("stopped_newton", outcome.newton);
    print_number("stopped_linear", outcome.linear);
    return;
  }
}

static void compare_truncated(const Case *self, unsigned steps) {
  double residual;
  End exact = solved(self, steps, 1e-9), ours = solved(self, steps, 1e-6), sofa = truncated(self, steps, &residual);
  double error_peer = distance(&sofa, &exact);
  print_number("error_ours", distance(&ours, &exact));
  print_number("error_peer", error_peer);
  print_number("height_ours", ours.height);
  print_number("height_peer", sofa.height);
  print_number("residual_peer", residual);
  compare_stopped(self, steps, &exact, error_peer);
  g_free(exact.q);
  g_free(ours.q);
  g_free(sofa.q);
}

/* Height of the lowest node, m. */
static double lowest(const End *end) {
  double y = HUGE_VAL;
  for (size_t i = 1; i < end->count; i += 3) y = fmin(y, end->q[i]);
  return y;
}

static void compare_lowest(const Case *self, unsigned steps) {
  End exact = solved(self, steps, 1e-9), ours = solved(self, steps, 1e-6);
  print_number("error_ours", distance(&ours, &exact));
  print_number("lowest_ours", lowest(&ours));
  print_number("lowest_peer", self->lowest);
  g_free(exact.q);
  g_free(ours.q);
}

/* Where the spheres are after the steps, each in `parts` of its own: contacts found anew in each. */
static End spheres_after(const Case *self, unsigned steps, unsigned parts) {
  Case finer = *self;
  if (parts > 1) finer.substeps = 1;
  Rig *rig = unbuilt(&finer, 1e-6);
  rig->description.solver.time_step /= parts;
  rig_build(rig);
  rig_run(rig->world, steps * parts);
  const SporeSpheres *spheres = spore_world_spheres(rig->world); /* one step old, the same for all */
  End end = end_of(spheres->count - spheres->static_count, spheres->centre + 3 * spheres->static_count);
  rig_free(rig);
  return end;
}

/* What contacts and time cost in accuracy: against symplectic Euler in steps of a 64th. */
static void compare_steps(const Case *self) {
  unsigned steps = MIN(self->compared, steps_at_most);
  End exact = spheres_after(self, steps, 64), ours = spheres_after(self, steps, 1);
  print_number("error_ours", distance(&ours, &exact));
  print_number("height_ours", ours.height);
  print_number("height_exact", exact.height);
  g_free(exact.q);
  g_free(ours.q);
}

static void run(const Case *self) {
  unsigned steps = MIN(self->steps, steps_at_most);
  Outcome outcome = measure(self, steps, 1e-6);
  printf("{\"case\": \"%s\", \"sofa\": \"%s\"", self->name, self->sofa);
  print_number("ours", outcome.ms);
  print_number("peer", self->sofa_ms);
  print_number("required", self->required_ms > 0 ? self->required_ms : NAN);
  print_number("hardware", hardware_ms(self, &outcome));
  print_number("dof", (double)outcome.dof);
  print_number("contacts", outcome.contacts);
  print_number("newton", outcome.newton);
  print_number("linear", outcome.linear);
  print_number("evaluations", outcome.evaluations);
  print_number("residual", outcome.residual);
  print_number("unsolved", outcome.unsolved);
  print_number("islands", (double)outcome.island_count);
  if (self->truncated) compare_truncated(self, steps);
  if (self->compared > 0) compare_steps(self);
  if (self->lowest < 0) compare_lowest(self, steps);
  printf("}\n");
  fflush(stdout);
}

/* By implicit Euler, and by explicit substeps where the case names them. */
static void run_rows(const Case *self) {
  g_autofree char *name = g_strdup_printf("%s, explicit", self->name);
  Case by_implicit = *self, by_explicit = *self;
  by_implicit.substeps = 0;
  by_explicit.name = name;
  run(&by_implicit);
  if (self->substeps > 0) run(&by_explicit);
}

static void run_all(const Case *cases, const char *prefix) {
  for (; cases->name; cases++)
    if (g_str_has_prefix(cases->name, prefix)) run_rows(cases);
}

int main(int argc, char **argv) {
  const char *prefix = "";
  for (int i = 1; i < argc; i++) {
    if (!strcmp(argv[i], "--steps") && i + 1 < argc) steps_at_most = (unsigned)strtoul(argv[++i], NULL, 10);
    else if (!strcmp(argv[i], "--repeats") && i + 1 < argc) repeats = (unsigned)strtoul(argv[++i], NULL, 10);
    else prefix = argv[i];
  }
  if (steps_at_most < 1 || repeats < 1) {
    fprintf(stderr, "bench_sofa: at least one step and one run are needed\n");
    return 2;
  }
  run_all(solid_cases, prefix);
  run_all(net_cases, prefix);
  run_all(rod_cases, prefix);
  run_all(contact_cases, prefix);
  return 0;
}
