/* How results are shown: found by what they are, with what several kinds of them draw alike. */
#include "ui/jobs/generate-types.h"

#include <math.h>

#include "core/scene/generated.h"

const SporeGenerateType *spore_generate_type(SporeGenerateKind kind) {
  static const SporeGenerateType *const types[] = {&spore_generate_spheres, &spore_generate_tetrahedra,
                                                   &spore_generate_curve, &spore_generate_surface,
                                                   &spore_generate_labels};
  gsize i = 0;
  while (i + 1 < G_N_ELEMENTS(types) && strcmp(types[i]->shows, spore_generators[kind]->shows) != 0) i++;
  return types[i];
}

/* Services for the kinds. */

double *spore_generate_scaled(const double *values, gsize count, gsize stride, double scale) {
  double *copy = g_new(double, count);
  for (gsize i = 0; i < count; i++) copy[i] = scale * fabs(values[stride * i]);
  return copy;
}

void spore_generate_show_surface(const SporeTriangleMesh *mesh, float *places, SporeStageCandidate *candidate) {
  candidate->vertex_count = mesh->vertex_count;
  candidate->triangle_count = mesh->triangle_count;
  candidate->vertices = g_memdup2(mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  candidate->triangles = g_memdup2(mesh->triangles, 3 * mesh->triangle_count * sizeof(guint32));
  candidate->vertex_values = places;
}

void spore_generate_show_spheres(const SporeSphereSet *set, float *places, SporeStageCandidate *candidate) {
  candidate->sphere_count = set->count;
  candidate->spheres = g_memdup2(set->spheres, 4 * set->count * sizeof(double));
  spore_spheres_radii(set, candidate->spheres + 3, 4);
  candidate->sphere_values = places;
}

void spore_generate_show_triangles(double *corners, gsize count, float *places, SporeStageCandidate *candidate) {
  candidate->vertex_count = 3 * count;
  candidate->triangle_count = count;
  candidate->vertices = corners;
  candidate->triangles = g_new(guint32, 3 * count);
  candidate->vertex_values = g_new(float, 3 * count);
  for (gsize i = 0; i < 3 * count; i++) {
    candidate->triangles[i] = (guint32)i;
    candidate->vertex_values[i] = places[i / 3];
  }
  g_free(places);
}

void spore_generate_show_cells(const SporeTetrahedralMesh *mesh, float *places, SporeStageCandidate *candidate) {
  SporeCellFaces faces;
  if (spore_cell_faces(mesh, &candidate->view, &faces, NULL)) {
    float *of_faces = g_new(float, faces.triangle_count);
    for (gsize i = 0; i < faces.triangle_count; i++) of_faces[i] = places[faces.cells[i]];
    double *corners = g_memdup2(faces.vertices, 9 * faces.triangle_count * sizeof(double));
    spore_generate_show_triangles(corners, faces.triangle_count, of_faces, candidate);
  }
  spore_cell_faces_clear(&faces);
  g_free(places);
}
