/* The balls of a region. */
#include "core/scene/region.h"

#include <glib/gi18n.h>

guint spore_region_ball_count(const SporeObject *region) { return 1 + spore_object_child_count(region); }

void spore_region_read_ball(const SporeObject *object, double ball[4]) {
  spore_vec3_store(ball, spore_object_vector(object, "centre"));
  ball[3] = spore_object_number(object, "radius");
}

double *spore_region_balls(const SporeObject *region, guint *count) {
  *count = region ? spore_region_ball_count(region) : 0;
  double *balls = region ? g_new(double, 4 * *count) : NULL;
  if (region) spore_region_read_ball(region, balls);
  for (guint i = 1; i < *count; i++) spore_region_read_ball(spore_object_child(region, i - 1), balls + 4 * i);
  return balls;
}

gboolean spore_region_check_balls(const SporeObject *region, GError **error) {
  guint count = spore_region_ball_count(region);
  if (count <= SPORE_REGION_BALLS) return TRUE;
  g_autofree char *where = spore_object_where(region);
  return spore_error_raise(
      error, SPORE_ERROR_INPUT, where,
      _("it is painted with %u dabs; expected at most %u; paint it with a wider brush, or split it "
        "into several regions"),
      count, SPORE_REGION_BALLS);
}
