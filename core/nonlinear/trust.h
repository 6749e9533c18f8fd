/* Trust in full steps of Newton's method that increase the residual.
 *
 * A full step may increase the residual and still be right: where springs, or a volume, are very stiff the step strains
 * them, and only later steps show how little was missing. Such a step is taken on trust. Trust goes on while the steps
 * get shorter; where the residual has not become good by then, the method goes back and searches along the line
 * (watchdog: R. M. Chamberlain, M. J. D. Powell, C. Lemarechal, H. C. Pedersen, Mathematical Programming Study 16,
 * 1982). No trust is given where forces set in and end: there the step may have missed the next contact, and later
 * steps tell nothing. */
#ifndef SPORE_NONLINEAR_TRUST_H
#define SPORE_NONLINEAR_TRUST_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#define SPORE_TRUST_IDLE 6
#define SPORE_TRUST_FAILURES 2

typedef struct SporeTrust {
  bool given;
  double norm;     /* of the residual where it was given */
  double shortest; /* step since then */
  size_t idle;     /* steps since the shortest */
  size_t failures; /* so far */
} SporeTrust;

/* Begins to trust, with a step of that length, where the residual has that norm. */
static inline void spore_trust_give(SporeTrust *trust, double step, double norm) {
  trust->given = true;
  trust->idle = 0;
  trust->shortest = step;
  trust->norm = norm;
}

/* Whether the steps still get shorter; norm: of the residual after the last one. */
static inline bool spore_trust_is_promising(SporeTrust *trust, double step, double norm) {
  if (!isfinite(norm)) return false;
  trust->idle++;
  if (step < 0.9 * trust->shortest) {
    trust->shortest = step;
    trust->idle = 0;
  }
  return trust->idle < SPORE_TRUST_IDLE;
}

#endif
