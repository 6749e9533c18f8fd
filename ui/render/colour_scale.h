/* The scale of colours that shows a quality on spheres, on surfaces, in legends and in histograms. It goes from dark
 * violet to yellow in even steps of lightness, so that it reads without hues ("viridis" of matplotlib, CC0). */
#ifndef SPORE_UI_RENDER_COLOUR_SCALE_H
#define SPORE_UI_RENDER_COLOUR_SCALE_H

#include "core/math/colour.h"

/* value 0..1, clamped; sRGB 0..1. */
void spore_colour_scale(double value, double srgb[3]);
/* Declaration of `vec3 scale_colour(float value)`, linear light, for a shader. g_free. */
char *spore_colour_scale_shader(void);

#endif
