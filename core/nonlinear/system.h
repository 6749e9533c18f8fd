/* What a nonlinear solver sees: a system r(x) = 0 with an inner product, and nothing of what it stands for.
 *
 * The system linearises itself: A ~ -dr/dx, symmetric positive definite but for what friction adds, is kept by the
 * system until the next `linearise`. `dot` is an inner product on x (kinetic energy's), `norm` the dual norm of a
 * residual. A is no less than the matrix of `dot`, so that |A^-1 r| <= norm(r), but where something buckles. */
#ifndef SPORE_NONLINEAR_SYSTEM_H
#define SPORE_NONLINEAR_SYSTEM_H

#include <stdbool.h>
#include <stddef.h>

#include "core/linalg/pcg.h"

typedef struct SporeSystem {
  void *data;
  size_t count;  /* unknowns */
  bool switches; /* there are forces that set in or end with x, such as those of contacts */
  const SporeCancel
      *cancel; /* asked in each iteration; what was reached then is the answer, not converged; NULL: none */
  /* r(x); entries that are not finite are allowed and make `norm` not finite. */
  void (*residual)(void *data, const double *x, double *r);
  /* from: where the step to x was taken by the linearisation there, or NULL; what that promised of x may serve better
   * than what x shows. */
  void (*linearise)(void *data, const double *x, const double *from);
  /* The same by all of -dr/dx that is symmetric, where A usually leaves out what may make it indefinite; NULL: it does
   * not. */
  void (*linearise_whole)(void *data, const double *x, const double *from);
  /* True when an earlier linearisation may stand in for a new one, and is now the current one. */
  bool (*reuse)(void *data, const double *x);
  /* dx ~ A^-1 r to a relative residual. */
  SporeLinearResult (*solve)(void *data, const double *r, double tolerance, double *dx);
  /* The same by the whole of -dr/dx, which need not be symmetric; NULL: A is. */
  SporeLinearResult (*solve_whole)(void *data, const double *r, double tolerance, double *dx);
  /* dx ~ A^-1 r by an operator that is linear, or nearly, at the least cost: quasi-Newton methods mend what it lacks.
   */
  SporeLinearResult (*approximate)(void *data, const double *r, double *dx);
  /* What linearising costs, counted in quasi-Newton iterations. */
  double (*linearisation_cost)(void *data);
  double (*dot)(void *data, const double *a, const double *b);
  void (*weigh)(void *data, const double *x, double *y); /* a.y = dot(a, x) */
  double (*norm)(void *data, const double *r);
  /* Size of x below which a change is not one, and of r below which it is: sums over what r is made of. */
  double scale_x, scale_r;
  /* Size of r, and of x, that is none, whatever the guess is: beside a residual that is rounding alone any would do. */
  double least;
  /* Norm of the load at x besides that of scale_r: where both are 0 there is nothing to solve but rounding. NULL: what
   * the residual is at the guess. */
  double (*load)(void *data, const double *x);
  /* Norm of the rounding in r at x, by the current linearisation. Along the soft axes alone: below it nothing is left
   * to solve. Along the stiff ones too: no solver can be sure to get below it, though what is soft may get better. */
  double (*rounding)(void *data, const double *x, bool stiff_axes);
} SporeSystem;

typedef struct SporeNonlinearOptions {
  size_t iterations; /* Newton's, at most */
  double tolerance;  /* of the residual and of the next change of x, both relative */
  bool linearised;   /* the system is, at the guess: Newton's method begins with that */
  double load;       /* where another method goes on: norm that its residual was relative to, the most that this one's
                        may be; 0: this is the first */
  /* Linear iterations after which Newton's method ends where the linear solver meets its limit: another solver would
   * have taken less work. 0: it never ends for that. */
  size_t linear_patience;
  size_t patience; /* times SPORE_HOPELESS_WORK that may be put into what seems hopeless; 0: once */
} SporeNonlinearOptions;

typedef struct SporeNonlinearResult {
  bool converged; /* the residual is within the tolerance, or is down to rounding and does not fall any more */
  bool finite;
  size_t iterations, linear_iterations, evaluations, linearisations;
  size_t unsolved; /* linear systems that did not reach their tolerance */
  double residual; /* relative, at the x returned */
  double load;     /* norm that the residual is relative to */
  bool indefinite; /* the linear solver met a direction of negative curvature */
} SporeNonlinearResult;

/* A residual above that part of the load after so many linear iterations is hopeless: no more work is put into it. */
#define SPORE_HOPELESS 0.5
#define SPORE_HOPELESS_WORK 1000

/* Newton's method with inexact linear solves and a line search. x holds the guess, and the answer after it; what is
 * best so far when it did not converge. r: the residual at the guess, overwritten. scratch: SPORE_NEWTON_SCRATCH x
 * count doubles. */
#define SPORE_DIFFERENCES 8 /* of iterations, that both methods keep */
#define SPORE_DIFFERENCES_SCRATCH (2 + 2 * SPORE_DIFFERENCES)
#define SPORE_NEWTON_SCRATCH (9 + SPORE_DIFFERENCES_SCRATCH)
SporeNonlinearResult spore_newton(const SporeSystem *system, const SporeNonlinearOptions *options, double *x, double *r,
                                  double *scratch);

/* Broyden's method with limited memory, in the form that meets the last differences all at once (Anderson's; H. Fang
 * and Y. Saad, "Two classes of multisecant methods for nonlinear acceleration", Numerical Linear Algebra with
 * Applications 16, 2009), from the linearisation that `reuse` allows. It takes a new one where that costs less than the
 * iterations it saves, by how the residual shrinks, and hands over to Newton where that fails or takes more iterations
 * than Newton may. Its own are cheap and count half: together they are at most one and a half times as many. */
#define SPORE_BROYDEN_SCRATCH SPORE_NEWTON_SCRATCH
SporeNonlinearResult spore_broyden(const SporeSystem *system, const SporeNonlinearOptions *options, double *x,
                                   double *r, double *scratch);

#endif
