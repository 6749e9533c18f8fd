/* Many runs of scenes: a manifest with one line for each case, and one file with what came of each case. */
#ifndef SPORE_APP_CLI_SWEEP_H
#define SPORE_APP_CLI_SWEEP_H

#include "app/cli/cli.h"

#define SPORE_SWEEP_CASES_MAXIMUM 100000

/* One run of one scene. */
typedef struct SporeSweepCase {
  guint number;
  char *hash;       /* of all that its result follows from; names the file of the result */
  char *scene;      /* from the manifest's folder, or absolute */
  char *scene_hash; /* spore_sweep_scene_hash when the sweep was planned */
  char **arguments; /* of `spore`: the command first */
  char **values;    /* one for each axis */
} SporeSweepCase;

typedef struct SporeManifest {
  char *file, *folder, *results; /* the manifest, its folder, the folder of results */
  char **axes;                   /* names of what differs between cases */
  GPtrArray *cases;              /* SporeSweepCase, in order of number from 0 on */
} SporeManifest;

/* What came of a case. */
typedef struct SporeSweepResult {
  gint64 status;     /* exit status; above 128: 128 and the signal that ended it */
  double seconds;    /* of the clock */
  char *host, *said; /* said: the first line on stderr, or NULL */
  gint64 core;       /* that the case had to itself; -1: none */
  JsonNode *output;  /* the object that --json printed; NULL: none */
} SporeSweepResult;

/* Of the scene's file and of the assets and tracks that it names, as 16 digits; g_free. NULL with a GError: it cannot
 * be read. */
char *spore_sweep_scene_hash(SporeCli *cli, const char *scene, GError **error);
/* A path from the folder, where the file lies in it; absolute otherwise. g_free. */
char *spore_sweep_path_from(const char *folder, const char *file);

SporeSweepCase *spore_sweep_case_new(guint number);
void spore_sweep_case_free(SporeSweepCase *one);
/* The manifest as text, one line a case; g_free. */
char *spore_sweep_format(const SporeManifest *sweep);
/* Reads a manifest. results: the folder of results, NULL: beside the manifest, with `.results` behind its name. */
SporeManifest *spore_sweep_read(const char *file, const char *results, GError **error);
void spore_sweep_free(SporeManifest *sweep);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeManifest, spore_sweep_free)

/* Members of the open object; text NULL: null. */
void spore_sweep_add_text(JsonBuilder *builder, const char *member, const char *text);
void spore_sweep_add_count(JsonBuilder *builder, const char *member, gint64 count);

/* The file that the result of a case is in; g_free. */
char *spore_sweep_result_file(const SporeManifest *sweep, const SporeSweepCase *one);
/* NULL without an error: there is none yet. NULL with an error: the file is damaged. */
SporeSweepResult *spore_sweep_result_read(const SporeManifest *sweep, const SporeSweepCase *one, GError **error);
void spore_sweep_result_free(SporeSweepResult *result);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeSweepResult, spore_sweep_result_free)
/* Whether the case need not run again. What a signal or a fault of ours ended may come right the next time. */
static inline gboolean spore_sweep_result_is_final(const SporeSweepResult *result) {
  return result->status <= SPORE_EXIT_INPUT;
}
/* Whether there is no output to go by. */
static inline gboolean spore_sweep_result_failed(const SporeSweepResult *result) {
  return result->status > SPORE_EXIT_NOT_HELD || !result->output;
}

/* The subcommands. */
int spore_sweep_plan(SporeCli *cli, int argc, char **argv);
int spore_sweep_run(SporeCli *cli, int argc, char **argv);
int spore_sweep_collect(SporeCli *cli, int argc, char **argv);

#endif
