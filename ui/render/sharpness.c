/* How sharp pictures are that follow one another. */
#include "ui/render/sharpness.h"

#define LONGEST_SHARP_US 33000 /* 30 pictures a second */
#define FEWEST_QUICK 2         /* a click draws two pictures, and nothing moves */

const gint64 spore_sharpness_rest_us = 150000;

int spore_sharpness_begin(SporeSharpness *sharpness, gint64 now_us) {
  gboolean soon = sharpness->drawn_us > 0 && now_us - sharpness->drawn_us < spore_sharpness_rest_us;
  sharpness->quick = soon ? sharpness->quick + 1 : 0;
  sharpness->coarse = sharpness->quick >= FEWEST_QUICK && sharpness->sharp_us > LONGEST_SHARP_US;
  sharpness->began_us = now_us;
  return sharpness->coarse ? 2 : 1;
}

void spore_sharpness_drawn(SporeSharpness *sharpness, gint64 now_us) {
  sharpness->drawn_us = now_us;
  if (!sharpness->coarse) sharpness->sharp_us = now_us - sharpness->began_us;
}

void spore_sharpness_rest(SporeSharpness *sharpness) { sharpness->drawn_us = 0; }
