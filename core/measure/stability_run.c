/* One run of a world that is pushed, and an account of its energy.
 *
 * Energy at any time may be no more than at the start and the work done since. Devices do the work F.v h at what they
 * hold, thermostats that of their power. What else changes energy from outside (parameters that jump, particles that
 * come or go, tissue that shrinks, a change of level) begins the account anew. A gain is measured against the energy at
 * work: what was there, the largest change of each kind since, and what the devices turned over. */
#include <math.h>
#include <string.h>

#include "core/measure/stability_private.h"

#define LOOKS 100            /* at the energy, in a run */
#define STEPS_OF_MEETING 100 /* after an instrument met something */
#define FALLEN_STEPS 4       /* what gravity gives in so many steps is at work at least */
#define GRAVITY 9.81         /* m/s^2 */
#define JUMP_STIFFNESS 1e3
#define JUMP_CONTACT 100
#define JUMP_GRAVITY 20. /* m/s^2 */

typedef struct Account {
  SporeEnergy start;
  double had, change, work, turnover; /* J */
  uint64_t outside;                   /* count_outside when it began */
  size_t safer;                       /* count_safer when it began */
  bool begun;
} Account;

static double total(const SporeEnergy *energy) {
  return energy->kinetic + energy->internal + energy->gravity + energy->contact;
}

static double mass_of(const SporeWorld *world, uint32_t body) {
  const SporeModel *model = spore_world_body_model(world, body);
  return model ? spore_model_total_mass(model) : 0;
}

static double least_energy(const SporeWorld *world, double step_s) {
  double mass = 0, speed = FALLEN_STEPS * step_s * GRAVITY;
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) mass += mass_of(world, b);
  return 0.5 * mass * speed * speed;
}

/* A number that changes when particles come or go, or a level does. */
static uint64_t count_outside(const SporeWorld *world) {
  uint64_t number = 0;
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    SporeLodState level;
    const SporeModel *model = spore_world_body_model(world, b);
    if (model && model->type->rates) number = 31 * number + spore_world_particle_count(world, b);
    if (spore_world_lod_state(world, b, &level)) number = 31 * number + level.changes;
  }
  return number;
}

/* Number of bodies that the monitor moves by a safer method. */
static size_t count_safer(const SporeWorld *world) {
  size_t count = 0;
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) count += spore_world_body_made_safer(world, b);
  return count;
}

/* Whether tissue was coagulated in the last step. */
static bool is_heated(const SporeWorld *world) {
  for (size_t i = 0; i < spore_world_tool_count(world); i++)
    if (spore_world_tool_state(world, i).coagulated > 0) return true;
  return false;
}

static void begin(Account *account, const SporeWorld *world, double step_s) {
  SporeEnergy energy = spore_world_energy(world);
  *account = (Account){.begun = true, .start = energy, .outside = count_outside(world), .safer = count_safer(world)};
  account->had = least_energy(world, step_s) + energy.kinetic + fabs(energy.internal) + energy.contact;
}

static void add_turnover(Account *account, double work) {
  account->work += work;
  account->turnover += fabs(work);
}

/* Work that thermostats and devices did in the step; of these, forces on what they hold, times its way. True: they felt
 * some. */
static bool add_work(Account *account, SporeWorld *world, double step_s) {
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(world);
  bool felt = false;
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    const SporeModel *model = spore_world_body_model(world, b);
    if (model && model->type->power) add_turnover(account, step_s * model->type->power(model));
    if (spore_world_body_role(world, b) != SPORE_ACTIVE) continue;
    const double *reaction = snapshot->reaction + 6 * (size_t)b, *v = spore_world_v(world, b);
    double work = 0;
    for (int k = 0; k < 6; k++) {
      work -= step_s * reaction[k] * v[k];
      felt |= reaction[k] != 0;
    }
    add_turnover(account, work);
  }
  return felt;
}

static uint32_t fastest_body(const SporeWorld *world) {
  uint32_t fastest = SPORE_NO_BODY;
  double most = -1;
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    const SporeModel *model = spore_world_body_model(world, b);
    const double *v = spore_world_v(world, b);
    double energy = 0;
    for (size_t i = 0; model && i < model->node_count; i++)
      energy += model->block_mass[i] * spore_vec3_dot(spore_vec3_load(v + 3 * i), spore_vec3_load(v + 3 * i));
    if (!model || energy <= most) continue;
    most = energy;
    fastest = b;
  }
  return fastest;
}

static void look(Account *account, const SporeWorld *world, SporePushRun *run) {
  SporeEnergy now = spore_world_energy(world);
  if (!isfinite(total(&now))) {
    run->finite = false;
    return;
  }
  double gain = total(&now) - total(&account->start) - account->work;
  double change = now.kinetic + fabs(now.internal - account->start.internal) +
                  fabs(now.gravity - account->start.gravity) + fabs(now.contact - account->start.contact);
  account->change = fmax(account->change, change - fmax(gain, 0));
  double share = gain / (account->had + account->change + account->turnover);
  if (share <= run->gain) return;
  run->gain = share;
  run->fastest = fastest_body(world);
}

/* A body by the static method has no energy that is kept. */
static bool keeps_energy(const SporeWorld *world) {
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    SporeMethod method;
    if (spore_world_body_method(world, b, &method) &&
        strcmp(method.integrator.name, spore_integrator_names[SPORE_INTEGRATOR_STATIC]) == 0)
      return false;
  }
  return true;
}

static void jump(const SporeStabilityScene *scene, SporeWorld *world, SporePushJump how) {
  const SporeCommand sideways = {.kind = SPORE_COMMAND_GRAVITY, .vector = {JUMP_GRAVITY, 0, 0}};
  if (how == SPORE_JUMP_STIFFNESS) scene->jump(scene->data, world, JUMP_STIFFNESS, 1);
  if (how == SPORE_JUMP_CONTACT) scene->jump(scene->data, world, 1, JUMP_CONTACT);
  if (how == SPORE_JUMP_GRAVITY) spore_world_post(world, &sideways);
}

/* Begins the account anew, and keeps what it came to. */
static void begin_anew(Account *account, SporeWorld *world, double step_s, SporePushRun *run) {
  if (account->begun && count_safer(world) != account->safer) {
    run->gain_before = fmax(run->gain_before, run->gain);
    run->gain = 0;
  }
  begin(account, world, step_s);
}

static bool is_over(const SporePushLength *length, const SporePushRun *run) {
  if (!run->finite) return true;
  if (length->most == 0 || run->steps < length->steps) return run->steps >= length->steps;
  bool met = run->met_at > 0 && run->steps >= run->met_at + STEPS_OF_MEETING;
  return met || run->steps >= length->most;
}

static void take_steps(const SporeStabilityScene *scene, SporeWorld *world, const SporePush *push,
                       const SporePushLength *length, SporePushRun *run) {
  Account account = {0};
  size_t stride = length->steps / LOOKS + 1, jump_at = length->steps / 2;
  while (!is_over(length, run)) {
    run->out_of_time = spore_clock_ns() > length->until_ns;
    if (run->out_of_time) break;
    bool jumps = push->jump != SPORE_JUMP_NONE && run->steps == jump_at;
    if (jumps) jump(scene, world, push->jump);
    double before_s = spore_world_time_s(world);
    spore_world_step(world);
    if (spore_world_cancelled(world)) break;
    spore_world_tidy(world);
    double step_s = spore_world_time_s(world) - before_s;
    run->steps++;
    size_t contacts = spore_world_counts(world).contacts;
    if (contacts > run->contacts) run->contacts = contacts;
    /* The first step counts what is deep in something else from the start as contacts. */
    bool anew = !account.begun || jumps || is_heated(world) || count_outside(world) != account.outside ||
                count_safer(world) != account.safer;
    if (anew) begin_anew(&account, world, step_s, run);
    else if (add_work(&account, world, step_s) && run->met_at == 0) run->met_at = run->steps;
    if (run->steps % stride == 0 || run->steps == length->steps) look(&account, world, run);
  }
}

bool spore_push_run(const SporeStabilityScene *scene, SporeWorld *world, const SporePush *push, SporePushLength length,
                    SporePushRun *run) {
  *run = (SporePushRun){.finite = true, .fastest = SPORE_NO_BODY};
  SporePushDevices *devices = NULL;
  if (push->input != SPORE_INPUT_AS_IT_IS && !(devices = spore_push_devices_new(world, push->input, length.steps)))
    return false;
  bool put = spore_start_put(world, push->start);
  run->judged = keeps_energy(world);
  if (put) take_steps(scene, world, push, &length, run);
  spore_push_devices_free(devices);
  return put;
}
