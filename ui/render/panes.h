/* Pictures of simulations without a window: one of them, or several side by side. */
#ifndef SPORE_UI_RENDER_PANES_H
#define SPORE_UI_RENDER_PANES_H

#include "ui/render/stage.h"

typedef struct SporePanes SporePanes;

/* width, height: pixels of each simulation's picture. NULL with a GError: there is no graphics. Used on the thread that
 * made it alone. */
SporePanes *spore_panes_new(int width, int height, GError **error);
/* What is hidden in all of them; at first nothing is. */
void spore_panes_set_clip(SporePanes *panes, const SporeClip *clip);
void spore_panes_set_light(SporePanes *panes, gboolean light); /* see SporeRenderOptions */
/* Whether pictures carry their legends; at first they do not. */
void spore_panes_set_legends(SporePanes *panes, gboolean legends);
/* Shows what is reached through the ports of that name, see spore_stage_find_ports, in all simulations that are there.
 * FALSE with a GError: there is no such port. */
gboolean spore_panes_show_ports(SporePanes *panes, const char *name, GError **error);
void spore_panes_free(SporePanes *panes); /* NULL is allowed */
/* Adds a simulation at the right of those that are there; document and simulation are borrowed. camera: of the scene,
 * by name; NULL: see spore_stage_camera. FALSE with a GError: no such camera. */
gboolean spore_panes_add(SporePanes *panes, SporeDocument *document, SporeSimulation *simulation, const char *camera,
                         const SporeStageOptions *shown, GError **error);
/* Of the first simulation: the words of its legends, g_free, and the end of its scale of colours
 * (spore_stage_legends_text, spore_stage_field_end). */
char *spore_panes_legends(const SporePanes *panes, double *field_end);
/* Legends that the last picture has no room for; G_MAXUINT with a GError: it carries none, and why. */
guint spore_panes_legends_left_out(const SporePanes *panes, GError **error);
int spore_panes_width(const SporePanes *panes);            /* of the whole picture */
const char *spore_panes_renderer(const SporePanes *panes); /* GL_RENDERER */
/* The simulations as they are now: rows of 4 * width bytes, as spore_renderer_draw gives them. Valid until the next
 * call; NULL with a GError. */
const guint8 *spore_panes_draw(SporePanes *panes, GError **error);

#endif
