/* A preconditioner that holds what couples the bodies of an island.
 *
 * Factors of the bodies' own matrices B leave out the couplings J^T K J, and conjugate gradients then take about as
 * many iterations as there are couplings, and more where these are stiff. Where that is more work than the following,
 * the couplings are taken in by Woodbury's formula (M. A. Woodbury, "Inverting modified matrices", 1950): (B + J^T K
 * J)^-1 = B^-1 - B^-1 J^T (1 + K G)^-1 K J B^-1,  G = J B^-1 J^T. G, the flexibility of the bodies where they are
 * coupled, needs a solution by B for each direction of each coupling. It is kept, with B's factors and J, from step to
 * step: bodies and places change little from one to the next, and conjugate gradients take care of that until their
 * iterations are more work than new factors. Only couplings that are new need their part of G. K is that of the current
 * linearisation, and need not be symmetric.
 *
 * Everything lies with the first body of the island that has room for it. */
#include <assert.h>
#include <string.h>

#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/linalg/dense.h"
#include "core/sim/solve/coupled_rows.h"
#include "core/sim/solve/local_assembly.h"

/* Of an operation of a solution where SPORE_LANES of them go on at once: see preconditioner.c. */
#define SOLVE_WEIGHT 0.3
#define DENSE_WEIGHT 2. /* of the third power of the rows */

/* Of a recent mean, what the last step gives. */
#define RECENT 0.25
/* What is left of the work without it, a step with it: so it is tried again how much that is. Sooner where steps take
 * less than SLIGHT of it: then that costs little. */
#define FADES 0.997
#define FADES_SLIGHT 0.97
#define SLIGHT 0.25
#define JUDGED_STEPS 4   /* that it is given before it is judged */
#define SETTLED_STEPS 32 /* after which its end is only a trial */
#define PATIENCE 2       /* steps without it, then; twice as many each time that it did not serve as long */
#define PATIENCE_MOST 256

bool spore_world_create_coupled_rooms(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->role != SPORE_PASSIVE || body->preconditioner.matrix.block_count == 0) continue;
    body->preconditioner.coupled = SPORE_NEW(SporeCoupledRoom);
    if (!body->preconditioner.coupled) return false;
  }
  return true;
}

bool spore_world_has_coupled_rooms(const SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (world->bodies[b].preconditioner.coupled) return true;
  return false;
}

static SporeCoupledRoom *room_of(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeCoupledRoom *room = spore_island_system_body(system, b, &site)->preconditioner.coupled;
    if (room) return room;
  }
  return NULL;
}

static bool resists(const SporeCoupling *coupling) {
  for (size_t e = 0; e < 6; e++)
    if (coupling->k[e] != 0) return true;
  return false;
}

/* The term of a contact's coupling, for what friction drags; `at` goes on from coupling to coupling. */
static const SporeContactTerm *term_of(const SporeIslandSystem *system, const SporeCoupling *coupling, size_t *at) {
  for (; *at < system->island->contact_count; ++*at) {
    const SporeContactTerm *term = spore_island_system_contact(system, *at);
    if (&term->a == coupling->a.end) return term;
  }
  return NULL;
}

static void take_coupling(SporeCoupledRoom *room, const SporeCoupling *coupling, const SporeContactTerm *term) {
  if (!resists(coupling)) return;
  size_t i = spore_coupled_rows_take(room, coupling);
  if (i == SPORE_COUPLED_MOST) return;
  const double *c = coupling->k, k[9] = {c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5]};
  memcpy(room->k + 9 * i, k, sizeof k);
  SporeMat3 drag = {0};
  if (term) drag = spore_mat3_outer(term->drag, term->normal);
  memcpy(room->drag + 9 * i, drag.m, sizeof drag.m);
}

/* K of the current linearisation. */
static void take_couplings(const SporeIslandSystem *system, SporeCoupledRoom *room) {
  const SporeCoupling *contacts = system->world->contact.couplings + system->island->contact_start,
                      *springs = system->world->links.couplings + system->island->spring_start;
  spore_coupled_rows_begin(room);
  for (size_t i = 0, at = 0; i < system->contact_couplings; i++)
    take_coupling(room, &contacts[i], term_of(system, &contacts[i], &at));
  for (size_t i = 0; i < system->spring_couplings; i++) take_coupling(room, &springs[i], NULL);
  room->factored = false;
}

static size_t lead_of(const SporeCoupledRoom *room) {
  return (3 * room->active_count + SPORE_LANES - 1) / SPORE_LANES * SPORE_LANES;
}

/* Rows of 1 + K G of the coupling at that place. */
static void set_rows(SporeCoupledRoom *room, size_t place, bool dragged) {
  size_t lead = lead_of(room);
  double *rows = room->matrix + 3 * place * lead, k[9];
  const double *g = room->flexibility + 3 * room->active[place] * SPORE_COUPLED_ROWS;
  for (size_t e = 0; e < 9; e++) k[e] = room->k[9 * place + e] - (dragged ? room->drag[9 * place + e] : 0);
  memset(rows, 0, 3 * lead * sizeof *rows);
  for (size_t j = 0; j < 3 * room->active_count; j++) {
    size_t column = 3 * room->active[j / 3] + j % 3;
    for (size_t e = 0; e < 3; e++)
      rows[e * lead + j] = k[3 * e] * g[column] + k[3 * e + 1] * g[SPORE_COUPLED_ROWS + column] +
                           k[3 * e + 2] * g[2 * SPORE_COUPLED_ROWS + column];
  }
  for (size_t e = 0; e < 3; e++) rows[e * lead + 3 * place + e] += 1;
}

/* matrix = 1 + K G, factorised. */
static bool factorise(SporeCoupledRoom *room, bool dragged) {
  for (size_t place = 0; place < room->active_count; place++) set_rows(room, place, dragged);
  room->dragged = dragged;
  room->factored =
      SPORE_KERNEL(spore_dense_factorise)(3 * room->active_count, lead_of(room), room->matrix, room->order);
  return room->factored;
}

/* Whether factors of earlier steps serve, and what iterations with them cost is less than new ones. */
static bool has_factors(const SporeIslandSystem *system, const SporeCoupledRoom *room) {
  double work = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_has_factor(system, body)) continue;
    if (!spore_body_has_bare_factor(body)) return false;
    work += spore_body_factor_work(body);
  }
  return room->used <= work;
}

static bool factorise_bodies(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_has_factor(system, body)) continue;
    spore_body_factorise(body, NULL, true);
    spore_island_system_count(system, spore_body_factor_work(body));
    if (!body->preconditioner.factor_ready) return false;
  }
  return true;
}

/* Those factors are the present ones. */
static void set_ready(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_has_factor(system, body)) body->preconditioner.factor_ready = true;
  }
}

/* The blocks of bodies without a factor hold no couplings either. */
static void invert_masses(const SporeIslandSystem *system) {
  double *blocks = spore_island_system_precondition_blocks(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_has_factor(system, body)) continue;
    spore_island_system_body_diagonal(system, body, blocks + 3 * site->v);
    spore_blocks_invert(blocks + 3 * site->v, body->block_count);
  }
}

static size_t count_resisting(const SporeIslandSystem *system) {
  const SporeCoupling *contacts = system->world->contact.couplings + system->island->contact_start,
                      *springs = system->world->links.couplings + system->island->spring_start;
  size_t count = 0;
  for (size_t i = 0; i < system->contact_couplings; i++) count += resists(&contacts[i]);
  for (size_t i = 0; i < system->spring_couplings; i++) count += resists(&springs[i]);
  return count < SPORE_COUPLED_MOST ? count : SPORE_COUPLED_MOST;
}

/* Whether the matrix of some body may be indefinite, so that no factor can be counted on. */
static bool may_buckle(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_assembles(system, body) && body->preconditioner.matrix_form == SPORE_TANGENT_WHOLE)
      return true;
  }
  return false;
}

/* Work of so many new couplings in G, and of a factor of 1 + K G. */
static double column_work(const SporeIslandSystem *system, size_t couplings) {
  double work = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_has_factor(system, body)) work += body->preconditioner.factor.solve_flops;
  }
  return SOLVE_WEIGHT * 3. * (double)couplings * work;
}

/* Work of a new G for the couplings of the island, and of new factors, in operations as preconditioner.c counts them.
 */
static double work_of(const SporeIslandSystem *system, bool factors) {
  double work = 0, rows = 3. * (double)count_resisting(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_has_factor(system, body)) continue;
    if (factors) work += spore_body_factor_work(body);
    work += SOLVE_WEIGHT * rows * body->preconditioner.factor.solve_flops;
  }
  return work + DENSE_WEIGHT * rows * rows * rows;
}

double spore_island_system_iteration_work(const SporeIslandSystem *system) {
  double work = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) continue;
    work += spore_body_gradient_work(body);
    if (body->preconditioner.factor_ready) work += (system->coupled ? 2 : 1) * spore_body_solve_work(body);
  }
  return work;
}

SporePatience spore_island_system_coupling_patience(void *data) {
  SporeIslandSystem *system = data;
  SporePatience never = {0};
  bool any = false;
  if (system->coupled_fresh || system->together || !room_of(system)) return never;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (spore_island_system_assembles(system, body) && !spore_island_system_has_factor(system, body)) return never;
    if (spore_body_is_static(body)) return never; /* next to no inertia: what buckles is left to conjugate gradients */
    any |= spore_island_system_has_factor(system, body);
  }
  size_t rows = system->contact_couplings + system->spring_couplings;
  if (!any || rows == 0) return never;
  bool factors = system->coupled || !has_factors(system, room_of(system));
  double iteration = spore_island_system_iteration_work(system), most = work_of(system, factors) / iteration;
  double spent = system->coupled ? room_of(system)->used / iteration : (double)system->products;
  if (may_buckle(system)) spent = 0; /* a solution by itself, however much the step has taken */
  /* The more a step has taken, the more it will take. */
  return (SporePatience){most > spent + 1 ? (size_t)(most - spent) : 1, (size_t)(most * most / (most + spent))};
}

/* Of what G was made of besides the couplings. */
static uint64_t digest(const SporeIslandSystem *system) {
  uint64_t hash = SPORE_HASH_INIT;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    uint64_t its[3] = {(uint64_t)(body - system->world->bodies), site->v, 0};
    if (spore_island_system_has_factor(system, body)) its[2] = body->preconditioner.factors_made;
    hash = spore_hash(hash, its, sizeof its);
  }
  return hash;
}

/* Whether the preconditioner of earlier steps is that of the present bodies. */
static bool serves(const SporeIslandSystem *system, const SporeCoupledRoom *room) {
  if (room->count == 0 || system->contact_couplings + system->spring_couplings == 0) return false;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!spore_island_system_assembles(system, body)) continue;
    if (!spore_island_system_has_factor(system, body) || !spore_body_has_bare_factor(body)) return false;
  }
  return room->bodies == digest(system);
}

static void end_recalls(SporeRecall *recall) {
  bool settled = recall->steps >= SETTLED_STEPS;
  recall->patience = settled || recall->patience == 0 ? PATIENCE : 2 * recall->patience;
  if (recall->patience > PATIENCE_MOST) recall->patience = PATIENCE_MOST;
  recall->wait = recall->patience;
  recall->on = false;
}

/* Judges by the work of the steps before; made: in the last one the preconditioner was. */
static void judge_recalls(SporeRecall *recall, bool made) {
  if (!recall->on) {
    recall->without += (recall->without > 0 ? RECENT : 1) * (recall->work - recall->without);
    if (recall->wait > 0) recall->wait--;
    else recall->on = made;
    recall->steps = 0;
    return;
  }
  recall->with += (recall->steps == 0 ? 1 : RECENT) * (recall->work - recall->with);
  recall->without *= recall->work < SLIGHT * recall->without ? FADES_SLIGHT : FADES;
  if (++recall->steps >= JUDGED_STEPS && recall->with > recall->without) end_recalls(recall);
}

void spore_island_system_recall_coupled(SporeIslandSystem *system) {
  SporeCoupledRoom *room = room_of(system);
  system->work = room ? &room->recall.work : NULL;
  if (!room) return;
  uint64_t step = system->world->state.step + 1;
  if (room->recall.step != step) {
    if (room->recall.step > 0) judge_recalls(&room->recall, room->count > 0);
    room->recall.step = step;
    room->recall.work = 0;
    room->recall.on &= serves(system, room);
    if (!room->recall.on) room->count = 0;
  }
  if (system->coupled || !room->recall.on || !serves(system, room)) return;
  system->coupled = true;
  system->coupled_c = system->linearised_c;
  system->coupled_c2 = system->linearised_c2;
}

bool spore_island_system_couple(void *data) {
  SporeIslandSystem *system = data;
  SporeCoupledRoom *room = room_of(system);
  assert(room);
  room->count = 0;
  system->coupled_fresh = system->coupled || !has_factors(system, room);
  if (system->coupled_fresh) {
    if (!factorise_bodies(system)) return system->coupled = false;
    room->used = 0;
  }
  set_ready(system);
  system->coupled = true;
  system->coupled_c = system->linearised_c;
  system->coupled_c2 = system->linearised_c2;
  system->products = 0;
  room->bodies = digest(system);
  room->iteration = system->iteration_work = spore_island_system_iteration_work(system);
  spore_island_system_update_coupled(system);
  return true;
}

void spore_island_system_update_coupled(SporeIslandSystem *system) {
  if (!system->coupled) return;
  SporeCoupledRoom *room = room_of(system);
  room->used = fmax(room->used - 2 * room->iteration, 0);
  invert_masses(system);
  take_couplings(system, room);
  spore_island_system_count(system, column_work(system, spore_coupled_rows_solve(system, room)));
}

void spore_island_system_take_in_couplings(SporeIslandSystem *system, const double *r, bool dragged, double *z) {
  SporeCoupledRoom *room = room_of(system);
  size_t n = system->island->v_count;
  double *left = spore_island_system_lanes(system, 0), *t = room->motion;
  room->used += room->iteration;
  if ((!room->factored || room->dragged != dragged) && !factorise(room, dragged)) return;
  for (size_t i = 0; i < room->active_count; i++) {
    double u[3];
    spore_vec3_store(u, spore_coupled_row_motion(&room->row[room->active[i]], z));
    for (size_t e = 0; e < 3; e++) {
      const double *k = room->k + 9 * i + 3 * e, *drag = room->drag + 9 * i + 3 * e;
      double force = k[0] * u[0] + k[1] * u[1] + k[2] * u[2];
      if (dragged) force -= drag[0] * u[0] + drag[1] * u[1] + drag[2] * u[2];
      t[3 * i + e] = force;
    }
  }
  SPORE_KERNEL(spore_dense_solve)(3 * room->active_count, lead_of(room), room->matrix, room->order, t);
  memcpy(left, r, n * sizeof *left);
  for (size_t i = 0; i < room->active_count; i++)
    spore_coupled_row_push(&room->row[room->active[i]], spore_vec3_scale(-1, spore_vec3_load(t + 3 * i)), left);
  spore_island_system_filter(system, left);
  spore_island_system_solve_bodies(system, left, z);
}
