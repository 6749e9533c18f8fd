/* spore check: what is wrong with a scene, before it hurts. */
#include <glib/gi18n.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/scene/check.h"

static const char *severity_name(SporeSeverity severity) {
  static const char *const names[] = {"note", "warning", "error"};
  return names[severity];
}

static void report_diagnostic(SporeCli *cli, const SporeDiagnostic *diagnostic) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "severity", severity_name(diagnostic->severity));
  spore_cli_text(cli, "place", diagnostic->place);
  spore_cli_text(cli, "message", diagnostic->message);
  spore_cli_text(cli, "remedy", diagnostic->remedy);
  spore_cli_close(cli);
  spore_cli_say(cli, "%s: %s: %s; %s\n", diagnostic->place, severity_name(diagnostic->severity), diagnostic->message,
                diagnostic->remedy);
}

int spore_command_check(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"diagnostics", N_("what was found, worst first: severity (error, warning, note), place (FILE:LINE:COLUMN or "
                         "path), message, remedy")},
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
    report_diagnostic(cli, diagnostic);
    faults += diagnostic->severity == SPORE_FAULT;
  }
  spore_cli_close_array(cli);
  if (diagnostics->len == 0) spore_cli_say(cli, _("%s: nothing to mend\n"), argv[1]);
  spore_document_free(document);
  return spore_cli_finish(cli, faults ? SPORE_EXIT_NOT_HELD : SPORE_EXIT_DONE);
}
