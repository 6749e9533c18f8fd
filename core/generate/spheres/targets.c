/* Search for the fewest spheres that reach the targets. */
#include <math.h>

#include "core/base/text.h"
#include "core/generate/spheres/private.h"

/* When the search ends. The errors of sets whose counts differ by a few % scatter by as much, so a finer search is of
 * no use. */
#define NEAR_COUNT 30 /* smallest count that is enough / its difference to the largest count that is too small */
#define NEAR_EXCESS 0.97
#define FIRST_COUNT 32
#define USUAL_SLOPE -0.8  /* slope of log(error) over log(count) */
#define LEAST_EXCESS 1e-3 /* its logarithm must be finite */
#define GENTLEST_SLOPE -0.2
#define BEYOND 1.02      /* factor beyond the allowed error at which a trial aims */
#define BISECTED_AFTER 6 /* trials */

const char *spore_spheres_hardest_target(const SporeSpheresTargets *targets, const SporeSpheresReport *report,
                                         double *excess) {
  const struct {
    const char *name;
    double error, allowed; /* 0: not asked for */
  } all[] = {{"coverage", 1 - report->coverage, targets->coverage > 0 ? 1 - targets->coverage : 0},
             {"outside", report->outside, targets->outside},
             {"distance", report->distance_mean, targets->distance},
             {"depth_error", spore_spheres_felt_error(report), targets->depth_error}};
  const char *hardest = NULL;
  double most = -1;
  for (size_t i = 0; i < sizeof all / sizeof *all; i++)
    if (all[i].allowed > 0 && all[i].error / all[i].allowed > most)
      most = all[i].error / all[i].allowed, hardest = all[i].name;
  if (excess) *excess = fmax(most, 0);
  return hardest;
}

/* 0, or up to `most`. */
static bool check_target(double value, double most) { return value == 0 || (value > 0 && value <= most); }

bool spore_targets_check(const SporeSpheresTargets *targets, SporeError *error) {
  if (check_target(targets->coverage, nextafter(1, 0)) && check_target(targets->outside, 1e9) &&
      check_target(targets->distance, 1) && check_target(targets->depth_error, 1) &&
      spore_spheres_hardest_target(targets, &(SporeSpheresReport){0}, NULL))
    return true;
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("neither a number of spheres nor targets are given (coverage %g, outside %g, tolerance %g, "
        "depth error %g); a coverage below 1, such as 0.95, a volume outside above 0, a mean distance "
        "or a depth error up to 1 was expected; give one of them or several"),
      targets->coverage, targets->outside, targets->distance, targets->depth_error);
}

bool spore_targets_out_of_reach(const SporeSpheresTargets *targets, const SporeSpheresReport *report,
                                SporeError *error) {
  double excess;
  spore_spheres_hardest_target(targets, report, &excess);
  return spore_error_set(
      error, SPORE_ERROR_NUMERICAL, NULL,
      _("%u spheres still have a coverage of %g, %g outside, a mean distance of %g of the diagonal and "
        "a depth error of %g, %.3g times as much as is allowed; ask for less"),
      SPORE_SPHERES_MAXIMUM, report->coverage, report->outside, report->distance_mean, spore_spheres_felt_error(report),
      excess);
}

static double power(size_t a, double a_excess, size_t b, double b_excess) {
  return fmin(log(b_excess / a_excess) / log((double)b / (double)a), GENTLEST_SLOPE);
}

/* The excess falls about as a power of the count, so each trial follows a line in logarithms. The slope comes from the
 * largest count that is too small and the smallest that is enough. The line starts at the one whose excess is nearer to
 * 1 and aims a little beyond 1, so that the next trial is likely to be on the other side. */
size_t spore_target_search_next(const SporeTargetSearch *s) {
  if (!s->trials) return FIRST_COUNT;
  bool both = s->few && s->enough;
  double slope = both ? power(s->few, s->few_excess, s->enough, s->enough_excess) : USUAL_SLOPE;
  bool from_few = !s->enough || (both && s->few_excess * s->enough_excess < 1);
  double known = from_few ? (double)s->few : (double)s->enough, excess = from_few ? s->few_excess : s->enough_excess;
  double beyond = from_few ? 1 / BEYOND : BEYOND, guess = known * pow(excess / beyond, -1 / slope);
  size_t low = s->few + 1, high = s->enough ? s->enough - 1 : SPORE_SPHERES_MAXIMUM;
  if (!s->few) guess = fmin(guess, (double)s->enough / 2);
  if (!s->enough) guess = fmax(guess, 1.2 * (double)s->few);
  bool outside = guess <= (double)low || guess >= (double)high;
  if (both && (outside || s->trials > BISECTED_AFTER)) guess = sqrt((double)s->few * (double)s->enough);
  return guess < (double)low ? low : guess > (double)high ? high : (size_t)guess;
}

bool spore_target_search_add(SporeTargetSearch *s, size_t count, const SporeSpheresTargets *targets,
                             const SporeSpheresReport *report) {
  double excess;
  spore_spheres_hardest_target(targets, report, &excess);
  s->trials++;
  if (excess <= 1) s->enough = count, s->enough_excess = fmax(excess, LEAST_EXCESS);
  else s->few = count, s->few_excess = excess;
  return excess <= 1;
}

bool spore_target_search_done(const SporeTargetSearch *s) {
  return s->enough && (s->enough_excess > NEAR_EXCESS || s->enough - s->few <= 1 + s->enough / NEAR_COUNT);
}

bool spore_target_search_failed(const SporeTargetSearch *s) { return !s->enough && s->few >= SPORE_SPHERES_MAXIMUM; }
