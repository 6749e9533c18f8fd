/* The report of an accuracy study (core/measure/accuracy.h) for people and for files: the command line and the editor
 * give the same. Texts are translated, and freed with g_free. */
#ifndef SPORE_AUTHOR_ACCURACY_PAGE_H
#define SPORE_AUTHOR_ACCURACY_PAGE_H

#include <glib.h>

#include "core/measure/accuracy.h"

/* Name of a level of detail; NULL: -1, the scene's. */
const char *spore_accuracy_level_name(int level);
/* Indices (guint) of the points in the Pareto set, ascending by cost; g_array_unref. */
GArray *spore_accuracy_pareto(const SporeAccuracyReport *report);
/* What is to be said of a point beside its numbers: not stable, Pareto, ...; "" for nothing. */
const char *spore_accuracy_remark(const SporeAccuracyPoint *point);
/* Sentences about the stretch, the reference and what can be told, one a line. */
char *spore_accuracy_describe(const SporeAccuracyReport *report);
/* Orders of the methods, errors of the levels, and what was cut, one a line. */
char *spore_accuracy_describe_methods(const SporeAccuracyReport *report);

/* What each set of spheres gives away, one a line; "" where one set alone was asked for. */
char *spore_accuracy_describe_spheres(const SporeAccuracyReport *report);

/* A point a line, SI units, numbers in the C locale. */
char *spore_accuracy_csv(const SporeAccuracyReport *report);
/* The work-precision plot as SVG, and one self-contained HTML page with plot, sentences and table. scene: file of the
 * scene, of which the name is shown. NULL with a GError: no point can be shown, or no memory. */
char *spore_accuracy_plot(const char *scene, const SporeAccuracyReport *report, GError **error);
char *spore_accuracy_html(const char *scene, const SporeAccuracyReport *report, GError **error);

#endif
