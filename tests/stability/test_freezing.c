/* Bodies that the monitor freezes (stability case 35): in every shipped scene each body alone, and several in different
 * orders. A frozen body stands still and is named; the others go on; its terms hold between what stands still. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "tests/stability/rig.h"
#include "tests/stability/scene.h"

static unsigned warm_steps(void) { return tests_sanitized ? 2 : 25; } /* until bodies touch */
static unsigned more_steps(void) { return tests_sanitized ? 2 : 10; }

/* Gives all blocks of the body this velocity. */
static void set_speed(SporeWorld *world, uint32_t b, double speed) {
  const SporeBody *body = &world->bodies[b];
  g_autofree double *v = g_new(double, 3 * body->block_count);
  g_autofree double *q = g_memdup2(spore_world_q(world, b), body->q_count * sizeof *q);
  for (size_t k = 0; k < 3 * body->block_count; k++) v[k] = speed;
  spore_world_set_state(world, b, q, v);
}

/* The static method does not look at velocities. */
static gboolean can_break(const SporeWorld *world, uint32_t b) {
  const SporeBody *body = &world->bodies[b];
  return body->role == SPORE_PASSIVE && !spore_body_is_static(body) && body->held.count < body->block_count;
}

static gboolean said_frozen(const SporeWorld *world, uint32_t b) {
  g_autofree char *start = g_strdup_printf("%s: frozen", spore_world_body_name(world, b));
  return rig_said(world, start);
}

static void assert_finite(const SporeWorld *world) {
  g_assert_true(isfinite(rig_energy(world)));
  g_assert_true(rig_finite(world));
  for (size_t k = 0; k < 6 * world->body_count; k++) g_assert_true(isfinite(world->state.reaction[k]));
  for (size_t i = 0; i < world->links.count; i++) g_assert_true(isfinite(spore_world_link_state(world, i).load));
}

/* No term that only still things hold is left with an island. */
static void assert_islands_move(const SporeWorld *world) {
  for (size_t i = 0; i < world->solve.island_count; i++) {
    const SporeIsland *island = &world->solve.islands[i];
    for (size_t k = 0; k < island->contact_count; k++) {
      const SporeContactTerm *term = &world->contact.terms[world->contact.order[island->contact_start + k]];
      g_assert_false(term->a.prescribed && term->b.prescribed);
    }
    for (size_t k = 0; k < island->spring_count; k++) {
      const SporeSpringTerm *term = &world->links.springs[world->links.order[island->spring_start + k]];
      g_assert_false(term->a.prescribed && term->b.prescribed);
    }
  }
}

/* Breaks the bodies in this order, `at_once` or one a step, and steps on. */
static void break_bodies(SporeWorld *world, const uint32_t *order, unsigned count, gboolean at_once, double speed) {
  uint64_t hidden = 0; /* bit b: body b was broken */
  g_assert_cmpuint(world->body_count, <=, 64);
  for (unsigned i = 0; i < count; i++) {
    if (!world->bodies[order[i]].frozen) set_speed(world, order[i], speed);
    hidden |= (uint64_t)1 << order[i];
    if (at_once && i + 1 < count) continue;
    spore_world_step(world);
    assert_islands_move(world);
    assert_finite(world);
  }
  for (unsigned i = 0; i < count; i++) {
    const SporeBody *body = &world->bodies[order[i]];
    const double *v = spore_world_v(world, order[i]);
    if (!body->frozen && isfinite(speed)) continue; /* what it hit, or its damping, has slowed it down */
    g_assert_true(body->frozen && said_frozen(world, order[i]));
    for (size_t k = 0; k < 3 * body->block_count; k++) g_assert_cmpfloat(v[k], ==, 0);
  }
  for (unsigned i = 0; i < more_steps(); i++) {
    spore_world_step(world);
    assert_islands_move(world);
    assert_finite(world);
  }
  for (uint32_t b = 0; isnan(speed) && b < world->body_count; b++)
    g_assert_true(!world->bodies[b].frozen || (hidden >> b & 1));
}

/* A reset begins anew, as if nothing had been frozen. */
static void start_again(SporeWorld *world, uint64_t *warm) {
  spore_world_reset(world);
  g_assert_false(rig_any_frozen(world));
  for (unsigned i = 0; i < warm_steps(); i++) spore_world_step(world);
  if (*warm) g_assert_cmphex(spore_world_hash(world), ==, *warm);
  *warm = spore_world_hash(world);
}

/* A frozen body that is well again moves again. */
static void thaw(SporeWorld *world, uint32_t body) {
  g_assert_true(spore_world_post(world, &(SporeCommand){.kind = SPORE_COMMAND_THAW, .body = body}));
  for (unsigned i = 0; i < more_steps(); i++) spore_world_step(world);
  g_assert_false(world->bodies[body].frozen);
  assert_finite(world);
}

static unsigned breakable(const SporeWorld *world, uint32_t *bodies) {
  unsigned count = 0;
  for (uint32_t b = 0; b < world->body_count; b++)
    if (can_break(world, b)) bodies[count++] = b;
  return count;
}

static void test_each(gconstpointer data) {
  Scene scene = scene_open(data, NULL, NULL, NULL);
  SporeWorld *world = scene.world;
  uint64_t warm = 0;
  uint32_t bodies[64];
  start_again(world, &warm);
  unsigned count = breakable(world, bodies);
  for (unsigned i = 0; i < count; i++) {
    if (i > 0) start_again(world, &warm);
    break_bodies(world, &bodies[i], 1, FALSE, NAN);
    thaw(world, bodies[i]);
    if (tests_sanitized && i > 0) continue; /* what is thrown out so fast takes long to recover */
    start_again(world, &warm);
    break_bodies(world, &bodies[i], 1, FALSE, 2 * world->solver.maximum_speed);
  }
  g_test_message("%u bodies frozen in turn", count);
  scene_close(&scene);
}

static void test_orders(gconstpointer data) {
  Scene scene = scene_open(data, NULL, NULL, NULL);
  SporeWorld *world = scene.world;
  uint64_t warm = 0;
  uint32_t forward[64], backward[64], inward[64];
  start_again(world, &warm);
  unsigned count = breakable(world, forward);
  for (unsigned i = 0; i < count; i++) {
    backward[i] = forward[count - 1 - i];
    inward[i] = i % 2 ? forward[count - 1 - i / 2] : forward[i / 2];
  }
  const uint32_t *orders[] = {forward, backward, inward};
  for (unsigned k = 0; count > 1 && k < G_N_ELEMENTS(orders); k++) {
    for (int at_once = 0; at_once <= 1; at_once++) {
      break_bodies(world, orders[k], count, at_once, NAN);
      start_again(world, &warm);
    }
    break_bodies(world, orders[k], count - 1, TRUE, NAN);
    start_again(world, &warm);
  }
  scene_close(&scene);
}

/* Whether a tool holds, pierces or has cut something. */
static gboolean any_used(const SporeWorld *world) {
  for (size_t i = 0; i < spore_world_tool_count(world); i++) {
    SporeToolState state = spore_world_tool_state(world, i);
    if (state.held + state.stitches + state.cut > 0) return TRUE;
  }
  return FALSE;
}

/* Bodies that a tool is at work on: the tool goes on, the body is cut, let go and drawn at while it stands still, and
 * moves again afterwards. */
static void test_tool(gconstpointer data) {
  Scene scene = scene_open(data, NULL, NULL, NULL);
  SporeWorld *world = scene.world;
  unsigned step = 0;
  uint32_t bodies[64];
  for (; step < 2000 && !any_used(world); step++) spore_world_step(world);
  g_assert_true(any_used(world));
  unsigned count = breakable(world, bodies);
  for (unsigned i = 0; i < count; i++) {
    break_bodies(world, &bodies[i], 1, FALSE, NAN);
    for (unsigned k = 0; k < rig_steps(200, 20); k++) spore_world_step(world);
    assert_finite(world);
    thaw(world, bodies[i]);
  }
  break_bodies(world, bodies, count, TRUE, NAN);
  for (unsigned k = 0; k < rig_steps(200, 20); k++) spore_world_step(world);
  assert_finite(world);
  g_test_message("used from step %u", step);
  scene_close(&scene);
}

/* A frozen body keeps its level of detail. */
static void test_lod(void) {
  Scene scene = scene_open(SPORE_SCENES "/levels.spore", NULL, NULL, NULL);
  uint32_t body = spore_world_find_body(scene.world, "ovary_right");
  spore_world_step(scene.world);
  break_bodies(scene.world, &body, 1, FALSE, NAN);
  SporeLodGrade before = scene.world->bodies[body].grade;
  for (int level = 0; level < SPORE_LOD_COUNT; level++) {
    g_assert_true(spore_world_post(
        scene.world, &(SporeCommand){.kind = SPORE_COMMAND_LOD, .body = body, .level = (SporeLodGrade)level}));
    spore_world_step(scene.world);
    g_assert_cmpint(scene.world->bodies[body].grade, ==, before);
  }
  thaw(scene.world, body);
  scene_close(&scene);
}

static SporeModel *box(void) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(0.03, 0.02, 0.01));
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", 0.05, NULL);
}

/* Three boxes: each linked to the next, the first and the last to the scene. */
static Rig *linked_boxes(const SporeLinkType *kind) {
  static const char *const names[] = {"a", "b", "c"};
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, 0, -9.81);
  for (uint32_t b = 0; b < 3; b++) rig_passive(rig, names[b], box(), NULL)->pose.position.x = 0.05 * b;
  uint32_t ends[4][2] = {{0, SPORE_NO_BODY}, {0, 1}, {1, 2}, {2, SPORE_NO_BODY}};
  for (int i = 0; i < 4; i++) {
    SporeLinkDescription *link =
        rig_link(rig, "link", kind, ends[i][0], ends[i][1], spore_vec3(0.05 * i - 0.025, 0, 0));
    link->length = 0.01;
    link->friction = kind->line == SPORE_LINE_NONE ? 0 : 0.2;
  }
  rig_build(rig);
  return rig;
}

/* Every kind of link in every order, one after the other and at once. */
static void test_links(void) {
  static const uint32_t orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  for (size_t k = 0; spore_link_types[k]; k++) {
    if (spore_link_types[k]->term_count == 0) continue;
    for (int order = 0; order < 6; order++)
      for (unsigned count = 1; count <= 3; count++)
        for (int at_once = 0; at_once <= 1; at_once++) {
          Rig *rig = linked_boxes(spore_link_types[k]);
          rig_run(rig->world, 3);
          break_bodies(rig->world, orders[order], count, at_once, NAN);
          thaw(rig->world, orders[order][0]);
          rig_free(rig);
        }
  }
}

/* A sleeping ball lies on one that is frozen; setting the frozen one's state lets it move again. */
static void test_sleeping(void) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig_unmovable(rig, "floor", rig_floor(rig, 5, 5, 0.01, 0.01));
  for (int b = 0; b < 2; b++)
    rig_passive(rig, b ? "upper" : "lower", box(), rig_sphere(rig, 0.02))->pose.position.y = 0.02 + 0.0399 * b;
  SporeWorld *world = rig_build(rig);
  uint32_t lower = spore_world_find_body(world, "lower"), upper = spore_world_find_body(world, "upper");
  break_bodies(world, &lower, 1, FALSE, NAN);
  for (int i = 0; i < 5000 && !spore_world_body_asleep(world, upper); i++) spore_world_step(world);
  g_assert_true(spore_world_body_asleep(world, upper) && world->bodies[lower].frozen);
  rig_run(world, 10);
  assert_finite(world);
  set_speed(world, lower, 0);
  g_assert_false(world->bodies[lower].frozen);
  rig_run(world, 10);
  assert_finite(world);
  rig_free(rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_autoptr(GDir) folder = g_dir_open(SPORE_SCENES, 0, NULL);
  g_assert_nonnull(folder);
  for (const char *name; (name = g_dir_read_name(folder));) {
    if (!g_str_has_suffix(name, ".spore")) continue;
    g_autofree char *each = g_strconcat("/freezing/each/", name, NULL);
    g_autofree char *orders = g_strconcat("/freezing/orders/", name, NULL);
    g_test_add_data_func_full(each, g_build_filename(SPORE_SCENES, name, NULL), test_each, g_free);
    g_test_add_data_func_full(orders, g_build_filename(SPORE_SCENES, name, NULL), test_orders, g_free);
  }
  static const char *const tools[] = {"plate8-clamp", "suture", "cut-ovary"};
  for (size_t i = 0; i < G_N_ELEMENTS(tools); i++) {
    g_autofree char *path = g_strconcat("/freezing/tool/", tools[i], NULL);
    g_test_add_data_func_full(path, g_strconcat(SPORE_SCENES "/", tools[i], ".spore", NULL), test_tool, g_free);
  }
  g_test_add_func("/freezing/lod", test_lod);
  g_test_add_func("/freezing/links", test_links);
  g_test_add_func("/freezing/sleeping", test_sleeping);
  return g_test_run();
}
