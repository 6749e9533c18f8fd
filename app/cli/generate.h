/* Generators that work for a body of a scene, in place of a mesh file: what they make becomes the body's. */
#ifndef SPORE_APP_CLI_GENERATE_H
#define SPORE_APP_CLI_GENERATE_H

#include "app/cli/options.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"

typedef struct SporeSceneBody {
  SporeDocument *document;
  SporeObject *body, *target;    /* target: asset that the body uses already, or NULL */
  const SporeTriangleMesh *mesh; /* source of the result; owned by the document */
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
/* Opens the scene and the body. fields: gets the values of the body's asset (without one, the initial values), then
 * those of the command line. The regions of the command line come after those of the asset. */
gboolean spore_cli_open_body(SporeCli *cli, const char *file, const char *name, const SporeCliOptions *options,
                             SporeSceneBody *scene, void *fields, GError **error);
/* The source of the result, which the asset remembers. Borrows scene and fields. */
SporeGeneratedFrom spore_cli_generated_from(const SporeSceneBody *scene, const void *fields);
/* Saves the scene where it was, and says so. */
gboolean spore_cli_save_body(SporeCli *cli, SporeSceneBody *scene, const char *file, GError **error);
void spore_cli_close_body(SporeSceneBody *scene);

/* Whether a mesh can be written in the format that the file's name ends in; says so on stderr where it cannot. */
gboolean spore_cli_knows_mesh(const char *file);
/* Writes the mesh to a file whose format is known. */
gboolean spore_cli_write_mesh(const char *file, const SporeTriangleMesh *mesh, GError **error);

/* Reports the result: members of the report, and lines for people. */
typedef void SporeCliReport(SporeCli *cli, const SporeGenerateWork *work);
/* Generates from the mesh that the body (NULL: the only one) shows, gives the result to the body, and saves the scene.
 */
gboolean spore_cli_generate(SporeCli *cli, const SporeCliOptions *options, const char *file, const char *body,
                            SporeCliReport *report, GError **error);
/* spore COMMAND SCENE of a generator that has no command of its own: its facts are the report. */
int spore_command_generate(SporeCli *cli, const SporeGeneratorType *type, int argc, char **argv);

#endif
