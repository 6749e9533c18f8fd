/* Island system: forces of the models and of the terms of an island, and its motion, for the integrators. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/sim/solve/island_system.h"

static void add_body_forces(const SporeIslandSystem *system, const double *q, const double *v, double *f) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    const double *shape = (system->shape ? system->shape : q) + site->q;
    if (spore_island_system_leaves(system, body)) continue;
    const SporeModelType *type = body->model->type;
    bool still = spore_body_is_static(body);
    bool met = system->sweeping && spore_model_sweeps(body->model);
    if (!met && type->force_along && system->shape_s > 0 && !still)
      type->force_along(body->model, q + site->q, shape, v + site->v, system->shape_s, f + site->v);
    else if (!met)
      type->force(body->model, q + site->q, shape, still ? system->world->solve.still : v + site->v, f + site->v);
    double gravity[3];
    spore_vec3_store(gravity, spore_body_gravity(system->world, body));
    spore_nodes_pull(body->block_count, f + site->v, body->model->block_mass, gravity);
  }
}

static void add_term_forces(const SporeIslandSystem *system, const double *q, const double *v, double *f) {
  spore_island_system_add_contact_forces(system, q, v, f);
  for (size_t i = 0; i < system->island->spring_count; i++)
    spore_spring_term_force(spore_island_system_spring(system, i), system->world->solve.local_sites, q, v, f);
}

static void set_shape(void *data, const double *shape, double h) {
  SporeIslandSystem *system = data;
  system->shape = shape;
  system->shape_s = h;
}

static void start_forces(const SporeIslandSystem *system, double *f) {
  if (system->given) memcpy(f, system->given, system->island->v_count * sizeof *f);
  else memset(f, 0, system->island->v_count * sizeof *f);
}

static void force(void *data, const double *q, const double *v, double *f) {
  SporeIslandSystem *system = data;
  start_forces(system, f);
  add_body_forces(system, q, v, f);
  add_term_forces(system, q, v, f);
  spore_island_system_filter(system, f);
}

static void loose_force(void *data, const double *q, const double *v, double *f) {
  SporeIslandSystem *system = data;
  system->sweeping = true;
  force(data, q, v, f);
  system->sweeping = false;
}

/* What a sweep moves of a body, from where it was to where other forces led; NULL: the body is moved by these alone. */
static double *rows_of(const SporeIslandSystem *system, size_t b, SporeRowsStep *step, double *rows) {
  const SporeSite *site;
  if (!spore_model_sweeps(spore_island_system_body(system, b, &site)->model)) return NULL;
  step->x0 += site->q, step->v0 += site->v, step->x1 += site->q, step->v1 += site->v;
  return rows + 4 * (site->v / 3);
}

static double part_of(const SporeIslandSystem *system) {
  double part = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeModel *model = spore_island_system_body(system, b, &site)->model;
    if (spore_model_sweeps(model)) part = fmax(part, model->type->sweep->part(model));
  }
  return part;
}

static void sweep(void *data, double h, const double *q0, const double *v0, double *q1, double *v1, double *rows) {
  SporeIslandSystem *system = data;
  const double part = part_of(system);
  const SporeRowsStep whole = {part, h, q0, v0, q1, v1};
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    SporeRowsStep step = whole;
    double *now = rows_of(system, b, &step, rows);
    if (!now) continue;
    spore_rows_predict(body->block_count, now, &step, body->model->block_mass);
    for (size_t k = 0; k < body->held.count; k++) now[4 * (size_t)body->held.blocks[k] + 3] = 0;
    body->model->type->sweep->sweep(
        body->model, &(SporeSweep){.h = part * h, .before = step.x0, .now = now, .cancel = system->world->cancel});
  }
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeRowsStep step = whole;
    const double *now = rows_of(system, b, &step, rows);
    if (now) spore_rows_follow(spore_island_system_body(system, b, &site)->block_count, now, &step);
  }
  if (system->meets)
    spore_island_system_meet_contacts(system,
                                      &(SporeContactSweep){.h = h, .before = q0, .q = q1, .v = v1, .rows = rows});
}

static void body_force(void *data, const double *q, const double *v, double *f) {
  SporeIslandSystem *system = data;
  start_forces(system, f);
  add_body_forces(system, q, v, f);
  spore_island_system_filter(system, f);
}

/* Counts a term at each block that moves the end; counts: a double for each block. */
static void count_end(const SporeWorld *world, const SporeEnd *end, double *counts) {
  assert(end->prescribed || end->body < world->body_count);
  assert(end->prescribed || end->point < end->mapping->point_count);
  if (end->prescribed) return;
  double *local = counts + world->solve.local_sites[end->body].v / 3;
  const SporeMapping *mapping = end->mapping;
  if (mapping->kind == SPORE_MAPPING_IDENTITY) local[end->point]++;
  if (mapping->kind == SPORE_MAPPING_RIGID) local[0]++;
  if (mapping->kind != SPORE_MAPPING_LINEAR) return;
  for (uint32_t k = mapping->row_start[end->point]; k < mapping->row_start[end->point + 1]; k++)
    local[mapping->block[k]]++;
}

/* c . A c */
static double quadratic(const double *a, SporeVec3 c) {
  return c.x * (a[0] * c.x + a[1] * c.y + a[2] * c.z) + c.y * (a[3] * c.x + a[4] * c.y + a[5] * c.z) +
         c.z * (a[6] * c.x + a[7] * c.y + a[8] * c.z);
}

/* Sum of n/m over the blocks that move the end, n the number of terms at the block. The force may have any direction
 * and act up to `arm` away from the end. With `normal` the force acts along that line, and turns a body only by the
 * distance of the line from the centre of mass. */
static double end_inverse_mass(const SporeWorld *world, const SporeEnd *end, SporeVec3 arm, const SporeVec3 *normal,
                               const double *counts) {
  assert(end->prescribed || end->body < world->body_count);
  if (end->prescribed) return 0;
  const double *local = counts + world->solve.local_sites[end->body].v / 3;
  const SporeBody *body = &world->bodies[end->body];
  const double *inverse = world->state.mass_inverse + 3 * body->v_offset;
  const SporeMapping *mapping = end->mapping;
  if (mapping->kind == SPORE_MAPPING_IDENTITY) return local[end->point] * inverse[9 * (size_t)end->point];
  if (mapping->kind == SPORE_MAPPING_RIGID) {
    SporeVec3 centre = spore_vec3_sub(end->position, spore_vec3_load(world->state.q + body->q_offset));
    SporeVec3 point = spore_vec3_add(centre, arm);
    if (normal) return local[0] * (inverse[0] + quadratic(inverse + 9, spore_vec3_cross(point, *normal)));
    double lever = spore_vec3_length(centre) + spore_vec3_length(arm);
    return local[0] * (inverse[0] + lever * lever * (inverse[9] + inverse[13] + inverse[17]));
  }
  double sum = 0;
  for (uint32_t k = mapping->row_start[end->point]; k < mapping->row_start[end->point + 1]; k++)
    sum += mapping->weight[k] * mapping->weight[k] * local[mapping->block[k]] * inverse[9 * (size_t)mapping->block[k]];
  return sum;
}

static void count_terms(const SporeIslandSystem *system, double *counts) {
  const SporeWorld *world = system->world;
  memset(counts, 0, system->island->v_count / 3 * sizeof *counts);
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    count_end(world, &term->a, counts);
    count_end(world, &term->b, counts);
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    count_end(world, &term->a, counts);
    count_end(world, &term->b, counts);
  }
}

/* Without friction a contact pushes along its normal alone. */
static double contact_inverse_mass(const SporeWorld *world, const SporeContactTerm *term, const double *counts) {
  const SporeVec3 *normal = term->law.friction > 0 ? NULL : &term->normal;
  return end_inverse_mass(world, &term->a, term->arm_a, normal, counts) +
         end_inverse_mass(world, &term->b, term->arm_b, normal, counts);
}

/* A step of h seconds resolves a term well whose h^2 w k + h w d is no more than this. */
#define RESOLVED 0.25

/* Explicit Euler resolves only what is well damped, since it feeds energy into all else that swings. */
static bool resolves(const SporeIslandSystem *system, double h, double inverse_mass, double stiffness, double damping) {
  assert(h > 0 && inverse_mass >= 0);
  if (system->island->integrator == SPORE_INTEGRATOR_EXPLICIT_EULER && h * stiffness > damping) return false;
  return h * inverse_mass * (h * stiffness + damping) <= RESOLVED;
}

/* A contact is found where the step begins, as deep as its bodies came in the one before: no substep makes that less.
 */
static bool resolves_contacts(const SporeIslandSystem *system, double h, size_t substeps, const double *counts) {
  assert(substeps >= 1);
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    double inverse_mass = contact_inverse_mass(system->world, term, counts);
    if (!resolves(system, h, inverse_mass, term->law.stiffness, term->law.damping / (double)substeps)) return false;
  }
  return true;
}

static bool resolves_springs(const SporeIslandSystem *system, double h, const double *counts) {
  const SporeVec3 none = {0, 0, 0};
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    double inverse_mass = end_inverse_mass(system->world, &term->a, none, NULL, counts) +
                          end_inverse_mass(system->world, &term->b, none, NULL, counts);
    if (!resolves(system, h, inverse_mass, term->law.stiffness, term->law.damping)) return false;
  }
  return true;
}

double spore_island_system_short_step(const SporeIslandSystem *system, double part) {
  assert(part > 0 && system->island->spring_count == 0);
  double *counts = spore_island_system_precondition_blocks(system), step = HUGE_VAL; /* free: no matrix is made yet */
  count_terms(system, counts);
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    double inverse_mass = contact_inverse_mass(system->world, term, counts);
    double stiffness = inverse_mass * term->law.stiffness, damping = inverse_mass * term->law.damping;
    step = fmin(step, part / sqrt(stiffness + damping * damping));
  }
  return isfinite(step) ? step : 0;
}

bool spore_island_system_resolves(const SporeIslandSystem *system, double h, size_t substeps, bool links) {
  assert(h > 0 && substeps >= 1);
  if (system->island->contact_count + (links ? system->island->spring_count : 0) == 0) return true;
  double *counts = spore_island_system_precondition_blocks(system); /* free: no matrix is made yet */
  count_terms(system, counts);
  return (system->meets || resolves_contacts(system, h, substeps, counts)) &&
         (!links || resolves_springs(system, h / (double)substeps, counts));
}

static void term_force(void *data, const double *q, const double *v, double *f) {
  SporeIslandSystem *system = data;
  add_term_forces(system, q, v, f);
  spore_island_system_filter(system, f);
}

static void move_end(SporeEnd *end, double elapsed_s) {
  if (end->prescribed) end->offset = spore_vec3_scale(elapsed_s, end->velocity);
}

static void set_time(void *data, double elapsed_s) {
  SporeIslandSystem *system = data;
  double at_s = system->start_s + elapsed_s;
  if (at_s == system->now_s) return;
  system->now_s = at_s;
  if (!system->driven) return;
  for (size_t i = 0; i < system->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(system, i);
    move_end(&term->a, at_s);
    move_end(&term->b, at_s);
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    SporeSpringTerm *term = spore_island_system_spring(system, i);
    move_end(&term->a, at_s);
    move_end(&term->b, at_s);
  }
}

static void take_tangent(void *data, SporeTangentForm form) { ((SporeIslandSystem *)data)->tangent = form; }

static void set_mass(void *data, const double *q) {
  SporeIslandSystem *system = data;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    spore_body_turn_mass(system->world, body, q + site->q);
  }
}

static void kick(void *data, const double *f, double h, double *v) {
  SporeIslandSystem *system = data;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    /* A rigid body's single node comes with its frame. */
    size_t nodes = spore_model_is_rigid(body->model) ? 0 : body->model->node_count;
    spore_nodes_kick(nodes, v + site->v, h, f + site->v, body->model->block_mass);
    spore_blocks_add(system->world->state.mass_inverse + 3 * body->v_offset + 9 * nodes, body->block_count - nodes, h,
                     f + site->v + 3 * nodes, v + site->v + 3 * nodes);
  }
  spore_island_system_filter(system, v);
}

void spore_body_drift(const SporeBody *body, const double *q0, const double *v, double h, double *q1, double *v1) {
  assert(body->model && q0 && v && q1 && v1);
  if (body->model->type->drift) {
    body->model->type->drift(body->model, q0, v, h, q1, v1);
    return;
  }
  spore_vector_move(body->q_count, q1, q0, h, v);
  if (v1 != v) memcpy(v1, v, body->q_count * sizeof *v);
}

static void drift(void *data, const double *q0, const double *v, double h, double *q1, double *v1) {
  SporeIslandSystem *system = data;
  system->drift_s = fmax(system->drift_s, h);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    spore_body_drift(body, q0 + site->q, v + site->v, h, q1 + site->q, v1 + site->v);
  }
}

/* For a frame, whose inertia turns with it: adds the same change of angular momentum. */
static void carry_turning(const SporeIslandSystem *system, const SporeBody *body, const double *dv, const double *q1,
                          double *v1) {
  assert(body->block_count == body->model->node_count + 1);
  size_t at = body->model->node_count;
  double momentum[3];
  spore_blocks_apply(spore_island_system_mass(system, body) + 9 * at, 1, dv + 3 * at, momentum);
  SporeMat3 inertia = body->model->type->inertia(body->model, q1);
  spore_blocks_invert(inertia.m, 1);
  spore_blocks_add(inertia.m, 1, 1, momentum, v1 + 3 * at);
}

static void carry(void *data, const double *dv, const double *q1, double *v1) {
  SporeIslandSystem *system = data;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    for (size_t k = 0; k < 3 * body->model->node_count; k++) v1[site->v + k] += dv[site->v + k];
    if (!spore_model_is_nodal(body->model)) carry_turning(system, body, dv + site->v, q1 + site->q, v1 + site->v);
  }
}

static void mass_multiply(void *data, const double *x, double *y) {
  SporeIslandSystem *system = data;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    spore_island_system_weigh(system, body, x + site->v, y + site->v);
  }
}

#define DIGEST_FACTOR 0x9e3779b97f4a7c15u

static void add_bits(uint64_t sum[5], const double numbers[5]) {
  uint64_t bits[5];
  memcpy(bits, numbers, sizeof bits);
  for (size_t k = 0; k < 5; k++) sum[k] = sum[k] * DIGEST_FACTOR + bits[k];
}

uint64_t spore_island_system_laws(const SporeIslandSystem *system) {
  uint64_t sum[5] = {system->island->contact_count, system->island->spring_count};
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    const double law[5] = {term->law.stiffness, term->law.damping, term->law.friction, term->law.damping_depth,
                           term->depth};
    add_bits(sum, law);
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    const double law[5] = {term->law.stiffness, term->law.damping, term->law.friction, term->law.rest_length,
                           term->stretch};
    add_bits(sum, law);
  }
  for (size_t k = 1; k < 5; k++) sum[0] = sum[0] * DIGEST_FACTOR ^ sum[k];
  return sum[0];
}

static size_t kept_buffer(const SporeKeptEquations *equations) {
  assert(equations->set < 2);
  return SPORE_EQUATIONS * equations->set + equations->count % SPORE_EQUATIONS;
}

static bool evaluation(void *data, SporeEvaluation *evaluation) {
  const SporeIslandSystem *system = data;
  if (!system->equations) return false;
  const SporeEvaluation *kept = &system->world->solve.evaluated[kept_buffer(system->equations)];
  const SporeIsland *island = system->island;
  *evaluation = (SporeEvaluation){kept->q + island->q_start, kept->v + island->v_start, kept->f + island->v_start};
  return true;
}

static void keep(void *data, const SporeEquation *equation) {
  const SporeIslandSystem *system = data;
  SporeKeptEquations *equations = system->equations;
  SporeSolve *solve = &system->world->solve;
  assert(equations && equation->c >= 0 && equation->qa && equation->v);
  assert(!system->shape || system->shape == equation->qa);
  const SporeIsland *island = system->island;
  size_t buffer = kept_buffer(equations), i = equations->count++ % SPORE_EQUATIONS;
  equations->kept[i].c = equation->c;
  equations->kept[i].load = equation->load;
  equations->kept[i].at_s = system->now_s;
  equations->kept[i].shaped = system->shape != NULL;
  equations->kept[i].apart = system->apart;
  equations->kept[i].evaluated = equation->evaluated;
  equations->kept[i].laws = spore_island_system_laws(system);
  if (equation->c == 0) equations->balance_load = equation->load;
  memcpy(solve->kept_q[buffer] + island->q_start, equation->qa, island->q_count * sizeof(double));
  memcpy(solve->kept_v[buffer] + island->v_start, equation->v, island->v_count * sizeof(double));
  if (equation->va) memcpy(solve->kept_va[buffer] + island->v_start, equation->va, island->v_count * sizeof(double));
}

static double distance(void *data, const double *x) {
  const SporeIslandSystem *system = data;
  double most = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    const double *mass = spore_island_system_mass(system, body), *local = x + site->v;
    double square = 0;
    assert(body->total_mass > 0);
    for (size_t i = 0; i < body->block_count; i++, mass += 9, local += 3) {
      double weighed[3];
      spore_blocks_apply(mass, 1, local, weighed);
      square += spore_vec3_dot(spore_vec3_load(local), spore_vec3_load(weighed));
    }
    double mean = sqrt(square / body->total_mass);
    if (!(mean <= most)) most = mean;
  }
  return most;
}

bool spore_island_system_is_held(const SporeIslandSystem *system) {
  assert(system->world && system->island);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    if (spore_island_system_body(system, b, &site)->held.pin_count > 0) return true;
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    if (term->a.prescribed || term->b.prescribed) return true;
  }
  return false;
}

/* Whether some force begins or ends as bodies move: forces of contacts, of friction, and of stops of curve joints. */
static bool switches(const SporeIslandSystem *system) {
  if (system->island->contact_count > 0) return true;
  for (size_t i = 0; i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    if (term->law.friction > 0 || (term->curve && spore_curve_joint_may_stop(term->curve))) return true;
  }
  return false;
}

SporeDynamics spore_island_system_dynamics(SporeIslandSystem *system) {
  assert(system->world && system->island);
  assert(system->island->v_count % 3 == 0);
  spore_island_system_lay_contacts(system);
  return (SporeDynamics){.data = system,
                         .q_count = system->island->q_count,
                         .block_count = system->island->v_count / 3,
                         .switches = switches(system),
                         .cancel = system->world->cancel,
                         .set_shape = set_shape,
                         .definite = spore_island_system_definite,
                         .force = force,
                         .body_force = body_force,
                         .term_force = term_force,
                         .loose_force = loose_force,
                         .sweep = sweep,
                         .set_time = set_time,
                         .set_mass = set_mass,
                         .kick = kick,
                         .drift = drift,
                         .carry = carry,
                         .mass_multiply = mass_multiply,
                         .linearise = spore_island_system_linearise,
                         .take_tangent = take_tangent,
                         .reuse = spore_island_system_reuse,
                         .multiply = spore_island_system_multiply,
                         .drags = spore_island_system_drags,
                         .multiply_dragged = spore_island_system_multiply_dragged,
                         .precondition = spore_island_system_precondition,
                         .precondition_dragged = spore_island_system_precondition_dragged,
                         .coupling_patience = spore_island_system_coupling_patience,
                         .couple = spore_island_system_couple,
                         .factor_cost = spore_island_system_factor_cost,
                         .factorised = spore_island_system_factorised,
                         .factor_patience = spore_island_system_factor_patience,
                         .rounding = spore_island_system_rounding,
                         .evaluation = evaluation,
                         .keep = keep,
                         .distance = distance,
                         .buckles = spore_island_system_buckles(system),
                         .held = system->balance,
                         .gravity_momentum = system->island->gravity_momentum,
                         .least_force = system->island->least_force};
}

static void invert_mass(SporeWorld *world, const SporeBody *body, size_t start, size_t count) {
  assert(start + count <= body->block_count);
  double *mass = world->state.mass + 3 * body->v_offset, *inverse = world->state.mass_inverse + 3 * body->v_offset;
  memcpy(inverse + 9 * start, mass + 9 * start, 9 * count * sizeof *mass);
  spore_blocks_invert(inverse + 9 * start, count);
}

void spore_body_set_mass(SporeWorld *world, const SporeBody *body) {
  assert(body->model && body->block_count == body->model->block_count);
  spore_model_mass(body->model, world->state.q + body->q_offset, world->state.mass + 3 * body->v_offset);
  invert_mass(world, body, 0, body->block_count);
}

void spore_body_turn_mass(SporeWorld *world, const SporeBody *body, const double *q) {
  assert(body->model && q);
  size_t at = body->model->node_count;
  if (spore_model_is_nodal(body->model)) return;
  SporeMat3 inertia = body->model->type->inertia(body->model, q);
  memcpy(world->state.mass + 3 * body->v_offset + 9 * at, inertia.m, sizeof inertia.m);
  invert_mass(world, body, at, 1);
}
