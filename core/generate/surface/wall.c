/* Hollow organs: the inner surface at a given depth, and the closed surface around the wall. */
#include "core/generate/surface/surface.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/mesh/isosurface.h"
#include "core/mesh/simplify.h"

#define FINEST 0.01        /* of the diagonal: largest step of the lattice, unless the wall is thinner */
#define OFF 0.5            /* of the thickness over the detail: largest error, on the lattice and of what replaces it */
#define SPACING (1.0 / 3)  /* of the thickness: between the points at which that error is checked */
#define MEASURED (1.0 / 6) /* of the thickness: between the points at which the error is reported */
#define CELL 0.25          /* of the thickness: side of the cubes by which depths are found */
#define MOST_PARTS 32      /* of a side, for the report */
#define TRIANGLES_A_REPORT 256
#define SEARCHES 20000 /* places at which the depth is sampled to find the deepest */

typedef struct Depth {
  const SporeBvh *bvh;
  SporeDepthCells *cells;
  double thickness;
  SporeBvhKnown known;
} Depth;

/* Negative in the lumen. */
static double beyond_wall(void *data, SporeVec3 place) {
  Depth *depth = data;
  depth->known = spore_depth_cells_beside(depth->cells, place, &depth->known);
  return depth->thickness - depth->known.depth;
}

/* The deepest point of a lattice over the box. */
static double find_deepest(const SporeBvh *bvh, const SporeMeshReport *box, SporeVec3 *place) {
  int each = (int)cbrt(SEARCHES);
  double deepest = -HUGE_VAL;
  for (int n = 0; n < each * each * each; n++) {
    const int at[3] = {n % each, n / each % each, n / each / each};
    double x[3];
    for (int e = 0; e < 3; e++) x[e] = box->lower[e] + (at[e] + 0.5) / each * (box->upper[e] - box->lower[e]);
    double depth = spore_bvh_depth(bvh, spore_vec3_load(x));
    if (depth > deepest) deepest = depth, *place = spore_vec3_load(x);
  }
  return deepest;
}

static bool refuse(const SporeBvh *bvh, const SporeMeshReport *box, double thickness, SporeError *error) {
  SporeVec3 place = {0, 0, 0};
  double deepest = find_deepest(bvh, box, &place);
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("a wall of %g m leaves no lumen: the deepest place found lies %g m below the surface, at (%g "
        "%g %g) m; a thinner wall was expected; ask for less than that"),
      thickness, deepest, place.x, place.y, place.z);
}

static bool go_on(const SporeProgress *progress, double fraction, SporeError *error) {
  return spore_progress_step(progress, fraction, _("measuring the distance"), error);
}

/* Distances from the outer surface, at vertices and centroids of triangles. */
static bool measure_outer(const SporeTriangleMesh *outer, const SporeBvh *inner, SporeWallReport *report,
                          const SporeProgress *progress, SporeError *error) {
  double area = 0;
  report->thickness_min = HUGE_VAL;
  for (size_t t = 0; t < outer->triangle_count; t++) {
    if (t % TRIANGLES_A_REPORT == 0 && !go_on(progress, 0.5 * (double)t / (double)outer->triangle_count, error))
      return false;
    SporeVec3 p[3], middle = {0, 0, 0};
    for (size_t k = 0; k < 3; k++) {
      p[k] = spore_mesh_vertex(outer->vertices, outer->triangles[3 * t + k]);
      middle = spore_vec3_add_scaled(middle, 1.0 / 3, p[k]);
    }
    double at = spore_bvh_distance(inner, middle, NULL, NULL), corner = spore_bvh_distance(inner, p[0], NULL, NULL);
    double size = spore_vec3_length(spore_mesh_area_vector(p[0], p[1], p[2]));
    report->thickness_min = fmin(report->thickness_min, fmin(at, corner));
    report->thickness_max = fmax(report->thickness_max, fmax(at, corner));
    report->thickness_mean += size * at;
    area += size;
  }
  report->thickness_mean /= area;
  return true;
}

/* Distances from the inner surface, at points of each triangle and its sides. */
static void measure_triangle(const SporeVec3 p[3], const SporeBvh *outer, double thickness, SporeWallReport *report) {
  SporeVec3 one = spore_vec3_sub(p[1], p[0]), other = spore_vec3_sub(p[2], p[0]);
  double longest = fmax(spore_vec3_distance(p[1], p[2]), fmax(spore_vec3_length(one), spore_vec3_length(other)));
  int parts = (int)fmin(fmax(ceil(longest / (MEASURED * thickness)), 2), MOST_PARTS);
  for (int i = 0; i <= parts; i++)
    for (int j = 0; i + j <= parts; j++) {
      SporeVec3 place =
          spore_vec3_add_scaled(spore_vec3_add_scaled(p[0], (double)i / parts, one), (double)j / parts, other);
      double at = spore_bvh_distance(outer, place, NULL, NULL), error = fabs(at / thickness - 1);
      report->inner_min = fmin(report->inner_min, at);
      report->inner_max = fmax(report->inner_max, at);
      if (error > report->error) report->error = error, report->error_at = place;
    }
}

static bool measure_inner(const SporeTriangleMesh *inner, const SporeBvh *outer, double thickness,
                          SporeWallReport *report, const SporeProgress *progress, SporeError *error) {
  report->inner_min = HUGE_VAL;
  for (size_t t = 0; t < inner->triangle_count; t++) {
    if (t % TRIANGLES_A_REPORT == 0 && !go_on(progress, 0.5 + 0.5 * (double)t / (double)inner->triangle_count, error))
      return false;
    SporeVec3 p[3];
    for (size_t k = 0; k < 3; k++) p[k] = spore_mesh_vertex(inner->vertices, inner->triangles[3 * t + k]);
    measure_triangle(p, outer, thickness, report);
  }
  return true;
}

static bool report_wall(const SporeTriangleMesh *outer, const SporeBvh *bvh, const SporeMeshReport *box,
                        const SporeTriangleMesh *inner, double thickness, SporeWallReport *report,
                        const SporeProgress *progress, SporeError *error) {
  SporeMeshReport lumen;
  SporeBvh *other = spore_bvh_create(inner, error);
  if (!other || !spore_triangle_mesh_report(inner, &lumen, error)) {
    spore_bvh_free(other);
    return false;
  }
  bool done = measure_outer(outer, other, report, progress, error) &&
              measure_inner(inner, bvh, thickness, report, progress, error);
  report->lumen_volume = lumen.volume;
  report->wall_volume = fabs(box->volume) - lumen.volume;
  report->pieces = lumen.components;
  spore_bvh_free(other);
  return done;
}

/* The inner surface, as accurate as the detail asks for, in as few triangles as this accuracy allows. */
static bool make_inner(Depth *depth, const SporeMeshReport *box, double step, double detail, SporeTriangleMesh *inner,
                       const SporeProgress *progress, SporeError *error) {
  double lower[3], upper[3], near = depth->thickness / (detail > 0 ? detail : SPORE_WALL_DETAIL);
  for (int e = 0; e < 3; e++) lower[e] = box->lower[e] - 0.3 * step, upper[e] = box->upper[e] + 0.3 * step;
  if (!spore_isosurface(lower, upper, step, OFF * near, beyond_wall, depth, inner, progress, error)) return false;
  if (inner->triangle_count == 0) return refuse(depth->bvh, box, depth->thickness, error);
  const SporeSurfaceLimit limit = {depth->cells, depth->thickness, OFF * near, SPACING * depth->thickness};
  return spore_triangle_mesh_thin(inner, &limit, progress, error);
}

bool spore_wall_inner(const SporeTriangleMesh *outer, double thickness, double detail, SporeTriangleMesh *inner,
                      SporeWallReport *report, const SporeProgress *progress, SporeError *error) {
  uint64_t start = spore_clock_ns();
  SporeMeshReport box;
  *inner = (SporeTriangleMesh){0};
  *report = (SporeWallReport){0};
  if (!spore_triangle_mesh_report_solid(outer, &box, error)) return false;
  SporeBvh *bvh = spore_bvh_create(outer, error);
  if (!bvh) return false;
  Depth depth = {.bvh = bvh, .cells = spore_depth_cells_create(bvh, CELL * thickness), .thickness = thickness};
  report->step = fmin(FINEST * box.diagonal, thickness);
  bool made = (depth.cells || spore_mesh_no_memory(error)) &&
              make_inner(&depth, &box, report->step, detail, inner, progress, error) &&
              report_wall(outer, bvh, &box, inner, thickness, report, progress, error);
  spore_depth_cells_free(depth.cells);
  spore_bvh_free(bvh);
  if (!made) spore_triangle_mesh_clear(inner);
  report->seconds = 1e-9 * (double)(spore_clock_ns() - start);
  return made;
}

bool spore_wall_solid(const SporeTriangleMesh *outer, const SporeTriangleMesh *inner, SporeTriangleMesh *wall,
                      SporeError *error) {
  if (!spore_triangle_mesh_allocate(wall, outer->vertex_count + inner->vertex_count,
                                    outer->triangle_count + inner->triangle_count, error))
    return false;
  memcpy(wall->vertices, outer->vertices, 3 * outer->vertex_count * sizeof(double));
  memcpy(wall->vertices + 3 * outer->vertex_count, inner->vertices, 3 * inner->vertex_count * sizeof(double));
  memcpy(wall->triangles, outer->triangles, 3 * outer->triangle_count * sizeof(uint32_t));
  uint32_t *to = wall->triangles + 3 * outer->triangle_count, shift = (uint32_t)outer->vertex_count;
  for (size_t t = 0; t < inner->triangle_count; t++, to += 3) {
    const uint32_t *n = inner->triangles + 3 * t;
    to[0] = shift + n[0], to[1] = shift + n[2], to[2] = shift + n[1];
  }
  return true;
}
