/* What a run was like: energy, contacts and the solver's work, gathered step by step from outside the step. */
#ifndef SPORE_MEASURE_RUN_STATISTICS_H
#define SPORE_MEASURE_RUN_STATISTICS_H

#include "core/sim/world.h"

typedef struct SporeRunStatistics {
  size_t steps;
  double energy_start, energy_end; /* total, J; the end is that of the last look */
  double energy_drift;             /* largest |energy - start| of all looks, J */
  double contacts, newton, linear; /* sums over the steps */
  size_t contacts_max, newton_max, linear_max;
  double residual_max; /* relative, worst of all implicit solves */
} SporeRunStatistics;

void spore_run_statistics_start(SporeRunStatistics *statistics, const SporeWorld *world);
/* After each step: counts. */
void spore_run_statistics_step(SporeRunStatistics *statistics, const SporeWorld *world);
/* Looks at the energy: as dear as a force evaluation, so not after every step. */
void spore_run_statistics_energy(SporeRunStatistics *statistics, const SporeWorld *world);
/* A sum as the mean of a step. */
double spore_run_statistics_mean(const SporeRunStatistics *statistics, double sum);

#endif
