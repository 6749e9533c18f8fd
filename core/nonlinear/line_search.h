/* Line search shared by the nonlinear solvers. */
#ifndef SPORE_NONLINEAR_LINE_SEARCH_H
#define SPORE_NONLINEAR_LINE_SEARCH_H

#include "core/nonlinear/system.h"

/* Halves the step from x along d until it helps: the residual norm halves, or the residual does not point back along d
 * by more than half of what it pointed forward. Energy has then fallen, even where the norm must climb a hill on the
 * way (buckling), so that an answer that is not solved to tolerance has not gained any. Where d does not go downhill
 * (Broyden may say so), the norm has to fall. r and norm: residual at x; on success trial, trial_r, *trial_norm hold
 * the new point, and the length is returned; 0 where no length helps. evaluations is counted up. */
double spore_line_search(const SporeSystem *system, const double *x, const double *d, const double *r, double norm,
                         double *trial, double *trial_r, double *trial_norm, size_t *evaluations);

#endif
