/* spore: the command line. */
#include <glib/gi18n.h>
#include <locale.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "app/cli/cli.h"
#include "app/cli/generate.h"
#include "app/catalogue.h"
#include "app/ending.h"
#include "core/author/generator.h"
#include "models/registry.h"

typedef struct Command {
  const char *name;
  int (*run)(SporeCli *cli, int argc, char **argv);
  const char *summary;
} Command;

static const Command commands[] = {
    {"run", spore_command_run, N_("Run a scene and say how it went")},
    {"check", spore_command_check, N_("Say what is wrong with a scene, and the remedy")},
    {"plan", spore_command_plan, N_("Say what a scene needs, what it leaves out, and why")},
    {"accuracy", spore_command_accuracy, N_("Measure what methods and steps cost, and how wrong they are")},
    {"stability", spore_command_stability, N_("Push a scene, and say what it bears")},
#ifdef SPORE_HAVE_RENDER
    {"render", spore_command_render, N_("Make a picture of a scene")},
#endif
    {"import", spore_command_import, N_("Make a scene from organ meshes")},
    {"edit", spore_command_edit, N_("Change a scene: properties, what holds an organ, a probe")},
    {"export", spore_command_export, N_("Write a scene for other programs, and for running it without SPORE")},
    {"advise", spore_command_advise, N_("Say what a scene simulates that nobody would miss")},
    {"sweep", spore_command_sweep, N_("Run many scenes and settings, and put the results together")},
    {"centreline", spore_command_centreline, N_("Find the middle line of a tubular organ")},
    {"spheres", spore_command_spheres, N_("Fit collision spheres to a mesh")},
    {"spline", spore_command_spline, N_("Make a spline sheet of a patch of an organ between four corners")},
    {"surface", spore_command_surface, N_("Make the surface of a net: fewer, well-shaped triangles")},
    {"tetrahedra", spore_command_tetrahedra, N_("Fill a mesh with tetrahedra")},
    {"models", spore_command_models, N_("List models and their parameters")},
    {"schema", spore_command_schema, N_("Print the RELAX NG schema of scenes")},
};

/* The command of a generator that has no command of its own; NULL: there is none. */
static const SporeGeneratorType *generator_of(const char *command) {
  for (gsize i = 0; i < G_N_ELEMENTS(commands); i++)
    if (g_str_equal(commands[i].name, command)) return NULL;
  for (gsize i = 0; spore_generators[i]; i++)
    if (g_str_equal(spore_generators[i]->command, command)) return spore_generators[i];
  return NULL;
}

static void print_help(void) {
  printf("%s\n\n", _("Usage: spore COMMAND [OPTION...] [ARGUMENT...]"));
  for (gsize i = 0; i < G_N_ELEMENTS(commands); i++) printf("  %-11s %s\n", commands[i].name, _(commands[i].summary));
  for (gsize i = 0; spore_generators[i]; i++)
    if (generator_of(spore_generators[i]->command))
      printf("  %-11s %s\n", spore_generators[i]->command, _(spore_generators[i]->working));
  printf("\n%s\n", _("`spore COMMAND --help` says more. Exit status: 0 done, 1 a check did not hold, 2 bad input, "
                     "3 a fault of ours."));
}

/* command NULL: the command of the generator. */
static int run_command(const Command *command, const SporeGeneratorType *generator, int argc, char **argv) {
  g_autofree char *name = g_strdup_printf("spore %s", argv[0]);
  g_set_prgname(name);
  SporeCli cli = {.schema = spore_schema_new(spore_model_registry, spore_generator_elements()),
                  .report = json_builder_new()};
  json_builder_begin_object(cli.report);
  int status = command ? command->run(&cli, argc, argv) : spore_command_generate(&cli, generator, argc, argv);
  g_object_unref(cli.report);
  spore_schema_free(cli.schema);
  return status;
}

/* What was printed is part of what was asked for: a full device must not pass for success. */
static void close_output(void) {
  gboolean failed = ferror(stdout) != 0;
  if (fflush(stdout) == 0 && !failed) return;
  if (spore_cli_interrupted()) _exit(SPORE_EXIT_INTERRUPTED); /* a signal may cut a write short */
  spore_cli_usage(_("standard output cannot be written; free some space, or send it to another place"));
  _exit(SPORE_EXIT_INPUT);
}

/* The stack grows as it is used. Where memory is short that fails, and ends a program without a word: what it needs is
 * taken before anything else. */
#define STACK_BYTES (256 * 1024)
#define PAGE_BYTES 4096
static __attribute__((noinline)) void take_stack(void) {
  volatile char room[STACK_BYTES];
  for (gsize i = 0; i < sizeof room; i += PAGE_BYTES) room[i] = 0;
}

int main(int argc, char **argv) {
  take_stack();
  spore_ending_prepare();
  spore_catalogue_start();
  spore_ending_translate();
  atexit(close_output);
  if (argc < 2 || g_str_equal(argv[1], "--help") || g_str_equal(argv[1], "help") || g_str_equal(argv[1], "-h")) {
    print_help();
    return argc < 2 ? SPORE_EXIT_INPUT : SPORE_EXIT_DONE;
  }
  if (g_str_equal(argv[1], "--version")) {
    printf("spore %s\n", SPORE_VERSION);
    return SPORE_EXIT_DONE;
  }
  for (gsize i = 0; i < G_N_ELEMENTS(commands); i++)
    if (g_str_equal(argv[1], commands[i].name)) return run_command(&commands[i], NULL, argc - 1, argv + 1);
  const SporeGeneratorType *generator = generator_of(argv[1]);
  if (generator) return run_command(NULL, generator, argc - 1, argv + 1);
  return spore_cli_usage(_("spore: '%s' is no command; expected one of those that `spore --help` lists"), argv[1]);
}
