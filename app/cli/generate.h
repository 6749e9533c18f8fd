/* Generators that work for a body of a scene, in place of a mesh file: what they make becomes the body's. */
#ifndef SPORE_APP_CLI_GENERATE_H
#define SPORE_APP_CLI_GENERATE_H

#include "app/cli/options.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"

typedef struct SporeSceneBody {
  SporeDocument *document;
  SporeObject *body, *target;    /* target: asset that the body uses already, or NULL */
  const SporeTriangleMesh *mesh; /* that it is made from; the document's */
  SporeObject *source;           /* asset of the mesh */
  char *source_hash;
  SporeGenerateRegion regions[SPORE_GENERATE_REGIONS]; /* the asset's, then those of the command line */
  gsize region_count, own_count;                       /* own: of the asset */
} SporeSceneBody;

#define SPORE_SCENE_BODY_ENTRY(name)                                                                                   \
  {                                                                                                                    \
    "body", 'b', 0, G_OPTION_ARG_STRING, (name),                                                                       \
        N_("Body of the scene that gets the result (default: the only one); what is not given here is as its asset "   \
           "says"),                                                                                                    \
        "NAME"                                                                                                         \
  }

/* Whether the file is a scene, by its name. */
gboolean spore_cli_is_scene(const char *file);
/* fields: filled with what the body's asset asks for, or the usual, and over it what the command line says; its regions
 * come after the asset's. */
gboolean spore_cli_open_body(SporeCli *cli, const char *file, const char *name, const SporeCliOptions *options,
                             SporeSceneBody *scene, void *fields, GError **error);
/* What the result came from, to be remembered by the asset. Borrows scene and fields. */
SporeGeneratedFrom spore_cli_generated_from(const SporeSceneBody *scene, const void *fields);
/* Saves the scene where it was, and says so. */
gboolean spore_cli_save_body(SporeCli *cli, SporeSceneBody *scene, const char *file, GError **error);
void spore_cli_close_body(SporeSceneBody *scene);

/* Members and lines about what was made. */
typedef void SporeCliReport(SporeCli *cli, const SporeGenerateWork *work);
/* Generates from the mesh that the body (NULL: the only one) shows, gives the result to the body, and saves the scene.
 */
gboolean spore_cli_generate(SporeCli *cli, const SporeCliOptions *options, const char *file, const char *body,
                            SporeCliReport *report, GError **error);
/* spore COMMAND SCENE of a generator that has no command of its own: its facts are the report. */
int spore_command_generate(SporeCli *cli, const SporeGeneratorType *type, int argc, char **argv);

#endif
