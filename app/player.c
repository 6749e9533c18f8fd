/* spore-player: runs a runtime file. Needs libc and libm alone, and no more of SPORE than libspore. */
#include <errno.h>
#include <inttypes.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/base/text.h"
#include "models/spore.h"

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

/* A text between quotation marks, as JSON has it. */
static void print_text(const char *text) {
  putchar('"');
  for (; *text; text++) {
    if (*text == '"' || *text == '\\') printf("\\%c", *text);
    else if ((unsigned char)*text < 0x20) printf("\\u%04x", (unsigned)*text);
    else putchar(*text);
  }
  putchar('"');
}

static void print_names(SporeRuntime *runtime) {
  const SporeWorld *world = spore_runtime_world(runtime);
  printf("\"bodies\": [");
  for (uint32_t i = 0; i < spore_world_body_count(world); i++) {
    if (i > 0) printf(", ");
    print_text(spore_world_body_name(world, i));
  }
  printf("], \"tools\": [");
  for (size_t i = 0; i < spore_world_tool_count(world); i++) {
    if (i > 0) printf(", ");
    print_text(spore_world_tool_state(world, i).name);
  }
  printf("], \"visuals\": [");
  for (size_t i = 0; i < spore_runtime_visual_count(runtime); i++) {
    const SporeRuntimeVisual *visual = spore_runtime_visual(runtime, i);
    printf("%s{\"body\": ", i > 0 ? ", " : "");
    print_text(spore_world_body_name(world, visual->body));
    printf(", \"vertices\": %zu, \"triangles\": %zu}", visual->mesh->vertex_count, visual->mesh->triangle_count);
  }
  printf("]");
}

static void say_unsolved(const SporeWorld *world) {
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++) {
    const SporeUnsolved unsolved = spore_world_unsolved(world, i);
    printf(_("%s: %llu steps not solved as written: %s; %s\n"), spore_world_body_name(world, unsolved.body),
           (unsigned long long)unsolved.steps, unsolved.cause, unsolved.remedy);
  }
}

static void print_unsolved(const SporeWorld *world) {
  printf("\"unsolved\": [");
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++) {
    const SporeUnsolved unsolved = spore_world_unsolved(world, i);
    printf("%s{\"body\": ", i > 0 ? ", " : "");
    print_text(spore_world_body_name(world, unsolved.body));
    printf(", \"steps\": %llu, \"cause\": ", (unsigned long long)unsolved.steps);
    print_text(unsolved.cause);
    printf("}");
  }
  printf("], ");
}

static void report(SporeRuntime *runtime, const Options *options) {
  const SporeWorld *world = spore_runtime_world(runtime);
  const uint64_t steps = spore_world_step_count(world), hash = spore_world_hash(world);
  if (!options->json) {
    printf(_("%llu steps, %g s, state %016llx\n"), (unsigned long long)steps, spore_world_time_s(world),
           (unsigned long long)hash);
    say_unsolved(world);
    return;
  }
  printf("{\"file\": ");
  print_text(options->file);
  printf(", \"steps\": %" PRIu64 ", \"time_s\": %.17g, ", steps, spore_world_time_s(world));
  print_unsolved(world);
  print_names(runtime);
  printf(", \"state_hash\": \"%016" PRIx64 "\"}\n", hash);
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
  for (uint64_t i = 0; i < options.steps && !interrupted; i++) {
    spore_world_step(world);
    if (spore_world_cancelled(world)) break;
    spore_world_tidy(world); /* as `spore run` does: it is part of what the state follows from */
  }
  if (!interrupted) report(runtime, &options);
  status = interrupted ? INTERRUPTED : spore_world_unsolved_count(world) > 0 ? NOT_SOLVED : DONE;
  spore_runtime_free(runtime);
  if (fflush(stdout) != 0) status = INPUT;
  return status;
}
