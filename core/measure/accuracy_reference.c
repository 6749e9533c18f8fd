/* The reference of the accuracy study: which method gets nearest, its own error, a second method that has to come to
 * the same, and how far runs drift apart whose starts differ by next to nothing. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/accuracy_private.h"

#define SHARE 0.2          /* of the time of the study, for the runs of the reference */
#define CROSS_SHARE 0.06   /* for the second method */
#define CHAOS_SHARE 0.2    /* for the perturbed runs */
#define FINEST 5           /* halvings of the smallest step of a point */
#define FINEST_STEP_S 1e-6 /* the smallest time_step that a scene may have */
#define SLOWEST 0.4        /* order that is assumed at least */
#define LOST 0.05          /* a reference whose own error is more is none */
#define TOLERANCE 1e-10    /* relative residual of implicit steps */
#define PERTURBATION 1e-8  /* of a body's length */
#define CHAOTIC 1e-3
#define SPREAD_RUNS 8
#define AGREE 3        /* times what both say of their errors */
#define ALIKE 0.01     /* of a run's error: what is no farther apart is the same but for rounding, */
#define ALIKE_ALL 1e-9 /* or this, of a body's length */

double spore_study_mean_difference(const SporeStudy *study, const SporeTrial *a, const SporeTrial *b) {
  size_t bodies = study->points.body_count;
  double sum = 0;
  if (!a->finite || !b->finite || a->samples != b->samples || a->samples < 2) return HUGE_VAL;
  for (size_t k = 0; k < bodies; k++) {
    SporeVec3 apart = {0, 0, 0};
    for (size_t s = 1; s < a->samples; s++)
      apart = spore_vec3_add(apart, spore_vec3_sub(spore_vec3_load(a->centre + 3 * (s * bodies + k)),
                                                   spore_vec3_load(b->centre + 3 * (s * bodies + k))));
    double part = spore_vec3_length(apart) / (double)(a->samples - 1) / study->points.bodies[k].length;
    sum += part * part;
  }
  return sqrt(sum / (double)bodies);
}

double spore_study_difference(const SporeStudy *study, const SporeTrial *a, const SporeTrial *b) {
  if (study->report->statistics) return spore_study_mean_difference(study, a, b);
  return spore_trial_difference(&study->points, a, b).rms;
}

/* What the steps of a method that were run as points tell of its error. */
typedef struct Candidate {
  size_t method;
  double dt_s, cost_s; /* smallest step, and what the stretch took with it */
  double error, order; /* at that step */
} Candidate;

/* Error of the finer of two runs whose steps have this ratio. */
static double richardson(double apart, double order, double ratio) { return apart / (pow(ratio, order) - 1); }

/* False: fewer than three steps of the method were stable. */
static bool weigh(const SporeStudy *study, size_t method, int level, Candidate *candidate) {
  const SporeAccuracyReport *report = study->report;
  size_t last[3], found = 0;
  for (size_t i = report->point_count; i-- > 0 && found < 3;)
    if (report->points[i].method == method && report->points[i].level == level && study->trials[i].stable)
      last[found++] = i;
  if (found < 3) return false;
  const SporeTrial *fine = &study->trials[last[0]], *middle = &study->trials[last[1]],
                   *coarse = &study->trials[last[2]];
  double near = spore_study_difference(study, fine, middle), far = spore_study_difference(study, middle, coarse);
  double ratio = middle->dt_s / fine->dt_s,
         nominal = spore_study_nominal_order(report->methods[method].method.integrator);
  double order = log(far / near) / log(ratio);
  order = near > 0 && isfinite(order) ? fmin(fmax(order, SLOWEST), nominal) : nominal;
  *candidate = (Candidate){method, fine->dt_s, fine->cpu_s, richardson(near, order, ratio), order};
  return isfinite(near) && isfinite(far);
}

/* Whether two methods move the bodies alike at all steps that both were run with, two at least. */
static bool are_alike(const SporeStudy *study, size_t method, size_t other) {
  const SporeAccuracyReport *report = study->report;
  size_t pairs = 0;
  for (size_t i = 0; i < report->point_count; i++)
    for (size_t k = 0; k < report->point_count; k++) {
      const SporeAccuracyPoint *a = &report->points[i], *b = &report->points[k];
      bool same_step = a->level == b->level && fabs(a->dt_s / b->dt_s - 1) < 1e-9;
      if (a->method != method || b->method != other || !same_step) continue;
      double apart = spore_study_difference(study, &study->trials[i], &study->trials[k]);
      double error = spore_study_difference(study, &study->reference, &study->trials[i]);
      if (!(apart <= fmax(ALIKE * error, ALIKE_ALL)) || isinf(apart)) return false;
      pairs++;
    }
  return pairs > 1;
}

/* A second method that goes the same way checks nothing, and a reader takes it for another one. */
static void find_alike(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  for (size_t m = 0; m < report->method_count; m++)
    for (size_t k = 0; k < m && report->methods[m].alike == m; k++)
      if (are_alike(study, m, k)) report->methods[m].alike = k;
}

/* How often the smallest step may be halved for runs that may take `most_s` seconds; `runs`: their work, by the finest.
 */
static int halvings(const SporeStudy *study, const Candidate *candidate, double runs, double most_s) {
  int count = 0;
  double cost_s = runs * candidate->cost_s;
  while (count < FINEST && candidate->dt_s / (2 << count) >= FINEST_STEP_S &&
         (study->options.full ? count < 3 : cost_s * (2 << count) <= most_s))
    count++;
  return count;
}

/* Whether a method is no second one beside another: the same integrator, or where `alike` says so one that moves the
 * bodies alike. */
static bool is_same(const SporeAccuracyReport *report, size_t method, size_t other, bool alike) {
  if (other >= report->method_count) return false;
  const SporeAccuracyFit *a = &report->methods[method], *b = &report->methods[other];
  return a->method.integrator == b->method.integrator || (alike && a->alike == b->alike);
}

/* The method whose error would be the smallest in the time that there is, but none that is the same as `but`. */
static bool choose(const SporeStudy *study, int level, size_t but, bool alike, double runs, double most_s,
                   Candidate *best, int *count) {
  double least = HUGE_VAL;
  for (size_t m = 0; m < study->report->method_count; m++) {
    Candidate candidate;
    if (is_same(study->report, m, but, alike) || !weigh(study, m, level, &candidate)) continue;
    int halved = halvings(study, &candidate, runs, most_s);
    double error = candidate.error * pow(2, -candidate.order * halved);
    if (!(error < least)) continue;
    least = error;
    *best = candidate;
    *count = halved;
  }
  return isfinite(least);
}

bool spore_study_run_exactly(SporeStudy *study, size_t method, const SporeAccuracyWorld *as, uint32_t seed,
                             SporeTrial *trial) {
  SporeError why = SPORE_ERROR_INIT;
  SporeAccuracyWorld world = *as;
  world.method = &study->report->methods[method].method;
  world.dt_s = spore_trial_step(study->report->interval_s, as->dt_s);
  world.tolerance = TOLERANCE;
  world.awake = true;
  const SporeStudyRun how = {.perturbation = seed ? PERTURBATION : 0, .seed = seed};
  SporeStudyOutcome outcome = spore_study_run(study, &world, &how, trial, &why);
  if (outcome == SPORE_STUDY_REFUSED && study->error) *study->error = why;
  return outcome == SPORE_STUDY_RAN;
}

static bool run(SporeStudy *study, size_t method, int level, double dt_s, uint32_t seed, SporeTrial *trial) {
  const SporeAccuracyWorld as = {.level = level, .dt_s = dt_s};
  return spore_study_run_exactly(study, method, &as, seed, trial);
}

/* Mean places over perturbed runs, in the place of the reference's; the spread is how far the runs lie from them. */
static void take_means(SporeStudy *study) {
  SporeTrial *reference = &study->reference;
  size_t numbers = reference->samples * study->points.body_count * 3;
  double square = 0, runs = (double)study->perturbed_count;
  for (size_t i = 0; i < numbers; i++) {
    double sum = 0;
    for (size_t k = 0; k < study->perturbed_count; k++) sum += study->perturbed[k].centre[i];
    reference->centre[i] = sum / runs;
  }
  for (size_t k = 0; k < study->perturbed_count; k++) {
    double apart = spore_study_mean_difference(study, &study->perturbed[k], reference);
    square += apart * apart;
  }
  study->report->spread = sqrt(square / (runs - 1));
}

/* Runs whose start is moved by next to nothing, until it is known how far they drift apart. plain: the same unmoved. */
static bool find_growth(SporeStudy *study, int level, const SporeTrial *plain, double dt_s) {
  SporeAccuracyReport *report = study->report;
  size_t wanted = 1;
  study->perturbed = SPORE_NEW_ARRAY(SporeTrial, SPREAD_RUNS);
  if (!study->perturbed)
    return spore_error_set(study->error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for perturbed runs"));
  while (study->perturbed_count < wanted) {
    SporeTrial *trial = &study->perturbed[study->perturbed_count];
    if (!run(study, report->reference.method, level, dt_s, (uint32_t)study->perturbed_count + 1, trial)) return false;
    if (study->perturbed_count++ > 0) continue;
    report->growth = spore_trial_difference(&study->points, plain, trial).rms;
    report->chaotic = report->statistics = !(report->growth <= CHAOTIC);
    if (!report->chaotic) break;
    wanted = SPREAD_RUNS;
    while (!study->options.full && wanted > 3 && (double)wanted * trial->cpu_s > CHAOS_SHARE * study->most_s) wanted--;
    if (wanted < SPREAD_RUNS) spore_study_cut(study, _("%zu perturbed runs instead of %d"), wanted, SPREAD_RUNS);
  }
  return true;
}

/* How far a second method comes to the same: one that goes another way, if there is one. */
static bool cross_check(SporeStudy *study, int level) {
  SporeAccuracyReference *reference = &study->report->reference;
  Candidate second;
  int halved = 0;
  SporeTrial trial;
  find_alike(study);
  reference->cross_method = SIZE_MAX;
  reference->agreed = false;
  bool found = false;
  for (int alike = 1; alike >= 0 && !found; alike--)
    found = choose(study, level, reference->method, alike, 1, CROSS_SHARE * study->most_s, &second, &halved);
  if (!found) return true;
  reference->cross_method = second.method;
  reference->cross_dt_s = spore_trial_step(study->report->interval_s, second.dt_s / (double)(1 << halved));
  reference->cross_expected = second.error * pow(2, -second.order * halved);
  if (!run(study, second.method, level, reference->cross_dt_s, 0, &trial)) return false;
  reference->cross_difference = spore_study_difference(study, &study->reference, &trial);
  spore_trial_clear(&trial);
  double said = reference->cross_expected + reference->own_error + study->report->spread + study->report->growth;
  reference->agreed = reference->cross_difference <= AGREE * said;
  if (!reference->agreed) reference->own_error = fmax(reference->own_error, reference->cross_difference);
  return true;
}

static bool refuse(SporeStudy *study) {
  const SporeAccuracyReference *reference = &study->report->reference;
  return spore_error_set(study->error, SPORE_ERROR_NUMERICAL, NULL,
                         _("no reference converges: %s at %.3g s is still %.2g of a body's length off; expected less "
                           "than %g; ask for a shorter stretch (--time), smaller steps (--dt) or one body (--body)"),
                         study->report->methods[reference->method].label, reference->dt_s, reference->own_error, LOST);
}

/* Own error by the three runs at 4 h, 2 h and h. */
static bool find_own_error(SporeStudy *study, const SporeTrial *coarse, const SporeTrial *middle) {
  SporeAccuracyReference *reference = &study->report->reference;
  const SporeTrial *fine = &study->reference;
  double far = spore_study_difference(study, coarse, middle), near = spore_study_difference(study, middle, fine);
  double ratio = middle->dt_s / fine->dt_s;
  double nominal = spore_study_nominal_order(study->report->methods[reference->method].method.integrator);
  reference->order = near > 0 ? log(far / near) / log(coarse->dt_s / middle->dt_s) : nominal;
  double order = isfinite(reference->order) ? fmin(fmax(reference->order, SLOWEST), nominal) : SLOWEST;
  reference->own_error = study->report->statistics ? near : richardson(near, order, ratio); /* means keep no order */
  return reference->own_error <= LOST || (study->report->statistics && isfinite(near)) || refuse(study);
}

static bool run_reference(SporeStudy *study, int level, SporeTrial *coarse, SporeTrial *middle) {
  SporeAccuracyReference *reference = &study->report->reference;
  double dt_s = reference->dt_s;
  study->done = 0.35;
  if (!run(study, reference->method, level, 4 * dt_s, 0, coarse)) return false;
  if (!find_growth(study, level, coarse, 4 * dt_s)) return false;
  study->done = 0.4;
  if (!run(study, reference->method, level, 2 * dt_s, 0, middle)) return false;
  if (!run(study, reference->method, level, dt_s, 0, &study->reference)) return false;
  if (!find_own_error(study, coarse, middle)) return false;
  study->report->contacts = study->reference.contacts / fmax(1, (double)study->reference.steps);
  reference->gap = study->reference.gap;
  reference->line_stretch = study->reference.line_stretch;
  if (study->report->statistics) take_means(study);
  study->done = 0.5;
  return cross_check(study, level);
}

/* What the level itself costs in truth, by the reference's method. */
static bool find_spatial_errors(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  for (size_t i = 0; i < report->level_count; i++) {
    SporeTrial trial;
    if (!run(study, report->reference.method, report->levels[i].level, 4 * report->reference.dt_s, 0, &trial))
      return false;
    report->levels[i].error = spore_study_difference(study, &study->reference, &trial);
    spore_trial_clear(&trial);
  }
  return true;
}

bool spore_study_refer(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  int level = spore_study_finest_level(report), halved = 0;
  Candidate best;
  if (!choose(study, level, SIZE_MAX, false, 2, SHARE * study->most_s, &best, &halved))
    return spore_error_set(
        study->error, SPORE_ERROR_NUMERICAL, NULL,
        _("no reference converges: no method is stable at three of the steps that there was time for; "
          "expected one that is; give more time (--seconds), or ask for smaller steps or other "
          "methods (--dt and --methods of accuracy)"));
  report->reference.method = best.method;
  report->reference.dt_s = spore_trial_step(report->interval_s, best.dt_s / (double)(1 << halved));
  SporeTrial coarse = {0}, middle = {0};
  bool good = run_reference(study, level, &coarse, &middle) && find_spatial_errors(study);
  spore_trial_clear(&coarse);
  spore_trial_clear(&middle);
  return good;
}
