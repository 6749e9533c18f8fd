/* Which shaders a picture of a document needs, told without graphics. */
#ifndef SPORE_UI_RENDER_SHADER_NEEDS_H
#define SPORE_UI_RENDER_SHADER_NEEDS_H

#include "core/scene/compile.h"

typedef struct SporeShaderNeed {
  const char *name; /* file of its fragment shader in resources/shaders */
  guint bodies;     /* that it draws; 0: it is for the picture as a whole */
} SporeShaderNeed;

/* SporeShaderNeed of a picture without marks or grid, in the order of the programs; g_array_unref. simulation: of the
 * document. */
GArray *spore_shader_needs(SporeDocument *document, const SporeSimulation *simulation);

#endif
