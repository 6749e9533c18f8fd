/* Forces of Lennard-Jones pairs, on a list of clusters. */
#ifndef SPORE_MODELS_PARTICLES_LENNARD_JONES_LAW_H
#define SPORE_MODELS_PARTICLES_LENNARD_JONES_LAW_H

#include "models/particles/cluster_list.h"

/* With s = sigma^2 / r^2, for r below the cut-off c:
 *   force / r = 24 epsilon / r^2 (2 s^6 - s^3) - shift,  energy = 4 epsilon (s^6 - s^3) + shift r^2 / 2 - level
 * shift and level make force and energy begin from zero at the cut-off, without the root that a shift of the force
 * itself would take. Nearer than `core`, force / r stays what it is there: the force is capped, and the energy of two
 * particles at one place is finite. */
typedef struct SporeLennardJonesLaw {
  double cutoff2, core2; /* m^2 */
  double f12, f6, shift; /* force / r = (f12 r^-6 - f6) r^-6 r^-2 - shift */
  double e12, e6, level; /* energy = (e12 r^-6 - e6) r^-6 + shift r^2 / 2 - level */
  double core_stiffness; /* force / r in the core, N/m */
} SporeLennardJonesLaw;

SporeLennardJonesLaw spore_lennard_jones_law(double sigma, double epsilon, double cutoff, double core);

/* lennard_jones_kernels.c. Sets list->f to the forces at list->x. Returns whether the force of a pair was capped. */
SPORE_DECLARE_KERNEL(bool, spore_lennard_jones_force, const SporeClusterList *list, const SporeLennardJonesLaw *law);
SPORE_DECLARE_KERNEL(double, spore_lennard_jones_energy, const SporeClusterList *list, const SporeLennardJonesLaw *law);

#endif
