/* Each allocation of each part fails in turn: an error, no crash, nothing lost (the sanitizer looks). */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/spheres/bounding.h"
#include "core/generate/spheres/weighted.h"
#include "tests/mesh/shapes.h"

static const SporeProgressPart quiet = {NULL, 0, 1};

typedef struct Fixture {
  SporeTriangleMesh mesh;
  SporeSolid solid;
  SporeSamples samples;
  SporeBalls candidates;
} Fixture;

static void set_up(Fixture *f, gconstpointer data) {
  SporeRandom random = {1};
  shape_box(&f->mesh, (double[3]){-0.08, -0.08, -0.02}, (double[3]){0.08, 0.08, 0.02}, 1);
  g_assert_true(spore_solid_create(&f->solid, &f->mesh, NULL));
  g_assert_true(spore_samples_create(&f->samples, &f->solid, 2, &random, &quiet, NULL));
  g_assert_true(spore_candidates_create(&f->candidates, &f->solid, 64, &random, &quiet, NULL));
}

static void tear_down(Fixture *f, gconstpointer data) {
  spore_triangle_mesh_clear(&f->mesh);
  spore_solid_clear(&f->solid);
  spore_samples_clear(&f->samples);
  spore_balls_clear(&f->candidates);
}

static bool solid(Fixture *f, SporeError *error) {
  SporeSolid made;
  bool done = spore_solid_create(&made, &f->mesh, error);
  if (done) spore_solid_clear(&made);
  return done;
}

static bool samples(Fixture *f, SporeError *error) {
  SporeRandom random = {1};
  SporeSamples made;
  bool done = spore_samples_create(&made, &f->solid, 2, &random, &quiet, error);
  if (done) spore_samples_clear(&made);
  return done;
}

static bool candidates(Fixture *f, SporeError *error) {
  SporeRandom random = {1};
  SporeBalls made;
  bool done = spore_candidates_create(&made, &f->solid, 64, &random, &quiet, error);
  if (done) spore_balls_clear(&made);
  return done;
}

static bool cover_and_fit(Fixture *f, SporeError *error) {
  SporeBalls balls;
  if (!spore_balls_create(&balls, 2)) return spore_generate_no_memory(error);
  bool done = spore_candidates_cover(&f->candidates, &f->samples, &balls, &quiet, error) &&
              spore_spheres_fit(&f->solid, &f->samples, &f->candidates, &balls, NULL, false, 1, &quiet, error);
  spore_balls_clear(&balls);
  return done;
}

static bool costs(Fixture *f, SporeError *error) {
  SporeRandom random = {1};
  SporeCosts made;
  const double point[3] = {0.06, 0, 0};
  if (!spore_costs_create(&made, &f->solid, 1, &random, &quiet, error)) return false;
  bool done = spore_costs_add(&made, point, 1, 1e-9) || spore_generate_no_memory(error);
  spore_costs_clear(&made);
  return done;
}

/* Too small, so that there are gaps to be found and filled. */
static bool cover(Fixture *f, SporeError *error) {
  SporeBalls balls;
  double *gaps;
  size_t count;
  if (!spore_balls_create(&balls, 12)) return spore_generate_no_memory(error);
  for (size_t i = 0; i < 12; i++) {
    balls.x[i] = 0.06 * cos((double)i), balls.y[i] = 0.06 * sin((double)i), balls.r[i] = 0.026;
  }
  bool done = (spore_balls_gaps(&f->solid, &balls, 1e-3, 1e-2, 100000, &gaps, &count) &&
               spore_balls_grow_to_cover(&f->solid, &balls)) ||
              spore_generate_no_memory(error);
  if (done) g_assert_cmpuint(count, >, 0);
  spore_free(gaps);
  spore_balls_clear(&balls);
  return done;
}

static bool weigh(Fixture *f, SporeError *error) {
  SporeBalls balls;
  double weights[2], level;
  if (!spore_balls_create(&balls, 2)) return spore_generate_no_memory(error);
  spore_balls_set(&balls, 0, spore_vec3(0.06, 0, 0), 0.02);
  spore_balls_set(&balls, 1, spore_vec3(-0.06, 0, 0), 0.02);
  bool done = spore_spheres_weigh(&f->solid, &balls, (const uint8_t[2]){0}, weights, &level, 1, &quiet, error);
  spore_balls_clear(&balls);
  return done;
}

static bool measure(Fixture *f, SporeError *error) {
  double sphere[4] = {0.06, 0, 0, 0.02};
  SporeSphereSet set = {1, sphere};
  SporeSpheresReport report;
  return spore_solid_measure(&f->solid, &set, &report, &quiet, error);
}

/* A part, and how many of its allocations come before and after those that its rounds repeat; 0: it has no rounds. */
typedef struct Part {
  const char *path;
  bool (*work)(Fixture *, SporeError *);
  uint64_t before, after;
} Part;

static void fail_each(Fixture *f, gconstpointer data) {
  const Part *part = data;
  uint64_t start = spore_allocation_count();
  g_assert_true(part->work(f, NULL));
  uint64_t all = spore_allocation_count() - start;
  g_assert_cmpuint(all, <, 200);
  for (uint64_t n = 1; n <= all; n++) {
    if (part->before && n > part->before && n <= all - part->after && n % 16) continue;
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    g_assert_false(part->work(f, &error));
    spore_allocation_fail_at(0);
    g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  }
}

int main(int argc, char **argv) {
  static const Part parts[] = {
      {"/generate/spheres-memory/solid", solid},           {"/generate/spheres-memory/samples", samples},
      {"/generate/spheres-memory/candidates", candidates}, {"/generate/spheres-memory/cover-and-fit", cover_and_fit},
      {"/generate/spheres-memory/costs", costs},           {"/generate/spheres-memory/weigh", weigh, 29, 4},
      {"/generate/spheres-memory/cover", cover},           {"/generate/spheres-memory/measure", measure}};
  g_test_init(&argc, &argv, NULL);
  for (size_t i = 0; i < G_N_ELEMENTS(parts); i++)
    g_test_add(parts[i].path, Fixture, &parts[i], set_up, fail_each, tear_down);
  return g_test_run();
}
