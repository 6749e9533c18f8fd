/* A straight chain of mass points and springs, each with its own mass and stiffness, whose rest state under gravity is
 * known in closed form. The springs are those of the mass-spring net. */
#ifndef SPORE_TESTS_CHAIN_H
#define SPORE_TESTS_CHAIN_H

#include "core/body/model.h"

/* Nodes 0..count at (0, -i spacing, 0); spring i ties nodes i and i + 1. Copies. */
SporeModel *chain_new(size_t count, double spacing, const double *stiffness, const double *mass, double damping);
/* Heights at rest when node 0 is held and gravity g (m/s^2) pulls down: count + 1. */
void chain_hang(size_t count, double spacing, const double *stiffness, const double *mass, double g, double *height);

#endif
