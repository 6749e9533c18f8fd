/* The retrieval bag, from its scene's recorded input: an ovary is let go of in the bag, which its draw-string closes
 * and carries up. Film alone holds the ovary. */
#include <glib.h>
#include <stdio.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/base/memory.h"
#include "core/io/off.h"
#include "core/io/scene_xml.h"
#include "core/mesh/bvh.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define LEFT_S 5.5     /* the grasper has left, and what it let go of lies still */
#define END_S 10.1     /* the bag has been carried up */
#define DEPTH_M 0.001  /* a film's spheres have this radius: what is no deeper has not passed */
#define LIFTED_M 0.035 /* the bag hangs up to 5 mm higher or lower where it has turned */
#define OPEN_M 0.150   /* of draw-string between the first hole of the rim and the last one, before */
#define CLOSED_M 0.055 /* and after: a third of it */
#define RING_JOINTS 10

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
  run->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  run->document = spore_scene_load(run->schema, SPORE_SCENES "/bag.spore", &error);
  g_assert_no_error(error);
  run->pool = spore_pool_create(1);
  run->simulation = spore_simulation_new(run->document, run->pool, NULL, NULL, &error);
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

/* Draw-string between the first hole of the mouth and the last one, m, of its length at rest. */
static double string_in_mouth(const Run *run) {
  double first = 1, last = 0, length = 0;
  g_autofree char *text = NULL;
  g_assert_true(g_file_get_contents(SPORE_SCENES "/bag/draw-string.curve", &text, NULL, NULL));
  g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
  double before[3], here[3];
  for (size_t i = 0, points = 0; lines[i]; i++) {
    if (sscanf(lines[i], "%lf %lf %lf", here, here + 1, here + 2) != 3) continue;
    if (points++) length += spore_vec3_distance(spore_vec3_load(before), spore_vec3_load(here));
    memcpy(before, here, sizeof here);
  }
  for (size_t i = 0; i < spore_world_link_count(run->world); i++) {
    SporeLinkState link = spore_world_link_state(run->world, i);
    if (!g_str_has_prefix(link.name, "hole_")) continue;
    first = fmin(first, link.along), last = fmax(last, link.along);
  }
  return (last - first) * length;
}

/* Middle of the ovary's spheres, m above the scene's origin. */
static double height(const Run *run) {
  const SporeSpheres *spheres = spore_world_spheres(run->world);
  double sum = 0, count = 0;
  for (size_t i = 0; i < spheres->count; i++)
    if (spheres->body[i] == run->ovary) sum += spheres->centre[3 * i + 1], count++;
  return sum / count;
}

static size_t broken_joints(const Run *run, const char *prefix) {
  size_t count = 0;
  for (size_t i = 0; i < spore_world_link_count(run->world); i++) {
    SporeLinkState link = spore_world_link_state(run->world, i);
    count += link.broken && g_str_has_prefix(link.name, prefix);
  }
  return count;
}

static void check_inside(const Run *run, double depth) {
  size_t all, inside = count_inside(run, &all);
  g_test_message("%.1f s: %zu of %zu spheres inside, at most %.2f mm deep in the film, %.1f mm up, %.1f mm of string",
                 spore_world_time_s(run->world), inside, all, 1e3 * depth, 1e3 * height(run),
                 1e3 * string_in_mouth(run));
  g_assert_cmpuint(all, >=, 60);
  g_assert_cmpuint(inside, ==, all);
  g_assert_cmpfloat(depth, <, DEPTH_M);
}

static void ovary_is_carried_in_the_bag(void) {
  Run run = {0};
  size_t all;
  run_begin(&run);
  g_assert_cmpuint(count_inside(&run, &all), ==, 0);
  double depth = run_until(&run, LEFT_S), low = height(&run);
  check_inside(&run, depth);
  g_assert_cmpfloat(string_in_mouth(&run), >, OPEN_M);
  g_assert_cmpuint(broken_joints(&run, "ring_"), ==, 0);
  SporeToolState grasper = spore_world_tool_state(run.world, 0);
  g_assert_cmpuint(grasper.held + grasper.lost, ==, 0);
  depth = run_until(&run, END_S);
  check_inside(&run, depth);
  g_assert_cmpfloat(string_in_mouth(&run), <, CLOSED_M);
  g_assert_cmpfloat(height(&run) - low, >, LIFTED_M);
  g_assert_cmpuint(broken_joints(&run, "ring_"), ==, RING_JOINTS);
  g_assert_cmpuint(broken_joints(&run, "hole_"), ==, 0);
  g_assert_false(spore_world_body_frozen(run.world, run.bag) || spore_world_body_frozen(run.world, run.ovary));
  run_end(&run);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/bag/carries-the-ovary", ovary_is_carried_in_the_bag);
  return g_test_run();
}
