/* Contacts, from spheres to forces. The stages are:
 *   map      spheres follow the last good state;
 *   detect   the grid finds pairs of spheres that touch; the contact manifold says what each body feels of them;
 *   respond  each contact of the manifold becomes a contact term, which the solver evaluates;
 *   friction keeps the tangential springs of this step for the next one. */
#ifndef SPORE_SIM_CONTACT_H
#define SPORE_SIM_CONTACT_H

#include "core/collide/depth_field.h"
#include "core/collide/grid.h"
#include "core/constraint/coupling.h"
#include "core/sim/contact/contact_lanes.h"
#include "core/sim/state/state.h"

/* A contact of the manifold: what a body feels, and the pair of spheres by which friction finds the contact again in
 * the next step. */
typedef struct SporeManifoldContact {
  SporeContact contact;
  uint32_t pair_a, pair_b; /* sphere indices; of a body with a depth field, the first sphere of that body */
  bool field_a, field_b;   /* the body is felt as one depth field */
} SporeManifoldContact;

/* What friction keeps of a pair of spheres from one step to the next. */
typedef struct SporeFrictionState {
  uint32_t sphere_a, sphere_b;
  SporeVec3 stretch; /* of the tangential spring, m */
  SporeVec3 normal;  /* of the contact: it tells several contacts of one pair apart, as a sphere may touch a depth field
                        in several places */
} SporeFrictionState;

/* The contacts of the world. Arrays of `capacity` grow between steps only where there are more contacts than ever
 * before.
 */
typedef struct SporeContactSystem {
  SporeSpheres spheres;
  uint64_t mapped; /* number of the state (SporeSnapshots) that the spheres were last mapped from */
  double *reach;   /* radius by which the grid looks for pairs, m: that of the sphere plus a margin */
  SporeGrid *grid; /* NULL where nothing can touch */
  size_t missed;   /* contacts that the last detection had no room for */
  size_t count, capacity;
  SporeManifoldContact *manifold; /* capacity */
  SporeContactTerm *terms;        /* capacity */
  SporeContactLanes *lanes;       /* contacts of all islands, side by side for vector instructions */
  double *frames;                 /* SPORE_FRAME_DOUBLES a body: frames of rigid bodies at the last evaluation */
  SporeCoupling *couplings;       /* capacity, in the order of `order` */
  uint32_t *order;                /* capacity: indices of contacts, island by island */
  size_t friction_count;          /* entries of friction, which is in the order of the pairs */
  SporeFrictionState *friction, *friction_scratch;
} SporeContactSystem;

/* The collision unit of a body. */
typedef struct SporeCollisionUnit {
  SporeContactFields fields;
  SporeMapping spheres;
  size_t start;          /* index of the body's first sphere among all spheres */
  SporeDepthField field; /* empty: the body's spheres are felt one by one */
  double *whole_weight;  /* weights of `spheres` before anything was cut, for a reset; NULL: nothing can cut the body */
} SporeCollisionUnit;

/* contacts.c */
/* Stage: maps the spheres from the last good state. */
void spore_world_map_spheres(SporeWorld *world);
/* Stage: finds the pairs of spheres that touch, and fills the manifold. */
void spore_world_detect(SporeWorld *world);
/* Stage: makes contact terms of the manifold. */
void spore_world_respond(SporeWorld *world);
/* Fills the end of a term from its body: position and velocity when the step begins. */
void spore_world_fill_end(const SporeWorld *world, SporeEnd *end);
/* Makes room for as many contacts as the grid may find. False: no memory. */
bool spore_world_reserve_contacts(SporeWorld *world);
void spore_contacts_clear(SporeContactSystem *contact);

/* depth_contacts.c: bodies that are felt as one depth field. */
bool spore_world_create_fields(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Fills the manifold from the contacts found, in the order of their pairs; returns the number of its contacts. */
size_t spore_world_find_manifold(SporeWorld *world);

/* friction_state.c */
/* Makes room for the friction of more contacts. False: no memory. */
bool spore_friction_reserve(SporeWorld *world, size_t old_contacts, size_t contacts);
/* Gives the contacts of this step the tangential springs that their pairs had at the end of the last step. */
void spore_world_restore_friction(SporeWorld *world);
/* Stage: keeps the tangential springs at the end of the step, for the next step. */
void spore_world_keep_friction(SporeWorld *world);

#endif
