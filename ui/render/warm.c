/* Makes programs ready before a picture needs them. A driver that draws on processors compiles a program when it first
 * draws with it, which takes as long as many pictures: so one thing of each kind is drawn into a small picture. */
#include "ui/render/frame.h"
#include "ui/render/passes.h"

typedef enum { BACKGROUND, GRID, LINES, SURFACES, SPHERES, OVERLAYS, PUFFS, LENS, STEP_COUNT } Step;

static const double corners[9] = {0, 0, 0, 0.1, 0, 0, 0, 0.1, 0}, sphere[4] = {0, 0, 0, 0.1};
static const float colour[3] = {1, 1, 1};

/* What is drawn in that step; NULL: nothing but the program itself. */
static SporeDrawable *sample_of(Step step) {
  static const guint32 triangle[3] = {0, 1, 2};
  static const SporeSurfaceStyle style = {.colour = {1, 1, 1}};
  static const SporePuff puff = {.radius = 0.1, .opacity = 0.5};
  SporePuffGroup *smoke;
  switch (step) {
  case GRID:
  case LINES:
    return &spore_line_group_new(corners, 1, colour, 1)->base;
  case SURFACES:
    return &spore_surface_new(corners, 3, triangle, 1, &style, NULL)->base;
  case SPHERES:
  case OVERLAYS:
    return &spore_sphere_group_new(sphere, 1, colour, NULL, step == OVERLAYS)->base;
  case PUFFS:
    smoke = spore_puff_group_new(colour);
    spore_puff_group_move(smoke, &puff, 1);
    return &smoke->base;
  default:
    return NULL;
  }
}

static gboolean draw(SporeCanvas *canvas, Step step, const SporeFrame *frame, GPtrArray *things, GError **error) {
  SporePrograms *programs = &canvas->programs;
  const SporeVariant variant = SPORE_VARIANT_FAST;
  switch (step) {
  case BACKGROUND:
    return spore_background_pass(canvas, variant, error);
  case GRID:
    return spore_line_pass(things, frame, programs, variant, FALSE, error);
  case LINES:
    return spore_line_pass(things, frame, programs, variant, TRUE, error);
  case SURFACES:
    return spore_surface_pass(things, frame, programs, variant, FALSE, error);
  case PUFFS:
    return spore_puff_pass(things, frame, programs, variant, error);
  case LENS:
    return spore_lens_pass(canvas, NULL, error);
  default:
    return spore_sphere_pass(things, frame, programs, variant, step == OVERLAYS, error);
  }
}

gboolean spore_canvas_warm(SporeCanvas *canvas, const SporeTarget *target, GError **error) {
  const SporeCamera camera = {.distance = 1, .field_of_view = 0.6};
  const SporeRenderOptions options = {.width = target->width, .height = target->height};
  gboolean drawn = TRUE;
  SporeFrame frame;
  spore_frame_prepare(&frame, &camera, canvas, &options, target->width, target->height);
  spore_canvas_set_frame(canvas, &frame);
  spore_target_bind(target);
  glClear(GL_DEPTH_BUFFER_BIT);
  for (Step step = BACKGROUND; step < STEP_COUNT && drawn; step++) {
    g_autoptr(GPtrArray) things = g_ptr_array_new_with_free_func((GDestroyNotify)spore_drawable_free);
    SporeDrawable *sample = sample_of(step);
    if (sample) g_ptr_array_add(things, sample);
    drawn = draw(canvas, step, &frame, things, error);
  }
  return drawn;
}
