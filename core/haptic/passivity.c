/* The energy tank of a device, and the force that it leaves. */
#include "core/haptic/passivity.h"

#include <math.h>
#include <string.h>

#include "core/math/vec3.h"

/* Takes from the tank the energy that the force held since the last tick gave to the hand. */
static void settle(SporePassivity *passivity, const SporePassivityLimits *limits, SporeVec3 position) {
  SporeVec3 way = spore_vec3_sub(position, spore_vec3_load(passivity->position));
  double given = spore_vec3_dot(spore_vec3_load(passivity->force), way);
  passivity->stored = fmin(passivity->stored - given, limits->tank);
}

/* Largest part s of the force that takes no more than `stored` in dt: s F.v dt + s^2 F^2 dt^2 / 2m. The second term is
 * the motion of the device alone, which moves more easily than a device in a hand. */
static double allowed_part(double stored, double speed_part, double square_part) {
  if (speed_part + square_part <= stored) return 1;
  double discriminant = speed_part * speed_part + 4 * square_part * stored;
  if (!(discriminant > 0)) return 0;
  return fmin(fmax((sqrt(discriminant) - speed_part) / (2 * square_part), 0), 1);
}

bool spore_passivity_limit(SporePassivity *passivity, const SporePassivityLimits *limits, const double position[3],
                           double dt_s, double force[3]) {
  SporeVec3 at = spore_vec3_load(position), wanted = spore_vec3_load(force), velocity = {0, 0, 0};
  double length = spore_vec3_length(wanted);
  if (length > limits->force) wanted = spore_vec3_scale(limits->force / length, wanted);
  if (passivity->started) {
    velocity = spore_vec3_scale(1 / dt_s, spore_vec3_sub(at, spore_vec3_load(passivity->position)));
    settle(passivity, limits, at);
  }
  /* The velocity comes from two positions: it may be more than it seems. */
  double speed_part = spore_vec3_dot(wanted, velocity) * dt_s + limits->resolution * spore_vec3_length(wanted);
  double square_part = 0.5 * spore_vec3_dot(wanted, wanted) * dt_s * dt_s / limits->mass;
  double part = square_part > 0 ? allowed_part(fmax(passivity->stored, 0), speed_part, square_part) : 1;
  SporeVec3 told = spore_vec3_scale(part, wanted);
  /* Positions that are known to half the resolution hide so much work where the force changes. */
  double change = spore_vec3_distance(told, spore_vec3_load(passivity->force));
  passivity->stored -= 0.5 * limits->resolution * change;
  spore_vec3_store(force, told);
  memcpy(passivity->position, position, sizeof passivity->position);
  memcpy(passivity->force, force, sizeof passivity->force);
  passivity->started = true;
  return part == 1;
}
