/* Kinds of links: what a link is called, its parameters, and what it holds. registry.c lists the kinds; each is a file
 * of its own. */
#ifndef SPORE_SIM_LINK_TYPE_H
#define SPORE_SIM_LINK_TYPE_H

#include "core/base/parameter.h"
#include "core/body/model.h"

typedef struct SporeLinkType SporeLinkType;
struct SporeSpring; /* core/constraint/spring.h */

/* What a body's own line does at its ends with what slides along it. */
typedef enum SporeEnds {
  SPORE_ENDS_STOP,    /* holds it there */
  SPORE_ENDS_SLIP_OFF /* lets it go, for good */
} SporeEnds;

/* A link of a world that is to be made. Points are of the world, at time 0, m; each kind reads a part of the members,
 * those that its parameters name. The names of bodies are those of the scene's file; a world goes by the indices. */
typedef struct SporeLinkDescription {
  const char *name;
  const SporeLinkType *type;
  uint32_t body_a, body_b; /* body_b: SPORE_NO_BODY ties to the world */
  SporeVec3 point_a, point_b;
  SporeVec3 direction;       /* any length but 0; a body's own line has its own */
  double radius;             /* of what is held still, m */
  double length;             /* between the points that are held, m */
  double stiffness, damping; /* N/m and N s/m; damping negative: critical for the lighter of its bodies */
  double rest_length;        /* m; negative: the distance at time 0 */
  double strength;           /* N: what its points feel together, above which it breaks; 0: never */
  double friction;           /* Coulomb coefficient along the line */
  int ends;                  /* SporeEnds, of a body's own line */
  const char *body_a_name, *body_b_name;
} SporeLinkDescription;

/* Which body the line belongs to that a point of the other body runs along. */
typedef enum SporeLinkLine { SPORE_LINE_NONE, SPORE_LINE_OF_BODY_A, SPORE_LINE_OF_BODY_B } SporeLinkLine;

/* What ties bodies. Pins hold blocks still. All others are stiff springs between material points, so that any
 * integrator bears them; a joint is made of springs of length 0. */
struct SporeLinkType {
  const char *element;            /* as in the file: "hinge" */
  const char *label;              /* for people, translatable (N_) */
  const char *doc;                /* one sentence, translatable (N_) */
  SporeParameterTable parameters; /* of SporeLinkDescription */
  size_t term_count;              /* springs; 0: the link holds blocks of body_a still */
  bool is_joint;                  /* its points are held together */
  SporeLinkLine line;
  unsigned held_freedoms;      /* of the 6 between two rigid bodies; 0: a spring or pin, which holds none of them */
  bool point_on_a, point_on_b; /* its points belong to that body: a stiff arm leads there */

  /* Optional. */
  /* What is wrong with the description of this kind (translated: what, what was expected, what to do), or NULL. */
  const char *(*fault)(const SporeLinkDescription *link);
  /* Where the ends of a term are at time 0. NULL: both at point_a. */
  void (*place)(const SporeLinkDescription *link, size_t term, SporeVec3 *a, SporeVec3 *b);
  /* Changes the law of the terms: stiffness, damping and friction are set. NULL: nothing to change. */
  void (*law)(const SporeLinkDescription *link, struct SporeSpring *law);
  /* Sets marks[i] for each of the `count` points (3 numbers each) that the link holds still; how many. Required where
   * term_count is 0. */
  size_t (*hold)(const SporeLinkDescription *link, const double *points, size_t count, uint8_t *marks);
};

extern const SporeLinkType spore_link_pin;    /* holds still what lies within `radius` of point_a */
extern const SporeLinkType spore_link_spring; /* a damped spring from point_a to point_b */
extern const SporeLinkType spore_link_ball;   /* the points of both bodies at point_a stay together */
extern const SporeLinkType spore_link_hinge;  /* the same with an axis: held at two points `length` apart */
extern const SporeLinkType spore_link_weld;   /* the same without a way to turn: held at four points */
/* The point of body_a at point_a stays on the line of body_b through it: a straight line along `direction`, or that of
 * a body along a curve, whose nearest point is taken. */
extern const SporeLinkType spore_link_slide;
/* The line of body_a goes through the point of body_b at point_a. An active body_a is turned about its origin, which
 * stays where the device says, until its line goes through there: a trocar (remote centre of motion). */
extern const SporeLinkType spore_link_port;

extern const SporeLinkType *const spore_link_types[];           /* NULL at the end */
const SporeLinkType *spore_link_type_find(const char *element); /* NULL: there is none */

#endif
