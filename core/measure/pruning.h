/* What leaving out saves: a world beside the same world that leaves nothing out (SporeWorldDescription.unpruned). */
#ifndef SPORE_MEASURE_PRUNING_H
#define SPORE_MEASURE_PRUNING_H

#include "core/sim/world.h"

#define SPORE_PRUNING_STEPS 200 /* that a measured plan takes */

/* Figures of two worlds that took the same steps. */
typedef struct SporePruning {
  size_t steps;                        /* that each world took */
  double us, unpruned_us;              /* median of a step, us of the clock */
  double ratio, ratio_low, ratio_high; /* unpruned to pruned, of steps that were taken one after the other: median, and
                                          the quartiles */
  bool equal;                          /* the states were the same to the bit after each step */
  double worst;       /* m: largest distance between a node, or the origin of a frame, in both worlds */
  size_t most_asleep; /* bodies that slept in one step; in the other world none does */
} SporePruning;

/* Takes `steps` steps of both worlds in turn, so that what else the machine does meets both alike. Both worlds are at
 * time 0 and made from the same scene. ratios: room for `steps` numbers. False: one of them was cancelled, and there
 * are no figures. */
bool spore_pruning_measure(SporeWorld *world, SporeWorld *unpruned, size_t steps, double *ratios,
                           SporePruning *pruning);

/* What leaving out the stages saves a step, us: the sum of the stages' medians in `unpruned` less those in `world`.
 * stages: names of stages, with a space between. Below 0: the stages cost more in `world`, which is noise where both
 * are about the same. */
double spore_pruning_saved_us(const SporeWorld *world, const SporeWorld *unpruned, const char *stages);

#endif
