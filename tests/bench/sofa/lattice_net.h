/* A net as SOFA's benchmark has it: mass points in a lattice, springs along the edges and both diagonals of every cell,
 * each of stiffness `tension` / rest length, under Rayleigh damping. */
#ifndef SPORE_BENCH_LATTICE_NET_H
#define SPORE_BENCH_LATTICE_NET_H

#include "core/body/model.h"

typedef struct LatticeNet LatticeNet;
typedef void (*LatticePlace)(const LatticeNet *net, unsigned column, unsigned row, double *x);

struct LatticeNet {
  unsigned columns, rows;
  double spacing;           /* m */
  double mass;              /* kg, of the whole net, shared evenly */
  double tension;           /* N: a spring of rest length L has stiffness tension / L */
  double mass_damping;      /* 1/s: force -mass_damping m v */
  double stiffness_damping; /* s: a spring of stiffness k damps the speed of its length by stiffness_damping k */
  LatticePlace start;       /* where a node starts; NULL: flat, y = 0 */
};

/* Node (column, row) is block row * columns + column. The net lies centred about the origin, columns along x, rows
 * along z. Its rest lengths are those of the flat net wherever it starts. */
SporeModel *lattice_net_new(const LatticeNet *net);
/* Where the nodes start, count x 3. */
void lattice_net_points(const LatticeNet *net, double *points);

#endif
