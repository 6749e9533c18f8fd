/* What `spore run` reports of the exercise of a scene. */
#ifndef SPORE_APP_RUN_EXERCISE_H
#define SPORE_APP_RUN_EXERCISE_H

#include "app/cli/cli.h"
#include "core/author/exercise_report.h"

/* Adds the exercise to the report, and says it to people. exercise: NULL: nothing is added. */
void spore_run_report_exercise(SporeCli *cli, const SporeExercise *exercise);

/* Whether the file of --report can be written: its name says .csv, .json or .html, and it takes the place of neither
 * the scene nor the input (NULL: none). */
gboolean spore_exercise_file_check(const char *file, const char *scene, const char *input, GError **error);
/* Writes the exercise as a table (.csv), an object (.json) or a page that needs no other file (.html), by the file's
 * name. pictures: NULL: none. Returns the exit status. */
int spore_exercise_file_save(const SporeCli *cli, const SporeExercise *exercise, const char *scene, const char *file,
                             const SporeReportPictures *pictures);

#endif
