/* Statistics of a run: energy, contacts, the solver's work, the local error and loops, collected after each step from
 * outside of the step. */
#ifndef SPORE_MEASURE_RUN_STATISTICS_H
#define SPORE_MEASURE_RUN_STATISTICS_H

#include "core/measure/local_error.h"
#include "core/measure/loops.h"

#define SPORE_ENERGY_PERIOD 64 /* steps from one look at the energy to the next; a look costs as much as the forces */

typedef struct SporeRunStatistics {
  size_t steps;
  double energy_start, energy_end; /* total, J; energy_end: at the last look */
  double energy_drift;             /* largest |energy - energy_start| of all looks, J */
  double contacts, newton, linear; /* sums over the steps */
  size_t contacts_max, newton_max, linear_max;
  double depth_max, force_max; /* of contacts, m and N: see SporeStepCounts */
  double residual_max;         /* relative, worst of all steps: see SporeStepCounts */
  SporeLocalError local_error;
  SporeLoops loops;
} SporeRunStatistics;

/* Begins with a look at the energy. dt_s: the step. Without memory for them, local errors are not estimated
 * and loops not measured. Clear by spore_run_statistics_clear. */
void spore_run_statistics_start(SporeRunStatistics *statistics, const SporeWorld *world, double dt_s);
void spore_run_statistics_clear(SporeRunStatistics *statistics);
/* Adds the counts of a step, and looks at energy and local error where it is time to; to be called after each step. */
void spore_run_statistics_step(SporeRunStatistics *statistics, const SporeWorld *world);
/* Looks at the energy; to be called at the end of a run. */
void spore_run_statistics_energy(SporeRunStatistics *statistics, const SporeWorld *world);
/* The mean of a sum over the steps. */
double spore_run_statistics_mean(const SporeRunStatistics *statistics, double sum);

#endif
