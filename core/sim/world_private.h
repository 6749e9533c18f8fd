/* The structure of a world: its bodies, and one structure for each room of core/sim. Every file of these rooms includes
 * this header; core/README.md defines which room may call which. */
#ifndef SPORE_SIM_WORLD_PRIVATE_H
#define SPORE_SIM_WORLD_PRIVATE_H

#include "core/haptic/guard.h"
#include "core/sim/contact/contact.h"
#include "core/sim/effect/effect.h"
#include "core/sim/effect/lens.h"
#include "core/sim/effect/stain.h"
#include "core/sim/link/link.h"
#include "core/sim/lod/lod.h"
#include "core/sim/solve/solve.h"
#include "core/sim/state/state.h"
#include "core/sim/step.h"
#include "core/sim/tool/tool.h"
#include "core/sim/topology/topology.h"
#include "core/sim/world.h"

/* The device of an active body, its input and its feedback. */
typedef struct SporeBodyDevice {
  SporeDevice *device; /* borrowed; NULL: none */
  SporeGuard guard;
  SporeDeviceState input;     /* after the guard */
  SporeDeviceCommand command; /* feedback to the device */
  SporePassivity passivity;   /* limits the feedback of a device that pushes a hand */
  double input_time_s;
  bool has_input; /* the device has reported a state since the last reset */
} SporeBodyDevice;

struct SporeBody {
  char *name;
  SporeRole role;
  SporePose rest_pose; /* of the frame that the body is made in, at time 0 */
  double *start;       /* q_count of the first level: the state at time 0; NULL: as the model places it */
  SporeModel *model;
  double total_mass;                               /* kg, of the model */
  SporeLod *lod;                                   /* NULL: the body has one level of detail */
  SporeLodGrade grade;                             /* active level: model, matrix, spheres and pins are of this level */
  size_t q_offset, q_count, v_offset, block_count; /* place in q and v; v_offset in doubles */
  size_t q_most, block_most; /* largest counts so far: values behind the present ones are 0 up to there */
  uint64_t changed;          /* number of the newest state in which the body differs from the state before */
  bool altered;              /* cut, torn or coagulated since time 0: the body keeps its level */
  bool frozen;
  SporeBodyEffect effect;
  double parking_gap;  /* m, between particles out of the world; 0: no particle leaves */
  double parking_lane; /* m: the y of these particles, so that those of two bodies do not meet */
  SporeBodyMethod method;
  SporeHeldBlocks held;
  SporeCollisionUnit collision;
  SporePreconditioner preconditioner;
  SporeBodyHistory history;
  SporeBodySleep sleep;
  double own_energy;            /* kinetic and of the model, when the energy watch began, J */
  SporePause pause, impatience; /* of recovery by smaller steps, in steps; and with patience, in recoveries */
  uint32_t hopeless;            /* steps that could not be solved at all, in a row: see recovery.c */
  uint64_t hopeless_step;       /* number of the last one */
  SporeReported reported;
  SporeChangingMatrix changing; /* of a body that is split or refined */
  SporeNodeSplitting splitting;
  SporeSplineRefinement refinement;
  SporeBodyDevice device;
  SporeBodyMarks marks;
};

struct SporeWorld {
  size_t body_count;
  SporeBody *bodies;
  SporeSolverFields solver;
  SporePool *pool;
  const SporeCancel *cancel;
  bool has_lod; /* some body has levels of detail */
  SporeLodSystem levels;
  SporeCommands commands;
  SporeSchedule schedule;
  SporeState state;
  SporeContactSystem contact;
  SporeSolve solve;
  SporeLinkSystem links;
  SporeTopology topology;
  SporeToolSystem tools;
  SporeStains stains;
  SporeLenses lenses;
};

/* Whether physics moves the body; `body` may be SPORE_NO_BODY. */
static inline bool spore_body_is_passive(const SporeWorld *world, uint32_t body) {
  return body < world->body_count && world->bodies[body].role == SPORE_PASSIVE;
}
/* Whether the body is moved by physics, and not by an effect in its place. */
static inline bool spore_body_is_physical(const SporeBody *body) {
  return body->role == SPORE_PASSIVE && !body->effect.on;
}
/* The time for which the body's drops go on in this step, s; 0: it is not poured, or they rest in this step. */
static inline double spore_body_pour_time(const SporeWorld *world, const SporeBody *body) {
  if (!body->effect.on || !body->effect.drops.from) return 0;
  double steps = fmax(1, round(SPORE_POUR_PACE_S / world->solver.time_step));
  return world->state.step % (uint64_t)steps == 0 ? steps * world->solver.time_step : 0;
}
/* Whether physics moves the body in this step. */
static inline bool spore_body_moves(const SporeBody *body) {
  return spore_body_is_physical(body) && !body->frozen && !body->sleep.asleep;
}
/* Whether the body stays where it is in this step, so that its next state is not written. */
static inline bool spore_body_lies_still(const SporeBody *body) {
  return body->sleep.asleep || (body->effect.on && body->effect.settled);
}
/* Whether the body's own forces are independent of its velocity. */
static inline bool spore_body_is_static(const SporeBody *body) {
  return body->method.integrator == SPORE_INTEGRATOR_STATIC;
}
/* Whether the body keeps its explicit method where contacts and links are implicit: see multirate.c. Only particles do,
 * which have no Jacobian for an implicit step. */
static inline bool spore_body_goes_alone(const SporeBody *body) {
  return !spore_integrator(body->method.integrator)->implicit && body->model->type->rates;
}
/* Whether the elements of the body are met one after the other. */
static inline bool spore_body_sweeps(const SporeBody *body) {
  return spore_integrator(body->method.integrator)->sweeps && spore_model_sweeps(body->model);
}
/* Gravity on the body, less its buoyancy in air, m/s^2. */
static inline SporeVec3 spore_body_gravity(const SporeWorld *world, const SporeBody *body) {
  return spore_vec3_scale(1 - body->model->buoyancy, world->state.gravity);
}
/* Whether ties between the body's nodes may be cut. The drawn surface follows cuts of the finest level only. */
static inline bool spore_body_can_be_cut(const SporeBody *body) {
  return body->model && body->model->type->cut && body->grade == SPORE_LOD_FINE;
}
static inline size_t spore_world_spring_count(const SporeWorld *world) {
  return world->links.term_count + world->links.hold_count + world->body_count;
}

/* state/bodies.c */
/* Calls `call` for the body's model at each of its levels of detail. */
void spore_body_each_model(const SporeBody *body, void (*call)(SporeModel *model, void *user), void *user);
/* As spore_world_map_lod, with what may end it. */
bool spore_body_map(const SporeWorld *world, uint32_t body, SporeLodGrade level, const double *points, size_t count,
                    const SporeCancel *cancel, SporeMapping *mapping, SporeError *error);

/* contact/contacts.c: maps the centres of the set onto the body's present level, into its collision unit.
 * set: may be NULL. */
bool spore_body_map_spheres(SporeWorld *world, uint32_t body, const SporeSphereSet *set, SporeError *error);

/* Maps one point that lies at `at` (world, m) at time 0, and sets the end of a term there. */
bool spore_world_attach(SporeWorld *world, uint32_t body, SporeVec3 at, SporeMapping *mapping, SporeEnd *end,
                        SporeError *error);
/* A point of the world at time 0, in the frame of a body. */
SporeVec3 spore_world_to_frame(const SporeWorld *world, uint32_t body, SporeVec3 at);

#endif
