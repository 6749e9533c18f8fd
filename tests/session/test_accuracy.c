/* An accuracy study in the editor: a job that ends when it is cancelled, points that become the scene's method in one
 * step, and what the scene remembers of them. No display. */
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "core/scene/run_hash.h"
#include "core/scene/variation.h"
#include "models/registry.h"
#include "ui/document/asset-readers.h"
#include "ui/document/measured-facts.h"
#include "ui/jobs/accuracy-work.h"
#include "ui/jobs/plan-work.h"
#include "ui/jobs/spore-job.h"

#define SCENE SPORE_SCENES "/minimal.spore" /* a ball falls onto a floor; its step is 1 ms */

typedef struct {
  SporeSchema *schema;
  SporeEditorDocument *editor;
  SporeDocument *document;
} Fixture;

static SporeDocument *load(const SporeSchema *schema, const char *file) {
  GError *error = NULL;
  SporeDocument *document = spore_scene_load(schema, file, &error);
  g_assert_no_error(error);
  spore_document_set_readers(document, &spore_editor_readers);
  return document;
}

static void set_up(Fixture *fixture, gconstpointer data) {
  fixture->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  fixture->document = load(fixture->schema, SCENE);
  fixture->editor = spore_editor_document_new(fixture->document);
}

static void tear_down(Fixture *fixture, gconstpointer data) {
  g_object_unref(fixture->editor);
  spore_schema_free(fixture->schema);
}

static char *text_of(Fixture *fixture) {
  gsize size;
  return spore_scene_format(fixture->document, &size);
}

static void set(Fixture *fixture, const char *path, const char *property, const char *text) {
  GError *error = NULL;
  spore_edit_set_property(fixture->document, path, property, text, &error);
  g_assert_no_error(error);
}

/* Two methods over a short stretch. */
static SporeAccuracyWork *short_work(Fixture *fixture) {
  const SporeAccuracyMethod methods[] = {{SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1}, {SPORE_INTEGRATOR_VERLET, -1, -1}};
  SporeAccuracyWork *work = spore_accuracy_work_new(fixture->document);
  g_array_append_vals(work->methods, methods, G_N_ELEMENTS(methods));
  work->time_s = 0.05;
  return work;
}

static const SporeAccuracyStudy *study(Fixture *fixture) {
  GError *error = NULL;
  SporeAccuracyWork *work = short_work(fixture);
  spore_accuracy_work_run(work, NULL, &error);
  g_assert_no_error(error);
  spore_editor_document_take_study(fixture->editor, g_steal_pointer(&work->study));
  spore_accuracy_work_free(work);
  return spore_editor_document_get_study(fixture->editor);
}

/* The point of a method whose step is nearest. */
static gsize find(const SporeAccuracyStudy *of, SporeIntegratorKind kind, double dt_s) {
  const SporeAccuracyReport *report = of->report;
  gsize best = report->point_count;
  for (gsize i = 0; i < report->point_count; i++) {
    if (report->methods[report->points[i].method].method.integrator != kind) continue;
    if (best == report->point_count ||
        fabs(log(report->points[i].dt_s / dt_s)) < fabs(log(report->points[best].dt_s / dt_s)))
      best = i;
  }
  g_assert_cmpuint(best, <, report->point_count);
  return best;
}

static void apply(Fixture *fixture, gsize point) {
  GError *error = NULL;
  spore_accuracy_study_apply(spore_editor_document_get_study(fixture->editor), point, fixture->document, &error);
  g_assert_no_error(error);
}

/* A point becomes the scene's method, solver's and body's, as one step; the scene says what was measured. */
static void test_apply(Fixture *fixture, gconstpointer data) {
  g_autofree char *before = text_of(fixture);
  const SporeAccuracyStudy *of = study(fixture);
  gsize point = find(of, SPORE_INTEGRATOR_VERLET, 0.002);
  g_assert_cmpint(spore_editor_document_get_measured(fixture->editor), ==, SPORE_MEASURED_NOT);
  apply(fixture, point);
  SporeObject *solver = spore_document_section(fixture->document, "solver");
  SporeObject *mechanical = spore_document_by_path(fixture->document, "bodies/ball/mechanical");
  g_assert_cmpfloat(spore_object_number(solver, "time_step"), ==, of->report->points[point].dt_s);
  g_assert_cmpint((int)spore_object_number(solver, "integrator"), ==, SPORE_INTEGRATOR_VERLET);
  g_assert_cmpint((int)spore_object_number(mechanical, "integrator"), ==, SPORE_INTEGRATOR_VERLET + 1);
  g_assert_cmpint(spore_editor_document_get_measured(fixture->editor), ==, SPORE_MEASURED_FRESH);
  g_assert_cmpint(spore_editor_document_get_point(fixture->editor), ==, point);
  g_autofree char *figures = spore_accuracy_point_figures(of->report, &of->report->points[point]);
  g_autofree char *name = spore_accuracy_point_name(of->report, &of->report->points[point]);
  g_autofree char *wanted = g_strdup_printf("measured: %s (%s)", figures, name);
  g_autofree char *said = spore_measured_sentence(fixture->editor);
  g_assert_cmpstr(said, ==, wanted);
  spore_document_undo(fixture->document);
  g_autofree char *after = text_of(fixture);
  g_assert_cmpstr(after, ==, before);
}

/* The settings that the scene has were measured, too: its own method leaves the integrator to the solver. */
static void test_own_point(Fixture *fixture, gconstpointer data) {
  const SporeAccuracyStudy *of = study(fixture);
  gsize own = find(of, SPORE_INTEGRATOR_IMPLICIT_EULER, 0.001);
  g_assert_cmpfloat(of->report->points[own].dt_s, ==, 0.001);
  g_assert_cmpint(spore_editor_document_get_point(fixture->editor), ==, own);
  set(fixture, "bodies/ball/mechanical", "integrator", "implicit_euler"); /* says the same */
  g_assert_cmpint(spore_editor_document_get_point(fixture->editor), ==, own);
  set(fixture, "bodies/ball/mechanical", "integrator", "rk4");
  g_assert_cmpint(spore_editor_document_get_point(fixture->editor), ==, -1);
  set(fixture, "bodies/ball/mechanical", "integrator", "verlet");
  g_assert_cmpint(spore_editor_document_get_point(fixture->editor), ==, -1); /* the solver says another method still */
  set(fixture, "bodies/ball/mechanical", "integrator", NULL);
  set(fixture, "solver", "integrator", "verlet");
  g_assert_cmpint(spore_editor_document_get_point(fixture->editor), ==, find(of, SPORE_INTEGRATOR_VERLET, 0.001));
  set(fixture, "solver", "substeps", "2");
  g_assert_false(spore_editor_document_study_holds(fixture->editor));
}

/* The scene with the point runs as the study ran it, to the bit. */
static void test_apply_is_what_was_measured(Fixture *fixture, gconstpointer data) {
  const SporeAccuracyStudy *of = study(fixture);
  gsize point = find(of, SPORE_INTEGRATOR_VERLET, 0.002);
  const SporeVariation variation = {.integrator = "verlet", .dt_s = of->report->points[point].dt_s};
  g_autoptr(SporeSimulation) studied = spore_variation_make(fixture->document, &variation, NULL, NULL, NULL, NULL);
  apply(fixture, point);
  g_autoptr(SporeSimulation) applied = spore_simulation_new(fixture->document, NULL, NULL, NULL, NULL);
  for (int i = 0; i < 80; i++) {
    spore_world_step(studied->world);
    spore_world_step(applied->world);
  }
  g_assert_cmphex(spore_world_hash(studied->world), ==, spore_world_hash(applied->world));
}

/* What a run depends on makes the figures stale, and nothing else does. */
static void test_stale(Fixture *fixture, gconstpointer data) {
  const SporeAccuracyStudy *of = study(fixture);
  apply(fixture, find(of, SPORE_INTEGRATOR_IMPLICIT_EULER, 0.002));
  static const struct {
    const char *path, *property, *text;
    SporeMeasured state;
    gboolean holds; /* the other points are of the scene still */
  } changes[] = {{"meta", "title", "Another", SPORE_MEASURED_FRESH, TRUE},
                 {"bodies/ball/visual", "wetness", "0.1", SPORE_MEASURED_FRESH, TRUE},
                 {"tools/front", "field_of_view", "0.8", SPORE_MEASURED_FRESH, TRUE},
                 {"solver", "time_step", "0.0015", SPORE_MEASURED_STALE, TRUE},
                 {"bodies/ball/mechanical", "integrator", "rk4", SPORE_MEASURED_STALE, TRUE},
                 {"solver", "tolerance", "0.05", SPORE_MEASURED_STALE, FALSE},
                 {"environment", "gravity", "0 -5 0", SPORE_MEASURED_STALE, FALSE},
                 {"bodies/ball", "velocity", "0 0 0.1", SPORE_MEASURED_STALE, FALSE},
                 {"bodies/ball/collision", "spheres", "floor-spheres", SPORE_MEASURED_STALE, FALSE},
                 {"bodies/ball/mechanical/rigid_body", "density", "900", SPORE_MEASURED_STALE, FALSE}};
  for (gsize i = 0; i < G_N_ELEMENTS(changes); i++) {
    g_test_message("%s/%s", changes[i].path, changes[i].property);
    set(fixture, changes[i].path, changes[i].property, changes[i].text);
    g_assert_cmpint(spore_editor_document_get_measured(fixture->editor), ==, changes[i].state);
    g_assert_cmpint(spore_editor_document_study_holds(fixture->editor), ==, changes[i].holds);
    g_autofree char *said = spore_measured_sentence(fixture->editor);
    g_assert_cmpint(strstr(said, "stale") != NULL, ==, changes[i].state == SPORE_MEASURED_STALE);
    spore_document_undo(fixture->document);
    g_assert_cmpint(spore_editor_document_get_measured(fixture->editor), ==, SPORE_MEASURED_FRESH);
    g_assert_true(spore_editor_document_study_holds(fixture->editor));
  }
}

/* The content of an asset counts, whatever its name. */
static void test_run_hash(Fixture *fixture, gconstpointer data) {
  guint64 before = spore_document_run_hash(fixture->document);
  GError *error = NULL;
  SporeObject *spheres = spore_document_find(fixture->document, "spheres", "ball-spheres");
  spore_document_rename(fixture->document, spheres, "others", &error);
  g_assert_no_error(error);
  g_assert_cmphex(spore_document_run_hash(fixture->document), ==, before);
  g_autoptr(GBytes) content = g_bytes_new_static("0 0 0 0.011\n", 12);
  spore_document_put_blob(fixture->document, "other.spheres", content);
  set(fixture, "assets/others", "file", "other.spheres");
  g_assert_cmphex(spore_document_run_hash(fixture->document), !=, before);
}

/* What was measured is saved with the scene, and is as fresh when that is read again. */
static void test_saved(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  g_autofree char *folder = g_dir_make_tmp("spore-accuracy-XXXXXX", NULL);
  g_autofree char *file = g_build_filename(folder, "scene.spore", NULL);
  const SporeAccuracyStudy *of = study(fixture);
  apply(fixture, find(of, SPORE_INTEGRATOR_VERLET, 0.001));
  g_autofree char *said = spore_measured_sentence(fixture->editor);
  g_autofree char *source = spore_measured_source(fixture->document);
  spore_editor_document_save(fixture->editor, file, &error);
  g_assert_no_error(error);
  g_autoptr(SporeEditorDocument) again = spore_editor_document_new(load(fixture->schema, file));
  g_autofree char *said_again = spore_measured_sentence(again);
  g_autofree char *source_again = spore_measured_source(spore_editor_document_get(again));
  g_assert_cmpint(spore_editor_document_get_measured(again), ==, SPORE_MEASURED_FRESH);
  g_assert_cmpstr(said_again, ==, said);
  g_assert_cmpstr(source_again, ==, source);
  g_assert_nonnull(strstr(source, "against"));
  gboolean stale;
  g_autofree char *hint = NULL, *note = spore_measured_note(again, "solver", "time_step", &hint, &stale);
  g_assert_true(note && !stale && g_str_equal(hint, source));
}

/* Figures stand beside what a study varies, and beside nothing else. */
static void test_notes(Fixture *fixture, gconstpointer data) {
  const SporeAccuracyStudy *of = study(fixture);
  gsize point = find(of, SPORE_INTEGRATOR_VERLET, 0.001);
  apply(fixture, point);
  static const struct {
    const char *path, *property;
    gboolean noted;
  } rows[] = {{"solver", "time_step", TRUE},
              {"solver", "integrator", TRUE},
              {"solver", "nonlinear", TRUE},
              {"solver", "linear", TRUE},
              {"bodies/ball/mechanical", "integrator", TRUE},
              {"bodies/ball/fidelity", "level", FALSE}, /* no level was measured */
              {"solver", "tolerance", FALSE},
              {"bodies/ball/mechanical", "substeps", FALSE},
              {"bodies/ball", "role", FALSE}};
  g_autofree char *figures = spore_accuracy_point_figures(of->report, &of->report->points[point]);
  for (gsize i = 0; i < G_N_ELEMENTS(rows); i++) {
    gboolean stale;
    g_autofree char *hint = NULL;
    g_autofree char *note = spore_measured_note(fixture->editor, rows[i].path, rows[i].property, &hint, &stale);
    g_test_message("%s/%s: %s", rows[i].path, rows[i].property, note ? note : "-");
    g_assert_cmpstr(note, ==, rows[i].noted ? figures : NULL);
    g_assert_false(stale);
  }
  gboolean stale;
  g_autofree char *hint = NULL, *note = spore_measured_note(fixture->editor, "solver", "integrator", &hint, &stale);
  g_assert_nonnull(strstr(hint, "implicit_euler at 1 ms: ")); /* the other method at this step */
  g_assert_null(strstr(hint, "implicit_euler at 2 ms"));
  set(fixture, "environment", "gravity", "0 -5 0");
  g_autofree char *other = NULL, *after = spore_measured_note(fixture->editor, "solver", "integrator", &other, &stale);
  g_assert_true(stale);
  g_assert_cmpstr(after, ==, note);
}

/* A study of one body sets that body's method alone, and says nothing of the solver's. */
static void test_one_body(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeAccuracyWork *work = short_work(fixture);
  work->body = g_strdup("ball");
  spore_accuracy_work_run(work, NULL, &error);
  g_assert_no_error(error);
  spore_editor_document_take_study(fixture->editor, g_steal_pointer(&work->study));
  spore_accuracy_work_free(work);
  apply(fixture, find(spore_editor_document_get_study(fixture->editor), SPORE_INTEGRATOR_VERLET, 0.001));
  SporeObject *measured = spore_document_by_path(fixture->document, "meta/measured");
  g_assert_cmpstr(spore_object_text(measured, "body"), ==, "ball");
  gboolean stale;
  g_autofree char *hint = NULL, *body_hint = NULL;
  g_assert_null(spore_measured_note(fixture->editor, "solver", "integrator", &hint, &stale));
  g_autofree char *note =
      spore_measured_note(fixture->editor, "bodies/ball/mechanical", "integrator", &body_hint, &stale);
  g_assert_nonnull(note);
}

/* A point that is not stable is refused with the remedy, and nothing changes. */
static void test_unstable(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  const SporeAccuracyStudy *of = study(fixture);
  g_autofree char *before = text_of(fixture);
  of->report->points[0].stable = false;
  g_assert_false(spore_accuracy_study_apply(of, 0, fixture->document, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_assert_nonnull(strstr(error->message, "choose another one"));
  g_error_free(error);
  g_autofree char *after = text_of(fixture);
  g_assert_cmpstr(after, ==, before);
  g_assert_false(spore_document_can_undo(fixture->document));
}

/* A point at a level sets the level of the bodies that have one. */
static void test_level(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  g_assert_false(spore_accuracy_work_has_levels(fixture->document, NULL));
  SporeObject *ball = spore_document_find(fixture->document, "body", "ball");
  SporeObject *fidelity = spore_document_insert(fixture->document, ball, "fidelity", NULL, G_MAXUINT, &error);
  g_assert_true(fidelity && spore_document_insert(fixture->document, fidelity, "coarse", NULL, G_MAXUINT, &error));
  g_assert_true(spore_accuracy_work_has_levels(fixture->document, NULL));
  g_assert_true(spore_accuracy_work_has_levels(fixture->document, "ball"));
  g_assert_false(spore_accuracy_work_has_levels(fixture->document, "floor"));
  SporeAccuracyFit method = {.method = {SPORE_INTEGRATOR_VERLET, -1, -1}, .label = "verlet"};
  SporeAccuracyPoint point = {.level = SPORE_LOD_COARSE, .dt_s = 0.002, .error = 0.1, .stable = true};
  SporeAccuracyReport report = {.method_count = 1, .point_count = 1, .methods = &method, .points = &point};
  guint64 hash = 0;
  const SporeAccuracyStudy made = {.report = &report, .hashes = &hash};
  spore_accuracy_study_apply(&made, 0, fixture->document, &error);
  g_assert_no_error(error);
  g_assert_cmpint((int)spore_object_number(fidelity, "level"), ==, SPORE_LOD_COARSE);
  g_autofree char *said = spore_measured_text(fixture->document);
  g_assert_nonnull(strstr(said, "(verlet at 2 ms, coarse)"));
}

/* Jobs. */

typedef struct {
  GMainLoop *loop;
  gboolean cancelled, freed;
  double most; /* fraction that was told */
} Watch;

static Watch watch;

static void done(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  watch.cancelled = g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  if (!watch.cancelled) g_main_loop_quit(watch.loop);
}

static void freed(gpointer data) {
  spore_accuracy_work_free(data);
  watch.freed = TRUE;
  g_main_context_invoke(NULL, (GSourceFunc)(GCallback)g_main_loop_quit, watch.loop);
}

static void progressed(SporeJob *job) {
  watch.most = MAX(watch.most, spore_job_get_fraction(job));
  if (watch.most > 0) spore_job_cancel(job);
}

/* Sets of spheres are an option of the study: three are compared, the largest with itself at half the step; a scene
 * whose spheres were not generated from a mesh is refused with the remedy. */
static void test_spheres(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  SporeAccuracyWork *work = short_work(fixture);
  work->spheres = TRUE;
  g_assert_false(spore_accuracy_work_run(work, NULL, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  g_assert_nonnull(strstr(error->message, "generate spheres"));
  g_clear_error(&error);
  spore_accuracy_work_free(work);
  SporeDocument *rigid = load(fixture->schema, SPORE_SCENES "/table1-rigid.spore");
  for (int on = 0; on <= 1; on++) {
    work = spore_accuracy_work_new(rigid);
    g_array_append_val(work->methods, ((SporeAccuracyMethod){SPORE_INTEGRATOR_IMPLICIT_EULER, -1, -1}));
    work->time_s = 0.02;
    work->spheres = on;
    spore_accuracy_work_run(work, NULL, &error);
    g_assert_no_error(error);
    const SporeAccuracyReport *report = work->study->report;
    g_assert_cmpuint(report->sphere_count, ==, on ? 3 : 0);
    for (gsize i = 1; i < report->sphere_count; i++)
      g_assert_cmpuint(report->spheres[i].count, >, report->spheres[i - 1].count);
    spore_accuracy_work_free(work);
  }
  spore_document_free(rigid);
}

/* A study that would take long tells how far it is, and is over for both sides after a cancel. */
static void test_cancel(Fixture *fixture, gconstpointer data) {
  SporeAccuracyWork *work = spore_accuracy_work_new(fixture->document);
  work->full = TRUE;
  work->time_s = 1000;
  watch = (Watch){.loop = g_main_loop_new(NULL, FALSE)};
  SporeJob *job = spore_job_start("Accuracy", spore_accuracy_work_run, work, freed, done, G_OBJECT(fixture->editor));
  g_signal_connect(job, "progressed", G_CALLBACK(progressed), NULL);
  while (!watch.freed) g_main_loop_run(watch.loop);
  g_assert_true(watch.cancelled);
  g_assert_cmpfloat(watch.most, <, 1);
  g_object_unref(job);
  g_main_loop_unref(watch.loop);
}

/* The plan as a table has a row for all that is in and all that is left out, with what was measured. */
static void test_plan_table(Fixture *fixture, gconstpointer data) {
  GError *error = NULL;
  for (gboolean measured = FALSE; measured <= TRUE; measured++) {
    SporePlanWork *work = spore_plan_work_new(fixture->document, measured);
    spore_plan_work_run(work, NULL, &error);
    g_assert_no_error(error);
    const SporePlan *plan = spore_world_plan(work->simulation->world);
    g_autofree char *csv = spore_plan_work_csv(work);
    g_auto(GStrv) lines = g_strsplit(g_strchomp(csv), "\n", -1);
    g_assert_cmpuint(g_strv_length(lines), ==, 1 + plan->stage_count + plan->left_out_count);
    for (gsize i = 0; i < plan->stage_count; i++) {
      g_auto(GStrv) fields = g_strsplit(lines[1 + i], ",", 7);
      g_assert_cmpint(atoi(fields[1]), ==, plan->stages[i].included);
      gboolean timed = measured && plan->stages[i].profile;
      g_assert_cmpint(*fields[4] != '\0', ==, timed);
    }
    spore_plan_work_free(work);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
#define ADD(name, test) g_test_add("/accuracy/" name, Fixture, NULL, set_up, test, tear_down)
  ADD("apply", test_apply);
  ADD("own_point", test_own_point);
  ADD("apply_is_what_was_measured", test_apply_is_what_was_measured);
  ADD("stale", test_stale);
  ADD("run_hash", test_run_hash);
  ADD("saved", test_saved);
  ADD("notes", test_notes);
  ADD("one_body", test_one_body);
  ADD("unstable", test_unstable);
  ADD("level", test_level);
  ADD("spheres", test_spheres);
  ADD("cancel", test_cancel);
  ADD("plan_table", test_plan_table);
  return g_test_run();
}
