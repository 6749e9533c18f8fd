#include "core/sim/world.h"

#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/constraint/pin.h"
#include "core/sim/levels.h"

static void clear_body(SporeBody *body) {
  spore_free(body->name);
  spore_mapping_clear(&body->spheres);
  spore_depth_field_clear(&body->field);
  spore_free(body->held);
  spore_free(body->whole_weight);
  spore_block_matrix_clear(&body->matrix);
  spore_block_cholesky_clear(&body->factor);
  spore_free(body->held_flags);
  if (body->levels) spore_levels_free(body);
  else if (body->model) body->model->type->destroy(body->model);
}

static void clear_commands(SporeCommands *commands) {
  size_t written = atomic_load(&commands->written);
  for (size_t i = atomic_load(&commands->applied); i != written; i++)
    spore_free(commands->ring[i % SPORE_COMMAND_CAPACITY].fields);
  spore_free(commands->ring);
}

static void free_arrays(SporeWorld *world) {
  void *arrays[] = {world->rest_q,
                    world->rest_v,
                    world->world_sites,
                    world->target_q,
                    world->mass,
                    world->mass_inverse,
                    world->spheres.centre,
                    world->spheres.velocity,
                    world->spheres.radius,
                    world->spheres.body,
                    world->reaction,
                    world->contacts,
                    world->links,
                    world->cuts.edges,
                    world->cuts.corners,
                    world->hangs,
                    world->lines.breaks,
                    world->lines.span_count,
                    world->emitters,
                    world->ports,
                    world->springs,
                    world->spring_active,
                    world->contact_couplings,
                    world->contact_lanes,
                    world->frames,
                    world->spring_couplings,
                    world->parent,
                    world->island_of,
                    world->island_bodies,
                    world->islands,
                    world->grips,
                    world->felt,
                    world->reach,
                    world->kept_grips,
                    world->contact_order,
                    world->spring_order,
                    world->local_sites,
                    world->local_q0,
                    world->local_v0,
                    world->local_q1,
                    world->local_v1,
                    world->best_q,
                    world->best_v,
                    world->scratch,
                    world->precondition,
                    world->still,
                    world->history_a,
                    world->history_b,
                    world->local_history_a,
                    world->local_history_b};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++) spore_free(arrays[i]);
}

void spore_world_free(SporeWorld *world) {
  if (!world) return;
  for (size_t i = 0; world->spring_mappings && i < 2 * spore_world_spring_count(world); i++)
    spore_mapping_clear(&world->spring_mappings[i]);
  spore_free(world->spring_mappings);
  spore_world_clear_tools(world);
  spore_world_clear_division(world);
  for (size_t i = 0; world->links && i < world->link_count; i++) spore_free(world->links[i].name);
  for (size_t i = 0; world->bodies && i < world->body_count; i++) clear_body(&world->bodies[i]);
  spore_free(world->bodies);
  spore_grid_free(world->grid);
  spore_snapshots_clear(&world->snapshots);
  clear_commands(&world->commands);
  free_arrays(world);
  spore_free(world);
}

/* The models go back to the caller. */
static SporeWorld *give_up(SporeWorld *world) {
  for (size_t i = 0; world->bodies && i < world->body_count; i++) {
    spore_levels_give_up(&world->bodies[i]);
    world->bodies[i].model = NULL;
  }
  spore_world_free(world);
  return NULL;
}

static void set_pool(SporeModel *model, void *pool) { model->pool = pool; }

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the world"));
}

SporeWorld *spore_world_create(const SporeWorldDescription *description, SporePool *pool, SporeError *error) {
  SporeWorld *world = SPORE_NEW(SporeWorld);
  if (!world) {
    no_memory(error);
    return NULL;
  }
  world->pool = pool;
  world->solver = description->solver;
  world->gravity = description->gravity;
  world->profile.name = "step";
  bool made =
      spore_world_compile_bodies(world, description, error) && spore_world_compile_spheres(world, description, error) &&
      spore_world_compile_links(world, description, error) && spore_world_compile_tools(world, description, error) &&
      spore_world_compile_particles(world, description, error) &&
      (spore_world_compile_knots(world) || no_memory(error)) && spore_world_compile_factors(world, error) &&
      spore_world_compile_levels(world, description, error) && spore_world_allocate_vectors(world, error) &&
      spore_world_check_step(world, error);
  if (!made) return give_up(world);
  if (!spore_snapshots_init(world)) {
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the snapshots"));
    return give_up(world);
  }
  for (size_t b = 0; b < world->body_count; b++) spore_body_each_model(&world->bodies[b], set_pool, pool);
  spore_world_compile_sleep(world);
  spore_world_make_plan(world);
  spore_world_reset(world);
  return world;
}

void spore_world_step(SporeWorld *world) { spore_world_run_plan(world); }

static void reset_body(SporeWorld *world, SporeBody *body) {
  body->integrator = body->chosen;
  body->told_deep = body->told_soft = body->altered = false;
  body->soft_since = body->soft_last = 0;
  body->frozen = false;
  body->rest_steps = 0;
  body->told = SPORE_TROUBLE_NONE;
  body->noticed = false;
  spore_body_forget_steps(world, body);
  body->has_input = false;
  body->command = (SporeDeviceCommand){0};
  spore_guard_start(&body->guard, 0, body->rest_pose);
  body->passivity = (SporePassivity){0};
  if (body->model) spore_body_set_mass(world, body);
  if (body->model && body->model->type->forget) body->model->type->forget(body->model);
}

void spore_world_reset(SporeWorld *world) {
  spore_world_wake_all(world);
  spore_world_mend_bodies(world);
  spore_world_reset_levels(world);
  spore_world_mend_knots(world);
  memcpy(world->next_q, world->rest_q, world->q_count * sizeof *world->q);
  memcpy(world->next_v, world->rest_v, world->v_count * sizeof *world->v);
  for (size_t b = 0; b < world->body_count; b++) spore_body_mark_changed(world, &world->bodies[b]);
  spore_world_advance_state(world);
  memcpy(world->target_q, world->rest_q, world->q_count * sizeof *world->q);
  memset(world->reaction, 0, 6 * world->body_count * sizeof *world->reaction);
  for (size_t b = 0; b < world->body_count; b++) spore_world_release(world, (uint32_t)b);
  spore_world_mend_links(world);
  spore_world_reset_tools(world);
  spore_world_mend_division(world);
  spore_world_reset_particles(world);
  world->step = 0;
  world->contact_count = world->grip_count = 0;
  world->counts = (SporeStepCounts){0};
  world->step_us = 0;
  for (size_t b = 0; b < world->body_count; b++) reset_body(world, &world->bodies[b]);
  SporeMonitor *monitor = &world->monitor;
  monitor->recoveries = monitor->substeps = monitor->not_finite = monitor->too_fast = monitor->energy = 0;
  monitor->not_converged = monitor->deep_contacts = monitor->soft_contacts = monitor->over_budget =
      monitor->held_inputs = monitor->shortened_forces = monitor->broken_links = monitor->lost_holds =
          monitor->torn_springs = 0;
  spore_world_map_spheres(world);
  spore_world_link(world);
  spore_snapshot_publish(world);
}

void spore_world_set_state(SporeWorld *world, uint32_t index, const double *q, const double *v) {
  SporeBody *body = &world->bodies[index];
  spore_world_wake_all(world);
  memcpy(world->next_q + body->q_offset, q, body->q_count * sizeof *q);
  memcpy(world->target_q + body->q_offset, q, body->q_count * sizeof *q);
  memcpy(world->next_v + body->v_offset, v, 3 * body->block_count * sizeof *v);
  if (body->parking_gap > 0) spore_body_find_parked(body, q);
  spore_pin_filter(body->held, body->held_count, world->next_v + body->v_offset);
  spore_body_mark_changed(world, body);
  spore_world_advance_state(world);
  spore_body_forget_steps(world, body);
  if (body->model && body->model->type->forget) body->model->type->forget(body->model);
  world->contact_count = world->grip_count = 0; /* they belong to the state before */
  spore_world_lose_rails(world);
  if (body->model) spore_body_set_mass(world, body);
  spore_world_map_spheres(world);
  spore_world_link(world);
  spore_snapshot_publish(world);
}

void spore_world_set_budget(SporeWorld *world, double budget_us) { world->budget_us = budget_us; }

void spore_world_set_device(SporeWorld *world, uint32_t body, SporeDevice *device) {
  if (body < world->body_count) world->bodies[body].device = device;
}

const SporeDeviceState *spore_world_input(const SporeWorld *world, uint32_t index, double *time_s) {
  const SporeBody *body = &world->bodies[index];
  if (!body->has_input) return NULL;
  *time_s = body->input_time_s;
  return &body->input;
}

size_t spore_world_body_count(const SporeWorld *world) { return world->body_count; }

uint32_t spore_world_find_body(const SporeWorld *world, const char *name) {
  for (uint32_t b = 0; b < world->body_count; b++)
    if (!strcmp(world->bodies[b].name, name)) return b;
  return SPORE_NO_BODY;
}

const char *spore_world_body_name(const SporeWorld *world, uint32_t body) { return world->bodies[body].name; }
SporeRole spore_world_body_role(const SporeWorld *world, uint32_t body) { return world->bodies[body].role; }
uint32_t spore_world_hand(const SporeWorld *world, uint32_t body) {
  if (world->bodies[body].role != SPORE_ACTIVE) return SPORE_NO_BODY;
  for (size_t i = 0; i < world->tool_count; i++)
    for (int side = 0; side < 2; side++)
      if (world->tools[i].jaws[side].body == body) return world->tools[i].body;
  return body;
}
const SporeModel *spore_world_body_model(const SporeWorld *world, uint32_t body) { return world->bodies[body].model; }
bool spore_world_body_made_safer(const SporeWorld *world, uint32_t body) {
  return world->bodies[body].integrator != world->bodies[body].chosen;
}
bool spore_world_body_frozen(const SporeWorld *world, uint32_t body) { return world->bodies[body].frozen; }
bool spore_world_body_asleep(const SporeWorld *world, uint32_t body) { return world->bodies[body].asleep; }
uint64_t spore_world_step_count(const SporeWorld *world) { return world->step; }
double spore_world_time_s(const SporeWorld *world) { return (double)world->step * world->solver.time_step; }
const SporeSpheres *spore_world_spheres(const SporeWorld *world) { return &world->spheres; }
size_t spore_world_body_sphere_count(const SporeWorld *world, uint32_t body) {
  return world->bodies[body].spheres.point_count;
}
size_t spore_world_dof(const SporeWorld *world) { return world->dof; }
size_t spore_world_q_offset(const SporeWorld *world, uint32_t body) { return world->bodies[body].q_offset; }
size_t spore_world_corner_start(const SporeWorld *world, uint32_t body) {
  const SporeDivision *division = &world->bodies[body].division;
  return division->possible ? division->corner_start : SIZE_MAX;
}
size_t spore_world_v_offset(const SporeWorld *world, uint32_t body) { return world->bodies[body].v_offset; }
const double *spore_world_q(const SporeWorld *world, uint32_t body) { return world->q + world->bodies[body].q_offset; }
const double *spore_world_v(const SporeWorld *world, uint32_t body) { return world->v + world->bodies[body].v_offset; }
const SporeProfilePhase *spore_world_profile(const SporeWorld *world) { return &world->profile; }
const SporeMonitor *spore_world_monitor(const SporeWorld *world) { return &world->monitor; }
SporeStepCounts spore_world_counts(const SporeWorld *world) { return world->counts; }

/* Points of an unmovable body stand where its pose puts them. */
static bool map_fixed(const SporeBody *body, const double *points, size_t count, SporeMapping *mapping,
                      SporeError *error) {
  if (!spore_mapping_init_points(mapping, SPORE_MAPPING_FIXED, points, count, error)) return false;
  for (size_t i = 0; i < count; i++)
    spore_vec3_store(mapping->points + 3 * i, spore_pose_apply(body->rest_pose, spore_vec3_load(points + 3 * i)));
  return true;
}

bool spore_world_map_level(const SporeWorld *world, uint32_t index, SporeLevelGrade level, const double *points,
                           size_t count, SporeMapping *mapping, SporeError *error) {
  const SporeBody *body = &world->bodies[index];
  const SporeModel *model = spore_world_level_model(world, index, level);
  if (body->role == SPORE_UNMOVABLE) return map_fixed(body, points, count, mapping, error);
  if (body->role == SPORE_ACTIVE) return spore_mapping_init_points(mapping, SPORE_MAPPING_RIGID, points, count, error);
  return model->type->map(model, points, count, mapping, error);
}

bool spore_world_map_drawn(const SporeWorld *world, uint32_t body, SporeLevelGrade level, const SporeTriangleMesh *mesh,
                           SporeMapping *mapping, SporeError *error) {
  const SporeModel *model = spore_world_level_model(world, body, level);
  if (world->bodies[body].role == SPORE_PASSIVE && model->type->carry)
    return model->type->carry(model, mesh, mapping, error);
  return spore_world_map_level(world, body, level, mesh->vertices, mesh->vertex_count, mapping, error);
}

bool spore_world_map(const SporeWorld *world, uint32_t body, const double *points, size_t count, SporeMapping *mapping,
                     SporeError *error) {
  return spore_world_map_level(world, body, world->bodies[body].level, points, count, mapping, error);
}
