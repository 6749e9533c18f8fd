/* The step of a world: one table of stages, run from top to bottom. A stage that a world does not need is not in its
 * schedule and costs nothing. */
#include "core/sim/step.h"

#include <assert.h>

#include "core/base/text.h"
#include "core/sim/world_private.h"

/* Conditions: whether a world needs a stage. */

static bool always(const SporeWorld *world) { return true; }

static bool has_role(const SporeWorld *world, SporeRole role) {
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == role) return true;
  return false;
}

static bool has_active(const SporeWorld *world) { return has_role(world, SPORE_ACTIVE); }
static bool has_passive(const SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (spore_body_is_physical(&world->bodies[b])) return true;
  return false;
}
static bool has_moving(const SporeWorld *world) { return has_active(world) || has_role(world, SPORE_PASSIVE); }
static bool has_tools(const SporeWorld *world) { return world->tools.count > 0; }
static bool may_tear(const SporeWorld *world) { return world->topology.tearing_count > 0; }
static bool may_touch(const SporeWorld *world) { return world->contact.grid != NULL; }
static bool may_sleep(const SporeWorld *world) { return world->solver.sleep_speed > 0 && has_passive(world); }
/* Whether jaws may hold something by ties. */
static bool may_hold(const SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++)
    if (world->tools.all[i]->spring_count > 0 && !world->tools.all[i]->effect) return true;
  return false;
}
static bool has_springs(const SporeWorld *world) {
  return (world->links.count > 0 || may_hold(world) || world->links.pull_count > 0) && has_passive(world);
}
static bool has_terms(const SporeWorld *world) { return may_touch(world) || has_springs(world); }
static bool may_split(const SporeWorld *world) { return world->topology.cuts.corner_count > 0; }
static bool may_refine(const SporeWorld *world) { return world->topology.line_count > 0; }

static bool may_break(const SporeWorld *world) {
  for (size_t i = 0; i < world->links.count; i++)
    if (isfinite(world->links.all[i].strength)) return true;
  return false;
}

static bool has_holds(const SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++)
    if (world->tools.all[i]->type->tear && !world->tools.all[i]->effect) return true;
  return false;
}

/* Whether some step may solve equations: that of an implicit body, or of explicit ones whose contacts or links their
 * step does not resolve. Implicit Euler may also stand in where an explicit step goes wrong; but not of particles. */
static bool may_solve(const SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    const SporeBody *body = &world->bodies[b];
    if (!spore_body_is_physical(body)) continue;
    if (spore_integrator(body->method.chosen)->implicit || !body->model->type->rates) return true;
  }
  return has_passive(world) && has_terms(world);
}

/* Items: what a stage works on. */

static size_t bodies(const SporeWorld *world) { return world->body_count; }
static size_t active_bodies(const SporeWorld *world) {
  size_t count = 0;
  for (size_t b = 0; b < world->body_count; b++) count += world->bodies[b].role == SPORE_ACTIVE;
  return count;
}
static size_t sleeping_bodies(const SporeWorld *world) { return world->solve.sleeping_count; }
static size_t tearing_bodies(const SporeWorld *world) { return world->topology.tearing_count; }
static size_t all_spheres(const SporeWorld *world) { return world->contact.spheres.count; }
static size_t moving_spheres(const SporeWorld *world) {
  return world->contact.spheres.count - world->contact.spheres.static_count;
}
static size_t drops(const SporeWorld *world) {
  size_t count = 0;
  for (size_t b = 0; b < world->body_count; b++)
    if (spore_body_is_fluid(&world->bodies[b])) count += world->bodies[b].block_count;
  return count;
}
static size_t contacts(const SporeWorld *world) { return world->contact.count; }
static size_t links(const SporeWorld *world) {
  return world->links.count + world->links.trocar_count + world->links.pull_count;
}
static size_t tools(const SporeWorld *world) { return world->tools.count; }
static size_t tetrahedra(const SporeWorld *world) { return world->topology.cuts.corner_count; }
static size_t lines(const SporeWorld *world) { return world->topology.line_count; }
static size_t effects(const SporeWorld *world) {
  size_t count = 0;
  for (size_t b = 0; b < world->body_count; b++) count += world->bodies[b].effect.on;
  return count;
}
static size_t islands(const SporeWorld *world) { return world->solve.island_count; }
static size_t degrees_of_freedom(const SporeWorld *world) { return spore_world_dof(world); }

/* Estimates, us: of stages whose cost is not so much an item. Contacts are not known before they are there. */

#define ITERATIONS 1.3   /* of an implicit step in which little happens */
#define FRAME_US 1.5     /* an implicit step of a rigid body */
#define EXPLICIT_US 0.06 /* a block in an explicit substep */
#define VERIFY_US 0.02   /* a degree of freedom */

static double physics_of(const SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  SporeBodyWork work;
  if (spore_world_body_work(world, index, &work)) return ITERATIONS * 1e6 * work.step_s;
  if (spore_integrator(body->method.integrator)->implicit) return FRAME_US;
  return EXPLICIT_US * (double)(body->method.substeps * body->block_count);
}

static double integrate_work(const SporeWorld *world) {
  double sum = 0;
  for (uint32_t b = 0; b < world->body_count; b++)
    if (spore_body_is_physical(&world->bodies[b])) sum += physics_of(world, b);
  return sum;
}

#define EFFECT_US 5  /* a body */
#define DROP_US 0.15 /* a drop, each time that drops move */

static double effect_of(const SporeWorld *world, uint32_t index) {
  const SporeBody *body = &world->bodies[index];
  if (!body->effect.drops.from || body->effect.settled) return EFFECT_US;
  return DROP_US * (double)body->block_count * world->solver.time_step / SPORE_POUR_PACE_S;
}

static double effects_work(const SporeWorld *world) {
  double sum = 0;
  for (uint32_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].effect.on) sum += effect_of(world, b);
  return sum;
}

bool spore_world_effect_work(const SporeWorld *world, uint32_t body, double *effect_us, double *physics_us) {
  assert(body < world->body_count);
  if (!world->bodies[body].effect.on) return false;
  *effect_us = effect_of(world, body);
  *physics_us = physics_of(world, body);
  return true;
}

static double verify_work(const SporeWorld *world) { return VERIFY_US * (double)spore_world_dof(world); }

/* The stages of a step. Contacts and links are found from `detect` to `link` and do not change in the rest of the
 * step, so that forces are a pure function of q, v and t. From `accept` on the next state is written; from `advance` on
 * the next state is the state. */
static const SporeStageType stages[] = {
    {"commands", always, spore_world_apply_commands, NULL, /**/
     N_("parameters and pulls may change while it runs"), NULL, 0.02, 0},
    {"levels", spore_lod_is_automatic, spore_world_adapt_levels, spore_lod_automatic_count, /**/
     N_("bodies change their level of detail by themselves"), N_("no body changes its level of detail by itself"), 0.02,
     0.5},
    {"device_input", has_active, spore_world_read_devices, active_bodies, /**/
     N_("active bodies follow their devices"), N_("no body is driven by a device or a track"), 0.2, 0.7},
    {"tools", has_tools, spore_world_use_tools, tools, /**/
     N_("instruments close, hold or suck"), N_("no instrument does more than touch"), 0.1, 0.5},
    {"tear", may_tear, spore_world_tear, tearing_bodies, /**/
     N_("nets may tear where they are strained too much"), N_("no body tears"), 0.1, 1},
    {"map", may_touch, spore_world_map_spheres, moving_spheres, /**/
     N_("bodies that move have spheres to touch"), N_("no two bodies can touch"), 0.1, 0.012},
    {"detect", may_touch, spore_world_detect, all_spheres, /**/
     N_("bodies that move have spheres to touch"), N_("no two bodies can touch"), 0.3, 0.004},
    {"stain", spore_world_may_stain, spore_world_stain, drops, /**/
     N_("what drops lie on takes on their colour"), N_("no fluid stains or washes what it touches"), 0.05, 0.002},
    {"lens", spore_world_may_wet_lens, spore_world_wet_lenses, drops, /**/
     N_("drops wet the lens of an endoscope, or smoke hazes its view"),
     N_("nothing wets a lens, and no smoke hazes a view"), 0.05, 0.002},
    {"wake", may_sleep, spore_world_wake_touched, sleeping_bodies, /**/
     N_("bodies at rest sleep until something that moves touches them"),
     N_("bodies never sleep: sleep_speed is 0, or none moves by physics"), 0.05, 0},
    {"respond", may_touch, spore_world_respond, contacts, /**/
     N_("bodies that move have spheres to touch"), N_("no two bodies can touch"), 0.1, 0.1},
    {"link", has_springs, spore_world_link, links, /**/
     N_("links, jaws or a viewer's pull tie bodies"), N_("no link ties bodies, and nobody pulls at one"), 0.05, 0.08},
    {"islands", has_passive, spore_world_find_islands, islands, /**/
     N_("bodies that touch or are tied are solved together"), N_("no body moves by physics"), 0.15, 0.05},
    {"integrate", has_passive, spore_world_integrate, degrees_of_freedom, /**/
     N_("passive bodies move by physics"), N_("no body moves by physics"), 0, 0, integrate_work},
    {"verify", may_solve, spore_world_verify, degrees_of_freedom, /**/
     N_("what steps solve is evaluated again, apart from the solver"), N_("no step solves equations"), 0, 0,
     verify_work},
    {"reactions", has_terms, spore_world_add_reactions, bodies, /**/
     N_("contacts or links push back"), N_("nothing touches and nothing is tied"), 0.1, 0.03},
    {"feedback", has_active, spore_world_feed_back, active_bodies, /**/
     N_("devices feel what active bodies touch"), N_("no body is driven by a device or a track"), 0.1, 0.05},
    {"accept", has_moving, spore_world_accept, bodies, /**/
     N_("bodies that move have a next state"), N_("no body moves"), 0.05, 0.02},
    {"effects", spore_world_has_effects, spore_world_move_effects, effects, /**/
     N_("effects move bodies in place of physics"), N_("physics moves all bodies that no device moves"), 0.05, 0,
     effects_work},
    {"particles", spore_world_exchanges_particles, spore_world_exchange_particles, bodies, /**/
     N_("particles come and go: by suction, by emitters, or as they dissolve"),
     N_("nothing sucks particles away or lets them out"), 0.1, 0.02},
    {"split_nodes", may_split, spore_world_split_nodes, tetrahedra, /**/
     N_("scissors may cut tetrahedra apart"), N_("nothing cuts tetrahedra apart"), 0.1, 0},
    {"advance", always, spore_world_advance, bodies, /**/
     N_("the next state becomes the state"), NULL, 0.05, 0.01},
    {"friction", may_touch, spore_world_keep_pairs, contacts, /**/
     N_("contacts that stick hold on in the next step"), N_("no two bodies can touch"), 0.05, 0.06},
    {"break_links", may_break, spore_world_break_links, links, /**/
     N_("links may bear too much"), N_("no link can break"), 0.01, 0.01},
    {"tear_holds", has_holds, spore_world_tear_holds, tools, /**/
     N_("what jaws hold may tear away"), N_("no jaws hold anything"), 0.05, 0.05},
    {"watch_energy", spore_world_may_gain_energy, spore_world_watch_energy, bodies, /**/
     N_("some methods may make energy out of nothing"),
     N_("no method makes energy out of nothing, or static moves a body and keeps none"), 0.1, 0.01},
    {"report", has_passive, spore_world_report_islands, islands, /**/
     N_("what went wrong is counted and said"), N_("no body moves by physics"), 0.08, 0.02},
    {"refine_splines", may_refine, spore_world_refine_splines, lines, /**/
     N_("threads get control points where they bend"), N_("no thread gets control points where it bends"), 0, 1},
    {"publish", always, spore_world_end_step, bodies, /**/
     N_("readers see the new state"), NULL, 0.1, 0.01},
};
_Static_assert(sizeof stages / sizeof *stages == SPORE_STAGE_COUNT, "SPORE_STAGE_COUNT");

/* Work besides stages that a world does not need. */

static bool none_solves(const SporeWorld *world) { return has_passive(world) && !may_solve(world); }

static bool has_unmovable_spheres(const SporeWorld *world) {
  return may_touch(world) && world->contact.spheres.static_count > 0;
}

static bool no_contact(const SporeWorld *world) { return !may_touch(world); }
static bool no_passive(const SporeWorld *world) { return !has_passive(world); }
static bool no_exchange(const SporeWorld *world) { return !spore_world_exchanges_particles(world); }
static bool no_tools(const SporeWorld *world) { return !has_tools(world); }
static bool no_active(const SporeWorld *world) { return !has_active(world); }
static bool has_pins(const SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].held.pin_count > 0) return true;
  return false;
}
static bool no_links(const SporeWorld *world) { return links(world) == 0 && !has_pins(world); }
static bool pins_alone(const SporeWorld *world) { return links(world) == 0 && has_pins(world); }

static const struct {
  const char *what;
  bool (*spared)(const SporeWorld *world);
  const char *reason, *stages;
} spared[] = {
    {N_("collision"), no_contact, N_("no two bodies can touch"), "map detect respond friction"},
    {N_("mapping of unmovable spheres"), has_unmovable_spheres, N_("they lie in the grid from the start"),
     "map detect"},
    {N_("integration"), no_passive, N_("no body moves by physics"), "islands integrate report"},
    {N_("physics of effects"), spore_world_has_effects, N_("an effect moves these bodies"), "islands integrate verify"},
    {N_("the nonlinear solver"), none_solves,
     N_("every body is integrated explicitly, and nothing touches or ties them"), "verify"},
    {N_("exchange of particles"), no_exchange, N_("nothing sucks particles away or lets them out"), "particles"},
    {N_("tools"), no_tools, N_("no instrument does more than touch"), "tools tear_holds"},
    {N_("devices and feedback"), no_active, N_("no body is driven by a device or a track"), "device_input feedback"},
    {N_("links"), no_links, N_("the scene has none"), "link break_links"},
    {N_("links other than pins"), pins_alone, N_("the scene has none"), "link break_links"},
};
_Static_assert(sizeof spared / sizeof *spared <= SPORE_LEFT_OUT_MAXIMUM, "SPORE_LEFT_OUT_MAXIMUM");

/* Contacts have no arrays to work on where no body has spheres. */
static bool runs(const SporeWorld *world, const SporeStageType *stage) {
  return stage->needed(world) || (world->schedule.unpruned && stage->needed != may_touch);
}

void spore_world_make_plan(SporeWorld *world) {
  SporeSchedule *schedule = &world->schedule;
  SporePlan *plan = &schedule->plan;
  *plan = (SporePlan){.stages = schedule->plan_stages, .left_out = schedule->left_out};
  schedule->run_count = 0;
  schedule->stale = false;
  for (size_t i = 0; i < SPORE_STAGE_COUNT; i++) {
    bool included = runs(world, &stages[i]);
    SporeProfilePhase *profile = &schedule->profiles[i];
    profile->name = stages[i].name;
    schedule->plan_stages[plan->stage_count++] =
        (SporePlanStage){.name = stages[i].name,
                         .included = included,
                         .reason = _(stages[i].needed(world) ? stages[i].why : stages[i].why_not),
                         .profile = included ? profile : NULL};
    if (included) schedule->run[schedule->run_count++] = (uint8_t)i;
  }
  for (size_t i = 0; i < sizeof spared / sizeof *spared; i++)
    if (spared[i].spared(world))
      schedule->left_out[plan->left_out_count++] =
          (SporePlanLeftOut){_(spared[i].what), _(spared[i].reason), spared[i].stages};
}

bool spore_world_cancelled(const SporeWorld *world) { return world->schedule.cancelled; }

void spore_world_step(SporeWorld *world) {
  SporeSchedule *schedule = &world->schedule;
  uint64_t start = spore_clock_ns(), before = start;
  bool accepted = false; /* before it nothing of the next state is kept; after it the step is short */
  /* The first stage applies commands, which may add or remove a later stage. */
  for (size_t i = 0; i < schedule->run_count; i++) {
    size_t stage = schedule->run[i];
    schedule->cancelled |= !accepted && spore_cancel_asked(world->cancel);
    if (schedule->cancelled) return;
    accepted |= stages[stage].run == spore_world_accept;
    stages[stage].run(world);
    uint64_t after = spore_clock_ns();
    spore_profile_add(&schedule->profiles[stage], after - before);
    before = after;
    if (schedule->stale) spore_world_make_plan(world);
  }
  spore_profile_add(&schedule->profile, before - start);
  schedule->step_us = (double)(before - start) * 1e-3;
  if (schedule->budget_us > 0 && schedule->step_us > schedule->budget_us) spore_world_report_budget(world);
}

static void fill_items(const SporeWorld *world, const SporeStageType *stage, SporePlanStage *plan) {
  if (stage->items) plan->items = stage->items(world);
  plan->estimate_us = stage->fixed_us + stage->item_us * (double)plan->items;
  if (stage->work) plan->estimate_us += stage->work(world);
}

const SporePlan *spore_world_plan(const SporeWorld *world) {
  /* The item counts and estimates of stages change from step to step. They are updated only when the plan is read. */
  SporeSchedule *schedule = &((SporeWorld *)(uintptr_t)world)->schedule;
  schedule->plan.estimate_us = 0;
  for (size_t i = 0; i < schedule->plan.stage_count; i++) {
    if (!schedule->plan_stages[i].included) continue;
    fill_items(world, &stages[i], &schedule->plan_stages[i]);
    schedule->plan.estimate_us += schedule->plan_stages[i].estimate_us;
  }
  return &schedule->plan;
}

/* The present meaning of automatic: the body's choice of a factor decides both solvers. */
static SporeChoice nonlinear_choice(const SporeWorld *world, const SporeBody *body, bool balances) {
  int kind = world->solver.nonlinear;
  if (balances) /* static has its own: see core/integrate/static.c */
    return (SporeChoice){spore_nonlinear_names[SPORE_NONLINEAR_NEWTON], SPORE_SOURCE_AUTOMATIC};
  if (kind != SPORE_NONLINEAR_AUTOMATIC) return (SporeChoice){spore_nonlinear_names[kind], SPORE_SOURCE_SCENE};
  kind = body->preconditioner.choice.factorised ? SPORE_NONLINEAR_BROYDEN : SPORE_NONLINEAR_NEWTON;
  return (SporeChoice){spore_nonlinear_names[kind], SPORE_SOURCE_AUTOMATIC};
}

static SporeChoice linear_choice(const SporeWorld *world, const SporeBody *body) {
  int factor = body->preconditioner.factor.band.block_count > 0 ? SPORE_LINEAR_BANDED : SPORE_LINEAR_CHOLESKY;
  int kind = body->preconditioner.choice.factorised ? factor : SPORE_LINEAR_CONJUGATE_GRADIENTS;
  bool open = world->solver.linear == SPORE_LINEAR_AUTOMATIC || kind != world->solver.linear;
  return (SporeChoice){spore_linear_names[kind], open ? SPORE_SOURCE_AUTOMATIC : SPORE_SOURCE_SCENE};
}

/* The body's margin and the widest of the others that have spheres, m. */
static double widest_margin(const SporeWorld *world, uint32_t index) {
  double widest = 0;
  for (uint32_t b = 0; b < world->body_count; b++)
    if (b != index && world->bodies[b].collision.spheres.point_count > 0)
      widest = fmax(widest, world->bodies[b].collision.fields.margin);
  return widest + world->bodies[index].collision.fields.margin;
}

bool spore_world_body_method(const SporeWorld *world, uint32_t index, SporeMethod *method) {
  const SporeBody *body = &world->bodies[index];
  if (!spore_body_is_physical(body)) return false;
  const SporeIntegrator *integrator = spore_integrator(body->method.integrator);
  *method = (SporeMethod){.integrator = {integrator->name, body->method.integrator_source},
                          .substeps = body->method.substeps,
                          .substeps_source = body->method.substeps_source,
                          .balances = spore_body_is_static(body) && spore_body_is_held(world, index)};
  if (body->method.integrator != body->method.chosen) method->integrator.source = SPORE_SOURCE_MONITOR;
  /* Islands are sorted anew by each step, so that sorting them changes nothing that is kept. */
  method->coupled = spore_body_coupled((SporeWorld *)(uintptr_t)world, index, &method->resolving);
  method->impacts = spore_body_impacts(world, index);
  if (method->coupled == SPORE_COUPLED_CONTACTS) method->margin = widest_margin(world, index);
  if (!integrator->implicit && method->coupled == SPORE_COUPLED_NEVER) return true;
  method->nonlinear = nonlinear_choice(world, body, method->balances);
  method->linear = linear_choice(world, body);
  return true;
}
