/* The retrieval bag, from its scene's recorded input: an ovary is let go of in the bag, and film alone holds it. */
#include <glib.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/off.h"
#include "core/io/scene_xml.h"
#include "core/mesh/bvh.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define BAG_END_S 6.0 /* the grasper has left, and what it let go of lies still */
#define DEPTH_M 0.001 /* a film's spheres have this radius: what is no deeper has not passed */

typedef struct Run {
  SporeSchema *schema;
  SporeDocument *document;
  SporePool *pool;
  SporeSimulation *simulation;
  SporeWorld *world;
  SporeTriangleMesh film; /* of the bag, at rest */
  uint32_t bag, ovary;
} Run;

static void run_begin(Run *run) {
  GError *error = NULL;
  g_autofree char *text = NULL;
  gsize size;
  run->schema = spore_schema_new(spore_model_registry);
  run->document = spore_scene_load(run->schema, SPORE_SCENES "/bag.spore", &error);
  g_assert_no_error(error);
  run->pool = spore_pool_create(1);
  run->simulation = spore_simulation_new(run->document, run->pool, NULL, &error);
  g_assert_no_error(error);
  run->world = run->simulation->world;
  run->bag = spore_world_find_body(run->world, "bag");
  run->ovary = spore_world_find_body(run->world, "ovary");
  g_assert_true(g_file_get_contents(SPORE_SCENES "/bag/bag.off", &text, &size, &error));
  g_assert_true(spore_off_parse("bag", text, size, &run->film, &error));
}

static void run_end(Run *run) {
  spore_triangle_mesh_clear(&run->film);
  spore_simulation_free(run->simulation);
  spore_pool_free(run->pool);
  spore_document_free(run->document);
  spore_schema_free(run->schema);
}

/* Of the film, the vertex that follows each along the mouth; the others: itself. */
static void find_mouth(const SporeTriangleMesh *film, uint32_t *next) {
  for (uint32_t i = 0; i < film->vertex_count; i++) next[i] = i;
  for (size_t k = 0; k < 3 * film->triangle_count; k++) {
    uint32_t a = film->triangles[k], b = film->triangles[k / 3 * 3 + (k + 1) % 3];
    bool shared = false;
    for (size_t l = 0; !shared && l < 3 * film->triangle_count; l++)
      shared = film->triangles[l] == b && film->triangles[l / 3 * 3 + (l + 1) % 3] == a;
    if (!shared) next[a] = b;
  }
}

/* The bag as it is, with a lid over its mouth: a fan about the mouth's middle. */
static SporeBvh *closed_bag(const Run *run) {
  const SporeTriangleMesh *film = &run->film;
  size_t n = film->vertex_count, rim = 0;
  g_autofree uint32_t *next = g_new(uint32_t, n);
  find_mouth(film, next);
  for (uint32_t i = 0; i < n; i++) rim += next[i] != i;
  g_assert_cmpuint(rim, >, 2);
  SporeTriangleMesh closed;
  g_assert_true(spore_triangle_mesh_allocate(&closed, n + 1, film->triangle_count + rim, NULL));
  memcpy(closed.vertices, spore_world_q(run->world, run->bag), 3 * n * sizeof *closed.vertices);
  memcpy(closed.triangles, film->triangles, 3 * film->triangle_count * sizeof *closed.triangles);
  uint32_t *lid = closed.triangles + 3 * film->triangle_count;
  for (uint32_t i = 0; i < n; i++) {
    if (next[i] == i) continue;
    *lid++ = next[i], *lid++ = i, *lid++ = (uint32_t)n;
    for (size_t e = 0; e < 3; e++) closed.vertices[3 * n + e] += closed.vertices[3 * (size_t)i + e] / (double)rim;
  }
  SporeBvh *bvh = spore_bvh_create(&closed, NULL);
  g_assert_nonnull(bvh);
  spore_triangle_mesh_clear(&closed);
  return bvh;
}

/* How many of the ovary's spheres have their centres inside the closed bag. */
static size_t count_inside(const Run *run, size_t *all) {
  const SporeSpheres *spheres = spore_world_spheres(run->world);
  SporeBvh *bag = closed_bag(run);
  size_t inside = 0;
  *all = 0;
  for (size_t i = 0; i < spheres->count; i++) {
    if (spheres->body[i] != run->ovary) continue;
    inside += fabs(spore_bvh_winding(bag, spore_vec3_load(spheres->centre + 3 * i))) > 0.5;
    ++*all;
  }
  spore_bvh_free(bag);
  return inside;
}

/* The deepest that a sphere of the ovary is in one of the film. */
static double depth_in_film(const Run *run) {
  const SporeSpheres *spheres = spore_world_spheres(run->world);
  double depth = 0;
  for (size_t i = 0; i < spheres->count; i++)
    for (size_t k = 0; spheres->body[i] == run->ovary && k < spheres->count; k++) {
      if (spheres->body[k] != run->bag) continue;
      double apart =
          spore_vec3_distance(spore_vec3_load(spheres->centre + 3 * i), spore_vec3_load(spheres->centre + 3 * k));
      depth = fmax(depth, spheres->radius[i] + spheres->radius[k] - apart);
    }
  return depth;
}

/* Runs until then; returns how deep the ovary was in the film at most, looking 50 times a second. */
static double run_until(Run *run, double time_s) {
  double depth = 0;
  while (spore_world_time_s(run->world) < time_s) {
    for (int i = 0; i < 5; i++) spore_world_step(run->world);
    depth = fmax(depth, depth_in_film(run));
  }
  return depth;
}

static void ovary_stays_in_the_bag(void) {
  Run run = {0};
  size_t all;
  run_begin(&run);
  g_assert_cmpuint(count_inside(&run, &all), ==, 0);
  double depth = run_until(&run, BAG_END_S);
  size_t inside = count_inside(&run, &all);
  const SporeMonitor *monitor = spore_world_monitor(run.world);
  g_test_message("%zu of %zu spheres inside, at most %.2f mm deep in the film", inside, all, 1e3 * depth);
  g_assert_cmpuint(all, >=, 60);
  g_assert_cmpuint(inside, ==, all);
  g_assert_cmpfloat(depth, <, DEPTH_M);
  g_assert_cmpuint(monitor->deep_contacts + monitor->recoveries + monitor->lost_holds, ==, 0);
  SporeToolState grasper = spore_world_tool_state(run.world, 0);
  g_assert_cmpuint(grasper.held, ==, 0);
  run_end(&run);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/bag/holds-the-ovary", ovary_stays_in_the_bag);
  return g_test_run();
}
