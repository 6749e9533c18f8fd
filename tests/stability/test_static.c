/* Balance of forces in place of motion: case 38, and the branch that is taken where there are several balances. */
#include <math.h>
#include <string.h>

#include "models/common/nodal.h"
#include "tests/stability/rig.h"

#define G 9.81
#define SIDE 9         /* nodes along a side of a sheet */
#define SPACING 0.0125 /* m */
#define LENGTH 0.2     /* of a thread, m */
#define TOLERANCE 1e-10
#define NUDGE 1e-5 /* m */

/* What hangs. */
typedef struct Hanging {
  const char *name;
  SporeModel *(*make)(void);
  double radius;     /* of the pins, in spacings */
  gboolean edge;     /* held along the edge at the origin, else at two places */
  SporeVec3 ends[2]; /* one twice: at one place */
  gboolean swings;   /* past the balance that the load leads to, into another */
} Hanging;

static SporeModel *thread_of(SporeCurve *curve, double young) {
  return rig_curve_model(&spore_spline_1d, curve, "young_modulus", young, "control_points", 24.0, NULL);
}

static SporeModel *taut_thread(void) {
  SporeCurve curve;
  shape_line(&curve, 21, LENGTH, 1e-3);
  return thread_of(&curve, 1e5);
}

/* Half a circle in the plane of x and z. */
static SporeModel *make_arc(double young) {
  SporeCurve curve;
  g_assert_true(spore_curve_allocate(&curve, 21, NULL));
  for (unsigned i = 0; i < 21; i++) {
    double angle = G_PI * i / 20, radius = LENGTH / G_PI;
    spore_vec3_store(curve.points + 4 * i, spore_vec3(radius * (1 - cos(angle)), 0, radius * sin(angle)));
    curve.points[4 * i + 3] = 5e-4;
  }
  return thread_of(&curve, young);
}

static SporeModel *stiff_arc(void) { return make_arc(1e7); }
static SporeModel *soft_arc(void) { return make_arc(1e5); }

static SporeModel *make_sheet(const SporeModelType *type, gboolean level) {
  SporeTriangleMesh mesh;
  if (level) shape_level_sheet(&mesh, SIDE, SIDE, SPACING);
  else shape_sheet(&mesh, SIDE, SIDE, SPACING, TRUE);
  return rig_surface_model(type, &mesh, NULL);
}

static SporeModel *level_net(void) { return make_sheet(&spore_mass_spring_net, TRUE); }
static SporeModel *upright_net(void) { return make_sheet(&spore_mass_spring_net, FALSE); }
static SporeModel *level_sheet(void) { return make_sheet(&spore_spline_2d, TRUE); }

/* In a world of its own, from its shape at rest; level ones in the plane of x and z. */
static Rig *hang(const Hanging *hanging, SporeIntegratorKind kind, double time_step) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -G, 0);
  rig->description.solver.time_step = time_step;
  rig->description.solver.integrator = (int)kind;
  rig->description.solver.tolerance = TOLERANCE;
  rig->description.solver.sleep_speed = 0;
  rig_passive(rig, hanging->name, hanging->make(), NULL);
  for (int i = 0; i < SIDE && hanging->edge; i++)
    rig_pin(rig, 0, spore_vec3(i * SPACING, 0, 0), hanging->radius * SPACING);
  for (int end = 0; end < 2 && !hanging->edge; end++) rig_pin(rig, 0, hanging->ends[end], hanging->radius * SPACING);
  rig_build(rig);
  return rig;
}

static double diagonal_of(const double *q, size_t nodes) {
  SporeVec3 low = spore_vec3_load(q), high = low;
  for (size_t i = 1; i < nodes; i++) {
    SporeVec3 p = spore_vec3_load(q + 3 * i);
    low = spore_vec3(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
    high = spore_vec3(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
  }
  return spore_vec3_distance(low, high);
}

static double farthest(const double *a, const double *b, size_t nodes) {
  double worst = 0;
  for (size_t i = 0; i < nodes; i++)
    worst = fmax(worst, spore_vec3_distance(spore_vec3_load(a + 3 * i), spore_vec3_load(b + 3 * i)));
  return worst;
}

/* Force that is left over weight, both as the static method measures them; what is held is what has not moved. */
static double force_left(const SporeModel *model, const double *q, const double *start) {
  double *f = g_new0(double, 3 * model->block_count), *still = g_new0(double, 3 * model->block_count);
  model->type->force(model, q, q, still, f);
  double square = 0, weight = 0;
  for (size_t i = 0; i < model->node_count; i++) {
    double mass = model->block_mass[i];
    f[3 * i + 1] -= G * mass;
    if (memcmp(q + 3 * i, start + 3 * i, 3 * sizeof *q) == 0) continue;
    for (size_t k = 0; k < 3; k++) square += f[3 * i + k] * f[3 * i + k] / mass;
    weight += mass * G * G;
  }
  g_free(f);
  g_free(still);
  return sqrt(square / weight);
}

/* Where the body comes to rest, from its shape at rest or from near `from`: implicit Euler with long steps takes the
 * energy out of every motion. */
static double *settle(const Hanging *hanging, const double *from, const double *start, unsigned *steps) {
  Rig *rig = hang(hanging, SPORE_INTEGRATOR_IMPLICIT_EULER, 0.05);
  size_t count = 3 * spore_world_body_model(rig->world, 0)->block_count;
  double speed = HUGE_VAL;
  if (from) {
    double *q = g_memdup2(from, count * sizeof *q), *still = g_new0(double, count);
    GRand *random = g_rand_new_with_seed(38);
    for (size_t i = 0; i < count; i++)
      if (from[i] != start[i]) q[i] += NUDGE * g_rand_double_range(random, -1, 1);
    spore_world_set_state(rig->world, 0, q, still);
    g_rand_free(random);
    g_free(still);
    g_free(q);
  }
  for (*steps = 0; *steps < 4000 && speed > 1e-10; ++*steps) {
    spore_world_step(rig->world);
    const double *v = spore_world_v(rig->world, 0);
    speed = 0;
    for (size_t i = 0; i < count; i++) speed = fmax(speed, fabs(v[i]));
  }
  g_assert_cmpfloat(speed, <=, 1e-10);
  double *q = g_memdup2(spore_world_q(rig->world, 0), count * sizeof *q);
  rig_free(rig);
  return q;
}

/* Three steps: solved, and once balanced nothing moves. */
static void balance(const Hanging *hanging, SporeWorld *world, const double *start) {
  double residual = 0;
  size_t first = 0, later = 0;
  for (int step = 0; step < 3; step++) {
    spore_world_step(world);
    SporeStepCounts counts = spore_world_counts(world);
    residual = fmax(residual, counts.residual);
    if (step == 0) first = counts.newton_iterations;
    else later += counts.newton_iterations;
  }
  double left = force_left(spore_world_body_model(world, 0), spore_world_q(world, 0), start);
  g_test_message("case 38: %s: %zu iterations, then %zu; force left %.1e of its weight, said %.1e", hanging->name,
                 first, later, left, residual);
  g_assert_cmpuint(spore_world_unsolved_count(world), ==, 0);
  g_assert_cmpuint(spore_world_monitor(world)->recoveries, ==, 0);
  g_assert_cmpfloat(residual, <=, TOLERANCE);
  g_assert_cmpfloat(left, <=, 2 * TOLERANCE); /* the sum over what is held differs by its share */
  g_assert_cmpuint(later, ==, 0);
}

/* Case 38: to a millionth of its size, static ends where motion comes to rest; and comes back to when it is nudged, so
 * that the balance is a stable one. */
static void case_38(gconstpointer data) {
  const Hanging *hanging = data;
  unsigned steps, back_steps;
  Rig *rig = hang(hanging, SPORE_INTEGRATOR_STATIC, 0.004);
  const SporeModel *model = spore_world_body_model(rig->world, 0);
  double *start = g_memdup2(spore_world_q(rig->world, 0), model->q_count * sizeof *start);
  balance(hanging, rig->world, start);
  const double *q = spore_world_q(rig->world, 0);
  double *settled = settle(hanging, NULL, start, &steps), *back = settle(hanging, q, start, &back_steps);
  double size = diagonal_of(start, model->node_count), off = farthest(q, settled, model->node_count) / size;
  double away = farthest(q, back, model->node_count) / size;
  g_test_message("case 38: %s: moved %.2g of its size; off by %.1e from where it settles in %u steps, and by %.1e from "
                 "where it comes back to in %u",
                 hanging->name, farthest(q, start, model->node_count) / size, off, steps, away, back_steps);
  g_assert_cmpfloat(away, <, 1e-6);
  if (hanging->swings) g_assert_cmpfloat(off, >, 1e-3);
  else g_assert_cmpfloat(off, <, 1e-6);
  g_free(start);
  g_free(settled);
  g_free(back);
  rig_free(rig);
}

#define SIDES ((SIDE - 1) * SPACING)
static const Hanging cases[] = {
    {"taut-thread", taut_thread, 0.3, FALSE, {{0, 0, 0}, {LENGTH / 3, LENGTH * 2 / 3, LENGTH * 2 / 3}}, FALSE},
    {"thread-at-one-end", taut_thread, 0.3, FALSE, {{0, 0, 0}, {0, 0, 0}}, FALSE},
    {"stiff-thread", stiff_arc, 0.3, FALSE, {{0, 0, 0}, {2 * LENGTH / G_PI, 0, 0}}, FALSE},
    {"soft-thread", soft_arc, 0.3, FALSE, {{0, 0, 0}, {2 * LENGTH / G_PI, 0, 0}}, FALSE},
    {"level-net", level_net, 0.3, TRUE, {{0, 0, 0}, {0, 0, 0}}, FALSE},
    {"net-at-corners", level_net, 0.3, FALSE, {{0, 0, 0}, {SIDES, 0, 0}}, TRUE},
    {"upright-net", upright_net, 0.3, FALSE, {{0, SIDES, 0}, {SIDES, SIDES, 0}}, FALSE},
    {"level-sheet", level_sheet, 0.9, TRUE, {{0, 0, 0}, {0, 0, 0}}, FALSE},
};

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (guint i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_autofree char *path = g_strdup_printf("/static/case-38/%s", cases[i].name);
    g_test_add_data_func(path, &cases[i], case_38);
  }
  return g_test_run();
}
