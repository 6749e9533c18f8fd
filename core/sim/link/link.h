/* Links: what ties bodies to each other and to the scene. Pins become held blocks, trocars turn active bodies, and all
 * other links become spring terms. */
#ifndef SPORE_SIM_LINK_H
#define SPORE_SIM_LINK_H

#include "core/constraint/coupling.h"
#include "core/sim/state/state.h"

/* A link of the scene; its terms lie next to each other. */
typedef struct SporeLink {
  char *name;
  const SporeLinkType *type;
  size_t term_start, term_count; /* in springs */
  double strength;               /* N; infinite: it never breaks */
  bool broken;
  SporeVec3 base, along; /* of a straight line, in the frame of the body at end b of the term */
  SporeCurveJoint curve; /* of the line of a body that deforms; without spans: none */
  bool reported_sharp;   /* the monitor has said that the line bends too sharply where the point slides */
  uint32_t sharp_steps;  /* in a row in which the line did */
  bool lost;             /* the state was set from outside: where the point is on the line is not known */
} SporeLink;

/* A trocar: an active body turns about its origin until its shaft goes through the pivot (remote centre of motion). */
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
  /* Springs: of links, behind those of tools, behind those one pull a body. */
  size_t term_count, hold_count; /* of links; of tools */
  SporeSpringTerm *springs;
  bool *active;             /* a spring */
  SporeMapping *mappings;   /* two a spring: end a, end b */
  SporeCoupling *couplings; /* a spring, in the order of `order` */
  uint32_t *order;          /* springs, island by island */
} SporeLinkSystem;

/* links.c */
/* Makes links, and room for the springs of tools (world->links.hold_count, set before) and pulls. */
bool spore_world_create_links(SporeWorld *world, const SporeWorldDescription *description, SporeError *error);
void spore_world_reset_links(SporeWorld *world);
void spore_world_clear_links(SporeWorld *world);
/* The blocks of the body at its present level of detail that pins hold still. */
bool spore_body_create_pins(SporeWorld *world, const SporeWorldDescription *description, uint32_t body,
                            SporeError *error);
/* Stage: puts the ends of springs where their bodies are when the step begins. */
void spore_world_link(SporeWorld *world);

/* link_terms.c: links that hold points together. */
SporeSpring spore_link_law(const SporeWorld *world, const SporeLinkDescription *link);
/* Breaks the link. */
void spore_link_release(SporeWorld *world, SporeLink *link);
/* Stage, after the step: breaks the links that bear more than they can. */
void spore_world_break_links(SporeWorld *world);

/* curve_joints.c: lines that the point of a link runs along. */
/* Whether the line is that of a body that deforms. */
bool spore_link_is_curved(const SporeWorld *world, const SporeLinkDescription *link);
/* The straight line of a link that has its term; or a link along a body's own line, with its term. */
bool spore_link_make_line(const SporeWorld *world, SporeLink *link, const SporeLinkDescription *from,
                          SporeError *error);
bool spore_link_make_curve(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error);
/* Moves the line with its body, and the point on the line to where the other end is; or lets that slip off. */
void spore_link_follow(SporeWorld *world, SporeLink *link);
/* The state was set from outside: what slides is looked for again, and friction holds nothing of before. */
void spore_world_lose_lines(SporeWorld *world);

/* trocars.c */
void spore_trocar_make(const SporeWorld *world, SporeTrocar *trocar, const SporeLinkDescription *from);
/* Turns where the active body is to be until its shaft goes through the pivot. */
void spore_trocar_aim(const SporeWorld *world, const SporeTrocar *trocar);

/* pulls.c: springs between a body and a point of the world, made by commands. */
bool spore_world_create_pulls(SporeWorld *world);
void spore_world_pull(SporeWorld *world, const SporeCommand *command);
void spore_world_release(SporeWorld *world, uint32_t body);
/* Where the pull of a body holds it; false: nothing pulls the body. */
bool spore_world_pulled_point(const SporeWorld *world, uint32_t body, SporeVec3 *point);
/* Lets the pull hold the body by the node next to the point. */
void spore_world_pull_by(SporeWorld *world, uint32_t body, SporeVec3 point);
/* Index of the body's pull in the springs. */
size_t spore_world_pull_index(const SporeWorld *world, uint32_t body);

#endif
