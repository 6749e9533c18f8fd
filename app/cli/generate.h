/* A generator that works for a body of a scene, as its table and its ops say. */
#ifndef SPORE_APP_CLI_GENERATE_H
#define SPORE_APP_CLI_GENERATE_H

#include "app/cli/options.h"
#include "core/author/generator_work.h"

/* Members and lines about what was made. */
typedef void SporeCliReport(SporeCli *cli, const SporeGenerateWork *work);
/* Generates from the mesh that the body (NULL: the only one) shows, gives the result to the body, and saves the scene.
 */
gboolean spore_cli_generate(SporeCli *cli, const SporeCliOptions *options, const char *file, const char *body,
                            SporeCliReport *report, GError **error);
/* spore COMMAND SCENE of a generator that has no command of its own: its facts are the report. */
int spore_command_generate(SporeCli *cli, const SporeGeneratorType *type, int argc, char **argv);

#endif
