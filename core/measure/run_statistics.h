/* Statistics of a run: energy, contacts and the solver's work, collected after each step from outside of the step. */
#ifndef SPORE_MEASURE_RUN_STATISTICS_H
#define SPORE_MEASURE_RUN_STATISTICS_H

#include "core/sim/world.h"

typedef struct SporeRunStatistics {
  size_t steps;
  double energy_start, energy_end; /* total, J; energy_end: at the last call of spore_run_statistics_energy */
  double energy_drift;             /* largest |energy - energy_start| of these calls, J */
  double contacts, newton, linear; /* sums over the steps */
  size_t contacts_max, newton_max, linear_max;
  double residual_max; /* relative, worst of all steps: see SporeStepCounts */
} SporeRunStatistics;

void spore_run_statistics_start(SporeRunStatistics *statistics, const SporeWorld *world);
/* Adds the counts of a step; to be called after each step. */
void spore_run_statistics_step(SporeRunStatistics *statistics, const SporeWorld *world);
/* Measures the energy. This costs as much as an evaluation of the forces, so it is not done after every step. */
void spore_run_statistics_energy(SporeRunStatistics *statistics, const SporeWorld *world);
/* The mean of a sum over the steps. */
double spore_run_statistics_mean(const SporeRunStatistics *statistics, double sum);

#endif
