/* What an integrator sees: M v' = f(q, v), q moved by v, and nothing of bodies or contacts.
 *
 * Blocks of v that are held (pins) are the dynamics' own affair: force, kick, multiply and precondition give zero
 * for them. All vectors of velocity kind have 3 block_count entries. */
#ifndef SPORE_INTEGRATE_DYNAMICS_H
#define SPORE_INTEGRATE_DYNAMICS_H

#include <stdbool.h>
#include <stddef.h>

typedef struct SporeDynamics {
  void *data;
  size_t q_count, block_count;
  void (*force)(void *data, const double *q, const double *v, double *f); /* f = all forces, N */
  void (*kick)(void *data, const double *f, double h, double *v);         /* v += h M^-1 f */
  /* v += (M + h D + h^2 K)^-1 h f, with the diagonal blocks of the D and K of contacts and links alone, at (q, v0): as
   * kick where nothing touches, and stable however stiff a contact is. v may not be v0. */
  void (*kick_terms)(void *data, const double *q, const double *v0, const double *f, double h, double *v);
  void (*drift)(void *data, const double *q0, const double *v, double h, double *q1,
                double *v1);                                     /* force-free motion */
  void (*mass_multiply)(void *data, const double *x, double *y); /* y = M x */
  /* Assembles A = M + c D + c2 K at (q, v), D = -df/dv, K = -df/dq; multiply and precondition (block-Jacobi) then
   * stand for this A. */
  void (*linearise)(void *data, const double *q, const double *v, double c, double c2);
  /* True when the A of an earlier step, made with the same c and c2, may be used again; it is then the current one. */
  bool (*reuse)(void *data, const double *q, const double *v, double c, double c2);
  void (*multiply)(void *data, const double *x, double *y);     /* y = A x */
  void (*precondition)(void *data, const double *r, double *z); /* z = diagonal blocks of A, inverted, times r */
  /* Norm (r.M^-1 r)^1/2 of the rounding that c f carries at q, by the diagonal of the current A. */
  double (*rounding)(void *data, const double *q, double c);
  double gravity_momentum; /* (M g . g)^1/2, N / kg^1/2: how big a force is worth looking at */
} SporeDynamics;

#endif
