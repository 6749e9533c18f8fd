/* What it costs to measure a run while it goes on: iterations, contacts, energy and local error, as spore run and the
 * editor measure them.
 *
 *   bench_monitor SCENE STEPS
 *
 * Pairs of runs of STEPS steps from time 0, one measured and one not, in one process and in turns; the first pair warms
 * up. Prints "step: U us, ratio R from A to B, more M us": the median step that is not measured, the median of the
 * pairs' ratios (measured by not measured), the interval that holds that median at 95 %, and the median difference a
 * step. */
#include <glib.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "core/measure/run_statistics.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define PAIRS 20
/* Ranks, from 0, of 20 ordered values between which the median of what they are drawn from lies: by the binomial
 * distribution, in 95.9 % of cases. */
#define LOW 5
#define HIGH 14

/* CPU time of the thread: what else runs on the machine counts little. */
static double now_us(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * (double)now.tv_sec + 1e-3 * (double)now.tv_nsec;
}

static double run_us(SporeWorld *world, unsigned steps, double dt_s, gboolean measured) {
  SporeRunStatistics statistics;
  spore_world_reset(world);
  if (measured) spore_run_statistics_start(&statistics, world, dt_s);
  double start = now_us();
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    spore_world_tidy(world);
    if (measured) spore_run_statistics_step(&statistics, world);
  }
  double end = now_us();
  if (measured) spore_run_statistics_clear(&statistics);
  return (end - start) / steps;
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(const double *sorted) { return 0.5 * (sorted[PAIRS / 2 - 1] + sorted[PAIRS / 2]); }

int main(int argc, char **argv) {
  GError *error = NULL;
  if (argc != 3) return fprintf(stderr, "bench_monitor SCENE STEPS\n"), 2;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = spore_scene_load(schema, argv[1], &error);
  g_assert_no_error(error);
  SporePool *pool = spore_pool_create(1);
  SporeSimulation *simulation = spore_simulation_new(document, pool, NULL, NULL, &error);
  g_assert_no_error(error);
  unsigned steps = (unsigned)atoi(argv[2]);
  double dt_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  double plain[PAIRS], ratio[PAIRS], more[PAIRS];
  for (int pair = -1; pair < PAIRS; pair++) {
    double took[2];
    for (int turn = 0; turn < 2; turn++) {
      gboolean measured = (turn + pair) % 2 == 0; /* which one goes first changes */
      took[measured] = run_us(simulation->world, steps, dt_s, measured);
    }
    if (pair < 0) continue;
    plain[pair] = took[0];
    ratio[pair] = took[1] / took[0];
    more[pair] = took[1] - took[0];
  }
  qsort(plain, PAIRS, sizeof *plain, compare);
  qsort(ratio, PAIRS, sizeof *ratio, compare);
  qsort(more, PAIRS, sizeof *more, compare);
  printf("step: %.2f us, ratio %.4f from %.4f to %.4f, more %.3f us\n", median(plain), median(ratio), ratio[LOW],
         ratio[HIGH], median(more));
  spore_simulation_free(simulation);
  spore_pool_free(pool);
  spore_document_free(document);
  spore_schema_free(schema);
  return 0;
}
