/* An island as the integrators see it, for dynamics.c (forces, motion) and linearise.c (matrices). */
#ifndef SPORE_SIM_GROUP_H
#define SPORE_SIM_GROUP_H

#include <math.h>
#include <string.h>

#include "core/constraint/pin.h"
#include "core/math/vector.h"
#include "core/sim/world_private.h"

/* The i-th body of the island, and where its part begins in the local vectors. */
static inline SporeBody *spore_group_body(const SporeGroup *group, size_t i, const SporeSite **site) {
  uint32_t index = group->world->island_bodies[group->island->body_start + i];
  *site = &group->world->local_sites[index];
  return &group->world->bodies[index];
}

static inline SporeContactTerm *spore_group_contact(const SporeGroup *group, size_t i) {
  uint32_t index = group->world->contact_order[group->island->contact_start + i];
  return &group->world->contacts[index];
}

static inline SporeSpringTerm *spore_group_spring(const SporeGroup *group, size_t i) {
  uint32_t index = group->world->spring_order[group->island->spring_start + i];
  return &group->world->springs[index];
}

/* Whether the body moves by a method of its own in this group, and takes part with its mass alone: see mixed.c. */
static inline bool spore_group_leaves(const SporeGroup *group, const SporeBody *body) {
  return group->apart && !spore_integrator(body->integrator)->implicit;
}

/* Whether the body has a matrix of its own in A; else its mass stands for it. */
static inline bool spore_group_assembles(const SporeGroup *group, const SporeBody *body) {
  return body->matrix.block_count > 0 && !spore_group_leaves(group, body);
}

/* What is left of the inertia of a body in steps: static ones that pins hold have next to none beside others. */
static inline double spore_group_inertia(const SporeGroup *group, const SporeBody *body) {
  return group->apart && spore_body_is_static(body) && body->pin_count > 0 ? 1e-6 : 1;
}

static inline double *spore_group_precondition_blocks(const SporeGroup *group) {
  return group->world->precondition + 3 * group->island->v_start;
}

static inline const double *spore_group_mass(const SporeGroup *group, const SporeBody *body) {
  return group->world->mass + 3 * body->v_offset;
}

/* y = blocks x, or y += scale blocks x */
static inline void spore_blocks_apply(const double *blocks, size_t count, const double *x, double *y) {
  for (size_t i = 0; i < count; i++, blocks += 9, x += 3, y += 3) {
    double a = x[0], b = x[1], c = x[2];
    y[0] = blocks[0] * a + blocks[1] * b + blocks[2] * c;
    y[1] = blocks[3] * a + blocks[4] * b + blocks[5] * c;
    y[2] = blocks[6] * a + blocks[7] * b + blocks[8] * c;
  }
}

static inline void spore_blocks_add(const double *blocks, size_t count, double scale, const double *x, double *y) {
  for (size_t i = 0; i < count; i++, blocks += 9, x += 3, y += 3) {
    double a = scale * x[0], b = scale * x[1], c = scale * x[2];
    y[0] += blocks[0] * a + blocks[1] * b + blocks[2] * c;
    y[1] += blocks[3] * a + blocks[4] * b + blocks[5] * c;
    y[2] += blocks[6] * a + blocks[7] * b + blocks[8] * c;
  }
}

/* y = M x of a body */
static inline void spore_group_weigh(const SporeGroup *group, const SporeBody *body, const double *x, double *y) {
  size_t nodes = body->model->node_count;
  spore_nodes_weigh(nodes, y, body->model->block_mass, x);
  spore_blocks_apply(spore_group_mass(group, body) + 9 * nodes, body->block_count - nodes, x + 3 * nodes,
                     y + 3 * nodes);
  double inertia = spore_group_inertia(group, body);
  for (size_t k = 0; inertia != 1 && k < 3 * body->block_count; k++) y[k] *= inertia;
}

/* Inverses of symmetric blocks. One without an inverse gets that of its trace: a preconditioner may be rough, but not
 * singular. */
static inline void spore_blocks_invert(double *blocks, size_t count) {
  for (size_t i = 0; i < count; i++, blocks += 9) {
    double xx = blocks[0], xy = blocks[1], xz = blocks[2], yy = blocks[4], yz = blocks[5], zz = blocks[8];
    double a = yy * zz - yz * yz, b = xz * yz - xy * zz, c = xy * yz - xz * yy;
    double determinant = xx * a + xy * b + xz * c, mean = (xx + yy + zz) / 3;
    if (determinant > 0 && determinant > 1e-30 * mean * mean * mean && isfinite(1 / determinant)) {
      double s = 1 / determinant, e = xy * xz - xx * yz;
      double inverse[9] = {
          a * s, b * s, c * s, b * s, (xx * zz - xz * xz) * s, e * s, c * s, e * s, (xx * yy - xy * xy) * s};
      memcpy(blocks, inverse, sizeof inverse);
      continue;
    }
    SporeMat3 inverse = spore_mat3_scale(mean > 0 ? 1 / mean : 1, spore_mat3_identity());
    memcpy(blocks, inverse.m, sizeof inverse.m);
  }
}

static inline void spore_group_filter(const SporeGroup *group, double *vector) {
  for (size_t b = 0; b < group->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_group_body(group, b, &site);
    spore_pin_filter(body->held, body->held_count, vector + site->v);
  }
}

/* contact_lanes.c: terms are as stiff as they are, and contacts lie in lanes; adds the forces of all contacts; takes
 * over how the terms were softened. */
void spore_group_lay_contacts(SporeGroup *group);
void spore_group_add_contact_forces(const SporeGroup *group, const double *q, const double *v, double *f);
void spore_group_soften_lanes(const SporeGroup *group);

/* linearise.c: the slots of SporeDynamics that stand for A = M + c D + c2 K. */
void spore_group_linearise(void *data, const double *q, const double *from, const double *v, double c, double c2);
bool spore_group_reuse(void *data, const double *q, const double *v, double c, double c2);
void spore_group_multiply(void *data, const double *x, double *y);
void spore_group_multiply_dragged(void *data, const double *x, double *y);
bool spore_group_drags(void *data);
void spore_group_precondition(void *data, const double *r, double *z);
double spore_group_factor_cost(void *data);
bool spore_group_factorised(void *data);
double spore_group_rounding(void *data, double c, bool stiff_axes);

#endif
