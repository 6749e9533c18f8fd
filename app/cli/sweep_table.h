/* The results of a sweep as a table of numbers, and plots of it. */
#ifndef SPORE_APP_CLI_SWEEP_TABLE_H
#define SPORE_APP_CLI_SWEEP_TABLE_H

#include "app/cli/sweep.h"

typedef struct SporeSweepTable {
  const SporeManifest *sweep;
  SporeSweepResult **results; /* one for each case; NULL: it has none */
  char **quantities;          /* paths of numbers in the output: step_us.p99, links.cord.load_N */
  double *values;             /* cases x quantities; NAN: there is none */
} SporeSweepTable;

/* Reads all results. quantities: with commas between them; NULL: every number that is a member, or a member of a
 * member, of some output. NULL with a GError: a result is damaged, or a quantity is nowhere. */
SporeSweepTable *spore_sweep_table_read(const SporeManifest *sweep, const char *quantities, GError **error);
void spore_sweep_table_free(SporeSweepTable *table);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeSweepTable, spore_sweep_table_free)
/* Number of a quantity or axis by its name; -1: there is none. */
int spore_sweep_index(char *const *names, const char *name);

/* Comma-separated, a line for each case; g_free. */
char *spore_sweep_csv(const SporeSweepTable *table);
/* The quantity over one axis (its mean, with its standard deviation over all else), or over two: a map of
 * means. over: names of axes with a comma between them; NULL: the first two of more than one value, repeats apart.
 * g_free. */
char *spore_sweep_svg(const SporeSweepTable *table, guint quantity, const char *over, GError **error);
/* A page with a plot of each of the quantities, the table, and what is missing and failed; g_free. */
char *spore_sweep_html(const SporeSweepTable *table, const char *over, GError **error);

#endif
