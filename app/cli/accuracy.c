/* spore accuracy: error against run time. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "app/cli/accuracy_report.h"
#include "app/cli/scene.h"
#include "core/author/accuracy_methods.h"
#include "core/author/accuracy_page.h"
#include "core/author/accuracy_study.h"
#include "core/author/sphere_sets.h"
#include "core/base/number.h"
#include "core/io/scene_xml.h"
#include "ui/render/svg.h"

#define STEPS_MOST 20
#define LONGEST_S 1e4

typedef struct Request {
  char *body, *methods, *nonlinear, *linear, *dt, *levels, *spheres, *time, *seconds;
  char *svg, *png, *csv, *html;
  gboolean full;
  SporeSceneOptions scene;
} Request;

static void clear_request(Request *request) {
  char **const texts[] = {&request->body, &request->methods, &request->nonlinear, &request->linear,  &request->spheres,
                          &request->dt,   &request->levels,  &request->time,      &request->seconds, &request->svg,
                          &request->png,  &request->csv,     &request->html};
  for (gsize i = 0; i < G_N_ELEMENTS(texts); i++) g_clear_pointer(texts[i], g_free);
  spore_scene_options_clear(&request->scene);
}

/* Indices of the names in a list with commas; text NULL: none. */
static gboolean read_names(const char *option, const char *text, const char *const *names, GArray *found,
                           GError **error) {
  g_auto(GStrv) words = g_strsplit(text ? text : "", ",", -1);
  for (char **word = words; *word; word++) {
    int index = spore_cli_choice(option, g_strstrip(*word), names, error);
    if (index < 0) return FALSE;
    g_array_append_val(found, index);
  }
  return TRUE;
}

/* INTEGRATOR, INTEGRATOR/NONLINEAR or INTEGRATOR/NONLINEAR/LINEAR. */
static gboolean read_method(const char *text, SporeAccuracyMethod *method, GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, "/", 3);
  *method = (SporeAccuracyMethod){SPORE_INTEGRATOR_DEFAULT, -1, -1};
  int integrator = spore_cli_choice("--methods", parts[0] ? parts[0] : "", spore_integrator_names, error);
  if (integrator < 0) return FALSE;
  method->integrator = (SporeIntegratorKind)integrator;
  if (parts[1] && (method->nonlinear = spore_cli_choice("--methods", parts[1], spore_nonlinear_names, error)) < 0)
    return FALSE;
  return !parts[1] || !parts[2] ||
         (method->linear = spore_cli_choice("--methods", parts[2], spore_linear_names, error)) >= 0;
}

static gboolean read_methods(const Request *request, GArray *methods, GError **error) {
  g_autoptr(GArray) nonlinear = g_array_new(FALSE, FALSE, sizeof(int));
  g_autoptr(GArray) linear = g_array_new(FALSE, FALSE, sizeof(int));
  if (!read_names("--nonlinear", request->nonlinear, spore_nonlinear_names, nonlinear, error) ||
      !read_names("--linear", request->linear, spore_linear_names, linear, error))
    return FALSE;
  if (!request->methods) spore_accuracy_methods_add_usual(methods, nonlinear, linear);
  g_auto(GStrv) words = g_strsplit(request->methods ? request->methods : "", ",", -1);
  for (char **word = words; *word; word++) {
    SporeAccuracyMethod method;
    if (!read_method(g_strstrip(*word), &method, error)) return FALSE;
    spore_accuracy_methods_add(methods, method, nonlinear, linear);
  }
  return TRUE;
}

/* LO:HI:N */
static gboolean read_steps(const char *text, SporeAccuracyOptions *options, GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, ":", -1);
  double number[3] = {0};
  gboolean good = g_strv_length(parts) == 3;
  for (int i = 0; good && i < 3; i++) {
    gsize length = strlen(parts[i]);
    good = length > 0 && spore_number_read(parts[i], length, &number[i]) == length;
  }
  good = good && number[0] >= 1e-6 && number[0] <= number[1] && number[1] <= 0.1 && number[2] == round(number[2]) &&
         number[2] >= 3 && number[2] <= STEPS_MOST;
  if (!good)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--dt",
                             _("'%s' is no range of steps; expected LO:HI:N, the smallest and the largest step in s, "
                               "1e-6 to 0.1, and how many, 3 to %d; such as 0.001:0.016:5"),
                             text, STEPS_MOST);
  options->dt_low_s = number[0], options->dt_high_s = number[1], options->dt_count = (gsize)number[2];
  return TRUE;
}

static int compare_numbers(gconstpointer a, gconstpointer b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Factors with commas between; text NULL: none. */
static gboolean read_factors(const char *text, GArray *factors, GError **error) {
  g_auto(GStrv) words = g_strsplit(text ? text : "", ",", -1);
  gboolean good = TRUE;
  for (char **word = words; *word && good; word++) {
    double factor = 0;
    gsize length = strlen(g_strstrip(*word));
    good = length > 0 && spore_number_read(*word, length, &factor) == length && factor >= SPORE_SPHERE_FACTOR_LEAST &&
           factor <= SPORE_SPHERE_FACTOR_MOST;
    g_array_append_val(factors, factor);
  }
  g_array_sort(factors, compare_numbers);
  for (guint i = 1; i < factors->len; i++)
    good = good && g_array_index(factors, double, i) > g_array_index(factors, double, i - 1);
  if (good && (!text || factors->len >= 2)) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--spheres",
                           _("'%s' is no list of factors; expected at least two different ones, %g to %g, such as "
                             "0.5,1,2"),
                           text, SPORE_SPHERE_FACTOR_LEAST, SPORE_SPHERE_FACTOR_MOST);
}

/* A time of an option within its range; text NULL: *seconds stays. */
static gboolean read_seconds(const char *option, const char *text, double least_s, double *seconds, GError **error) {
  if (!text) return TRUE;
  if (!spore_cli_seconds(option, text, seconds, error)) return FALSE;
  return (*seconds >= least_s && *seconds <= LONGEST_S) ||
         spore_error_raise(error, SPORE_ERROR_INPUT, option, _("%s s; expected %g s to %g s"), text, least_s,
                           LONGEST_S);
}

static gboolean read_times(const Request *request, SporeAccuracyOptions *options, GError **error) {
  if (request->full && request->seconds)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--seconds",
                             _("--full takes all the time that it needs; expected one of the two; leave one out"));
  return read_seconds("--time", request->time, 1e-3, &options->time_s, error) &&
         read_seconds("--seconds", request->seconds, 1, &options->most_s, error);
}

static gboolean check_body(SporeRun *run, const char *name, GError **error) {
  if (!name) return TRUE;
  SporeObject *body = spore_cli_find_body(run->document, "--body", name, error);
  if (!body) return FALSE;
  return (int)spore_object_number(body, "role") == SPORE_PASSIVE ||
         spore_error_raise(error, SPORE_ERROR_INPUT, "--body",
                           _("physics does not move \"%s\"; expected a passive body; name another one"), name);
}

static gboolean check_levels(const SporeRun *run, const GArray *levels, GError **error) {
  SporeLodState state;
  for (guint32 body = 0; body < spore_world_body_count(run->simulation->world); body++)
    if (spore_world_lod_state(run->simulation->world, body, &state)) return TRUE;
  return levels->len == 0 ||
         spore_error_raise(error, SPORE_ERROR_INPUT, "--levels",
                           _("no body of the scene has levels; expected <fidelity> with <coarse> or <medium>; make "
                             "levels, or leave the option out"));
}

/* A file that is to be written. */
typedef struct Output {
  const char *file; /* NULL: none */
  char *text;
  gsize size;
} Output;

static gboolean make_outputs(const char *scene, const Request *request, const SporeAccuracyReport *report,
                             Output outputs[4], GError **error) {
  g_autofree char *svg = request->svg || request->png ? spore_accuracy_plot(scene, report, error) : g_strdup("");
  if (!svg) return FALSE;
  outputs[0] = (Output){request->csv, request->csv ? spore_accuracy_csv(report) : NULL, 0};
  outputs[1] = (Output){request->svg, request->svg ? g_strdup(svg) : NULL, 0};
  outputs[2] = (Output){request->html, request->html ? spore_accuracy_html(scene, report, error) : NULL, 0};
  for (int i = 0; i < 3; i++)
    if (outputs[i].text) outputs[i].size = strlen(outputs[i].text);
  outputs[3].file = request->png;
  if (request->png) outputs[3].text = spore_svg_to_png(svg, &outputs[3].size, error);
  return (!request->html || outputs[2].text) && (!request->png || outputs[3].text);
}

/* Nothing is written before all of it is made. */
static gboolean write_files(const char *scene, const Request *request, const SporeAccuracyReport *report,
                            GError **error) {
  Output outputs[4] = {{NULL}};
  gboolean good = make_outputs(scene, request, report, outputs, error);
  for (gsize i = 0; i < G_N_ELEMENTS(outputs); i++) {
    if (good && outputs[i].file) good = spore_write_file(outputs[i].file, outputs[i].text, outputs[i].size, error);
    g_free(outputs[i].text);
  }
  return good;
}

/* Asked before the work, which takes long. */
static gboolean may_write(const char *scene, const Request *request, GError **error) {
  const char *const files[] = {request->csv, request->svg, request->html, request->png};
  gsize size;
  for (gsize i = 0; i < G_N_ELEMENTS(files); i++)
    if (files[i] && !spore_cli_has_room(files[i], scene, error)) return FALSE;
  if (!request->png) return TRUE;
  g_autoptr(GError) why = NULL;
  g_autofree char *picture =
      spore_svg_to_png("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"8\" height=\"8\"/>", &size, &why);
  return picture ||
         spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, "--png", _("%s, or write --svg instead"), why->message);
}

static gboolean study(SporeCli *cli, const char *file, const Request *request, SporeAccuracyOptions *options,
                      GError **error) {
  g_autoptr(SporeRun) run = spore_run_open(cli, file, &request->scene, 1, error);
  g_autoptr(GArray) levels = g_array_new(FALSE, FALSE, sizeof(int));
  g_autoptr(GArray) factors = g_array_new(FALSE, FALSE, sizeof(double));
  if (!read_factors(request->spheres, factors, error) || !run || !check_body(run, request->body, error) ||
      !read_names("--levels", request->levels, spore_lod_names, levels, error) || !check_levels(run, levels, error))
    return FALSE;
  options->levels = (const int *)(gconstpointer)levels->data;
  options->level_count = levels->len;
  options->spheres = (const double *)(gconstpointer)factors->data;
  options->sphere_count = factors->len;
  const SporeTrack *input = request->scene.input ? &run->input : NULL;
  SporeAccuracyStudy *found =
      spore_accuracy_study_new(run->document, run->simulation, run->pool, input, options, error);
  if (!found) return FALSE;
  gboolean done = write_files(file, request, found->report, error);
  if (done) spore_accuracy_tell(cli, file, found->report);
  spore_accuracy_study_free(found);
  return done;
}

static int carry_out(SporeCli *cli, const char *file, const Request *request) {
  GError *error = NULL;
  g_autoptr(GArray) methods = g_array_new(FALSE, FALSE, sizeof(SporeAccuracyMethod));
  SporeAccuracyOptions options = {
      .body = request->body, .full = request->full, .cancel = spore_cli_cancel(), .progress = spore_cli_progress(cli)};
  if (!read_methods(request, methods, &error) || !read_times(request, &options, &error)) return spore_cli_fail(error);
  if (request->dt && !read_steps(request->dt, &options, &error)) return spore_cli_fail(error);
  options.methods = (const SporeAccuracyMethod *)(gconstpointer)methods->data;
  options.method_count = methods->len;
  if (!may_write(file, request, &error) || !study(cli, file, request, &options, &error)) return spore_cli_fail(error);
  spore_progress(options.progress, 1, NULL);
  return spore_cli_finish(cli, SPORE_EXIT_DONE);
}

int spore_command_accuracy(SporeCli *cli, int argc, char **argv) {
  static const SporeCommandInfo info = {
      "accuracy",
      "SCENE",
      N_("Measures what a choice of method and step costs, and how wrong it is: runs the scene by several methods and "
         "steps, against a reference that tells its own error."),
      1,
      1,
      spore_accuracy_members};
  Request r = {0};
  const GOptionEntry entries[] = {
      {"body", 0, 0, G_OPTION_ARG_STRING, &r.body, N_("Vary and measure this body alone"), "BODY"},
      {"methods", 0, 0, G_OPTION_ARG_STRING, &r.methods,
       N_("Integrators, with commas between; each may name its solvers: implicit_euler/broyden/cholesky"), "A,B"},
      {"dt", 0, 0, G_OPTION_ARG_STRING, &r.dt, N_("Steps of every method, s, in equal ratios: 0.001:0.016:5"),
       "LO:HI:N"},
      {"nonlinear", 0, 0, G_OPTION_ARG_STRING, &r.nonlinear, N_("Each implicit method with each of these solvers"),
       "A,B"},
      {"linear", 0, 0, G_OPTION_ARG_STRING, &r.linear, N_("Each implicit method with each of these linear solvers"),
       "A,B"},
      {"levels", 0, 0, G_OPTION_ARG_STRING, &r.levels, N_("Levels of detail: coarse,medium,fine"), "A,B"},
      {"spheres", 0, 0, G_OPTION_ARG_STRING, &r.spheres,
       N_("What fewer spheres give away: generate the sets anew, this many times as large: 0.5,1,2"), "A,B"},
      {"time", 't', 0, G_OPTION_ARG_STRING, &r.time, N_("Simulated time of a run (default 1)"), "S"},
      {"full", 0, 0, G_OPTION_ARG_NONE, &r.full, N_("Cut nothing to fit the time"), NULL},
      {"seconds", 0, 0, G_OPTION_ARG_STRING, &r.seconds,
       N_("Time on the processor that it all may take (default 36); what does not fit is cut, and said"), "S"},
      {"svg", 0, 0, G_OPTION_ARG_FILENAME, &r.svg, N_("Write a plot"), "F.svg"},
      {"png", 0, 0, G_OPTION_ARG_FILENAME, &r.png, N_("Write the plot as a picture"), "F.png"},
      {"csv", 0, 0, G_OPTION_ARG_FILENAME, &r.csv, N_("Write all points as a table"), "F.csv"},
      {"html", 0, 0, G_OPTION_ARG_FILENAME, &r.html, N_("Write plot, tables and sentences as one page"), "F.html"},
      {"set", 0, 0, G_OPTION_ARG_STRING_ARRAY, &r.scene.set, N_("Set a property: bodies/liver/position=\"0 0 1\""),
       "PATH=VALUE"},
      {"input", 0, 0, G_OPTION_ARG_FILENAME, &r.scene.input, N_("Recorded device input"), "TRACK"},
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = carry_out(cli, argv[1], &r);
  clear_request(&r);
  return status;
}
