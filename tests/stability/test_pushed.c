/* What comes of scenes that the stability study pushes: a net a thousand times as stiff that an instrument pushes in is
 * solved, and contacts that do not hold fail a case unless what the program advises makes them hold. */
#include <glib.h>
#include <string.h>

#include "core/measure/stability.h"
#include "core/scene/variation.h"
#include "tests/stability/rig.h"
#include "tests/stability/scene.h"

#define STEP_S 1e-3
#define WALL 0.005 /* radius of a sphere that holds a ball, m */
#define BALL 0.02  /* m */
#define STIFF 1e4  /* N/m, of each body */
#define SLOW 0.2   /* m/s: the wall stops it */
#define FAST 5.    /* m/s: it does not, but contacts 1000 times as stiff do */
#define MISS 0.1   /* of the load: what the study counts as failed */

/* A ball that is thrown at a wall, faster where bodies are stiffer; whether contacts become stiffer where the study
 * asks for it. */
typedef struct Thrown {
  bool heeds;
  GPtrArray *rigs;
} Thrown;

static SporeModel *ball(void) {
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(2 * BALL, 2 * BALL, 2 * BALL));
  return rig_surface_model(&spore_rigid_body, &box, NULL);
}

static SporeWorld *make(void *data, const SporeStabilityChange *change, SporeError *error) {
  Thrown *thrown = data;
  Rig *rig = rig_new();
  rig->description.solver.time_step = STEP_S * change->time_step;
  double stiffness = STIFF * (thrown->heeds ? change->contact : 1);
  rig_unmovable(rig, "wall", rig_sphere(rig, WALL))->contact.stiffness = stiffness;
  SporeBodyDescription *body = rig_passive(rig, "ball", ball(), rig_sphere(rig, BALL));
  body->contact.stiffness = stiffness;
  body->pose.position = spore_vec3(0, WALL + BALL + 0.005, 0);
  body->velocity = spore_vec3(0, change->stiffness > 1 ? -FAST : -SLOW, 0);
  g_ptr_array_add(thrown->rigs, rig);
  return rig_build(rig);
}

static void drop(void *data, SporeWorld *world) {
  Thrown *thrown = data;
  for (guint i = 0; i < thrown->rigs->len; i++) {
    Rig *rig = thrown->rigs->pdata[i];
    if (rig->world != world) continue;
    rig_free(rig);
    g_ptr_array_remove_index(thrown->rigs, i);
    return;
  }
  g_assert_not_reached();
}

static bool jump(void *data, SporeWorld *world, double stiffness, double contact) { return true; }

static void test_remedy(gconstpointer data) {
  Thrown thrown = {GPOINTER_TO_INT(data), g_ptr_array_new()};
  const SporeStabilityScene scene = {&thrown, STEP_S, make, drop, jump};
  const SporeStabilityOptions options = {.quick = true, .time_s = 0.1, .most_s = 1000};
  SporeStabilityReport *report = spore_stability_study(&scene, &options, NULL);
  g_assert_nonnull(report);
  g_assert_cmpuint(thrown.rigs->len, ==, 0);
  const SporeStabilityCase *stiffer = NULL;
  for (size_t i = 0; i < report->case_count; i++) {
    const SporeStabilityCase *one = &report->cases[i];
    g_test_message("%s: %s: %s", spore_stability_verdicts[one->verdict], one->name, one->detail);
    if (strcmp(one->name, "stiffness_x1000") == 0) stiffer = one;
    else g_assert_cmpint(one->verdict, !=, SPORE_STABILITY_FAILED);
  }
  g_assert_nonnull(stiffer);
  g_assert_cmpint(stiffer->verdict, ==, thrown.heeds ? SPORE_STABILITY_RECOVERED : SPORE_STABILITY_FAILED);
  g_assert_nonnull(strstr(stiffer->detail, "ball: a contact does not hold it"));
  g_assert_cmpint(strstr(stiffer->detail, "with contacts 1000 times as stiff they hold") != NULL, ==, thrown.heeds);
  spore_stability_report_free(report);
  g_ptr_array_unref(thrown.rigs);
}

/* Such a net buckles under the probe, and a step takes up to three times the iterations that it usually may. */
static void test_net(void) {
  GError *error = NULL;
  Scene scene = scene_open(SPORE_SCENES "/plate2-tissue.spore", NULL, NULL, NULL);
  const SporeVariation variation = {.stiffness = 1e3};
  SporeSimulation *stiff = spore_variation_make(scene.document, &variation, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  rig_run(stiff->world, rig_steps(426, 350));
  g_assert_cmpuint(spore_world_monitor(stiff->world)->recoveries, >, 0);
  for (size_t i = 0; i < spore_world_unsolved_count(stiff->world); i++) {
    SporeUnsolved entry = spore_world_unsolved(stiff->world, i);
    g_test_message("%u steps, worst %g: %s", (unsigned)entry.steps, entry.worst, entry.cause);
    g_assert_cmpint(entry.kind, ==, SPORE_UNSOLVED_RESIDUAL);
    g_assert_cmpfloat(entry.worst, <, MISS);
  }
  g_assert_false(rig_any_frozen(stiff->world));
  spore_simulation_free(stiff);
  scene_close(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_data_func("/pushed/remedy_helps", GINT_TO_POINTER(true), test_remedy);
  g_test_add_data_func("/pushed/remedy_does_not", GINT_TO_POINTER(false), test_remedy);
  g_test_add_func("/pushed/net", test_net);
  return g_test_run();
}
