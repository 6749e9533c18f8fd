/* bench_scale SCENE STEPS SECONDS: what the first steps of a scene take, as one JSON object.
 *
 * Time is on the processor. The steps are run again, as long as all runs together take less than SECONDS, and of each
 * step the least of all runs counts: all runs do the same work. Memory is the most that the program ever held. */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define RUNS 20 /* at most */

typedef struct Cost {
  double made_s;
  double *step_s;
  unsigned steps, runs;
  double newton, linear, contacts; /* a step */
  size_t dof;
  char *unsolved; /* why a step was not solved as the scene is written; NULL: every one was */
} Cost;

static double cpu_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Of the memory that the program itself mapped, bytes. */
static double peak_bytes(void) {
  g_autofree char *text = NULL;
  g_assert_true(g_file_get_contents("/proc/self/status", &text, NULL, NULL));
  const char *row = strstr(text, "VmHWM:");
  return row ? 1024 * g_ascii_strtod(row + strlen("VmHWM:"), NULL) : NAN;
}

static void take_counts(Cost *cost, const SporeWorld *world) {
  SporeStepCounts counts = spore_world_counts(world);
  cost->newton += (double)counts.newton_iterations / cost->steps;
  cost->linear += (double)counts.linear_iterations / cost->steps;
  cost->contacts += (double)counts.contacts / cost->steps;
}

static void run(Cost *cost, SporeWorld *world) {
  spore_world_reset(world);
  for (unsigned i = 0; i < cost->steps; i++) {
    double began_s = cpu_s();
    spore_world_step(world);
    cost->step_s[i] = fmin(cost->step_s[i], cpu_s() - began_s);
    spore_world_tidy(world);
    if (cost->runs == 0) take_counts(cost, world);
  }
  cost->runs++;
}

static void measure(Cost *cost, const char *file, double most_s) {
  GError *error = NULL;
  double began_s = cpu_s();
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, file, &error);
  SporeSimulation *simulation = document ? spore_simulation_new(document, NULL, NULL, NULL, &error) : NULL;
  if (!simulation) {
    fprintf(stderr, "%s: %s\n", file, error->message);
    exit(1);
  }
  SporeWorld *world = simulation->world;
  cost->made_s = cpu_s() - began_s;
  for (began_s = cpu_s(); cost->runs < 2 || (cost->runs < RUNS && cpu_s() - began_s < most_s);) {
    run(cost, world);
    if (cost->runs == 1 && cpu_s() - began_s > most_s) break;
  }
  cost->dof = spore_world_dof(world);
  if (spore_world_unsolved_count(world) > 0) cost->unsolved = g_strdup(spore_world_unsolved(world, 0).cause);
  spore_simulation_free(simulation);
  spore_document_free(document);
  spore_schema_free(schema);
}

int main(int argc, char **argv) {
  Cost cost = {.steps = argc == 4 ? (unsigned)strtoul(argv[2], NULL, 10) : 0};
  if (cost.steps == 0) return fprintf(stderr, "usage: bench_scale SCENE STEPS SECONDS\n"), 2;
  cost.step_s = g_new(double, cost.steps);
  for (unsigned i = 0; i < cost.steps; i++) cost.step_s[i] = HUGE_VAL;
  measure(&cost, argv[1], g_ascii_strtod(argv[3], NULL));
  double sum_s = 0;
  for (unsigned i = 0; i < cost.steps; i++) sum_s += cost.step_s[i];
  printf("{\"dof\": %zu, \"made_s\": %.6g, \"step_s\": %.6g, \"runs\": %u, \"newton\": %.4g, \"linear\": %.4g, "
         "\"contacts\": "
         "%.4g, \"bytes\": %.9g, \"unsolved\": \"%s\"}\n",
         cost.dof, cost.made_s, sum_s / cost.steps, cost.runs, cost.newton, cost.linear, cost.contacts, peak_bytes(),
         cost.unsolved ? cost.unsolved : "");
  g_free(cost.unsolved);
  g_free(cost.step_s);
  return 0;
}
