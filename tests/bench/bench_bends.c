/* How sharply the nets of a scene bend: what spheres that follow bends would have to follow (bench_fold.c).
 *
 *   bench_bends SCENE TIME      TIME: s
 *
 * Of each net, one line: its name, its edges between two triangles, their mean length and the first sphere's radius,
 * mm, the sharpest crease at any time, degrees, and the most of all creases that are sharper than 60 degrees at once,
 * %. */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "core/author/generator.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define SHARP 60.0 /* degrees */
#define LOOK 5     /* steps */

/* From a to b, between triangles to c and to d. */
typedef struct Crease {
  guint32 a, b, c, d;
} Crease;

static GArray *find_creases(const guint32 *corners, size_t triangles) {
  GArray *creases = g_array_new(FALSE, FALSE, sizeof(Crease));
  g_autoptr(GHashTable) across = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, NULL);
  for (size_t i = 0; i < 3 * triangles; i++) {
    const guint32 *t = corners + i / 3 * 3, a = t[i % 3], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    gint64 key = (gint64)MIN(a, b) << 32 | MAX(a, b);
    gpointer other;
    if (g_hash_table_lookup_extended(across, &key, NULL, &other)) {
      Crease crease = {a, b, c, GPOINTER_TO_UINT(other)};
      g_array_append_val(creases, crease);
    } else {
      g_hash_table_insert(across, g_memdup2(&key, sizeof key), GUINT_TO_POINTER(c));
    }
  }
  return creases;
}

static SporeVec3 node(const double *q, guint32 i) { return spore_vec3_load(q + 3 * (size_t)i); }

/* Degrees; 0: flat. */
static double angle_of(const Crease *crease, const double *q) {
  SporeVec3 a = node(q, crease->a), along = spore_vec3_sub(node(q, crease->b), a);
  SporeVec3 n = spore_vec3_cross(along, spore_vec3_sub(node(q, crease->c), a));
  SporeVec3 m = spore_vec3_cross(spore_vec3_sub(node(q, crease->d), a), along);
  return atan2(spore_vec3_length(spore_vec3_cross(n, m)), spore_vec3_dot(n, m)) * 180 / G_PI;
}

static double mean_length(const GArray *creases, const double *q) {
  double sum = 0;
  for (guint i = 0; i < creases->len; i++) {
    const Crease *crease = &g_array_index(creases, Crease, i);
    sum += spore_vec3_distance(node(q, crease->a), node(q, crease->b)) / creases->len;
  }
  return sum;
}

static double radius_of(const SporeWorld *world, guint32 body) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  for (size_t i = 0; i < spheres->count; i++)
    if (spheres->body[i] == body) return spheres->radius[i];
  return 0;
}

static void measure(SporeWorld *world, guint32 body, double time_s) {
  const SporeModel *model = spore_world_body_model(world, body);
  guint32 *corners;
  size_t triangles;
  g_assert_true(model->type->skin(model, &corners, &triangles));
  g_autoptr(GArray) creases = find_creases(corners, triangles);
  double sharpest = 0, most = 0;
  spore_world_reset(world);
  double length = mean_length(creases, spore_world_q(world, body));
  while (spore_world_time_s(world) < time_s) {
    for (int i = 0; i < LOOK; i++) spore_world_step(world);
    guint sharp = 0;
    for (guint i = 0; i < creases->len; i++) {
      double angle = angle_of(&g_array_index(creases, Crease, i), spore_world_q(world, body));
      sharpest = fmax(sharpest, angle);
      sharp += angle > SHARP;
    }
    most = fmax(most, 100. * sharp / creases->len);
  }
  printf("%s %u %.2f %.2f %.0f %.1f\n", spore_world_body_name(world, body), creases->len, 1e3 * length,
         1e3 * radius_of(world, body), sharpest, most);
  spore_free(corners);
}

int main(int argc, char **argv) {
  if (argc != 3) return fprintf(stderr, "usage: bench_bends SCENE TIME\n"), 2;
  GError *error = NULL;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, argv[1], &error);
  g_assert_no_error(error);
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  for (guint32 body = 0; body < spore_world_body_count(simulation->world); body++)
    if (spore_world_body_role(simulation->world, body) == SPORE_PASSIVE &&
        g_str_equal(spore_world_body_model(simulation->world, body)->type->name, "mass_spring_net"))
      measure(simulation->world, body, g_ascii_strtod(argv[2], NULL));
  spore_simulation_free(simulation);
  spore_document_free(document);
  spore_schema_free(schema);
  return 0;
}
