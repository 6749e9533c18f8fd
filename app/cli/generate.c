/* A generator works for a body of a scene: what its table and its ops say is all that is known of it here. */
#include "app/cli/generate.h"

#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/scene_body.h"

static SporeGenerateKind kind_of(const SporeGeneratorType *type) {
  SporeGenerateKind kind = 0;
  while (spore_generators[kind] != type) kind++;
  return kind;
}

/* The regions of the command line come after those of the asset. */
static SporeGenerateWork *new_work(const SporeSceneBody *scene, const SporeGenerateOptions *options, GError **error) {
  SporeGenerateWork *work = spore_generate_work_new(scene->document, scene->body, options, error);
  if (!work) return NULL;
  memcpy(work->regions, scene->regions, scene->region_count * sizeof *scene->regions);
  work->region_count = scene->region_count;
  return work;
}

static gboolean generate(SporeCli *cli, const SporeCliOptions *asked, const char *file, const char *body,
                         SporeCliReport *report, SporeSceneBody *scene, GError **error) {
  SporeGenerateOptions options = {.kind = kind_of(asked->type), .purpose = MAX(asked->purpose, 0)};
  if (!spore_cli_open_body(cli, file, body, asked, scene, &options.fields, error)) return FALSE;
  SporeGenerateWork *work = new_work(scene, &options, error);
  gboolean done = work && asked->type->run(work, spore_cli_progress(cli), error) &&
                  spore_generate_work_apply(work, scene->document, error);
  if (done) report(cli, work);
  if (work) spore_generate_work_unref(work);
  return done && spore_cli_save_body(cli, scene, file, error);
}

gboolean spore_cli_generate(SporeCli *cli, const SporeCliOptions *options, const char *file, const char *body,
                            SporeCliReport *report, GError **error) {
  SporeSceneBody scene = {0};
  gboolean done = generate(cli, options, file, body, report, &scene, error);
  spore_cli_close_body(&scene);
  return done;
}

static void report_facts(SporeCli *cli, const SporeGenerateWork *work) {
  g_autofree char *facts = spore_generators[work->options.kind]->facts(work);
  spore_cli_text(cli, "facts", facts);
  spore_cli_say(cli, "%s\n", facts);
}

int spore_command_generate(SporeCli *cli, const SporeGeneratorType *type, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"facts", N_("what was made, in words")},
      {"scene", N_("that was given: as written, and the name of the body that has the result: body")},
      {NULL, NULL}};
  const SporeCommandInfo info = {type->command, "SCENE", type->working, 1, 1, members};
  char *body = NULL;
  GError *error = NULL;
  const GOptionEntry entries[] = {SPORE_SCENE_BODY_ENTRY(&body), G_OPTION_ENTRY_NULL};
  g_auto(SporeCliOptions) options = {0};
  int status = spore_cli_options_parse(&options, cli, type, "", &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE)
    status = spore_cli_generate(cli, &options, argv[1], body, report_facts, &error)
                 ? spore_cli_finish(cli, SPORE_EXIT_DONE)
                 : spore_cli_fail(error);
  g_free(body);
  return status;
}
