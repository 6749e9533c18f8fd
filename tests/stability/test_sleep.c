/* Bodies at rest sleep, wake when something may move them, and a run with sleep is the run without to the stated bound.
 */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/stability/rig.h"

#define BALL_RADIUS 0.02
#define SETTLED_S 4. /* more than the pile needs to come to rest and to fall asleep */
/* Longest time constant of the pile's motion about rest, s: of balls of 0.03 kg on contacts of 500 N/m. */
#define PILE_TIME_CONSTANT 0.1

/* Follows a straight way there and back in a second, or stays there, from a time on; before and after it stands still.
 */
typedef struct Poker {
  SporeDevice base;
  double start_s;
  SporeVec3 from, to;
  gboolean stays;
} Poker;

static bool poke(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  const Poker *poker = (const Poker *)device;
  double phase = CLAMP(time_s - poker->start_s, 0, poker->stays ? 0.5 : 1), part = 0.5 - 0.5 * cos(2 * G_PI * phase);
  SporeVec3 at = spore_vec3_add_scaled(poker->from, part, spore_vec3_sub(poker->to, poker->from));
  *state = (SporeDeviceState){.orientation = {1, 0, 0, 0}};
  spore_vec3_store(state->position, at);
  return true;
}

static void poker_close(SporeDevice *device) {}
static const SporeDeviceType poker_type = {.name = "poker", .doc = "", .exchange = poke, .close = poker_close};

static SporeModel *ball_model(void) {
  SporeTriangleMesh mesh;
  shape_box(&mesh, spore_vec3(0, 0, 0), spore_vec3(0.03, 0.03, 0.03));
  return rig_surface_model(&spore_rigid_body, &mesh, "mass", 0.03, NULL);
}

static void add_ball(Rig *rig, const char *name, SporeVec3 at) {
  SporeBodyDescription *ball = rig_passive(rig, name, ball_model(), rig_sphere(rig, BALL_RADIUS));
  ball->pose.position = at;
  ball->contact.damping = 5;
  ball->contact.friction = 0;
}

/* Two piles of five balls in the dimples of a floor, 0.4 m apart, and a tool above the first. */
static Rig *piles(double sleep_speed, SporeIntegratorKind integrator) {
  static const char *const names[2][5] = {{"a0", "a1", "a2", "a3", "a4"}, {"b0", "b1", "b2", "b3", "b4"}};
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.integrator = integrator;
  rig->description.solver.sleep_speed = sleep_speed;
  rig->description.solver.time_step = integrator == SPORE_INTEGRATOR_IMPLICIT_EULER ? 0.002 : 0.0005;
  SporeBodyDescription *floor = rig_unmovable(rig, "floor", rig_floor(rig, 20, 20, 0.04, 0.03));
  floor->contact.damping = 5;
  floor->contact.friction = 0;
  for (int pile = 0; pile < 2; pile++) {
    double x = pile ? 0.2 : -0.2;
    for (int i = 0; i < 4; i++) add_ball(rig, names[pile][i], spore_vec3(x + 0.04 * (i % 2), 0.015, 0.04 * (i / 2)));
    add_ball(rig, names[pile][4], spore_vec3(x + 0.02, 0.045, 0.02));
  }
  SporeBodyDescription *tool = rig_active(rig, "tool", rig_sphere(rig, 0.005));
  tool->pose.position = spore_vec3(-0.18, 0.12, 0.02);
  return rig;
}

static Poker poker_over_pile(double start_s) {
  return (Poker){{&poker_type}, start_s, spore_vec3(-0.18, 0.12, 0.02), spore_vec3(-0.18, 0.0605, 0.02)};
}

static void run_for(Rig *rig, double time_s) {
  rig_run(rig->world, (guint)lround(time_s / rig->description.solver.time_step));
}

static guint count_asleep(const SporeWorld *world) {
  guint asleep = 0;
  for (guint b = 0; b < spore_world_body_count(world); b++) asleep += spore_world_body_asleep(world, b);
  return asleep;
}

/* Largest distance between the same body's origins in two worlds. */
static double apart(const SporeWorld *a, const SporeWorld *b) {
  double most = 0;
  for (guint i = 0; i < spore_world_body_count(a); i++)
    most = fmax(most, spore_vec3_distance(spore_vec3_load(spore_world_q(a, i)), spore_vec3_load(spore_world_q(b, i))));
  return most;
}

/* The piles settle and sleep; the tool presses on one, which wakes, and the other sleeps on; both rest again. */
static void test_pile(gconstpointer data) {
  SporeIntegratorKind integrator = (SporeIntegratorKind)GPOINTER_TO_INT(data);
  Rig *slept = piles(1e-6, integrator), *awake = piles(0, integrator);
  SporeWorld *worlds[2] = {rig_build(slept), rig_build(awake)};
  Poker pokers[2] = {poker_over_pile(SETTLED_S), poker_over_pile(SETTLED_S)};
  for (int w = 0; w < 2; w++) spore_world_set_device(worlds[w], 11, &pokers[w].base);
  run_for(slept, SETTLED_S);
  run_for(awake, SETTLED_S);
  double settled = apart(worlds[0], worlds[1]), jump = fabs(rig_energy(worlds[0]) - rig_energy(worlds[1]));
  g_assert_cmpuint(count_asleep(worlds[0]), ==, 10);
  g_assert_cmpuint(count_asleep(worlds[1]), ==, 0);
  g_assert_cmpuint(spore_world_counts(worlds[0]).contacts, ==, 0);
  guint least = 10;
  double poked = 0;
  while (spore_world_time_s(worlds[0]) < 2 * SETTLED_S) {
    for (int w = 0; w < 2; w++) spore_world_step(worlds[w]);
    least = MIN(least, count_asleep(worlds[0]));
    poked = fmax(poked, apart(worlds[0], worlds[1]));
  }
  g_test_message("asleep and awake apart by %.1e m settled, %.1e m while poked, %.1e m after it; energy by %.1e J",
                 settled, poked, apart(worlds[0], worlds[1]), jump);
  g_assert_cmpuint(least, ==, 5);
  g_assert_cmpuint(count_asleep(worlds[0]), ==, 10);
  g_assert_cmpfloat(settled, <=, 1e-6 * PILE_TIME_CONSTANT);
  g_assert_cmpfloat(poked, <=, 2e-6 * PILE_TIME_CONSTANT);
  g_assert_cmpfloat(jump, <=, 1e-8);
  rig_free(slept);
  rig_free(awake);
}

/* The energy of contacts is counted once, in the step in which their island falls asleep as before and after it. */
static void test_energy(void) {
  Rig *rig = piles(1e-6, SPORE_INTEGRATOR_IMPLICIT_EULER);
  SporeWorld *world = rig_build(rig);
  double least = HUGE_VAL, most = 0;
  guint fell_asleep = 0;
  while (spore_world_time_s(world) < SETTLED_S) {
    guint before = count_asleep(world);
    double energy = spore_world_energy(world).contact;
    spore_world_step(world);
    if (count_asleep(world) == before) continue;
    fell_asleep++;
    for (int steps = 0; steps < 2; steps++, spore_world_step(world)) {
      least = fmin(least, spore_world_energy(world).contact / energy);
      most = fmax(most, spore_world_energy(world).contact / energy);
    }
  }
  g_test_message("energy of contacts when their island falls asleep: %.9f to %.9f times that before", least, most);
  g_assert_cmpuint(fell_asleep, >=, 1);
  g_assert_cmpfloat(least, >, 1 - 1e-6);
  g_assert_cmpfloat(most, <, 1 + 1e-6);
  rig_free(rig);
}

/* What a tool touches stays awake, however still the tool is: it is to feel friction and creep. */
static void test_held(void) {
  Rig *rig = piles(1e-6, SPORE_INTEGRATOR_IMPLICIT_EULER);
  SporeWorld *world = rig_build(rig);
  Poker poker = poker_over_pile(SETTLED_S);
  poker.stays = TRUE;
  spore_world_set_device(world, 11, &poker.base);
  run_for(rig, SETTLED_S);
  g_assert_cmpuint(count_asleep(world), ==, 10);
  run_for(rig, SETTLED_S);
  g_assert_cmpuint(count_asleep(world), ==, 5);
  for (guint b = 1; b <= 5; b++) g_assert_false(spore_world_body_asleep(world, b));
  g_assert_cmpfloat(spore_world_snapshot_acquire(world)->reaction[6 * 11 + 1], >, 0.1);
  const double *asleep = spore_world_snapshot_acquire(world)->reaction + 6 * 10; /* the top of the other pile */
  g_assert_cmpfloat_with_epsilon(asleep[1], 0.03 * 9.81, 1e-6);
  rig_free(rig);
}

static SporeWorld *build_with(Rig *rig, SporePool *pool) {
  rig_build_on(rig, pool);
  return rig->world;
}

static void test_threads(void) {
  uint64_t expected = 0;
  for (int threads = 1; threads <= 4; threads *= 2) {
    SporePool *pool = spore_pool_create(threads);
    Rig *rig = piles(1e-6, SPORE_INTEGRATOR_IMPLICIT_EULER);
    SporeWorld *world = build_with(rig, pool);
    Poker poker = poker_over_pile(SETTLED_S);
    spore_world_set_device(world, 11, &poker.base);
    run_for(rig, SETTLED_S + 0.6);
    g_assert_cmpuint(count_asleep(world), ==, 5);
    if (threads == 1) expected = spore_world_hash(world);
    g_assert_cmphex(spore_world_hash(world), ==, expected);
    rig_free(rig);
    spore_pool_free(pool);
  }
}

/* After a reset the same run again, bit for bit. */
static void test_reset(void) {
  Rig *rig = piles(1e-6, SPORE_INTEGRATOR_IMPLICIT_EULER);
  SporeWorld *world = rig_build(rig);
  run_for(rig, SETTLED_S);
  uint64_t hash = spore_world_hash(world);
  g_assert_cmpuint(count_asleep(world), ==, 10);
  spore_world_reset(world);
  g_assert_cmpuint(count_asleep(world), ==, 0);
  run_for(rig, SETTLED_S);
  g_assert_cmphex(spore_world_hash(world), ==, hash);
  rig_free(rig);
}

/* Each of what may change the forces on a pile wakes it, and it alone where that is all that is concerned. */
typedef enum Cause { GRAVITY, PULL, CONTACT, FLOOR_CONTACT, SET_STATE, FALLING_BALL, CAUSE_COUNT } Cause;

static void wake_by(Cause cause, SporeWorld *world) {
  SporeCommand command = {.body = 1};
  spore_parameters_set_initial(&spore_contact_parameters, &command.contact);
  const double *q = spore_world_q(world, 1);
  double state[7], still[6] = {0, -0.5, 0, 0, 0, 0};
  memcpy(state, q, sizeof state);
  switch (cause) {
  case GRAVITY:
    command.kind = SPORE_COMMAND_GRAVITY;
    command.vector = spore_vec3(0, -5, 0);
    break;
  case PULL:
    command.kind = SPORE_COMMAND_PULL;
    command.point = spore_vec3_load(q);
    command.vector = spore_vec3_add(command.point, spore_vec3(0, 0.05, 0));
    command.number = 100;
    break;
  case FLOOR_CONTACT:
    command.body = 0; /* the floor */
    command.kind = SPORE_COMMAND_CONTACT;
    break;
  case CONTACT:
    command.kind = SPORE_COMMAND_CONTACT;
    break;
  case SET_STATE:
    spore_world_set_state(world, 1, state, still);
    return;
  case FALLING_BALL: /* of the second pile, onto the first */
    memcpy(state, spore_world_q(world, 5), sizeof state);
    state[1] += 0.06;
    spore_world_set_state(world, 6, state, still);
    return;
  case CAUSE_COUNT:
    break;
  }
  g_assert_true(spore_world_post(world, &command));
}

static void test_causes(void) {
  static const guint asleep_after[CAUSE_COUNT] = {0, 5, 5, 0, 0, 0};
  Rig *rig = piles(1e-6, SPORE_INTEGRATOR_IMPLICIT_EULER);
  SporeWorld *world = rig_build(rig);
  for (Cause cause = 0; cause < CAUSE_COUNT; cause++) {
    spore_world_reset(world);
    run_for(rig, SETTLED_S);
    g_assert_cmpuint(count_asleep(world), ==, 10);
    wake_by(cause, world);
    spore_world_step(world);
    g_assert_cmpuint(count_asleep(world), ==, asleep_after[cause]);
    g_assert_cmpuint(spore_world_counts(world).contacts, >, 0);
    /* What is woken sees its contacts in the same step: nothing falls through for want of one. */
    rig_run(world, 50);
    for (guint b = 1; b <= 10; b++) g_assert_cmpfloat(spore_world_q(world, b)[1], >, -0.001);
  }
  rig_free(rig);
}

/* A net that hangs from two corners sleeps, and swings on when its parameters change; the step costs nothing then. */
static void test_net(void) {
  Rig *rigs[2];
  SporeWorld *worlds[2];
  for (int w = 0; w < 2; w++) {
    SporeTriangleMesh sheet;
    shape_sheet(&sheet, 6, 6, 0.02, TRUE);
    rigs[w] = rig_new();
    rigs[w]->description.gravity = spore_vec3(0, -9.81, 0);
    if (w == 1) rigs[w]->description.solver.sleep_speed = 0;
    rig_passive(rigs[w], "net", rig_surface_model(&spore_mass_spring_net, &sheet, "damping", 0.5, NULL), NULL);
    rig_pin(rigs[w], 0, spore_vec3(0, 0.1, 0), 1e-3);
    rig_pin(rigs[w], 0, spore_vec3(0.1, 0.1, 0), 1e-3);
    worlds[w] = rig_build(rigs[w]);
    rig_run(worlds[w], 6000);
  }
  double most = 0;
  for (guint i = 0; i < 3 * 36; i++)
    most = fmax(most, fabs(spore_world_q(worlds[0], 0)[i] - spore_world_q(worlds[1], 0)[i]));
  g_test_message("net asleep and awake apart by %.1e m", most);
  g_assert_cmpuint(count_asleep(worlds[0]), ==, 1);
  g_assert_cmpuint(spore_world_counts(worlds[0]).force_evaluations, ==, 0);
  g_assert_cmpfloat(most, <=, 1e-6);
  SporeCommand command = {.kind = SPORE_COMMAND_RETUNE, .body = 0};
  command.fields = rig_fields(&spore_mass_spring_net, "damping", 0.5, "structural_stiffness", 50.0, NULL);
  g_assert_true(spore_world_post(worlds[0], &command));
  spore_world_step(worlds[0]);
  g_assert_cmpuint(count_asleep(worlds[0]), ==, 0);
  g_assert_cmpuint(spore_world_counts(worlds[0]).force_evaluations, >, 0);
  rig_free(rigs[0]);
  rig_free(rigs[1]);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_data_func("/sleep/pile/symplectic_euler", GINT_TO_POINTER(SPORE_INTEGRATOR_SYMPLECTIC_EULER), test_pile);
  g_test_add_data_func("/sleep/pile/implicit_euler", GINT_TO_POINTER(SPORE_INTEGRATOR_IMPLICIT_EULER), test_pile);
  g_test_add_func("/sleep/energy", test_energy);
  g_test_add_func("/sleep/held", test_held);
  g_test_add_func("/sleep/threads", test_threads);
  g_test_add_func("/sleep/reset", test_reset);
  g_test_add_func("/sleep/causes", test_causes);
  g_test_add_func("/sleep/net", test_net);
  return g_test_run();
}
