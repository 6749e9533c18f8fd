/* An island as the integrators see it: the models' forces and matrices block by block, terms matrix-free on top. */
#include <float.h>
#include <string.h>

#include "core/constraint/pin.h"
#include "core/sim/world_private.h"

/* The i-th body of the island, and where its part begins in the local vectors. */
static SporeBody *body_at(const SporeGroup *group, size_t i, const SporeSite **site) {
  uint32_t index = group->world->island_bodies[group->island->body_start + i];
  *site = &group->world->local_sites[index];
  return &group->world->bodies[index];
}

static SporeContactTerm *contact(const SporeGroup *group, size_t i, SporeMat3 **jacobian) {
  uint32_t index = group->world->contact_order[group->island->contact_start + i];
  *jacobian = &group->world->contact_jacobians[index];
  return &group->world->contacts[index];
}

static SporeSpringTerm *spring(const SporeGroup *group, size_t i, SporeMat3 **jacobian) {
  uint32_t index = group->world->spring_order[group->island->spring_start + i];
  *jacobian = &group->world->spring_jacobians[index];
  return &group->world->springs[index];
}

static double *precondition_blocks(const SporeGroup *group) {
  return group->world->precondition + 3 * group->island->v_start;
}

static double *block_stiffness(const SporeGroup *group) {
  return group->world->block_stiffness + group->island->v_start / 3;
}

static const double *mass_of(const SporeGroup *group, const SporeBody *body) {
  return group->world->mass + 3 * body->v_offset;
}

/* y = blocks x, or y += scale blocks x */
static void apply_blocks(const double *blocks, size_t count, const double *x, double *y) {
  for (size_t i = 0; i < count; i++, blocks += 9, x += 3, y += 3) {
    double a = x[0], b = x[1], c = x[2];
    y[0] = blocks[0] * a + blocks[1] * b + blocks[2] * c;
    y[1] = blocks[3] * a + blocks[4] * b + blocks[5] * c;
    y[2] = blocks[6] * a + blocks[7] * b + blocks[8] * c;
  }
}

static void add_blocks(const double *blocks, size_t count, double scale, const double *x, double *y) {
  for (size_t i = 0; i < count; i++, blocks += 9, x += 3, y += 3) {
    double a = scale * x[0], b = scale * x[1], c = scale * x[2];
    y[0] += blocks[0] * a + blocks[1] * b + blocks[2] * c;
    y[1] += blocks[3] * a + blocks[4] * b + blocks[5] * c;
    y[2] += blocks[6] * a + blocks[7] * b + blocks[8] * c;
  }
}

static void add_gravity(const SporeBody *body, SporeVec3 gravity, double *f) {
  for (size_t i = 0; i < body->block_count; i++)
    spore_vec3_accumulate(f + 3 * i, spore_vec3_scale(body->model->block_mass[i], gravity));
}

static void filter(const SporeGroup *group, double *vector) {
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    spore_pin_filter(body->held, body->held_count, vector + site->v);
  }
}

static void add_body_forces(const SporeGroup *group, const double *q, const double *v, double *f) {
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    body->model->type->force(body->model, q + site->q, v + site->v, f + site->v);
    add_gravity(body, group->world->gravity, f + site->v);
  }
}

static void add_term_forces(const SporeGroup *group, const double *q, const double *v, double *f) {
  SporeMat3 *unused;
  for (size_t i = 0; i < group->island->contact_count; i++)
    spore_contact_term_force(contact(group, i, &unused), group->world->local_sites, q, v, f);
  for (size_t i = 0; i < group->island->spring_count; i++)
    spore_spring_term_force(spring(group, i, &unused), group->world->local_sites, q, v, f);
}

static void force(void *data, const double *q, const double *v, double *f) {
  SporeGroup *group = data;
  memset(f, 0, group->island->v_count * sizeof *f);
  add_body_forces(group, q, v, f);
  add_term_forces(group, q, v, f);
  filter(group, f);
}

static void body_force(void *data, const double *q, const double *v, double *f) {
  SporeGroup *group = data;
  memset(f, 0, group->island->v_count * sizeof *f);
  add_body_forces(group, q, v, f);
  filter(group, f);
}

/* Counts a term at each block that the end hangs on; counts: a double a block. */
static void count_end(const SporeWorld *world, const SporeEnd *end, double *counts) {
  if (end->prescribed) return;
  double *local = counts + world->local_sites[end->body].v / 3;
  const SporeMapping *mapping = end->mapping;
  if (mapping->kind == SPORE_MAPPING_IDENTITY) local[end->point]++;
  if (mapping->kind == SPORE_MAPPING_RIGID) local[0]++;
  if (mapping->kind != SPORE_MAPPING_LINEAR) return;
  for (uint32_t k = mapping->row_start[end->point]; k < mapping->row_start[end->point + 1]; k++)
    local[mapping->block[k]]++;
}

/* Sum of n/m over those blocks, for a force that acts up to `arm` away from the end. */
static double end_inverse_mass(const SporeWorld *world, const SporeEnd *end, double arm, const double *counts) {
  if (end->prescribed) return 0;
  const double *local = counts + world->local_sites[end->body].v / 3;
  const SporeBody *body = &world->bodies[end->body];
  const double *inverse = world->mass_inverse + 3 * body->v_offset;
  const SporeMapping *mapping = end->mapping;
  if (mapping->kind == SPORE_MAPPING_IDENTITY) return local[end->point] * inverse[9 * (size_t)end->point];
  if (mapping->kind == SPORE_MAPPING_RIGID) {
    double lever = spore_vec3_distance(end->position, spore_vec3_load(world->q + body->q_offset)) + arm;
    return local[0] * (inverse[0] + lever * lever * (inverse[9] + inverse[13] + inverse[17]));
  }
  double sum = 0;
  for (uint32_t k = mapping->row_start[end->point]; k < mapping->row_start[end->point + 1]; k++)
    sum += mapping->weight[k] * mapping->weight[k] * local[mapping->block[k]] * inverse[9 * (size_t)mapping->block[k]];
  return sum;
}

static void count_terms(const SporeGroup *group, double *counts) {
  const SporeWorld *world = group->world;
  SporeMat3 *unused;
  memset(counts, 0, group->island->v_count / 3 * sizeof *counts);
  for (size_t i = 0; i < group->island->contact_count; i++) {
    const SporeContactTerm *term = contact(group, i, &unused);
    count_end(world, &term->a, counts);
    count_end(world, &term->b, counts);
  }
  for (size_t i = 0; i < group->island->spring_count; i++) {
    const SporeSpringTerm *term = spring(group, i, &unused);
    count_end(world, &term->a, counts);
    count_end(world, &term->b, counts);
  }
}

/* Sets the softening of all terms for an explicit step of h seconds. */
static void soften_terms(const SporeGroup *group, double h) {
  const SporeWorld *world = group->world;
  SporeMat3 *unused;
  double *counts = precondition_blocks(group); /* free: only implicit steps precondition */
  count_terms(group, counts);
  for (size_t i = 0; i < group->island->contact_count; i++) {
    SporeContactTerm *term = contact(group, i, &unused);
    double inverse_mass =
        end_inverse_mass(world, &term->a, term->arm_a, counts) + end_inverse_mass(world, &term->b, term->arm_b, counts);
    term->softening = spore_softening(h, inverse_mass, term->law.stiffness);
  }
  for (size_t i = 0; i < group->island->spring_count; i++) {
    SporeSpringTerm *term = spring(group, i, &unused);
    double inverse_mass = end_inverse_mass(world, &term->a, 0, counts) + end_inverse_mass(world, &term->b, 0, counts);
    term->softening = spore_softening(h, inverse_mass, term->law.stiffness);
  }
}

void spore_group_harden(SporeGroup *group) {
  const SporeSoftening none = {0, 0, 0};
  SporeMat3 *unused;
  for (size_t i = 0; i < group->island->contact_count; i++) contact(group, i, &unused)->softening = none;
  for (size_t i = 0; i < group->island->spring_count; i++) spring(group, i, &unused)->softening = none;
}

static bool term_force(void *data, const double *q, const double *v, double h, double *f) {
  SporeGroup *group = data;
  if (group->island->contact_count + group->island->spring_count == 0) return false;
  soften_terms(group, h);
  memset(f, 0, group->island->v_count * sizeof *f);
  add_term_forces(group, q, v, f);
  filter(group, f);
  return true;
}

static void kick(void *data, const double *f, double h, double *v) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    add_blocks(group->world->mass_inverse + 3 * body->v_offset, body->block_count, h, f + site->v, v + site->v);
  }
  filter(group, v);
}

static void drift(void *data, const double *q0, const double *v, double h, double *q1, double *v1) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    if (body->model->type->drift) {
      body->model->type->drift(body->model, q0 + site->q, v + site->v, h, q1 + site->q, v1 + site->v);
      continue;
    }
    for (size_t k = 0; k < body->q_count; k++) q1[site->q + k] = q0[site->q + k] + h * v[site->v + k];
    memcpy(v1 + site->v, v + site->v, body->q_count * sizeof *v);
  }
}

static void mass_multiply(void *data, const double *x, double *y) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    apply_blocks(mass_of(group, body), body->block_count, x + site->v, y + site->v);
  }
}

static void linearise_terms(SporeGroup *group, const double *q, const double *v, double c, double c2) {
  const SporeSite *sites = group->world->local_sites;
  SporeMat3 *jacobian;
  for (size_t i = 0; i < group->island->contact_count; i++) {
    SporeContactTerm *term = contact(group, i, &jacobian);
    *jacobian = spore_contact_term_jacobian(term, sites, q, v, c, c2);
  }
  for (size_t i = 0; i < group->island->spring_count; i++) {
    SporeSpringTerm *term = spring(group, i, &jacobian);
    *jacobian = spore_spring_term_jacobian(term, sites, q, v, c, c2);
  }
}

static void add_term_diagonals(SporeGroup *group, double *blocks) {
  const SporeSite *sites = group->world->local_sites;
  SporeMat3 *jacobian;
  for (size_t i = 0; i < group->island->contact_count; i++) {
    const SporeContactTerm *term = contact(group, i, &jacobian);
    spore_term_diagonal(&term->a, &term->b, jacobian, sites, blocks);
  }
  for (size_t i = 0; i < group->island->spring_count; i++) {
    const SporeSpringTerm *term = spring(group, i, &jacobian);
    spore_term_diagonal(&term->a, &term->b, jacobian, sites, blocks);
  }
}

/* Diagonal blocks of the models' part of A; M alone where there is no matrix. */
static void body_diagonal(const SporeGroup *group, const SporeBody *body, double *blocks) {
  if (body->matrix.block_count == 0) {
    memcpy(blocks, mass_of(group, body), 9 * body->block_count * sizeof *blocks);
    return;
  }
  for (size_t i = 0; i < body->block_count; i++)
    memcpy(blocks + 9 * i, body->matrix.values + 9 * (size_t)body->matrix.diagonal[i], 9 * sizeof *blocks);
}

/* A block without an inverse gets that of its trace: a preconditioner may be rough, but not singular. */
static void invert_blocks(double *blocks, size_t count) {
  for (size_t i = 0; i < count; i++, blocks += 9) {
    SporeMat3 block, inverse;
    memcpy(block.m, blocks, sizeof block.m);
    double mean = spore_mat3_trace(block) / 3;
    if (!spore_mat3_invert(block, &inverse) || spore_mat3_determinant(block) <= 0)
      inverse = spore_mat3_scale(mean > 0 ? 1 / mean : 1, spore_mat3_identity());
    memcpy(blocks, inverse.m, sizeof inverse.m);
  }
}

/* The body's own matrix with the diagonal blocks of the terms; where it is not positive definite in floating point,
 * block-Jacobi stands in. */
static void factorise(SporeBody *body, const double *blocks, bool alone) {
  body->factor_alone = alone;
  body->factor_ready = spore_block_cholesky_factorise(&body->factor, &body->matrix, blocks, body->held_flags);
}

/* Root mean square of the eigenvalues of A - M in each diagonal block. */
static void measure_stiffness(const double *blocks, const double *mass, size_t count, double *stiffness) {
  for (size_t i = 0; i < count; i++, blocks += 9, mass += 9) {
    double sum = 0;
    for (int e = 0; e < 9; e++) sum += (blocks[e] - mass[e]) * (blocks[e] - mass[e]);
    stiffness[i] = sqrt(sum / 3);
  }
}

static void make_preconditioner(SporeGroup *group) {
  bool alone = group->island->contact_count + group->island->spring_count == 0;
  double *blocks = precondition_blocks(group);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    body_diagonal(group, body, blocks + 3 * site->v);
  }
  add_term_diagonals(group, blocks);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    measure_stiffness(blocks + 3 * site->v, mass_of(group, body), body->block_count,
                      block_stiffness(group) + site->v / 3);
    bool current = body->factor_ready && body->factor_alone && alone;
    if (!body->choice.factorised) body->factor_ready = false;
    else if (!current) factorise(body, blocks + 3 * site->v, alone);
  }
  invert_blocks(blocks, group->island->v_count / 3);
}

static void assemble(const SporeGroup *group, SporeBody *body, const double *q, const double *v, double c, double c2) {
  if (body->matrix.block_count == 0) return;
  spore_block_matrix_zero(&body->matrix);
  body->model->type->jacobian(body->model, q, v, c2, c, &body->matrix);
  const double *mass = mass_of(group, body);
  for (size_t i = 0; i < body->block_count; i++) {
    double *block = body->matrix.values + 9 * (size_t)body->matrix.diagonal[i];
    for (int e = 0; e < 9; e++) block[e] += mass[9 * i + e];
  }
  body->factor_ready = false;
  body->matrix_c = c;
  body->matrix_c2 = c2;
  body->matrix_step = group->world->step;
}

static void linearise(void *data, const double *q, const double *v, double c, double c2) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    assemble(group, body, q + site->q, v + site->v, c, c2);
  }
  linearise_terms(group, q, v, c, c2);
  make_preconditioner(group);
}

static bool reuse(void *data, const double *q, const double *v, double c, double c2) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    if (body->matrix.block_count == 0) continue;
    bool same = body->matrix_c == c && body->matrix_c2 == c2;
    if (!same || group->world->step - body->matrix_step >= SPORE_MATRIX_STEPS) return false;
  }
  linearise_terms(group, q, v, c, c2);
  make_preconditioner(group);
  return true;
}

static void multiply(void *data, const double *x, double *y) {
  SporeGroup *group = data;
  const SporeSite *sites = group->world->local_sites;
  SporeMat3 *jacobian;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    if (body->matrix.block_count == 0) {
      apply_blocks(mass_of(group, body), body->block_count, x + site->v, y + site->v);
      continue;
    }
    memset(y + site->v, 0, 3 * body->block_count * sizeof *y);
    spore_block_matrix_multiply_add(&body->matrix, x + site->v, y + site->v);
  }
  for (size_t i = 0; i < group->island->contact_count; i++) {
    const SporeContactTerm *term = contact(group, i, &jacobian);
    spore_term_multiply(&term->a, &term->b, jacobian, sites, x, y);
  }
  for (size_t i = 0; i < group->island->spring_count; i++) {
    const SporeSpringTerm *term = spring(group, i, &jacobian);
    spore_term_multiply(&term->a, &term->b, jacobian, sites, x, y);
  }
  filter(group, y);
}

static void precondition(void *data, const double *r, double *z) {
  SporeGroup *group = data;
  const double *inverse = precondition_blocks(group);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    if (body->factor_ready) spore_block_cholesky_solve(&body->factor, r + site->v, z + site->v);
    else apply_blocks(inverse + 3 * site->v, body->block_count, r + site->v, z + site->v);
  }
  filter(group, z);
}

/* How stiff a block is along its soft axes, from the preconditioner, which holds the inverse of A's diagonal blocks. */
static double softest_stiffness(const double *inverse, double weight) {
  double flexible = (inverse[0] + inverse[4] + inverse[8]) / 3;
  return fmax(1 / flexible - 1 / weight, 0);
}

/* Positions are known to DBL_EPSILON |q|, so forces to that times the stiffness. */
static double rounding(void *data, const double *q, double c, bool stiff_axes) {
  SporeGroup *group = data;
  const double *inverse = precondition_blocks(group);
  double sum = 0;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = body_at(group, b, &site);
    const double *mass_inverse = group->world->mass_inverse + 3 * body->v_offset;
    bool nodal = body->q_count == 3 * body->block_count;
    for (size_t i = 0; i < body->block_count; i++) {
      const double *w = mass_inverse + 9 * i;
      double weight = (w[0] + w[4] + w[8]) / 3;
      double stiff = stiff_axes ? block_stiffness(group)[site->v / 3 + i]
                                : softest_stiffness(inverse + 3 * site->v + 9 * i, weight);
      stiff /= c;
      double size = nodal ? spore_vec3_length(spore_vec3_load(q + site->q + 3 * i))
                          : 1 + spore_vec3_length(spore_vec3_load(q + site->q));
      sum += weight * stiff * stiff * size * size;
    }
  }
  return 4 * DBL_EPSILON * sqrt(sum);
}

SporeDynamics spore_group_dynamics(SporeGroup *group) {
  return (SporeDynamics){.data = group,
                         .q_count = group->island->q_count,
                         .block_count = group->island->v_count / 3,
                         .force = force,
                         .body_force = body_force,
                         .term_force = term_force,
                         .kick = kick,
                         .drift = drift,
                         .mass_multiply = mass_multiply,
                         .linearise = linearise,
                         .reuse = reuse,
                         .multiply = multiply,
                         .precondition = precondition,
                         .rounding = rounding,
                         .gravity_momentum = group->island->gravity_momentum};
}

void spore_body_update_mass(SporeWorld *world, const SporeBody *body) {
  double *mass = world->mass + 3 * body->v_offset, *inverse = world->mass_inverse + 3 * body->v_offset;
  body->model->type->mass(body->model, world->q + body->q_offset, mass);
  memcpy(inverse, mass, 9 * body->block_count * sizeof *mass);
  invert_blocks(inverse, body->block_count);
}
