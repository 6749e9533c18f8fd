/* Snapshots: whoever reads them, whenever, sees states that the world was in, whole and the newest. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "tests/sim/chain_model.h"

/* Chains that swing, come to rest one after the other and are woken again, and a body that a device might move. Two
 * chains that do not lie next to each other are tied together. */
enum { CHAINS = 16, LINKS = 8, HAND = CHAINS, BODIES, PUSHED = 3, PULLED = 5, POISONED = 8, PUBLICATIONS = 640 };

static SporeWorld *swings(SporePool *pool) {
  SporeBodyDescription bodies[BODIES];
  char names[CHAINS][8];
  for (int i = 0; i < CHAINS; i++) {
    g_snprintf(names[i], sizeof names[i], "c%d", i);
    SporeModel *model = chain_create((ChainFields){.count = LINKS,
                                                   .mass = 0.1,
                                                   .spacing = 0.25,
                                                   .stiffness = 300,
                                                   .damping = 2 + 0.25 * i,
                                                   .anchor = 200,
                                                   .poison_at = i == POISONED ? 8.2 : HUGE_VAL});
    bodies[i] = passive_body(names[i], model, (SporeVec3){0, i, 0});
    bodies[i].velocity = (SporeVec3){0, 0.02 * (i + 1), 0.1};
  }
  bodies[HAND] = (SporeBodyDescription){.name = "hand", .role = SPORE_ACTIVE, .pose = spore_pose_identity()};
  bodies[HAND].contact = bodies[0].contact;
  SporeLinkDescription link = {.name = "link",
                               .type = &spore_link_spring,
                               .body_a = 1,
                               .body_b = 4,
                               .point_a = {0.5, 1, 0},
                               .point_b = {0.5, 4, 0},
                               .stiffness = 20,
                               .damping = 0.1,
                               .rest_length = -1};
  SporeWorldDescription description = world_description(bodies, BODIES);
  description.gravity = (SporeVec3){0, -9.81, 0};
  description.links = &link;
  description.link_count = 1;
  description.solver.integrator = SPORE_INTEGRATOR_IMPLICIT_EULER;
  description.solver.time_step = 5e-3;
  description.solver.sleep_speed = 1e-3;
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, pool, &error);
  if (!world) g_error("%s: %s", error.place, error.message);
  return world;
}

static guint count_asleep(const SporeWorld *world) {
  guint asleep = 0;
  for (guint b = 0; b < CHAINS; b++) asleep += spore_world_body_asleep(world, b);
  return asleep;
}

static void pull(SporeWorld *world, guint body, double height) {
  SporeCommand command = {
      .kind = SPORE_COMMAND_PULL, .body = body, .point = {0, body, 0}, .vector = {0, body + height, 0}, .number = 300};
  g_assert_true(spore_world_post(world, &command));
}

/* A state as set from outside: at rest, but for the chain's first particle. */
static void set_chain(SporeWorld *world, guint body, double raised, double velocity) {
  double q[3 * LINKS], v[3 * LINKS] = {0};
  memcpy(q, spore_world_q(world, body), sizeof q);
  q[1] += raised;
  v[2] = velocity;
  spore_world_set_state(world, body, q, v);
}

static void set_hand(SporeWorld *world) {
  spore_world_set_state(world, HAND, (double[7]){1, 2, 3, 1, 0, 0, 0}, (double[6]){0});
}

static void post(SporeWorld *world, guint publication) {
  SporeCommand release = {.kind = SPORE_COMMAND_RELEASE, .body = PULLED};
  if (publication == 160 || publication == 520) pull(world, PULLED, 0.2);
  if (publication == 180 || publication == 530) g_assert_true(spore_world_post(world, &release));
  if (publication == 200) pull(world, POISONED, 1);
}

/* A round of the world's life: each act publishes a state. */
static void act(SporeWorld *world, guint publication) {
  post(world, publication);
  switch (publication) {
  case 0:
    spore_world_reset(world);
    break;
  case 230: /* its forces are no numbers there */
    set_chain(world, POISONED, 0.5, 0.3);
    break;
  case 250:
    set_hand(world);
    break;
  case 580:
    set_chain(world, PUSHED, 0, 0.3);
    break;
  default:
    spore_world_step(world);
  }
}

/* The states of a round by their hashes. Those of bodies that do not move are compared bit by bit with what they were
 * when they came to rest. */
static void record_round(guint64 *hashes) {
  SporeWorld *world = swings(NULL);
  double rest[CHAINS][3 * LINKS];
  gboolean still[CHAINS] = {FALSE};
  guint asleep[PUBLICATIONS];
  for (guint p = 0; p < PUBLICATIONS; p++) {
    act(world, p);
    hashes[p] = spore_world_hash(world);
    for (guint b = 0; b < CHAINS; b++) {
      gboolean now = spore_world_body_asleep(world, b) || spore_world_body_frozen(world, b);
      if (now && still[b]) g_assert_cmpmem(spore_world_q(world, b), sizeof rest[b], rest[b], sizeof rest[b]);
      memcpy(rest[b], spore_world_q(world, b), sizeof rest[b]);
      for (guint k = 0; now && k < 3 * LINKS; k++) g_assert_cmpfloat(spore_world_v(world, b)[k], ==, 0);
      still[b] = now;
    }
    asleep[p] = count_asleep(world);
  }
  g_assert_cmpuint(asleep[159], >, 10);
  g_assert_cmpuint(asleep[229], >, 10); /* while one chain was pulled, and one is held back by its forces */
  g_assert_cmpuint(asleep[231], ==, 0);
  g_assert_cmpuint(asleep[519], ==, CHAINS - 1);
  g_assert_cmpuint(asleep[529], ==, CHAINS - 2);
  g_assert_true(spore_world_body_frozen(world, POISONED));
  spore_world_free(world);
}

/* Whenever snapshots are taken, the same states: buffers that a body lies in no longer are brought up to date. */
static void test_acquired_at_random(void) {
  guint64 hashes[PUBLICATIONS];
  record_round(hashes);
  SporeWorld *world = swings(NULL);
  for (guint chance = 1; chance <= 256; chance *= 4)
    for (guint p = 0; p < PUBLICATIONS; p++) {
      act(world, p);
      g_assert_cmphex(spore_world_hash(world), ==, hashes[p]);
      if (g_test_rand_int_range(0, (gint32)chance) > 0) continue;
      g_assert_cmphex(spore_snapshot_hash(spore_world_snapshot_acquire(world)), ==, hashes[p]);
    }
  spore_world_free(world);
}

typedef struct Reader {
  SporeWorld *world;
  GRand *random;
  const guint64 *hashes;
  gint published, seen, wrong, stop;
} Reader;

static void dawdle(GRand *random) {
  guint32 chance = g_rand_int(random) % 64;
  if (chance == 0) g_usleep(20);
  else if (chance < 8) g_thread_yield();
}

static gpointer read_snapshots(gpointer data) {
  Reader *reader = data;
  while (!g_atomic_int_get(&reader->stop)) {
    gint oldest = g_atomic_int_get(&reader->published) - 1;
    const SporeSnapshot *snapshot = spore_world_snapshot_acquire(reader->world);
    gint newest = g_atomic_int_get(&reader->published); /* the last of them being published */
    dawdle(reader->random);
    guint64 hash = spore_snapshot_hash(snapshot);
    gboolean found = FALSE;
    for (gint p = MAX(oldest, 0); p <= newest && !found; p++) found = hash == reader->hashes[p % PUBLICATIONS];
    g_atomic_int_add(&reader->wrong, !found);
    g_atomic_int_inc(&reader->seen);
  }
  return NULL;
}

static void wait_for_reader(Reader *reader) {
  gint seen = g_atomic_int_get(&reader->seen);
  while (g_atomic_int_get(&reader->seen) == seen) g_thread_yield();
}

/* Another thread reads while the world steps, sleeps, wakes, is reset and set. */
static void test_reader(gconstpointer data) {
  guint64 hashes[PUBLICATIONS];
  record_round(hashes);
  SporePool *pool = spore_pool_create(GPOINTER_TO_INT(data));
  GRand *random = g_rand_new_with_seed((guint32)g_test_rand_int());
  Reader reader = {.world = swings(pool),
                   .random = g_rand_new_with_seed((guint32)g_test_rand_int()),
                   .hashes = hashes,
                   .published = 1};
  GThread *thread = g_thread_new("reader", read_snapshots, &reader);
  for (guint p = 1; p < 4 * PUBLICATIONS; p++) {
    act(reader.world, p % PUBLICATIONS);
    g_atomic_int_inc(&reader.published);
    dawdle(random);
    if (p % 16 == 0) wait_for_reader(&reader);
  }
  g_atomic_int_set(&reader.stop, 1);
  g_thread_join(thread);
  g_assert_cmpint(reader.wrong, ==, 0);
  spore_world_free(reader.world);
  spore_pool_free(pool);
  g_rand_free(random);
  g_rand_free(reader.random);
}

/* The messages of the monitor come with the snapshot, also those that came while nobody read. */
static void test_messages(void) {
  SporeWorld *world = swings(NULL);
  SporeCommand refused = {.kind = SPORE_COMMAND_GRAVITY, .vector = {0, NAN, 0}};
  guint64 posted = 0;
  for (guint round = 0; round < 40; round++) {
    for (guint i = 0; i < round * round % 90; i++, posted++) g_assert_true(spore_world_post(world, &refused));
    spore_world_step(world);
    const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
    const SporeMonitor *monitor = spore_world_monitor(world);
    g_assert_cmpuint(snapshot->message_count, ==, posted);
    g_assert_cmpmem(snapshot->messages, sizeof snapshot->messages, monitor->messages, sizeof monitor->messages);
    for (guint skipped = 0; skipped < round % 4; skipped++, posted++) {
      g_assert_true(spore_world_post(world, &refused));
      spore_world_step(world);
    }
  }
  g_assert_nonnull(strstr(spore_world_snapshot_acquire(world)->messages[0].text, "gravity"));
  spore_world_free(world);
}

/* Where nothing moves the state is shown all the same, at each step. */
static void test_still(void) {
  SporeBodyDescription body = {
      .name = "table", .role = SPORE_UNMOVABLE, .pose = {.position = {1, 2, 3}, .orientation = {1, 0, 0, 0}}};
  spore_parameters_set_initial(&spore_contact_parameters, &body.contact);
  SporeWorldDescription description = world_description(&body, 1);
  SporeError error = SPORE_ERROR_INIT;
  SporeWorld *world = spore_world_create(&description, NULL, &error);
  g_assert_nonnull(world);
  for (int step = 0; step < 5; step++) {
    const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
    g_assert_cmpuint(snapshot->step, ==, (guint64)step);
    const double *q = snapshot->q + spore_world_q_offset(world, 0);
    g_assert_true(q[0] == 1 && q[1] == 2 && q[2] == 3 && q[3] == 1);
    spore_world_step(world);
  }
  spore_world_free(world);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/sim/snapshot/acquired-at-random", test_acquired_at_random);
  g_test_add_data_func("/sim/snapshot/reader/1", GINT_TO_POINTER(1), test_reader);
  g_test_add_data_func("/sim/snapshot/reader/2", GINT_TO_POINTER(2), test_reader);
  g_test_add_data_func("/sim/snapshot/reader/4", GINT_TO_POINTER(4), test_reader);
  g_test_add_func("/sim/snapshot/messages", test_messages);
  g_test_add_func("/sim/snapshot/still", test_still);
  return g_test_run();
}
