/* What a run has come to is kept as the beginning of its scene: of each kind of body, to the bit; a file that is
 * damaged is refused, and one of another shape is stale. */
#include <math.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/author/pose_edits.h"
#include "core/base/memory.h"
#include "core/runtime/runtime.h"
#include "core/scene/check.h"
#include "core/scene/compile_runtime.h"
#include "core/scene/kept_pose.h"
#include "models/registry.h"
#include "tests/scene/fixture.h"

/* The scene with a copy of its own of what it keeps; files are those of the shipped folder. */
static SporeDocument *load(const char *name) {
  g_autofree char *file = g_strdup_printf(SPORE_SCENES "/%s.spore", name);
  g_autoptr(GError) error = NULL;
  SporeDocument *document = spore_scene_load(fixture_model_schema(), file, &error);
  g_assert_no_error(error);
  return document;
}

static SporeSimulation *simulate(SporeDocument *document) {
  g_autoptr(GError) error = NULL;
  SporeSimulation *simulation = spore_simulation_new(document, NULL, NULL, NULL, &error);
  g_assert_no_error(error);
  return simulation;
}

static const SporeDiagnostic *find_said(const GPtrArray *found, const char *part) {
  for (guint i = 0; i < found->len; i++)
    if (strstr(((const SporeDiagnostic *)found->pdata[i])->message, part)) return found->pdata[i];
  return NULL;
}

/* Whether all movable bodies are, to the bit, where they are in the other world, and stand still. */
static void assert_same(const SporeWorld *begun, const SporeWorld *kept) {
  for (guint32 b = 0; b < spore_world_body_count(kept); b++) {
    const SporeModel *model = spore_world_body_model(kept, b);
    gsize count = model ? model->q_count - 3 * model->spare_count : 7, blocks = model ? model->block_count : 2;
    if (spore_world_body_role(kept, b) == SPORE_UNMOVABLE) continue;
    g_assert_cmpmem(spore_world_q(begun, b), count * sizeof(double), spore_world_q(kept, b), count * sizeof(double));
    for (gsize i = 0; i < 3 * blocks; i++) g_assert_cmpfloat(spore_world_v(begun, b)[i], ==, 0);
  }
}

/* The runtime file of the scene begins so, too. */
static void assert_runtime(SporeDocument *document, const SporeWorld *kept) {
  g_autoptr(GPtrArray) undrawn = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GError) error = NULL;
  SporeError fault = SPORE_ERROR_INIT;
  gsize size;
  gpointer content = spore_document_format_runtime(document, NULL, NULL, undrawn, &size, &error);
  g_assert_no_error(error);
  SporeRuntime *runtime = spore_runtime_parse("F", content, size, spore_model_registry, NULL, NULL, &fault);
  g_assert_nonnull(runtime);
  assert_same(spore_runtime_world(runtime), kept);
  spore_runtime_free(runtime);
  spore_free(content);
}

static void test_kinds(void) {
  static const char *const names[] = {
      "table1-rigid", "table1-mass-spring", "cut-ovary", "table1-fluid", "table1-spline-1d", "knot", "levels"};
  for (gsize i = 0; i < G_N_ELEMENTS(names); i++) {
    SporeDocument *document = load(names[i]);
    g_autofree char *before = fixture_format(document);
    g_autoptr(GPtrArray) left_out = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GError) error = NULL;
    SporeSimulation *ran = simulate(document);
    for (int step = 0; step < 10; step++) spore_world_step(ran->world);
    g_assert_true(spore_edit_keep_pose(document, ran, NULL, left_out, &error));
    g_assert_no_error(error);
    g_assert_cmpuint(left_out->len, ==, 0);
    SporeSimulation *begun = simulate(document);
    assert_same(begun->world, ran->world);
    spore_world_step(begun->world);
    spore_world_reset(begun->world);
    assert_same(begun->world, ran->world);
    spore_simulation_free(begun);
    if (i == 0) assert_runtime(document, ran->world);
    spore_document_undo(document); /* one step of undo */
    g_autofree char *after = fixture_format(document);
    g_assert_cmpstr(after, ==, before);
    spore_simulation_free(ran);
    spore_document_free(document);
  }
}

/* A ball that has fallen. */
static SporeDocument *fallen(void) {
  SporeDocument *document = load("minimal");
  g_autoptr(GPtrArray) left_out = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GError) error = NULL;
  g_assert_false(spore_edit_keep_pose_after(document, 0, NULL, NULL, left_out, &error));
  g_assert_nonnull(strstr(error->message, "no body has moved"));
  g_clear_error(&error);
  g_assert_true(spore_edit_keep_pose_after(document, 0.05, NULL, NULL, left_out, &error));
  g_assert_no_error(error);
  return document;
}

static void set(SporeDocument *document, const char *path, const char *property, const char *text) {
  g_autoptr(GError) error = NULL;
  g_assert_true(spore_edit_set_property(document, path, property, text, &error));
  g_assert_no_error(error);
}

static SporeVec3 begins_at(SporeDocument *document) {
  SporeSimulation *simulation = simulate(document);
  SporeVec3 place = spore_vec3_load(spore_world_q(simulation->world, spore_world_find_body(simulation->world, "ball")));
  spore_simulation_free(simulation);
  return place;
}

/* A pose goes with the body's frame; it is not one of another model; and without it the body begins as before. */
static void test_belongs(void) {
  SporeDocument *document = fallen();
  SporeVec3 kept = begins_at(document);
  g_assert_cmpfloat(kept.y, <, 0.06 - 0.5 * 9 * 0.05 * 0.05);
  g_autoptr(GPtrArray) good = spore_document_check(document, NULL);
  g_assert_null(find_said(good, "kept pose"));
  set(document, "bodies/ball", "position", "0.1015 0.06 0.001");
  SporeVec3 moved = begins_at(document);
  g_assert_cmpfloat_with_epsilon(moved.x, kept.x + 0.1, 1e-12);
  g_assert_cmpfloat_with_epsilon(moved.y, kept.y, 1e-12);
  set(document, "bodies/ball/mechanical", "geometry", "floor");
  g_autoptr(GPtrArray) bad = spore_document_check(document, NULL);
  const SporeDiagnostic *stale = find_said(bad, "kept pose");
  g_assert_true(stale && stale->severity == SPORE_WARNING && strstr(stale->remedy, "keep the pose again"));
  set(document, "bodies/ball/mechanical", "geometry", "ball");
  set(document, "bodies/ball", "position", "0.0015 0.06 0.001");
  g_autoptr(GError) error = NULL;
  g_assert_true(spore_document_kept_poses(document) == 1 && spore_edit_forget_pose(document, &error));
  g_assert_cmpuint(spore_document_kept_poses(document), ==, 0);
  g_assert_cmpfloat(begins_at(document).y, ==, 0.06);
  spore_document_free(document);
}

/* A file with the first `from` of the good one replaced is refused so. */
static void refuse(SporeDocument *document, const char *good, const char *from, const char *to, const char *part) {
  g_auto(GStrv) parts = g_strsplit(good, from, 2);
  g_assert_cmpuint(g_strv_length(parts), ==, 2);
  g_autofree char *bad = g_strjoinv(to, parts);
  g_autoptr(GBytes) content = g_bytes_new(bad, strlen(bad));
  g_autoptr(GError) error = NULL;
  spore_document_put_blob(document, "bad.pose", content);
  set(document, "bodies/ball", "kept_pose", "bad.pose");
  g_assert_null(spore_simulation_new(document, NULL, NULL, NULL, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, part);
}

static void test_damaged(void) {
  SporeDocument *document = fallen();
  const SporeObject *ball = spore_document_by_path(document, "bodies/ball");
  g_autoptr(GBytes) content = spore_document_read_asset(document, spore_object_text(ball, "kept_pose"), NULL);
  g_autofree char *good = g_strndup(g_bytes_get_data(content, NULL), g_bytes_get_size(content));
  refuse(document, good, "spore-pose 1", "spore-pose 9", "line 1: expected spore-pose 1");
  refuse(document, good, "of ", "of x", "line 2: expected 16 hexadecimal digits");
  refuse(document, good, "numbers 7\n", "numbers 7\nnan\n", "line 5: expected a finite number");
  refuse(document, good, "numbers 7\n", "numbers 8\n", "expected a finite number");
  refuse(document, good, "numbers 7\n", "numbers 6\n", "expected its end");
  refuse(document, good, "numbers 7\n", "numbers 1e300\n", "as many numbers as the file has");
  spore_document_free(document);
}

static bool refuse_to_go_on(void *data, double fraction, const char *stage) {
  (*(guint *)data)++;
  return false;
}

/* Who cancels gets the scene as it was. */
static void test_cancelled(void) {
  SporeDocument *document = load("minimal");
  g_autofree char *before = fixture_format(document);
  g_autoptr(GPtrArray) left_out = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GError) error = NULL;
  SporeSimulation *ran = simulate(document);
  guint asked = 0;
  const SporeProgress progress = {refuse_to_go_on, &asked, NULL};
  for (int step = 0; step < 10; step++) spore_world_step(ran->world);
  g_assert_false(spore_edit_keep_pose(document, ran, &progress, left_out, &error));
  g_assert_error(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  g_assert_cmpuint(asked, ==, 1);
  g_autofree char *after = fixture_format(document);
  g_assert_cmpstr(after, ==, before);
  spore_simulation_free(ran);
  spore_document_free(document);
}

/* A tetrahedron that is inside out is not one to begin with, in a file or from a run. */
static void test_inverted(void) {
  FixtureScene scene = fixture_scene_new(
      "<spore version=\"1.0\"><assets><tetrahedra name=\"cells\" file=\"cube.mesh\"/></assets><bodies>"
      "<body name=\"cube\"><mechanical geometry=\"cells\"><neo_hookean_tetrahedra/></mechanical></body></bodies>"
      "</spore>\n");
  g_autoptr(GPtrArray) left_out = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GError) error = NULL;
  SporeSimulation *ran = simulate(scene.document);
  const SporeModel *model = spore_world_body_model(ran->world, 0);
  g_autofree double *q = g_memdup2(spore_world_q(ran->world, 0), model->q_count * sizeof *q);
  g_autofree double *v = g_new0(double, 3 * model->block_count);
  for (gsize i = 0; i < model->node_count; i++) q[3 * i] = -q[3 * i]; /* as in a mirror */
  spore_world_set_state(ran->world, 0, q, v);
  g_assert_false(spore_edit_keep_pose(scene.document, ran, NULL, left_out, &error));
  fixture_assert_error(error, SPORE_ERROR_INPUT, "inside out");
  spore_simulation_free(ran);
  fixture_scene_free(&scene);
}

/* What jaws hold at a kept pose is let go: said as the pose is kept, and by the check of the scene; not of open jaws.
 */
static void test_jaws(void) {
  const double open_s = 1, held_s = 1.6;
  for (int held = 0; held < 2; held++) {
    SporeDocument *document = load("plate8-clamp");
    g_autoptr(GPtrArray) left_out = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GError) error = NULL;
    g_assert_true(spore_edit_keep_pose_after(document, held ? held_s : open_s, NULL, NULL, left_out, &error));
    g_assert_no_error(error);
    g_assert_cmpuint(left_out->len, ==, held ? 1 : 0);
    if (held) g_assert_nonnull(strstr(left_out->pdata[0], "lets go of what they hold"));
    g_autoptr(GPtrArray) found = spore_document_check(document, NULL);
    g_assert_true((find_said(found, "has its jaws about \"tube_right\" as they were kept") != NULL) == held);
    spore_document_free(document);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/pose/kinds", test_kinds);
  g_test_add_func("/pose/belongs", test_belongs);
  g_test_add_func("/pose/damaged", test_damaged);
  g_test_add_func("/pose/cancelled", test_cancelled);
  g_test_add_func("/pose/inverted", test_inverted);
  g_test_add_func("/pose/jaws", test_jaws);
  return g_test_run();
}
