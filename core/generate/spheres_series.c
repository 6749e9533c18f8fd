#include "core/generate/spheres_series.h"

#include <math.h>

#include "core/base/text.h"

static bool check_counts(const size_t *counts, size_t count, SporeError *error) {
  if (!count)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("no number of spheres is given; at least one was expected; give some, such as 16, 32, 64"));
  for (size_t i = 0; i < count; i++)
    if (counts[i] < 1 || counts[i] > SPORE_SPHERES_MAXIMUM || (i > 0 && counts[i] <= counts[i - 1]))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("%zu as number of spheres is out of range or not larger than the one before; ascending "
                               "numbers from 1 to %u were expected; sort them"),
                             counts[i], SPORE_SPHERES_MAXIMUM);
  return true;
}

bool spore_spheres_series(const SporeSpheresSource *source, const SporeSpheresOptions *options, const size_t *counts,
                          size_t count, SporeSpheresReport *reports, SporeSpheresMeasured *measured, void *data,
                          const SporeProgress *progress, SporeError *error) {
  double sum = 0, done = 0;
  if (!check_counts(counts, count, error)) return false;
  for (size_t i = 0; i < count; i++) sum += 40 + (double)counts[i]; /* about what each takes */
  for (size_t i = 0; i < count; i++) {
    SporeProgressShare part = {progress, done / sum, (40 + (double)counts[i]) / sum};
    SporeProgress inner = spore_progress_of_share(&part);
    SporeSpheresOptions one = *options;
    SporeSphereSet set;
    one.count = counts[i];
    if (!spore_spheres_from_source(source, &one, &set, &reports[i], &inner, error)) return false;
    spore_sphere_set_clear(&set);
    if (measured) measured(data, i, &reports[i]);
    done += 40 + (double)counts[i];
  }
  return true;
}

/* What a doubling lowers the error by, before point i. */
static double gain(const size_t *counts, const double *errors, size_t i) {
  return (errors[i - 1] - errors[i]) / log2((double)counts[i] / (double)counts[i - 1]);
}

size_t spore_enough(const size_t *counts, const double *errors, size_t count, double worth) {
  size_t enough = count;
  for (size_t i = count; i-- > 1 && gain(counts, errors, i) < worth;) enough = i - 1;
  return enough;
}
