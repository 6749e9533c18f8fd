/* What spore-player tells of a run: to people, and as JSON. */
#include "app/player_report.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "core/base/text.h"

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

/* The exercise. */

/* What is no finite number is null. */
static void print_number(const char *member, double value) {
  if (isfinite(value)) printf(", \"%s\": %.17g", member, value);
  else printf(", \"%s\": null", member);
}

/* A member that is there where there is such a number. */
static void print_known(const char *member, double value) {
  if (isfinite(value)) print_number(member, value);
}

static void print_word(const char *member, const char *text) {
  printf("\"%s\": ", member);
  print_text(text);
}

static void print_step(const SporeStepState *step) {
  putchar('{');
  print_word("name", step->name);
  printf(", ");
  print_word("kind", step->kind->element);
  printf(", ");
  print_word("phase", spore_step_phase_names[step->phase]);
  print_known("done_s", step->done_s);
  printf(", \"early\": %" PRIu64 ", \"lost\": %" PRIu64, step->early, step->lost);
  if (step->hint) printf(", "), print_word("hint", step->hint);
  putchar('}');
}

static void print_metric(const SporeMetricState *metric) {
  putchar('{');
  print_word("name", metric->name);
  printf(", ");
  print_word("kind", metric->kind->element);
  print_number("value", metric->value);
  printf(", ");
  print_word("unit", metric->unit);
  print_known("good", metric->good);
  print_known("pass", metric->pass);
  print_known("mark", metric->mark);
  printf(", ");
  print_word("verdict", spore_metric_verdict_names[metric->verdict]);
  if (metric->source) printf(", "), print_word("source", metric->source);
  putchar('}');
}

static void print_exercise(const SporeExercise *exercise) {
  const SporeExerciseState state = spore_exercise_state(exercise);
  printf(", \"exercise\": {");
  print_word("phase", spore_exercise_phase_names[state.phase]);
  print_number("time_s", state.time_s);
  print_number("score", state.score);
  printf(", \"passed\": %s, \"steps\": [", state.passed ? "true" : "false");
  for (size_t i = 0; i < state.steps; i++) {
    const SporeStepState step = spore_exercise_step_state(exercise, i);
    if (i > 0) printf(", ");
    print_step(&step);
  }
  printf("], \"metrics\": [");
  for (size_t i = 0; i < state.metrics; i++) {
    const SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    if (i > 0) printf(", ");
    print_metric(&metric);
  }
  printf("]}");
}

static void say_exercise(const SporeExercise *exercise) {
  const SporeExerciseState state = spore_exercise_state(exercise);
  printf(_("exercise: %zu of %zu steps done in %.2f s, score %.1f of 100\n"), state.steps_done, state.steps,
         state.time_s, state.score);
  for (size_t i = 0; i < state.steps; i++) {
    const SporeStepState step = spore_exercise_step_state(exercise, i);
    if (step.phase == SPORE_STEP_DONE) printf(_("  step %s: done at %.2f s\n"), step.name, step.done_s);
    else printf(_("  step %s: not done\n"), step.name);
  }
  for (size_t i = 0; i < state.metrics; i++) {
    const SporeMetricState metric = spore_exercise_metric_state(exercise, i);
    printf("  %s: %.4g %s\n", metric.name, metric.value, metric.unit);
  }
}

void spore_player_say(SporeRuntime *runtime) {
  const SporeWorld *world = spore_runtime_world(runtime);
  const SporeExercise *exercise = spore_runtime_exercise(runtime);
  printf(_("%llu steps, %g s, state %016llx\n"), (unsigned long long)spore_world_step_count(world),
         spore_world_time_s(world), (unsigned long long)spore_world_hash(world));
  say_unsolved(world);
  if (exercise) say_exercise(exercise);
}

void spore_player_print(SporeRuntime *runtime, const char *file) {
  const SporeWorld *world = spore_runtime_world(runtime);
  const SporeExercise *exercise = spore_runtime_exercise(runtime);
  printf("{\"file\": ");
  print_text(file);
  printf(", \"steps\": %" PRIu64 ", \"time_s\": %.17g, ", spore_world_step_count(world), spore_world_time_s(world));
  print_unsolved(world);
  print_names(runtime);
  if (exercise) print_exercise(exercise);
  printf(", \"state_hash\": \"%016" PRIx64 "\"}\n", spore_world_hash(world));
}
