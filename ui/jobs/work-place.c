/* How far a work is. */
#include "ui/jobs/work-place.h"

static bool report(void *data, double fraction, const char *stage) {
  SporeWorkPlace *place = data;
  place->fraction = fraction;
  return spore_progress(place->whole, fraction, stage);
}

static bool asked(void *data) {
  const SporeWorkPlace *place = data;
  return !spore_progress(place->whole, place->fraction, NULL);
}

void spore_work_place_init(SporeWorkPlace *place, const SporeProgress *whole) {
  *place = (SporeWorkPlace){.whole = whole, .progress = {report, place, NULL}, .cancel = {asked, place}};
}
