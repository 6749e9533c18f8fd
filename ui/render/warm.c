/* Makes programs ready before a picture needs them. A driver that draws on processors compiles a program when it first
 * draws with it, which takes as long as many pictures: so one thing of each kind is drawn into a small picture. */
#include <string.h>

#include "ui/render/frame.h"
#include "ui/render/passes.h"

/* A surface of each kind is another thing to the driver: what its vertices have, how it is blended, and what cuts it.
 */
typedef enum {
  BACKGROUND,
  GRID,
  LINES,
  SURFACES,
  METAL,
  LIQUID,
  VALUED,
  STAINED,
  CLEAR,
  TEXTURED,
  STAINED_TEXTURED,
  SPHERES,
  OVERLAYS,
  PUFFS,
  LENS,
  DRY_LENS,
  CUT, /* a surface, and the cap that fills it */
  STEP_COUNT
} Step;

static const double corners[12] = {0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1}, sphere[4] = {0, 0, 0, 0.1};
static const float colour[3] = {1, 1, 1};

/* A closed surface. */
static SporeDrawable *surface_of(Step step, const SporeTextureImage *texture) {
  static const guint32 triangles[12] = {0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};
  static const float numbers[4] = {0.5f, 0.5f, 0.5f, 0.5f}, places[24] = {0};
  const SporeMaterial material = step == METAL                     ? SPORE_MATERIAL_METAL
                                 : step == LIQUID || step == CLEAR ? SPORE_MATERIAL_LIQUID
                                                                   : SPORE_MATERIAL_TISSUE;
  const SporeSurfaceStyle style = {.colour = {1, 1, 1}, .material = material, .clearness = step == CLEAR ? 0.5f : 0};
  SporeSurfaceGroup *surface = spore_surface_new(corners, 4, triangles, 4, &style, step == VALUED ? numbers : NULL);
  if (step == TEXTURED || step == STAINED_TEXTURED) spore_surface_lay(surface, corners, texture, places);
  if (step == STAINED || step == STAINED_TEXTURED) spore_surface_stain(surface, numbers);
  return &surface->base;
}

/* What is drawn in that step; NULL: nothing but the program itself. */
static SporeDrawable *sample_of(Step step, const SporeTextureImage *texture) {
  static const SporePuff puff = {.radius = 0.1, .opacity = 0.5};
  SporePuffGroup *smoke;
  switch (step) {
  case GRID:
  case LINES:
    return &spore_line_group_new(corners, 1, colour, 1)->base;
  case SURFACES:
  case METAL:
  case LIQUID:
  case VALUED:
  case STAINED:
  case CLEAR:
  case TEXTURED:
  case STAINED_TEXTURED:
  case CUT:
    return surface_of(step, texture);
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
  case METAL:
  case LIQUID:
  case VALUED:
  case STAINED:
  case CLEAR:
  case TEXTURED:
  case STAINED_TEXTURED:
    return spore_surface_pass(things, frame, programs, variant, step == CLEAR, error);
  case CUT:
    return spore_surface_pass(things, frame, programs, variant, FALSE, error) &&
           spore_cap_pass(things, frame, programs, variant, error);
  case PUFFS:
    return spore_puff_pass(things, frame, programs, variant, error);
  case LENS:
  case DRY_LENS:
    return spore_lens_pass(canvas, NULL, step == LENS, error);
  default:
    return spore_sphere_pass(things, frame, programs, variant, step == OVERLAYS, error);
  }
}

static SporeTextureImage *white_texture(GError **error) {
  enum { SIDE = 4 };
  guint8 white[4 * SIDE * SIDE];
  memset(white, 255, sizeof white);
  g_autoptr(GBytes) png = spore_png_encode(white, SIDE, SIDE, 4 * SIDE, error);
  return png ? spore_texture_image_new("white", png, error) : NULL;
}

gboolean spore_canvas_warm(SporeCanvas *canvas, const SporeTarget *target, GError **error) {
  const SporeCamera camera = {.distance = 1, .field_of_view = 0.6};
  SporeRenderOptions options = {.width = target->width, .height = target->height};
  SporeTextureImage *texture = white_texture(error);
  gboolean drawn = texture != NULL;
  for (Step step = BACKGROUND; step < STEP_COUNT && drawn; step++) {
    SporeFrame frame;
    g_autoptr(GPtrArray) things = g_ptr_array_new_with_free_func((GDestroyNotify)spore_drawable_free);
    SporeDrawable *sample = sample_of(step, texture);
    if (sample) g_ptr_array_add(things, sample);
    if (step == CUT) options.clip = (SporeClip){{1, 0, 0}, 0.02};
    spore_frame_prepare(&frame, &camera, canvas, &options, target->width, target->height);
    spore_canvas_set_frame(canvas, &frame);
    spore_target_bind(target);
    glClear(GL_DEPTH_BUFFER_BIT);
    drawn = draw(canvas, step, &frame, things, error);
  }
  spore_texture_image_free(texture);
  return drawn;
}
