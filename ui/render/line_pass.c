#include <string.h>

#include "ui/render/passes.h"

#define HIDDEN_ALPHA 0.22f

SporeLineGroup *spore_line_group_new(const double *points, gsize count, const float colour[3], float width) {
  SporeLineGroup *group = g_new0(SporeLineGroup, 1);
  group->base.kind = SPORE_DRAW_LINES;
  group->base.visible = TRUE;
  group->width = width;
  group->hidden = HIDDEN_ALPHA;
  memcpy(group->colour, colour, sizeof group->colour);
  glGenVertexArrays(1, &group->vertex_array);
  glGenBuffers(1, &group->moving);
  spore_line_group_move(group, points, count);
  glBindVertexArray(group->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, group->moving);
  for (guint end = 0; end < 2; end++) {
    glEnableVertexAttribArray(end);
    glVertexAttribPointer(end, 3, GL_FLOAT, GL_FALSE, 6 * sizeof(float), (const void *)(end * 3 * sizeof(float)));
    glVertexAttribDivisor(end, 1);
  }
  glBindVertexArray(0);
  return group;
}

void spore_line_group_move(SporeLineGroup *group, const double *points, gsize count) {
  spore_drawable_set_bounds(&group->base, points, 2 * count, 3, FALSE, TRUE);
  group->count = count;
  float *moved = g_new(float, 6 * count);
  for (gsize i = 0; i < 6 * count; i++) moved[i] = (float)(points[i] - group->base.origin[i % 3]);
  glBindBuffer(GL_ARRAY_BUFFER, group->moving);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(6 * count * sizeof(float)), moved, GL_STREAM_DRAW);
  g_free(moved);
}

static void draw_groups(GPtrArray *drawables, const SporeFrame *frame, const SporeProgram *program, gboolean hidden) {
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    if (!drawable || !drawable->visible || drawable->kind != SPORE_DRAW_LINES) continue;
    const SporeLineGroup *group = (const SporeLineGroup *)drawable;
    spore_drawable_set_offset(drawable, frame, program->offset);
    glUniform3fv(program->colour, 1, group->colour);
    glUniform1f(program->width, group->width);
    glUniform1f(program->fade, group->fade);
    glUniform1f(program->dim, hidden ? group->hidden : 1);
    glBindVertexArray(group->vertex_array);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)group->count);
  }
}

gboolean spore_line_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                         gboolean hidden, GError **error) {
  const SporeProgram *program = spore_programs_get(programs, SPORE_PROGRAM_LINE, variant, error);
  if (!program) return FALSE;
  glUseProgram(program->id);
  glUniform1f(program->near, (float)frame->near);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  if (hidden) {
    glDepthFunc(GL_GREATER);
    draw_groups(drawables, frame, program, TRUE);
    glDepthFunc(GL_LEQUAL);
  }
  draw_groups(drawables, frame, program, FALSE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return TRUE;
}
