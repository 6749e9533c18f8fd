/* A surface of fewer, well-shaped triangles for a net or a shell, and hollow organs with a wall. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/mesh/bvh.h"
#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

/* The edges, over what is coloured. */
static void show_edges(const SporeTriangleMesh *mesh, SporeStageCandidate *candidate) {
  candidate->are_edges = TRUE;
  candidate->line_count = 3 * mesh->triangle_count;
  candidate->lines = g_new(double, 6 * candidate->line_count);
  for (gsize i = 0; i < candidate->line_count; i++) {
    const guint32 *corners = mesh->triangles + 3 * (i / 3);
    for (gsize k = 0; k < 2; k++)
      memcpy(candidate->lines + 6 * i + 3 * k, mesh->vertices + 3 * corners[(i + k) % 3], 3 * sizeof(double));
  }
}

static void measure_distance(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->mesh.vertex_count;
  quality->values = spore_generate_scaled(work->surface_distance, quality->count, 1, 1e3);
}

static void show_given(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_surface(&work->mesh, places, candidate);
  show_edges(&work->surface, candidate);
}

static double least_angle(const SporeTriangleMesh *mesh, gsize t) {
  double least = 180;
  for (gsize k = 0; k < 3; k++) {
    SporeVec3 corner[3];
    for (gsize j = 0; j < 3; j++)
      corner[j] = spore_vec3_load(mesh->vertices + 3 * mesh->triangles[3 * t + (k + j) % 3]);
    SporeVec3 a = spore_vec3_sub(corner[1], corner[0]), b = spore_vec3_sub(corner[2], corner[0]);
    least = fmin(least, 180 / G_PI * atan2(spore_vec3_length(spore_vec3_cross(a, b)), spore_vec3_dot(a, b)));
  }
  return least;
}

static void measure_angles(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->surface.triangle_count;
  quality->values = g_new(double, quality->count);
  for (gsize t = 0; t < quality->count; t++) quality->values[t] = least_angle(&work->surface, t);
}

static void show_triangles(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  const SporeTriangleMesh *mesh = &work->surface;
  double *corners = g_new(double, 9 * mesh->triangle_count);
  for (gsize i = 0; i < 3 * mesh->triangle_count; i++)
    memcpy(corners + 3 * i, mesh->vertices + 3 * (gsize)mesh->triangles[i], 3 * sizeof(double));
  spore_generate_show_triangles(corners, mesh->triangle_count, places, candidate);
  show_edges(mesh, candidate);
}

static const SporeGenerateQuality qualities[] = {
    {N_("Surface distance"), "mm", FALSE, measure_distance, show_given},
    {N_("Least angle"), "°", FALSE, measure_angles, show_triangles},
};

const SporeGenerateType spore_generate_surface = {
    .shows = "surface",
    .counts = (const size_t[]){50, 100, 200, 400, 800, 1600, 3200, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
};
