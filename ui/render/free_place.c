/* A place that is farthest to the right, or lowest, touches the side of the view or what lies around: only such places
 * are looked at. */
#include "ui/render/free_place.h"

static gboolean are_apart(const SporePlace *one, const SporePlace *other, int gap) {
  return one->x + one->width + gap <= other->x || other->x + other->width + gap <= one->x ||
         one->y + one->height + gap <= other->y || other->y + other->height + gap <= one->y;
}

static gboolean is_free(const SporeAround *around, const SporePlace *place) {
  if (place->x < around->margin || place->y < around->margin ||
      place->x + place->width > around->width - around->margin ||
      place->y + place->height > around->height - around->margin)
    return FALSE;
  for (guint i = 0; i < around->count; i++)
    if (!are_apart(place, &around->at[i], around->gap)) return FALSE;
  return TRUE;
}

gboolean spore_free_place_find(const SporeAround *around, SporePlace *place) {
  SporePlace best = {.x = -1};
  for (guint i = 0; i <= around->count; i++)
    for (guint k = 0; k <= around->count; k++) {
      SporePlace tried = *place;
      tried.x = (i < around->count ? around->at[i].x - around->gap : around->width - around->margin) - place->width;
      tried.y = (k < around->count ? around->at[k].y - around->gap : around->height - around->margin) - place->height;
      gboolean better = tried.x > best.x || (tried.x == best.x && tried.y > best.y);
      if (better && is_free(around, &tried)) best = tried;
    }
  if (best.x < 0) return FALSE;
  *place = best;
  return TRUE;
}
