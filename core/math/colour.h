/* Colours. */
#ifndef SPORE_MATH_COLOUR_H
#define SPORE_MATH_COLOUR_H

#include <math.h>

/* One channel, 0..1, from sRGB to linear light (IEC 61966-2-1). */
static inline double spore_linear_light(double srgb) {
  return srgb <= 0.04045 ? srgb / 12.92 : pow((srgb + 0.055) / 1.055, 2.4);
}

/* And back. */
static inline double spore_srgb(double light) {
  return light <= 0.0031308 ? 12.92 * light : 1.055 * pow(light, 1 / 2.4) - 0.055;
}

#endif
