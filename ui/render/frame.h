/* What the shaders get of a frame: projection, light, range of depth. */
#ifndef SPORE_UI_RENDER_FRAME_H
#define SPORE_UI_RENDER_FRAME_H

#include "ui/render/passes.h"

/* Fills the frame for the visible drawables and the cones of the canvas. width x height: of the buffer drawn into. */
void spore_frame_prepare(SporeFrame *frame, const SporeCamera *camera, const SporeCanvas *canvas,
                         const SporeRenderOptions *options, int width, int height);
/* Adds the lamp's view of the visible drawables near the camera's target. */
void spore_frame_add_shadow(SporeFrame *frame, const SporeCamera *camera, GPtrArray *drawables);

#endif
