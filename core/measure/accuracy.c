/* The accuracy study: which runs are made, in which order, and what is cut to fit the time. */
#include "core/measure/accuracy.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/integrate/integrator.h"
#include "core/measure/accuracy_private.h"
#include "core/sim/solve/step_limit.h"

#define USUAL_TIME_S 1.
#define LEAST_TIME_S 0.1
#define USUAL_MOST_S 36.
#define USUAL_REPEATS 5
#define USUAL_STEPS 5
#define LEAST_STEPS 3
#define MOST_STEPS 8       /* where there is time */
#define LEAST_FIRST_S 1e-5 /* the largest step of a method is no smaller */
#define HALVINGS 6         /* of a first step that the scene does not take */
#define LONG_SHARE 0.01    /* runs that take longer are timed once */
#define SAMPLES 250        /* looks at a run, at most */
#define POINTS_SHARE 0.1   /* of the time, for one run of every point */
#define RUN_SHARE 0.05     /* for a single run */
#define REPEATS_SHARE 0.9  /* repeats end then */
#define LONGEST_STEP_S 0.1
#define LEAST_HIGH_S 0.008 /* the largest step that implicit methods are tried with, at least */

void spore_accuracy_label(const SporeAccuracyMethod *method, char label[SPORE_ACCURACY_LABEL]) {
  bool nonlinear = method->nonlinear >= 0, linear = method->linear >= 0;
  snprintf(label, SPORE_ACCURACY_LABEL, "%s%s%s%s%s", spore_integrator_names[method->integrator], nonlinear ? "/" : "",
           nonlinear ? spore_nonlinear_names[method->nonlinear] : "", linear ? "/" : "",
           linear ? spore_linear_names[method->linear] : "");
}

static bool no_memory(SporeStudy *study) {
  return spore_error_set(study->error, SPORE_ERROR_MEMORY, NULL,
                         _("there is not enough memory to compare runs; ask for a shorter stretch (--time) or fewer "
                           "methods (--methods)"));
}

/* Methods. */

static bool add_method(SporeStudy *study, const SporeAccuracyMethod *method) {
  SporeAccuracyReport *report = study->report;
  for (size_t m = 0; m < report->method_count; m++) {
    const SporeAccuracyMethod *other = &report->methods[m].method;
    if (other->integrator == method->integrator && other->nonlinear == method->nonlinear &&
        other->linear == method->linear)
      return true;
  }
  SporeAccuracyFit *methods =
      spore_reallocate(report->methods, report->method_count, report->method_count + 1, sizeof *methods);
  if (!methods) return no_memory(study);
  report->methods = methods;
  SporeAccuracyFit *fit = &methods[report->method_count++];
  *fit = (SporeAccuracyFit){
      .method = *method, .nominal = spore_study_nominal_order(method->integrator), .alike = report->method_count - 1};
  spore_accuracy_label(method, fit->label);
  return true;
}

/* Whether no body's forces can be solved for: then implicit methods move none. */
static bool is_all_particles(const SporeStudy *study, const SporeWorld *world) {
  for (size_t k = 0; k < study->points.body_count; k++)
    if (!spore_world_body_model(world, study->points.bodies[k].body)->type->rates) return false;
  return true;
}

/* Whether some body's elements can be met one after the other. */
static bool some_sweep(const SporeStudy *study, const SporeWorld *world) {
  for (size_t k = 0; k < study->points.body_count; k++)
    if (spore_model_sweeps(spore_world_body_model(world, study->points.bodies[k].body))) return true;
  return false;
}

static bool choose_methods(SporeStudy *study, const SporeWorld *world) {
  static const SporeIntegratorKind usual[] = {SPORE_INTEGRATOR_IMPLICIT_EULER,    SPORE_INTEGRATOR_TR_BDF2,
                                              SPORE_INTEGRATOR_IMPLICIT_MIDPOINT, SPORE_INTEGRATOR_BDF2,
                                              SPORE_INTEGRATOR_SYMPLECTIC_EULER,  SPORE_INTEGRATOR_RK4};
  static const SporeIntegratorKind explicit[] = {SPORE_INTEGRATOR_VERLET, SPORE_INTEGRATOR_SYMPLECTIC_EULER,
                                                 SPORE_INTEGRATOR_RK4, SPORE_INTEGRATOR_EXPLICIT_EULER};
  const SporeAccuracyOptions *options = &study->options;
  for (size_t m = 0; m < options->method_count; m++)
    if (!add_method(study, &options->methods[m])) return false;
  if (options->method_count > 0) return true;
  bool alone = is_all_particles(study, world);
  SporeAccuracyMethod own = {study->scene.own.integrator, -1, -1};
  if (own.integrator >= 0 && own.integrator != SPORE_INTEGRATOR_STATIC && !add_method(study, &own)) return false;
  size_t count = alone ? sizeof explicit / sizeof *explicit : sizeof usual / sizeof *usual;
  for (size_t m = 0; m < count; m++)
    if (!add_method(study, &(SporeAccuracyMethod){alone ? explicit[m] : usual[m], -1, -1})) return false;
  return !some_sweep(study, world) ||
         add_method(study, &(SporeAccuracyMethod){SPORE_INTEGRATOR_POSITION_BASED, -1, -1});
}

/* Steps. */

/* The largest step of an explicit method by the stiffest mode of the bodies; infinite for an implicit one. */
static double step_limit(const SporeStudy *study, const SporeWorld *world, SporeIntegratorKind kind) {
  double least = HUGE_VAL;
  if (spore_integrator(kind)->implicit) return least;
  for (size_t k = 0; k < study->points.body_count; k++) {
    const SporeModel *model = spore_world_body_model(world, study->points.bodies[k].body);
    SporeStepLimit limit;
    uint32_t body = study->points.bodies[k].body;
    const double *q = spore_world_q(world, body), *v = spore_world_v(world, body);
    if (!spore_step_limit(model, kind, q, v, NULL, 0, &limit, NULL)) continue;
    if (limit.dt_s > 0) least = fmin(least, limit.dt_s);
  }
  return least;
}

static double high_step(const SporeStudy *study) {
  if (study->options.dt_count > 0) return study->options.dt_high_s;
  double dt_s = study->scene.dt_s, high_s = fmin(LONGEST_STEP_S, fmax(4 * dt_s, LEAST_HIGH_S));
  return dt_s * fmax(1, round(high_s / dt_s));
}

/* Step i of a method whose largest one is given. */
static double step_at(const SporeStudy *study, double high_s, size_t i) {
  const SporeAccuracyOptions *options = &study->options;
  double part = options->dt_count > 1 ? (double)i / (double)(options->dt_count - 1) : 0;
  double wanted = options->dt_count > 0 ? high_s * pow(options->dt_low_s / high_s, part) : high_s / (double)(1u << i);
  return spore_trial_step(study->report->interval_s, wanted);
}

static double first_step(const SporeStudy *study, const SporeWorld *world, size_t method) {
  double high_s = high_step(study);
  if (study->options.dt_count > 0) return high_s;
  double limit_s = step_limit(study, world, study->report->methods[method].method.integrator);
  return fmax(fmin(high_s, limit_s), LEAST_FIRST_S);
}

typedef struct Pair { /* a method at a level */
  size_t method;
  int level;
  double first_s;
} Pair;

/* Halves the first step of a method until the scene is made with it, where nobody asked for that step: particles beside
 * other bodies keep their method and bear less. False: the study ended. */
static bool lower_first_step(SporeStudy *study, Pair *pair) {
  for (int i = 0; study->options.dt_count == 0 && i < HALVINGS; i++) {
    const SporeAccuracyWorld wanted = {.method = &study->report->methods[pair->method].method,
                                       .level = pair->level,
                                       .dt_s = step_at(study, pair->first_s, 0)};
    SporeError why = SPORE_ERROR_INIT;
    SporeWorld *world = study->scene.make(study->scene.data, &wanted, &why);
    if (world) study->scene.drop(study->scene.data, world);
    if (why.code == SPORE_ERROR_CANCELLED) return spore_error_set(study->error, why.code, NULL, "%s", why.message);
    if (world || wanted.dt_s * 0.5 < LEAST_FIRST_S) return true;
    pair->first_s = wanted.dt_s * 0.5;
  }
  return true;
}

/* One run of every point. */

/* Runs a point of the report. */
static SporeStudyOutcome run_point(SporeStudy *study, size_t index) {
  SporeAccuracyReport *report = study->report;
  SporeAccuracyPoint *point = &report->points[index];
  const SporeAccuracyFit *fit = &report->methods[point->method];
  const SporeAccuracyWorld world = {.method = &fit->method, .level = point->level, .dt_s = point->dt_s};
  const SporeStudyRun how = {.most_s = study->options.full ? 0 : RUN_SHARE * study->most_s};
  SporeError why = SPORE_ERROR_INIT;
  SporeStudyOutcome outcome = spore_study_run(study, &world, &how, &study->trials[index], &why);
  if (outcome == SPORE_STUDY_TOO_LONG)
    spore_study_cut(study, _("%s at %.3g ms: given up after %.2g s"), fit->label, 1e3 * point->dt_s, how.most_s);
  if (outcome != SPORE_STUDY_REFUSED) return outcome;
  study->refusal = why;
  spore_study_cut(study, _("%s: the scene does not run so: %s"), fit->label, why.message);
  return outcome;
}

/* What the first `steps` steps of a method cost, by the first of them. */
static double cost_of(const SporeStudy *study, size_t steps) {
  double ratio = 2, sum = 0;
  const SporeAccuracyOptions *options = &study->options;
  if (options->dt_count > 1) ratio = pow(options->dt_high_s / options->dt_low_s, 1 / (double)(options->dt_count - 1));
  for (size_t i = 0; i < steps; i++) sum += pow(ratio, (double)i);
  return sum;
}

static void set_samples(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  study->samples = (size_t)fmax(1, ceil(report->time_s / report->interval_s - 1e-6));
  report->time_s = (double)study->samples * report->interval_s;
}

/* What the first steps of all methods take on the processor. Less than 0: the study ended. */
static double time_first_steps(SporeStudy *study, const Pair *pairs, size_t count) {
  SporeAccuracyReport *report = study->report;
  double sum = 0;
  for (size_t p = 0; p < count; p++) {
    size_t cuts = report->cut_count;
    report->points[0] = (SporeAccuracyPoint){
        .method = pairs[p].method, .level = pairs[p].level, .dt_s = step_at(study, pairs[p].first_s, 0)};
    SporeStudyOutcome outcome = run_point(study, 0);
    if (outcome == SPORE_STUDY_ENDED) return -1;
    while (report->cut_count > cuts) spore_free(report->cuts[--report->cut_count]); /* said when it counts */
    sum += outcome == SPORE_STUDY_TOO_LONG ? RUN_SHARE * study->most_s : study->trials[0].cpu_s;
    spore_trial_clear(&study->trials[0]);
  }
  return sum;
}

/* Makes the stretch as long, and the steps as many, as the time allows, by short runs of every method. */
static bool fit_stretch(SporeStudy *study, const Pair *pairs, size_t count) {
  SporeAccuracyReport *report = study->report;
  double wanted_s = report->time_s, most_s = POINTS_SHARE * study->most_s;
  if (study->options.full) return true;
  report->time_s = fmin(wanted_s, fmax(LEAST_TIME_S, 4 * report->interval_s));
  set_samples(study);
  double shortest_s = report->time_s, first_s = time_first_steps(study, pairs, count);
  if (first_s < 0) return false;
  double possible_s = shortest_s * most_s / (first_s * cost_of(study, study->steps));
  report->time_s = fmin(wanted_s, fmax(possible_s, shortest_s));
  set_samples(study);
  double each_s = first_s * report->time_s / shortest_s;
  while (study->options.dt_count == 0 && study->options.dt_most == 0 && study->steps < MOST_STEPS &&
         each_s * cost_of(study, study->steps + 1) <= most_s)
    study->steps++;
  if (report->time_s < wanted_s * (1 - 1e-9))
    spore_study_cut(study, _("the stretch is %.3g s instead of %.3g s"), report->time_s, wanted_s);
  return true;
}

/* Whether the next step of a method, twice the work of the last one, is too much. done: steps that were run. */
static bool is_too_much(const SporeStudy *study, double last_s, size_t done) {
  double most_s = RUN_SHARE * study->most_s;
  if (done >= LEAST_STEPS)
    most_s = fmin(most_s, 2 * POINTS_SHARE * study->most_s / (double)study->report->method_count);
  return !study->options.full && 2 * last_s > most_s;
}

/* All steps of a method at a level, the largest first, while there is time. */
static bool run_pair(SporeStudy *study, const Pair *pair) {
  SporeAccuracyReport *report = study->report;
  const SporeAccuracyFit *fit = &report->methods[pair->method];
  double last_s = 0;
  size_t left = 0;
  for (size_t i = 0; i < study->steps; i++) {
    double dt_s = step_at(study, pair->first_s, i);
    bool same = i > 0 && dt_s > step_at(study, pair->first_s, i - 1) * (1 - 1e-9);
    if (same) {
      spore_study_cut(study, _("%s: the step nearest to the one wished for is %.3g ms again"), fit->label, 1e3 * dt_s);
      continue;
    }
    if (is_too_much(study, last_s, i - left)) {
      left++;
      continue;
    }
    size_t index = report->point_count;
    double began_s = spore_study_elapsed_s(study);
    report->points[index] = (SporeAccuracyPoint){.method = pair->method, .level = pair->level, .dt_s = dt_s};
    SporeStudyOutcome outcome = run_point(study, index);
    if (outcome == SPORE_STUDY_ENDED) return false;
    if (outcome == SPORE_STUDY_TOO_LONG) left += study->steps - i - 1;
    if (outcome != SPORE_STUDY_RAN) break;
    last_s = spore_study_elapsed_s(study) - began_s;
    study->costs[index * study->options.repeats] = study->trials[index].cpu_s / study->trials[index].simulated_s;
    report->points[index].repeats = 1;
    report->point_count++;
  }
  if (left > 0) spore_study_cut(study, _("%s: the %zu smallest steps, for want of time"), fit->label, left);
  return true;
}

static bool run_points(SporeStudy *study, const Pair *pairs, size_t count) {
  for (size_t p = 0; p < count; p++) {
    study->done = 0.1 + 0.25 * (double)p / (double)count;
    if (!run_pair(study, &pairs[p])) return false;
  }
  return true;
}

static bool plan_and_run(SporeStudy *study, const SporeWorld *world) {
  SporeAccuracyReport *report = study->report;
  size_t levels = report->level_count > 0 ? report->level_count : 1, count = levels * report->method_count;
  size_t most = count * (study->options.dt_count > 0 ? study->options.dt_count : MOST_STEPS);
  Pair *pairs = SPORE_NEW_ARRAY(Pair, count);
  report->points = SPORE_NEW_ARRAY(SporeAccuracyPoint, most);
  study->trials = SPORE_NEW_ARRAY(SporeTrial, most);
  study->costs = SPORE_NEW_ARRAY(double, most * study->options.repeats);
  bool good = (pairs && report->points && study->trials && study->costs) || no_memory(study);
  for (size_t p = 0; good && p < count; p++) {
    size_t method = p % report->method_count;
    pairs[p] = (Pair){method, report->level_count > 0 ? report->levels[p / report->method_count].level : -1,
                      first_step(study, world, method)};
    good = lower_first_step(study, &pairs[p]);
  }
  study->done = 0.05;
  good = good && fit_stretch(study, pairs, count) && run_points(study, pairs, count);
  spore_free(pairs);
  if (!good || report->point_count > 0) return good;
  if (study->refusal.code != SPORE_ERROR_NONE)
    return spore_error_set(study->error, SPORE_ERROR_INPUT, NULL, "%s", study->refusal.message);
  return spore_error_set(
      study->error, SPORE_ERROR_NUMERICAL, NULL,
      _("no method runs a stretch of %.3g s within %.2g s; expected one that does; ask for a shorter "
        "one (--time), larger steps (--dt), or for --full"),
      report->time_s, RUN_SHARE * study->most_s);
}

/* Whether the run of a point takes so long that once is enough. */
static bool is_long(const SporeStudy *study, size_t i) {
  return !study->options.full && study->trials[i].cpu_s > LONG_SHARE * study->most_s;
}

/* Timed runs of all points again, each round beginning with another one. */
static bool repeat(SporeStudy *study) {
  SporeAccuracyReport *report = study->report;
  double round_s = 0;
  size_t rounds = 1, wanted = study->options.repeats, count = report->point_count;
  for (size_t i = 0; i < count; i++) round_s += is_long(study, i) ? 0 : study->trials[i].cpu_s;
  for (; rounds < wanted; rounds++) {
    double began_s = spore_study_elapsed_s(study);
    if (!study->options.full && began_s + round_s > REPEATS_SHARE * study->most_s) break;
    study->done = 0.55 + 0.4 * (double)rounds / (double)wanted;
    for (size_t k = 0; k < count; k++) {
      size_t i = (k + rounds * (count / wanted + 1)) % count;
      SporeAccuracyPoint *point = &report->points[i];
      if (is_long(study, i)) continue;
      const SporeAccuracyWorld world = {
          .method = &report->methods[point->method].method, .level = point->level, .dt_s = point->dt_s};
      SporeError why = SPORE_ERROR_INIT;
      SporeTrial trial;
      SporeStudyOutcome outcome = spore_study_run(study, &world, &(SporeStudyRun){.timed_only = true}, &trial, &why);
      if (outcome != SPORE_STUDY_RAN) return outcome != SPORE_STUDY_ENDED;
      study->costs[i * wanted + point->repeats++] = trial.cpu_s / trial.simulated_s;
      spore_trial_clear(&trial);
    }
    round_s = fmax(round_s, spore_study_elapsed_s(study) - began_s);
  }
  size_t once = 0;
  for (size_t i = 0; i < count; i++) once += is_long(study, i);
  if (once > 0 && rounds > 1)
    spore_study_cut(study, _("%zu points that take longer than %.2g s are timed once"), once,
                    LONG_SHARE * study->most_s);
  if (rounds < wanted) spore_study_cut(study, _("each point is timed %zu times instead of %zu"), rounds, wanted);
  return true;
}

/* The study. */

static bool begin(SporeStudy *study) {
  const SporeAccuracyOptions *options = &study->options;
  SporeAccuracyReport *report = study->report;
  double high_s = high_step(study);
  study->steps = options->dt_count > 0 ? options->dt_count : options->dt_most > 0 ? options->dt_most : USUAL_STEPS;
  report->time_s = options->time_s > 0 ? options->time_s : USUAL_TIME_S;
  report->interval_s = high_s * fmax(1, ceil(report->time_s / high_s / SAMPLES - 1e-6));
  set_samples(study);
  report->levels = SPORE_NEW_ARRAY(SporeAccuracyLevel, options->level_count);
  if (!report->levels) return no_memory(study);
  for (size_t i = 0; i < options->level_count; i++) report->levels[i].level = options->levels[i];
  report->spheres = SPORE_NEW_ARRAY(SporeAccuracySpheres, options->sphere_count);
  if (!report->spheres) return no_memory(study);
  for (size_t i = 0; i < options->sphere_count; i++) report->spheres[i].factor = options->spheres[i];
  report->sphere_count = options->sphere_count;
  report->level_count = options->level_count;
  return true;
}

/* The scene as it is, of which points are chosen. */
static SporeWorld *open_scene(SporeStudy *study) {
  const SporeAccuracyWorld world = {.level = study->report->level_count > 0 ? SPORE_LOD_FINE : -1};
  SporeWorld *made = study->scene.make(study->scene.data, &world, study->error);
  uint32_t body = SPORE_NO_BODY;
  if (made && study->options.body) body = spore_world_find_body(made, study->options.body);
  if (made) study->body_count = spore_world_body_count(made);
  if (made && spore_trial_points_choose(&study->points, made, body, study->error)) return made;
  if (made) study->scene.drop(study->scene.data, made);
  return NULL;
}

static bool carry_out(SporeStudy *study) {
  if (!begin(study)) return false;
  SporeWorld *world = open_scene(study);
  if (!world) return false;
  bool good = choose_methods(study, world);
  if (good && study->report->level_count == 0) good = spore_study_find_window(study);
  good = good && plan_and_run(study, world);
  study->scene.drop(study->scene.data, world);
  return good && spore_study_refer(study) && spore_study_compare_spheres(study) && repeat(study) &&
         (spore_study_judge(study) || no_memory(study));
}

/* Frees the runs of the points: what is told of them stands in the report. The reference and the start stay. */
static void clear_points(SporeStudy *study) {
  for (size_t i = 0; study->trials && i < study->report->point_count; i++) spore_trial_clear(&study->trials[i]);
  for (size_t i = 0; study->perturbed && i < study->perturbed_count; i++) spore_trial_clear(&study->perturbed[i]);
  spore_free(study->trials);
  spore_free(study->perturbed);
  spore_free(study->costs);
  study->trials = study->perturbed = NULL;
  study->costs = NULL;
}

static void clear(SporeStudy *study) {
  clear_points(study);
  spore_trial_clear(&study->reference);
  spore_study_forget_state(study);
  spore_trial_points_clear(&study->points);
  spore_free(study);
}

SporeAccuracyReport *spore_accuracy_study(const SporeAccuracyScene *scene, const SporeAccuracyOptions *options,
                                          SporeError *error) {
  SporeError unseen = SPORE_ERROR_INIT;
  SporeAccuracyReport *report = SPORE_NEW(SporeAccuracyReport);
  SporeStudy *study = report ? SPORE_NEW(SporeStudy) : NULL;
  assert(scene->dt_s > 0);
  if (!study) {
    spore_free(report);
    no_memory(&(SporeStudy){.error = error ? error : &unseen});
    return NULL;
  }
  *study = (SporeStudy){.scene = *scene,
                        .options = *options,
                        .report = report,
                        .most_s = options->most_s > 0 ? options->most_s : USUAL_MOST_S,
                        .error = error ? error : &unseen,
                        .started_s = spore_processor_s()};
  if (study->options.repeats == 0) study->options.repeats = USUAL_REPEATS;
  report->study = study;
  bool good = carry_out(study);
  clear_points(study);
  study->error = NULL;
  if (good) return report;
  spore_accuracy_report_free(report);
  return NULL;
}

bool spore_accuracy_measure_more(SporeAccuracyReport *report, const SporeAccuracyWorld *world, bool timed_only,
                                 SporeAccuracyPoint *point, SporeError *error) {
  SporeStudy *study = report->study;
  SporeError unseen = SPORE_ERROR_INIT, why = SPORE_ERROR_INIT;
  SporeTrial trial;
  const SporeStudyRun how = {.timed_only = timed_only, .most_s = study->options.full ? 0 : RUN_SHARE * study->most_s};
  study->error = error ? error : &unseen;
  SporeStudyOutcome outcome = spore_study_run(study, world, &how, &trial, &why);
  study->error = NULL;
  *point = (SporeAccuracyPoint){.level = world->level, .dt_s = world->dt_s, .error = HUGE_VAL, .cost = HUGE_VAL};
  if (outcome == SPORE_STUDY_ENDED) return false;
  if (outcome != SPORE_STUDY_RAN) return true;
  double cost = trial.cpu_s / trial.simulated_s;
  point->repeats = 1;
  if (!timed_only) spore_study_judge_point(study, point, &trial, &cost);
  point->cost = cost;
  point->us_per_step = 1e6 * cost * trial.dt_s;
  point->stable = trial.stable;
  spore_trial_clear(&trial);
  return true;
}

void spore_accuracy_report_free(SporeAccuracyReport *report) {
  if (!report) return;
  if (report->study) clear(report->study);
  for (size_t i = 0; i < report->cut_count; i++) spore_free(report->cuts[i]);
  spore_free(report->cuts);
  spore_free(report->methods);
  spore_free(report->points);
  spore_free(report->levels);
  spore_free(report->spheres);
  spore_free(report->sentence);
  spore_free(report);
}
