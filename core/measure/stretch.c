/* Measures the lengths of lines and the gaps of links. */
#include "core/measure/stretch.h"

#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/body/path.h"

static const SporeModel *line_of(const SporeWorld *world, uint32_t body) {
  const SporeModel *model = spore_world_body_model(world, body);
  return model && model->type->line ? model : NULL;
}

static void measure_pieces(SporeSplineKnots knots, const double *points, double *lengths) {
  double end = spore_spline_end(knots) / SPORE_STRETCH_PIECES;
  for (int i = 0; i < SPORE_STRETCH_PIECES; i++) lengths[i] = spore_path_length(knots, points, i * end, (i + 1) * end);
}

static bool measure_at_rest(SporeStretch *stretch, const SporeModel *model) {
  double *q = SPORE_NEW_ARRAY(double, model->q_count), *v = SPORE_NEW_ARRAY(double, 3 * model->block_count);
  bool good = q && v;
  if (good) {
    model->type->place(model, spore_pose_identity(), spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), q, v);
    measure_pieces(model->type->line->path(model), q, stretch->rest + stretch->line_count * SPORE_STRETCH_PIECES);
  }
  spore_free(q);
  spore_free(v);
  return good;
}

bool spore_stretch_create(SporeStretch *stretch, const SporeWorld *world, SporeError *error) {
  size_t lines = 0;
  uint32_t bodies = (uint32_t)spore_world_body_count(world);
  for (uint32_t b = 0; b < bodies; b++) lines += line_of(world, b) != NULL;
  *stretch = (SporeStretch){.bodies = SPORE_NEW_ARRAY(uint32_t, lines),
                            .rest = SPORE_NEW_ARRAY(double, lines *SPORE_STRETCH_PIECES)};
  bool good = stretch->bodies && stretch->rest;
  for (uint32_t b = 0; good && b < bodies; b++) {
    if (!line_of(world, b)) continue;
    good = measure_at_rest(stretch, line_of(world, b));
    stretch->bodies[stretch->line_count++] = b;
  }
  if (good) return true;
  spore_stretch_clear(stretch);
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("there is not enough memory for the lengths of lines"));
}

void spore_stretch_clear(SporeStretch *stretch) {
  spore_free(stretch->bodies);
  spore_free(stretch->rest);
  *stretch = (SporeStretch){0};
}

double spore_stretch_of_lines(const SporeStretch *stretch, const SporeWorld *world, const SporeSnapshot *snapshot) {
  double most = stretch->line_count > 0 ? 0 : NAN, lengths[SPORE_STRETCH_PIECES];
  for (size_t k = 0; k < stretch->line_count; k++) {
    uint32_t body = stretch->bodies[k];
    const SporeModel *model = spore_world_body_model(world, body);
    SporeSplineKnots knots = spore_snapshot_knots(world, snapshot, body);
    if (knots.span_count == 0) knots = model->type->line->path(model); /* they never change */
    measure_pieces(knots, spore_world_q(world, body), lengths);
    const double *rest = stretch->rest + k * SPORE_STRETCH_PIECES;
    for (int i = 0; i < SPORE_STRETCH_PIECES; i++)
      if (rest[i] > 0) most = fmax(most, fabs(lengths[i] / rest[i] - 1));
  }
  return most;
}

double spore_stretch_gap(const SporeWorld *world) {
  size_t links = spore_world_link_count(world);
  double most = links > 0 ? 0 : NAN;
  for (size_t i = 0; i < links; i++) most = fmax(most, spore_world_link_state(world, i).drift);
  return most;
}
