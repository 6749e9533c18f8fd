/* A picture in full quality: shadow, occlusion, several samples a pixel, glare, and film. */
#include "ui/render/frame.h"
#include "ui/render/passes.h"

#define SHADOW_SIZE 2048
#define SUPERSAMPLES 2 /* each way */
#define GLOW_SHARE 4   /* glare is computed at a fourth of the size */

static void bind_texture(int unit, GLuint texture) {
  glActiveTexture(GL_TEXTURE0 + (GLenum)unit);
  glBindTexture(GL_TEXTURE_2D, texture);
}

static gboolean prepare(SporePicture *picture, const SporeTarget *screen, int scale, GError **error) {
  int width = screen->width, height = screen->height;
  gboolean fresh = !picture->shadow.framebuffer;
  if (!spore_target_prepare(&picture->shadow, SHADOW_SIZE, SHADOW_SIZE, 0, 0, GL_DEPTH_COMPONENT24, error))
    return FALSE;
  if (fresh) {
    static const float lit[4] = {1, 1, 1, 1}; /* beyond the map there is no shadow */
    glBindTexture(GL_TEXTURE_2D, picture->shadow.depth);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTexParameterfv(GL_TEXTURE_2D, GL_TEXTURE_BORDER_COLOR, lit);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_COMPARE_FUNC, GL_LEQUAL);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  }
  int glow_width = MAX(1, width / GLOW_SHARE), glow_height = MAX(1, height / GLOW_SHARE);
  return spore_target_prepare(&picture->depth, width, height, 0, 0, GL_DEPTH24_STENCIL8, error) &&
         spore_target_prepare(&picture->occlusion, width, height, 0, GL_R8, 0, error) &&
         spore_target_prepare(&picture->smoothed, width, height, 0, GL_R8, 0, error) &&
         spore_target_prepare(&picture->colour, width * scale, height * scale, 0, GL_RGBA16F, GL_DEPTH24_STENCIL8,
                              error) &&
         spore_target_prepare(&picture->glow, glow_width, glow_height, 0, GL_RGBA16F, 0, error) &&
         spore_target_prepare(&picture->glare, glow_width, glow_height, 0, GL_RGBA16F, 0, error);
}

/* Draws the depth of solids alone. */
static gboolean draw_depth(SporeCanvas *canvas, const SporeFrame *frame, const SporeTarget *target,
                           SporeVariant variant, GError **error) {
  spore_target_bind(target);
  glClear(GL_DEPTH_BUFFER_BIT);
  glFrontFace(variant == SPORE_VARIANT_SHADOW ? GL_CCW : GL_CW); /* only the eye's projection is upside down */
  gboolean caps = variant != SPORE_VARIANT_SHADOW; /* the lamp's map has no stencil, and what is cut away no shadow */
  gboolean drawn = spore_surface_pass(canvas->drawables, frame, &canvas->programs, variant, FALSE, error) &&
                   (!caps || spore_cap_pass(canvas->drawables, frame, &canvas->programs, variant, error)) &&
                   spore_sphere_pass(canvas->drawables, frame, &canvas->programs, variant, FALSE, error);
  glFrontFace(GL_CW);
  return drawn;
}

/* Runs a program over the whole target. */
static gboolean filter(SporeCanvas *canvas, SporeProgramKind kind, const SporeTarget *target, float x, float y,
                       GError **error) {
  const SporeProgram *program = spore_programs_get(&canvas->programs, kind, SPORE_VARIANT_FULL, error);
  if (!program) return FALSE;
  glUseProgram(program->id);
  glUniform2f(program->direction, x, y);
  spore_target_bind(target);
  glBindVertexArray(canvas->screen_array);
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  return TRUE;
}

static gboolean draw_occlusion(SporePicture *picture, SporeCanvas *canvas, GError **error) {
  bind_texture(SPORE_UNIT_DEPTH, picture->depth.depth);
  if (!filter(canvas, SPORE_PROGRAM_OCCLUSION, &picture->occlusion, 0, 0, error)) return FALSE;
  bind_texture(SPORE_UNIT_OCCLUSION, picture->occlusion.colour);
  if (!filter(canvas, SPORE_PROGRAM_SMOOTH, &picture->smoothed, 1, 0, error)) return FALSE;
  bind_texture(SPORE_UNIT_OCCLUSION, picture->smoothed.colour);
  if (!filter(canvas, SPORE_PROGRAM_SMOOTH, &picture->occlusion, 0, 1, error)) return FALSE;
  bind_texture(SPORE_UNIT_OCCLUSION, picture->occlusion.colour);
  return TRUE;
}

static gboolean draw_colour(SporePicture *picture, SporeCanvas *canvas, const SporeFrame *frame, gboolean grid,
                            GError **error) {
  spore_target_bind(&picture->colour);
  bind_texture(SPORE_UNIT_SHADOW, picture->shadow.depth);
  glClear(GL_DEPTH_BUFFER_BIT);
  return spore_canvas_draw(canvas, frame, SPORE_VARIANT_FULL, grid, error);
}

static gboolean draw_glare(SporePicture *picture, SporeCanvas *canvas, SporeFrame *frame, GError **error) {
  frame->block.viewport[0] = (float)picture->glow.width, frame->block.viewport[1] = (float)picture->glow.height;
  spore_canvas_set_frame(canvas, frame);
  bind_texture(SPORE_UNIT_COLOUR, picture->colour.colour);
  if (!filter(canvas, SPORE_PROGRAM_GLOW, &picture->glow, 0, 0, error)) return FALSE;
  bind_texture(SPORE_UNIT_COLOUR, picture->glow.colour);
  if (!filter(canvas, SPORE_PROGRAM_GLOW, &picture->glare, 1, 0, error)) return FALSE;
  bind_texture(SPORE_UNIT_COLOUR, picture->glare.colour);
  return filter(canvas, SPORE_PROGRAM_GLOW, &picture->glow, 0, 1, error);
}

gboolean spore_picture_draw(SporePicture *picture, SporeCanvas *canvas, const SporeCamera *camera,
                            const SporeRenderOptions *options, const SporeTarget *screen, int largest, GError **error) {
  int scale = MAX(screen->width, screen->height) * SUPERSAMPLES <= largest ? SUPERSAMPLES : 1;
  SporeFrame small, large;
  if (!prepare(picture, screen, scale, error)) return FALSE;
  spore_frame_prepare(&small, camera, canvas, options, screen->width, screen->height);
  spore_frame_add_shadow(&small, camera, canvas->drawables);
  spore_frame_prepare(&large, camera, canvas, options, picture->colour.width, picture->colour.height);
  spore_frame_add_shadow(&large, camera, canvas->drawables);

  spore_canvas_set_frame(canvas, &small);
  if (!draw_depth(canvas, &small, &picture->shadow, SPORE_VARIANT_SHADOW, error) ||
      !draw_depth(canvas, &small, &picture->depth, SPORE_VARIANT_DEPTH, error) ||
      !draw_occlusion(picture, canvas, error))
    return FALSE;
  spore_canvas_set_frame(canvas, &large);
  if (!draw_colour(picture, canvas, &large, options->grid, error) || !draw_glare(picture, canvas, &large, error))
    return FALSE;
  spore_canvas_set_frame(canvas, &small);
  bind_texture(SPORE_UNIT_COLOUR, picture->colour.colour);
  bind_texture(SPORE_UNIT_GLOW, picture->glow.colour);
  return filter(canvas, SPORE_PROGRAM_COMPOSITE, screen, 0, 0, error);
}

void spore_picture_clear(SporePicture *picture) {
  SporeTarget *const targets[] = {&picture->shadow, &picture->depth, &picture->occlusion, &picture->smoothed,
                                  &picture->colour, &picture->glow,  &picture->glare};
  for (guint i = 0; i < G_N_ELEMENTS(targets); i++) spore_target_clear(targets[i]);
}
