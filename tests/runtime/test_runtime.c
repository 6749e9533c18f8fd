/* Runtime files: a scene that was written to one runs to the same bits, its meshes are where the scene's are, and what
 * is damaged or hostile is refused in words. So does its exercise: the same events, metrics and score. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/author/generator.h"
#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/io/scene_xml.h"
#include "core/runtime/runtime.h"
#include "core/scene/compile.h"
#include "core/scene/compile_runtime.h"
#include "models/registry.h"
#include "tests/ways.h"

#define HEAD 40 /* bytes: see core/runtime/file.c */
#define CHECKSUM_AT 32
#define STEPS 60

typedef struct Content {
  void *bytes;
  gsize size;
} Content;

/* exercise: takes the place of the scene's end; NULL: the scene as it is. */
static SporeDocument *load(SporeSchema *schema, const char *scene, const char *exercise) {
  GError *error = NULL;
  g_autofree char *file = g_strdup_printf("%s/%s.spore", SPORE_SCENES, scene), *text = NULL;
  g_file_get_contents(file, &text, NULL, &error);
  g_assert_no_error(error);
  if (exercise) strcpy(strstr(text, "</spore>"), "");
  g_autofree char *whole = g_strconcat(text, exercise, NULL);
  SporeDocument *document = spore_scene_parse(schema, file, whole, strlen(whole), &error);
  g_assert_no_error(error);
  return document;
}

static Content write_with(const char *scene, const char *exercise) {
  GError *error = NULL;
  g_autoptr(GPtrArray) undrawn = g_ptr_array_new_with_free_func(g_free);
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = load(schema, scene, exercise);
  Content content = {0};
  content.bytes = spore_document_format_runtime(document, NULL, NULL, undrawn, &content.size, &error);
  g_assert_no_error(error);
  spore_document_free(document);
  spore_schema_free(schema);
  return content;
}

static Content write_scene(const char *scene) { return write_with(scene, NULL); }

/* Of the scene itself after so many steps. */
static guint64 hash_of_scene(const char *scene, int steps) {
  GError *error = NULL;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = load(schema, scene, NULL);
  SporePool *pool = spore_pool_create(1);
  SporeSimulation *simulation = spore_simulation_new(document, pool, NULL, NULL, &error);
  g_assert_no_error(error);
  for (int i = 0; i < steps; i++) {
    spore_world_step(simulation->world);
    spore_world_tidy(simulation->world);
  }
  guint64 hash = spore_world_hash(simulation->world);
  spore_simulation_free(simulation);
  spore_pool_free(pool);
  spore_document_free(document);
  spore_schema_free(schema);
  return hash;
}

static SporeRuntime *parse(const Content *content, SporeError *error) {
  return spore_runtime_parse("F", content->bytes, content->size, spore_model_registry, NULL, NULL, error);
}

static void step(SporeWorld *world, int steps) {
  for (int i = 0; i < steps; i++) {
    spore_world_step(world);
    spore_world_tidy(world);
  }
}

static void play(SporeRuntime *runtime, int steps) {
  SporeExercise *exercise = spore_runtime_exercise(runtime);
  for (int i = 0; i < steps; i++) {
    step(spore_runtime_world(runtime), 1);
    if (exercise) spore_exercise_watch(exercise, spore_runtime_world(runtime));
  }
}

/* Vertices stand where the mesh does before the first step, and elsewhere after the last one where the body moved. */
static void check_visuals(SporeRuntime *runtime, gboolean moved) {
  SporeWorld *world = spore_runtime_world(runtime);
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  double most = 0;
  g_assert_cmpuint(spore_runtime_visual_count(runtime), >, 0);
  for (size_t i = 0; i < spore_runtime_visual_count(runtime); i++) {
    const SporeRuntimeVisual *visual = spore_runtime_visual(runtime, i);
    size_t count = visual->mesh->vertex_count;
    g_autofree double *vertices = g_new(double, 3 * count);
    g_assert_true(spore_runtime_vertices(runtime, i, snapshot, vertices, NULL));
    if (spore_world_body_role(world, visual->body) != SPORE_PASSIVE) continue;
    for (size_t k = 0; k < 3 * count; k++) {
      g_assert_true(isfinite(vertices[k]));
      most = fmax(most, fabs(vertices[k] - visual->mesh->vertices[k]));
    }
  }
  if (moved) g_assert_cmpfloat(most, >, 1e-6);
  else g_assert_cmpfloat(most, <, 1e-6);
}

/* Of models, links, tools, levels, tracks, effects and emitters each. */
static void runs_to_the_same_bits(void) {
  static const char *const scenes[] = {"minimal", "suture",       "plate8-clamp", "levels",
                                       "knot",    "plate7-steam", "cut-ovary",    "table1-fluid"};
  for (gsize i = 0; i < G_N_ELEMENTS(scenes); i++) {
    SporeError error = SPORE_ERROR_INIT;
    Content content = write_scene(scenes[i]);
    SporeRuntime *runtime = parse(&content, &error);
    if (!runtime) g_error("%s: %s", scenes[i], error.message);
    step(spore_runtime_world(runtime), STEPS);
    g_test_message("%s: %zu bytes, %u bodies", scenes[i], content.size,
                   (guint)spore_world_body_count(spore_runtime_world(runtime)));
    g_assert_cmphex(spore_world_hash(spore_runtime_world(runtime)), ==, hash_of_scene(scenes[i], STEPS));
    spore_runtime_free(runtime);
    spore_free(content.bytes);
  }
}

static void meshes_follow(void) {
  Content content = write_scene("table1-deformable");
  SporeRuntime *runtime = parse(&content, NULL);
  g_assert_nonnull(runtime);
  check_visuals(runtime, FALSE);
  step(spore_runtime_world(runtime), 10 * STEPS);
  check_visuals(runtime, TRUE);
  guint32 probe = spore_world_find_body(spore_runtime_world(runtime), "probe");
  g_assert_cmpstr(spore_world_body_name(spore_runtime_world(runtime), probe), ==, "probe");
  spore_runtime_free(runtime);
  spore_free(content.bytes);
}

static void expect_refusal(const Content *content, const char *word) {
  SporeError error = SPORE_ERROR_INIT;
  SporeRuntime *runtime = parse(content, &error);
  g_assert_null(runtime);
  g_assert_cmpstr(error.place, ==, "F");
  if (!strstr(error.message, word)) g_error("\"%s\" does not say \"%s\"", error.message, word);
}

static void seal(Content *content) {
  guint64 size = content->size - HEAD,
          checksum = spore_hash(SPORE_HASH_INIT, (char *)content->bytes + HEAD, content->size - HEAD);
  memcpy((char *)content->bytes + CHECKSUM_AT - 8, &size, sizeof size);
  memcpy((char *)content->bytes + CHECKSUM_AT, &checksum, sizeof checksum);
}

static void damage_is_told(void) {
  Content whole = write_scene("minimal");
  guint8 *bytes = whole.bytes;
  for (gsize size = 0; size < whole.size; size += size < 64 ? 1 : 911) {
    Content part = {bytes, size};
    expect_refusal(&part, size < HEAD ? "no runtime file" : "behind its head");
  }
  const struct {
    gsize at;
    const char *word;
  } flips[] = {{0, "no runtime file"}, {8, "byte order"},  {12, "version"},
               {16, "layout"},         {HEAD, "checksum"}, {whole.size - 1, "checksum"}};
  for (gsize i = 0; i < G_N_ELEMENTS(flips); i++) {
    bytes[flips[i].at] ^= 1;
    expect_refusal(&whole, flips[i].word);
    bytes[flips[i].at] ^= 1;
  }
  Content longer = {g_malloc0(whole.size + 8), whole.size + 8};
  memcpy(longer.bytes, whole.bytes, whole.size);
  seal(&longer);
  expect_refusal(&longer, "left at its end");
  g_free(longer.bytes);
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_runtime_load("/nonexistent/f.run", spore_model_registry, NULL, NULL, &error));
  g_assert_true(strstr(error.message, "cannot be read") != NULL);
  spore_free(whole.bytes);
}

/* Parts of every kind of reference: instruments, cameras, bodies, containers, fluids, other steps. */
static const char parts[] =
    "<exercise task=\"Stir it.\" order=\"given\" time_limit=\"60\">"
    "<reached name=\"near\" tool=\"right\" point=\"0.07 0.03 0.08\" radius=\"0.05\" hint=\"Go there.\"/>"
    "<bagged name=\"in\" body=\"blood\" container=\"peritoneum\" share=\"0.01\"/>"
    "<touched name=\"late\" body=\"uterus\" tool=\"right\" after=\"in\"/>"
    "<passed_through name=\"way\" body=\"blood\" point=\"0 1 0\" radius=\"1\"/>"
    "<path_length name=\"path\" tool=\"right\" good=\"1 mm\" pass=\"2 cm\" source=\"a \\ &quot;b&quot;\"/>"
    "<time_taken name=\"time\" good=\"1 s\" weight=\"2\"/><peak_force name=\"force\"/><smoothness name=\"smooth\"/>"
    "<blood_lost name=\"lost\" body=\"blood\"/><out_of_view name=\"unseen\" camera=\"laparoscope\"/>"
    "<drops name=\"drops\" body=\"blood\"/><collisions name=\"hits\"/></exercise></spore>";

static void same_number(double a, double b) { g_assert_cmpmem(&a, sizeof a, &b, sizeof b); }

static void same_exercise(const SporeExercise *a, const SporeExercise *b) {
  const SporeExerciseState one = spore_exercise_state(a), two = spore_exercise_state(b);
  g_assert_cmpuint(one.steps_done, ==, two.steps_done);
  g_assert_cmpuint(one.steps, ==, two.steps);
  g_assert_cmpuint(one.metrics, ==, two.metrics);
  g_assert_cmpint(one.phase, ==, two.phase);
  same_number(one.time_s, two.time_s);
  same_number(one.score, two.score);
  for (size_t i = 0; i < one.steps; i++) {
    const SporeStepState first = spore_exercise_step_state(a, i), second = spore_exercise_step_state(b, i);
    g_assert_cmpstr(first.name, ==, second.name);
    g_assert_cmpstr(first.hint, ==, second.hint);
    g_assert_cmpint(first.phase, ==, second.phase);
    same_number(first.done_s, second.done_s);
  }
  for (size_t i = 0; i < one.metrics; i++) {
    const SporeMetricState first = spore_exercise_metric_state(a, i), second = spore_exercise_metric_state(b, i);
    g_assert_cmpstr(first.name, ==, second.name);
    g_assert_cmpstr(first.source, ==, second.source);
    same_number(first.value, second.value);
    same_number(first.good, second.good);
    same_number(first.pass, second.pass);
    g_assert_cmpint(first.verdict, ==, second.verdict);
  }
}

static void exercise_comes_along(void) {
  GError *error = NULL;
  SporeSchema *schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  SporeDocument *document = load(schema, "plate3-blood", parts);
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  Content content = write_with("plate3-blood", parts);
  SporeRuntime *runtime = parse(&content, NULL);
  g_assert_nonnull(runtime);
  SporeExercise *exercise = spore_runtime_exercise(runtime);
  for (int i = 0; i < STEPS; i++) {
    step(simulation->world, 1);
    spore_exercise_watch(simulation->exercise, simulation->world);
  }
  play(runtime, STEPS);
  same_exercise(simulation->exercise, exercise);
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, >=, 1);
  g_assert_cmpfloat(spore_exercise_metric_state(exercise, 0).value, >, 0);
  spore_runtime_free(runtime);
  spore_free(content.bytes);
  spore_simulation_free(simulation);
  spore_document_free(document);
  spore_schema_free(schema);
  content = write_scene("plate3-blood");
  runtime = parse(&content, NULL);
  g_assert_null(spore_runtime_exercise(runtime));
  spore_runtime_free(runtime);
  spore_free(content.bytes);
}

static guint64 next_random(guint64 *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return *state >> 33;
}

/* What an enemy would write: any bytes from there on changed, and the checksum right. */
static void mutate(Content *content, gsize from, guint64 *random) {
  static const guint64 words[] = {0, 1, G_MAXUINT64, G_MAXUINT32, 0x7ff0000000000000u, 0x8000000000000000u, 1u << 20};
  guint8 *bytes = content->bytes;
  for (guint64 count = 1 + next_random(random) % 3; count > 0; count--) {
    gsize at = from + next_random(random) % (content->size - from - 8);
    if (next_random(random) % 2) bytes[at] ^= (guint8)(1u << next_random(random) % 8);
    else memcpy(bytes + at, &words[next_random(random) % G_N_ELEMENTS(words)], 8);
  }
  seal(content);
}

static void refuse_hostile(const char *scene, Content whole, gsize from) {
  Content changed = {g_malloc(whole.size), whole.size};
  guint64 random = 7;
  guint refused = 0;
  for (int round = 0; round < 300; round++) {
    SporeError error = SPORE_ERROR_INIT;
    memcpy(changed.bytes, whole.bytes, whole.size);
    mutate(&changed, from, &random);
    SporeRuntime *runtime = parse(&changed, &error);
    if (runtime) play(runtime, 2);
    else g_assert_true(*error.message && strcmp(error.place, "F") == 0);
    refused += !runtime;
    spore_runtime_free(runtime);
  }
  g_test_message("%s: %u of 300 refused", scene, refused);
  g_assert_cmpuint(refused, >, 10);
  g_assert_cmpuint(refused, <, 300);
  g_free(changed.bytes);
  spore_free(whole.bytes);
}

static void hostile_files(gconstpointer scene) { refuse_hostile(scene, write_scene(scene), HEAD); }

/* The exercise is what the file ends with. */
static void hostile_exercises(void) {
  Content without = write_scene("plate3-blood");
  refuse_hostile("an exercise", write_with("plate3-blood", parts), without.size - 64);
  spore_free(without.bytes);
}

static Content kept;

static bool load_kept(GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  SporeRuntime *runtime = parse(&kept, &fault);
  if (!runtime) return spore_error_propagate(&fault, error);
  spore_runtime_free(runtime);
  return true;
}

static void memory_runs_short(void) {
  kept = write_with("minimal", "<exercise><reached name=\"a\" body=\"ball\" hint=\"b\"/><time_taken name=\"c\"/>"
                               "</exercise></spore>");
  ways_fail_each(load_kept);
  ways_clear();
  spore_free(kept.bytes);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/runtime/same-bits", runs_to_the_same_bits);
  g_test_add_func("/runtime/meshes-follow", meshes_follow);
  g_test_add_func("/runtime/damage", damage_is_told);
  g_test_add_data_func("/runtime/hostile-minimal", "minimal", hostile_files);
  g_test_add_data_func("/runtime/hostile-suture", "suture", hostile_files);
  g_test_add_data_func("/runtime/hostile-steam", "plate7-steam", hostile_files);
  g_test_add_func("/runtime/exercise", exercise_comes_along);
  g_test_add_func("/runtime/hostile-exercises", hostile_exercises);
  g_test_add_func("/runtime/memory", memory_runs_short);
  return g_test_run();
}
