/* spore-player: runs a runtime file. Needs libc and libm alone, and no more of SPORE than libspore. */
#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "app/player_report.h"
#include "core/base/text.h"

enum { DONE = 0, NOT_SOLVED = 1, INPUT = 2, FAULT = 3, INTERRUPTED = 130 };

typedef struct Options {
  const char *file;
  uint64_t steps;
  bool json;
} Options;

static volatile sig_atomic_t interrupted;

static void interrupt(int signal) { interrupted = 1; }

static bool asked(void *data) { return interrupted != 0; }

static const SporeCancel cancel = {asked, NULL};

static int usage(const char *what, const char *word) {
  fprintf(stderr,
          _("spore-player: %s%s; expected FILE [--steps N] [--json], with a FILE that `spore export --format runtime` "
            "wrote; correct the command\n"),
          what, word);
  return INPUT;
}

static bool parse_count(const char *text, uint64_t *count) {
  char *end;
  errno = 0;
  *count = strtoull(text, &end, 10);
  return text[0] >= '0' && text[0] <= '9' && *end == '\0' && errno == 0;
}

static int parse(int argc, char **argv, Options *options) {
  for (int i = 1; i < argc; i++) {
    if (strcmp(argv[i], "--json") == 0) {
      options->json = true;
    } else if (strcmp(argv[i], "--steps") == 0) {
      if (++i == argc || !parse_count(argv[i], &options->steps))
        return usage(_("--steps needs a number of 0 or more"), "");
    } else if (argv[i][0] == '-') {
      return usage(_("unknown option "), argv[i]);
    } else if (options->file) {
      return usage(_("more than one file: "), argv[i]);
    } else {
      options->file = argv[i];
    }
  }
  return options->file ? DONE : usage(_("no file is given"), "");
}

int main(int argc, char **argv) {
  Options options = {.steps = 1000};
  SporeError error = SPORE_ERROR_INIT;
  int status = parse(argc, argv, &options);
  if (status != DONE) return status;
  signal(SIGINT, interrupt);
  signal(SIGTERM, interrupt);
  SporeRuntime *runtime = spore_runtime_load(options.file, spore_model_registry, NULL, &cancel, &error);
  if (!runtime) {
    fprintf(stderr, "%s: %s\n", error.place, error.message);
    return interrupted ? INTERRUPTED : error.code == SPORE_ERROR_INTERNAL ? FAULT : INPUT;
  }
  SporeWorld *world = spore_runtime_world(runtime);
  SporeExercise *exercise = spore_runtime_exercise(runtime);
  for (uint64_t i = 0; i < options.steps && !interrupted; i++) {
    spore_world_step(world);
    if (spore_world_cancelled(world)) break;
    spore_world_tidy(world); /* as `spore run` does: it is part of what the state follows from */
    if (exercise) spore_exercise_watch(exercise, world);
  }
  if (!interrupted && options.json) spore_player_print(runtime, options.file);
  else if (!interrupted) spore_player_say(runtime);
  status = interrupted ? INTERRUPTED : spore_world_unsolved_count(world) > 0 ? NOT_SOLVED : DONE;
  spore_runtime_free(runtime);
  if (fflush(stdout) != 0) status = INPUT;
  return status;
}
