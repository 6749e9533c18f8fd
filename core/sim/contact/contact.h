/* Contacts: spheres that follow the state, pairs of spheres that touch, the contact manifold, contact terms, and the
 * state of friction between two steps. */
#ifndef SPORE_SIM_CONTACT_H
#define SPORE_SIM_CONTACT_H

#include "core/collide/depth_field.h"
#include "core/collide/grid.h"
#include "core/constraint/coupling.h"
#include "core/sim/contact/contact_lanes.h"
#include "core/sim/state/state.h"

/* A contact of the manifold, and the pair of spheres that identifies the contact for friction. */
typedef struct SporeManifoldContact {
  SporeContact contact;
  uint32_t pair_a, pair_b; /* spheres; for a body with a depth field, its first sphere */
  bool field_a, field_b;   /* the contact is with the depth field of the body */
} SporeManifoldContact;

/* State of friction between a pair of spheres, from one step to the next. */
typedef struct SporeFrictionState {
  uint32_t sphere_a, sphere_b;
  SporeVec3 stretch; /* of the tangential spring, m */
  SporeVec3 normal;  /* of the contact: a sphere may touch a depth field in several places */
} SporeFrictionState;

typedef struct SporeContactSystem {
  SporeSpheres spheres;
  uint64_t mapped; /* number of the state that the spheres were last mapped from */
  double *reach;   /* radius of each sphere for the grid, m */
  SporeGrid *grid; /* NULL where nothing can touch */
  size_t missed;   /* contacts that found no room in the last detection */
  size_t count, capacity;
  SporeManifoldContact *manifold; /* capacity */
  SporeContactTerm *terms;        /* capacity */
  SporeContactLanes *lanes;       /* room for those of all islands */
  double *frames;                 /* SPORE_FRAME_DOUBLES a body: frames of rigid bodies at the last evaluation */
  SporeCoupling *couplings;       /* capacity, in the order of `order` */
  uint32_t *order;                /* capacity: contacts, island by island */
  size_t friction_count;          /* in the order of the pairs */
  SporeFrictionState *friction, *friction_scratch;
} SporeContactSystem;

/* A body's collision unit. */
typedef struct SporeCollisionUnit {
  SporeContactFields fields;
  SporeMapping spheres;
  size_t start;                   /* its first sphere among those of the world */
  SporeDepthField field;          /* empty: others touch its spheres one by one */
  double *whole_weight;           /* weights of the mapping before anything was cut; NULL: nothing cuts the body */
  uint64_t soft_since, soft_last; /* see soft_contact.c: number of the step, from 1 */
} SporeCollisionUnit;

/* contacts.c */
/* Stages: maps the spheres from the state; finds the pairs that touch; makes terms of them. */
void spore_world_map_spheres(SporeWorld *world);
void spore_world_detect(SporeWorld *world);
void spore_world_respond(SporeWorld *world);
/* Sets the place of the end when the step begins, and its velocity where it is prescribed. */
void spore_world_fill_end(const SporeWorld *world, SporeEnd *end);
/* Makes room for as many contacts as the grid finds. False: no memory. */
bool spore_world_reserve_contacts(SporeWorld *world);
void spore_contacts_clear(SporeContactSystem *contact);

/* depth_contacts.c: bodies whose surface is one depth field. */
bool spore_world_create_fields(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Fills the manifold from the contacts found, in the order of their pairs. Returns the number of contacts. */
size_t spore_world_find_manifold(SporeWorld *world);

/* friction_state.c */
bool spore_friction_reserve(SporeWorld *world, size_t old_contacts, size_t contacts);
/* Gives each new contact the state of friction that its pair had when the last step ended. */
void spore_world_restore_friction(SporeWorld *world);
/* Stage: keeps the state of friction at the end of the step. */
void spore_world_keep_friction(SporeWorld *world);

/* soft_contact.c. Stage: reports contacts at rest that are too soft because the step is too long. */
void spore_world_watch_contacts(SporeWorld *world);

#endif
