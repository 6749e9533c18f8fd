/* spore plan: what a scene needs, what it leaves out, and why. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "app/cli/cli.h"
#include "app/cli/plan_tables.h"
#include "app/cli/scene.h"
#include "core/measure/pruning.h"
#include "core/scene/needs.h"
#include "core/scene/work_estimate.h"

#define LEAST_SAVED_US 0.01 /* less is not worth a word */

static void report_stage(SporeCli *cli, const SporePlanStage *stage, const SporeWorld *world,
                         const SporeWorld *unpruned) {
  double median_us = unpruned && stage->profile ? spore_profile_summary(stage->profile).median_us : -1;
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", stage->name);
  json_builder_set_member_name(cli->report, "included");
  json_builder_add_boolean_value(cli->report, stage->included);
  spore_cli_text(cli, "reason", stage->reason);
  spore_cli_count(cli, "items", (gint64)stage->items);
  if (stage->included) spore_cli_number(cli, "estimate_us", stage->estimate_us);
  if (median_us >= 0) spore_cli_number(cli, "measured_us", median_us);
  if (unpruned && !stage->included)
    spore_cli_number(cli, "saves_us", spore_pruning_saved_us(world, unpruned, stage->name));
  spore_cli_close(cli);
  g_autofree char *time = median_us >= 0 ? g_strdup_printf("%.2f us", median_us) : g_strdup("-");
  g_autofree char *estimate = stage->included ? g_strdup_printf("%.2f us", stage->estimate_us) : g_strdup("-");
  spore_cli_say(cli, "%-14s %-4s %7zu %12s %12s  %s\n", stage->name, stage->included ? _("yes") : _("no"), stage->items,
                estimate, time, stage->reason);
}

static const char *const source_names[] = {"body", "scene", "automatic", "monitor"}; /* by SporeMethodSource */
static const char *const source_words[] = {N_("body"), N_("scene"), N_("automatic"), N_("monitor")};

/* Reports who chose. The solver section always has a value: where the author gave none, that is the default. */
static void report_source(SporeCli *cli, const SporeDocument *document, const char *member, const char *what,
                          SporeMethodSource source, GString *row) {
  const SporeObject *solver = spore_document_section(document, "solver");
  int property = spore_parameter_find(spore_object_type(solver)->table, member);
  bool given = source != SPORE_SOURCE_SCENE || (property >= 0 && spore_object_is_set(solver, (guint)property));
  spore_cli_text(cli, "said_by", given ? source_names[source] : "default");
  g_autofree char *text = g_strdup_printf("%s (%s)", what, given ? _(source_words[source]) : _("default"));
  g_string_append_printf(row, " %-30s", text);
}

static void report_choice(SporeCli *cli, const SporeDocument *document, const char *member, const SporeChoice *choice,
                          GString *row) {
  if (!choice->name) {
    json_builder_set_member_name(cli->report, member);
    json_builder_add_null_value(cli->report);
    g_string_append_printf(row, " %-30s", "-");
    return;
  }
  spore_cli_open(cli, member);
  spore_cli_text(cli, "name", choice->name);
  report_source(cli, document, member, choice->name, choice->source, row);
  spore_cli_close(cli);
}

/* What takes long, said beforehand. */
static void report_work(SporeCli *cli, const SporeWorld *world, guint body) {
  SporeBodyWork work;
  if (!spore_world_body_work(world, body, &work)) return;
  spore_cli_number(cli, "make_s", work.make_s);
  spore_cli_number(cli, "factor_s", work.factor_s);
  spore_cli_number(cli, "step_s", work.step_s);
}

static void say_work(gpointer data, const char *sentence, const char *remedy) {
  spore_cli_say(data, "%s; %s\n", sentence, remedy);
}

#define LEAST_DAMPING 0.001 /* a second: less is not worth a sentence */

static void remark_coupled(GString *remarks, const char *body, const SporeMethod *method, gboolean particles) {
  const char *implicit = spore_integrator_names[SPORE_INTEGRATOR_IMPLICIT_EULER];
  if (method->coupled == SPORE_COUPLED_CONTACTS && particles)
    g_string_append_printf(
        remarks, _("%s: contacts that its step does not resolve are met in a few substeps, or are implicit\n"), body);
  else if (method->coupled == SPORE_COUPLED_CONTACTS)
    g_string_append_printf(remarks, _("%s: %s moves it in steps that do not resolve its contacts\n"), body, implicit);
  if (method->coupled == SPORE_COUPLED_CONTACTS && !particles && method->margin > 0)
    g_string_append_printf(remarks,
                           _("%s: %s moves it also in steps in which spheres are within their margins, %.3g m "
                             "apart at most\n"),
                           body, implicit, method->margin);
  if (method->coupled == SPORE_COUPLED_LINKS && particles)
    g_string_append_printf(
        remarks, _("%s: its step does not resolve its links, which are met in a few substeps, or are implicit\n"),
        body);
  else if (method->coupled == SPORE_COUPLED_LINKS && method->resolving > 0)
    g_string_append_printf(remarks,
                           _("%s: %s moves it, since its step does not resolve its links; %zu substeps would\n"), body,
                           implicit, method->resolving);
  else if (method->coupled == SPORE_COUPLED_LINKS)
    g_string_append_printf(remarks, _("%s: %s moves it, since its step does not resolve its links\n"), body, implicit);
}

static void remark_impacts(SporeCli *cli, GString *remarks, const char *body, SporeImpacts impacts) {
  const char *follower = spore_integrator_names[SPORE_INTEGRATOR_VERLET];
  json_builder_set_member_name(cli->report, "impacts");
  if (impacts == SPORE_IMPACTS_FOLLOWED) json_builder_add_string_value(cli->report, follower);
  else json_builder_add_null_value(cli->report);
  if (impacts == SPORE_IMPACTS_FOLLOWED)
    g_string_append_printf(remarks, _("%s: %s follows its impacts with one other rigid body, in parts of the step\n"),
                           body, follower);
  if (impacts == SPORE_IMPACTS_LINKED)
    g_string_append_printf(remarks, _("%s: how fast it leaves an impact depends on the step, since a link ties it\n"),
                           body);
}

static void report_damping(SporeCli *cli, const SporeWorld *world, guint body, GString *remarks) {
  double share;
  json_builder_set_member_name(cli->report, "damping_a_second");
  if (!spore_world_body_damping(world, body, &share)) {
    json_builder_add_null_value(cli->report);
    return;
  }
  json_builder_add_double_value(cli->report, share);
  if (share >= LEAST_DAMPING)
    g_string_append_printf(remarks, _("%s: its method takes %.3g %% of the energy of its slowest swing in a second\n"),
                           spore_world_body_name(world, body), 100 * share);
}

/* Whether the body is a surface with an edge, as its model takes it: a closed one encloses a volume, and does not fold.
 */
static gboolean is_open_sheet(const SporeRun *run, guint body) {
  const SporeWorld *world = run->simulation->world;
  SporeObject *object = spore_document_find(run->document, "body", spore_world_body_name(world, body));
  SporeObject *mechanical = object ? spore_object_child_of(object, "mechanical") : NULL;
  SporeObject *asset = mechanical ? spore_object_reference(mechanical, "geometry") : NULL;
  gboolean surface = spore_world_body_model(world, body)->type->geometry == SPORE_GEOMETRY_SURFACE;
  const SporeTriangleMesh *mesh = asset && surface ? spore_document_mesh(run->document, asset, NULL) : NULL;
  SporeMeshReport report;
  return mesh && spore_triangle_mesh_report(mesh, &report, NULL) && report.boundary_edges > 0;
}

/* Measured by bench_fold, on a net 90 mm wide with 500 spheres of 2 mm, at folds to radii of 3, 6 and 12 mm: what fixed
 * spheres leave open in the fold is .38 to .41 mm on average, and .38 mm where the net is flat. A reserve of 40 % more
 * spheres that goes into the sharpest fold leaves .13 mm, and a step's cost is then 4.3 us instead of 2.2; as many more
 * everywhere leave .31 mm in the fold and .27 mm beside it, at 2.8 us. */
static void remark_bending(const SporeRun *run, guint body, GString *remarks) {
  const SporeWorld *world = run->simulation->world;
  if (spore_world_body_sphere_count(world, body) < 2 || !is_open_sheet(run, body)) return;
  g_string_append_printf(
      remarks,
      _("%s: its spheres keep their places on it while it bends, which leaves gaps about 5 %% wider in a sharp fold "
        "than where it is flat; spheres that follow the fold would double the cost of contacts, and 40 %% more of them "
        "narrow all gaps by a quarter\n"),
      spore_world_body_name(world, body));
}

/* Members of a body, and the sentences that go with them. */
static void report_remarks(SporeCli *cli, const SporeRun *run, guint body, const SporeMethod *method,
                           GString *remarks) {
  const SporeWorld *world = run->simulation->world;
  json_builder_set_member_name(cli->report, "implicit_by");
  if (method->coupled == SPORE_COUPLED_NEVER) json_builder_add_null_value(cli->report);
  else json_builder_add_string_value(cli->report, method->coupled == SPORE_COUPLED_LINKS ? "links" : "contacts");
  spore_cli_count(cli, "resolving_substeps", (gint64)method->resolving);
  remark_coupled(remarks, spore_world_body_name(world, body), method,
                 spore_world_body_model(world, body)->type->rates != NULL);
  remark_impacts(cli, remarks, spore_world_body_name(world, body), method->impacts);
  report_damping(cli, world, body, remarks);
  remark_bending(run, body, remarks);
}

static void report_method(SporeCli *cli, const SporeDocument *document, const SporeWorld *world, guint index, int width,
                          const SporeMethod *method) {
  const char *body = spore_world_body_name(world, index);
  g_autoptr(GString) row = g_string_new(NULL);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", body);
  report_choice(cli, document, "integrator", &method->integrator, row);
  spore_cli_open(cli, "substeps");
  spore_cli_count(cli, "count", (gint64)method->substeps);
  g_autofree char *substeps = g_strdup_printf("%zu", method->substeps);
  report_source(cli, document, "substeps", substeps, method->substeps_source, row);
  spore_cli_close(cli);
  report_choice(cli, document, "nonlinear", &method->nonlinear, row);
  report_choice(cli, document, "linear", &method->linear, row);
  report_work(cli, world, index);
  spore_cli_say(cli, "%-*s%s\n", width, body, g_strchomp(row->str));
}

/* Says which of several balances static finds. */
static void report_branches(SporeCli *cli, const SporeWorld *world) {
  SporeMethod method;
  spore_cli_open_array(cli, "branches");
  for (guint body = 0; body < spore_world_body_count(world); body++) {
    if (!spore_world_body_method(world, body, &method) || !method.balances) continue;
    const char *name = spore_world_body_name(world, body);
    spore_cli_text(cli, NULL, name);
    spore_cli_say(
        cli,
        _("static: %s: of the balances that it may have, the one reached by following the load from the state "
          "before; others may lie beyond where its stiffness is negative\n"),
        name);
  }
  spore_cli_close_array(cli);
}

static void report_bodies(SporeCli *cli, const SporeRun *run) {
  const SporeDocument *document = run->document;
  const SporeWorld *world = run->simulation->world;
  SporeMethod method;
  gboolean titled = FALSE;
  g_autoptr(GString) remarks = g_string_new(NULL);
  int width = spore_cli_body_width(world);
  spore_cli_open_array(cli, "bodies");
  for (guint body = 0; body < spore_world_body_count(world); body++) {
    if (!spore_world_body_method(world, body, &method)) continue;
    if (!titled)
      spore_cli_say(cli, "%-*s %-30s %-30s %-30s %s\n", width, _("body"), _("integrator (source)"), _("substeps"),
                    _("nonlinear"), _("linear"));
    titled = TRUE;
    report_method(cli, document, world, body, width, &method);
    report_remarks(cli, run, body, &method, remarks);
    spore_cli_close(cli);
  }
  for (guint body = 0; body < spore_world_body_count(world); body++) spore_body_say_work(world, body, say_work, cli);
  spore_cli_close_array(cli);
  spore_cli_say(cli, "%s", remarks->str);
}

static void report_left_out(SporeCli *cli, const SporePlanLeftOut *left_out, const SporeWorld *world,
                            const SporeWorld *unpruned) {
  double saves_us = unpruned ? spore_pruning_saved_us(world, unpruned, left_out->stages) : NAN;
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "what", left_out->what);
  spore_cli_text(cli, "reason", left_out->reason);
  spore_cli_number(cli, "saves", saves_us);
  spore_cli_close(cli);
  if (saves_us >= LEAST_SAVED_US)
    spore_cli_say(cli, _("left out: %s (%s): saves %.2f us a step\n"), left_out->what, left_out->reason, saves_us);
  else spore_cli_say(cli, _("left out: %s (%s)\n"), left_out->what, left_out->reason);
}

static void report_step(SporeCli *cli, const SporeRun *run, gboolean measured) {
  const SporeWorld *world = run->simulation->world;
  const SporePlan *plan = spore_world_plan(world);
  double dt_s = spore_object_number(spore_document_section(run->document, "solver"), "time_step");
  double median_us = measured ? spore_profile_summary(spore_world_profile(world)).median_us : NAN;
  spore_cli_open(cli, "step");
  spore_cli_number(cli, "time_step_s", dt_s);
  spore_cli_number(cli, "estimate_us", plan->estimate_us);
  spore_cli_number(cli, "measured_us", median_us);
  spore_cli_close(cli);
  g_autofree char *estimate = g_strdup_printf("%.2f us", plan->estimate_us);
  g_autofree char *time = measured ? g_strdup_printf("%.2f us", median_us) : g_strdup("-");
  spore_cli_say(cli, "%-14s %-4s %7s %12s %12s  ", _("a step"), "", "", estimate, time);
  spore_cli_say(cli, _("of %g us that are simulated in it\n"), 1e6 * dt_s);
}

/* unpruned: NULL where nothing was measured. */
static void report(SporeCli *cli, const SporeRun *run, const GArray *needs, const SporeWorld *unpruned) {
  SporeDocument *document = run->document;
  const SporeWorld *world = run->simulation->world;
  const SporePlan *plan = spore_world_plan(world);
  spore_cli_say(cli, "%-14s %-4s %7s %12s %12s  %s\n", _("stage"), _("in?"), _("items"), _("estimate"), _("measured"),
                _("why"));
  spore_cli_open_array(cli, "stages");
  for (gsize i = 0; i < plan->stage_count; i++) report_stage(cli, &plan->stages[i], world, unpruned);
  spore_cli_close_array(cli);
  report_step(cli, run, unpruned != NULL);
  spore_cli_open_array(cli, "left_out");
  for (gsize i = 0; i < plan->left_out_count; i++) report_left_out(cli, &plan->left_out[i], world, unpruned);
  spore_plan_report_files_left_out(cli, document, needs);
  spore_cli_close_array(cli);
  report_bodies(cli, run);
  report_branches(cli, world);
}

int spore_command_plan(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"stages", N_("of a step, in their order: name, included, reason, items (what it works on), estimate_us (from "
                    "counts, without contacts that are not there yet, on a machine of 2024), and with --measure "
                    "measured_us, the median, or saves_us where the stage is left out")},
      {"step", N_("all stages together: time_step_s (of the scene), estimate_us, and with --measure measured_us")},
      {"left_out", N_("what the scene does not need: what, reason, and with --measure saves (us a step; else null), or "
                      "of files bytes")},
      {"unpruned", N_("with --measure: us (a step with nothing left out), ratio (to a step as "
                      "it is), equal (bit: the same states; bound: bodies sleep; "
                      "no: a fault), worst (m, how far a node is off at most)")},
      {"bodies",
       N_("that physics moves, each with its name, integrator, substeps, nonlinear and linear solver: name "
          "or count, and said_by (body, scene, default, automatic, monitor); null: nothing is solved; where its steps "
          "are implicit also about how long it takes on one core, by counts: make_s, "
          "factor_s (each time that its matrix is factorised; 0: never), step_s (at least). Of one "
          "with an explicit integrator implicit_by: links or contacts that its step does not resolve, so "
          "that implicit_euler moves it then; null: nothing. resolving_substeps: would resolve the links; 0: "
          "none would, or none need to. impacts: what follows its impacts with rigid bodies in parts of the step; "
          "null: nothing does. damping_a_second: the share of its energy that the method takes from "
          "its slowest swing; null: not known")},
      {"effects",
       N_("what is an effect: name, kind (body, or that of the tool or emitter), effect_us (of a body, in a step, by "
          "counts), physics_us (the same of its physics, without contacts and links), and of tools and emitters with "
          "--measure seconds (of the recorded input, that both were run for), step_us and step_us_physical (of a step "
          "of the scene, mean)")},
      {"branches",
       N_("names of held bodies by static, which may have several balances: the one reached by following the load "
          "from the state before is taken")},
      {"models", N_("that the scene is made of: name, bodies (how many)")},
      {"assets",
       N_("files that the scene names: name, use (simulated, drawn, source: something is generated from it, unused), "
          "bytes (null: cannot be read)")},
      {"textures",
       N_("files of textures, pictures and their places, which a picture of the scene takes and a run does not: file, "
          "bytes (null: cannot be read), bodies (names of those that wear it)")},
      {"shaders",
       N_("that a picture of the scene takes; a run takes none: name, bodies (that it draws; 0: it is for the whole "
          "picture; empty: this build makes none)")},
      {"libraries", N_("that the program has loaded for this command")},
      {"mappings",
       N_("what is drawn and felt of each body that physics moves, with points of its own: name, unit (visual or "
          "collision), points, off_share (lying off the geometry that carries them), farthest_m (how far), leverage "
          "(how "
          "much farther than its carriers one moves at most; 1: among them), and the largest error at rest, "
          "after a rigid motion, an affine one (null: it follows a frame), and a bend of a tenth of its length: "
          "rest_error_m, rigid_error_m, affine_error_m, bend_error_m")},
      {"pins",
       N_("pins on lines, a row for each side with a free part: name, body, side (start or end), held (control "
          "points), "
          "clamp_beyond_m (where the line bends as if it were clamped, from the end of the pin's radius; null: it can "
          "turn there), free_m (length outside the radius). On a sheet, side is sheet, and instead of clamp_beyond_m "
          "there is "
          "moves_m: how far within the radius places of it can still move (null: none stands still)")},
      {"levels",
       N_("where bodies have levels: each one's name, memory_bytes (of mappings, matrices and states that having "
          "levels takes), automatic (none, error, distance, time), levels: level, active, dof, spheres, and with "
          "--measure measured_us, the median of a "
          "step of the scene with the body at it from the start")},
      {"lines",
       N_("where control points come and go as a line bends (most_bend): each one's name, control points made (at the "
          "start), reserve (that there may be), dof_most (of the body with all of them), memory_bytes (that keeping "
          "them takes), and with --measure look_us (to look at its bends once a step) and change_us (when some come)")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "plan",
      "SCENE",
      N_("Says what a scene needs, what it leaves out, and why, and how each body is integrated and "
         "solved. What is chosen automatically is chosen as it runs: --measure shows it."),
      1,
      1,
      members};
  SporeSceneOptions options = {0};
  gboolean measured = FALSE;
  const GOptionEntry entries[] = {
      {"measure", 0, 0, G_OPTION_ARG_NONE, &measured, N_("Run 200 steps and say what each stage costs"), NULL},
      SPORE_SCENE_OPTION_ENTRIES(options),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status != SPORE_EXIT_DONE) return status;
  GError *error = NULL;
  g_autoptr(SporeRun) run = spore_run_open(cli, argv[1], &options, 1, &error);
  spore_scene_options_clear(&options);
  if (!run) return spore_cli_fail(error);
  spore_plan_report_pins(cli, run); /* as they hold at time 0 */
  SporePruning pruning;
  g_autoptr(SporeSimulation) unpruned = NULL;
  if (measured && !spore_plan_measure_pruning(run, &pruning, &unpruned, &error)) return spore_cli_fail(error);
  if (spore_cli_interrupted()) return SPORE_EXIT_INTERRUPTED;
  g_autoptr(GArray) needs = spore_document_asset_needs(run->document);
  report(cli, run, needs, unpruned ? unpruned->world : NULL);
  if (!spore_plan_report_effects(cli, run, measured, &error)) return spore_cli_fail(error);
  if (spore_cli_interrupted()) return SPORE_EXIT_INTERRUPTED;
  status = measured ? spore_plan_report_pruning(cli, &pruning) : SPORE_EXIT_DONE;
  spore_plan_report_needs(cli, run, needs);
  spore_plan_report_mapping(cli, run);
  spore_plan_report_lines(cli, run->simulation->world, measured);
  if (!spore_plan_report_levels(cli, run, measured ? SPORE_PRUNING_STEPS : 0, &error)) return spore_cli_fail(error);
  if (spore_cli_interrupted()) return SPORE_EXIT_INTERRUPTED;
  return spore_cli_finish(cli, status);
}
