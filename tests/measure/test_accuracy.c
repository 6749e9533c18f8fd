/* The accuracy study tells the truth: errors against its reference are errors against closed solutions, orders are
 * those of the methods, and a method that is broken is found, whether it is a point or the reference itself. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/accuracy.h"
#include "tests/stability/rig.h"
#include "tests/sim/chain_model.h"

#define FREQUENCY 20. /* rad/s */
#define BROKEN SPORE_INTEGRATOR_BDF2
#define BROKEN_PART 0.97 /* of its step, that the broken method really goes */

#define DIVERGENCE 70.  /* 1/s: 1e-8 grows to 1e-2 in the stretch */
#define COARSE_PART 0.9 /* of gravity: an error that no step mends */

#define REST_STIFFNESS 4000. /* N/m, of either of the two that touch */
#define REST_DAMPING 120.    /* N s/m */

/* What worlds are made of. */
typedef struct Case {
  void (*describe)(Rig *rig);
  GHashTable *rigs; /* world -> Rig */
  gboolean broken;  /* BROKEN goes less far than it says */
  guint made, dropped;
} Case;

/* Two masses, each on a spring of its own, that begin to fall at time 0. */
static void describe_springs(Rig *rig) {
  ChainFields fields = {
      .count = 2, .mass = 0.5, .spacing = 0.1, .anchor = 0.5 * FREQUENCY * FREQUENCY, .poison_at = HUGE_VAL};
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig_passive(rig, "body", chain_create(fields), NULL);
}

static SporeVec3 spring_place(SporeVec3 rest, double t) {
  double fall = -9.81 / (FREQUENCY * FREQUENCY) * (1 - cos(FREQUENCY * t));
  return spore_vec3_add(rest, spore_vec3(0, fall, 0));
}

#define TOP_WIDTH 0.1
#define TOP_HEIGHT 0.2
static const SporeVec3 top_spin = {3, 0, 8};

/* A box of square section that turns freely. */
static void describe_top(Rig *rig) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(TOP_WIDTH, TOP_WIDTH, TOP_HEIGHT));
  rig_passive(rig, "body", rig_surface_model(&spore_rigid_body, &mesh, "mass", 1.0, NULL), NULL)->spin = top_spin;
}

/* A free symmetric top turns about its axis, and with that axis about its angular momentum, both steadily (Goldstein,
 * Classical Mechanics, section 5.6). */
static SporeVec3 top_place(SporeVec3 rest, double t) {
  double across = (TOP_WIDTH * TOP_WIDTH + TOP_HEIGHT * TOP_HEIGHT) / 12, along = TOP_WIDTH * TOP_WIDTH / 6;
  SporeVec3 momentum = {across * top_spin.x, across * top_spin.y, along * top_spin.z};
  SporeQuat own = spore_quat_from_rotation_vector(spore_vec3(0, 0, (1 - along / across) * top_spin.z * t));
  SporeQuat about = spore_quat_from_rotation_vector(spore_vec3_scale(t / across, momentum));
  return spore_quat_rotate(about, spore_quat_rotate(own, rest));
}

static SporeWorld *make(void *data, const SporeAccuracyWorld *wanted, SporeError *error) {
  Case *test = data;
  Rig *rig = rig_new();
  test->describe(rig);
  SporeSolverFields *solver = &rig->description.solver;
  solver->sleep_speed = 0;
  solver->tolerance = wanted->tolerance > 0 ? wanted->tolerance : 1e-10;
  solver->time_step = wanted->dt_s > 0 ? wanted->dt_s : 1e-3;
  if (wanted->method) solver->integrator = (int)wanted->method->integrator;
  if (test->broken && wanted->method && wanted->method->integrator == BROKEN) solver->time_step *= BROKEN_PART;
  for (guint i = 0; i < rig->bodies->len && wanted->spheres > 0; i++)
    g_array_index(rig->bodies, SporeBodyDescription, i).contact.stiffness *= wanted->spheres;
  if (wanted->level == SPORE_LOD_COARSE) rig->description.gravity.y *= COARSE_PART;
  SporeWorld *world = rig_try_build(rig, error);
  if (world) g_hash_table_insert(test->rigs, world, rig);
  else rig_free(rig);
  test->made += world != NULL;
  return world;
}

static void drop(void *data, SporeWorld *world) {
  Case *test = data;
  test->dropped++;
  rig_free(g_hash_table_lookup(test->rigs, world));
  g_hash_table_remove(test->rigs, world);
}

static SporeAccuracyReport *study(Case *test, const SporeAccuracyMethod *methods, size_t count, SporeError *error) {
  const SporeAccuracyScene scene = {test, make, drop, FALSE, {SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1}, 1e-3};
  const SporeAccuracyOptions options = {.methods = methods,
                                        .method_count = count,
                                        .dt_low_s = 5e-4,
                                        .dt_high_s = 4e-3,
                                        .dt_count = 4,
                                        .time_s = 0.2,
                                        .repeats = 2,
                                        .full = TRUE}; /* so that no clock has a say */
  test->rigs = g_hash_table_new(NULL, NULL);
  SporeAccuracyReport *report = spore_accuracy_study(&scene, &options, error);
  g_assert_cmpuint(test->made, ==, test->dropped);
  g_hash_table_unref(test->rigs);
  return report;
}

/* Error of a run by a method and step against the closed solution. */
static double exact_error(Case *test, const SporeAccuracyReport *report, const SporeAccuracyPoint *point,
                          SporeVec3 (*place)(SporeVec3, double)) {
  const SporeAccuracyWorld wanted = {
      .method = &report->methods[point->method].method, .level = -1, .dt_s = point->dt_s};
  const SporeTrialSettings settings = {
      .interval_s = report->interval_s,
      .samples = (size_t)round(report->time_s / report->interval_s),
      .dt_s = point->dt_s,
  };
  SporeTrialPoints points;
  SporeTrial ran;
  test->rigs = g_hash_table_new(NULL, NULL);
  SporeWorld *world = make(test, &wanted, NULL);
  g_assert_true(spore_trial_points_choose(&points, world, SPORE_NO_BODY, NULL));
  g_assert_true(spore_trial_run(&ran, world, &points, &settings, NULL));
  drop(test, world);
  g_hash_table_unref(test->rigs);
  SporeTrial exact = ran;
  exact.positions = g_new(double, 3 * ran.samples * ran.points);
  for (size_t i = 0; i < ran.samples * ran.points; i++)
    spore_vec3_store(exact.positions + 3 * i, place(spore_vec3_load(points.bodies[0].rest + 3 * (i % ran.points)),
                                                    (double)(i / ran.points) * settings.interval_s));
  double error = spore_trial_difference(&points, &ran, &exact).rms;
  g_free(exact.positions);
  spore_trial_clear(&ran);
  spore_trial_points_clear(&points);
  return error;
}

static const SporeAccuracyMethod all[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1},
                                          {SPORE_INTEGRATOR_TR_BDF2, -1, -1},
                                          {SPORE_INTEGRATOR_SYMPLECTIC_EULER, -1, -1},
                                          {SPORE_INTEGRATOR_RK4, -1, -1}};

static void assert_true_errors(Case *test, SporeVec3 (*place)(SporeVec3, double)) {
  SporeError error = SPORE_ERROR_INIT;
  SporeAccuracyReport *report = study(test, all, G_N_ELEMENTS(all), &error);
  if (!report) g_error("%s", error.message);
  g_assert_cmpuint(report->point_count, ==, 16);
  g_assert_true(report->reference.agreed);
  g_assert_false(report->chaotic);
  for (size_t i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    double exact = exact_error(test, report, point, place);
    g_assert_true(point->stable);
    g_assert_cmpfloat(fabs(exact - point->error), <=, 2 * report->reference.own_error + 1e-9);
    if (point->resolved) g_assert_cmpfloat(fabs(exact - point->error), <=, 0.2 * exact);
  }
  spore_accuracy_report_free(report);
}

static void test_springs(void) {
  Case test = {.describe = describe_springs};
  assert_true_errors(&test, spring_place);
}

static void test_top(void) {
  Case test = {.describe = describe_top};
  assert_true_errors(&test, top_place);
}

/* Orders, the Pareto set, and the sentence. */
static void test_orders(void) {
  Case test = {.describe = describe_springs};
  SporeAccuracyReport *report = study(&test, all, 3, NULL);
  const double orders[] = {1, 2, 1};
  size_t pareto = 0;
  for (size_t m = 0; m < 3; m++) {
    g_assert_cmpfloat_with_epsilon(report->methods[m].order, orders[m], 0.2);
    g_assert_true(report->methods[m].converges);
  }
  for (size_t i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    pareto += point->pareto;
    g_assert_cmpfloat(point->us_per_step, >, 0);
    g_assert_cmpuint(point->repeats, >=, 1);
    if (!point->pareto) continue;
    for (size_t k = 0; k < report->point_count; k++)
      g_assert_false(report->points[k].resolved && report->points[k].error < point->error &&
                     report->points[k].cost < point->cost);
  }
  g_assert_cmpuint(pareto, >, 0);
  g_assert_true(g_str_has_prefix(report->sentence, "implicit_euler at 1 ms: "));
  char *svg = spore_accuracy_svg(report, "springs", NULL);
  g_assert_nonnull(strstr(svg, "symplectic_euler"));
  spore_free(svg);
  spore_accuracy_report_free(report);
}

/* A coarse level has an error of its own; the finest level is what errors are measured from. */
static void test_levels(void) {
  const int levels[] = {SPORE_LOD_COARSE, SPORE_LOD_FINE};
  Case test = {.describe = describe_springs, .rigs = g_hash_table_new(NULL, NULL)};
  const SporeAccuracyScene scene = {&test, make, drop, FALSE, {SPORE_INTEGRATOR_RK4, -1, -1}, 1e-3};
  const SporeAccuracyOptions options = {
      .methods = all, .method_count = 2, .levels = levels, .level_count = 2, .time_s = 0.1, .full = TRUE};
  SporeAccuracyReport *report = spore_accuracy_study(&scene, &options, NULL);
  g_assert_cmpuint(report->level_count, ==, 2);
  g_assert_cmpfloat(report->levels[0].error, >, 100 * report->levels[1].error);
  for (size_t i = 0; i < report->point_count; i++)
    if (report->points[i].level == SPORE_LOD_COARSE && report->points[i].method == 1)
      g_assert_cmpfloat_with_epsilon(report->points[i].error, report->levels[0].error, 0.1 * report->levels[0].error);
  /* One more world is judged as the points were. */
  for (size_t i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    const SporeAccuracyWorld world = {
        .method = &report->methods[point->method].method, .level = point->level, .dt_s = point->dt_s};
    SporeAccuracyPoint again;
    g_assert_true(spore_accuracy_measure_more(report, &world, FALSE, &again, NULL));
    g_assert_cmpfloat(again.error, ==, point->error);
    g_assert_cmpint(again.stable, ==, point->stable);
    g_assert_cmpfloat(again.cost, >, 0);
  }
  spore_accuracy_report_free(report);
  g_assert_cmpuint(test.made, ==, test.dropped);
  g_hash_table_unref(test.rigs);
}

/* A ball that comes to rest on a floor. Its spheres' number stands here for the stiffness of the contact. */
static void describe_rest(Rig *rig) {
  const SporeContactFields contact = {.stiffness = REST_STIFFNESS, .damping = REST_DAMPING};
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.1, 0.1, 0.1));
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  SporeModel *model = rig_surface_model(&spore_rigid_body, &cube, "mass", 0.5, NULL);
  SporeBodyDescription *ball = rig_passive(rig, "ball", model, rig_sphere(rig, 0.05));
  ball->pose.position = spore_vec3(0, 0.05, 0);
  ball->contact = contact;
  SporeBodyDescription *floor = rig_unmovable(rig, "floor", rig_sphere(rig, 100));
  floor->pose.position = spore_vec3(0, -100, 0);
  floor->contact = contact;
}

static SporeAccuracyReport *study_spheres(void (*describe)(Rig *rig), const double *factors, size_t count) {
  Case test = {.describe = describe, .rigs = g_hash_table_new(NULL, NULL)};
  const SporeAccuracyScene scene = {&test, make, drop, FALSE, {SPORE_INTEGRATOR_RK4, -1, -1}, 1e-3};
  const SporeAccuracyOptions options = {.methods = all,
                                        .method_count = 2,
                                        .spheres = factors,
                                        .sphere_count = count,
                                        .dt_low_s = 5e-4,
                                        .dt_high_s = 2e-3,
                                        .dt_count = 3,
                                        .time_s = 1,
                                        .full = TRUE};
  SporeError error = SPORE_ERROR_INIT;
  SporeAccuracyReport *report = spore_accuracy_study(&scene, &options, &error);
  if (!report) g_error("%s", error.message);
  g_assert_cmpuint(test.made, ==, test.dropped);
  g_hash_table_unref(test.rigs);
  return report;
}

/* At rest the force is the weight, whatever gives it; the depth is the weight over the stiffness. */
static void test_spheres(void) {
  static const double factors[] = {1, 2, 4};
  SporeAccuracyReport *report = study_spheres(describe_rest, factors, 3);
  g_assert_cmpuint(report->sphere_count, ==, 3);
  for (size_t i = 0; i < 3; i++) {
    const SporeAccuracySpheres *spheres = &report->spheres[i];
    g_test_message("%g: force %g, depth %g, places %g", spheres->factor, spheres->force, spheres->depth,
                   spheres->error);
    g_assert_cmpuint(spheres->count, ==, 2);
    g_assert_cmpfloat_with_epsilon(spheres->depth, factors[2] / factors[i] - 1, 0.1);
    g_assert_cmpfloat(spheres->force, <, 0.2); /* while it comes to rest */
  }
  g_assert_cmpfloat(report->spheres[2].depth, <, 0.01); /* the depth is that when a step began */
  g_assert_cmpfloat(report->spheres[2].force, <, report->spheres[1].force);
  spore_accuracy_report_free(report);
}

/* Without contacts there is nothing to tell of them, and places do not depend on spheres. */
static void test_spheres_apart(void) {
  static const double factors[] = {1, 2};
  SporeAccuracyReport *report = study_spheres(describe_springs, factors, 2);
  g_assert_true(isnan(report->spheres[0].force) && isnan(report->spheres[0].depth));
  g_assert_cmpfloat(report->spheres[0].error, ==, 0);
  spore_accuracy_report_free(report);
}

/* A method that does not go as far as it says has an error that no step lowers. */
static void test_broken_point(void) {
  const SporeAccuracyMethod methods[] = {all[1], all[3], {BROKEN, -1, -1}};
  Case test = {.describe = describe_springs, .broken = TRUE};
  SporeAccuracyReport *report = study(&test, methods, 3, NULL);
  g_assert_cmpstr(report->methods[report->reference.method].label, !=, "bdf2");
  g_assert_cmpfloat(report->methods[2].order, <, 0.3);
  g_assert_false(report->methods[2].converges);
  g_assert_true(report->methods[0].converges);
  spore_accuracy_report_free(report);
}

/* A broken method that converges, to what is wrong, may be taken as the reference: then the second method tells. */
static void test_broken_reference(void) {
  const SporeAccuracyMethod methods[] = {{BROKEN, -1, -1}, all[0]};
  Case test = {.describe = describe_springs, .broken = TRUE};
  SporeAccuracyReport *report = study(&test, methods, 2, NULL);
  g_assert_cmpstr(report->methods[report->reference.method].label, ==, "bdf2");
  g_assert_false(report->reference.agreed);
  g_assert_cmpfloat(report->reference.own_error, >, 1e-3);
  for (size_t i = 0; i < report->point_count; i++) g_assert_false(report->points[i].pareto);
  spore_accuracy_report_free(report);
}

/* Masses on springs that push them away: what lies nearly the same at the start lies far apart at the end. */
static void describe_divergence(Rig *rig) {
  ChainFields fields = {
      .count = 2, .mass = 0.5, .spacing = 0.1, .anchor = -0.5 * DIVERGENCE * DIVERGENCE, .poison_at = HUGE_VAL};
  rig_passive(rig, "body", chain_create(fields), NULL);
}

static void test_chaos(void) {
  const SporeAccuracyMethod methods[] = {all[2], all[3]};
  Case test = {.describe = describe_divergence};
  SporeError error = SPORE_ERROR_INIT;
  SporeAccuracyReport *report = study(&test, methods, 2, &error);
  if (!report) g_error("%s", error.message);
  g_assert_true(report->chaotic && report->statistics);
  g_assert_cmpfloat(report->growth, >, 1e-3);
  g_assert_cmpfloat(report->spread, >, 0);
  g_assert_cmpfloat(report->floor, >=, 2 * report->spread);
  spore_accuracy_report_free(report);
}

/* Forces that are not numbers from the start on: no step is stable, so that nothing can be a reference. */
static void describe_poison(Rig *rig) {
  ChainFields fields = {.count = 2, .mass = 0.5, .spacing = 0.1, .anchor = 200, .poison_at = -1};
  rig_passive(rig, "body", chain_create(fields), NULL);
}

static void test_nothing_converges(void) {
  Case test = {.describe = describe_poison};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(study(&test, all, 2, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_NUMERICAL);
  g_assert_nonnull(strstr(error.message, "no reference converges"));
}

/* Explicit Euler makes energy in every step of undamped springs: the world refuses it, and the study says why. */
static void test_refused(void) {
  const SporeAccuracyMethod methods[] = {{SPORE_INTEGRATOR_EXPLICIT_EULER, -1, -1}, all[1], all[3]};
  Case test = {.describe = describe_springs};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(study(&test, methods, 1, &error));
  g_assert_nonnull(strstr(error.message, "explicit_euler"));
  SporeAccuracyReport *report = study(&test, methods, 3, NULL);
  g_assert_cmpuint(report->point_count, ==, 8);
  gboolean said = FALSE;
  for (size_t i = 0; i < report->cut_count; i++) said |= g_str_has_prefix(report->cuts[i], "explicit_euler: ");
  g_assert_true(said);
  spore_accuracy_report_free(report);
}

static bool ask(void *data) { return --*(int *)data < 0; }

/* Wherever it is cancelled, it ends and drops every world. */
static void test_cancelled(void) {
  for (int after = 0; after < 40; after += 3) {
    int left = after;
    const SporeCancel cancel = {ask, &left};
    Case test = {.describe = describe_springs, .rigs = g_hash_table_new(NULL, NULL)};
    const SporeAccuracyScene scene = {&test, make, drop, FALSE, {SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1}, 1e-3};
    const SporeAccuracyOptions options = {
        .methods = all, .method_count = 2, .time_s = 0.05, .repeats = 1, .cancel = &cancel};
    SporeError error = SPORE_ERROR_INIT;
    g_assert_null(spore_accuracy_study(&scene, &options, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpuint(test.made, ==, test.dropped);
    g_hash_table_unref(test.rigs);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/accuracy/springs", test_springs);
  g_test_add_func("/accuracy/top", test_top);
  g_test_add_func("/accuracy/orders", test_orders);
  g_test_add_func("/accuracy/levels", test_levels);
  g_test_add_func("/accuracy/spheres", test_spheres);
  g_test_add_func("/accuracy/spheres_apart", test_spheres_apart);
  g_test_add_func("/accuracy/broken_point", test_broken_point);
  g_test_add_func("/accuracy/broken_reference", test_broken_reference);
  g_test_add_func("/accuracy/chaos", test_chaos);
  g_test_add_func("/accuracy/nothing_converges", test_nothing_converges);
  g_test_add_func("/accuracy/refused", test_refused);
  g_test_add_func("/accuracy/cancelled", test_cancelled);
  return g_test_run();
}
