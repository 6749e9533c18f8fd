/* Contacts, from spheres to forces. The stages are:
 *   map      spheres follow the last good state;
 *   detect   the grid finds pairs of spheres that touch; the contact manifold says what each body feels of them;
 *   respond  each contact of the manifold becomes a contact term, which the solver evaluates;
 *   friction keeps the tangential springs and the overlaps of this step for the next one. */
#ifndef SPORE_SIM_CONTACT_H
#define SPORE_SIM_CONTACT_H

#include "core/collide/depth_field.h"
#include "core/collide/grid.h"
#include "core/constraint/coupling.h"
#include "core/sim/contact/contact_lanes.h"
#include "core/sim/state/state.h"

/* A contact of the manifold: what a body feels, and the pair of spheres by which its state finds the contact again in
 * the next step. */
typedef struct SporeManifoldContact {
  SporeContact contact;
  uint32_t pair_a, pair_b; /* sphere indices; of a body with a depth field, the first sphere of that body */
  bool field_a, field_b;   /* the body is felt as one depth field */
} SporeManifoldContact;

/* What is kept of a contact of a pair of spheres from one step to the next. */
typedef struct SporePairState {
  uint32_t sphere_a, sphere_b;
  double overlap;    /* part of the depth that motion has not made, m: see SporeContactTerm */
  SporeVec3 stretch; /* of friction's tangential spring, m */
  SporeVec3 normal;  /* of the contact: it tells several contacts of one pair apart, as a sphere may touch a depth field
                        in several places */
} SporePairState;

/* The contacts of the world. Arrays of `capacity` grow between steps only where there are more contacts than ever
 * before.
 */
typedef struct SporeContactSystem {
  SporeSpheres spheres;
  uint64_t mapped; /* number of the state (SporeSnapshots) that the spheres were last mapped from */
  double *reach;   /* radius by which the grid looks for pairs, m: that of the sphere plus a margin */
  SporeGrid *grid; /* NULL where nothing can touch */
  bool any_put;    /* some body was put where it is since the last step */
  size_t missed;   /* contacts that the last detection had no room for */
  size_t count, capacity;
  SporeManifoldContact *manifold; /* capacity */
  SporeContactTerm *terms;        /* capacity */
  SporeContactLanes *lanes;       /* contacts of all islands, side by side for vector instructions */
  double *frames;                 /* SPORE_FRAME_DOUBLES a body: frames of rigid bodies at the last evaluation */
  SporeCoupling *couplings;       /* capacity, in the order of `order` */
  uint32_t *order;                /* capacity: indices of contacts, island by island */
  size_t pair_count;              /* entries of pairs, which is in the order of the pairs */
  SporePairState *pairs, *pairs_scratch;
} SporeContactSystem;

/* How a body meets others in a step: see passing.c. */
typedef struct SporeImpact {
  uint64_t step;  /* number of the step, from 1; of no other step the rest means anything */
  double at_s;    /* when the first of its contacts would be as deep as the radius, if nothing stopped it */
  double support; /* energy that all of its contacts would hold then, J */
} SporeImpact;

/* The collision unit of a body. */
typedef struct SporeCollisionUnit {
  SporeContactFields fields;
  SporeMapping spheres;
  size_t start;          /* index of the body's first sphere among all spheres */
  SporeDepthField field; /* empty: the body's spheres are felt one by one */
  double *whole_weight;  /* weights of `spheres` before anything was cut, for a reset; NULL: nothing can cut the body */
  bool put;              /* the body was put where it is, or changed, since the last step: see spore_body_put */
  bool moved;            /* its spheres are not where they were a step ago */
  bool pulled;           /* a viewer's pull moves the body: what it enters it has not entered by its own motion */
  SporeImpact impact;
} SporeCollisionUnit;

/* contacts.c */
/* Stage: maps the spheres from the last good state. */
void spore_world_map_spheres(SporeWorld *world);
/* Speed of a rigid body, m/s, below which what it meets is no impact: what falls for a few steps is as fast. */
double spore_world_slowest_impact(const SporeWorld *world);
/* Stage: finds the pairs of spheres that touch, and fills the manifold. */
void spore_world_detect(SporeWorld *world);
/* Stage: makes contact terms of the manifold. */
void spore_world_respond(SporeWorld *world);
/* Fills the end of a term from its body: position and velocity when the step begins. */
void spore_world_fill_end(const SporeWorld *world, SporeEnd *end);
/* Makes room for as many contacts as the grid may find. False: no memory. */
bool spore_world_reserve_contacts(SporeWorld *world);
void spore_contacts_clear(SporeContactSystem *contact);
/* Notes that the body was put where it is, not moved there: what it overlaps next is an overlap, and it has passed
 * nothing on its way. */
void spore_body_put(SporeWorld *world, uint32_t body);
/* Forgets all contacts, since bodies were put in another state. */
void spore_contacts_forget(SporeWorld *world);

/* depth_contacts.c: bodies that are felt as one depth field. */
bool spore_world_create_fields(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Fills the manifold from the contacts found, in the order of their pairs; returns the number of its contacts. */
size_t spore_world_find_manifold(SporeWorld *world);

/* pair_state.c */
/* Makes room for the states of more contacts. False: no memory. */
bool spore_pairs_reserve(SporeWorld *world, size_t old_contacts, size_t contacts);
/* Gives the contacts of this step the tangential springs and the overlaps that their pairs had at the end of the last
 * step. */
void spore_world_restore_pairs(SporeWorld *world);
/* Stage: keeps them at the end of the step, for the next step. */
void spore_world_keep_pairs(SporeWorld *world);

/* passing.c: counts and reports bodies that contacts do not hold: that come too fast, are deeper than the radius of a
 * sphere, or passed each other in the step before. */
void spore_world_watch_passing(SporeWorld *world);

#endif
