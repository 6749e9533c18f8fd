/* What all drawables share: origin, bounds, and freeing. */
#include <math.h>

#include "ui/render/passes.h"

void spore_drawable_set_offset(const SporeDrawable *drawable, const SporeFrame *frame, GLint location) {
  const double *origin = drawable->origin;
  glUniform3f(location, (float)(origin[0] - frame->eye.x), (float)(origin[1] - frame->eye.y),
              (float)(origin[2] - frame->eye.z));
}

void spore_drawable_set_bounds(SporeDrawable *drawable, const double *points, gsize count, gsize stride,
                               gboolean radius, gboolean set_origin) {
  double *lower = drawable->lower, *upper = drawable->upper;
  for (int i = 0; i < 3; i++) lower[i] = HUGE_VAL, upper[i] = -HUGE_VAL;
  for (gsize p = 0; p < count; p++) {
    const double *point = points + p * stride;
    double grow = radius ? point[3] : 0;
    for (int i = 0; i < 3; i++) {
      lower[i] = MIN(lower[i], point[i] - grow);
      upper[i] = MAX(upper[i], point[i] + grow);
    }
  }
  if (set_origin)
    for (int i = 0; i < 3; i++) drawable->origin[i] = count ? (lower[i] + upper[i]) / 2 : 0;
}

gboolean spore_drawables_show(const GPtrArray *drawables, SporeDrawableKind kind) {
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    if (drawable && drawable->visible && drawable->kind == kind) return TRUE;
  }
  return FALSE;
}

static void free_surface(SporeSurfaceGroup *surface) {
  GLuint buffers[] = {surface->moving,  surface->rest,   surface->values, surface->stain,
                      surface->indices, surface->places, surface->coarse};
  glDeleteBuffers(G_N_ELEMENTS(buffers), buffers);
  glDeleteVertexArrays(1, &surface->vertex_array);
  g_free(surface->triangles);
  g_free(surface->normals);
  g_free(surface->twins);
}

static void free_spheres(SporeSphereGroup *group) {
  GLuint buffers[] = {group->moving, group->values, group->stain};
  glDeleteBuffers(G_N_ELEMENTS(buffers), buffers);
  glDeleteVertexArrays(1, &group->vertex_array);
}

static void free_puffs(SporePuffGroup *group) {
  glDeleteBuffers(1, &group->moving);
  glDeleteVertexArrays(1, &group->vertex_array);
  g_free(group->puffs);
}

static void free_lines(SporeLineGroup *group) {
  glDeleteBuffers(1, &group->moving);
  glDeleteVertexArrays(1, &group->vertex_array);
}

void spore_drawable_free(SporeDrawable *drawable) {
  if (!drawable) return;
  switch (drawable->kind) {
  case SPORE_DRAW_SURFACE:
    free_surface((SporeSurfaceGroup *)drawable);
    break;
  case SPORE_DRAW_SPHERES:
    free_spheres((SporeSphereGroup *)drawable);
    break;
  case SPORE_DRAW_PUFFS:
    free_puffs((SporePuffGroup *)drawable);
    break;
  case SPORE_DRAW_LINES:
    free_lines((SporeLineGroup *)drawable);
    break;
  }
  g_free(drawable);
}
