/* Opening a scene from the command line, with the options that change it, and running it. */
#ifndef SPORE_APP_CLI_SCENE_H
#define SPORE_APP_CLI_SCENE_H

#include "app/cli/cli.h"
#include "core/scene/compile.h"

typedef struct SporeSceneOptions {
  char **set; /* PATH=VALUE, PATH ending in the property: solver/time_step, bodies/liver/collision/stiffness */
  char *integrator, *dt, *input;
} SporeSceneOptions;

#define SPORE_SCENE_OPTION_ENTRIES(options)                                                                            \
  {                                                                                                                    \
      "set",                                                                                                           \
      0,                                                                                                               \
      0,                                                                                                               \
      G_OPTION_ARG_STRING_ARRAY,                                                                                       \
      &(options).set,                                                                                                  \
      N_("Set a property: bodies/liver/position=\"0 0 1\""),                                                           \
      "PATH=VALUE"},                                                                                                   \
      {"dt", 0, 0, G_OPTION_ARG_STRING, &(options).dt, N_("Time step, s"), "S"},                                       \
      {"integrator", 0, 0, G_OPTION_ARG_STRING, &(options).integrator, N_("Integrator"), "NAME"}, {                    \
    "input", 0, 0, G_OPTION_ARG_FILENAME, &(options).input, N_("Recorded device input"), "TRACK"                       \
  }

void spore_scene_options_clear(SporeSceneOptions *options);

/* Sets PATH/PROPERTY=VALUE; makes the unit of a body where it does not exist yet. */
gboolean spore_cli_set(SporeDocument *document, const char *setting, GError **error);
/* Reports one problem: an element of the open array of the report, and a line for people. */
void spore_cli_diagnostic(SporeCli *cli, const char *place, const char *message, const char *remedy);
/* Reports all problems of a scene: elements of the open array of the report, and lines for people. */
void spore_cli_diagnostics(SporeCli *cli, SporeDocument *document);

/* An empty scene that will be written to that file (NULL: to none). Tells people where it replaces an existing file. */
SporeDocument *spore_cli_new_scene(SporeCli *cli, const char *file);
/* Finds a body by name. NULL with an error that lists the scene's bodies. place: where the name was given, for the
 * message. */
SporeObject *spore_cli_find_body(SporeDocument *document, const char *place, const char *name, GError **error);

/* Loads a scene and applies --set, --dt and --integrator. */
SporeDocument *spore_cli_load(SporeCli *cli, const char *file, const SporeSceneOptions *options, GError **error);

/* Reads the file of a track over an empty one. */
gboolean spore_cli_read_track(const char *file, SporeTrack *track, GError **error);

/* A scene that is ready to run. Everything in it lives as long as the run. */
typedef struct SporeRun {
  SporeDocument *document;
  SporePool *pool;
  SporeTrack input; /* of --input */
  SporeSimulation *simulation;
} SporeRun;

SporeRun *spore_run_open(SporeCli *cli, const char *file, const SporeSceneOptions *options, int threads,
                         GError **error);
void spore_run_free(SporeRun *run);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeRun, spore_run_free)

/* Steps that --time asks for, from its text. */
gboolean spore_cli_steps(const char *time, double dt_s, gint64 *steps, GError **error);
/* Steps between two moments that --every asks for, from its text; NULL: each step. */
gboolean spore_cli_stride(const char *every, double dt_s, guint64 *stride, GError **error);

/* Width of the column of body names in a table. */
int spore_cli_body_width(const SporeWorld *world);

/* A change of level that the command line asks for. */
typedef struct SporeLevelChange {
  guint32 body;
  SporeLodGrade level;
  double time_s;
  gboolean posted;
} SporeLevelChange;

/* Reads settings of the form BODY=LEVEL or BODY=LEVEL@SECONDS; settings may be NULL. NULL with a GError: no such body,
 * level or time. Free with g_array_unref. */
GArray *spore_level_changes_parse(const SporeWorld *world, char **settings, GError **error);
/* Posts the changes that are due. */
void spore_level_changes_post(GArray *changes, SporeWorld *world);

#endif
