/* The candidate of a generator or of the Edit tool, and marks on a body: what the stage shows beside the scene. */
#include <math.h>
#include <string.h>

#include "ui/render/stage_body.h"

#define MARK_GROWS 1.02 /* so that the mark lies over its sphere */

static const float plain_colour[3] = {0.03f, 0.24f, 0.36f}, mark_colour[3] = {0.95f, 0.32f, 0.02f},
                   line_colour[3] = {0.95f, 0.62f, 0.05f}, edge_colour[3] = {0.9f, 0.9f, 0.9f},
                   marks_colour[3] = {0.98f, 0.84f, 0.22f};

void spore_stage_candidate_free(SporeStageCandidate *candidate) {
  if (!candidate) return;
  g_free(candidate->spheres);
  g_free(candidate->sphere_values);
  g_free(candidate->vertices);
  g_free(candidate->triangles);
  g_free(candidate->vertex_values);
  g_free(candidate->lines);
  g_free(candidate);
}

/* Copies points of `stride` doubles and poses their first three. g_free. */
static double *posed(SporePose pose, const double *points, gsize count, gsize stride) {
  double *moved = g_memdup2(points, count * stride * sizeof *points);
  for (gsize i = 0; i < count; i++)
    spore_vec3_store(moved + stride * i, spore_pose_apply(pose, spore_vec3_load(points + stride * i)));
  return moved;
}

static void add_spheres(SporeStage *stage, const SporeStageCandidate *candidate, SporePose pose) {
  g_autofree double *spheres = posed(pose, candidate->spheres, candidate->sphere_count, 4);
  stage->candidate_handles[0] = spore_renderer_add_spheres(stage->renderer, spheres, candidate->sphere_count,
                                                           plain_colour, candidate->sphere_values, TRUE);
  if (candidate->chosen >= candidate->sphere_count) return;
  double *mark = spheres + 4 * candidate->chosen;
  mark[3] *= MARK_GROWS;
  stage->candidate_handles[1] = spore_renderer_add_spheres(stage->renderer, mark, 1, mark_colour, NULL, TRUE);
}

static void add_surface(SporeStage *stage, const SporeStageCandidate *candidate, SporePose pose) {
  g_autofree double *vertices = posed(pose, candidate->vertices, candidate->vertex_count, 3);
  stage->candidate_handles[2] =
      spore_renderer_add_valued_surface(stage->renderer, vertices, candidate->vertex_count, candidate->triangles,
                                        candidate->triangle_count, candidate->vertex_values);
}

static void add_lines(SporeStage *stage, const SporeStageCandidate *candidate, SporePose pose) {
  g_autofree double *lines = posed(pose, candidate->lines, 2 * candidate->line_count, 3);
  gsize edges = candidate->edge_count, others = candidate->line_count - edges;
  if (edges) {
    stage->candidate_handles[3] = spore_renderer_add_lines(stage->renderer, lines, edges, edge_colour, 1);
    spore_renderer_see_lines_through(stage->renderer, stage->candidate_handles[3], 0);
  }
  if (others)
    stage->candidate_handles[4] =
        spore_renderer_add_lines(stage->renderer, lines + 6 * edges, others, line_colour, 2.5f);
}

void spore_stage_place_candidate(SporeStage *stage) {
  const SporeStageCandidate *candidate = stage->candidate;
  for (guint i = 0; i < G_N_ELEMENTS(stage->candidate_handles); i++)
    if (stage->candidate_handles[i]) spore_renderer_remove(stage->renderer, stage->candidate_handles[i]);
  memset(stage->candidate_handles, 0, sizeof stage->candidate_handles);
  const SporeObject *body =
      candidate && candidate->body ? spore_document_by_id(stage->document, candidate->body) : NULL;
  if (!candidate || (candidate->body && !body)) return;
  SporePose pose = body ? spore_body_pose(body) : spore_pose_identity();
  if (candidate->sphere_count) add_spheres(stage, candidate, pose);
  if (candidate->triangle_count) add_surface(stage, candidate, pose);
  if (candidate->line_count) add_lines(stage, candidate, pose);
}

void spore_stage_set_candidate(SporeStage *stage, const SporeStageCandidate *candidate) {
  stage->candidate = candidate;
  spore_stage_place_candidate(stage);
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_show(stage, stage->bodies->pdata[i]);
}

void spore_stage_place_marks(SporeStage *stage) {
  const SporeStageMarks *marks = stage->marks;
  if (stage->marks_handle) spore_renderer_remove(stage->renderer, stage->marks_handle);
  stage->marks_handle = 0;
  const SporeObject *body = marks ? spore_document_by_id(stage->document, marks->body) : NULL;
  if (!body || !marks->count) return;
  g_autofree double *segments = posed(spore_body_pose(body), marks->segments, 2 * marks->count, 3);
  stage->marks_handle = spore_renderer_add_lines(stage->renderer, segments, marks->count, marks_colour, 1.8f);
  spore_renderer_see_lines_through(stage->renderer, stage->marks_handle, 0.8);
}

void spore_stage_set_marks(SporeStage *stage, const SporeStageMarks *marks) {
  stage->marks = marks;
  spore_stage_place_marks(stage);
}
