/* Lines: groups of segments of a given width, and the floor grid, which is made of such groups. */
#include <math.h>
#include <string.h>

#include "ui/render/passes.h"

#define HIDDEN_ALPHA 0.22f
/* In a light room, bright lines lie on wider dark ones; those that are too thin for that are darker themselves. */
#define EDGED_WIDTH 1.7f
#define EDGE_PIXELS 2.0f
#define EDGE_ALPHA 0.6f
#define BRIGHT 0.6f /* mean of a colour's channels */
#define DARKER 0.25f

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

static gboolean is_bright(const SporeLineGroup *group) {
  return (group->colour[0] + group->colour[1] + group->colour[2]) / 3 > BRIGHT;
}

static void draw_group(const SporeLineGroup *group, const SporeProgram *program, const float colour[3], float width,
                       float alpha) {
  glUniform3fv(program->colour, 1, colour);
  glUniform1f(program->width, width);
  glUniform1f(program->fade, group->fade);
  glUniform1f(program->dim, alpha);
  glBindVertexArray(group->vertex_array);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, (GLsizei)group->count);
}

static void draw_groups(GPtrArray *drawables, const SporeFrame *frame, const SporeProgram *program, gboolean hidden) {
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    if (!drawable || !drawable->visible || drawable->kind != SPORE_DRAW_LINES) continue;
    const SporeLineGroup *group = (const SporeLineGroup *)drawable;
    spore_drawable_set_offset(drawable, frame, program->offset);
    static const float edge[3] = {0.01f, 0.01f, 0.01f};
    float colour[3], shade = frame->light && group->width < EDGED_WIDTH && is_bright(group) ? DARKER : 1;
    for (int k = 0; k < 3; k++) colour[k] = shade * group->colour[k];
    if (frame->light && !hidden && group->width >= EDGED_WIDTH)
      draw_group(group, program, edge, (group->width + EDGE_PIXELS) * frame->line_scale, EDGE_ALPHA);
    draw_group(group, program, colour, group->width * frame->line_scale, hidden ? group->hidden : 1);
  }
}

gboolean spore_line_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                         gboolean hidden, GError **error) {
  if (!spore_drawables_show(drawables, SPORE_DRAW_LINES)) return TRUE;
  const SporeProgram *program = spore_programs_get(programs, SPORE_PROGRAM_LINE, variant, error);
  if (!program) return FALSE;
  glUseProgram(program->id);
  glUniform1f(program->near, (float)frame->near);
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  spore_frame_clip(frame, hidden); /* the grid is not of the scene */
  if (hidden) {
    glDepthFunc(GL_GREATER);
    draw_groups(drawables, frame, program, TRUE);
    glDepthFunc(GL_LEQUAL);
  }
  draw_groups(drawables, frame, program, FALSE);
  spore_frame_clip(frame, FALSE);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  return TRUE;
}

/* The grid. */

/* Grid cells each way from what the camera looks at. */
#define GRID_CELLS 20

enum { GRID_FINE, GRID_COARSE, GRID_X, GRID_Z, GRID_GROUPS };

/* In a dark room, and in a light one. */
static const float grid_colours[2][GRID_GROUPS][3] = {
    {{0.045f, 0.042f, 0.042f}, {0.085f, 0.080f, 0.080f}, {0.42f, 0.06f, 0.06f}, {0.06f, 0.14f, 0.50f}},
    {{0.42f, 0.43f, 0.45f}, {0.20f, 0.21f, 0.22f}, {0.62f, 0.05f, 0.05f}, {0.06f, 0.14f, 0.62f}}};

GPtrArray *spore_grid_new(void) {
  GPtrArray *grid = g_ptr_array_new();
  for (int i = 0; i < GRID_GROUPS; i++)
    g_ptr_array_add(grid, spore_line_group_new(NULL, 0, grid_colours[0][i], i < GRID_X ? 1.0f : 1.6f));
  return grid;
}

static void add_line(GArray *points, double x0, double z0, double x1, double z1) {
  double line[6] = {x0, 0, z0, x1, 0, z1};
  g_array_append_vals(points, line, 6);
}

static void set_group(GPtrArray *grid, guint group, GArray *points, double fade) {
  SporeLineGroup *lines = grid->pdata[group];
  spore_line_group_move(lines, (const double *)points->data, points->len / 6);
  lines->fade = (float)fade;
  g_array_set_size(points, 0);
}

void spore_grid_update(GPtrArray *grid, const SporeCamera *camera, gboolean light) {
  for (int i = 0; i < GRID_GROUPS; i++) {
    SporeLineGroup *lines = grid->pdata[i];
    memcpy(lines->colour, grid_colours[light ? 1 : 0][i], sizeof lines->colour);
  }
  double cell = pow(10, floor(log10(camera->distance * 0.35))), reach = GRID_CELLS * cell;
  double fade = 2.2 * camera->distance + reach * 0.5;
  long middle_x = lround(camera->target.x / cell), middle_z = lround(camera->target.z / cell);
  double low_x = ((double)middle_x - GRID_CELLS) * cell, low_z = ((double)middle_z - GRID_CELLS) * cell;
  GArray *points = g_array_new(FALSE, FALSE, sizeof(double));
  for (int coarse = 0; coarse < 2; coarse++) {
    for (int i = 0; i <= 2 * GRID_CELLS; i++) {
      long line_x = middle_x + i - GRID_CELLS, line_z = middle_z + i - GRID_CELLS;
      double x = (double)line_x * cell, z = (double)line_z * cell;
      if (line_x != 0 && (line_x % 10 == 0) == coarse) add_line(points, x, low_z, x, low_z + 2 * reach);
      if (line_z != 0 && (line_z % 10 == 0) == coarse) add_line(points, low_x, z, low_x + 2 * reach, z);
    }
    set_group(grid, coarse ? GRID_COARSE : GRID_FINE, points, fade);
  }
  if (low_z <= 0 && low_z + 2 * reach >= 0) add_line(points, low_x, 0, low_x + 2 * reach, 0);
  set_group(grid, GRID_X, points, fade);
  if (low_x <= 0 && low_x + 2 * reach >= 0) add_line(points, 0, low_z, 0, low_z + 2 * reach);
  set_group(grid, GRID_Z, points, fade);
  g_array_free(points, TRUE);
}
