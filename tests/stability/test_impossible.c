/* Requests that no step can fulfil (stability case 43): each costs a bounded multiple of what the scene costs without
 * it, counted in work and not by a clock, and is told. */
#include <glib.h>
#include <string.h>

#include "core/collide/grid_private.h"
#include "tests/stability/rig.h"
#include "tests/stability/scene.h"

#define STEPS 300
#define MULTIPLE 10
#define FEW 100 /* iterations that no step of a small body takes notice of */

/* Of STEPS steps. */
typedef struct Work {
  size_t iterations, evaluations; /* of the solvers; of forces */
  size_t pairs, contacts;         /* near pairs that are tested; terms */
  size_t most;                    /* iterations of a single step */
} Work;

static Work work_of(SporeWorld *world) {
  Work work = {0};
  for (int i = 0; i < STEPS; i++) {
    spore_world_step(world);
    SporeStepCounts counts = spore_world_counts(world);
    size_t iterations = counts.newton_iterations + counts.linear_iterations;
    work.iterations += iterations;
    work.most = MAX(work.most, iterations);
    work.evaluations += counts.force_evaluations;
    work.pairs += world->contact.grid ? world->contact.grid->pair_count : 0;
    work.contacts += counts.contacts;
  }
  return work;
}

static void assert_bounded(const char *what, Work work, Work normal, size_t spheres) {
  g_test_message("%s: %zu iterations for %zu, at most %zu a step for %zu, %zu evaluations for %zu, %zu pairs for %zu, "
                 "%zu contacts for %zu",
                 what, work.iterations, normal.iterations, work.most, normal.most, work.evaluations, normal.evaluations,
                 work.pairs, normal.pairs, work.contacts, normal.contacts);
  g_assert_cmpuint(work.most, <=, MULTIPLE * (normal.most + FEW));
  g_assert_cmpuint(work.iterations, <=, MULTIPLE * normal.iterations);
  g_assert_cmpuint(work.evaluations, <=, MULTIPLE * normal.evaluations);
  /* Where nothing is near, a step still goes over all spheres. */
  g_assert_cmpuint(work.pairs, <=, MULTIPLE * (normal.pairs + STEPS * spheres));
  g_assert_cmpuint(work.contacts, <=, MULTIPLE * (normal.contacts + STEPS * spheres));
}

typedef struct Request {
  const char *scene, *path, *property, *value;
  const char *said; /* how a message of the monitor begins */
  bool frozen;      /* the body that the message is of */
} Request;

static const Request requests[] = {
    {"plate1-ovary", "links/right_cord_1", "rest_length", "1e6", "ovary_right: frozen", true},
    {"table1-deformable", "links/right_cord_1", "rest_length", "1e6", "ovary: frozen", true},
    {"levels", "links/right_cord_1", "rest_length", "1e6", "ovary_right: frozen", true},
    {"plate1-ovary", "bodies/ovary_right", "position", "1e6 0 0", "ovary_right: frozen", true},
    {"plate1-ovary", "bodies/ovary_right", "position", "0 -1e6 1e6", "ovary_right: frozen", true},
    {"plate1-ovary", "bodies/probe/collision", "margin", "1000", "probe: its margin of 1e+03 m", false},
    {"plate1-ovary", "bodies/ovary_right/collision", "margin", "1000", "ovary_right: its margin of 1e+03 m", false},
    {"plate3-blood", "bodies/probe/collision", "margin", "1000", "probe: its margin of 1e+03 m", false},
    {"plate2-tissue", "bodies/probe/collision", "margin", "1000", "probe: its margin of 1e+03 m", false},
    {"plate1-ovary", "bodies/probe", "position", "1000 0 0", "probe: its device", false},
};

static void test_request(gconstpointer data) {
  const Request *request = data;
  g_autofree char *file = g_strdup_printf(SPORE_SCENES "/%s.spore", request->scene);
  Scene scene = scene_open(file, NULL, NULL, NULL);
  Work normal = work_of(scene.world);
  g_assert_false(rig_said(scene.world, request->said));
  scene_close(&scene);
  scene = scene_open(file, request->path, request->property, request->value);
  Work work = work_of(scene.world);
  assert_bounded(request->path, work, normal, scene.world->contact.spheres.count);
  g_assert_true(rig_said(scene.world, request->said));
  g_assert_true(rig_finite(scene.world));
  g_assert_true(!request->frozen || rig_any_frozen(scene.world));
  scene_close(&scene);
}

/* An instrument that no device holds back is put a kilometre away and back, among all spheres of the scene. */
static void test_jump(void) {
  Scene scene = scene_open(SPORE_SCENES "/plate1-ovary.spore", NULL, NULL, NULL);
  uint32_t probe = spore_world_find_body(scene.world, "probe");
  Work normal = work_of(scene.world);
  spore_world_set_device(scene.world, probe, NULL);
  double *target = scene.world->state.target_q + scene.world->bodies[probe].q_offset;
  Work work = {0};
  for (int k = 0; k < 2; k++) {
    target[0] += k ? -1000 : 1000;
    spore_world_step(scene.world);
    SporeStepCounts counts = spore_world_counts(scene.world);
    work.iterations += counts.newton_iterations + counts.linear_iterations;
    work.evaluations += counts.force_evaluations;
    work.pairs += scene.world->contact.grid->pair_count;
    work.contacts += counts.contacts;
  }
  assert_bounded("a jump", work, normal, scene.world->contact.spheres.count);
  scene_close(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  for (size_t i = 0; i < G_N_ELEMENTS(requests); i++) {
    g_autofree char *path = g_strdup_printf("/impossible/%zu/%s/%s", i, requests[i].scene, requests[i].property);
    g_test_add_data_func(path, &requests[i], test_request);
  }
  g_test_add_func("/impossible/jump", test_jump);
  return g_test_run();
}
