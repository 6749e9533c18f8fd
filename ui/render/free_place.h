/* A place on the screen where nothing else lies. */
#ifndef SPORE_UI_RENDER_FREE_PLACE_H
#define SPORE_UI_RENDER_FREE_PLACE_H

#include <glib.h>

/* A rectangle, pixels; x, y: its upper left corner. */
typedef struct SporePlace {
  int x, y, width, height;
} SporePlace;

/* Things that lie in a view of that size, and what is kept free beside them and at the sides of the view, pixels. */
typedef struct SporeAround {
  int width, height, gap, margin;
  guint count;
  const SporePlace *at;
} SporeAround;

/* Sets x and y of the place, whose size is given: as far to the right as it may, and there as low as it may. FALSE:
 * there is no room. */
gboolean spore_free_place_find(const SporeAround *around, SporePlace *place);

#endif
