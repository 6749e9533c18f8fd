/* The stability study: a scene that is sound is not called failed, a planted instability is found with the body's name,
 * limits are those of linear theory, and what was not tried is said. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/measure/stability.h"
#include "tests/sim/chain_model.h"

#define STEP_S 1e-3

/* A chain, and how its worlds are made. */
typedef struct Scene {
  ChainFields fields;
  SporeIntegratorKind integrator;
  guint bodies;
  guint alive; /* worlds that are not dropped */
} Scene;

/* 10 particles in a row, tied to their places: its fastest mode has the frequency (4 k/m + a/m)^1/2 nearly. */
static Scene sound(SporeIntegratorKind integrator) {
  return (Scene){.fields = {.count = 10,
                            .mass = 0.01,
                            .spacing = 0.01,
                            .stiffness = 1000,
                            .damping = 0.02,
                            .anchor = 100,
                            .poison_at = HUGE_VAL},
                 .integrator = integrator,
                 .bodies = 1};
}

static SporeWorld *make(void *data, const SporeStabilityChange *change, SporeError *error) {
  Scene *scene = data;
  SporeBodyDescription bodies[2];
  const char *names[] = {"chain", "other"};
  for (guint b = 0; b < scene->bodies; b++) {
    ChainFields fields = scene->fields;
    gboolean scaled = !change->every_second || b == 1;
    fields.stiffness *= scaled ? change->stiffness : 1;
    fields.mass *= scaled ? change->mass : 1;
    bodies[b] = passive_body(names[b], chain_create(fields), spore_vec3(0, 0, b));
  }
  SporeWorldDescription description = world_description(bodies, scene->bodies);
  description.gravity = spore_vec3(0, -9.81, 0);
  description.solver.time_step = CLAMP(STEP_S * change->time_step, 1e-6, 0.1);
  description.solver.integrator = scene->integrator;
  SporeWorld *world = spore_world_create(&description, NULL, error);
  scene->alive += world != NULL;
  for (guint b = 0; !world && b < scene->bodies; b++) bodies[b].model->type->destroy(bodies[b].model);
  return world;
}

static void drop(void *data, SporeWorld *world) {
  ((Scene *)data)->alive--;
  spore_world_free(world);
}

static bool jump(void *data, SporeWorld *world, double stiffness, double contact) {
  ChainFields *fields = SPORE_NEW(ChainFields);
  *fields = ((Scene *)data)->fields;
  fields->stiffness *= stiffness;
  return spore_world_post(world, &(SporeCommand){.kind = SPORE_COMMAND_RETUNE, .fields = fields});
}

static SporeStabilityReport *study(Scene *scene, SporeStabilityOptions options) {
  SporeError error = SPORE_ERROR_INIT;
  options.most_s = 1000; /* no case may depend on how fast the machine is */
  SporeStabilityScene worlds = {scene, STEP_S, make, drop, jump};
  SporeStabilityReport *report = spore_stability_study(&worlds, &options, &error);
  if (!report) g_error("%s", error.message);
  g_assert_cmpuint(scene->alive, ==, 0);
  for (size_t i = 0; i < report->case_count; i++)
    g_test_message("%s: %s: %s", spore_stability_verdicts[report->cases[i].verdict], report->cases[i].name,
                   report->cases[i].detail);
  return report;
}

static const SporeStabilityCase *find(const SporeStabilityReport *report, const char *name) {
  for (size_t i = 0; i < report->case_count; i++)
    if (strcmp(report->cases[i].name, name) == 0) return &report->cases[i];
  return NULL;
}

static gboolean is_left_out(const SporeStabilityReport *report, const char *what, const char *why) {
  for (size_t i = 0; i < report->left_out_count; i++)
    if (strstr(report->left_out[i].what, what) && strstr(report->left_out[i].why, why)) return TRUE;
  return FALSE;
}

/* All cases, by all methods. */
static void test_sound(void) {
  Scene scene = sound(SPORE_INTEGRATOR_IMPLICIT_EULER);
  scene.bodies = 2;
  SporeStabilityReport *report = study(&scene, (SporeStabilityOptions){.time_s = 0.1});
  g_assert_cmpuint(spore_stability_count(report, SPORE_STABILITY_FAILED), ==, 0);
  g_assert_cmpint(find(report, "as_written")->verdict, ==, SPORE_STABILITY_STABLE);
  g_assert_nonnull(find(report, "mass_ratio"));
  g_assert_nonnull(find(report, "start_point"));
  g_assert_cmpuint(report->steps, ==, 100);
  g_assert_cmpuint(report->limit_count, ==, 2 * SPORE_INTEGRATOR_STATIC);
  g_assert_true(is_left_out(report, "input that is not a number", "no instrument"));
  spore_stability_report_free(report);
}

static void test_limits(void) {
  Scene scene = sound(SPORE_INTEGRATOR_IMPLICIT_EULER);
  scene.fields.damping = 0;
  SporeStabilityReport *report = study(&scene, (SporeStabilityOptions){.time_s = 0.01});
  double frequency = 0;
  /* Of n particles with free ends, the eigenvalues are 2 k/m (1 - cos(pi j / n)) + a/m, j = 0..n-1. */
  frequency = sqrt((2 * 1000 * (1 - cos(G_PI * 9 / 10)) + 100) / 0.01);
  for (size_t i = 0; i < report->limit_count; i++) {
    const SporeStabilityLimit *limit = &report->limits[i];
    g_test_message("%s: predicted %g, safe %g, unsafe %g", spore_integrator_names[limit->method], limit->predicted_s,
                   limit->found.safe_s, limit->found.unsafe_s);
    double analytic = limit->method == SPORE_INTEGRATOR_RK4                ? 2 * sqrt(2) / frequency
                      : limit->method == SPORE_INTEGRATOR_VERLET           ? 2 / frequency
                      : limit->method == SPORE_INTEGRATOR_SYMPLECTIC_EULER ? 2 / frequency
                      : limit->method == SPORE_INTEGRATOR_POSITION_BASED
                          ? 2 / frequency /* nothing here is met by a sweep */
                          : 0;
    g_assert_cmpint(limit->own, ==, limit->method == SPORE_INTEGRATOR_IMPLICIT_EULER);
    if (analytic > 0) {
      g_assert_cmpfloat_with_epsilon(limit->predicted_s, analytic, 0.01 * analytic);
      g_assert_cmpfloat_with_epsilon(limit->found.safe_s, analytic, 0.05 * analytic);
      g_assert_cmpfloat_with_epsilon(limit->found.unsafe_s, analytic, 0.05 * analytic);
    } else if (limit->method == SPORE_INTEGRATOR_EXPLICIT_EULER) { /* without damping no step is safe */
      g_assert_cmpfloat(limit->predicted_s, ==, 0);
      g_assert_cmpfloat(limit->found.safe_s, <, 0.05 / frequency);
    } else {
      g_assert_true(isinf(limit->predicted_s) && isinf(limit->found.unsafe_s));
      g_assert_cmpfloat(limit->found.safe_s, ==, SPORE_STABILITY_LARGEST_STEP_S);
    }
  }
  spore_stability_report_free(report);
}

/* Damping below 0 feeds energy into what moves: the planted fault. */
static void test_planted(void) {
  Scene scene = sound(SPORE_INTEGRATOR_IMPLICIT_EULER);
  scene.fields.damping = -0.5;
  SporeStabilityReport *report = study(&scene, (SporeStabilityOptions){.quick = true});
  const SporeStabilityCase *written = find(report, "as_written");
  g_assert_cmpint(written->verdict, ==, SPORE_STABILITY_FAILED);
  g_assert_true(g_str_has_prefix(written->detail, "chain: "));
  g_assert_nonnull(strstr(written->detail, "energy"));
  spore_stability_report_free(report);
}

/* Forces that are no numbers: the body is frozen, and named with the cause. */
static void test_not_finite(void) {
  Scene scene = sound(SPORE_INTEGRATOR_IMPLICIT_EULER);
  scene.fields.poison_at = -1;
  SporeStabilityReport *report = study(&scene, (SporeStabilityOptions){.quick = true, .time_s = 0.02});
  const SporeStabilityCase *written = find(report, "as_written");
  g_assert_cmpint(written->verdict, ==, SPORE_STABILITY_FAILED);
  g_assert_true(g_str_has_prefix(written->detail, "chain: it stands still"));
  g_assert_cmpint(report->limits[0].beyond, ==, SPORE_METHOD_NOT_SOLVED);
  g_assert_cmpfloat(report->limits[0].found.safe_s, ==, 0);
  spore_stability_report_free(report);
}

/* An explicit scene: what is refused with its limit did not fail, and the map shows where. */
static void test_map(void) {
  Scene scene = sound(SPORE_INTEGRATOR_SYMPLECTIC_EULER);
  SporeStabilityReport *report = study(&scene, (SporeStabilityOptions){.quick = true, .map = true});
  const SporeStabilityMap *map = &report->map;
  g_assert_cmpint(find(report, "time_step_x4")->verdict, ==, SPORE_STABILITY_REFUSED);
  g_assert_nonnull(strstr(find(report, "time_step_x4")->detail, "expected at most"));
  g_assert_cmpuint(map->columns, ==, 5);
  g_assert_cmpuint(map->rows, ==, 3);
  g_assert_cmpfloat(map->time_step_s[2], ==, STEP_S);
  g_assert_cmpint(map->cells[1][2], ==, SPORE_STABILITY_STABLE);
  g_assert_cmpint(map->cells[1][4], ==, SPORE_STABILITY_REFUSED);
  g_assert_cmpint(map->cells[2][0], ==, SPORE_STABILITY_STABLE);
  g_assert_cmpfloat_with_epsilon(map->limit_s[1], report->limits[0].predicted_s, 1e-9);
  g_assert_cmpfloat(map->limit_s[2], <, 0.2 * map->limit_s[1]);
  SporeError error = SPORE_ERROR_INIT;
  char *svg = spore_stability_map_svg(report, "a & b", &error);
  g_assert_nonnull(svg);
  g_assert_nonnull(strstr(svg, "a &amp; b"));
  g_assert_nonnull(strstr(svg, "chain, symplectic_euler"));
  guint circles = 0, stable = 0;
  for (const char *at = strstr(svg, "<circle r=\"6\""); at; at = strstr(at + 1, "<circle r=\"6\"")) circles++;
  for (size_t r = 0; r < map->rows; r++)
    for (size_t c = 0; c < map->columns; c++) stable += map->cells[r][c] == SPORE_STABILITY_STABLE;
  g_assert_cmpuint(circles, ==, stable + 1); /* and the legend's */
  spore_free(svg);
  spore_stability_report_free(report);
}

static void test_no_map(void) {
  SporeStabilityReport report = {0};
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_stability_map_svg(&report, "", &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
}

/* Where there is no time for more, it is said of each thing. */
static void test_no_time(void) {
  Scene scene = sound(SPORE_INTEGRATOR_IMPLICIT_EULER);
  SporeStabilityScene worlds = {&scene, STEP_S, make, drop, jump};
  const SporeStabilityOptions options = {.quick = true, .map = true, .most_s = 1e-9};
  SporeStabilityReport *report = spore_stability_study(&worlds, &options, NULL);
  g_assert_nonnull(report);
  g_assert_cmpuint(report->case_count, ==, 0);
  g_assert_cmpuint(report->limit_count, ==, 0);
  g_assert_true(is_left_out(report, "as written", "no time"));
  g_assert_true(is_left_out(report, "largest step of chain by implicit_euler", "no time"));
  g_assert_true(is_left_out(report, "15 cells of the map", "no time"));
  spore_stability_report_free(report);
}

static bool end_at_once(void *data, double fraction, const char *stage) {
  g_assert_cmpfloat(fraction, <=, 1);
  return --*(int *)data > 0;
}

static void test_cancelled(void) {
  for (int calls = 1; calls < 12; calls += 3) {
    Scene scene = sound(SPORE_INTEGRATOR_SYMPLECTIC_EULER);
    int left = calls;
    SporeError error = SPORE_ERROR_INIT;
    const SporeProgress progress = {.report = end_at_once, .data = &left};
    SporeStabilityScene worlds = {&scene, STEP_S, make, drop, jump};
    const SporeStabilityOptions options = {.quick = true, .most_s = 1000, .progress = &progress};
    g_assert_null(spore_stability_study(&worlds, &options, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpuint(scene.alive, ==, 0);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/stability/sound", test_sound);
  g_test_add_func("/stability/limits", test_limits);
  g_test_add_func("/stability/planted", test_planted);
  g_test_add_func("/stability/not_finite", test_not_finite);
  g_test_add_func("/stability/map", test_map);
  g_test_add_func("/stability/no_map", test_no_map);
  g_test_add_func("/stability/no_time", test_no_time);
  g_test_add_func("/stability/cancelled", test_cancelled);
  return g_test_run();
}
