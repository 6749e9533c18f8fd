/* Couplings: terms between bodies as symmetric blocks, multiplied without a matrix. */
#include "core/constraint/coupling.h"

#include <assert.h>

static unsigned char couple(const SporeEnd *end, const SporeSite *sites, SporeCoupledEnd *coupled) {
  assert(end->prescribed || end->point < end->mapping->point_count);
  *coupled = (SporeCoupledEnd){.end = end};
  if (end->prescribed) return SPORE_COUPLED_NOTHING;
  coupled->v = sites[end->body].v;
  switch (end->mapping->kind) {
  case SPORE_MAPPING_FIXED:
  case SPORE_MAPPING_FRAMES:
    return SPORE_COUPLED_NOTHING;
  case SPORE_MAPPING_IDENTITY:
    coupled->v += 3 * (size_t)end->point;
    return SPORE_COUPLED_NODE;
  case SPORE_MAPPING_RIGID:
    spore_vec3_store(coupled->lever, end->offset);
    return SPORE_COUPLED_RIGID;
  case SPORE_MAPPING_LINEAR:
    break;
  }
  return SPORE_COUPLED_POINT;
}

SporeCoupling spore_coupling(const SporeEnd *a, const SporeEnd *b, const SporeMat3 *k, const SporeSite *sites) {
  assert(!a->prescribed || !b->prescribed);
  SporeCoupling coupling = {.k = {k->m[0], k->m[1], k->m[2], k->m[4], k->m[5], k->m[8]}};
  coupling.kind_a = couple(a, sites, &coupling.a);
  coupling.kind_b = couple(b, sites, &coupling.b);
  return coupling;
}

static inline SporeVec3 gather(unsigned char kind, const SporeCoupledEnd *end, const double *x) {
  x += end->v;
  switch (kind) {
  case SPORE_COUPLED_NODE:
    return spore_vec3_load(x);
  case SPORE_COUPLED_RIGID:
    return spore_vec3_add(spore_vec3_load(x), spore_vec3_cross(spore_vec3_load(x + 3), spore_vec3_load(end->lever)));
  case SPORE_COUPLED_POINT:
    return spore_mapping_velocity(end->end->mapping, end->end->point, NULL, x);
  default:
    return (SporeVec3){0, 0, 0};
  }
}

static inline void scatter(unsigned char kind, const SporeCoupledEnd *end, SporeVec3 force, double *y) {
  y += end->v;
  switch (kind) {
  case SPORE_COUPLED_NODE:
    spore_vec3_accumulate(y, force);
    return;
  case SPORE_COUPLED_RIGID:
    spore_vec3_accumulate(y, force);
    spore_vec3_accumulate(y + 3, spore_vec3_cross(spore_vec3_load(end->lever), force));
    return;
  case SPORE_COUPLED_POINT:
    spore_mapping_add_force(end->end->mapping, end->end->point, NULL, force, y);
    return;
  default:
    return;
  }
}

void spore_couplings_multiply(const SporeCoupling *couplings, size_t count, const double *x, double *y) {
  assert(count == 0 || (couplings && x != y));
  for (size_t i = 0; i < count; i++) {
    const SporeCoupling *c = &couplings[i];
    SporeVec3 u = spore_vec3_sub(gather(c->kind_a, &c->a, x), gather(c->kind_b, &c->b, x));
    SporeVec3 force = {c->k[0] * u.x + c->k[1] * u.y + c->k[2] * u.z, c->k[1] * u.x + c->k[3] * u.y + c->k[4] * u.z,
                       c->k[2] * u.x + c->k[4] * u.y + c->k[5] * u.z};
    scatter(c->kind_a, &c->a, force, y);
    scatter(c->kind_b, &c->b, spore_vec3_scale(-1, force), y);
  }
}

static void add_block(double *block, const SporeMat3 *k) {
  for (int e = 0; e < 9; e++) block[e] += k->m[e];
}

static void add_diagonal(unsigned char kind, const SporeCoupledEnd *end, const SporeMat3 *k, double *blocks) {
  blocks += 3 * end->v;
  if (kind == SPORE_COUPLED_NODE || kind == SPORE_COUPLED_RIGID) add_block(blocks, k);
  if (kind == SPORE_COUPLED_POINT) spore_mapping_add_diagonal(end->end->mapping, end->end->point, NULL, k, blocks);
  if (kind != SPORE_COUPLED_RIGID) return;
  SporeMat3 r = spore_mat3_skew(spore_vec3_load(end->lever));
  SporeMat3 turned = spore_mat3_multiply(spore_mat3_transpose(r), spore_mat3_multiply(*k, r));
  add_block(blocks + 9, &turned);
}

void spore_couplings_diagonal(const SporeCoupling *couplings, size_t count, double *blocks) {
  assert(count == 0 || (couplings && blocks));
  for (size_t i = 0; i < count; i++) {
    const SporeCoupling *c = &couplings[i];
    SporeMat3 k = {{c->k[0], c->k[1], c->k[2], c->k[1], c->k[3], c->k[4], c->k[2], c->k[4], c->k[5]}};
    add_diagonal(c->kind_a, &c->a, &k, blocks);
    add_diagonal(c->kind_b, &c->b, &k, blocks);
  }
}
