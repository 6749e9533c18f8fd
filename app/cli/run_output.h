/* `spore run --output`: numbers over time, measured while a scene runs and written as CSV or JSON at the end. */
#ifndef SPORE_APP_CLI_RUN_OUTPUT_H
#define SPORE_APP_CLI_RUN_OUTPUT_H

#include "app/cli/scene.h"
#include "core/measure/numbers.h"

typedef struct SporeOutputOptions {
  char *file, *quantities, *every; /* NULL: not given */
  char **watch;
} SporeOutputOptions;

#define SPORE_OUTPUT_OPTION_ENTRIES(options)                                                                           \
  {"output",                                                                                                           \
   'o',                                                                                                                \
   0,                                                                                                                  \
   G_OPTION_ARG_FILENAME,                                                                                              \
   &(options).file,                                                                                                    \
   N_("Write numbers over time, from time 0 on: F.csv or F.json"),                                                     \
   "FILE"},                                                                                                            \
      {"quantities",                                                                                                   \
       0,                                                                                                              \
       0,                                                                                                              \
       G_OPTION_ARG_STRING,                                                                                            \
       &(options).quantities,                                                                                          \
       N_("Which ones, with commas between them (see below)"),                                                         \
       "NAMES"},                                                                                                       \
      {"watch",                                                                                                        \
       0,                                                                                                              \
       0,                                                                                                              \
       G_OPTION_ARG_STRING_ARRAY,                                                                                      \
       &(options).watch,                                                                                               \
       N_("Follow a point of a body, by its place in the scene at time 0, m: liver@0.01,0,0.02"),                      \
       "BODY@X,Y,Z"},                                                                                                  \
  {                                                                                                                    \
    "every", 0, 0, G_OPTION_ARG_STRING, &(options).every,                                                              \
        N_("Simulated time between two rows, a multiple of the step (default: the step)"), "S"                         \
  }

void spore_output_options_clear(SporeOutputOptions *options);
/* The quantities, for --help. g_free. */
char *spore_output_describe(void);
/* What can be refused before the scene is opened: names, the kind of the file, whether it can be written. record,
 * input: other files of the run, NULL: none. */
gboolean spore_output_check(const SporeOutputOptions *options, const char *scene, const char *input, const char *record,
                            GError **error);

/* An output under way. Without --output everything is NULL or 0, and no function below does anything. */
typedef struct SporeOutput {
  const char *file;              /* borrowed */
  SporeMeasurement *measurement; /* NULL: nothing is measured */
  SporeNumbers numbers;
  guint64 stride; /* steps a row */
  double dt_s;
  gboolean lost; /* a row, for want of memory */
} SporeOutput;

/* Maps the watched points and measures the first row, at time 0. The output is the caller's to clear in any case. */
gboolean spore_output_open(SporeOutput *output, const SporeOutputOptions *options, const SporeRun *run, GError **error);
/* To be called after each step. FALSE: there is no memory for more, and the run had better end. */
gboolean spore_output_step(SporeOutput *output, guint64 step);
/* Writes the file, whole or not at all; of an interrupted run, not at all. Returns the exit status. */
int spore_output_save(const SporeCli *cli, const SporeOutput *output, const char *scene);
void spore_output_clear(SporeOutput *output);

#endif
