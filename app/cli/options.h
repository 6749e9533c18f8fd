/* Options of a command that generates: those of the generator's table, and what goes with them. An option is --NAME,
 * where NAME is the attribute's name with "-" between words. */
#ifndef SPORE_APP_CLI_OPTIONS_H
#define SPORE_APP_CLI_OPTIONS_H

#include "app/cli/cli.h"
#include "core/author/generator.h"

typedef struct SporeCliOptions {
  const SporeGeneratorType *type;
  SporeParameterTable table; /* of the asset that the generator makes */
  gboolean *given;           /* table.count: on the command line */
  SporeValue *values;        /* table.count: whether given */
  int purpose;               /* --as: index in type->purpose->choices; -1: not given */
  GArray *regions;           /* of SporeGenerateRegion: --region */
} SporeCliOptions;

void spore_cli_options_clear(SporeCliOptions *options);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(SporeCliOptions, spore_cli_options_clear)

/* Reads the command line: the options of the table, --region where the asset has regions, --as where there are several
 * purposes, and `more` (ends with G_OPTION_ENTRY_NULL). letters: "n=count t=tolerance", short forms. Returns
 * SPORE_EXIT_DONE to go on; prints its own message when it fails. The options are the caller's to clear in any case. */
int spore_cli_options_parse(SporeCliOptions *options, SporeCli *cli, const SporeGeneratorType *type,
                            const char *letters, const SporeCommandInfo *info, const GOptionEntry *more, int *argc,
                            char ***argv);
gboolean spore_cli_options_has(const SporeCliOptions *options, const char *name);
/* The number that is given; 0: none. */
double spore_cli_options_number(const SporeCliOptions *options, const char *name);
/* The way that was chosen (SporeGeneratorType.ways), -1: none. */
int spore_cli_options_way(const SporeCliOptions *options);
/* --count, --coverage, ...: the options of all ways, for messages. g_free. */
char *spore_cli_options_ways(const SporeCliOptions *options);
/* Given options replace the fields of the asset. Where a way is given, the options of other ways become 0. */
void spore_cli_options_fill(const SporeCliOptions *options, void *fields);
/* The first given option that another generator does not take, as "--NAME"; NULL: it takes all. g_free. */
char *spore_cli_options_foreign(const SporeCliOptions *options, const SporeGeneratorType *other);

#endif
