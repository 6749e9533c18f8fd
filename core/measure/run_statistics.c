/* Sums up energy, contacts, solver work and local error over the steps of a run. */
#include "core/measure/run_statistics.h"

#include <math.h>

/* Sum of all kinds, J. */
static double total_energy(const SporeWorld *world) {
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal + energy.gravity + energy.contact;
}

void spore_run_statistics_start(SporeRunStatistics *statistics, const SporeWorld *world, double dt_s) {
  double energy = total_energy(world);
  *statistics = (SporeRunStatistics){.energy_start = energy, .energy_end = energy};
  spore_local_error_init(&statistics->local_error, world, dt_s);
  spore_loops_start(&statistics->loops, world);
}

void spore_run_statistics_clear(SporeRunStatistics *statistics) {
  spore_local_error_clear(&statistics->local_error);
  spore_loops_clear(&statistics->loops);
}

static size_t larger(size_t a, size_t b) { return a > b ? a : b; }

void spore_run_statistics_step(SporeRunStatistics *statistics, const SporeWorld *world) {
  SporeStepCounts counts = spore_world_counts(world);
  statistics->steps++;
  statistics->contacts += (double)counts.contacts;
  statistics->newton += (double)counts.newton_iterations;
  statistics->linear += (double)counts.linear_iterations;
  statistics->contacts_max = larger(statistics->contacts_max, counts.contacts);
  statistics->newton_max = larger(statistics->newton_max, counts.newton_iterations);
  statistics->linear_max = larger(statistics->linear_max, counts.linear_iterations);
  statistics->depth_max = fmax(statistics->depth_max, counts.contact_depth);
  statistics->force_max = fmax(statistics->force_max, counts.contact_force);
  statistics->residual_max = fmax(statistics->residual_max, counts.residual);
  spore_local_error_step(&statistics->local_error, world);
  spore_loops_step(&statistics->loops, world);
  if (statistics->steps % SPORE_ENERGY_PERIOD == 0) spore_run_statistics_energy(statistics, world);
}

void spore_run_statistics_energy(SporeRunStatistics *statistics, const SporeWorld *world) {
  statistics->energy_end = total_energy(world);
  statistics->energy_drift = fmax(statistics->energy_drift, fabs(statistics->energy_end - statistics->energy_start));
}

double spore_run_statistics_mean(const SporeRunStatistics *statistics, double sum) {
  return statistics->steps ? sum / (double)statistics->steps : 0;
}
