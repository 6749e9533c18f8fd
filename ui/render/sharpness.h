/* How sharp pictures are that follow one another: where a sharp one takes too long, those of something that moves have
 * a quarter of the pixels, and the one on which it comes to rest is drawn again. Times are of one clock, us. */
#ifndef SPORE_UI_RENDER_SHARPNESS_H
#define SPORE_UI_RENDER_SHARPNESS_H

#include <glib.h>

typedef struct SporeSharpness {
  gint64 began_us, drawn_us; /* of the last picture */
  gint64 sharp_us;           /* that the last sharp one took; 0: none was drawn */
  guint quick;               /* pictures that each began soon after the one before, without a rest */
  gboolean coarse;           /* the last one was */
} SporeSharpness;

/* A picture begins. Returns how many pixels each way are drawn as one: 1, or 2 for a coarse one. */
int spore_sharpness_begin(SporeSharpness *sharpness, gint64 now_us);
void spore_sharpness_drawn(SporeSharpness *sharpness, gint64 now_us);
/* How long after a coarse picture a sharp one is due, if none has begun by then. */
extern const gint64 spore_sharpness_rest_us;
/* It is: the next picture is sharp. */
void spore_sharpness_rest(SporeSharpness *sharpness);

#endif
