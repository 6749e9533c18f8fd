#include "core/generate/wall.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/wall_parts.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/mesh/isosurface.h"

#define STEPS 4        /* in the thickness */
#define FINEST 0.01    /* of the diagonal: no finer is needed than this, unless the wall is thinner */
#define SEARCHES 20000 /* places that are looked at for the deepest */

typedef struct Depth {
  const SporeBvh *bvh;
  double thickness;
} Depth;

/* Negative in the lumen. */
static double beyond_wall(void *data, SporeVec3 place) {
  const Depth *depth = data;
  return depth->thickness - spore_bvh_depth(depth->bvh, place);
}

/* Where of a lattice over the box it is deepest. */
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

/* From the outer surface, at vertices and middles of triangles. */
static void measure_outer(const SporeTriangleMesh *outer, const SporeBvh *inner, SporeWallReport *report) {
  double area = 0;
  report->thickness_min = HUGE_VAL;
  for (size_t t = 0; t < outer->triangle_count; t++) {
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
}

/* From the inner one, at vertices, middles of edges and of triangles. */
static void measure_inner(const SporeTriangleMesh *inner, const SporeBvh *outer, double thickness,
                          SporeWallReport *report) {
  report->inner_min = HUGE_VAL;
  for (size_t t = 0; t < inner->triangle_count; t++) {
    SporeVec3 p[7] = {{0, 0, 0}};
    for (size_t k = 0; k < 3; k++) {
      p[k + 1] = spore_mesh_vertex(inner->vertices, inner->triangles[3 * t + k]);
      p[0] = spore_vec3_add_scaled(p[0], 1.0 / 3, p[k + 1]);
    }
    for (size_t k = 0; k < 3; k++) p[4 + k] = spore_vec3_scale(0.5, spore_vec3_add(p[1 + k], p[1 + (k + 1) % 3]));
    for (size_t k = 0; k < 7; k++) {
      double at = spore_bvh_distance(outer, p[k], NULL, NULL), error = fabs(at / thickness - 1);
      report->inner_min = fmin(report->inner_min, at);
      report->inner_max = fmax(report->inner_max, at);
      if (error > report->error) report->error = error, report->error_at = p[k];
    }
  }
}

static bool report_wall(const SporeTriangleMesh *outer, const SporeBvh *bvh, const SporeMeshReport *box,
                        const SporeTriangleMesh *inner, double thickness, SporeWallReport *report, SporeError *error) {
  SporeMeshReport lumen;
  SporeBvh *other = spore_bvh_create(inner, error);
  if (!other || !spore_triangle_mesh_report(inner, &lumen, error)) {
    spore_bvh_free(other);
    return false;
  }
  measure_outer(outer, other, report);
  measure_inner(inner, bvh, thickness, report);
  report->lumen_volume = lumen.volume;
  report->wall_volume = fabs(box->volume) - lumen.volume;
  report->pieces = lumen.components;
  spore_bvh_free(other);
  return true;
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
  Depth depth = {bvh, thickness};
  double step = detail > 0 ? thickness / detail : fmin(FINEST * box.diagonal, thickness), lower[3], upper[3];
  if (detail <= 0) step = fmax(step, fmin(thickness / STEPS, FINEST * box.diagonal));
  for (int e = 0; e < 3; e++) lower[e] = box.lower[e] - 0.3 * step, upper[e] = box.upper[e] + 0.3 * step;
  report->step = step;
  bool made = spore_isosurface(lower, upper, step, beyond_wall, &depth, inner, progress, error);
  if (made && inner->triangle_count == 0) made = refuse(bvh, &box, thickness, error);
  if (made && !spore_wall_fit(bvh, thickness, step, inner))
    made = spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the inner surface of a wall"));
  made = made && report_wall(outer, bvh, &box, inner, thickness, report, error);
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
