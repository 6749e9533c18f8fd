/* The matrix A = M + c D + c2 K of an island: the models' block by block, terms matrix-free on top, and what
 * preconditions it. */
#include <float.h>
#include <string.h>

#include "core/sim/fold.h"

#define FLOPS_TO_ROUND 1e5 /* of a solution: below, its factor is quick to read as it is */

static SporeCoupling *contact_couplings(const SporeGroup *group) {
  return group->world->contact_couplings + group->island->contact_start;
}

static SporeCoupling *spring_couplings(const SporeGroup *group) {
  return group->world->spring_couplings + group->island->spring_start;
}

/* Folded into the matrix of `body`, if any, with the rest of the term. */
static void bend_rail(const SporeGroup *group, SporeSpringTerm *term, const double *q, double c2, uint32_t body) {
  spore_rail_bend(term, group->world->local_sites, q, c2);
  term->rail->bend.folded = body != SPORE_NO_BODY && term->rail->bend.turn > 0;
  if (term->rail->bend.folded) spore_body_fold_bend(&group->world->bodies[body], &term->rail->bend);
}

static void multiply_bends(const SporeGroup *group, const double *x, double *y) {
  for (size_t i = 0; group->world->rail_count > 0 && i < group->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_group_spring(group, i);
    if (term->rail && term->rail->bend.turn > 0 && !term->rail->bend.folded)
      spore_rail_bend_multiply(term, group->world->local_sites, x, y);
  }
}

static bool drags(const SporeContactTerm *term) { return spore_vec3_dot(term->drag, term->drag) > 0; }

/* Couplings are those terms that no body's matrix takes in; the others are added there, unless the matrices are kept
 * as they are. */
static void linearise_terms(SporeGroup *group, const double *q, const double *v, double c, double c2, bool kept) {
  const SporeSite *sites = group->world->local_sites;
  group->contact_couplings = group->spring_couplings = group->dragging = 0;
  for (size_t i = 0; i < group->island->contact_count; i++) {
    SporeContactTerm *term = spore_group_contact(group, i);
    uint32_t body = spore_group_folds(group, &term->a, &term->b);
    if (body != SPORE_NO_BODY && kept) continue;
    SporeMat3 k = spore_contact_term_jacobian(term, sites, q, v, group->now_s, c, c2);
    group->dragging += drags(term);
    if (body != SPORE_NO_BODY) spore_body_fold(&group->world->bodies[body], &term->a, &term->b, &k);
    else contact_couplings(group)[group->contact_couplings++] = spore_coupling(&term->a, &term->b, &k, sites);
  }
  for (size_t i = 0; i < group->island->spring_count; i++) {
    SporeSpringTerm *term = spore_group_spring(group, i);
    uint32_t body = spore_group_folds(group, &term->a, &term->b);
    if (body != SPORE_NO_BODY && kept) continue;
    SporeMat3 k = spore_spring_term_jacobian(term, sites, q, v, c, c2);
    if (term->rail) bend_rail(group, term, q, c2, body);
    if (body != SPORE_NO_BODY) spore_body_fold(&group->world->bodies[body], &term->a, &term->b, &k);
    else spring_couplings(group)[group->spring_couplings++] = spore_coupling(&term->a, &term->b, &k, sites);
  }
}

/* Diagonal blocks of the models' part of A; M alone where there is no matrix. */
static void body_diagonal(const SporeGroup *group, const SporeBody *body, double *blocks) {
  if (!spore_group_assembles(group, body)) {
    const double *mass = spore_group_mass(group, body);
    for (size_t e = 0; e < 9 * body->block_count; e++) blocks[e] = spore_group_inertia(group, body) * mass[e];
    return;
  }
  for (size_t i = 0; i < body->block_count; i++)
    memcpy(blocks + 9 * i, body->matrix.values + 9 * (size_t)body->matrix.diagonal[i], 9 * sizeof *blocks);
}

/* The body's own matrix with the diagonal blocks of the terms; where it is not positive definite in floating point,
 * block-Jacobi stands in. */
static void factorise(SporeBody *body, const double *blocks, bool alone) {
  bool may_round = body->factor.solve_flops > FLOPS_TO_ROUND;
  body->factor_alone = alone;
  body->factor_ready =
      spore_block_cholesky_factorise(&body->factor, &body->matrix, blocks, body->held_flags, may_round);
  body->factor_kept = body->factor_ready && !alone;
  body->choice.factors++;
}

/* How stiff a diagonal block of A - M is: the root mean square of its eigenvalues. */
static double stiffness_of(const double *block, const double *mass) {
  double sum = 0;
  for (int e = 0; e < 9; e++) sum += (block[e] - mass[e]) * (block[e] - mass[e]);
  return sqrt(sum / 3);
}

/* And along its soft axes, from the inverse of A's. */
static double softest_stiffness(const double *inverse, double weight) {
  double flexible = (inverse[0] + inverse[4] + inverse[8]) / 3;
  return fmax(1 / flexible - 1 / weight, 0);
}

/* Inverts A's diagonal blocks, and sums up what they say of rounding on the way, see spore_group_rounding. */
static void invert_diagonal(const SporeGroup *group, SporeBody *body, const double *q, double *blocks) {
  const double *mass = spore_group_mass(group, body), *inverse = group->world->mass_inverse + 3 * body->v_offset;
  size_t nodes = body->model->node_count;
  body->rounding_soft = body->rounding_stiff = 0;
  for (size_t i = 0; i < body->block_count; i++, blocks += 9, mass += 9, inverse += 9) {
    double weight = (inverse[0] + inverse[4] + inverse[8]) / 3, stiff = stiffness_of(blocks, mass);
    double size = spore_vec3_length(spore_vec3_load(q + 3 * (i < nodes ? i : nodes - 1)));
    if (nodes < body->block_count) size += 1; /* an orientation is known to rounding of 1 */
    spore_blocks_invert(blocks, 1);
    double soft = softest_stiffness(blocks, weight);
    body->rounding_soft += weight * soft * soft * size * size;
    body->rounding_stiff += weight * stiff * stiff * size * size;
  }
}

/* Among couplings conjugate gradients make up for what a factor does not know, so that one of an earlier matrix does as
 * long as it does well: see factor.c. Alone it is all there is. */
static void make_preconditioner(SporeGroup *group, const double *q) {
  bool alone = group->contact_couplings + group->spring_couplings == 0;
  double *blocks = spore_group_precondition_blocks(group);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_group_body(group, b, &site);
    body_diagonal(group, body, blocks + 3 * site->v);
  }
  spore_couplings_diagonal(contact_couplings(group), group->contact_couplings, blocks);
  spore_couplings_diagonal(spring_couplings(group), group->spring_couplings, blocks);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_group_body(group, b, &site);
    bool current = body->factor_ready && body->factor_alone && alone;
    if (!body->choice.factorised || !spore_group_assembles(group, body)) body->factor_ready = body->factor_kept = false;
    else if (body->factor_kept && !alone) body->factor_ready = true;
    else if (!current) factorise(body, blocks + 3 * site->v, alone);
    invert_diagonal(group, body, q + site->q, blocks + 3 * site->v);
  }
}

static void assemble(const SporeGroup *group, SporeBody *body, const SporeTangent *at, double c, double c2) {
  const SporeModelType *type = body->model->type;
  spore_block_matrix_zero(&body->matrix);
  if (type->tangent) type->tangent(body->model, at, &body->matrix);
  else type->jacobian(body->model, at->q, at->shape, at->v, at->stiffness_scale, at->damping_scale, &body->matrix);
  const double *mass = spore_group_mass(group, body);
  double inertia = spore_group_inertia(group, body);
  for (size_t i = 0; i < body->block_count; i++) {
    double *block = body->matrix.values + 9 * (size_t)body->matrix.diagonal[i];
    for (int e = 0; e < 9; e++) block[e] += inertia * mass[9 * i + e];
  }
  body->factor_ready = false;
  body->factor_kept &= body->matrix_c == c && body->matrix_c2 == c2;
  body->matrix_c = c;
  body->matrix_c2 = c2;
  body->matrix_step = group->world->step;
}

/* What is compressed may make the whole matrix indefinite. A factor tells, and then the matrix is made again without
 * that; conjugate gradients are not put at risk, nor are terms that no factor knows. */
static bool takes_whole(const SporeGroup *group, const SporeBody *body) {
  return body->choice.factorised && body->model->type->tangent && !spore_body_is_static(body) &&
         group->island->contact_count + group->island->spring_count == 0;
}

/* whole: as far as a body takes it; else what has no factor yet, without. */
static bool assemble_bodies(const SporeGroup *group, const double *q, const double *from, const double *v, double c,
                            double c2, bool whole) {
  bool any = false;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_group_body(group, b, &site);
    if (!spore_group_assembles(group, body)) continue;
    if (!whole && (body->factor_ready || !takes_whole(group, body))) continue;
    assemble(group, body,
             &(SporeTangent){.q = q + site->q,
                             .shape = (group->shape ? group->shape : q) + site->q,
                             .v = v + site->v,
                             .from = from ? from + site->q : NULL,
                             .stiffness_scale = c2,
                             .damping_scale = spore_body_is_static(body) ? 0 : c,
                             .whole = whole && takes_whole(group, body)},
             c, c2);
    any = true;
  }
  return any;
}

void spore_group_linearise(void *data, const double *q, const double *from, const double *v, double c, double c2) {
  SporeGroup *group = data;
  assemble_bodies(group, q, from, v, c, c2, true);
  linearise_terms(group, q, v, c, c2, false);
  make_preconditioner(group, q);
  if (assemble_bodies(group, q, from, v, c, c2, false)) make_preconditioner(group, q);
}

/* Whether factors that are as good as when they were made are all of the preconditioner. */
static bool has_factors_alone(SporeGroup *group) {
  if (spore_group_couples(group)) return false;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_group_body(group, b, &site);
    if (!body->choice.factorised || !body->factor_ready || !body->factor_alone) return false;
    if (!spore_group_assembles(group, body)) return false;
  }
  return true;
}

/* Whether every matrix of the island is that of c and c2, and not older than it is kept. */
static bool may_reuse(const SporeGroup *group, double c, double c2) {
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_group_body(group, b, &site);
    if (!spore_group_assembles(group, body)) continue;
    bool same = body->matrix_c == c && body->matrix_c2 == c2;
    if (!same || group->world->step - body->matrix_step >= body->choice.keep) return false;
  }
  return true;
}

bool spore_group_reuse(void *data, const double *q, const double *v, double c, double c2) {
  SporeGroup *group = data;
  bool kept = may_reuse(group, c, c2);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    spore_group_body(group, b, &site)->choice.start = kept ? SPORE_START_KEPT : SPORE_START_NEW;
  }
  if (!kept) return false;
  group->contact_couplings = group->spring_couplings = group->dragging = 0;
  if (has_factors_alone(group)) return true;
  linearise_terms(group, q, v, c, c2, true);
  make_preconditioner(group, q);
  return true;
}

double spore_group_factor_cost(void *data) {
  SporeGroup *group = data;
  double linearisation = 0, iteration = 0;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_group_body(group, b, &site);
    if (!spore_group_assembles(group, body)) continue;
    if (!body->choice.factorised || body->choice.stuck) return 0;
    linearisation += spore_body_linearisation_work(body);
    iteration += spore_body_iteration_work(body);
  }
  /* No factor knows how terms couple bodies. */
  return iteration > 0 && !spore_group_couples(group) ? linearisation / iteration : 0;
}

bool spore_group_factorised(void *data) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_group_body(group, b, &site);
    if (spore_group_assembles(group, body) && !body->factor_ready) return false;
  }
  return true;
}

void spore_group_multiply(void *data, const double *x, double *y) {
  SporeGroup *group = data;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_group_body(group, b, &site);
    if (!spore_group_assembles(group, body)) {
      spore_group_weigh(group, body, x + site->v, y + site->v);
      continue;
    }
    memset(y + site->v, 0, 3 * body->block_count * sizeof *y);
    spore_block_matrix_multiply_add(&body->matrix, x + site->v, y + site->v);
  }
  spore_couplings_multiply(contact_couplings(group), group->contact_couplings, x, y);
  spore_couplings_multiply(spring_couplings(group), group->spring_couplings, x, y);
  multiply_bends(group, x, y);
  spore_group_filter(group, y);
}

void spore_group_multiply_dragged(void *data, const double *x, double *y) {
  const SporeGroup *group = data;
  spore_group_multiply(data, x, y);
  for (size_t i = 0; i < group->island->contact_count; i++) {
    const SporeContactTerm *term = spore_group_contact(group, i);
    if (drags(term)) spore_contact_term_drag(term, group->world->local_sites, x, y);
  }
  spore_group_filter(group, y);
}

bool spore_group_drags(void *data) { return ((const SporeGroup *)data)->dragging > 0; }

void spore_group_precondition(void *data, const double *r, double *z) {
  SporeGroup *group = data;
  const double *inverse = spore_group_precondition_blocks(group);
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_group_body(group, b, &site);
    if (body->factor_ready) spore_block_cholesky_solve(&body->factor, r + site->v, z + site->v);
    else spore_blocks_apply(inverse + 3 * site->v, body->block_count, r + site->v, z + site->v);
  }
  spore_group_filter(group, z);
}

/* Positions are known to DBL_EPSILON |q|, so forces to that times the stiffness; by the q of the last linearisation. */
double spore_group_rounding(void *data, double c, bool stiff_axes) {
  const SporeGroup *group = data;
  double sum = 0;
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_group_body(group, b, &site);
    sum += stiff_axes ? body->rounding_stiff : body->rounding_soft;
  }
  return 4 * DBL_EPSILON * sqrt(sum) / c;
}
