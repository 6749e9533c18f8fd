/* spore models and spore schema: every parameter with unit, range, default and meaning, and the format as RELAX NG. */
#include <glib/gi18n.h>
#include <math.h>

#include "app/cli/cli.h"
#include "core/body/tissue.h"

static const char *type_name(SporeParameterType type) {
  static const char *const names[] = {"real", "integer", "boolean",   "vector", "choice",
                                      "text", "file",    "reference", "name"};
  return names[type];
}

/* What a running simulation does with a new value. */
static const char *change_name(SporeParameterChange change) {
  static const char *const names[] = {"live", "rebuild", "restart"};
  return names[change];
}

static void report_parameter(SporeCli *cli, const SporeParameter *parameter) {
  SporeValue value = {0};
  char initial[256] = "";
  if (!parameter->required && spore_parameter_initial(parameter, &value)) {
    spore_parameter_format(parameter, &value, initial, sizeof initial);
    spore_value_clear(&value);
  }
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", parameter->name);
  spore_cli_text(cli, "type", type_name(parameter->type));
  spore_cli_text(cli, "unit", parameter->unit);
  spore_cli_number(cli, "minimum", parameter->minimum);
  spore_cli_number(cli, "maximum", parameter->maximum);
  spore_cli_text(cli, "default", parameter->required ? NULL : initial);
  spore_cli_text(cli, "change", change_name(parameter->change));
  spore_cli_text(cli, "doc", _(parameter->doc));
  if (parameter->choices) {
    spore_cli_open_array(cli, "choices");
    for (int i = 0; parameter->choices[i]; i++) spore_cli_text(cli, NULL, parameter->choices[i]);
    spore_cli_close_array(cli);
  }
  spore_cli_close(cli);
  g_autofree char *choices = parameter->choices ? g_strjoinv(" | ", (char **)parameter->choices) : NULL;
  g_autofree char *range = choices ? g_steal_pointer(&choices)
                           : isfinite(parameter->minimum) || isfinite(parameter->maximum)
                               ? g_strdup_printf("%g to %g", parameter->minimum, parameter->maximum)
                               : g_strdup("");
  spore_cli_say(cli, "  %-24s %-9s %-7s %-22s %-10s %s\n", parameter->name, type_name(parameter->type), parameter->unit,
                range, parameter->required ? _("(required)") : initial, _(parameter->doc));
}

static void report_preset(SporeCli *cli, const SporePreset *preset) {
  g_autoptr(GPtrArray) settings = g_ptr_array_new_with_free_func(g_free);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", preset->name);
  spore_cli_text(cli, "label", _(preset->label));
  spore_cli_text(cli, "source", preset->source);
  spore_cli_open_array(cli, "settings");
  for (const char *const *setting = preset->settings; *setting; setting += 2) {
    g_ptr_array_add(settings, g_strdup_printf("%s=%s", setting[0], setting[1]));
    spore_cli_text(cli, NULL, settings->pdata[settings->len - 1]);
  }
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  g_ptr_array_add(settings, NULL);
  g_autofree char *text = g_strjoinv(" ", (char **)settings->pdata);
  spore_cli_say(cli, _("  preset %-17s %s (%s)\n"), preset->name, text, preset->source);
}

static void report_model(SporeCli *cli, const SporeModelType *type) {
  static const char *const geometry[] = {"none", "surface", "solid", "tetrahedra", "curve"};
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", type->name);
  spore_cli_text(cli, "label", _(type->label));
  spore_cli_text(cli, "doc", _(type->doc));
  spore_cli_text(cli, "geometry", geometry[type->geometry]);
  spore_cli_say(cli, "%s: %s\n%s\n", type->name, _(type->label), _(type->doc));
  spore_cli_open_array(cli, "parameters");
  for (gsize i = 0; i < type->parameters.count; i++) report_parameter(cli, &type->parameters.parameters[i]);
  spore_cli_close_array(cli);
  spore_cli_open_array(cli, "presets");
  for (const SporePreset *preset = type->presets; preset && preset->name; preset++) report_preset(cli, preset);
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  spore_cli_say(cli, "\n");
}

static void report_quantity(SporeCli *cli, const SporeTissueQuantity *quantity) {
  gboolean ranged = quantity->maximum > quantity->minimum;
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", quantity->name);
  spore_cli_text(cli, "unit", quantity->unit);
  spore_cli_number(cli, "typical", quantity->typical.number[0]);
  spore_cli_number(cli, "minimum", ranged ? quantity->minimum : NAN);
  spore_cli_number(cli, "maximum", ranged ? quantity->maximum : NAN);
  json_builder_set_member_name(cli->report, "fills");
  json_builder_add_boolean_value(cli->report, spore_tissue_fills(quantity->name));
  spore_cli_text(cli, "source", _(quantity->source));
  spore_cli_close(cli);
  g_autofree char *range = ranged ? g_strdup_printf("%g to %g", quantity->minimum, quantity->maximum) : g_strdup("-");
  spore_cli_say(cli, "  %-18s %-7s %-10g %-18s %s\n", quantity->name, quantity->unit, quantity->typical.number[0],
                range, _(quantity->source));
}

/* Quantities without a known measurement are listed, so that nobody takes a model's own value for a value of the
 * tissue. */
static void report_unknown(SporeCli *cli, const SporeTissue *tissue) {
  spore_cli_open_array(cli, "unknown");
  for (const char *const *name = spore_tissue_wanted; *name; name++) {
    if (spore_tissue_find(tissue, *name)) continue;
    json_builder_add_string_value(cli->report, *name);
    spore_cli_say(cli, "  %-26s %s\n", *name, _("no measurement was found: the model's own value, or yours"));
  }
  spore_cli_close_array(cli);
}

static void report_materials(SporeCli *cli) {
  spore_cli_open_array(cli, "materials");
  for (const SporeTissue *tissue = spore_tissues; tissue->name; tissue++) {
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", tissue->name);
    spore_cli_text(cli, "label", _(tissue->label));
    spore_cli_say(cli, "%s: %s\n", tissue->name, _(tissue->label));
    spore_cli_open_array(cli, "quantities");
    for (const SporeTissueQuantity *one = tissue->quantities; one->name; one++) report_quantity(cli, one);
    spore_cli_close_array(cli);
    report_unknown(cli, tissue);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

int spore_command_models(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"models",
       N_("each with name, label, doc, geometry (none, surface, solid, tetrahedra, curve), parameters and presets")},
      {"models.parameters",
       N_("each with name, type, unit, minimum, maximum, default, change (what a running simulation does with a new "
          "value: live, rebuild, restart), doc, and choices where there are some")},
      {"models.presets", N_("values that go together: each with name, label, source and settings (as PROPERTY=VALUE)")},
      {"materials", N_("with --materials, instead of models: tissues, each with name (for material=\"...\" in "
                       "<mechanical>), label and quantities")},
      {"materials.quantities",
       N_("each with name (of a parameter), unit, typical, minimum and maximum (null: not known), fills (whether a "
          "model takes it where its author says nothing) and source")},
      {"materials.unknown", N_("names of quantities of which no measurement was found: the model's own value stands")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {"models", "[NAME]", N_("Lists models and their parameters."), 0, 1, members};
  gboolean materials = FALSE;
  const GOptionEntry entries[] = {
      {"materials", 0, 0, G_OPTION_ARG_NONE, &materials, N_("List tissues and their figures, with sources"), NULL},
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status != SPORE_EXIT_DONE) return status;
  if (materials) {
    report_materials(cli);
    return spore_cli_finish(cli, SPORE_EXIT_DONE);
  }
  SporeModelRegistry registry = spore_schema_registry(cli->schema);
  if (argc > 1 && !spore_model_type_find(registry, argv[1])) {
    GString *names = g_string_new(NULL);
    for (gsize i = 0; registry[i]; i++) g_string_append_printf(names, "%s%s", i ? ", " : "", registry[i]->name);
    g_autofree char *list = g_string_free(names, FALSE);
    return spore_cli_usage(_("spore models: '%s' is no model; expected one of %s"), argv[1], list);
  }
  spore_cli_open_array(cli, "models");
  for (gsize i = 0; registry[i]; i++)
    if (argc < 2 || g_str_equal(argv[1], registry[i]->name)) report_model(cli, registry[i]);
  spore_cli_close_array(cli);
  return spore_cli_finish(cli, SPORE_EXIT_DONE);
}

int spore_command_schema(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {{"relax_ng", N_("the schema")}, {NULL, NULL}};
  static const SporeCommandInfo info = {"schema", "", N_("Prints the RELAX NG schema of scenes."), 0, 0, members};
  const GOptionEntry entries[] = {G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status != SPORE_EXIT_DONE) return status;
  g_autofree char *schema = spore_schema_relax_ng(cli->schema);
  spore_cli_text(cli, "relax_ng", schema);
  spore_cli_say(cli, "%s", schema);
  return spore_cli_finish(cli, SPORE_EXIT_DONE);
}
