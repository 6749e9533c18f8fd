/* What it costs to measure a run while it goes on.
 *
 *   bench_monitor SCENE STEPS
 *
 * Twice: "report", iterations, contacts, energy and local error, as spore run measures them always; and "plots", local
 * error, what is not solved, and all quantities 30 times a simulated second, as the editor measures them.
 *
 * Each time pairs of runs of STEPS steps from time 0, one measured and one not, in one process and in turns; the first
 * pair warms up. Prints "report: U us, ratio R from A to B, more M us": the median step that is not measured, the
 * median of the pairs' ratios (measured by not measured), the interval that holds that median at 95 %, and the median
 * difference a step. */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "core/measure/numbers.h"
#include "core/measure/run_statistics.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define PAIRS 20
/* As in ui/sim/session.c. */
#define ROWS_A_SECOND 30
#define STEPS_A_LOOK 16
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

/* What is measured. */
typedef enum Way { NOTHING, REPORT, PLOTS } Way;

typedef struct Meter {
  SporeRunStatistics statistics; /* of the report */
  SporeLocalError error;         /* of the plots, and the rest too */
  SporeNumbers numbers;
  uint64_t stride;
} Meter;

static void start(Meter *meter, const SporeWorld *world, double dt_s, Way way) {
  bool all[SPORE_QUANTITY_COUNT];
  *meter = (Meter){.stride = (uint64_t)fmax(1, round(1 / (ROWS_A_SECOND * dt_s)))};
  if (way == REPORT) spore_run_statistics_start(&meter->statistics, world, dt_s);
  if (way != PLOTS) return;
  for (int i = 0; i < SPORE_QUANTITY_COUNT; i++) all[i] = true;
  meter->numbers.measurement = spore_measurement_create(world, all, NULL, 0, NULL);
  spore_local_error_init(&meter->error, world, dt_s);
}

static void measure(Meter *meter, const SporeWorld *world, Way way) {
  if (way == REPORT) spore_run_statistics_step(&meter->statistics, world);
  if (way != PLOTS) return;
  uint64_t step = spore_world_step_count(world);
  spore_local_error_step(&meter->error, world);
  for (size_t i = 0; step % STEPS_A_LOOK == 0 && i < spore_world_unsolved_count(world); i++)
    spore_world_unsolved(world, i);
  if (step % meter->stride == 0) spore_numbers_add(&meter->numbers);
}

static void end(Meter *meter, Way way) {
  if (way == REPORT) spore_run_statistics_clear(&meter->statistics);
  if (way != PLOTS) return;
  spore_numbers_clear(&meter->numbers);
  spore_measurement_free(meter->numbers.measurement);
  spore_local_error_clear(&meter->error);
}

static double run_us(SporeWorld *world, unsigned steps, double dt_s, Way way) {
  Meter meter;
  spore_world_reset(world);
  start(&meter, world, dt_s, way);
  double begun = now_us();
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(world);
    spore_world_tidy(world);
    measure(&meter, world, way);
  }
  double ended = now_us();
  end(&meter, way);
  return (ended - begun) / steps;
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double median(const double *sorted) { return 0.5 * (sorted[PAIRS / 2 - 1] + sorted[PAIRS / 2]); }

static void compare_runs(SporeWorld *world, unsigned steps, double dt_s, Way way) {
  double plain[PAIRS], ratio[PAIRS], more[PAIRS];
  for (int pair = -1; pair < PAIRS; pair++) {
    double took[2];
    for (int turn = 0; turn < 2; turn++) {
      gboolean measured = (turn + pair) % 2 == 0; /* which one goes first changes */
      took[measured] = run_us(world, steps, dt_s, measured ? way : NOTHING);
    }
    if (pair < 0) continue;
    plain[pair] = took[0];
    ratio[pair] = took[1] / took[0];
    more[pair] = took[1] - took[0];
  }
  qsort(plain, PAIRS, sizeof *plain, compare);
  qsort(ratio, PAIRS, sizeof *ratio, compare);
  qsort(more, PAIRS, sizeof *more, compare);
  printf("%s: %.2f us, ratio %.4f from %.4f to %.4f, more %.3f us\n", way == REPORT ? "report" : "plots", median(plain),
         median(ratio), ratio[LOW], ratio[HIGH], median(more));
}

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
  compare_runs(simulation->world, steps, dt_s, REPORT);
  compare_runs(simulation->world, steps, dt_s, PLOTS);
  spore_simulation_free(simulation);
  spore_pool_free(pool);
  spore_document_free(document);
  spore_schema_free(schema);
  return 0;
}
