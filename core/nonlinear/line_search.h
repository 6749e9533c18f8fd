/* Line search shared by the nonlinear solvers. */
#ifndef SPORE_NONLINEAR_LINE_SEARCH_H
#define SPORE_NONLINEAR_LINE_SEARCH_H

#include "core/nonlinear/system.h"

/* Goes from x along d to where it helps: where the residual norm has halved, or where the residual's part along d is at
 * most half of what it was, forward or back. The residual is very nearly the gradient of an energy, so the answer has
 * not gained any even where it is not solved to tolerance. Where energy still falls at the full step, near the
 * answer (buckling: what A leaves out is negative), it goes further; where the residual points back (a contact that set
 * in on the way) it closes in by false position. Where d does not go downhill (Broyden may say so), the norm has to
 * fall. r and norm: residual at x; on success trial, trial_r, *trial_norm hold the new point, and the length is
 * returned; 0 where no length helps. tried: they hold x + d already. near: how small the norm is near the answer.
 * evaluations is counted up. */
double spore_line_search(const SporeSystem *system, const double *x, const double *d, const double *r, double norm,
                         bool tried, double near, double *trial, double *trial_r, double *trial_norm,
                         size_t *evaluations);

#endif
