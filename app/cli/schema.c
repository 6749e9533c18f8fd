/* spore schema: the format as RELAX NG, from the parameter tables. */
#include <glib/gi18n.h>
#include <stdio.h>

#include "app/cli/cli.h"

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
