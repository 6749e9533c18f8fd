/* A scene within a budget: the study, the search, and what was chosen timed again beside the scene as it is. */
#include "core/author/budget.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/accuracy_source.h"
#include "core/author/accuracy_study.h"
#include "core/author/budget_private.h"
#include "core/author/edits.h"
#include "core/integrate/integrator.h"
#include "core/measure/quantile.h"
#include "core/sim/solve/step_limit.h"

#define STEPS 4            /* of each method, in the study */
#define EXPLICIT_PARTS 16  /* of the scene's step: an explicit method whose steps have to be smaller is left out */
#define LEAST_SEARCH 0.25  /* of the time on the processor: what the search has when the study took all */
#define STUDY_PROGRESS 0.6 /* of all that is told of progress */
#define SEARCH_PROGRESS 0.2
#define LOW_RANK 5 /* of 20 sorted runs: the median lies between the 6th and the 15th with 95.9 % (binomial) */
#define HIGH_RANK 14

/* Subjects. */

static gboolean is_kept(const SporeBudgetOptions *options, const char *name) {
  return options->kept && g_strv_contains(options->kept, name);
}

static SporeIntegratorKind integrator_called(const char *name) {
  int kind = 0;
  while (!g_str_equal(spore_integrator_names[kind], name)) kind++;
  return (SporeIntegratorKind)kind;
}

/* Why the level of a body is not touched; NULL: it is. */
static const char *reason_of(const SporeBudgetOptions *options, const SporeWorld *world, guint32 body) {
  if (is_kept(options, spore_world_body_name(world, body))) return _("asked for");
  if (spore_world_may_be_cut(world, body)) return _("it may be cut or torn, at level fine alone");
  if (spore_world_lod_rule(world, body).by != SPORE_LOD_BY_HAND) return _("it changes its level by itself");
  return NULL;
}

/* The largest steps that the methods bear on the body, by what is stiff in it. */
static void find_limits(SporeBudgetSubject *subject, const SporeWorld *world) {
  const SporeModel *model = spore_world_body_model(world, subject->body);
  const double *q = spore_world_q(world, subject->body), *v = spore_world_v(world, subject->body);
  for (int kind = 0; kind < SPORE_INTEGRATOR_COUNT; kind++) {
    SporeStepLimit limit;
    subject->limit_s[kind] = HUGE_VAL;
    if (spore_integrator((SporeIntegratorKind)kind)->implicit || !spore_budget_may_pay(kind)) continue;
    if (!spore_step_limit(model, (SporeIntegratorKind)kind, q, v, NULL, 0, &limit, NULL)) continue;
    subject->limit_s[kind] = limit.dt_s;
  }
}

static void add_subject(SporeBudgetSearch *search, const SporeWorld *world, guint32 body, const SporeMethod *method) {
  SporeBudgetSubject *subject = &search->subjects[search->count];
  SporeBudgetBody *row = &search->result->bodies[search->count++];
  SporeLodState state;
  gboolean has_levels = spore_world_lod_state(world, body, &state);
  *subject = (SporeBudgetSubject){.name = spore_world_body_name(world, body),
                                  .body = body,
                                  .integrator = integrator_called(method->integrator.name),
                                  .substeps = method->substeps,
                                  .level = has_levels ? (int)state.level : -1,
                                  .particles = spore_world_body_model(world, body)->type->rates != NULL,
                                  .sweeps = spore_model_sweeps(spore_world_body_model(world, body))};
  find_limits(subject, world);
  row->name = g_strdup(subject->name);
  row->integrator[0] = method->integrator.name;
  row->level[0] = has_levels ? spore_lod_names[state.level] : NULL;
  row->reason = has_levels ? reason_of(search->options, world, body) : NULL;
  for (int k = 0; has_levels && k < SPORE_LOD_COUNT; k++)
    subject->levels[k] = spore_world_lod_model(world, body, (SporeLodGrade)k) != NULL;
  subject->keeps_level = !has_levels || row->reason != NULL;
  subject->keeps_integrator = subject->integrator == SPORE_INTEGRATOR_STATIC || is_kept(search->options, subject->name);
}

static gboolean find_subjects(SporeBudgetSearch *search, const SporeWorld *world, GError **error) {
  gsize bodies = spore_world_body_count(world);
  search->subjects = g_new0(SporeBudgetSubject, bodies);
  search->result->bodies = g_new0(SporeBudgetBody, bodies);
  for (guint32 body = 0; body < bodies; body++) {
    SporeMethod method;
    if (spore_world_body_method(world, body, &method)) add_subject(search, world, body, &method);
  }
  search->result->body_count = search->count;
  return search->count > 0 ||
         spore_error_raise(error, SPORE_ERROR_INPUT, NULL,
                           _("physics moves no body; expected one at least; there is nothing to choose"));
}

/* The study. */

/* Whether a body whose level is open begins at a coarser one than its finest, which errors are told from. */
static gboolean begins_coarse(const SporeBudgetSearch *search) {
  for (gsize i = 0; i < search->count; i++)
    if (!search->subjects[i].keeps_level && search->subjects[i].level != SPORE_LOD_FINE) return TRUE;
  return FALSE;
}

/* The smallest of the largest steps that the method bears on the bodies. */
static double limit_of(const SporeBudgetSearch *search, int kind) {
  double least = HUGE_VAL;
  for (gsize i = 0; i < search->count; i++) least = fmin(least, search->subjects[i].limit_s[kind]);
  return least;
}

/* Whether the study is of this method. Why not is told, where it is a matter of the scene. */
static gboolean is_studied(const SporeBudgetSearch *search, int kind, GStrvBuilder *cuts) {
  gboolean sweeps = FALSE;
  for (gsize i = 0; i < search->count; i++) sweeps |= search->subjects[i].sweeps;
  if (!spore_budget_may_pay(kind) || (spore_integrator((SporeIntegratorKind)kind)->sweeps && !sweeps)) return FALSE;
  double limit_s = limit_of(search, kind);
  if (limit_s * EXPLICIT_PARTS >= search->result->step_s) return TRUE;
  g_autofree char *cut = g_strdup_printf(_("%s for all bodies: what is stiff allows steps of %.2g ms at most"),
                                         spore_integrator_names[kind], 1e3 * limit_s);
  g_strv_builder_add(cuts, cut);
  return FALSE;
}

/* Methods of the study: the scene's own and all others that may be as cheap; none where nothing but particles moves,
 * for which the study knows better. */
static gsize choose_methods(const SporeBudgetSearch *search, const SporeAccuracyScene *scene,
                            SporeAccuracyMethod methods[SPORE_INTEGRATOR_COUNT], GStrvBuilder *cuts) {
  const SporeIntegratorKind own = scene->own.integrator;
  gsize count = 0;
  gboolean particles = TRUE;
  for (gsize i = 0; i < search->count; i++) particles &= search->subjects[i].particles;
  if (particles) return 0;
  if (own >= 0 && own != SPORE_INTEGRATOR_STATIC) methods[count++] = (SporeAccuracyMethod){own, -1, -1};
  for (int kind = 0; kind < SPORE_INTEGRATOR_COUNT; kind++)
    if (kind != (int)own && is_studied(search, kind, cuts))
      methods[count++] = (SporeAccuracyMethod){(SporeIntegratorKind)kind, -1, -1};
  return count;
}

static gboolean study(SporeBudgetSearch *search, const SporeAccuracyScene *scene, const SporeProgress *progress,
                      SporeError *fault) {
  const SporeBudgetOptions *options = search->options;
  SporeBudget *result = search->result;
  static const int fine = SPORE_LOD_FINE;
  SporeAccuracyMethod methods[SPORE_INTEGRATOR_COUNT];
  g_autoptr(GStrvBuilder) cuts = g_strv_builder_new();
  gboolean coarse = begins_coarse(search);
  double most_s = options->most_s > 0 ? options->most_s : SPORE_BUDGET_USUAL_S;
  search->until_s = spore_processor_s() + most_s;
  const SporeAccuracyOptions wanted = {.levels = &fine,
                                       .level_count = coarse ? 1 : 0,
                                       .methods = methods,
                                       .method_count = choose_methods(search, scene, methods, cuts),
                                       .dt_most = STEPS,
                                       .time_s = options->time_s,
                                       .most_s = most_s,
                                       .repeats = 1,
                                       .cancel = options->cancel,
                                       .progress = progress};
  search->report = spore_accuracy_study(scene, &wanted, fault);
  if (!search->report) return FALSE;
  search->until_s = fmax(search->until_s, spore_processor_s() + LEAST_SEARCH * most_s);
  result->start_s = search->report->start_s, result->time_s = search->report->time_s;
  result->contacts = search->report->contacts, result->floor = search->report->floor;
  result->statistics = search->report->statistics;
  for (gsize i = 0; i < search->report->cut_count; i++) g_strv_builder_add(cuts, search->report->cuts[i]);
  result->cuts = g_strv_builder_end(cuts);
  return TRUE;
}

/* The scene as it is, at the step that ends at the study's looks. */
static gboolean measure_own(SporeBudgetSearch *search, SporeError *fault) {
  double dt_s = spore_trial_step(search->report->interval_s, search->result->step_s);
  SporeBudgetChoice *own = spore_budget_choice_new(search, dt_s);
  g_ptr_array_add(search->tried, own);
  if (!spore_budget_measure(search, own, FALSE, &own->point, fault)) return FALSE;
  return isfinite(own->point.cost) ||
         spore_error_set(fault, SPORE_ERROR_NUMERICAL, NULL,
                         _("the scene as it is takes too long for %.3g s of input to be compared; expected less; ask "
                           "for a shorter time (--time), or for more seconds (--seconds)"),
                         search->report->time_s);
}

/* The result. */

static SporeBudgetForm form_of(const SporeBudgetSearch *search, const SporeBudgetChoice *choice,
                               const SporeSolverFields *solver) {
  const SporeAccuracyPoint *point = &choice->point;
  return (SporeBudgetForm){.dt_s = choice->dt_s,
                           .nonlinear =
                               spore_nonlinear_names[choice->nonlinear < 0 ? solver->nonlinear : choice->nonlinear],
                           .linear = spore_linear_names[choice->linear < 0 ? solver->linear : choice->linear],
                           .error = fmax(point->error, search->report->floor),
                           .resolved = point->error > search->report->floor,
                           .as_written = point->as_written,
                           .us = 1e6 * point->cost * search->result->step_s,
                           .step_us = 1e6 * point->cost * choice->dt_s,
                           .p99_us = point->p99_us};
}

/* What instruments do in one of two runs alone; NULL: nothing. */
static const char *what_happens(const SporeTrialEvents *a, const SporeTrialEvents *b) {
  const struct {
    guint64 in_a, in_b;
    const char *what;
  } kinds[] = {{a->broken, b->broken, _("a link breaks")},
               {a->torn, b->torn, _("a net tears")},
               {a->lost, b->lost, _("a hold of jaws tears away")},
               {a->cut, b->cut, _("something is cut")},
               {a->coagulated, b->coagulated, _("something is coagulated")},
               {a->taken, b->taken, _("particles are sucked away")},
               {a->pierced, b->pierced, _("a needle pierces something")},
               {a->stitches, b->stitches, _("a stitch is set")},
               {a->held, b->held, _("something is held")}};
  for (gsize i = 0; i < G_N_ELEMENTS(kinds); i++)
    if (!kinds[i].in_a != !kinds[i].in_b) return kinds[i].what;
  return NULL;
}

/* Median, and where it lies with 95 %, of SPORE_BUDGET_RUNS costs. */
static void summarise(double *costs, double step_s, SporeBudgetForm *form) {
  form->median_us = 1e6 * step_s * spore_quantile(costs, SPORE_BUDGET_RUNS, 0.5); /* sorts them */
  form->low_us = 1e6 * step_s * costs[LOW_RANK];
  form->high_us = 1e6 * step_s * costs[HIGH_RANK];
}

/* Times both forms in turn, the one that begins in turn, too. */
static gboolean time_both(SporeBudgetSearch *search, SporeBudgetChoice *own, SporeBudgetChoice *chosen,
                          SporeError *fault) {
  SporeBudgetChoice *const forms[] = {own, chosen};
  double costs[2][SPORE_BUDGET_RUNS];
  double first = STUDY_PROGRESS + SEARCH_PROGRESS;
  for (guint i = 0; i < SPORE_BUDGET_RUNS; i++)
    for (guint k = 0; k < 2; k++) {
      guint form = (i + k) % 2;
      SporeAccuracyPoint point;
      search->share.done = first + (1 - first) * i / SPORE_BUDGET_RUNS;
      if (!spore_budget_measure(search, forms[form], TRUE, &point, fault)) return FALSE;
      costs[form][i] = point.cost;
    }
  SporeBudget *result = search->result;
  summarise(costs[0], result->step_s, &result->before);
  summarise(costs[1], result->step_s, &result->chosen);
  result->kept_promise = fabs(result->chosen.median_us / result->chosen.us - 1) <= SPORE_BUDGET_WITHIN;
  result->met = result->chosen.median_us <= result->budget_us;
  return TRUE;
}

static void fill_bodies(SporeBudgetSearch *search, const SporeBudgetChoice *chosen) {
  SporeBudget *result = search->result;
  for (gsize i = 0; i < search->count; i++) {
    SporeBudgetBody *body = &result->bodies[i];
    body->integrator[1] =
        chosen->integrator[i] < 0 ? body->integrator[0] : spore_integrator_names[chosen->integrator[i]];
    body->level[1] = chosen->level[i] < 0 ? body->level[0] : spore_lod_names[chosen->level[i]];
  }
  result->setting_count = search->count;
  result->settings = g_new0(SporeBodySetting, search->count);
  spore_budget_choice_variation(search, chosen, result->settings);
  for (gsize i = 0; i < search->count; i++) result->settings[i].body = result->bodies[i].name;
}

/* Adds to what was cut that the search ended early. */
static void say_ended(SporeBudget *result) {
  g_autoptr(GStrvBuilder) cuts = g_strv_builder_new();
  g_autofree char *cut = g_strdup_printf(_("the search ended after %u runs, for want of time"), result->tried);
  g_strv_builder_addv(cuts, (const char **)result->cuts);
  g_strv_builder_add(cuts, cut);
  g_strfreev(result->cuts);
  result->cuts = g_strv_builder_end(cuts);
}

static gboolean choose(SporeBudgetSearch *search, SporeDocument *document, SporeError *fault) {
  SporeBudget *result = search->result;
  SporeSolverFields solver;
  search->share = (SporeProgressShare){search->options->progress, STUDY_PROGRESS, 0};
  if (!measure_own(search, fault)) return FALSE;
  SporeBudgetChoice *chosen = spore_budget_search(search, fault), *own = search->tried->pdata[0];
  if (!chosen) return FALSE;
  if (search->ended) say_ended(result);
  spore_object_fields(spore_document_section(document, "solver"), &solver);
  result->before = form_of(search, own, &solver);
  result->chosen = form_of(search, chosen, &solver);
  result->happens = what_happens(&own->point.events, &chosen->point.events);
  fill_bodies(search, chosen);
  return !spore_budget_choice_fits(search, chosen) || time_both(search, own, chosen, fault);
}

SporeBudget *spore_budget_find(SporeDocument *document, const SporeSimulation *simulation, SporePool *pool,
                               const SporeTrack *input, const SporeBudgetOptions *options, GError **error) {
  g_autoptr(SporeBudget) result = g_new0(SporeBudget, 1);
  SporeBudgetSearch search = {.options = options, .result = result, .measure = spore_budget_measure};
  SporeError fault = SPORE_ERROR_INIT;
  result->budget_us = options->budget_us;
  result->step_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  search.limit = 1e-6 * options->budget_us / result->step_s;
  search.tried = g_ptr_array_new_with_free_func(spore_budget_choice_free);
  gboolean good = find_subjects(&search, simulation->world, error);
  if (good) {
    SporeAccuracySource *source = spore_accuracy_source_new(document, simulation, pool, input, options->cancel, NULL);
    g_autoptr(GPtrArray) kept = g_ptr_array_new();
    for (gsize i = 0; i < search.count; i++)
      if (search.subjects[i].keeps_level) g_ptr_array_add(kept, (gpointer)search.subjects[i].name);
    g_ptr_array_add(kept, NULL);
    spore_accuracy_source_keep(source, (const char *const *)kept->pdata);
    const SporeAccuracyScene scene = spore_accuracy_source_scene(source);
    search.share = (SporeProgressShare){options->progress, 0, STUDY_PROGRESS};
    const SporeProgress progress = spore_progress_of_share(&search.share);
    good = study(&search, &scene, &progress, &fault) && choose(&search, document, &fault);
    if (!good) spore_error_propagate(&fault, error);
    result->report = search.report;
    result->time = g_get_real_time() / G_USEC_PER_SEC;
    spore_accuracy_source_free(source);
  }
  g_ptr_array_unref(search.tried);
  g_free(search.subjects);
  return good ? g_steal_pointer(&result) : NULL;
}

void spore_budget_free(SporeBudget *budget) {
  if (!budget) return;
  for (gsize i = 0; i < budget->body_count; i++) g_free(budget->bodies[i].name);
  g_free(budget->bodies);
  g_strfreev(budget->cuts);
  g_free(budget->settings);
  spore_accuracy_report_free(budget->report);
  g_free(budget);
}

gboolean spore_budget_changes(const SporeBudget *budget) {
  gboolean any = budget->chosen.dt_s != budget->before.dt_s || budget->chosen.nonlinear != budget->before.nonlinear ||
                 budget->chosen.linear != budget->before.linear;
  for (gsize i = 0; i < budget->setting_count; i++) any |= budget->settings[i].integrator || budget->settings[i].level;
  return any;
}

/* Names of the integrators of all bodies, each once; g_free. */
static char *integrators_of(const SporeBudget *budget) {
  GString *text = g_string_new(NULL);
  for (gsize i = 0; i < budget->body_count; i++) {
    const char *name = budget->bodies[i].integrator[1];
    gboolean known = FALSE;
    for (gsize k = 0; k < i; k++) known |= g_str_equal(name, budget->bodies[k].integrator[1]);
    if (!known) g_string_append_printf(text, "%s%s", text->len ? ", " : "", name);
  }
  return g_string_free(text, FALSE);
}

static gboolean remember(const SporeBudget *budget, SporeDocument *document, GError **error) {
  const SporeBudgetForm *chosen = &budget->chosen;
  g_autofree char *method = integrators_of(budget);
  const SporeMeasurement what = {.method = method,
                                 .dt_s = chosen->dt_s,
                                 .error = chosen->error,
                                 .floor = budget->floor,
                                 .step_s = 1e-6 * chosen->median_us * chosen->dt_s / budget->step_s,
                                 .report = budget->report,
                                 .time = budget->time};
  return spore_measured_remember(document, &what, error);
}

gboolean spore_budget_apply(const SporeBudget *budget, SporeDocument *document, GError **error) {
  const SporeBudgetForm *before = &budget->before, *chosen = &budget->chosen;
  const SporeVariation variation = {.settings = budget->settings,
                                    .setting_count = budget->setting_count,
                                    .dt_s = chosen->dt_s != before->dt_s ? chosen->dt_s : 0,
                                    .nonlinear = chosen->nonlinear != before->nonlinear ? chosen->nonlinear : NULL,
                                    .linear = chosen->linear != before->linear ? chosen->linear : NULL};
  spore_document_begin(document, _("Settings for a budget"));
  return spore_edit_finish(document,
                           spore_variation_set(document, &variation, error) && remember(budget, document, error));
}
