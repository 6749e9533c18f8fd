/* The contact of two spheres: overlapping, on their way to meet, or behind them. */
#include "core/collide/narrow.h"

#include <assert.h>

/* Of centres nearer than this part of the radii, the direction means nothing. */
#define COINCIDENT 1e-12

static SporeVec3 normal_of_coincident(SporeVec3 relative_velocity) {
  double speed = spore_vec3_length(relative_velocity);
  return speed > 1e-12 ? spore_vec3_scale(-1 / speed, relative_velocity) : (SporeVec3){0, 1, 0};
}

/* Time at which the offset p, moving with w, first has length r; negative: not ahead. p is longer than r. */
static double time_of_touch(SporeVec3 p, SporeVec3 w, double r) {
  double b = spore_vec3_dot(p, w), c = spore_vec3_dot(p, p) - r * r;
  double discriminant = b * b - spore_vec3_dot(w, w) * c;
  return b < 0 && discriminant >= 0 ? c / (sqrt(discriminant) - b) : -1;
}

bool spore_narrow_contact(const SporeSpheres *spheres, uint32_t a, uint32_t b, double dt_s, bool soft,
                          SporeContact *contact) {
  assert(a < b && b < spheres->count);
  assert(dt_s >= 0);
  SporeVec3 offset = spore_vec3_sub(spore_vec3_load(spheres->centre + 3 * a), spore_vec3_load(spheres->centre + 3 * b));
  SporeVec3 velocity =
      spore_vec3_sub(spore_vec3_load(spheres->velocity + 3 * a), spore_vec3_load(spheres->velocity + 3 * b));
  double ra = spheres->radius[a], rb = spheres->radius[b], sum = ra + rb, square = spore_vec3_dot(offset, offset);
  contact->a = a;
  contact->b = b;
  if (square < sum * sum) {
    double distance = sqrt(square);
    contact->normal =
        distance > COINCIDENT * sum ? spore_vec3_scale(1 / distance, offset) : normal_of_coincident(velocity);
    contact->depth = sum - distance;
    contact->gap_speed = spore_vec3_dot(contact->normal, velocity);
    return true;
  }
  double speed = spore_vec3_length(velocity);
  if (!(soft ? speed * dt_s > SPORE_SPHERES_FAST * fmin(ra, rb) : speed > spheres->slowest)) return false;
  double touch_s = time_of_touch(offset, velocity, sum);
  if (!(touch_s >= 0 && touch_s <= (soft ? 1 : SPORE_SPHERES_AHEAD) * dt_s)) return false;
  contact->normal = spore_vec3_normalise(spore_vec3_add_scaled(offset, touch_s, velocity), (SporeVec3){0, 1, 0});
  contact->gap_speed = spore_vec3_dot(contact->normal, velocity);
  contact->depth = contact->gap_speed * touch_s;
  return true;
}

bool spore_narrow_passed(const SporeSpheres *spheres, uint32_t a, uint32_t b, double dt_s, SporeContact *contact) {
  assert(a < b && b < spheres->count);
  assert(spheres->before && dt_s > 0);
  SporeVec3 from = spore_vec3_sub(spore_vec3_load(spheres->before + 3 * a), spore_vec3_load(spheres->before + 3 * b));
  SporeVec3 to = spore_vec3_sub(spore_vec3_load(spheres->centre + 3 * a), spore_vec3_load(spheres->centre + 3 * b));
  SporeVec3 way = spore_vec3_sub(to, from);
  double ra = spheres->radius[a], rb = spheres->radius[b], square = spore_vec3_dot(way, way), least = fmin(ra, rb);
  if (!(square > least * least)) return false; /* nor where one was put since */
  double part = -spore_vec3_dot(from, way) / square;
  if (!(part > 0 && part < 1)) return false;
  SporeVec3 nearest = spore_vec3_add_scaled(from, part, way);
  double distance = spore_vec3_length(nearest), speed = sqrt(square) / dt_s;
  SporeVec3 back = spore_vec3_scale(-1 / sqrt(square), way);
  *contact = (SporeContact){.a = a, .b = b, .normal = back, .depth = ra + rb - distance, .gap_speed = -speed};
  return contact->depth > least;
}
