/* A region of a body, as a colour on its surface: what the brush paints, or the region that is placed. */
#include <math.h>

#include "ui/render/stage_body.h"

#define RIM_PART 0.08 /* of a ball's radius: within it, the colour goes through the scale */

static SporeStageBody *painted_body(const SporeStage *stage) {
  for (guint i = 0; i < stage->bodies->len; i++) {
    SporeStageBody *body = stage->bodies->pdata[i];
    gboolean at_rest = body->rest_surface && body->rest_count == body->surface.count;
    if (body->object == stage->painted && body->surface_handle && at_rest) return body;
  }
  return NULL;
}

/* What is below 0 keeps its own look. */
static void colour(const SporeStage *stage, const SporeStageBody *body) {
  spore_renderer_value_surface(stage->renderer, body->surface_handle,
                               (const float *)(void *)stage->painted_values->data);
}

/* How far in the balls each vertex lies, in widths of the rim: between vertices that is linear, so that the rim is
 * where the balls end, however coarse the surface is. */
static void add_balls(const SporeStage *stage, const SporeStageBody *body, const double *balls, gsize count) {
  for (gsize i = 0; i < body->surface.count; i++) {
    float *value = &g_array_index(stage->painted_values, float, i);
    for (gsize b = 0; b < count; b++) {
      const double *ball = balls + 4 * b;
      double away = spore_vec3_distance(spore_vec3_load(ball), spore_vec3_load(body->rest_surface + 3 * i));
      *value = fmaxf(*value, (float)((ball[3] - away) / (RIM_PART * ball[3])));
    }
  }
}

void spore_stage_set_painted(SporeStage *stage, guint32 body, const double *balls, gsize count) {
  SporeStageBody *before = stage->painted == body ? NULL : painted_body(stage);
  stage->painted = body;
  if (before) spore_stage_body_recolour(stage, before);
  const SporeStageBody *now = body ? painted_body(stage) : NULL;
  if (!now) return;
  const float none = -HUGE_VALF;
  g_array_set_size(stage->painted_values, 0);
  for (gsize i = 0; i < now->surface.count; i++) g_array_append_val(stage->painted_values, none);
  add_balls(stage, now, balls, count);
  colour(stage, now);
}

void spore_stage_add_painted(SporeStage *stage, const double ball[4]) {
  const SporeStageBody *body = painted_body(stage);
  if (!body || stage->painted_values->len != body->surface.count) return;
  add_balls(stage, body, ball, 1);
  colour(stage, body);
}
