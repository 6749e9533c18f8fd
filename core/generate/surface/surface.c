/* A surface of fewer, well-shaped triangles, and its distance from the given one. */
#include "core/generate/surface/surface.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/mesh/bvh.h"
#include "core/mesh/half_edges.h"

#define SAMPLES 20000 /* of each surface, for the distance */

static SporeVec3 vertex(const SporeTriangleMesh *mesh, uint32_t index) {
  return spore_vec3_load(mesh->vertices + 3 * (size_t)index);
}

/* Each open edge as a triangle of zero area, so that distances to edges are computed as distances to a surface. */
static bool outline_of(const SporeTriangleMesh *mesh, SporeTriangleMesh *outline) {
  SporeHalfEdges halves;
  *outline = (SporeTriangleMesh){.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  if (!spore_half_edges_create(&halves, mesh->triangles, mesh->triangle_count)) return false;
  outline->triangles = SPORE_NEW_ARRAY(uint32_t, 3 * halves.count);
  for (size_t i = 0, end; outline->triangles && i < halves.count; i = end) {
    end = spore_half_edges_end(&halves, i);
    if (end - i > 1) continue;
    uint32_t *edge = outline->triangles + 3 * outline->triangle_count++;
    edge[0] = (uint32_t)(halves.edge[i] >> 32);
    edge[1] = edge[2] = (uint32_t)halves.edge[i];
  }
  spore_half_edges_clear(&halves);
  return outline->triangles != NULL;
}

/* Largest distance from points at and between the ends of each edge. */
static double farthest_from(const SporeTriangleMesh *outline, const SporeBvh *other) {
  double farthest = 0;
  for (size_t e = 0; e < outline->triangle_count; e++)
    for (int k = 0; k < 4; k++) {
      SporeVec3 a = vertex(outline, outline->triangles[3 * e]), b = vertex(outline, outline->triangles[3 * e + 1]);
      SporeVec3 p = spore_vec3_add_scaled(a, 0.25 * k, spore_vec3_sub(b, a));
      farthest = fmax(farthest, spore_bvh_distance(other, p, NULL, NULL));
    }
  return farthest;
}

static bool measure_outline(const SporeTriangleMesh *mesh, const SporeTriangleMesh *result, double *distance,
                            SporeError *error) {
  SporeTriangleMesh before, after = {0};
  bool made = outline_of(mesh, &before) && outline_of(result, &after);
  *distance = 0;
  if (!made) spore_generate_no_memory(error);
  if (made && before.triangle_count > 0 && after.triangle_count > 0) {
    SporeBvh *one = spore_bvh_create(&before, error), *other = one ? spore_bvh_create(&after, error) : NULL;
    made = other != NULL;
    if (made) *distance = fmax(farthest_from(&before, other), farthest_from(&after, one));
    spore_bvh_free(one);
    spore_bvh_free(other);
  }
  spore_free(before.triangles);
  spore_free(after.triangles);
  return made;
}

static bool measure_edges(const SporeTriangleMesh *mesh, SporeSurfaceReport *report, SporeError *error) {
  uint32_t *edges;
  size_t count;
  if (!spore_edges_of_triangles(mesh->triangles, mesh->triangle_count, &edges, &count))
    return spore_generate_no_memory(error);
  report->edge_min = HUGE_VAL;
  for (size_t e = 0; e < count; e++) {
    double length = spore_vec3_distance(vertex(mesh, edges[2 * e]), vertex(mesh, edges[2 * e + 1]));
    report->edge_min = fmin(report->edge_min, length);
    report->edge_max = fmax(report->edge_max, length);
    report->edge_mean += length / (double)count;
  }
  spore_free(edges);
  return true;
}

static bool measure(const SporeTriangleMesh *mesh, const SporeTriangleMesh *result, SporeSurfaceReport *report,
                    const SporeProgress *progress, SporeError *error) {
  SporeMeshReport before, after;
  double distance, outline;
  if (!spore_triangle_mesh_report(mesh, &before, error) || !spore_triangle_mesh_report(result, &after, error) ||
      !spore_surface_distance(mesh, result, SAMPLES, &distance, progress, error) ||
      !measure_outline(mesh, result, &outline, error) || !measure_edges(result, report, error))
    return false;
  spore_triangle_mesh_angles(result, &report->min_angle_deg, &report->mean_angle_deg);
  report->pieces = after.components;
  report->open_edges = after.boundary_edges;
  report->hausdorff = distance / before.diagonal;
  report->outline = outline / before.diagonal;
  report->area_change = after.area / before.area - 1;
  report->volume_change = before.closed ? after.volume / before.volume - 1 : NAN;
  return true;
}

bool spore_surface_from_mesh(const SporeTriangleMesh *mesh, const SporeSimplifyOptions *options,
                             SporeTriangleMesh *result, SporeSurfaceReport *report, const SporeProgress *progress,
                             SporeError *error) {
  uint64_t start = spore_clock_ns();
  *report = (SporeSurfaceReport){0};
  bool done = spore_triangle_mesh_simplify(mesh, options, result, &report->simplify, progress, error);
  report->seconds = 1e-9 * (double)(spore_clock_ns() - start);
  if (done && measure(mesh, result, report, progress, error)) return true;
  spore_triangle_mesh_clear(result);
  return false;
}
