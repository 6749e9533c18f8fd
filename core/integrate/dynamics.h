/* What an integrator sees: M v' = f(q, v), q moved by v, and nothing of bodies or contacts.
 *
 * M may turn with q (a rigid body's inertia does). What integrators add up is therefore momentum: v at q0 and v at q1
 * are compared by `carry`, and `drift` keeps momentum. Where q' = v, momentum is a constant times v and both are plain.
 *
 * Blocks of v that are held (pins) are the dynamics' own affair: force, kick, multiply and precondition give zero
 * for them. All vectors of velocity kind have 3 block_count entries. */
#ifndef SPORE_INTEGRATE_DYNAMICS_H
#define SPORE_INTEGRATE_DYNAMICS_H

#include <stdbool.h>
#include <stddef.h>

#include "core/base/cancel.h"
#include "core/linalg/pcg.h"

/* An equation that a step solved, with its answer, so that others than the solver can evaluate it:
 *   M (v - va) = c f(drift(qa, v, c), v),   M being that at qa.
 * c = 0 stands for the balance of forces, f(qa, v) = 0. */
typedef struct SporeEquation {
  double c;                  /* s */
  double load;               /* norm (r.M^-1 r)^1/2 that the tolerance of the residual r is a part of */
  const double *qa, *va, *v; /* va: NULL where c = 0 */
  bool evaluated;            /* the forces that the solver evaluated last were left where `evaluation` says */
} SporeEquation;

/* Room for the last evaluation of an equation's forces: at q and v, the forces f. */
typedef struct SporeEvaluation {
  double *q, *v, *f;
} SporeEvaluation;

/* How much of K an implicit step takes into its matrix, where forces bear and so may make K indefinite. */
typedef enum SporeTangentForm {
  SPORE_TANGENT_USUAL,   /* of bodies without what is indefinite, of links with it */
  SPORE_TANGENT_WHOLE,   /* all of it */
  SPORE_TANGENT_DEFINITE /* none that is indefinite */
} SporeTangentForm;

typedef struct SporeDynamics {
  void *data;
  size_t q_count, block_count;
  bool switches;             /* some forces set in or end as things move: there are contacts */
  const SporeCancel *cancel; /* ends a step before it is solved: what it leaves is of no use; NULL: none */
  /* From here on forces are elastic where they are evaluated and viscous at `shape` (borrowed), so that the viscous
   * ones are linear in v and A below is the whole Jacobian; first order in time; and they are asked for where nodes
   * moved from `shape` along v for h seconds, which saves work. At first, and with NULL: viscous there too. */
  void (*set_shape)(void *data, const double *shape, double h);
  void (*force)(void *data, const double *q, const double *v, double *f); /* f = all forces, N */
  /* The same in two parts: f = the bodies' own forces, and f += those of contacts and links. */
  void (*body_force)(void *data, const double *q, const double *v, double *f);
  void (*term_force)(void *data, const double *q, const double *v, double *f);
  /* What the elements of bodies do that are met one after the other. loose_force: f = all other forces; NULL: there are
   * no such elements. sweep: from q0, v0 and the v1 that the other forces led to in h seconds to the q1 and v1 of all,
   * as the elements move what has gone a part of the step (core/integrate/position_based.c), which they choose; rows: 4
   * block_count doubles of scratch. */
  void (*loose_force)(void *data, const double *q, const double *v, double *f);
  void (*sweep)(void *data, double h, const double *q0, const double *v0, double *q1, double *v1, double *rows);
  /* What is prescribed (tools) is taken to be where it will be `elapsed_s` after the start of this step; when the step
   * begins that is its end. */
  void (*set_time)(void *data, double elapsed_s);
  void (*set_mass)(void *data, const double *q);                  /* M is that at q from here on; at first that at q0 */
  void (*kick)(void *data, const double *f, double h, double *v); /* v += h M^-1 f */
  void (*drift)(void *data, const double *q0, const double *v, double h, double *q1,
                double *v1); /* force-free motion; q1 and v1 may be q0 and v */
  /* v1 += M(q1)^-1 M dv: the change of momentum that changes v by dv where M is, as a change of v at q1. */
  void (*carry)(void *data, const double *dv, const double *q1, double *v1);
  void (*mass_multiply)(void *data, const double *x, double *y); /* y = M x */
  /* Assembles A = M + c D + c2 K at (q, v), D = -df/dv, K = -df/dq; multiply and precondition then stand for
   * this A. from: the q of the linearisation whose step led to this one, for SporeModelType.tangent, or NULL. */
  void (*linearise)(void *data, const double *q, const double *from, const double *v, double c, double c2);
  /* What of K the next linearisations take; at first SPORE_TANGENT_USUAL. NULL: they have one form only. */
  void (*take_tangent)(void *data, SporeTangentForm form);
  /* Whether that A is positive definite, as far as its factors tell. Where `held`, K in it is whole, and negative where
   * something buckles. */
  bool (*definite)(void *data);
  /* True when the A of an earlier step, made with the same c and c2, may be used again; it is then the current one. */
  bool (*reuse)(void *data, const double *q, const double *v, double c, double c2);
  void (*multiply)(void *data, const double *x, double *y); /* y = A x */
  /* Whether A leaves out part of the Jacobian, because that is not symmetric: how friction that slips changes with what
   * presses; and y = A x with it. */
  bool (*drags)(void *data);
  void (*multiply_dragged)(void *data, const double *x, double *y);
  void (*precondition)(void *data, const double *r, double *z); /* z = P^-1 r, P near A */
  void (*precondition_dragged)(void *data, const double *r,
                               double *z); /* the same for what multiply_dragged stands for */
  /* How long a linear solution goes on before a P that holds what couples bodies, too, is worth making: `more` linear
   * iterations take as much work as that P. Least 0: there is no such P, or P is it. And makes P it, as long as it
   * serves; false: that cannot be. May be NULL: 0. */
  SporePatience (*coupling_patience)(void *data);
  bool (*couple)(void *data);
  /* What linearise costs against a force, a precondition and the rest of a quasi-Newton iteration, where P is a factor
   * of the bodies' part of A; 0 where it is not meant to be one. */
  double (*factor_cost)(void *data);
  bool (*factorised)(void *data); /* whether P is one now */
  /* Linear iterations that take as much work as the factor that P could be and is not: where so many do not solve a
   * system, the step is better taken again with the factor. 0: there is no such factor. May be NULL: 0. */
  size_t (*factor_patience)(void *data);
  size_t patience; /* times the linear iterations after which a step with much left of its load is hopeless; 0: once */
  /* Norm (r.M^-1 r)^1/2 of the rounding that c f carries, by the diagonal of the current A where that was made: along
   * the soft axes alone, or along the stiff ones too. */
  double (*rounding)(void *data, double c, bool stiff_axes);
  /* Where a solver leaves each evaluation of the forces of the equation that it keeps next, over the one before. False:
   * nobody asks. May be NULL: false. */
  bool (*evaluation)(void *data, SporeEvaluation *evaluation);
  /* Keeps a copy of an equation that was solved, or was not, for whoever checks the step. NULL: nobody does. */
  void (*keep)(void *data, const SporeEquation *equation);
  /* Largest root mean square displacement of a body, (x.M x / mass)^1/2, m; x in m. */
  double (*distance)(void *data, const double *x);
  bool buckles;            /* A is the whole of some body's stiffness, which `definite` is asked about */
  bool held;               /* by pins, or by links to what does not follow from q */
  double gravity_momentum; /* (M g . g)^1/2, N / kg^1/2: how big a force is worth looking at */
  double least_force;      /* likewise: what is less is no load, whatever the guess is; 0: anything is one */
} SporeDynamics;

#endif
