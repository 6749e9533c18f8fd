/* Simplifies a surface with its creases, or without creases where so few vertices then come nearer to the surface; and
 * thins a closed surface as far as a limit allows. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/mesh/crossings.h"
#include "core/mesh/simplify.h"
#include "core/mesh/simplify_parts.h"

#define DEAR 1.2 /* largest ratio of the error with creases to the error without */

static size_t wanted(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options) {
  if (options->vertices > 0) return options->vertices < 4 ? 4 : options->vertices;
  double area = 0,
         one = sqrt(3) / 2 * options->size * options->size; /* area of a vertex in a mesh of equilateral triangles */
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    area += spore_vec3_length(spore_mesh_area_vector(spore_mesh_vertex(mesh->vertices, n[0]),
                                                     spore_mesh_vertex(mesh->vertices, n[1]),
                                                     spore_mesh_vertex(mesh->vertices, n[2])));
  }
  double count = area / one;
  return count < 4 ? 4 : count > 1e9 ? 1000000000 : (size_t)count;
}

/* One simplified surface, from the original, keeping what turns more than `angle`. */
typedef struct Attempt {
  SporeTriangleMesh mesh;
  SporeShellFeatures features;
  double farthest; /* m: largest distance of a vertex of the original from the result */
  size_t crossings;
  bool reached;
} Attempt;

static bool measure(const SporeTriangleMesh *original, Attempt *attempt, SporeError *error) {
  SporeBvh *bvh = spore_bvh_create(&attempt->mesh, error);
  for (size_t i = 0; bvh && i < original->vertex_count; i++)
    attempt->farthest =
        fmax(attempt->farthest, spore_bvh_distance(bvh, spore_vec3_load(original->vertices + 3 * i), NULL, NULL));
  spore_bvh_free(bvh);
  return bvh != NULL;
}

/* What is done to one surface. */
typedef struct Work {
  const SporeTriangleMesh *original;
  const SporeSimplifyOptions *options;
  size_t vertices, crossings; /* wanted; of the original */
  const SporeProgress *progress;
} Work;

static bool make(const Work *work, double angle, Attempt *made, SporeError *error) {
  SporeShell shell;
  if (!spore_shell_create(&shell, work->original)) return spore_mesh_no_memory(error);
  size_t from = shell.live;
  bool done = spore_shell_find_features(&shell, angle, &made->features) || spore_mesh_no_memory(error);
  done = done && spore_shell_collapse_to(&shell, work->vertices, NULL, work->progress, error) &&
         (shell.live == from || spore_shell_fit(&shell, work->original, work->progress, error)) &&
         spore_shell_mesh(&shell, &made->mesh, error);
  made->reached = shell.live <= work->vertices;
  spore_shell_clear(&shell);
  return done;
}

static bool attempt(const Work *work, double angle, Attempt *made, SporeError *error) {
  *made = (Attempt){.farthest = 0};
  if (!make(work, angle, made, error)) return false;
  return (spore_triangle_mesh_crossings(&made->mesh, &made->crossings, NULL) || spore_mesh_no_memory(error)) &&
         measure(work->original, made, error);
}

/* Whether keeping the creases uses up too many vertices. */
static bool is_worse(const Attempt *with, const Attempt *without) {
  if (with->crossings != without->crossings) return with->crossings > without->crossings;
  return with->reached != without->reached ? without->reached : with->farthest > DEAR * without->farthest;
}

static bool simplify(const Work *work, Attempt *best, SporeSimplifyReport *report, SporeError *error) {
  double angle = work->options->keep_angle > 0 ? work->options->keep_angle : SPORE_SIMPLIFY_KEEP_ANGLE;
  Attempt other = {0};
  if (!attempt(work, angle, best, error)) return false;
  *report = (SporeSimplifyReport){.creases = best->features.creases,
                                  .locked_edges = best->features.locked,
                                  .creases_kept = true,
                                  .crossings_before = work->crossings};
  bool done = report->creases == 0 || attempt(work, 2 * M_PI, &other, error);
  if (done && report->creases > 0 && is_worse(best, &other)) {
    Attempt swap = *best;
    *best = other, other = swap;
    report->creases_kept = false;
  }
  spore_triangle_mesh_clear(&other.mesh);
  report->reached = best->reached;
  report->crossings = best->crossings;
  return done;
}

bool spore_triangle_mesh_simplify(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options,
                                  SporeTriangleMesh *result, SporeSimplifyReport *report, const SporeProgress *progress,
                                  SporeError *error) {
  Attempt best = {0};
  Work work = {.original = mesh, .options = options, .vertices = wanted(mesh, options), .progress = progress};
  bool done = spore_triangle_mesh_crossings(mesh, &work.crossings, NULL);
  if (done) done = simplify(&work, &best, report, error);
  else spore_mesh_no_memory(error);
  if (!done) spore_triangle_mesh_clear(&best.mesh);
  *result = best.mesh;
  return done;
}

bool spore_triangle_mesh_thin(SporeTriangleMesh *mesh, const SporeSurfaceLimit *limit, const SporeProgress *progress,
                              SporeError *error) {
  SporeShell shell;
  SporeTriangleMesh thin = {0};
  if (!spore_shell_create(&shell, mesh)) return spore_mesh_no_memory(error);
  bool done = spore_shell_collapse_to(&shell, 4, limit, progress, error) && spore_shell_mesh(&shell, &thin, error);
  spore_shell_clear(&shell);
  if (!done) return false;
  spore_triangle_mesh_clear(mesh);
  *mesh = thin;
  return true;
}
