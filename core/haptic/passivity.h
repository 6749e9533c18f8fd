/* A wall that is felt must not give the hand more energy than the hand gave it, however stiff it is and however late
 * the force comes. For whoever drives a device: between reading where it is and telling it its force.
 *
 * The force is held until the next tick, so the work of the last one is known exactly afterwards (B. Hannaford and
 * J.-H. Ryu, "Time-domain passivity control of haptic interfaces", IEEE Transactions on Robotics and Automation 18,
 * 2002). What the hand gave is kept in a tank; a force that pushes the hand away takes from it, and is shortened where
 * it could take more than is there before the next tick. */
#ifndef SPORE_HAPTIC_PASSIVITY_H
#define SPORE_HAPTIC_PASSIVITY_H

#include <stdbool.h>

typedef struct SporePassivityLimits {
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

/* One tick: the device stands at `position` (m) and moves with `velocity` (m/s); `force` (N) is to be held for dt_s
 * seconds and is shortened where it has to be. True: it was not. */
bool spore_passivity_limit(SporePassivity *passivity, const SporePassivityLimits *limits, const double position[3],
                           const double velocity[3], double dt_s, double force[3]);

#endif
