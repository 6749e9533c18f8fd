/* Judges the points of an accuracy study: errors, orders, which are worth their time, and one sentence. */
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/measure/accuracy_private.h"
#include "core/measure/quantile.h"

#define RESOLVED 10 /* times the reference's own error */
#define SPREADS 2   /* of the means of perturbed runs */
#define LOST 0.5    /* errors above tell no order */
#define FLAT 0.3    /* an order below is none */
#define SAME_COST 1.1
#define NEARER 1.2 /* times, to be worth a word */
#define WORSE 5    /* times the error of another method at the same step */
#define MUCH 10    /* times nearer, to be worth a word though it takes longer */
#define LONGER 4   /* times, at most */
#define AT_WORK 1  /* of the energy at work: what is off by more is no motion of this scene */

/* Energy that moves about in the reference. */
static double energy_at_work(const SporeTrial *reference) {
  double low = HUGE_VAL, high = -HUGE_VAL, kinetic = 0;
  for (size_t s = 0; s < reference->samples; s++) {
    low = fmin(low, reference->energy[s]);
    high = fmax(high, reference->energy[s]);
    kinetic = fmax(kinetic, reference->kinetic[s]);
  }
  return high - low + kinetic;
}

static double energy_drift(const SporeTrial *trial, const SporeTrial *reference) {
  double worst = 0, work = energy_at_work(reference);
  if (!trial->finite || trial->samples != reference->samples) return HUGE_VAL;
  for (size_t s = 0; s < trial->samples; s++) {
    double own = trial->energy[s] - trial->energy[0], right = reference->energy[s] - reference->energy[0];
    worst = fmax(worst, fabs(own - right));
  }
  return work > 0 ? worst / work : 0;
}

void spore_study_judge_point(const SporeStudy *study, SporeAccuracyPoint *point, const SporeTrial *trial,
                             double *costs) {
  SporeTrialDifference apart = spore_trial_difference(&study->points, &study->reference, trial);
  double steps = fmax(1, (double)trial->steps);
  point->error = study->report->statistics ? spore_study_mean_difference(study, &study->reference, trial) : apart.rms;
  point->final = apart.final;
  point->worst = apart.worst;
  point->energy_drift = energy_drift(trial, &study->reference);
  point->penetration = trial->penetration;
  point->gap = trial->gap;
  point->line_stretch = trial->line_stretch;
  point->cost = spore_quantile(costs, point->repeats, 0.5);
  point->us_per_step = 1e6 * point->cost * trial->dt_s;
  point->p99_us = trial->p99_us;
  point->real_time_factor = 1 / point->cost;
  point->force_evaluations = trial->force_evaluations / steps;
  point->newton = trial->newton / steps;
  point->linear = trial->linear / steps;
  point->events = trial->events;
  point->stable = trial->stable;
  point->as_written = trial->unsolved == 0;
  point->sound = point->stable && point->as_written && point->energy_drift <= AT_WORK;
  point->resolved = point->stable && isfinite(point->error) && point->error >= study->report->floor;
}

static void find_pareto(SporeAccuracyReport *report) {
  for (size_t i = 0; i < report->point_count; i++) {
    SporeAccuracyPoint *point = &report->points[i];
    point->pareto = point->resolved && point->sound;
    for (size_t k = 0; k < report->point_count && point->pareto; k++) {
      const SporeAccuracyPoint *other = &report->points[k];
      if (k == i || !other->resolved || !other->sound) continue;
      bool nowhere_worse = other->error <= point->error && other->cost <= point->cost;
      if (nowhere_worse && (other->error < point->error || other->cost < point->cost)) point->pareto = false;
    }
  }
}

/* Whether another method is much nearer at a step that is no smaller than the method's smallest. */
static bool is_outdone(const SporeAccuracyReport *report, size_t method, int level) {
  const SporeAccuracyPoint *own = NULL;
  for (size_t i = 0; i < report->point_count; i++)
    if (report->points[i].method == method && report->points[i].level == level) own = &report->points[i];
  for (size_t i = 0; own && i < report->point_count; i++) {
    const SporeAccuracyPoint *other = &report->points[i];
    bool comparable = other->level == level && other->stable && other->dt_s >= own->dt_s;
    if (comparable && other->error * WORSE < own->error) return true;
  }
  return false;
}

/* Slope of log error over log step, by least squares, at the level that the reference was run at. */
static void fit_order(SporeAccuracyReport *report, size_t method, int level) {
  SporeAccuracyFit *fit = &report->methods[method];
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (size_t i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    if (point->method != method || point->level != level || !point->resolved || point->error > LOST) continue;
    double a = log(point->dt_s), b = log(point->error);
    n++, x += a, y += b, xx += a * a, xy += a * b, yy += b * b;
  }
  fit->order = fit->order_spread = NAN;
  fit->converges = true;
  if (n < 3) return;
  double spread = xx - x * x / n;
  fit->order = (xy - x * y / n) / spread;
  double rest = yy - y * y / n - fit->order * fit->order * spread;
  fit->order_spread = sqrt(fmax(rest, 0) / (n - 2) / spread);
  fit->converges = fit->order >= FLAT || !is_outdone(report, method, level);
}

/* The point of the scene's own method whose step is nearest to the scene's, or else the median of all by cost. */
static const SporeAccuracyPoint *usual(const SporeStudy *study) {
  const SporeAccuracyReport *report = study->report;
  const SporeAccuracyPoint *best = NULL;
  double nearest = HUGE_VAL;
  for (int own = 1; own >= 0 && !best; own--)
    for (size_t i = 0; i < report->point_count; i++) {
      const SporeAccuracyPoint *point = &report->points[i];
      const SporeAccuracyMethod *method = &report->methods[point->method].method;
      if (own && method->integrator != study->scene.own.integrator) continue;
      double off = fabs(log(point->dt_s / study->scene.dt_s));
      if (off < nearest) nearest = off, best = point;
    }
  return best;
}

/* Error of a point, as far as can be told. */
static double told(const SporeAccuracyReport *report, const SporeAccuracyPoint *point) {
  return fmax(point->error, report->floor);
}

/* The sound point that is the nearest, and of those that cannot be told apart the cheapest, for at most `cost`. NULL:
 * none is `times` nearer than this one. */
static const SporeAccuracyPoint *nearer(const SporeAccuracyReport *report, const SporeAccuracyPoint *than, double cost,
                                        double times) {
  const SporeAccuracyPoint *best = NULL;
  for (size_t i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    if (!point->sound || !(point->cost <= cost)) continue;
    if (than->stable && !(told(report, point) * times < than->error)) continue;
    double error = told(report, point), least = best ? told(report, best) : HUGE_VAL;
    if (error < least || (error <= least && point->cost < best->cost)) best = point;
  }
  return best;
}

/* The cheapest sound point that is much nearer and does not take too long. */
static const SporeAccuracyPoint *much_nearer(const SporeAccuracyReport *report, const SporeAccuracyPoint *than) {
  const SporeAccuracyPoint *best = NULL;
  for (size_t i = 0; i < report->point_count; i++) {
    const SporeAccuracyPoint *point = &report->points[i];
    if (!point->sound || !(told(report, point) * MUCH <= than->error) || point->cost > LONGER * than->cost) continue;
    if (!best || point->cost < best->cost) best = point;
  }
  return best;
}

/* "tr_bdf2 at 8 ms" */
static void name_point(const SporeAccuracyReport *report, const SporeAccuracyPoint *point, char *text, size_t size) {
  snprintf(text, size, _("%s at %.3g ms"), report->methods[point->method].label, 1e3 * point->dt_s);
}

static void say_usual(const SporeAccuracyReport *report, const SporeAccuracyPoint *point, char *text, size_t size) {
  char name[128];
  name_point(report, point, name, sizeof name);
  double step_ms = 1e-3 * point->us_per_step;
  if (!point->stable) snprintf(text, size, _("%s: not stable, %.2g ms a step"), name, step_ms);
  else if (point->resolved)
    snprintf(text, size, _("%s: %.2g %% off, %.2g ms a step"), name, 100 * point->error, step_ms);
  else
    snprintf(text, size, _("%s: less than %.2g %% off, which is as far as can be told here, %.2g ms a step"), name,
             100 * report->floor, step_ms);
}

/* "is 3 times closer", or at least that where the better one's error cannot be told. */
static void say_closer(const SporeAccuracyReport *report, const SporeAccuracyPoint *point,
                       const SporeAccuracyPoint *better, char *text, size_t size) {
  double times = point->error / told(report, better);
  snprintf(text, size, better->resolved ? _("is %.2g times closer") : _("is at least %.2g times closer"), times);
}

static void say_better(const SporeAccuracyReport *report, const SporeAccuracyPoint *point, char *text, size_t size) {
  char name[128], closer[96];
  *text = '\0';
  if (point->stable && !point->resolved) return;
  const SporeAccuracyPoint *better = nearer(report, point, SAME_COST * point->cost, NEARER);
  const SporeAccuracyPoint *other = !better && point->stable ? much_nearer(report, point) : NULL;
  if (better || other) name_point(report, better ? better : other, name, sizeof name);
  if (better && !point->stable) snprintf(text, size, _("; %s is, for the same time"), name);
  else if (better) {
    say_closer(report, point, better, closer, sizeof closer);
    snprintf(text, size, _("; %s %s for the same time"), name, closer);
  } else if (other) {
    say_closer(report, point, other, closer, sizeof closer);
    snprintf(text, size, _("; nothing is nearer for the same time, but %s %s for %.2g times the time"), name, closer,
             other->cost / point->cost);
  } else if (point->resolved) snprintf(text, size, _("; nothing that was tried is nearer for the same time"));
}

/* What is wrong with a stable point in other ways than by its error; "": nothing. */
static const char *fault_of(const SporeAccuracyPoint *point) {
  if (!point->stable || point->sound) return "";
  return point->as_written ? _(" (its energy is far off)") : _(" (some steps are not solved)");
}

static bool say(SporeStudy *study) {
  char first[256] = "", second[320] = "", whole[640];
  const SporeAccuracyPoint *point = usual(study);
  if (point) {
    say_usual(study->report, point, first, sizeof first);
    say_better(study->report, point, second, sizeof second);
  }
  snprintf(whole, sizeof whole, "%s%s%s", first, point ? fault_of(point) : "", second);
  study->report->sentence = spore_copy_text(whole);
  return study->report->sentence;
}

bool spore_study_judge(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  int level = spore_study_finest_level(report);
  report->floor =
      fmax(RESOLVED * report->reference.own_error, report->statistics ? SPREADS * report->spread : report->growth);
  for (size_t i = 0; i < report->point_count; i++)
    spore_study_judge_point(study, &report->points[i], &study->trials[i], study->costs + i * study->options.repeats);
  find_pareto(report);
  for (size_t m = 0; m < report->method_count; m++) fit_order(report, m, level);
  return say(study);
}
