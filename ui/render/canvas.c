/* The canvas: tells the shaders of a frame, and draws everything in the order of the passes. */
#include "ui/render/passes.h"

void spore_canvas_set_frame(SporeCanvas *canvas, const SporeFrame *frame) {
  glBindBuffer(GL_UNIFORM_BUFFER, canvas->block);
  glBufferData(GL_UNIFORM_BUFFER, sizeof frame->block, &frame->block, GL_STREAM_DRAW);
  glBindBufferBase(GL_UNIFORM_BUFFER, 0, canvas->block);
}

gboolean spore_background_pass(SporeCanvas *canvas, SporeVariant variant, GError **error) {
  const SporeProgram *program = spore_programs_get(&canvas->programs, SPORE_PROGRAM_BACKGROUND, variant, error);
  if (!program) return FALSE;
  glUseProgram(program->id);
  glBindVertexArray(canvas->screen_array);
  glDepthMask(GL_FALSE);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
  return TRUE;
}

gboolean spore_lens_pass(SporeCanvas *canvas, const SporeTarget *straight, gboolean wet, GError **error) {
  const SporeProgramKind kind = wet ? SPORE_PROGRAM_LENS : SPORE_PROGRAM_DRY_LENS;
  const SporeProgram *program = spore_programs_get(&canvas->programs, kind, SPORE_VARIANT_FULL, error);
  if (!program) return FALSE;
  glActiveTexture(GL_TEXTURE0 + SPORE_UNIT_COLOUR);
  glBindTexture(GL_TEXTURE_2D, straight ? straight->colour : 0);
  glUseProgram(program->id);
  glBindVertexArray(canvas->screen_array);
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
  return TRUE;
}

/* This order writes each pixel least often: solids, the background behind them, what is
 * clear, smoke, then overlays. */
gboolean spore_canvas_draw(SporeCanvas *canvas, const SporeFrame *frame, SporeVariant variant, gboolean grid,
                           GError **error) {
  GPtrArray *drawables = canvas->drawables;
  SporePrograms *programs = &canvas->programs;
  return spore_surface_pass(drawables, frame, programs, variant, FALSE, error) &&
         spore_cap_pass(drawables, frame, programs, variant, error) &&
         spore_sphere_pass(drawables, frame, programs, variant, FALSE, error) &&
         (frame->backed || spore_background_pass(canvas, variant, error)) &&
         (!grid || spore_line_pass(canvas->grid, frame, programs, variant, FALSE, error)) &&
         spore_surface_pass(drawables, frame, programs, variant, TRUE, error) &&
         spore_puff_pass(drawables, frame, programs, variant, error) &&
         spore_sphere_pass(drawables, frame, programs, variant, TRUE, error) &&
         spore_line_pass(drawables, frame, programs, variant, TRUE, error);
}
