/* The system that every method of this folder moves: mass points, springs, tetrahedra, and balls that do not move.
 * Energies are those of our models: springs k/2 (l - L)^2 with a damper c along them; neo-Hookean tetrahedra
 * m/2 (I - log(I + 1)) + l/2 (J - alpha)^2 (Smith et al. 2018); corotational ones mu |F - R|^2, which is all that a
 * constant matrix stands for; contact k/2 depth^2. */
#ifndef SPORE_BENCH_FIELD_SYSTEM_H
#define SPORE_BENCH_FIELD_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

#include "tests/bench/field/lanes.h"

typedef struct Spring {
  uint32_t a, b;
  double rest, stiffness, damping;
} Spring;

typedef struct Tetrahedron {
  uint32_t corner[4];
  double gradient[3][3]; /* of the weights of corners 1 to 3, rest shape: F = sum (x_k - x_0) gradient_k^T */
  double volume;
} Tetrahedron;

typedef enum Law { NEO_HOOKEAN, COROTATIONAL } Law;

typedef struct System {
  size_t node_count, spring_count, tetrahedron_count, ball_count;
  Lanes *x;            /* node_count + 1: x y z and 1/mass, 0 of one that is held; the last is a node for padding */
  Lanes *v;            /* likewise, fourth component 0 */
  Lanes *acceleration; /* likewise: gravity, 0 of a held node */
  double *mass;
  Spring *springs;
  Tetrahedron *tetrahedra;
  Law law;
  double m, l, alpha; /* neo-Hookean; of the corotational law m is mu */
  double (*balls)[4]; /* centre and the distance at which a node touches */
  double contact_stiffness;
  bool damped;
} System;

System *system_new(size_t nodes, size_t springs, size_t tetrahedra);
void system_free(System *s);
/* Lengths at rest, gradients and volumes from where the nodes are, then masses from density, if positive. */
void system_rest(System *s, double density);
void system_hold(System *s, uint32_t node);
void system_law(System *s, Law law, double young_modulus, double poisson_ratio);
/* After masses and holds: 1/mass and gravity. */
void system_finish(System *s);
/* All forces but gravity are added to f. */
void system_force(const System *s, const Lanes *x, const Lanes *v, Lanes *f);
double system_potential(const System *s, const Lanes *x);

/* Deformation of four tetrahedra at once, and what a law makes of it: columns of the first Piola-Kirchhoff stress. */
Lanes33 law_stress(const System *s, const Lanes33 *f);

/* Numbers of the items in an order in which each `LANES` that follow one another share no node, UINT32_MAX for
 * padding: item i has nodes corner[i * corners ...]. Colours by the first that fits. The count, a multiple of LANES. */
size_t colour(const uint32_t *corner, size_t corners, size_t count, size_t nodes, uint32_t **order);

void *clear_memory(size_t count, size_t size);

#endif
