/* spore sweep: many runs, planned, run and collected. */
#include "app/cli/sweep.h"

#include <glib/gi18n.h>
#include <stdio.h>
#include <string.h>

typedef struct Subcommand {
  const char *name;
  int (*run)(SporeCli *cli, int argc, char **argv);
  const char *summary;
} Subcommand;

static const Subcommand subcommands[] = {
    {"plan", spore_sweep_plan, N_("Write a manifest: one line for each combination of scenes and settings")},
    {"run", spore_sweep_run, N_("Run the cases of a manifest that have no result yet")},
    {"collect", spore_sweep_collect, N_("Put the results together: a table, a page, plots")},
};

int spore_command_sweep(SporeCli *cli, int argc, char **argv) {
  const char *name = argc > 1 ? argv[1] : "--help";
  for (gsize i = 0; i < G_N_ELEMENTS(subcommands); i++)
    if (g_str_equal(name, subcommands[i].name)) return subcommands[i].run(cli, argc - 1, argv + 1);
  if (!g_str_equal(name, "--help") && !g_str_equal(name, "-h"))
    return spore_cli_usage(_("spore sweep: '%s' is not known; expected plan, run or collect"), name);
  printf("%s\n\n", _("Usage: spore sweep plan|run|collect [OPTION...] [ARGUMENT...]"));
  for (gsize i = 0; i < G_N_ELEMENTS(subcommands); i++)
    printf("  %-8s %s\n", subcommands[i].name, _(subcommands[i].summary));
  printf("\n%s\n", _("`spore sweep plan --help` says more, and so on."));
  return argc > 1 ? SPORE_EXIT_DONE : SPORE_EXIT_INPUT;
}
