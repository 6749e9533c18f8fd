/* The one scale of colours by which a quality is shown: on spheres, on surfaces, in legends and histograms. Dark violet
 * to yellow with even steps of lightness, so that it reads without seeing hues ("viridis" of matplotlib, CC0). */
#ifndef SPORE_UI_RENDER_COLOUR_SCALE_H
#define SPORE_UI_RENDER_COLOUR_SCALE_H

/* value 0..1, kept within; sRGB 0..1. */
void spore_colour_scale(double value, double srgb[3]);
/* One channel from sRGB to linear light. */
double spore_linear_light(double srgb);
/* Declaration of `vec3 scale_colour(float value)`, linear light, for a shader. g_free. */
char *spore_colour_scale_shader(void);

#endif
