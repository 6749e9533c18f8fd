/* A report on a surface: closed or open, faults, volume, pieces. */
#include <math.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/edge_marks.h"
#include "core/mesh/half_edges.h"
#include "core/mesh/volume.h"

#define HOLLOW_VOLUME 1e-12 /* of the cubed diagonal */

static bool degenerate(SporeVec3 a, SporeVec3 b, SporeVec3 c, double area) {
  double longest = fmax(spore_vec3_distance(a, b), fmax(spore_vec3_distance(b, c), spore_vec3_distance(c, a)));
  return area <= SPORE_MESH_FLAT * longest * longest;
}

/* Corners of a triangle about the middle of the mesh's box, so that a mesh far from the origin loses no digits. */
static void corners_about(const SporeTriangleMesh *mesh, size_t t, SporeVec3 middle, SporeVec3 p[3]) {
  for (int k = 0; k < 3; k++)
    p[k] = spore_vec3_sub(spore_mesh_vertex(mesh->vertices, mesh->triangles[3 * t + k]), middle);
}

static SporeVec3 middle_of(const double lower[3], const double upper[3]) {
  return spore_vec3_scale(0.5, spore_vec3_add(spore_vec3_load(lower), spore_vec3_load(upper)));
}

double spore_triangle_mesh_volume(const SporeTriangleMesh *mesh) {
  double lower[3], upper[3], volume = 0;
  if (!mesh->vertex_count) return 0;
  spore_mesh_bounds(mesh->vertices, mesh->vertex_count, 3, lower, upper);
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 p[3];
    corners_about(mesh, t, middle_of(lower, upper), p);
    volume += spore_vec3_dot(p[0], spore_vec3_cross(p[1], p[2])) / 6;
  }
  return volume;
}

bool spore_triangle_mesh_has_inside(const SporeTriangleMesh *mesh) {
  uint64_t sum = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++)
    for (size_t k = 0; k < 3; k++)
      sum += spore_edge_mark(mesh->triangles[3 * t + k], mesh->triangles[3 * t + (k + 1) % 3]);
  return mesh->triangle_count && !sum;
}

static void measure_triangles(const SporeTriangleMesh *mesh, SporeMeshReport *report) {
  SporeVec3 middle = middle_of(report->lower, report->upper);
  report->volume = spore_triangle_mesh_volume(mesh);
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 p[3];
    corners_about(mesh, t, middle, p);
    double area = spore_vec3_length(spore_mesh_area_vector(p[0], p[1], p[2]));
    report->area += area;
    report->degenerate_triangles += degenerate(p[0], p[1], p[2], area);
  }
}

static void count_edges(const SporeTriangleMesh *mesh, const SporeHalfEdges *halves, uint32_t *parent,
                        SporeMeshReport *report) {
  for (size_t i = 0, end; i < halves->count; i = end) {
    end = spore_half_edges_end(halves, i);
    report->boundary_edges += end - i == 1;
    report->nonmanifold_edges += end - i > 2;
    report->misoriented_edges += end - i == 2 && spore_half_edge_ascends(mesh->triangles, halves->half[i]) ==
                                                     spore_half_edge_ascends(mesh->triangles, halves->half[i + 1]);
    for (size_t j = i + 1; j < end; j++) spore_set_join(parent, halves->half[i] / 3, halves->half[j] / 3);
  }
}

bool spore_triangle_mesh_report(const SporeTriangleMesh *mesh, SporeMeshReport *report, SporeError *error) {
  *report = (SporeMeshReport){0};
  if (!mesh->vertex_count || !mesh->triangle_count) return true;
  SporeHalfEdges halves;
  uint32_t *parent = SPORE_NEW_ARRAY(uint32_t, mesh->triangle_count);
  if (!parent || !spore_half_edges_create(&halves, mesh->triangles, mesh->triangle_count)) {
    spore_free(parent);
    return spore_mesh_no_memory(error);
  }
  report->diagonal = spore_mesh_bounds(mesh->vertices, mesh->vertex_count, 3, report->lower, report->upper);
  measure_triangles(mesh, report);
  for (size_t t = 0; t < mesh->triangle_count; t++) parent[t] = (uint32_t)t;
  count_edges(mesh, &halves, parent, report);
  for (size_t t = 0; t < mesh->triangle_count; t++) report->components += parent[t] == t;
  report->closed = !report->boundary_edges && !report->nonmanifold_edges && !report->misoriented_edges;
  spore_half_edges_clear(&halves);
  spore_free(parent);
  return true;
}

bool spore_triangle_mesh_report_solid(const SporeTriangleMesh *mesh, SporeMeshReport *report, SporeError *error) {
  if (!mesh || mesh->triangle_count == 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("there is no surface; expected a closed one; give the body a mesh"));
  if (!spore_triangle_mesh_validate(mesh, error) || !spore_triangle_mesh_report(mesh, report, error)) return false;
  if (!report->closed)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("the surface is not closed (%zu open, %zu non-manifold, %zu misoriented edges); expected a "
          "closed one with one outside for this model; repair it or generate tetrahedra from it"),
        report->boundary_edges, report->nonmanifold_edges, report->misoriented_edges);
  double size = report->diagonal;
  if (fabs(report->volume) > HOLLOW_VOLUME * size * size * size) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the surface holds no volume (%g m^3); expected a solid; check unit and mesh"),
                         fabs(report->volume));
}
