/* spore check: what is wrong with a scene, before it hurts. */
#include <glib/gi18n.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/author/fix.h"
#include "core/scene/check.h"

static const char *severity_name(SporeSeverity severity) {
  static const char *const names[] = {"note", "warning", "error"};
  return names[severity];
}

/* What spore edit --fix does about it; null: nothing. What asks where a file lies is not among them. */
static void report_fix(SporeCli *cli, const char *scene, const SporeDiagnostic *diagnostic) {
  if (!spore_fix_asks_nothing(diagnostic)) {
    spore_cli_text(cli, "fix", NULL);
    return;
  }
  g_autofree char *quoted = g_shell_quote(scene);
  g_autofree char *command = g_strdup_printf("spore edit %s --fix", quoted);
  g_autofree char *does = spore_fix_label(diagnostic);
  spore_cli_open(cli, "fix");
  spore_cli_text(cli, "kind", spore_fix_name(diagnostic->fix));
  spore_cli_text(cli, "does", does);
  spore_cli_text(cli, "command", command);
  spore_cli_close(cli);
}

static void report_diagnostic(SporeCli *cli, const char *scene, const SporeDiagnostic *diagnostic) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "severity", severity_name(diagnostic->severity));
  spore_cli_text(cli, "place", diagnostic->place);
  spore_cli_text(cli, "message", diagnostic->message);
  spore_cli_text(cli, "remedy", diagnostic->remedy);
  report_fix(cli, scene, diagnostic);
  spore_cli_close(cli);
  spore_cli_say(cli, "%s: %s: %s; %s\n", diagnostic->place, severity_name(diagnostic->severity), diagnostic->message,
                diagnostic->remedy);
}

int spore_command_check(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"diagnostics", N_("what was found, worst first: severity (error, warning, note), place (FILE:LINE:COLUMN or "
                         "path), message, remedy, fix (what can be done about it without asking: kind (hold, set, "
                         "remove, generate), does (in words), command (which does all such fixes of the scene); null: "
                         "nothing)")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {"check",
                                        "SCENE",
                                        N_("Says what is wrong with a scene, and the remedy. The exit status is 1 "
                                           "where an error was found: the scene cannot run."),
                                        1,
                                        1,
                                        members};
  SporeSceneOptions options = {0};
  const GOptionEntry entries[] = {SPORE_SCENE_OPTION_ENTRIES(options), G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status != SPORE_EXIT_DONE) return status;
  GError *error = NULL;
  SporeDocument *document = spore_cli_load(cli, argv[1], &options, &error);
  spore_scene_options_clear(&options);
  if (!document) return spore_cli_fail(error);
  g_autoptr(GPtrArray) diagnostics = spore_document_check(document, spore_cli_cancel());
  if (spore_cli_interrupted()) {
    spore_document_free(document);
    return SPORE_EXIT_INTERRUPTED;
  }
  guint faults = 0;
  spore_cli_open_array(cli, "diagnostics");
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = g_ptr_array_index(diagnostics, i);
    report_diagnostic(cli, argv[1], diagnostic);
    faults += diagnostic->severity == SPORE_FAULT;
  }
  spore_cli_close_array(cli);
  if (diagnostics->len == 0) spore_cli_say(cli, _("%s: nothing to mend\n"), argv[1]);
  spore_document_free(document);
  return spore_cli_finish(cli, faults ? SPORE_EXIT_NOT_HELD : SPORE_EXIT_DONE);
}
