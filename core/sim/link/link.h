/* Links between bodies, and between a body and the scene. Pins become held blocks, trocars turn active bodies, and
 * all other links become spring terms. */
#ifndef SPORE_SIM_LINK_H
#define SPORE_SIM_LINK_H

#include "core/constraint/coupling.h"
#include "core/sim/state/state.h"

/* A link of the scene; its terms are contiguous. */
typedef struct SporeLink {
  char *name;
  const SporeLinkType *type;
  size_t term_start, term_count; /* in springs */
  double strength;               /* N; infinite: the link never breaks */
  bool broken;
  SporeVec3 base, along; /* of a straight line, in the frame of the body at end b of the term */
  SporeCurveJoint curve; /* of the line of a deformable body; without spans: none */
  bool reported_sharp;   /* the monitor has reported that the line bends too sharply where the point slides */
  uint32_t sharp_steps;  /* consecutive steps in which the line bends too sharply */
  bool lost;             /* the state was set from outside: the position of the point on the line is unknown */
} SporeLink;

/* A trocar: an active body is rotated about its origin until its shaft passes through the pivot (remote centre of
 * motion). */
typedef struct SporeTrocar {
  uint32_t body;
  SporeVec3 pivot;       /* world, m */
  SporeVec3 base, along; /* the shaft in the body's frame */
} SporeTrocar;

typedef struct SporeLinkSystem {
  size_t count, trocar_count, curve_joint_count; /* curve_joint_count: of links and needles */
  SporeLink *all;
  SporeTrocar *trocars;
  size_t pull_count; /* pulls held now */
  /* The springs are in this order: those of links, those of tools, one pull for each body. */
  size_t term_count, hold_count; /* of links; of tools */
  SporeSpringTerm *springs;
  bool *active;             /* one for each spring */
  SporeMapping *mappings;   /* two for each spring: end a, end b */
  SporeCoupling *couplings; /* one for each spring, in the order of `order` */
  uint32_t *order;          /* springs, island by island */
} SporeLinkSystem;

/* links.c */
/* Makes links, and room for the springs of tools (world->links.hold_count, set before) and pulls. */
bool spore_world_create_links(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
void spore_world_reset_links(SporeWorld *world);
void spore_world_clear_links(SporeWorld *world);
/* Lists the blocks of the body, at its present level of detail, that pins hold still. */
bool spore_body_create_pins(SporeWorld *world, const SporeWorldDescription *description, uint32_t body,
                            SporeError *error);
/* Stage: sets the ends of springs from the positions of their bodies at the beginning of the step. */
void spore_world_link(SporeWorld *world);

/* link_terms.c: links that hold points together. */
SporeSpring spore_link_law(const SporeWorld *world, const SporeLinkDescription *link);
/* Breaks the link. */
void spore_link_release(SporeWorld *world, SporeLink *link);
/* Stage, after the step: breaks the links whose load exceeds their strength. */
void spore_world_break_links(SporeWorld *world);

/* curve_joints.c: lines along which the point of a link slides. */
/* Whether the line belongs to a deformable body. */
bool spore_link_is_curved(const SporeWorld *world, const SporeLinkDescription *link);
/* Makes the straight line of a link whose term exists; or a link along a body's own line, with its term. */
bool spore_link_make_line(const SporeWorld *world, SporeLink *link, const SporeLinkDescription *from,
                          SporeError *error);
bool spore_link_make_curve(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error);
/* Moves the line with its body, and moves the point on the line to the other end; or lets the other end slip off. */
void spore_link_follow(SporeWorld *world, SporeLink *link);
/* The state was set from outside: the points on the lines must be sought again, and friction must not use the
 * earlier stretch. */
void spore_world_lose_lines(SporeWorld *world);

/* trocars.c */
void spore_trocar_make(const SporeWorld *world, SporeTrocar *trocar, const SporeLinkDescription *from);
/* Rotates the target pose of the active body until its shaft passes through the pivot. */
void spore_trocar_aim(const SporeWorld *world, const SporeTrocar *trocar);

/* pulls.c: springs between a body and a point of the world, made by commands. */
bool spore_world_create_pulls(SporeWorld *world);
void spore_world_pull(SporeWorld *world, const SporeCommand *command);
void spore_world_release(SporeWorld *world, uint32_t body);
/* The point at which the pull holds the body; false: nothing pulls the body. */
bool spore_world_pulled_point(const SporeWorld *world, uint32_t body, SporeVec3 *point);
/* Makes the pull hold the body by the node nearest to the point. */
void spore_world_pull_by(SporeWorld *world, uint32_t body, SporeVec3 point);
/* Index of the body's pull in the springs. */
size_t spore_world_pull_index(const SporeWorld *world, uint32_t body);

#endif
