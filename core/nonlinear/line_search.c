/* The line search. */
#include "core/nonlinear/line_search.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/math/vector.h"

#define TRIALS 12
#define FLAT 0.5     /* of the slope at the start: along d nothing more is to be had */
#define SWITCHED 0.2 /* of the slope at the start: what it has fallen by in excess of the promise */
#define BISECTIONS 8
#define LONGER 4 /* at most, times the length before */

typedef struct Line {
  const SporeSystem *system;
  const double *x, *d;
  double *trial, *trial_r;
  double norm, slope; /* of the residual at the trial; slope: its part along d */
  double near;
  bool tried; /* trial, trial_r and norm are those of the first length */
  size_t *evaluations;
} Line;

static void try_length(Line *line, double length) {
  size_t n = line->system->count;
  if (!line->tried) {
    memcpy(line->trial, line->x, n * sizeof *line->trial);
    spore_vector_add_scaled(n, line->trial, length, line->d);
    line->system->residual(line->system->data, line->trial, line->trial_r);
    ++*line->evaluations;
    line->norm = line->system->norm(line->system->data, line->trial_r);
  }
  line->tried = false;
  line->slope = isfinite(line->norm) ? spore_vector_dot(n, line->trial_r, line->d) : -HUGE_VAL;
}

/* d need not go downhill: the norm has to fall. */
static double by_norm(Line *line, double norm) {
  double length = 1;
  for (int k = 0; k <= TRIALS && !spore_cancel_asked(line->system->cancel); k++, length /= 2) {
    try_length(line, length);
    if (line->norm <= (1 - 1e-4 * length) * norm) return length;
  }
  return 0;
}

/* Where the straight line through the slopes is flat, well within the two. */
static double between(double low, double low_slope, double high, double high_slope) {
  double share = isfinite(high_slope) ? low_slope / (low_slope - high_slope) : 0.25;
  return low + fmin(fmax(share, 0.1), 0.9) * (high - low);
}

/* Where a force has switched on the way to `length`, as friction does that turns round, the slope has fallen by more
 * than the linearisation promised, in one place. Before that place and behind it the force is the same wherever one
 * goes, so that the next step would go past it again; in it the force tells how far to go. */
static double into_switch(Line *line, double start, double low, double length) {
  double fallen = (1 - length) * start - line->slope, high = length, at = length;
  if (!(fallen > SWITCHED * start)) return length;
  for (int k = 0; k < BISECTIONS; k++) {
    at = 0.5 * (low + high);
    try_length(line, at);
    double share = ((1 - at) * start - line->slope) / fallen;
    if (share > 0.2 && share < 0.8) return at;
    if (share > 0.5) high = at;
    else low = at;
  }
  try_length(line, length);
  return length;
}

static double by_slope(Line *line, double norm, double start) {
  double low = 0, low_slope = start, high = HUGE_VAL, high_slope = 0, length = 1;
  for (int k = 0, side = 0; k <= TRIALS && !spore_cancel_asked(line->system->cancel); k++) {
    try_length(line, length);
    if (line->norm <= 0.5 * norm) return length;
    if (fabs(line->slope) <= FLAT * start)
      return line->system->switches ? into_switch(line, start, low, length) : length;
    if (line->slope > 0) {
      if (!isfinite(high) && line->norm > line->near) return length;
      double gain = low_slope > line->slope ? line->slope / (low_slope - line->slope) : LONGER;
      double step = fmin(gain, LONGER) * (length - low);
      low = length;
      low_slope = line->slope;
      if (side == 1) high_slope *= 0.5; /* the Illinois variant of false position */
      side = 1;
      length = isfinite(high) ? between(low, low_slope, high, high_slope) : length + step;
    } else {
      high = length;
      high_slope = line->slope;
      if (side == -1) low_slope *= 0.5;
      side = -1;
      length = between(low, low_slope, high, high_slope);
    }
  }
  if (low > 0) try_length(line, low);
  return low;
}

double spore_line_search(const SporeSystem *system, const double *x, const double *d, const double *r, double norm,
                         bool tried, double near, double *trial, double *trial_r, double *trial_norm,
                         size_t *evaluations) {
  assert(system->residual && system->norm);
  assert(trial != x || system->count == 0);
  assert(trial_norm && evaluations);
  Line line = {system, x, d, trial, trial_r, *trial_norm, 0, near, tried, evaluations};
  double start = spore_vector_dot(system->count, r, d);
  double length = start > 0 ? by_slope(&line, norm, start) : by_norm(&line, norm);
  *trial_norm = line.norm;
  return length;
}
