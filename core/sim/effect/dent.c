/* Dents: how tissue gives way to what presses into it, by a formula.
 *
 * A force spread smoothly over the width e displaces a large elastic block by
 *   u(r) = ((a - b) / s I + b / s^3 r r^T + a e^2 / (2 s^3) I) f,  s = sqrt(r^2 + e^2),  b = a / (4 (1 - nu))
 * (F. de Goes and D. L. James, "Regularized Kelvinlets: sculpting brushes based on fundamental solutions of
 * elasticity", ACM Transactions on Graphics 36, 2017, equation 6). It falls as 1/r, so that all of an organ would move.
 * Less the same push of twice the width, it falls as 1/r^3 (their equation 13). The force is the one that moves the
 * middle by the dent's push. */
#include <assert.h>

#include "core/sim/effect/effect.h"

#define POISSON_RATIO 0.45
#define WIDER 2.0 /* of the push that is taken away */

static const double b_over_a = 0.25 / (1 - POISSON_RATIO);

/* u / a for f = push. */
static SporeVec3 displaced(SporeVec3 r, SporeVec3 push, double width) {
  double square = spore_vec3_dot(r, r) + width * width, s = sqrt(square), cube = s * square;
  double straight = (1 - b_over_a) / s + 0.5 * width * width / cube;
  return spore_vec3_add_scaled(spore_vec3_scale(straight, push), b_over_a * spore_vec3_dot(r, push) / cube, r);
}

/* The same in the middle, for a push of 1 m. */
static double middle(double width) { return (1.5 - b_over_a) / width; }

SporeVec3 spore_dents_at(const SporeDent *dents, size_t count, SporeVec3 place) {
  assert(count == 0 || dents);
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < count; i++) {
    const SporeDent *dent = &dents[i];
    assert(dent->width > 0);
    double wide = WIDER * dent->width;
    SporeVec3 r = spore_vec3_sub(place, dent->at);
    SporeVec3 u = spore_vec3_sub(displaced(r, dent->push, dent->width), displaced(r, dent->push, wide));
    sum = spore_vec3_add_scaled(sum, 1 / (middle(dent->width) - middle(wide)), u);
  }
  return sum;
}
