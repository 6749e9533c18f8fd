/* A wall that is felt must not give the hand more energy than the hand gave it, however stiff it is and however late
 * the force comes. The world does this for each device that pushes a hand, between reading where it is and telling it
 * its force (core/sim/devices.c).
 *
 * The force is held until the next tick, so the work of the last one is known exactly afterwards (B. Hannaford and
 * J.-H. Ryu, "Time-domain passivity control of haptic interfaces", IEEE Transactions on Robotics and Automation 18,
 * 2002). What the hand gave is kept in a tank; a force that pushes the hand away takes from it, and is shortened where
 * it could take more than is there before the next tick. */
#ifndef SPORE_HAPTIC_PASSIVITY_H
#define SPORE_HAPTIC_PASSIVITY_H

#include <stdbool.h>

/* What is known of the device that a hand holds. */
typedef struct SporePassivityLimits {
  double force;      /* N: the most that the device can give */
  double mass;       /* kg: of the device alone, the least that a force can move */
  double resolution; /* m: positions are known to half of it, 0: exactly */
  double tank;       /* J: more is not kept, so that nothing given long ago comes back at once */
} SporePassivityLimits;

/* A plain value; zero to begin with. */
typedef struct SporePassivity {
  bool started;
  double stored;                /* J, that the hand has given and not got back */
  double position[3], force[3]; /* at the last tick, and held since */
} SporePassivity;

/* One tick, dt_s seconds after the last: the device stands at `position` (m); `force` (N) is to be held until the next
 * and is shortened to what the device can give, and where it would give too much. True: for the latter it was not. */
bool spore_passivity_limit(SporePassivity *passivity, const SporePassivityLimits *limits, const double position[3],
                           double dt_s, double force[3]);

#endif
