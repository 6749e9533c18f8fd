/* What sets of spheres give away: forces of contacts, depth and places against those of the finest set. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/accuracy_private.h"

#define LEAST_COARSER 4 /* times the reference's step, of the sets that are compared */
#define MOST_COARSER 64
#define SHARE 0.15 /* of the time of the study, for all of them */

/* Root mean square of the difference of two series of numbers, a row a sample, over that of the second. statistics: of
 * their means. Not a number: the second is 0. */
static double apart(const double *a, const double *b, size_t rows, size_t columns, bool statistics) {
  double difference = 0, size = 0;
  for (size_t c = 0; c < columns; c++) {
    double sum_a = 0, sum_b = 0;
    for (size_t r = 0; r < rows; r++) {
      double x = a[r * columns + c], y = b[r * columns + c];
      sum_a += x, sum_b += y;
      if (!statistics) difference += (x - y) * (x - y), size += y * y;
    }
    if (statistics) difference += (sum_a - sum_b) * (sum_a - sum_b), size += sum_b * sum_b;
  }
  return size > 0 ? sqrt(difference / size) : NAN;
}

static void compare(const SporeStudy *study, const SporeTrial *trial, const SporeTrial *finest,
                    SporeAccuracySpheres *spheres) {
  bool statistics = study->report->statistics, comparable = trial->samples == finest->samples && trial->finite;
  size_t rows = finest->samples, columns = 3 * finest->world_bodies;
  spheres->count = trial->spheres;
  spheres->error = spore_study_difference(study, finest, trial);
  spheres->force = spheres->depth = HUGE_VAL;
  if (!comparable) return;
  spheres->force = apart(trial->contact_force, finest->contact_force, rows, columns, statistics);
  spheres->depth = apart(trial->contact_depth, finest->contact_depth, rows, 1, statistics);
}

static bool run(SporeStudy *study, double factor, double times, SporeTrial *trial) {
  const SporeAccuracyReference *reference = &study->report->reference;
  const SporeAccuracyWorld as = {
      .level = spore_study_finest_level(study->report), .spheres = factor, .dt_s = times * reference->dt_s};
  return spore_study_run_exactly(study, reference->method, &as, 0, trial);
}

/* Times the reference's step that the time allows. */
static double coarser(const SporeStudy *study) {
  double times = LEAST_COARSER, runs_s = (double)(study->report->sphere_count + 2) * study->reference.cpu_s;
  while (!study->options.full && times < MOST_COARSER && runs_s / times > SHARE * study->most_s) times *= 2;
  return times;
}

bool spore_study_compare_spheres(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  if (report->sphere_count == 0) return true;
  SporeTrial finest;
  size_t last = report->sphere_count - 1;
  double times = coarser(study);
  if (!run(study, report->spheres[last].factor, times, &finest)) return false;
  bool good = true;
  for (size_t i = 0; good && i <= last; i++) {
    SporeTrial trial;
    good = run(study, report->spheres[i].factor, i < last ? times : 0.5 * times, &trial);
    if (!good) break;
    compare(study, &trial, &finest, &report->spheres[i]);
    spore_trial_clear(&trial);
  }
  spore_trial_clear(&finest);
  return good;
}
