/* Contacts: spheres that follow the state, the pairs of them that touch, the contact manifold, contact terms, and what
 * friction remembers from one step to the next. */
#ifndef SPORE_SIM_CONTACT_H
#define SPORE_SIM_CONTACT_H

#include "core/collide/depth_field.h"
#include "core/collide/grid.h"
#include "core/constraint/coupling.h"
#include "core/sim/contact/contact_lanes.h"
#include "core/sim/state/state.h"

/* A contact of the manifold: what a body feels, and the pair of spheres that friction remembers the contact by. */
typedef struct SporeManifoldContact {
  SporeContact contact;
  uint32_t pair_a, pair_b; /* spheres; of a body with a depth field the first sphere of the body */
  bool field_a, field_b;   /* the body is felt as one depth field */
} SporeManifoldContact;

/* What friction holds of a pair of spheres between two steps. */
typedef struct SporeFrictionState {
  uint32_t sphere_a, sphere_b;
  SporeVec3 stretch; /* of the tangential spring, m */
  SporeVec3 normal;  /* of the contact: a sphere may touch a body with a depth field in several places */
} SporeFrictionState;

typedef struct SporeContactSystem {
  SporeSpheres spheres;
  uint64_t mapped; /* number of the state that the spheres were last mapped from */
  double *reach;   /* radius of each sphere as the grid sees it, m */
  SporeGrid *grid; /* NULL where nothing can touch */
  size_t missed;   /* contacts without room in the last detection */
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
  size_t start;                   /* its first sphere in the world's */
  SporeDepthField field;          /* empty: its spheres are felt one by one */
  double *whole_weight;           /* weights of the mapping before anything was cut; NULL: nothing cuts the body */
  uint64_t soft_since, soft_last; /* see soft_contact.c: number of the step, from 1 */
} SporeCollisionUnit;

/* contacts.c */
/* Stages: maps the spheres from the state; finds the pairs that touch; makes terms of them. */
void spore_world_map_spheres(SporeWorld *world);
void spore_world_detect(SporeWorld *world);
void spore_world_respond(SporeWorld *world);
/* Puts the end where its body is when the step begins. */
void spore_world_fill_end(const SporeWorld *world, SporeEnd *end);
/* Room for as many contacts as the grid finds. False: no memory. */
bool spore_world_reserve_contacts(SporeWorld *world);
void spore_contacts_clear(SporeContactSystem *contact);

/* depth_contacts.c: bodies that are felt as one depth field. */
bool spore_world_create_fields(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
/* Fills the manifold from the contacts found, in the order of their pairs; returns the number of its contacts. */
size_t spore_world_find_manifold(SporeWorld *world);

/* friction_state.c */
bool spore_friction_reserve(SporeWorld *world, size_t old_contacts, size_t contacts);
/* Gives new contacts what friction held for their pairs when the last step ended. */
void spore_world_restore_friction(SporeWorld *world);
/* Stage: keeps what friction holds now that the step has ended. */
void spore_world_keep_friction(SporeWorld *world);

/* soft_contact.c. Stage: says which contacts at rest do not hold for the length of the step. */
void spore_world_watch_contacts(SporeWorld *world);

#endif
