/* Makes a world from a description. All sizes are set and all input is checked here, so that a step does neither. */
#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/math/vector.h"
#include "core/sim/world_private.h"
#include "core/sim/solve/step_limit.h"

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
}

/* False where the making was cancelled; spore_world_create says so. */
static bool go_on(const SporeWorld *world) { return !spore_cancel_asked(world->cancel); }

static bool finite_all(const double *values, size_t count) {
  assert(count == 0 || values);
  for (size_t i = 0; i < count; i++)
    if (!isfinite(values[i])) return false;
  return true;
}

static bool fail(SporeError *error, const char *body, const char *text) {
  assert(body && text);
  char place[200];
  snprintf(place, sizeof place, "bodies/%s", body);
  return spore_error_set(error, SPORE_ERROR_INPUT, place, "%s", text);
}

static bool check_body(const SporeBodyDescription *body, SporeError *error) {
  const char *name = body->name ? body->name : "";
  if (!*name) return fail(error, name, _("a body has no name; expected one that is unique; give it a name"));
  if ((body->role == SPORE_PASSIVE) != (body->model != NULL))
    return fail(error, name, _("a passive body needs a mechanical model, and no other may have one; change the role"));
  const SporeQuat o = body->pose.orientation;
  if (!spore_vec3_is_finite(body->pose.position) || !spore_vec3_is_finite(body->velocity) ||
      !spore_vec3_is_finite(body->spin) || !isfinite(o.w + o.x + o.y + o.z))
    return fail(error, name, _("pose or velocity is not finite; expected numbers; correct the body's pose"));
  if (body->model && body->model->q_count > 6 * body->model->block_count)
    return fail(error, name, _("the model has more than 6 configuration values a block; this is a fault of the model"));
  if (body->model && (body->model->q_room < body->model->q_count || body->model->block_room < body->model->block_count))
    return fail(error, name, _("the model has less room than state; this is a fault of the model"));
  if (body->substeps > SPORE_SUBSTEPS_MAXIMUM)
    return fail(error, name, _("more than 1000 substeps; take a smaller time_step"));
  if (body->model && !spore_model_is_nodal(body->model) && !body->model->type->inertia)
    return fail(error, name, _("the model turns, but does not say its inertia; this is a fault of the model"));
  SporeError reason = SPORE_ERROR_INIT;
  if (!spore_parameters_check(&spore_contact_parameters, &body->contact, &reason))
    return fail(error, name, reason.message);
  return true;
}

static bool check_description(const SporeWorldDescription *description, SporeError *error) {
  if (!spore_parameters_check(&spore_solver_parameters, &description->solver, error)) {
    spore_error_at(error, "solver");
    return false;
  }
  if (!spore_vec3_is_finite(description->gravity))
    return spore_error_set(error, SPORE_ERROR_INPUT, "environment",
                           _("gravity is not finite; expected a vector in m/s^2; correct it"));
  for (size_t i = 0; i < description->body_count; i++)
    if (!check_body(&description->bodies[i], error)) return false;
  for (size_t i = 0; i < description->tool_count; i++) {
    const SporeToolDescription *tool = &description->tools[i];
    if (!spore_parameters_check(&tool->type->parameters, tool->fields, error)) return false;
  }
  for (size_t i = 0; i < description->emitter_count; i++)
    if (!spore_parameters_check(&spore_emitter_parameters, &description->emitters[i].fields, error)) return false;
  return true;
}

/* Most substeps that are chosen automatically. Contacts are found once a step. With more substeps, particles may
 * move so far that the next detection finds them deep inside others. */
#define SUBSTEPS_UNASKED 20

/* Chooses the integrator and the substeps that the scene leaves open, for a model that has rates and no Jacobian. An
 * implicit method requested by the scene has no Jacobian either, and needs steps as small as an explicit one. */
static void choose_steps(const SporeWorld *world, SporeBody *body, const SporeBodyDescription *from) {
  assert(body->model->type->rates);
  assert(world->solver.time_step > 0);
  if (from->integrator == SPORE_INTEGRATOR_DEFAULT && spore_integrator(body->method.integrator)->implicit) {
    body->method.integrator = body->method.chosen = SPORE_INTEGRATOR_VERLET;
    body->method.integrator_source = SPORE_SOURCE_AUTOMATIC;
  }
  if (from->substeps > 0) return;
  bool implicit = spore_integrator(body->method.integrator)->implicit;
  SporeStepLimit limit;
  if (!spore_step_limit(body->model, implicit ? SPORE_INTEGRATOR_VERLET : body->method.integrator, NULL, NULL, NULL, 0,
                        &limit, NULL))
    return;
  double needed = ceil(world->solver.time_step / limit.dt_s);
  if (needed <= (double)body->method.substeps) return;
  body->method.substeps = (size_t)fmin(needed, SUBSTEPS_UNASKED);
  body->method.substeps_source = SPORE_SOURCE_AUTOMATIC;
}

/* Sets offsets and names. The caller owns the models until the world is complete. */
static bool lay_out_body(SporeWorld *world, SporeBody *body, const SporeBodyDescription *from, SporeError *error) {
  assert((from->role == SPORE_PASSIVE) == (from->model != NULL));
  assert(!body->name);
  body->role = from->role;
  body->grade = SPORE_LOD_FINE;
  body->model = from->model;
  body->total_mass = from->model ? spore_model_total_mass(from->model) : 0;
  body->effect.on = body->effect.at_start = from->effect && from->model;
  body->collision.fields = from->contact;
  body->rest_pose = (SporePose){from->pose.position, spore_quat_normalise(from->pose.orientation)};
  body->method.integrator = body->method.chosen =
      from->integrator == SPORE_INTEGRATOR_DEFAULT ? (SporeIntegratorKind)world->solver.integrator : from->integrator;
  body->method.substeps = from->substeps > 0 ? from->substeps : (size_t)world->solver.substeps;
  body->method.integrator_source =
      from->integrator == SPORE_INTEGRATOR_DEFAULT ? SPORE_SOURCE_SCENE : SPORE_SOURCE_BODY;
  body->method.substeps_source = from->substeps > 0 ? SPORE_SOURCE_BODY : SPORE_SOURCE_SCENE;
  if (body->model && body->model->type->rates) choose_steps(world, body, from);
  body->q_offset = world->state.q_count;
  body->v_offset = world->state.v_count;
  body->q_count = from->model ? from->model->q_count : SPORE_POSE_Q;
  body->block_count = from->model ? from->model->block_count : SPORE_POSE_BLOCKS;
  body->name = spore_copy_text(from->name);
  if (!body->name) return no_memory(error);
  if (!spore_lod_make(world, body, from, error)) return false;
  body->q_most = body->lod ? body->lod->q_room : body->q_count;
  body->block_most = body->lod ? body->lod->v_room / 3 : body->block_count;
  bool roomy = from->model && !body->lod;
  world->state.q_count += roomy ? from->model->q_room : body->q_most;
  world->state.v_count += 3 * (roomy ? from->model->block_room : body->block_most);
  return true;
}

static void place_body(SporeWorld *world, const SporeBody *body, const SporeBodyDescription *from) {
  assert(body->q_offset + body->q_count <= world->state.q_count);
  assert(body->v_offset + 3 * body->block_count <= world->state.v_count);
  double *q = world->state.rest_q + body->q_offset, *v = world->state.rest_v + body->v_offset;
  if (body->model) {
    body->model->type->place(body->model, body->rest_pose, from->velocity, from->spin, q, v);
    return;
  }
  spore_vec3_store(q, body->rest_pose.position);
  spore_quat_store(q + 3, body->rest_pose.orientation);
}

static bool create_bodies(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  assert(description->body_count == 0 || description->bodies);
  if (!check_description(description, error) || !spore_world_reserve_nodes(description, error)) return false;
  size_t n = world->body_count = description->body_count;
  world->bodies = SPORE_NEW_ARRAY(SporeBody, n);
  world->state.sites = SPORE_NEW_ARRAY(SporeSite, n);
  if (!world->bodies || !world->state.sites) return no_memory(error);
  for (size_t i = 0; i < n; i++) {
    if (!lay_out_body(world, &world->bodies[i], &description->bodies[i], error)) return false;
    world->state.sites[i] = (SporeSite){world->bodies[i].q_offset, world->bodies[i].v_offset};
  }
  world->state.rest_q = SPORE_NEW_ARRAY(double, world->state.q_count);
  world->state.rest_v = SPORE_NEW_ARRAY(double, world->state.v_count);
  if (!world->state.rest_q || !world->state.rest_v) return no_memory(error);
  for (size_t i = 0; i < n; i++) {
    SporeBody *body = &world->bodies[i];
    if (!go_on(world) || !spore_body_create_matrix(body, error)) return false;
    place_body(world, body, &description->bodies[i]);
    if (!finite_all(world->state.rest_q + body->q_offset, body->q_count) ||
        !finite_all(world->state.rest_v + body->v_offset, 3 * body->block_count))
      return fail(error, body->name, _("the body cannot be placed: its state is not finite; check its mesh and pose"));
  }
  return true;
}

static bool is_unit(const double *q) { return fabs(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3] - 1) < 1e-6; }

/* Takes where a body begins, at its first level of detail. Spare nodes begin where the model puts them. */
static bool take_start(SporeWorld *world, uint32_t index, const SporeBodyDescription *from, SporeError *error) {
  SporeBody *body = &world->bodies[index];
  const SporeModel *model = spore_world_lod_model(world, index, spore_world_first_lod(world, index));
  const double *rest = body->lod ? body->lod->level[body->lod->first].rest_q : world->state.rest_q + body->q_offset;
  size_t count = model ? model->q_count : SPORE_POSE_Q, spare = model ? 3 * model->spare_count : 0;
  size_t turn = !model ? 3 : model->type->inertia ? 3 * model->node_count : SIZE_MAX;
  if (body->role == SPORE_UNMOVABLE || from->start_count + spare != count || !finite_all(from->start, count - spare) ||
      (turn != SIZE_MAX && !is_unit(from->start + turn)))
    return fail(error, body->name,
                _("what it is to begin with is not a state of this body; expected one that was kept of it; leave it "
                  "out"));
  body->start = SPORE_NEW_ARRAY(double, count);
  if (!body->start) return no_memory(error);
  memcpy(body->start, from->start, (count - spare) * sizeof *rest);
  memcpy(body->start + count - spare, rest + count - spare, spare * sizeof *rest);
  return true;
}

static bool take_starts(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  assert(description->body_count == world->body_count && !world->state.still);
  bool any = false;
  for (uint32_t b = 0; b < world->body_count; b++) {
    if (!description->bodies[b].start) continue;
    if (!take_start(world, b, &description->bodies[b], error)) return false;
    any = true;
  }
  if (any) world->state.still = SPORE_NEW_ARRAY(double, world->state.v_count);
  return !any || world->state.still || no_memory(error);
}

/* Appends the spheres of the unmovable bodies, or of all other bodies. */
static bool add_spheres(SporeWorld *world, const SporeWorldDescription *description, bool unmovable,
                        SporeError *error) {
  assert(description->body_count == world->body_count);
  SporeSpheres *all = &world->contact.spheres;
  for (size_t i = 0; i < world->body_count; i++) {
    SporeBody *body = &world->bodies[i];
    const SporeSphereSet *set = description->bodies[i].spheres;
    if ((body->role == SPORE_UNMOVABLE) != unmovable) continue;
    body->collision.start = all->count;
    if (!go_on(world) || !spore_body_map_spheres(world, (uint32_t)i, set, error)) return false;
    assert(body->collision.spheres.point_count == (set ? set->count : 0));
    if (set && !spore_spheres_radii(set, all->radius + all->count, 1)) return no_memory(error);
    for (size_t s = 0; set && s < set->count; s++) all->body[all->count + s] = (uint32_t)i;
    spore_mapping_positions(&body->collision.spheres, world->state.rest_q + body->q_offset,
                            all->centre + 3 * all->count);
    all->count += body->collision.spheres.point_count;
  }
  return true;
}

static SporeGridBody grid_body(const SporeBody *body) {
  return (SporeGridBody){.passive = body->role == SPORE_PASSIVE,
                         .active = body->role == SPORE_ACTIVE,
                         .self = body->collision.fields.self,
                         .soft = body->role == SPORE_PASSIVE && !spore_model_is_rigid(body->model),
                         .group = (uint32_t)body->collision.fields.group};
}

static bool make_grid(SporeWorld *world, SporeError *error) {
  assert(world->contact.reach && !world->contact.grid);
  SporeGridBody *bodies = SPORE_NEW_ARRAY(SporeGridBody, world->body_count);
  if (!bodies) return no_memory(error);
  size_t with = 0; /* bodies with spheres: only these can need a grid */
  for (size_t i = 0; i < world->body_count; i++)
    if (world->bodies[i].collision.spheres.point_count > 0) bodies[with++] = grid_body(&world->bodies[i]);
  bool needed = spore_grid_body_pairs(bodies, with) > 0 || (world->schedule.unpruned && with > 0);
  for (size_t i = 0; i < world->body_count; i++) bodies[i] = grid_body(&world->bodies[i]);
  SporeSpheres reaching = world->contact.spheres;
  reaching.radius = world->contact.reach;
  if (needed) world->contact.grid = spore_grid_create(&reaching, bodies, world->body_count, 0, error);
  spore_free(bodies);
  if (!needed) return true;
  if (world->contact.grid) return spore_world_reserve_contacts(world) || no_memory(error);
  return false;
}

static bool create_spheres(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  assert(world->contact.spheres.count == 0);
  size_t count = 0;
  for (size_t i = 0; i < description->body_count; i++)
    count += description->bodies[i].spheres ? description->bodies[i].spheres->count : 0;
  SporeSpheres *all = &world->contact.spheres;
  all->centre = SPORE_NEW_ARRAY(double, 3 * count);
  all->before = SPORE_NEW_ARRAY(double, 3 * count);
  all->velocity = SPORE_NEW_ARRAY(double, 3 * count);
  all->radius = SPORE_NEW_ARRAY(double, count);
  all->body = SPORE_NEW_ARRAY(uint32_t, count);
  if (!all->centre || !all->before || !all->velocity || !all->radius || !all->body) return no_memory(error);
  if (!add_spheres(world, description, true, error)) return false;
  if (!world->schedule.unpruned) all->static_count = all->count;
  memcpy(all->before, all->centre, 3 * all->count * sizeof *all->centre);
  return add_spheres(world, description, false, error) && spore_world_create_fields(world, description, error) &&
         make_grid(world, error);
}

static bool allocate_vectors(SporeWorld *world, SporeError *error) {
  assert(world->state.v_count % 3 == 0);
  SporeState *state = &world->state;
  size_t bodies = world->body_count, q = state->q_count, v = state->v_count;
  state->target_q = SPORE_NEW_ARRAY(double, q);
  state->mass = SPORE_NEW_ARRAY(double, 3 * v);
  state->mass_inverse = SPORE_NEW_ARRAY(double, 3 * v);
  state->reaction = SPORE_NEW_ARRAY(double, 6 * bodies);
  world->contact.frames = SPORE_NEW_ARRAY(double, SPORE_FRAME_DOUBLES *bodies);
  world->commands.ring = SPORE_NEW_ARRAY(SporeCommand, SPORE_COMMAND_CAPACITY);
  bool made = state->target_q && state->mass && state->mass_inverse && state->reaction && world->contact.frames &&
              world->commands.ring && spore_world_create_unsolved(world) && spore_world_create_solve(world);
  return made || no_memory(error);
}

/* An effect has no limit on the step. Where physics has one, the body stays an effect. */
static bool check_step(SporeWorld *world, uint32_t index, SporeError *error) {
  SporeBodyEffect *effect = &world->bodies[index].effect;
  SporeError ignored = SPORE_ERROR_INIT;
  bool short_enough = spore_body_check_step(world, index, effect->on ? &ignored : error);
  effect->too_long |= !short_enough;
  return short_enough || effect->on;
}

/* Checks the time step for each body at each of its levels of detail. */
static bool check_steps(SporeWorld *world, SporeError *error) {
  assert(world->state.rest_q && world->state.rest_v);
  for (uint32_t b = 0; b < world->body_count; b++)
    for (int level = 0; level < SPORE_LOD_COUNT; level++) {
      if (!spore_world_lod_model(world, b, (SporeLodGrade)level)) continue;
      spore_world_select_lod(world, b, (SporeLodGrade)level);
      if (!check_step(world, b, error)) return false;
    }
  return true;
}

/* Frees the unfinished world. The caller keeps the models. */
static SporeWorld *give_up(SporeWorld *world) {
  for (size_t i = 0; world->bodies && i < world->body_count; i++) {
    spore_lod_give_up(&world->bodies[i]);
    world->bodies[i].model = NULL;
  }
  spore_world_free(world);
  return NULL;
}

static SporeWorld *give_up_cancelled(SporeWorld *world, SporeError *error) {
  spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
  return give_up(world);
}

typedef struct Preparation {
  const SporeCancel *cancel;
  bool made;
} Preparation;

static void prepare_sweep(SporeModel *model, void *user) {
  Preparation *preparation = user;
  if (model->type->sweep)
    preparation->made = preparation->made && model->type->sweep->prepare(model, preparation->cancel);
}

static bool prepare_sweeps(const SporeWorld *world) {
  Preparation preparation = {world->cancel, true};
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].role == SPORE_PASSIVE && spore_integrator(world->bodies[b].method.chosen)->sweeps)
      spore_body_each_model(&world->bodies[b], prepare_sweep, &preparation);
  return preparation.made;
}

/* Sweeps each body once where it begins and lets go what comes out, so that what a sweep keeps for a step of its size
 * is there before the first one. */
static void rehearse_sweeps(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (!spore_body_moves(body) || !spore_body_sweeps(body)) continue;
    const SporeModelSweep *sweep = body->model->type->sweep;
    const double *q = world->state.q + body->q_offset, *still = world->state.v + body->v_offset;
    double *rows = world->solve.scratch, h = world->solver.time_step / (double)body->method.substeps;
    SporeRowsStep at = {sweep->part(body->model), h, q, still, NULL, (double *)still};
    spore_rows_predict(body->block_count, rows, &at, body->model->block_mass);
    for (size_t k = 0; k < body->held.count; k++) rows[4 * (size_t)body->held.blocks[k] + 3] = 0;
    sweep->sweep(body->model, &(SporeSweep){.h = at.part * h, .before = q, .now = rows, .cancel = world->cancel});
  }
}

static void set_pool(SporeModel *model, void *pool) { model->pool = pool; }

SporeWorld *spore_world_create(const SporeWorldDescription *description, SporePool *pool, SporeError *error) {
  assert(description);
  assert(description->tool_count == 0 || description->tools);
  assert(description->emitter_count == 0 || description->emitters);
  SporeWorld *world = SPORE_NEW(SporeWorld);
  if (!world) {
    no_memory(error);
    return NULL;
  }
  world->pool = pool;
  world->cancel = description->cancel;
  world->solver = description->solver;
  world->schedule.unpruned = description->unpruned;
  if (description->unpruned) world->solver.sleep_speed = 0;
  world->state.gravity = description->gravity;
  world->schedule.profile.name = "step";
  world->links.hold_count = spore_tools_spring_count(description);
  bool made =
      create_bodies(world, description, error) && create_spheres(world, description, error) && go_on(world) &&
      spore_world_create_links(world, description, error) && spore_world_create_tools(world, description, error) &&
      spore_world_create_particles(world, description, error) && spore_world_create_effects(world, error) &&
      ((spore_world_create_stains(world, description) && spore_world_create_lenses(world, description)) ||
       no_memory(error)) &&
      go_on(world) &&
      ((spore_world_create_refinement(world) && spore_world_create_coupled_rooms(world) && prepare_sweeps(world)) ||
       no_memory(error)) &&
      spore_world_create_factors(world, error) && go_on(world) && spore_world_create_lod(world, description, error) &&
      spore_lod_create_automation(world, description, error) && take_starts(world, description, error) &&
      allocate_vectors(world, error) && go_on(world) && check_steps(world, error);
  if (spore_cancel_asked(world->cancel)) return give_up_cancelled(world, error);
  if (!made) return give_up(world);
  if (!spore_snapshots_init(world)) {
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the snapshots"));
    return give_up(world);
  }
  for (size_t b = 0; b < world->body_count; b++) spore_body_each_model(&world->bodies[b], set_pool, pool);
  spore_world_create_sleep(world);
  spore_world_make_plan(world);
  spore_world_reset(world);
  rehearse_sweeps(world);
  return spore_cancel_asked(world->cancel) ? give_up_cancelled(world, error) : world;
}
