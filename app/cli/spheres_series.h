/* `spore spheres --counts`: error against the number of spheres. */
#ifndef SPORE_APP_CLI_SPHERES_SERIES_H
#define SPORE_APP_CLI_SPHERES_SERIES_H

#include "app/cli/cli.h"
#include "core/generate/spheres/spheres.h"

/* "16,32,64" as an array of size_t, ascending; NULL with a GError. */
GArray *spore_cli_counts(const char *text, GError **error);

/* Measures the series, reports it, and writes the plot and the table (NULL: not asked for). */
gboolean spore_cli_spheres_series(SporeCli *cli, const char *file, const SporeSpheresSource *source,
                                  const SporeSpheresOptions *options, const GArray *counts, double worth,
                                  const char *svg, const char *csv, GError **error);

/* The members of a set's report. */
void spore_cli_spheres_members(SporeCli *cli, size_t count, const SporeSpheresReport *report);

#endif
