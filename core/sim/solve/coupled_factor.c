/* A preconditioner that holds what couples the bodies of an island.
 *
 * Factors of the bodies' own matrices B leave out the couplings J^T K J, and conjugate gradients then take about as
 * many iterations as there are couplings, and more where these are stiff. Where that is more work than the following,
 * the couplings are taken in by Woodbury's formula (M. A. Woodbury, "Inverting modified matrices", 1950): (B + J^T K
 * J)^-1 = B^-1 - B^-1 J^T (1 + K G)^-1 K J B^-1,  G = J B^-1 J^T. G, the flexibility of the bodies where they are
 * coupled, needs a solution by B for each direction of each coupling. It is kept, with B's factors and J, until the
 * next attempt at a step: bodies and places change little within one, and conjugate gradients take care of that. K is
 * that of the current linearisation, and need not be symmetric.
 *
 * Everything lies with the first body of the island that has room for it. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/linalg/dense.h"
#include "core/sim/solve/local_assembly.h"

#define COUPLED_MOST 64 /* couplings; conjugate gradients take care of others */
#define ENDS_MOST 32    /* blocks of v that both ends of a coupling hang on */
#define ROWS (3 * COUPLED_MOST)
#define SOLVE_WEIGHT                                                                                                   \
  0.3 /* of an operation of a solution where SPORE_LANES of them go on at once: see preconditioner.c */
#define DENSE_WEIGHT 2. /* of the third power of the rows */

/* A block of v that a coupling hangs on: it moves by weight x, and where the block has a rotation behind it, by
 * weight w x lever too. */
typedef struct Part {
  uint32_t v;
  bool turns;
  double weight, lever[3];
} Part;

/* A coupling as it was when G was made: J's rows. */
typedef struct Row {
  const SporeEnd *end; /* whose it is */
  uint32_t part_count;
  Part part[ENDS_MOST];
} Row;

struct SporeCoupledRoom {
  size_t count;           /* rows */
  size_t ready;           /* of these: G is known */
  double used, iteration; /* work of iterations since the factors were made but the first of each solution; of one */
  double flexibility[ROWS * ROWS], matrix[ROWS * ROWS]; /* G; factor of 1 + K G */
  uint32_t order[ROWS];                                 /* of that factor */
  bool factored, dragged;                               /* there is one; of K with what friction drags */
  double k[9 * COUPLED_MOST], drag[9 * COUPLED_MOST];   /* K, and what is taken away from it where friction drags */
  double motion[ROWS];
  Row row[COUPLED_MOST];
};

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

/* Whether B is a matrix with a factor; else B is the mass, whose blocks are inverted. */
static bool has_factor(const SporeIslandSystem *system, const SporeBody *body) {
  return spore_island_system_assembles(system, body) && body->preconditioner.factor.block_count > 0;
}

static size_t add_end(const SporeCoupledEnd *end, unsigned char kind, double sign, Part *part, size_t room) {
  if (kind == SPORE_COUPLED_NOTHING) return 0;
  if (kind != SPORE_COUPLED_POINT) {
    if (room == 0) return SIZE_MAX;
    *part = (Part){.v = (uint32_t)end->v, .turns = kind == SPORE_COUPLED_RIGID, .weight = sign};
    if (part->turns) memcpy(part->lever, end->lever, sizeof part->lever);
    return 1;
  }
  const SporeMapping *mapping = end->end->mapping;
  uint32_t first = mapping->row_start[end->end->point], last = mapping->row_start[end->end->point + 1];
  if (last - first > room) return SIZE_MAX;
  for (uint32_t k = first; k < last; k++)
    *part++ = (Part){.v = (uint32_t)end->v + 3 * mapping->block[k], .weight = sign * mapping->weight[k]};
  return last - first;
}

/* False: it hangs on more blocks than there is room for. */
static bool set_row(Row *row, const SporeCoupling *coupling) {
  *row = (Row){.end = coupling->a.end};
  size_t a = add_end(&coupling->a, coupling->kind_a, 1, row->part, ENDS_MOST);
  if (a == SIZE_MAX) return false;
  size_t b = add_end(&coupling->b, coupling->kind_b, -1, row->part + a, ENDS_MOST - a);
  if (b == SIZE_MAX) return false;
  row->part_count = (uint32_t)(a + b);
  return true;
}

static inline bool lies_in(const Part *part, size_t from, size_t to) { return part->v >= from && part->v < to; }

static bool touches(const Row *row, size_t from, size_t to) {
  for (uint32_t p = 0; p < row->part_count; p++)
    if (lies_in(&row->part[p], from, to)) return true;
  return false;
}

/* J x, of the blocks of v between `from` and `to`; x begins with that at `from`. */
static SporeVec3 motion_of(const Row *row, size_t from, size_t to, const double *x) {
  SporeVec3 sum = {0, 0, 0};
  for (uint32_t p = 0; p < row->part_count; p++) {
    const Part *part = &row->part[p];
    if (!lies_in(part, from, to)) continue;
    SporeVec3 u = spore_vec3_load(x + part->v - from);
    if (part->turns)
      u = spore_vec3_add(u, spore_vec3_cross(spore_vec3_load(x + part->v - from + 3), spore_vec3_load(part->lever)));
    sum = spore_vec3_add_scaled(sum, part->weight, u);
  }
  return sum;
}

/* y += J^T force, likewise. */
static void push(const Row *row, size_t from, size_t to, SporeVec3 force, double *y) {
  for (uint32_t p = 0; p < row->part_count; p++) {
    const Part *part = &row->part[p];
    if (!lies_in(part, from, to)) continue;
    SporeVec3 share = spore_vec3_scale(part->weight, force);
    spore_vec3_accumulate(y + part->v - from, share);
    if (part->turns)
      spore_vec3_accumulate(y + part->v - from + 3, spore_vec3_cross(spore_vec3_load(part->lever), share));
  }
}

/* A group of columns of G: of coupling `row[lane]` along the axis `axis[lane]`. */
typedef struct Group {
  size_t count;
  uint32_t row[SPORE_LANES];
  uint32_t axis[SPORE_LANES];
} Group;

/* Room for SPORE_LANES vectors of the body whose part of v begins at `from`. */
static double *vectors_of(const SporeIslandSystem *system, size_t from) {
  return system->world->solve.lanes + SPORE_LANES * (system->island->v_start + from);
}

/* Adds what the body makes of these columns of G, and of the rows that mirror them. */
static void add_group(const SporeIslandSystem *system, SporeCoupledRoom *room, SporeBody *body, size_t from,
                      const Group *group) {
  size_t n = 3 * body->block_count, to = from + n;
  double *vectors = vectors_of(system, from);
  const double *inverse = spore_island_system_precondition_blocks(system) + 3 * from;
  memset(vectors, 0, SPORE_LANES * n * sizeof *vectors);
  for (size_t lane = 0; lane < group->count; lane++) {
    double unit[3] = {0, 0, 0}, *x = vectors + lane * n;
    unit[group->axis[lane]] = 1;
    push(&room->row[group->row[lane]], from, to, spore_vec3_load(unit), x);
    spore_pin_filter(body->held.blocks, body->held.count, x);
    if (!has_factor(system, body)) spore_blocks_apply(inverse, body->block_count, x, x);
  }
  if (has_factor(system, body)) spore_block_cholesky_solve_many(&body->preconditioner.factor, vectors, n);
  for (size_t lane = 0; lane < group->count; lane++) {
    size_t column = 3 * group->row[lane] + group->axis[lane];
    spore_pin_filter(body->held.blocks, body->held.count, vectors + lane * n);
    for (size_t i = 0; i < room->count; i++) {
      if (!touches(&room->row[i], from, to)) continue;
      double u[3];
      spore_vec3_store(u, motion_of(&room->row[i], from, to, vectors + lane * n));
      for (size_t e = 0; e < 3; e++) {
        room->flexibility[(3 * i + e) * ROWS + column] += u[e];
        if (i < room->ready) room->flexibility[column * ROWS + 3 * i + e] += u[e];
      }
    }
  }
}

/* Says where the body is coupled. */
static void ask(const SporeIslandSystem *system, const SporeCoupledRoom *room, SporeBody *body, size_t from) {
  uint8_t *asked = (uint8_t *)vectors_of(system, from);
  memset(asked, 0, body->block_count);
  for (size_t i = 0; i < room->count; i++)
    for (uint32_t p = 0; p < room->row[i].part_count; p++) {
      const Part *part = &room->row[i].part[p];
      if (lies_in(part, from, from + 3 * body->block_count)) asked[(part->v - from) / 3] = 1;
    }
  spore_block_cholesky_ask(&body->preconditioner.factor, asked);
}

/* Completes G for the rows that are new. */
static void find_flexibility(const SporeIslandSystem *system, SporeCoupledRoom *room) {
  for (size_t i = 0; i < 3 * room->count; i++) {
    size_t first = i < 3 * room->ready ? 3 * room->ready : 0;
    memset(room->flexibility + i * ROWS + first, 0, (3 * room->count - first) * sizeof(double));
  }
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    Group group = {0};
    if (has_factor(system, body)) ask(system, room, body, site->v);
    for (size_t i = room->ready; i < room->count; i++) {
      if (!touches(&room->row[i], site->v, site->v + 3 * body->block_count)) continue;
      for (uint32_t axis = 0; axis < 3; axis++) {
        group.row[group.count] = (uint32_t)i;
        group.axis[group.count++] = axis;
        if (group.count < SPORE_LANES) continue;
        add_group(system, room, body, site->v, &group);
        group.count = 0;
      }
    }
    if (group.count > 0) add_group(system, room, body, site->v, &group);
  }
  room->ready = room->count;
}

static bool resists(const SporeCoupling *coupling) {
  for (size_t e = 0; e < 6; e++)
    if (coupling->k[e] != 0) return true;
  return false;
}

/* The row of the coupling; a new one where it has none. ROWS: there is no room. */
static size_t row_of(SporeCoupledRoom *room, const SporeCoupling *coupling) {
  for (size_t i = 0; i < room->count; i++)
    if (room->row[i].end == coupling->a.end) return i;
  if (room->count == COUPLED_MOST || !set_row(&room->row[room->count], coupling)) return ROWS;
  return room->count++;
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
  size_t i = row_of(room, coupling);
  if (i == ROWS) return;
  const double *c = coupling->k, k[9] = {c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5]};
  memcpy(room->k + 9 * i, k, sizeof k);
  if (!term) return;
  SporeMat3 drag = spore_mat3_outer(term->drag, term->normal);
  memcpy(room->drag + 9 * i, drag.m, sizeof drag.m);
}

/* K of the current linearisation. */
static void take_couplings(const SporeIslandSystem *system, SporeCoupledRoom *room) {
  const SporeCoupling *contacts = system->world->contact.couplings + system->island->contact_start,
                      *springs = system->world->links.couplings + system->island->spring_start;
  memset(room->k, 0, sizeof room->k);
  memset(room->drag, 0, sizeof room->drag);
  for (size_t i = 0, at = 0; i < system->contact_couplings; i++)
    take_coupling(room, &contacts[i], term_of(system, &contacts[i], &at));
  for (size_t i = 0; i < system->spring_couplings; i++) take_coupling(room, &springs[i], NULL);
  room->factored = false;
}

/* matrix = 1 + K G, factorised. */
static bool factorise(SporeCoupledRoom *room, bool dragged) {
  size_t n = 3 * room->count;
  memset(room->matrix, 0, n * ROWS * sizeof(double));
  for (size_t i = 0; i < n; i++) {
    double *row = room->matrix + i * ROWS;
    for (size_t e = 0; e < 3; e++) {
      size_t at = 9 * (i / 3) + 3 * (i % 3) + e;
      double k = room->k[at] - (dragged ? room->drag[at] : 0);
      if (k != 0) spore_vector_add_scaled(n, row, k, room->flexibility + (i / 3 * 3 + e) * ROWS);
    }
    row[i] += 1;
  }
  room->dragged = dragged;
  room->factored = SPORE_KERNEL(spore_dense_factorise)(n, ROWS, room->matrix, room->order);
  return room->factored;
}

/* Whether factors of earlier steps serve, and what iterations with them cost is less than new ones. */
static bool has_factors(const SporeIslandSystem *system, const SporeCoupledRoom *room) {
  double work = 0;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!has_factor(system, body)) continue;
    if (!spore_body_has_bare_factor(body)) return false;
    work += spore_body_factor_work(body);
  }
  return room->used <= work;
}

static bool factorise_bodies(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (!has_factor(system, body)) continue;
    spore_body_factorise(body, NULL, true);
    if (!body->preconditioner.factor_ready) return false;
  }
  return true;
}

/* Those factors are the present ones. */
static void set_ready(const SporeIslandSystem *system) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    if (has_factor(system, body)) body->preconditioner.factor_ready = true;
  }
}

/* The blocks of bodies without a factor hold no couplings either. */
static void invert_masses(const SporeIslandSystem *system) {
  double *blocks = spore_island_system_precondition_blocks(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (has_factor(system, body)) continue;
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
  return count < COUPLED_MOST ? count : COUPLED_MOST;
}

/* Work of a new G for the couplings of the island, and of new factors, in operations as preconditioner.c counts them.
 */
static double work_of(const SporeIslandSystem *system, bool factors) {
  double work = 0, rows = 3. * (double)count_resisting(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (!has_factor(system, body)) continue;
    if (factors) work += spore_body_factor_work(body);
    work += SOLVE_WEIGHT * rows * body->preconditioner.factor.solve_flops;
  }
  return work + DENSE_WEIGHT * rows * rows * rows;
}

static double iteration_work(const SporeIslandSystem *system) {
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
    if (spore_island_system_assembles(system, body) && !has_factor(system, body)) return never;
    if (spore_body_is_static(body)) return never; /* next to no inertia: what buckles is left to conjugate gradients */
    any |= has_factor(system, body);
  }
  size_t rows = system->contact_couplings + system->spring_couplings;
  if (!any || rows == 0) return never;
  bool factors = system->coupled || !has_factors(system, room_of(system));
  double iteration = iteration_work(system), most = work_of(system, factors) / iteration;
  double spent = system->coupled ? room_of(system)->used / iteration : (double)system->products;
  /* The more a step has taken, the more it will take. */
  return (SporePatience){most > spent + 1 ? (size_t)(most - spent) : 1, (size_t)(most * most / (most + spent))};
}

bool spore_island_system_couple(void *data) {
  SporeIslandSystem *system = data;
  SporeCoupledRoom *room = room_of(system);
  assert(room);
  room->count = room->ready = 0;
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
  room->iteration = iteration_work(system);
  spore_island_system_update_coupled(system);
  return true;
}

void spore_island_system_update_coupled(SporeIslandSystem *system) {
  if (!system->coupled) return;
  SporeCoupledRoom *room = room_of(system);
  room->used = fmax(room->used - 2 * room->iteration, 0);
  invert_masses(system);
  take_couplings(system, room);
  if (room->ready < room->count) find_flexibility(system, room);
}

void spore_island_system_take_in_couplings(SporeIslandSystem *system, const double *r, bool dragged, double *z) {
  SporeCoupledRoom *room = room_of(system);
  size_t n = system->island->v_count;
  double *left = vectors_of(system, 0), *t = room->motion;
  room->used += room->iteration;
  if ((!room->factored || room->dragged != dragged) && !factorise(room, dragged)) return;
  for (size_t i = 0; i < room->count; i++) {
    double u[3];
    spore_vec3_store(u, motion_of(&room->row[i], 0, n, z));
    for (size_t e = 0; e < 3; e++) {
      const double *k = room->k + 9 * i + 3 * e, *drag = room->drag + 9 * i + 3 * e;
      double force = k[0] * u[0] + k[1] * u[1] + k[2] * u[2];
      if (dragged) force -= drag[0] * u[0] + drag[1] * u[1] + drag[2] * u[2];
      t[3 * i + e] = force;
    }
  }
  SPORE_KERNEL(spore_dense_solve)(3 * room->count, ROWS, room->matrix, room->order, t);
  memcpy(left, r, n * sizeof *left);
  for (size_t i = 0; i < room->count; i++)
    push(&room->row[i], 0, n, spore_vec3_scale(-1, spore_vec3_load(t + 3 * i)), left);
  spore_island_system_filter(system, left);
  spore_island_system_solve_bodies(system, left, z);
}
