/* Local error of steps, estimated from outside while a world runs.
 *
 * A step from x0, v0 to x1, v1 in h is compared with the trapezoidal rule, of second order, and that rule with its own
 * next term:
 *   |x1 - x0 - h (v0 + v1)/2| + h |v1 - 2 v0 + v-1| / 12,
 * v-1 being the velocity before. To leading order, the sum is no smaller than the error in position that the step made
 * (Hairer, Noersett and Wanner, Solving Ordinary Differential Equations I, II.1 and III.2: the trapezoidal rule's error
 * is h^3 x'''/12). For a method of first order the sum is close to that error, for a better one it is larger. Each norm
 * is the root mean square over a body's mass, (d.M d / mass)^1/2; of a frame the turning is left out. Where a contact
 * sets in within the three steps, the motion has no such order, and the sum tells of the impact. */
#ifndef SPORE_MEASURE_LOCAL_ERROR_H
#define SPORE_MEASURE_LOCAL_ERROR_H

#include "core/sim/world.h"

/* Steps from one estimate to the next: estimating costs next to nothing. */
#define SPORE_LOCAL_ERROR_PERIOD 64

typedef struct SporeLocalErrorBody SporeLocalErrorBody;

typedef struct SporeLocalError {
  double dt_s;
  size_t samples;                /* estimates so far */
  double last, most;             /* m: of the body that is worst; at the last estimate; of all */
  double sum;                    /* m: of all estimates */
  uint32_t last_body, most_body; /* the bodies that are worst; SPORE_NO_BODY: nothing has moved */
  SporeLocalErrorBody *bodies;   /* one a body; owned */
  size_t body_count;
} SporeLocalError;

/* Makes room for what is kept between steps. dt_s: the step. False: no memory; *estimate is empty then, and may be
 * used: it estimates nothing. */
bool spore_local_error_init(SporeLocalError *estimate, const SporeWorld *world, double dt_s);
void spore_local_error_clear(SporeLocalError *estimate);
/* Begins anew, for a world at time 0. */
void spore_local_error_reset(SporeLocalError *estimate);
/* To be called after each step; does something in three of SPORE_LOCAL_ERROR_PERIOD steps. True: there is a new
 * estimate.
 */
bool spore_local_error_step(SporeLocalError *estimate, const SporeWorld *world);

#endif
