/* Spheres, drawn as impostors that write depth. */
#include <string.h>

#include "ui/render/passes.h"

/* Share of its colour that an overlay keeps where something stands before it. */
#define HIDDEN_ALPHA 0.30f

enum { VALUE = 1, STAIN = 2 }; /* attributes of the shader: a number at each sphere */

static void describe(const SporeSphereGroup *group) {
  glBindVertexArray(group->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, group->moving);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, 0, NULL);
  glVertexAttribDivisor(0, 1);
  glBindVertexArray(0);
}

void spore_sphere_group_value(SporeSphereGroup *group, const float *values) {
  glBindVertexArray(group->vertex_array);
  if (values) {
    if (!group->values) glGenBuffers(1, &group->values);
    glBindBuffer(GL_ARRAY_BUFFER, group->values);
    glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(group->added * sizeof *values), values, GL_DYNAMIC_DRAW);
    glEnableVertexAttribArray(VALUE);
    glVertexAttribPointer(VALUE, 1, GL_FLOAT, GL_FALSE, 0, NULL);
    glVertexAttribDivisor(VALUE, 1);
  } else if (group->values) {
    glDisableVertexAttribArray(VALUE);
    glDeleteBuffers(1, &group->values);
    group->values = 0;
  }
  glBindVertexArray(0);
}

SporeSphereGroup *spore_sphere_group_new(const double *spheres, gsize count, const float colour[3], const float *values,
                                         gboolean overlay) {
  SporeSphereGroup *group = g_new0(SporeSphereGroup, 1);
  group->base.kind = SPORE_DRAW_SPHERES;
  group->base.visible = TRUE;
  group->overlay = overlay;
  memcpy(group->colour, colour, sizeof group->colour);
  glGenVertexArrays(1, &group->vertex_array);
  glGenBuffers(1, &group->moving);
  group->added = count;
  spore_drawable_set_bounds(&group->base, spheres, count, 4, TRUE, TRUE);
  spore_sphere_group_move(group, spheres, count);
  describe(group);
  spore_sphere_group_value(group, values);
  return group;
}

void spore_sphere_group_stain(SporeSphereGroup *group, const float *stain) {
  gboolean first = group->stain == 0;
  if (first) glGenBuffers(1, &group->stain);
  glBindBuffer(GL_ARRAY_BUFFER, group->stain);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(group->count * sizeof *stain), stain, GL_DYNAMIC_DRAW);
  if (!first) return;
  glBindVertexArray(group->vertex_array);
  glEnableVertexAttribArray(STAIN);
  glVertexAttribPointer(STAIN, 1, GL_FLOAT, GL_FALSE, 0, NULL);
  glVertexAttribDivisor(STAIN, 1);
  glBindVertexArray(0);
}

void spore_sphere_group_move(SporeSphereGroup *group, const double *spheres, gsize count) {
  group->count = count;
  spore_drawable_set_bounds(&group->base, spheres, group->count, 4, TRUE, FALSE);
  float *moved = g_new(float, 4 * group->count);
  for (gsize s = 0; s < group->count; s++) {
    for (int i = 0; i < 3; i++) moved[4 * s + i] = (float)(spheres[4 * s + i] - group->base.origin[i]);
    moved[4 * s + 3] = (float)spheres[4 * s + 3];
  }
  glBindBuffer(GL_ARRAY_BUFFER, group->moving);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(group->count * 4 * sizeof(float)), moved, GL_STREAM_DRAW);
  g_free(moved);
}

static void draw_groups(GPtrArray *drawables, const SporeFrame *frame, const SporeProgram *program, gboolean overlays) {
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    if (!drawable || !drawable->visible || drawable->kind != SPORE_DRAW_SPHERES) continue;
    const SporeSphereGroup *group = (const SporeSphereGroup *)drawable;
    if (!group->overlay != !overlays) continue;
    spore_drawable_set_offset(drawable, frame, program->offset);
    glUniform3fv(program->colour, 1, group->colour);
    glBindVertexArray(group->vertex_array);
    if (!group->values) glVertexAttrib1f(VALUE, -1);
    if (!group->stain) glVertexAttrib1f(STAIN, 0);
    glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)group->count);
  }
}

/* The squares stand at the far side of their spheres. So every hidden fragment passes the depth test, and the driver
 * may test before it shades. The next pass draws over fragments that are not hidden. */
static gboolean draw_hidden(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs,
                            SporeVariant variant, GError **error) {
  const SporeProgram *program = spore_programs_get(programs, SPORE_PROGRAM_HIDDEN_SPHERE, variant, error);
  if (!program) return FALSE;
  glUseProgram(program->id);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_FALSE);
  glEnable(GL_BLEND);
  glUniform1f(program->dim, HIDDEN_ALPHA);
  draw_groups(drawables, frame, program, TRUE);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDepthFunc(GL_LEQUAL);
  return TRUE;
}

gboolean spore_sphere_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                           gboolean overlays, GError **error) {
  if (!spore_drawables_show(drawables, SPORE_DRAW_SPHERES)) return TRUE;
  if (overlays && !draw_hidden(drawables, frame, programs, variant, error)) return FALSE;
  const SporeProgram *program = spore_programs_get(programs, SPORE_PROGRAM_SPHERE, variant, error);
  if (!program) return FALSE;
  glUseProgram(program->id);
  glUniform1f(program->dim, 1);
  draw_groups(drawables, frame, program, overlays);
  return TRUE;
}
