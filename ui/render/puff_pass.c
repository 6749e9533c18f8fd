/* Puffs of smoke: soft, translucent, and drawn from the farthest to the nearest. */
#include <string.h>

#include "ui/render/passes.h"

/* A puff as it is given to the shaders. */
typedef struct PlacedPuff {
  float place[4], kind[2]; /* relative to the drawable's origin, radius; opacity, seed */
  float distance;          /* from the eye, squared, m^2 */
} PlacedPuff;

SporePuffGroup *spore_puff_group_new(const float colour[3]) {
  SporePuffGroup *group = g_new0(SporePuffGroup, 1);
  group->base.kind = SPORE_DRAW_PUFFS;
  group->base.visible = TRUE;
  memcpy(group->colour, colour, sizeof group->colour);
  glGenVertexArrays(1, &group->vertex_array);
  glGenBuffers(1, &group->moving);
  glBindVertexArray(group->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, group->moving);
  for (guint i = 0; i < 2; i++) {
    const gsize start = i ? offsetof(PlacedPuff, kind) : 0;
    glEnableVertexAttribArray(i);
    glVertexAttribPointer(i, i ? 2 : 4, GL_FLOAT, GL_FALSE, sizeof(PlacedPuff), (const void *)start);
    glVertexAttribDivisor(i, 1);
  }
  glBindVertexArray(0);
  spore_puff_group_move(group, NULL, 0);
  return group;
}

void spore_puff_group_move(SporePuffGroup *group, const SporePuff *puffs, gsize count) {
  G_STATIC_ASSERT(sizeof(SporePuff) % sizeof(double) == 0 && offsetof(SporePuff, radius) == 3 * sizeof(double));
  spore_drawable_set_bounds(&group->base, (const double *)puffs, count, sizeof(SporePuff) / sizeof(double), TRUE, TRUE);
  g_free(group->puffs);
  group->puffs = g_memdup2(puffs, count * sizeof *puffs);
  group->count = count;
}

static gint farthest_first(gconstpointer a, gconstpointer b) {
  float x = ((const PlacedPuff *)a)->distance, y = ((const PlacedPuff *)b)->distance;
  return (x < y) - (x > y);
}

/* Sorts the farthest first: nearer puffs are blended over farther ones. */
static void upload(const SporePuffGroup *group, const SporeFrame *frame) {
  PlacedPuff *placed = g_new(PlacedPuff, group->count);
  for (gsize p = 0; p < group->count; p++) {
    const SporePuff *puff = &group->puffs[p];
    SporeVec3 off = spore_vec3_sub(spore_vec3_load(puff->centre), frame->eye);
    for (int i = 0; i < 3; i++) placed[p].place[i] = (float)(puff->centre[i] - group->base.origin[i]);
    placed[p].place[3] = (float)puff->radius;
    placed[p].kind[0] = (float)puff->opacity;
    placed[p].kind[1] = (float)puff->seed;
    placed[p].distance = (float)spore_vec3_dot(off, off);
  }
  qsort(placed, group->count, sizeof *placed, farthest_first);
  glBindBuffer(GL_ARRAY_BUFFER, group->moving);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(group->count * sizeof *placed), placed, GL_STREAM_DRAW);
  g_free(placed);
}

gboolean spore_puff_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                         GError **error) {
  const SporeProgram *program = NULL;
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    const SporePuffGroup *group = (const SporePuffGroup *)drawable;
    if (!drawable || !drawable->visible || drawable->kind != SPORE_DRAW_PUFFS || group->count == 0) continue;
    if (!program) program = spore_programs_get(programs, SPORE_PROGRAM_PUFF, variant, error);
    if (!program) return FALSE;
    glUseProgram(program->id);
    spore_frame_clip(frame, TRUE);
    glEnable(GL_BLEND);
    glDepthMask(GL_FALSE);
    spore_drawable_set_offset(drawable, frame, program->offset);
    glUniform3fv(program->colour, 1, group->colour);
    upload(group, frame);
    glBindVertexArray(group->vertex_array);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)group->count);
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
    spore_frame_clip(frame, FALSE);
  }
  return TRUE;
}
