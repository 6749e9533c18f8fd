/* SOFA's cases of the comparison, each a world of ours with the same physics. All: gravity (0, -9.81, 0), implicit
 * Euler solved to a relative residual of 1e-6; piles by explicit substeps too, where those are nearer to the answer. */
#ifndef SPORE_BENCH_SOFA_CASES_H
#define SPORE_BENCH_SOFA_CASES_H

#include "tests/stability/rig.h"

typedef struct Case {
  const char *name;
  void (*build)(Rig *rig, const struct Case *self);
  unsigned size[3];       /* what build makes of it */
  const char *sofa;       /* how SOFA came by its figure */
  double sofa_ms;         /* quoted, median of a step */
  double required_ms;     /* what ours is to be; 0: nothing is promised */
  unsigned before, steps; /* steps before those that are measured, and those */
  bool truncated;         /* one nodal body and nothing to touch: also stepped as SOFA steps it, for its error */
  unsigned substeps;      /* more than 0: a second row by symplectic Euler in so many; others are by implicit Euler */
  unsigned compared;      /* steps from the start after which it is compared with much shorter ones; 0: not */
  double lowest;          /* SOFA's lowest y after the steps, m, quoted; 0: not told */
  size_t elements;        /* tetrahedra, springs or spans, each of so many operations: */
  double force_flops, jacobian_flops;
} Case;

/* Operations of one element's force and Jacobian, counted by hand in models/tetrahedra/corotation_kernels.c (five
 * rounds of the polar iteration), models/net/springs.c and models/spline/spline_kernels.c. */
#define TETRAHEDRON_FLOPS .force_flops = 1000, .jacobian_flops = 2600
#define SPRING_FLOPS .force_flops = 35, .jacobian_flops = 75
#define SPAN_FLOPS .force_flops = 260, .jacobian_flops = 900

/* Ended by one without a name. */
extern const Case solid_cases[], net_cases[], rod_cases[], contact_cases[];

/* Builders that families share. */
/* A bulgy solid of 180 nodes and 600 tetrahedra, 6 x 5 x 3 m, about the origin: the size and the counts of SOFA's liver
 * (181, 596), which is not ours to copy. */
void organ_mesh(SporeTetrahedralMesh *mesh);
SporeModel *organ_model(void);

#endif
