/* The plan: which stages a world needs, and why. A stage that is left out costs nothing at all. */
#include "core/base/text.h"
#include "core/sim/world_private.h"

typedef struct Census {
  size_t passive, active, spheres_moving, spheres_bodies, self_bodies;
  bool implicit_needed;
} Census;

static Census count_bodies(const SporeWorld *world) {
  Census census = {0};
  const SporeBody *first = NULL;
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    census.passive += body->role == SPORE_PASSIVE;
    census.active += body->role == SPORE_ACTIVE;
    census.spheres_bodies += body->spheres.point_count > 0;
    if (body->role != SPORE_PASSIVE) continue;
    if (!first) first = body;
    /* Bodies that choose differently are coupled implicitly. */
    census.implicit_needed |= spore_integrator(body->integrator)->implicit || body->integrator != first->integrator ||
                              body->substeps != first->substeps;
  }
  for (size_t i = 0; i < world->link_count; i++) census.implicit_needed |= world->links[i].kind != SPORE_LINK_SPRING;
  census.spheres_moving = world->spheres.count - world->spheres.static_count;
  return census;
}

static size_t no_items(const SporeWorld *world) { return 0; }
static size_t active_bodies(const SporeWorld *world) { return count_bodies(world).active; }
static size_t moving_spheres(const SporeWorld *world) { return world->spheres.count - world->spheres.static_count; }
static size_t all_spheres(const SporeWorld *world) { return world->spheres.count; }
static size_t contacts(const SporeWorld *world) { return world->contact_count; }
static size_t links(const SporeWorld *world) { return world->link_count + world->port_count + world->pull_count; }
static size_t tool_count(const SporeWorld *world) { return world->tool_count; }
static size_t tearing(const SporeWorld *world) { return world->tearing_count; }
static size_t sleeping(const SporeWorld *world) { return world->sleeping_count; }
static size_t islands(const SporeWorld *world) { return world->island_count; }
static size_t degrees_of_freedom(const SporeWorld *world) { return world->dof; }
static size_t bodies(const SporeWorld *world) { return world->body_count; }

static void add(SporeWorld *world, const char *name, bool included, const char *reason, void (*run)(SporeWorld *),
                size_t (*items)(const SporeWorld *)) {
  size_t index = world->plan.stage_count++;
  SporeStage *stage = &world->stages[index];
  stage->run = run;
  stage->items = items;
  stage->profile.name = name;
  world->plan_stages[index] = (SporePlanStage){
      .name = name, .included = included, .reason = reason, .profile = included ? &stage->profile : NULL};
  if (included) world->run[world->run_count++] = stage;
}

static void leave_out(SporeWorld *world, const char *what, const char *reason) {
  world->left_out[world->plan.left_out_count++] = (SporePlanLeftOut){what, reason};
}

static void plan_sleep(SporeWorld *world, const Census *census) {
  bool sleep = census->passive > 0 && world->solver.sleep_speed > 0;
  add(world, "wake", sleep,
      sleep                 ? _("bodies at rest sleep until something that moves touches them")
      : census->passive > 0 ? _("bodies never sleep: sleep_speed is 0")
                            : _("no body moves by physics"),
      spore_world_wake_up, sleeping);
}

static void plan_collision(SporeWorld *world, const Census *census) {
  bool collide = world->grid != NULL;
  const char *why = collide ? _("bodies that move have spheres to touch") : _("no two bodies can touch");
  if (census->spheres_bodies == 0) why = _("no body has spheres");
  add(world, "map", collide, why, spore_world_map_spheres, moving_spheres);
  add(world, "detect", collide, why, spore_world_detect, all_spheres);
  plan_sleep(world, census);
  add(world, "respond", collide, why, spore_world_respond, contacts);
  if (!collide) leave_out(world, _("collision"), why);
  else if (world->spheres.static_count)
    leave_out(world, _("mapping of unmovable spheres"), _("they lie in the grid from the start"));
}

static void plan_numerics(SporeWorld *world, const Census *census) {
  bool moves = census->passive > 0;
  const char *why = moves ? _("passive bodies move by physics") : _("no body moves by physics");
  add(world, "group", moves, moves ? _("bodies that touch are solved together") : why, spore_world_group, islands);
  add(world, "integrate", moves, why, spore_world_integrate, degrees_of_freedom);
  if (!moves) leave_out(world, _("integration"), why);
  else if (!census->implicit_needed)
    leave_out(world, _("the nonlinear solver"), _("every body is integrated explicitly; it is kept for recovery only"));
}

void spore_world_make_plan(SporeWorld *world) {
  world->plan.stage_count = world->plan.left_out_count = world->run_count = 0;
  Census census = count_bodies(world);
  bool active = census.active > 0, linked = world->link_count > 0, moves = census.passive > 0;
  bool pulled = world->pull_count > 0;
  bool coupled = world->grid || (moves && (linked || world->hold_count));
  const char *no_active = _("no body is driven by a device or a track");
  add(world, "command", true, _("parameters and pulls may change while it runs"), spore_world_apply_commands, no_items);
  add(world, "sense", active, active ? _("active bodies follow their devices") : no_active, spore_world_sense,
      active_bodies);
  bool tools = world->tool_count > 0;
  add(world, "tools", tools, tools ? _("instruments close, hold or suck") : _("no instrument does more than touch"),
      spore_world_use_tools, tool_count);
  bool tears = world->tearing_count > 0;
  add(world, "tear", tears, tears ? _("nets may tear where they are strained too much") : _("no body tears"),
      spore_world_tear, tearing);
  plan_collision(world, &census);
  add(world, "link", moves && (linked || pulled || world->hold_count),
      linked              ? _("links tie bodies together")
      : world->hold_count ? _("jaws may hold bodies")
      : pulled            ? _("a viewer pulls at a body")
                          : _("no link ties bodies, and nobody pulls at one"),
      spore_world_link, links);
  plan_numerics(world, &census);
  add(world, "react", coupled, coupled ? _("contacts and links push back") : _("nothing touches and nothing is tied"),
      spore_world_react, bodies);
  add(world, "feedback", active, active ? _("devices feel what active bodies touch") : no_active, spore_world_feed_back,
      active_bodies);
  add(world, "commit", true, _("checks, accepts and publishes the new state"), spore_world_commit, bodies);
  if (!spore_world_exchanges_particles(world))
    leave_out(world, _("exchange of particles"), _("nothing sucks particles away or lets them out"));
  if (!tools) leave_out(world, _("tools"), _("no instrument does more than touch"));
  if (!active) leave_out(world, _("devices and feedback"), no_active);
  if (!linked && !pulled && !world->port_count) leave_out(world, _("links"), _("the scene has none"));
  world->plan.stages = world->plan_stages;
  world->plan.left_out = world->left_out;
}

/* One step: each stage of the plan in its order, timed. */
void spore_world_run_plan(SporeWorld *world) {
  uint64_t start = spore_clock_ns(), before = start;
  /* The first stage applies commands, which may put a stage behind it in or out. */
  for (size_t i = 0; i < world->run_count; i++) {
    SporeStage *stage = world->run[i];
    stage->run(world);
    uint64_t after = spore_clock_ns();
    spore_profile_add(&stage->profile, after - before);
    before = after;
  }
  spore_profile_add(&world->profile, before - start);
  world->step_us = (double)(before - start) * 1e-3;
  if (world->budget_us > 0 && world->step_us > world->budget_us) spore_world_report_budget(world);
}

const SporePlan *spore_world_plan(const SporeWorld *world) {
  /* What a stage works on changes from step to step; the plan is brought up to date when somebody looks. */
  SporeWorld *plan_owner = (SporeWorld *)(uintptr_t)world;
  for (size_t i = 0; i < world->plan.stage_count; i++)
    if (world->plan_stages[i].included) plan_owner->plan_stages[i].items = world->stages[i].items(world);
  return &world->plan;
}

/* What automatic is at present: a body's choice of a factor decides both. */
static SporeChoice nonlinear_choice(const SporeWorld *world, const SporeBody *body) {
  int kind = world->solver.nonlinear;
  if (kind != SPORE_NONLINEAR_AUTOMATIC) return (SporeChoice){spore_nonlinear_names[kind], SPORE_SAID_BY_SCENE};
  kind = body->choice.factorised ? SPORE_NONLINEAR_BROYDEN : SPORE_NONLINEAR_NEWTON;
  return (SporeChoice){spore_nonlinear_names[kind], SPORE_SAID_BY_NOBODY};
}

static SporeChoice linear_choice(const SporeWorld *world, const SporeBody *body) {
  int factor = body->factor.band.block_count > 0 ? SPORE_LINEAR_BANDED : SPORE_LINEAR_CHOLESKY;
  int kind = body->choice.factorised ? factor : SPORE_LINEAR_CONJUGATE_GRADIENTS;
  bool open = world->solver.linear == SPORE_LINEAR_AUTOMATIC || kind != world->solver.linear;
  return (SporeChoice){spore_linear_names[kind], open ? SPORE_SAID_BY_NOBODY : SPORE_SAID_BY_SCENE};
}

bool spore_world_body_method(const SporeWorld *world, uint32_t index, SporeMethod *method) {
  const SporeBody *body = &world->bodies[index];
  if (body->role != SPORE_PASSIVE) return false;
  const SporeIntegrator *integrator = spore_integrator(body->integrator);
  *method = (SporeMethod){.integrator = {integrator->name, body->integrator_said_by},
                          .substeps = body->substeps,
                          .substeps_said_by = body->substeps_said_by};
  if (body->integrator != body->chosen) method->integrator.said_by = SPORE_SAID_BY_MONITOR;
  if (!integrator->implicit) return true;
  method->nonlinear = nonlinear_choice(world, body);
  method->linear = linear_choice(world, body);
  return true;
}
