/* How far a scene at its own step strays from the same scene computed finely.
 *
 *   bench_scene_error SCENE TIME FINER [STEP]     STEP: s, instead of the scene's own
 *
 * Where the spheres of what physics moves are is looked at every 20 ms or so of the recorded input, in four runs: the
 * scene as it is; the same with its bodies shifted by 1e-8 of their size; and two references, FINER and FINER / 2 times
 * as fine, by methods of second order (TR-BDF2, for what is explicit Verlet) solved to 1e-7. The difference of those
 * two, over 3, is the reference's own error (Richardson). Errors are roots of the mean square over a body's spheres, in
 * parts of its size at rest; the worst body is told. Where the shift grows beyond 1e-3, positions are no property of
 * the scene (a fluid): there it is the middle of the body's spheres that is compared, the median of each coordinate,
 * and the shift of that is below what can be resolved.
 */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "core/scene/compile.h"
#include "models/registry.h"

#define LOOK_S 0.02
#define SHIFT 1e-8
#define GROWN 1e-3
#define REFERENCE_TOLERANCE "1e-7"

typedef struct Runs {
  const char *scene;
  SporeSchema *schema;
  double step_s; /* of the scene */
  size_t looks, steps_a_look;
} Runs;

/* What a run saw. */
typedef struct Trace {
  size_t count, body_count; /* spheres; bodies that physics moves and that have any */
  size_t *start;            /* body_count + 1 */
  guint32 *body;            /* in the world */
  GPtrArray *names;
  double *extent;  /* m, of each body */
  double *centres; /* looks x count x 3 */
} Trace;

static void trace_clear(Trace *trace) {
  g_free(trace->start);
  g_free(trace->body);
  g_free(trace->extent);
  g_free(trace->centres);
  g_ptr_array_unref(trace->names);
}

static void set(SporeDocument *document, SporeObject *object, const char *property, const char *text) {
  GError *error = NULL;
  spore_document_set_text(document, object, property, text, &error);
  g_assert_no_error(error);
}

static void set_step(SporeDocument *document, double step_s) {
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  set(document, spore_document_section(document, "solver"), "time_step", g_ascii_dtostr(text, sizeof text, step_s));
}

/* The world tells which bodies are explicit: they keep their substeps. */
static void refine(SporeDocument *document, const SporeWorld *world) {
  SporeObject *solver = spore_document_section(document, "solver");
  set(document, solver, "integrator", "tr_bdf2");
  set(document, solver, "tolerance", REFERENCE_TOLERANCE);
  set(document, solver, "sleep_speed", "0");
  for (guint32 b = 0; b < spore_world_body_count(world); b++) {
    SporeMethod method;
    if (!spore_world_body_method(world, b, &method)) continue;
    bool implicit = method.nonlinear.name != NULL;
    g_autofree char *path = g_strdup_printf("bodies/%s/mechanical", spore_world_body_name(world, b));
    SporeObject *mechanical = spore_document_by_path(document, path);
    set(document, mechanical, "integrator", implicit ? "tr_bdf2" : "verlet");
    if (implicit) set(document, mechanical, "substeps", "1");
  }
}

static SporeSimulation *compile(SporeDocument *document, SporePool *pool) {
  GError *error = NULL;
  SporeSimulation *simulation = spore_simulation_new(document, pool, NULL, NULL, &error);
  if (error) g_printerr("%s\n", error->message);
  g_assert_no_error(error);
  return simulation;
}

/* Each sphere's number in the trace, or SIZE_MAX. */
static void choose_spheres(const SporeWorld *world, Trace *trace, size_t *place) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  trace->names = g_ptr_array_new_with_free_func(g_free);
  trace->start = g_new0(size_t, spore_world_body_count(world) + 1);
  trace->body = g_new0(guint32, spore_world_body_count(world));
  guint32 last = SPORE_NO_BODY;
  for (size_t i = 0; i < spheres->count; i++) {
    guint32 body = spheres->body[i];
    place[i] = SIZE_MAX;
    if (spore_world_body_role(world, body) != SPORE_PASSIVE) continue;
    if (body != last) {
      trace->body[trace->body_count] = body;
      trace->start[trace->body_count++] = trace->count;
      g_ptr_array_add(trace->names, g_strdup(spore_world_body_name(world, body)));
      last = body;
    }
    place[i] = trace->count++;
  }
  trace->start[trace->body_count] = trace->count;
}

/* Diagonals of the boxes around the spheres where they are now. */
static void measure_extents(const SporeSpheres *spheres, const size_t *place, Trace *trace) {
  trace->extent = g_new0(double, trace->body_count);
  for (size_t b = 0; b < trace->body_count; b++) {
    double square = 0;
    for (size_t e = 0; e < 3; e++) {
      double lower = HUGE_VAL, upper = -HUGE_VAL;
      for (size_t i = 0; i < spheres->count; i++) {
        if (place[i] == SIZE_MAX || spheres->body[i] != trace->body[b]) continue;
        lower = fmin(lower, spheres->centre[3 * i + e] - spheres->radius[i]);
        upper = fmax(upper, spheres->centre[3 * i + e] + spheres->radius[i]);
      }
      square += (upper - lower) * (upper - lower);
    }
    trace->extent[b] = sqrt(square);
  }
}

/* Along x, every second node of a body by half as much as the others. */
static void shift(SporeWorld *world, const Trace *trace) {
  for (size_t b = 0; b < trace->body_count; b++) {
    const SporeModel *model = spore_world_body_model(world, trace->body[b]);
    g_autofree double *q = g_memdup2(spore_world_q(world, trace->body[b]), model->q_count * sizeof(double));
    g_autofree double *v = g_memdup2(spore_world_v(world, trace->body[b]), 3 * model->block_count * sizeof(double));
    size_t nodes = spore_model_is_nodal(model) ? model->q_count / 3 : 1;
    for (size_t i = 0; i < nodes; i++) q[3 * i] += SHIFT * trace->extent[b] / (double)(1 + i % 2);
    spore_world_set_state(world, trace->body[b], q, v);
  }
}

/* finer: 0 for the scene as it is. */
static Trace run(const Runs *runs, size_t finer, bool shifted) {
  GError *error = NULL;
  SporeDocument *document = spore_scene_load(runs->schema, runs->scene, &error);
  g_assert_no_error(error);
  SporePool *pool = spore_pool_create(1);
  set_step(document, runs->step_s);
  SporeSimulation *simulation = compile(document, pool);
  if (finer) {
    refine(document, simulation->world);
    set_step(document, runs->step_s / (double)finer);
    spore_simulation_free(simulation);
    simulation = compile(document, pool);
  }
  SporeWorld *world = simulation->world;
  const SporeSpheres *spheres = spore_world_spheres(world);
  g_autofree size_t *place = g_new(size_t, spheres->count);
  Trace trace = {0};
  choose_spheres(world, &trace, place);
  measure_extents(spheres, place, &trace);
  if (shifted) shift(world, &trace);
  trace.centres = g_new(double, 3 * trace.count * (runs->looks + 1));
  for (size_t look = 0; look <= runs->looks; look++) {
    /* Spheres are where the step found them: those of a look are known a step later. */
    spore_world_step(world);
    for (size_t i = 0; i < spheres->count; i++)
      if (place[i] != SIZE_MAX)
        memcpy(trace.centres + 3 * (look * trace.count + place[i]), spheres->centre + 3 * i, 3 * sizeof(double));
    for (size_t n = 1; n < runs->steps_a_look * MAX(finer, 1); n++) spore_world_step(world);
  }
  const SporeMonitor *monitor = spore_world_monitor(world);
  if (monitor->message_count) g_printerr("%zu times finer: %s\n", finer, monitor->messages[0].text);
  spore_simulation_free(simulation);
  spore_pool_free(pool);
  spore_document_free(document);
  return trace;
}

static int compare(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Of a coordinate of a body's spheres at a look: a few drops that leave the rest for good do not move it. */
static double median(const Trace *trace, size_t body, size_t look, size_t coordinate) {
  size_t first = trace->start[body], count = trace->start[body + 1] - first;
  g_autofree double *values = g_new(double, count);
  for (size_t i = 0; i < count; i++) values[i] = trace->centres[3 * (look * trace->count + first + i) + coordinate];
  qsort(values, count, sizeof *values, compare);
  return values[count / 2];
}

/* Of a body at a look, in parts of its size; of its spheres, or of their middle. */
static double distance(const Trace *a, const Trace *b, size_t body, size_t look, bool middle) {
  size_t first = a->start[body], end = a->start[body + 1];
  double square = 0;
  for (size_t k = 0; middle && k < 3; k++) square += pow(median(a, body, look, k) - median(b, body, look, k), 2);
  if (middle) return sqrt(square) / a->extent[body];
  for (size_t k = 3 * first; k < 3 * end; k++)
    square += pow(a->centres[3 * look * a->count + k] - b->centres[3 * look * a->count + k], 2);
  return sqrt(square / (double)(end - first)) / a->extent[body];
}

static double largest(const Runs *runs, const Trace *a, const Trace *b, size_t body, bool middle) {
  double most = 0;
  for (size_t look = 0; look <= runs->looks; look++) most = fmax(most, distance(a, b, body, look, middle));
  return most;
}

int main(int argc, char **argv) {
  if (argc < 4) {
    g_printerr("usage: bench_scene_error SCENE TIME FINER [STEP]\n");
    return 2;
  }
  Runs runs = {.scene = argv[1], .schema = spore_schema_new(spore_model_registry, spore_generator_elements())};
  GError *error = NULL;
  SporeDocument *document = spore_scene_load(runs.schema, runs.scene, &error);
  g_assert_no_error(error);
  runs.step_s = argc > 4 ? g_ascii_strtod(argv[4], NULL)
                         : spore_object_number(spore_document_section(document, "solver"), "time_step");
  spore_document_free(document);
  size_t finer = (size_t)g_ascii_strtoull(argv[3], NULL, 10);
  runs.steps_a_look = (size_t)MAX(1, round(LOOK_S / runs.step_s));
  runs.looks = (size_t)round(g_ascii_strtod(argv[2], NULL) / (runs.step_s * (double)runs.steps_a_look));
  Trace own = run(&runs, 0, false), shifted = run(&runs, 0, true);
  Trace rough = run(&runs, finer / 2, false), fine = run(&runs, finer, false);
  printf("[");
  for (size_t b = 0; b < own.body_count; b++) {
    double growth = largest(&runs, &own, &shifted, b, false);
    bool middle = growth > GROWN;
    printf("%s\n {\"body\": \"%s\", \"compared\": \"%s\", \"final\": %.3g, \"max\": %.3g, \"reference\": %.3g, "
           "\"growth\": %.3g, \"unresolved\": %.3g}",
           b ? "," : "", (const char *)own.names->pdata[b], middle ? "middle" : "spheres",
           distance(&own, &fine, b, runs.looks, middle), largest(&runs, &own, &fine, b, middle),
           largest(&runs, &rough, &fine, b, middle) / 3, growth, largest(&runs, &own, &shifted, b, middle));
  }
  printf("\n]\n");
  Trace *all[] = {&own, &shifted, &rough, &fine};
  for (size_t i = 0; i < G_N_ELEMENTS(all); i++) trace_clear(all[i]);
  spore_schema_free(runs.schema);
  return 0;
}
