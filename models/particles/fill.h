/* Particles that fill a solid, and points that follow them. */
#ifndef SPORE_MODELS_PARTICLES_FILL_H
#define SPORE_MODELS_PARTICLES_FILL_H

#include "core/base/cancel.h"
#include "core/mesh/mesh.h"
#include "core/body/mapping.h"

/* Centres inside a closed surface, on a face-centred cubic lattice with `wanted` places in the surface's volume, m^3:
 * so about that many. *points from spore_allocate. Refuses a surface that is open or holds no volume, and one too thin
 * to hold four particles. */
bool spore_particle_fill(const SporeTriangleMesh *surface, size_t wanted, const SporeCancel *cancel, double **points,
                         size_t *count, double *volume, SporeError *error);

/* A point at a particle follows it; another one keeps its place among four that lie around it. The particles
 * themselves, in their order, give the identity. `spacing`: of the particles, m. Refuses a point where they all lie in
 * one plane. */
bool spore_particle_map(const double *particles, size_t particle_count, double spacing, const double *points,
                        size_t count, const SporeCancel *cancel, SporeMapping *mapping, SporeError *error);

#endif
