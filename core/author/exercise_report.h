/* What came of an exercise, as a file for people and programs: a table, an object, or a page with plots in it. */
#ifndef SPORE_AUTHOR_EXERCISE_REPORT_H
#define SPORE_AUTHOR_EXERCISE_REPORT_H

#include <json-glib/json-glib.h>

#include "core/exercise/exercise.h"

/* Whether the name of the file says what kind of report it takes: .csv, .json or .html. */
gboolean spore_exercise_report_names(const char *file, GError **error);
/* The report that the file's name asks for; any other name than .csv and .html gets the object. title: of the page,
 * may be NULL. The same exercise gives the same text. g_free. */
char *spore_exercise_report(const SporeExercise *exercise, const char *title, const char *file);
/* Adds the member `exercise` to the open object: steps, metrics and score. */
void spore_exercise_report_add(const SporeExercise *exercise, JsonBuilder *builder);

#endif
