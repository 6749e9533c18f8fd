/* What came of an exercise, as a file for people and programs: a table, an object, or a page with plots in it. */
#ifndef SPORE_AUTHOR_EXERCISE_REPORT_H
#define SPORE_AUTHOR_EXERCISE_REPORT_H

#include <json-glib/json-glib.h>

#include "core/exercise/exercise.h"

/* Whether the name of the file says what kind of report it takes: .csv, .json or .html. */
gboolean spore_exercise_report_names(const char *file, GError **error);
/* Pictures for a page; both members are borrowed. */
typedef struct SporeReportPictures {
  const GPtrArray *of_step; /* of GBytes: a PNG of the moment at which the step was done; NULL or no such entry: none */
  const char *fault;        /* why pictures are missing, translated; NULL: none is */
} SporeReportPictures;
/* The report that the file's name asks for; any other name than .csv and .html gets the object. title: of the page,
 * may be NULL. pictures: NULL: none are wanted. g_free. */
char *spore_exercise_report(const SporeExercise *exercise, const char *title, const char *file,
                            const SporeReportPictures *pictures);
/* Adds the member `exercise` to the open object: steps, metrics and score. */
void spore_exercise_report_add(const SporeExercise *exercise, JsonBuilder *builder);

#endif
