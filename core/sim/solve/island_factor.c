/* Factor of a small island of rigid bodies: of its whole matrix, with all that couples the bodies.
 *
 * Conjugate gradients with diagonal blocks fail where joints tie masses of very different size: what is left of the
 * residual is that of the heavy bodies, and the light ones are not solved. The matrix of a few bodies is small, so it
 * is factorised as a dense one, row by row from the first entry that is not zero. Each body keeps its own six rows. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/sim/solve/local_assembly.h"

#define FREEDOMS 6 /* of a rigid body */
#define ROW (FREEDOMS * SPORE_SMALL_ISLAND)

bool spore_body_create_rows(SporeBody *body) {
  if (!body->model || !spore_model_is_rigid(body->model)) return true;
  body->preconditioner.rows = SPORE_NEW_ARRAY(double, FREEDOMS *ROW);
  return body->preconditioner.rows != NULL;
}

bool spore_island_system_is_small(const SporeIslandSystem *system) {
  if (system->island->kept_count > SPORE_SMALL_ISLAND) return false;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    if (!spore_island_system_body(system, b, &site)->preconditioner.rows) return false;
  }
  return true;
}

/* Row i of the island's matrix, and the first entry of the row that is not zero. */
static double *row_of(const SporeIslandSystem *system, size_t i, size_t *first) {
  const SporeSite *site;
  SporePreconditioner *its = &spore_island_system_body(system, i / FREEDOMS, &site)->preconditioner;
  *first = its->first_row;
  return its->rows + i % FREEDOMS * ROW;
}

static void clear(const SporeIslandSystem *system, const double *blocks) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporePreconditioner *its = &spore_island_system_body(system, b, &site)->preconditioner;
    assert(site->v == FREEDOMS * b);
    its->first_row = (uint32_t)(FREEDOMS * b);
    memset(its->rows, 0, FREEDOMS * ROW * sizeof *its->rows);
    for (size_t i = 0; i < FREEDOMS; i++)
      for (size_t j = 0; j < 3; j++)
        its->rows[i * ROW + FREEDOMS * b + i / 3 * 3 + j] = blocks[18 * b + 9 * (i / 3) + 3 * (i % 3) + j];
  }
}

/* Where an end's part of the motion that the coupling resists comes from: u = sum of m x, x of the block at v. */
typedef struct Part {
  size_t v;
  SporeMat3 m;
} Part;

static size_t add_parts(const SporeCoupledEnd *end, unsigned char kind, double sign, Part *parts) {
  if (kind != SPORE_COUPLED_RIGID) return 0;
  SporeMat3 lever = spore_mat3_skew(spore_vec3_load(end->lever));
  parts[0] = (Part){end->v, spore_mat3_scale(sign, spore_mat3_identity())};
  parts[1] = (Part){end->v + 3, spore_mat3_scale(-sign, lever)};
  return 2;
}

static void add_coupling(const SporeIslandSystem *system, const SporeCoupling *c) {
  Part parts[4];
  SporeMat3 k = {{c->k[0], c->k[1], c->k[2], c->k[1], c->k[3], c->k[4], c->k[2], c->k[4], c->k[5]}};
  size_t count = add_parts(&c->a, c->kind_a, 1, parts);
  count += add_parts(&c->b, c->kind_b, -1, parts + count);
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++) {
      if (parts[j].v > parts[i].v) continue;
      SporeMat3 half = spore_mat3_multiply(k, parts[j].m);
      SporeMat3 block = spore_mat3_multiply(spore_mat3_transpose(parts[i].m), half);
      const SporeSite *site;
      SporePreconditioner *its = &spore_island_system_body(system, parts[i].v / FREEDOMS, &site)->preconditioner;
      uint32_t first = (uint32_t)(parts[j].v / FREEDOMS * FREEDOMS);
      if (first < its->first_row) its->first_row = first;
      double *rows = its->rows + parts[i].v % FREEDOMS * ROW + parts[j].v;
      for (size_t e = 0; e < 9; e++) rows[e / 3 * ROW + e % 3] += block.m[e];
    }
}

/* What stands still has the identity's rows and columns. */
static void hold(const SporeIslandSystem *system, size_t count) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    for (size_t k = 0; k < body->held.count; k++)
      for (size_t h = 0, at = FREEDOMS * b + 3 * body->held.blocks[k]; h < 3; h++, at++)
        for (size_t i = 0, first; i < count; i++) {
          double *row = row_of(system, i, &first);
          if (i == at) memset(row, 0, i * sizeof *row);
          row[at] = i == at;
        }
  }
}

/* In place: L below the diagonal, and 1 over the diagonal of L on it. False: not positive definite. */
static bool factorise(const SporeIslandSystem *system, size_t count) {
  for (size_t i = 0; i < count; i++) {
    size_t first_i, first_j;
    double *row = row_of(system, i, &first_i), before = row[i];
    for (size_t j = first_i; j <= i; j++) {
      const double *other = row_of(system, j, &first_j);
      size_t first = first_i > first_j ? first_i : first_j;
      double sum = row[j] - spore_vector_dot(j - first, row + first, other + first);
      if (j < i) row[j] = sum * other[j];
      else if (!(sum > 1e-14 * before)) return false;
      else row[i] = 1 / sqrt(sum);
    }
  }
  return true;
}

bool spore_island_system_wants_factor(const SporeIslandSystem *system) {
  if (!spore_island_system_is_small(system)) return false;
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    const SporeBody *body = spore_island_system_body(system, b, &site);
    if (body->preconditioner.choice.needed || spore_body_is_static(body)) return true;
  }
  return false;
}

/* A force F at a lever r turns the body, and less so as the body follows: -d(r x F) = ((r.F) I - r F^T) dw. Of that the
 * symmetric part. */
static void add_lever(const SporeIslandSystem *system, const SporeEnd *end, SporeVec3 force, double c2) {
  if (end->prescribed) return;
  double *turning = system->world->bodies[end->body].preconditioner.turning;
  SporeMat3 outer = spore_mat3_outer(end->offset, force);
  double along = spore_vec3_dot(end->offset, force);
  for (size_t e = 0; e < 9; e++)
    turning[e] += c2 * ((e % 4 == 0 ? along : 0) - 0.5 * (outer.m[e] + outer.m[e % 3 * 3 + e / 3]));
}

/* Leaves out what is negative: a load that tips the body over. */
static void keep_positive(double *turning) {
  SporeMat3 block, axes;
  memcpy(block.m, turning, sizeof block.m);
  double value[3];
  spore_mat3_eigen_symmetric(block, value, &axes);
  for (size_t e = 0; e < 9; e++) {
    turning[e] = 0;
    for (size_t k = 0; k < 3; k++) turning[e] += fmax(value[k], 0) * axes.m[e / 3 * 3 + k] * axes.m[e % 3 * 3 + k];
  }
}

void spore_island_system_load_levers(const SporeIslandSystem *system, double c2) {
  bool wanted = spore_island_system_wants_factor(system);
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    memset(spore_island_system_body(system, b, &site)->preconditioner.turning, 0, 9 * sizeof(double));
  }
  for (size_t i = 0; wanted && i < system->island->spring_count; i++) {
    const SporeSpringTerm *term = spore_island_system_spring(system, i);
    add_lever(system, &term->a, term->force, c2);
    add_lever(system, &term->b, spore_vec3_scale(-1, term->force), c2);
  }
  for (size_t b = 0; wanted && b < system->island->kept_count; b++) {
    const SporeSite *site;
    keep_positive(spore_island_system_body(system, b, &site)->preconditioner.turning);
  }
}

bool spore_island_system_factorise(const SporeIslandSystem *system, const double *blocks) {
  if (!spore_island_system_wants_factor(system)) return false;
  size_t count = FREEDOMS * system->island->kept_count;
  clear(system, blocks);
  for (size_t i = 0; i < system->contact_couplings; i++)
    add_coupling(system, &system->world->contact.couplings[system->island->contact_start + i]);
  for (size_t i = 0; i < system->spring_couplings; i++)
    add_coupling(system, &system->world->links.couplings[system->island->spring_start + i]);
  hold(system, count);
  return factorise(system, count);
}

void spore_island_system_factor_solve(const SporeIslandSystem *system, const double *r, double *z) {
  assert(r != z);
  size_t count = FREEDOMS * system->island->kept_count, first;
  for (size_t i = 0; i < count; i++) {
    const double *row = row_of(system, i, &first);
    z[i] = (r[i] - spore_vector_dot(i - first, row + first, z + first)) * row[i];
  }
  for (size_t i = count; i-- > 0;) {
    const double *row = row_of(system, i, &first);
    z[i] *= row[i];
    spore_vector_add_scaled(i - first, z + first, -z[i], row + first);
  }
}
