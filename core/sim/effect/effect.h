/* Special effects: bodies that a formula moves in place of physics. They have no unknowns and no limit on the time
 * step, feel no force, and push nothing that physics moves but as something that a device moves does. What a body does
 * as an effect follows from its model (SporeEffectForm). */
#ifndef SPORE_SIM_EFFECT_H
#define SPORE_SIM_EFFECT_H

#include "core/collide/sphere.h"
#include "core/sim/state/state.h"

/* Drops that lie still: see settle.c. */
typedef struct SporeDropRest {
  bool asleep;      /* so the grid was told; SporeBodyEffect.settled says whether they may go on to sleep */
  bool noted;       /* what may move and is near them is known */
  bool begun;       /* a window began */
  uint64_t step;    /* in which it began */
  size_t held;      /* particles out of the world then */
  double *from;     /* 3 a drop: where it was then, m */
  unsigned windows; /* so many, one after the other, in which they lay still */
  size_t near_count, room;
  uint32_t *near;   /* room: spheres near them that may move */
  double *near_at;  /* 3 a sphere: where it was, m */
  uint8_t *is_near; /* one a sphere of the world */
} SporeDropRest;

/* The drops of a fluid that may be poured. */
#define SPORE_NO_DROP UINT32_MAX
typedef struct SporeDrops {
  double radius;          /* m */
  bool meet;              /* there is a collision sphere at each of them */
  uint32_t mask;          /* of slots of the table */
  uint32_t *first, *next; /* the first drop in a slot, the next in the slot of a drop; or SPORE_NO_DROP */
  size_t pair_count, pair_room;
  SporePair *pairs; /* pair_room: drops that are near each other */
  double *from;     /* 3 a drop: where it was, m; NULL: the body cannot be poured */
  SporeDropRest rest;
} SporeDrops;

/* Drops move no more often, s: nobody sees a drop move in less. */
#define SPORE_POUR_PACE_S 2e-3

/* What a body knows of its effect. */
typedef struct SporeBodyEffect {
  bool on, at_start; /* it is an effect now; at time 0 */
  bool settled;      /* it has the shape of time 0, and keeps that until an instrument comes near; its drops sleep */
  bool too_long;     /* the world's time step is too long for the body's physics: it stays an effect */
  SporeDrops drops;
} SporeBodyEffect;

/* How an instrument dents tissue: the displacement that a smooth push makes in a large elastic block, made smaller
 * farther away. One push, of unit length at `at`. */
typedef struct SporeDent {
  SporeVec3 at;   /* m */
  SporeVec3 push; /* m, of what lies at `at` */
  double width;   /* m, of the push */
} SporeDent;
/* How far the dents move what lies at `place` (m) at rest. */
SporeVec3 spore_dents_at(const SporeDent *dents, size_t count, SporeVec3 place);

/* Makes what effects need while the world runs. */
bool spore_world_create_effects(SporeWorld *world, SporeError *error);
void spore_body_clear_effect(SporeBody *body);
/* Stage: moves all bodies that are effects, in the next state. */
void spore_world_move_effects(SporeWorld *world);
/* Whether some body is an effect now. */
bool spore_world_has_effects(const SporeWorld *world);
/* Makes the body an effect, or gives it back to physics. The body stays where it is, and goes on from there. The
 * monitor says where that cannot be. */
void spore_world_set_effect(SporeWorld *world, uint32_t body, bool on);
/* Every body as it was at time 0. */
void spore_world_reset_effects(SporeWorld *world);

#endif
