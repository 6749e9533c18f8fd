/* Island system: an island as the integrators see it. For island_system.c (forces, motion) and linearise.c (matrices).
 */
#ifndef SPORE_SIM_ISLAND_SYSTEM_H
#define SPORE_SIM_ISLAND_SYSTEM_H

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/constraint/pin.h"
#include "core/math/vector.h"
#include "core/sim/world_private.h"

/* An island, and what an integrator has set for it. Must live as long as the dynamics that are made of it. */
typedef struct SporeIslandSystem {
  SporeWorld *world;
  const SporeIsland *island;
  const double *shape;   /* a q of the island: where viscous forces are evaluated; NULL: at the q of each force */
  double shape_s;        /* forces are evaluated where nodes moved from `shape` along v for this time; 0: anywhere */
  const double *given;   /* a constant force besides those of bodies and terms; NULL: none */
  bool apart;            /* particles that go alone take part by their mass only: see multirate.c */
  bool sweeping;         /* forces are those that no sweep meets */
  bool meets;            /* contacts are met in the sweep: no force is asked of them */
  bool balance;          /* its bodies are to be in balance: they give A their whole stiffness */
  double drift_s;        /* the longest that bodies moved free of force at once */
  double start_s, now_s; /* since the world step began: start of the integrator's step; time of the prescribed ends */
  size_t contact_couplings, spring_couplings; /* couplings of the current A: see local_assembly.h */
  SporeTangentForm tangent;                   /* what A takes of the stiffness of bodies and links */
  bool together;                              /* the preconditioner is a factor of the whole matrix */
  bool coupled;                               /* it holds the couplings: see coupled_factor.c */
  bool coupled_fresh;                         /* by factors of the last linearisation */
  double coupled_c, coupled_c2;               /* and is of these; of the last linearisation: */
  double linearised_c, linearised_c2;
  double *work, iteration_work;  /* what recall counts in, or NULL; of an iteration: see coupled_factor.c */
  size_t products;               /* with A, since then */
  size_t dragging;               /* contacts with a drag, which the current A leaves out */
  bool driven;                   /* a device moves some end */
  bool frames;                   /* some contacts are evaluated by the frames of rigid bodies */
  bool asked_couples, couples;   /* see spore_island_system_couples */
  SporeKeptEquations *equations; /* where solved equations are kept; NULL: none is solved */
} SporeIslandSystem;

SporeDynamics spore_island_system_dynamics(SporeIslandSystem *system);
/* Whether a step of h seconds is short for all contacts of the island, and for its links: h w (h k + d) is at most
 * 0.25, w the sum of n/m over the blocks of both ends, n the number of terms that share a block. Taken in substeps, h
 * is that much less for links and for the damping of contacts; but not for their stiffness, since contacts are found
 * once a step. */
bool spore_island_system_resolves(const SporeIslandSystem *system, double h, size_t substeps, bool links);
/* The longest step, s, with (h^2 w k + (h w d)^2)^1/2 no more than `part`, in radians, for all contacts; 0: none has a
 * stiffness or damping. For islands without links. */
double spore_island_system_short_step(const SporeIslandSystem *system, double part);
/* Whether a pin holds the island, or a link to a body that physics does not move. */
bool spore_island_system_is_held(const SporeIslandSystem *system);
/* A digest of the laws of contacts and links: where it changed, forces at the same q, v and t are others. */
uint64_t spore_island_system_laws(const SporeIslandSystem *system);
/* contact_lanes.c: writes the forces of contacts into the terms, after the last evaluation. */
void spore_island_system_keep_contacts(const SporeIslandSystem *system);

/* The i-th body of the island, and its place in the local vectors. */
static inline SporeBody *spore_island_system_body(const SporeIslandSystem *system, size_t i, const SporeSite **site) {
  assert(i < system->island->body_count);
  uint32_t index = system->world->solve.island_bodies[system->island->body_start + i];
  assert(index < system->world->body_count);
  *site = &system->world->solve.local_sites[index];
  return &system->world->bodies[index];
}

static inline SporeContactTerm *spore_island_system_contact(const SporeIslandSystem *system, size_t i) {
  assert(i < system->island->contact_count);
  uint32_t index = system->world->contact.order[system->island->contact_start + i];
  assert(index < system->world->contact.count);
  return &system->world->contact.terms[index];
}

static inline SporeSpringTerm *spore_island_system_spring(const SporeIslandSystem *system, size_t i) {
  assert(i < system->island->spring_count);
  uint32_t index = system->world->links.order[system->island->spring_start + i];
  assert(index < spore_world_spring_count(system->world));
  return &system->world->links.springs[index];
}

/* Whether the body moves by a method of its own, and takes part in this system by its mass only: see multirate.c. */
static inline bool spore_island_system_leaves(const SporeIslandSystem *system, const SporeBody *body) {
  return system->apart && spore_body_goes_alone(body);
}

/* Whether the body has a matrix of its own in A; else it has its mass there. */
static inline bool spore_island_system_assembles(const SporeIslandSystem *system, const SporeBody *body) {
  return body->preconditioner.matrix.block_count > 0 && !spore_island_system_leaves(system, body);
}

/* Share of its inertia that a body keeps in steps: a static body that pins hold has next to none beside others. */
static inline double spore_island_system_inertia(const SporeIslandSystem *system, const SporeBody *body) {
  return system->apart && spore_body_is_static(body) && body->held.pin_count > 0 ? 1e-6 : 1;
}

static inline double *spore_island_system_precondition_blocks(const SporeIslandSystem *system) {
  return system->world->solve.precondition + 3 * system->island->v_start;
}

static inline const double *spore_island_system_mass(const SporeIslandSystem *system, const SporeBody *body) {
  return system->world->state.mass + 3 * body->v_offset;
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
static inline void spore_island_system_weigh(const SporeIslandSystem *system, const SporeBody *body, const double *x,
                                             double *y) {
  size_t nodes = body->model->node_count;
  spore_nodes_weigh(nodes, y, body->model->block_mass, x);
  spore_blocks_apply(spore_island_system_mass(system, body) + 9 * nodes, body->block_count - nodes, x + 3 * nodes,
                     y + 3 * nodes);
  double inertia = spore_island_system_inertia(system, body);
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

static inline void spore_island_system_filter(const SporeIslandSystem *system, double *vector) {
  for (size_t b = 0; b < system->island->kept_count; b++) {
    const SporeSite *site;
    SporeBody *body = spore_island_system_body(system, b, &site);
    spore_pin_filter(body->held.blocks, body->held.count, vector + site->v);
  }
}

/* contact_lanes.c. Puts contacts into lanes. Adds the forces of all contacts. */
void spore_island_system_lay_contacts(SporeIslandSystem *system);
void spore_island_system_add_contact_forces(const SporeIslandSystem *system, const double *q, const double *v,
                                            double *f);

/* Where contacts are met one after the other: at the end of a step of an integrator. */
typedef struct SporeContactSweep {
  double h;             /* s, the step */
  const double *before; /* q of the island when it began */
  double *q, *v;        /* where it ends */
  const double *rows;   /* of the island's blocks, as in SporeSweep: the inverse masses count */
} SporeContactSweep;

/* contact_sweep.c. Whether sweeps may move all that the contacts of the island touch, and there are some. One sweep
 * over them, in their order; their forces are left in the terms. */
bool spore_island_system_can_meet(const SporeIslandSystem *system);
void spore_island_system_meet_contacts(const SporeIslandSystem *system, const SporeContactSweep *at);

/* island_factor.c. Whether the island is of rigid bodies alone, and of few. Factorises A as a whole where conjugate
 * gradients did not solve such an island; blocks: the bodies' own diagonal blocks, 9 each. False: it is not done, or
 * not positive definite. z = A^-1 r by that factor. */
bool spore_island_system_is_small(const SporeIslandSystem *system);
bool spore_island_system_wants_factor(const SporeIslandSystem *system);
/* Sets preconditioner.turning of the bodies, zero where no such factor is wanted. After the forces at the place of the
 * linearisation. */
void spore_island_system_load_levers(const SporeIslandSystem *system, double c2);
bool spore_island_system_factorise(const SporeIslandSystem *system, const double *blocks);
void spore_island_system_factor_solve(const SporeIslandSystem *system, const double *r, double *z);

/* coupled_factor.c: slots of SporeDynamics. After a linearisation: takes in its couplings. z = P^-1 r where z is what
 * the bodies alone make of r. */
SporePatience spore_island_system_coupling_patience(void *data);
bool spore_island_system_couple(void *data);
/* Where that preconditioner of an earlier step saves work, it serves again; counts the work of the step from here on.
 */
void spore_island_system_recall_coupled(SporeIslandSystem *system);
double spore_island_system_iteration_work(const SporeIslandSystem *system);
static inline void spore_island_system_count(const SporeIslandSystem *system, double work) {
  if (system->work) *system->work += work;
}
void spore_island_system_update_coupled(SporeIslandSystem *system);
void spore_island_system_take_in_couplings(SporeIslandSystem *system, const double *r, bool dragged, double *z);

/* body_factor.c. Diagonal blocks of the models' part of A; M alone where there is no matrix. */
void spore_island_system_body_diagonal(const SporeIslandSystem *system, const SporeBody *body, double *blocks);
/* Factorises the body's own matrix, its diagonal blocks replaced by `blocks` unless that is NULL. alone: without
 * couplings. Where the matrix is not positive definite in floating point, block-Jacobi is used instead. */
void spore_body_factorise(SporeBody *body, const double *blocks, bool alone);
/* Whether the numbers of the factor are those of a matrix without couplings, of the same c and c2 as the present one.
 */
bool spore_body_has_bare_factor(const SporeBody *body);
/* z = P^-1 r by the bodies' factors or diagonal blocks. */
void spore_island_system_solve_bodies(const SporeIslandSystem *system, const double *r, double *z);

/* linearise.c: the slots of SporeDynamics for A = M + c D + c2 K. */
void spore_island_system_linearise(void *data, const double *q, const double *from, const double *v, double c,
                                   double c2);
/* Whether the matrix of some body is its whole stiffness, which may be negative. */
bool spore_island_system_buckles(const SporeIslandSystem *system);
bool spore_island_system_definite(void *data);
bool spore_island_system_reuse(void *data, const double *q, const double *v, double c, double c2);
void spore_island_system_multiply(void *data, const double *x, double *y);
void spore_island_system_multiply_dragged(void *data, const double *x, double *y);
bool spore_island_system_drags(void *data);
void spore_island_system_precondition(void *data, const double *r, double *z);
void spore_island_system_precondition_dragged(void *data, const double *r, double *z);
double spore_island_system_factor_cost(void *data);
bool spore_island_system_factorised(void *data);
size_t spore_island_system_factor_patience(void *data);
double spore_island_system_rounding(void *data, double c, bool stiff_axes);

#endif
