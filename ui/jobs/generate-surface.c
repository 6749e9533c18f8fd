/* A surface of fewer, well-shaped triangles for a net or a shell, and hollow organs with a wall. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/mesh/bvh.h"
#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

static bool make_wall(SporeGenerateWork *work, const SporeProgress *progress, SporeError *failure) {
  SporeTriangleMesh outer = work->surface, inner = {0};
  work->surface = (SporeTriangleMesh){0};
  const SporeMeshFields *fields = &work->options.fields.surface;
  bool done = spore_wall_inner(&outer, fields->wall, (double)fields->wall_detail, &inner, &work->wall_report, progress,
                               failure) &&
              spore_wall_solid(&outer, &inner, &work->surface, failure);
  work->wall_report.seconds *= done;
  spore_triangle_mesh_clear(&outer);
  spore_triangle_mesh_clear(&inner);
  return done;
}

/* How far each vertex of the given mesh is from what was made of it. */
static bool measure(SporeGenerateWork *work, SporeError *failure) {
  SporeBvh *bvh = spore_bvh_create(&work->surface, failure);
  if (!bvh) return false;
  work->surface_distance = g_new(double, work->mesh.vertex_count);
  for (gsize i = 0; i < work->mesh.vertex_count; i++)
    work->surface_distance[i] = spore_bvh_distance(bvh, spore_vec3_load(work->mesh.vertices + 3 * i), NULL, NULL);
  spore_bvh_free(bvh);
  return true;
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSimplifyOptions options = spore_edit_surface_options(&work->options.fields.surface);
  gboolean thin = options.vertices > 0 || options.size > 0, wall = work->options.fields.surface.wall > 0;
  if (!thin && !wall)
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->source,
                             _("nothing is asked for; expected a number of nodes, a size or a wall; give one of them"));
  bool done =
      thin ? spore_surface_from_mesh(&work->mesh, &options, &work->surface, &work->surface_report, progress, &failure)
           : spore_triangle_mesh_copy(&work->surface, &work->mesh, &failure);
  done = done && measure(work, &failure) && (!wall || make_wall(work, progress, &failure));
  if (done) return TRUE;
  spore_error_at(&failure, work->source);
  return spore_error_propagate(&failure, error);
}

static gboolean price(const SporeGenerateWork *work, size_t count, double *error_percent, const SporeProgress *progress,
                      GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  SporeSimplifyOptions options = spore_edit_surface_options(&work->options.fields.surface);
  SporeTriangleMesh surface = {0};
  SporeSurfaceReport report;
  options.vertices = count;
  if (!spore_surface_from_mesh(&work->mesh, &options, &surface, &report, progress, &failure))
    return spore_error_propagate(&failure, error);
  spore_triangle_mesh_clear(&surface);
  *error_percent = 100 * report.hausdorff;
  return TRUE;
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  const SporeGeneratedFrom from = {work->source, work->source_hash, &work->options.fields};
  return spore_edit_use_surface(document, body, &from, &work->surface, (SporeSurfaceUse)work->options.purpose, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeSurfaceReport *report = &work->surface_report;
  const SporeWallReport *wall = &work->wall_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu nodes, %zu triangles in %.1f s"), work->surface.vertex_count,
                         work->surface.triangle_count, report->seconds + wall->seconds);
  if (report->mean_angle_deg > 0)
    g_string_append_printf(text, _("\nDistance %.2f %%, edges %.2f mm\nLeast angle %.1f°, mean %.1f°"),
                           100 * report->hausdorff, 1e3 * report->edge_mean, report->min_angle_deg,
                           report->mean_angle_deg);
  if (wall->wall_volume > 0)
    g_string_append_printf(text,
                           _("\nWall %.2f mm (%.2f to %.2f), off by %.1f %%, %.3g ml\nLumen %.3g ml, pieces: %zu"),
                           1e3 * wall->thickness_mean, 1e3 * wall->thickness_min, 1e3 * wall->thickness_max,
                           100 * wall->error, 1e6 * wall->wall_volume, 1e6 * wall->lumen_volume, wall->pieces);
  return g_string_free(text, FALSE);
}

/* Qualities. */

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
    .generator = &spore_generator_surface,
    .title = N_("Surface of %s"),
    .working = N_("Generating a surface"),
    .count_label = N_("Nodes"),
    .counts = (const size_t[]){50, 100, 200, 400, 800, 1600, 3200, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .price = price,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
    .run = run,
    .apply = apply,
    .facts = facts,
};
