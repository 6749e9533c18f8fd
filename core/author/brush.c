/* Painting with balls. */
#include "core/author/brush.h"

#define SPACING 0.5 /* of the radius: nearer dabs add less than 1/20 of it to the depth of what is painted */

typedef struct Ball {
  double centre[3], radius;
} Ball;

static Ball *ball_at(GArray *balls, guint i) { return &g_array_index(balls, Ball, i); }

static double distance(GArray *balls, guint i, SporeVec3 place) {
  return spore_vec3_distance(spore_vec3_load(ball_at(balls, i)->centre), place);
}

GArray *spore_brush_balls_new(const double *balls, gsize count) {
  GArray *array = g_array_new(FALSE, FALSE, sizeof(Ball));
  if (count) g_array_append_vals(array, balls, (guint)count);
  return array;
}

gboolean spore_brush_paint(GArray *balls, SporeVec3 place, double radius) {
  for (guint i = 0; i < balls->len; i++)
    if (ball_at(balls, i)->radius >= radius && distance(balls, i, place) < SPACING * radius) return FALSE;
  for (guint i = balls->len; i-- > 0;)
    if (distance(balls, i, place) + ball_at(balls, i)->radius <= radius) g_array_remove_index(balls, i);
  Ball dab = {.radius = radius};
  spore_vec3_store(dab.centre, place);
  g_array_append_val(balls, dab);
  return TRUE;
}

gboolean spore_brush_erase(GArray *balls, SporeVec3 place, double radius) {
  guint before = balls->len;
  for (guint i = balls->len; i-- > 0;)
    if (distance(balls, i, place) < radius) g_array_remove_index(balls, i);
  return balls->len < before;
}
