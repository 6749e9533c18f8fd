/* The matrix A = M + c D + c2 K of an island, and its preconditioner. The models' part is stored block by block; terms
 * that couple bodies are applied without a matrix. */
#include <assert.h>
#include <float.h>
#include <string.h>

#include "core/sim/solve/local_assembly.h"

static SporeCoupling *contact_couplings(const SporeIslandSystem *system) {
  return system->world->contact.couplings + system->island->contact_start;
}

static SporeCoupling *spring_couplings(const SporeIslandSystem *system) {
  return system->world->links.couplings + system->island->spring_start;
}

/* Adds the bending of the curve joint to the matrix of `body`, if there is one, like the rest of the term. */
static void bend_curve_joint(const SporeIslandSystem *system, SporeSpringTerm *term, const double *q, double c2,
                             uint32_t body) {
  assert(term->curve && (body == SPORE_NO_BODY || body < system->world->body_count));
  spore_curve_joint_bend(term, system->world->solve.local_sites, q, c2);
  term->curve->bend.assembled = body != SPORE_NO_BODY && term->curve->bend.turn > 0;
  if (term->curve->bend.assembled) spore_body_assemble_bend(&system->world->bodies[body], &term->curve->bend);
}

static void multiply_bends(const SporeIslandSystem *system, const double *x, double *y) {
  for (size_t i = 0; system->world->links.curve_joint_count > 0 && i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    if (term->curve && term->curve->bend.turn > 0 && !term->curve->bend.assembled)
      spore_curve_joint_bend_multiply(term, system->world->solve.local_sites, x, y);
  }
}

static bool drags(const SporeContactTerm *term) { return spore_vec3_dot(term->drag, term->drag) > 0; }

/* A term is added to the matrix of its body, unless the matrices are kept as they are. A term that fits into no body's
 * matrix becomes a coupling. */
static void linearise_terms(SporeIslandSystem *system, const double *q, const double *v, double c, double c2,
                            bool kept) {
  const SporeSite *sites = system->world->solve.local_sites;
  system->contact_couplings = system->spring_couplings = system->dragging = 0;
  for (size_t i = 0; i < system->island->contact_count; i++) {
    SporeContactTerm *term = spore_island_system_contact(system, i);
    uint32_t body = spore_island_system_local_body(system, &term->a, &term->b);
    if (body != SPORE_NO_BODY && kept) continue;
    SporeMat3 k = spore_contact_term_jacobian(term, sites, q, v, system->now_s, c, c2);
    system->dragging += drags(term);
    if (body != SPORE_NO_BODY) spore_body_assemble_term(&system->world->bodies[body], &term->a, &term->b, &k);
    else contact_couplings(system)[system->contact_couplings++] = spore_coupling(&term->a, &term->b, &k, sites);
  }
  for (size_t i = 0; i < system->island->spring_count; i++) {
    SporeSpringTerm *term = spore_island_system_spring(system, i);
    uint32_t body = spore_island_system_local_body(system, &term->a, &term->b);
    if (body != SPORE_NO_BODY && kept) continue;
    SporeMat3 k = spore_spring_term_jacobian(term, sites, q, v, c, c2);
    if (term->curve) bend_curve_joint(system, term, q, system->tangent == SPORE_TANGENT_DEFINITE ? 0 : c2, body);
    if (body != SPORE_NO_BODY) spore_body_assemble_term(&system->world->bodies[body], &term->a, &term->b, &k);
    else spring_couplings(system)[system->spring_couplings++] = spore_coupling(&term->a, &term->b, &k, sites);
  }
}

/* How stiff a diagonal block of A - M is: the root mean square of its eigenvalues. */
static double stiffness_of(const double *block, const double *mass) {
  double sum = 0;
  for (int e = 0; e < 9; e++) sum += (block[e] - mass[e]) * (block[e] - mass[e]);
  return sqrt(sum / 3);
}

/* Stiffness along the soft axes, from the inverse of the block of A. */
static double softest_stiffness(const double *inverse, double weight) {
  assert(weight > 0);
  double flexible = (inverse[0] + inverse[4] + inverse[8]) / 3;
  return fmax(1 / flexible - 1 / weight, 0);
}

/* Inverts the diagonal blocks of A, and sums up their share of rounding: see spore_island_system_rounding. */
static void invert_diagonal(const SporeIslandSystem *system, SporeBody *body, const double *q, double *blocks) {
  const double *mass = spore_island_system_mass(system, body),
               *inverse = system->world->state.mass_inverse + 3 * body->v_offset;
  size_t nodes = body->model->node_count;
  body->preconditioner.rounding_soft = body->preconditioner.rounding_stiff = 0;
  for (size_t i = 0; i < body->block_count; i++, blocks += 9, mass += 9, inverse += 9) {
    if (memcmp(blocks, mass, 9 * sizeof *mass) == 0) { /* nothing is stiff there */
      memcpy(blocks, inverse, 9 * sizeof *inverse);
      continue;
    }
    double weight = (inverse[0] + inverse[4] + inverse[8]) / 3, stiff = stiffness_of(blocks, mass);
    double size = spore_vec3_length(spore_vec3_load(q + 3 * (i < nodes ? i : nodes - 1)));
    if (nodes < body->block_count) size += 1; /* an orientation is known to rounding of 1 */
    spore_blocks_invert(blocks, 1);
    double soft = softest_stiffness(blocks, weight);
    body->preconditioner.rounding_soft += weight * soft * soft * size * size;
    body->preconditioner.rounding_stiff += weight * stiff * stiff * size * size;
  }
}

/* With couplings, conjugate gradients correct what a factor leaves out, so the factor of an earlier matrix is kept
 * while it serves well: see preconditioner.c. Without couplings the factor is the whole solver, and must be current. */
static void make_preconditioner(SporeIslandSystem *system, const double *q) {
  bool alone = system->contact_couplings + system->spring_couplings == 0;
  double *blocks = spore_island_system_precondition_blocks(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    spore_island_system_body_diagonal(system, body, blocks + 3 * site->v);
  }
  system->together = spore_island_system_factorise(system, blocks);
  spore_couplings_diagonal(contact_couplings(system), system->contact_couplings, blocks);
  spore_couplings_diagonal(spring_couplings(system), system->spring_couplings, blocks);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    bool current = body->preconditioner.factor_ready && body->preconditioner.factor_alone && alone;
    if (system->coupled && spore_island_system_assembles(system, body)) body->preconditioner.factor_ready = true;
    else if (!body->preconditioner.choice.factorised || !spore_island_system_assembles(system, body))
      body->preconditioner.factor_ready = body->preconditioner.factor_kept = false;
    else if (body->preconditioner.factor_kept && !alone) body->preconditioner.factor_ready = true;
    else if (!current) {
      spore_body_factorise(body, blocks + 3 * site->v, alone);
      spore_island_system_count(system, spore_body_factor_work(body));
    }
    invert_diagonal(system, body, q + site->q, blocks + 3 * site->v);
  }
  spore_island_system_update_coupled(system);
  system->iteration_work = spore_island_system_iteration_work(system);
}

/* Whether the body's matrix is its whole stiffness, negative parts and all, which the balance makes definite. */
static bool balances(const SporeIslandSystem *system, const SporeBody *body) {
  return system->balance && spore_body_is_static(body) && body->model->type->stiffness;
}

static void assemble(const SporeIslandSystem *system, SporeBody *body, const SporeTangent *at, double c, double c2) {
  assert(body->preconditioner.matrix.block_count == body->block_count && at->q && at->v);
  const SporeModelType *type = body->model->type;
  spore_block_matrix_zero(&body->preconditioner.matrix);
  if (balances(system, body)) type->stiffness(body->model, at, &body->preconditioner.matrix);
  else if (type->tangent) type->tangent(body->model, at, &body->preconditioner.matrix);
  else
    type->jacobian(body->model, at->q, at->shape, at->v, at->stiffness_scale, at->damping_scale,
                   &body->preconditioner.matrix);
  const double *mass = spore_island_system_mass(system, body);
  double inertia = spore_island_system_inertia(system, body);
  for (size_t i = 0; i < body->block_count; i++) {
    double *block = body->preconditioner.matrix.values + 9 * (size_t)body->preconditioner.matrix.diagonal[i];
    for (int e = 0; e < 9; e++) block[e] += inertia * mass[9 * i + e];
  }
  if (system->tangent != SPORE_TANGENT_WHOLE) body->preconditioner.factor_ready = false;
  body->preconditioner.factor_kept &=
      body->preconditioner.matrix_c == c && body->preconditioner.matrix_c2 == c2 && !system->balance;
  body->preconditioner.matrix_c = c;
  body->preconditioner.matrix_c2 = c2;
  body->preconditioner.matrix_step = system->world->state.step;
  body->preconditioner.matrix_form = system->tangent;
}

/* Whether the body takes its whole tangent. Compression may make the whole tangent indefinite. A factor detects that,
 * and the matrix is made again without the indefinite part. Conjugate gradients would not detect it, nor would a factor
 * that lacks some terms. In balance it is for the caller to make the matrix definite. */
static bool takes_whole(const SporeIslandSystem *system, const SporeBody *body) {
  bool may = body->model->type->tangent && system->tangent != SPORE_TANGENT_DEFINITE;
  if (may && system->tangent == SPORE_TANGENT_WHOLE) return true;
  if (!body->preconditioner.choice.factorised) return false;
  if (balances(system, body)) return true;
  return may && system->island->contact_count + system->island->spring_count == 0;
}

/* whole: assembles all bodies, by the whole tangent where a body takes it; else only the bodies whose factor failed. */
static bool assemble_bodies(const SporeIslandSystem *system, const double *q, const double *from, const double *v,
                            double c, double c2, bool whole) {
  bool any = false;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) continue;
    bool balance = balances(system, body);
    bool again = takes_whole(system, body) && body->preconditioner.choice.factorised;
    if (!whole && (body->preconditioner.factor_ready || balance || !again)) continue;
    assemble(system, body,
             &(SporeTangent){.q = q + site->q,
                             .shape = (system->shape ? system->shape : q) + site->q,
                             .v = v + site->v,
                             .from = from && !balance ? from + site->q : NULL,
                             .stiffness_scale = c2,
                             .damping_scale = spore_body_is_static(body) ? 0 : c,
                             .whole = whole && takes_whole(system, body)},
             c, c2);
    any = true;
  }
  return any;
}

void spore_island_system_linearise(void *data, const double *q, const double *from, const double *v, double c,
                                   double c2) {
  assert(c > 0 && c2 >= 0);
  SporeIslandSystem *system = data;
  system->coupled_fresh = false;
  system->coupled &= system->coupled_c == c && system->coupled_c2 == c2;
  system->linearised_c = c;
  system->linearised_c2 = c2;
  assemble_bodies(system, q, from, v, c, c2, true);
  linearise_terms(system, q, v, c, c2, false);
  spore_island_system_load_levers(system, c2);
  spore_island_system_recall_coupled(system);
  make_preconditioner(system, q);
  if (assemble_bodies(system, q, from, v, c, c2, false)) make_preconditioner(system, q);
}

bool spore_island_system_buckles(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    if (balances(system, spore_island_system_body(system, b, &site))) return true;
  }
  return false;
}

bool spore_island_system_definite(void *data) {
  const SporeIslandSystem *system = data;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    bool tells = balances(system, body) && takes_whole(system, body) && spore_island_system_assembles(system, body);
    if (tells && !body->preconditioner.factor_ready) return false;
  }
  return true;
}

/* Whether the preconditioner consists of factors only, which were made without couplings. */
static bool has_factors_alone(SporeIslandSystem *system) {
  if (spore_island_system_couples(system)) return false;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!body->preconditioner.choice.factorised || !body->preconditioner.factor_ready ||
        !body->preconditioner.factor_alone)
      return false;
    if (!spore_island_system_assembles(system, body)) return false;
  }
  return true;
}

/* Whether every matrix of the island is that of c and c2, and not too old. */
static bool may_reuse(const SporeIslandSystem *system, double c, double c2) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) continue;
    bool same = body->preconditioner.matrix_c == c && body->preconditioner.matrix_c2 == c2;
    if (!same || body->preconditioner.matrix_form != SPORE_TANGENT_USUAL ||
        system->world->state.step - body->preconditioner.matrix_step >= body->preconditioner.choice.keep)
      return false;
  }
  return true;
}

bool spore_island_system_reuse(void *data, const double *q, const double *v, double c, double c2) {
  SporeIslandSystem *system = data;
  bool kept = may_reuse(system, c, c2);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    spore_island_system_body(system, b, &site)->preconditioner.choice.start = kept ? SPORE_START_KEPT : SPORE_START_NEW;
  }
  if (!kept) return false;
  system->contact_couplings = system->spring_couplings = system->dragging = 0;
  if (has_factors_alone(system)) return true;
  linearise_terms(system, q, v, c, c2, true);
  spore_island_system_load_levers(system, c2);
  make_preconditioner(system, q);
  return true;
}

double spore_island_system_factor_cost(void *data) {
  SporeIslandSystem *system = data;
  double linearisation = 0, iteration = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) continue;
    if (!body->preconditioner.choice.factorised || body->preconditioner.choice.stuck) return 0;
    linearisation += spore_body_linearisation_work(body);
    iteration += spore_body_iteration_work(body);
  }
  /* A factor does not contain couplings of bodies. */
  return iteration > 0 && !spore_island_system_couples(system) ? linearisation / iteration : 0;
}

/* Only a body that chooses for itself, and that nothing is coupled to, is solved better by its factor alone. */
size_t spore_island_system_factor_patience(void *data) {
  const SporeIslandSystem *system = data;
  double factor = 0, iteration = 0;
  if (system->world->solver.linear != SPORE_LINEAR_AUTOMATIC) return 0;
  if (system->island->contact_count + system->island->spring_count > 0) return 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) continue;
    if (body->preconditioner.factor.block_count == 0 || body->preconditioner.choice.factorised) return 0;
    factor += spore_body_linearisation_work(body);
    iteration += spore_body_gradient_work(body);
  }
  return iteration > 0 ? (size_t)(factor / iteration) + 1 : 0;
}

bool spore_island_system_factorised(void *data) {
  SporeIslandSystem *system = data;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_assembles(system, body) && !body->preconditioner.factor_ready) return false;
  }
  return true;
}

void spore_island_system_multiply(void *data, const double *x, double *y) {
  assert(x != y);
  SporeIslandSystem *system = data;
  system->products++;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) {
      spore_island_system_weigh(system, body, x + site->v, y + site->v);
      if (body->preconditioner.rows)
        spore_blocks_add(body->preconditioner.turning, 1, 1, x + site->v + 3, y + site->v + 3);
      continue;
    }
    memset(y + site->v, 0, 3 * body->block_count * sizeof *y);
    spore_block_matrix_multiply_add(&body->preconditioner.matrix, x + site->v, y + site->v);
  }
  spore_couplings_multiply(contact_couplings(system), system->contact_couplings, x, y);
  spore_couplings_multiply(spring_couplings(system), system->spring_couplings, x, y);
  multiply_bends(system, x, y);
  spore_island_system_filter(system, y);
}

void spore_island_system_multiply_dragged(void *data, const double *x, double *y) {
  const SporeIslandSystem *system = data;
  spore_island_system_multiply(data, x, y);
  for (size_t i = 0; i < system->island->contact_count; i++) {
    const SporeContactTerm *term = spore_island_system_contact(system, i);
    if (drags(term)) spore_contact_term_drag(term, system->world->solve.local_sites, x, y);
  }
  spore_island_system_filter(system, y);
}

bool spore_island_system_drags(void *data) { return ((const SporeIslandSystem *)data)->dragging > 0; }

static void precondition(SporeIslandSystem *system, const double *r, bool dragged, double *z) {
  spore_island_system_count(system, system->iteration_work);
  if (system->together) spore_island_system_factor_solve(system, r, z);
  else spore_island_system_solve_bodies(system, r, z);
  if (system->coupled) spore_island_system_take_in_couplings(system, r, dragged, z);
  spore_island_system_filter(system, z);
}

void spore_island_system_precondition(void *data, const double *r, double *z) { precondition(data, r, false, z); }

void spore_island_system_precondition_dragged(void *data, const double *r, double *z) {
  precondition(data, r, true, z);
}

/* Positions are known to DBL_EPSILON |q|, so forces to that times the stiffness. q: of the last linearisation. */
double spore_island_system_rounding(void *data, double c, bool stiff_axes) {
  assert(c > 0);
  const SporeIslandSystem *system = data;
  double sum = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    sum += stiff_axes ? body->preconditioner.rounding_stiff : body->preconditioner.rounding_soft;
  }
  return DBL_EPSILON * sqrt(sum) / c;
}
