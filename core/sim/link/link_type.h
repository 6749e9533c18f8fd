/* Kinds of links: name, parameters, and what each kind holds. registry.c lists the kinds; each has a file of its
 * own. */
#ifndef SPORE_SIM_LINK_TYPE_H
#define SPORE_SIM_LINK_TYPE_H

#include "core/base/parameter.h"
#include "core/body/model.h"

typedef struct SporeLinkType SporeLinkType;
struct SporeSpring; /* core/constraint/spring.h */

/* What happens at the ends of a body's own line to a point that slides along the line. */
typedef enum SporeEnds {
  SPORE_ENDS_STOP,    /* the point is held there */
  SPORE_ENDS_SLIP_OFF /* the point is released permanently */
} SporeEnds;

/* Description of a link to be made. Points are in the world at time 0, m. Each kind reads only the members that its
 * parameters name. The names of bodies are those in the scene's file; a world uses the indices. */
typedef struct SporeLinkDescription {
  const char *name;
  const SporeLinkType *type;
  uint32_t body_a, body_b; /* body_b: SPORE_NO_BODY ties to the world */
  SporeVec3 point_a, point_b;
  SporeVec3 direction;       /* any length but 0; unused for a body's own line */
  double radius;             /* of the region that is held still, m */
  double length;             /* between the points that are held, m */
  double stiffness, damping; /* N/m and N s/m; damping negative: critical for the lighter of its bodies */
  double rest_length;        /* m; negative: the distance at time 0 */
  double strength;           /* N: sum of the forces at its points above which the link breaks; 0: never */
  double friction;           /* Coulomb coefficient along the line */
  int ends;                  /* SporeEnds, of a body's own line */
  /* Of a port, for authors: how far its instrument gets, see core/scene/port_reach.h. A run does not depend on it. */
  double reach_angle;             /* rad */
  double reach_least, reach_most; /* m */
  const char *body_a_name, *body_b_name;
} SporeLinkDescription;

/* Which body has the line along which a point of the other body slides. */
typedef enum SporeLinkLine { SPORE_LINE_NONE, SPORE_LINE_OF_BODY_A, SPORE_LINE_OF_BODY_B } SporeLinkLine;

/* A kind of link. Pins hold blocks still. All other kinds are stiff springs between material points, so that every
 * integrator supports them. A joint consists of springs of length 0. */
struct SporeLinkType {
  const char *element;            /* as in the file: "hinge" */
  const char *label;              /* for people, translatable (N_) */
  const char *doc;                /* one sentence, translatable (N_) */
  SporeParameterTable parameters; /* of SporeLinkDescription */
  size_t term_count;              /* springs; 0: the link holds blocks of body_a still */
  bool is_joint;                  /* its points are held together */
  SporeLinkLine line;
  unsigned held_freedoms;      /* of the 6 between two rigid bodies; 0: a spring or a pin */
  bool point_on_a, point_on_b; /* the points belong to that body: a stiff arm leads to them */

  /* Optional. */
  /* The fault of a description of this kind (translated: what, what was expected, what to do), or NULL. */
  const char *(*fault)(const SporeLinkDescription *link);
  /* Positions of the ends of a term at time 0. NULL: both at point_a. */
  void (*place)(const SporeLinkDescription *link, size_t term, SporeVec3 *a, SporeVec3 *b);
  /* Changes the law of the terms; stiffness, damping and friction are already set. NULL: no change. */
  void (*law)(const SporeLinkDescription *link, struct SporeSpring *law);
  /* Sets marks[i] for each of the `count` points (3 numbers each) that the link holds still; returns their number.
   * Required if term_count is 0. */
  size_t (*hold)(const SporeLinkDescription *link, const double *points, size_t count, uint8_t *marks);
};

extern const SporeLinkType spore_link_pin;    /* holds still the part of a body within `radius` of point_a */
extern const SporeLinkType spore_link_spring; /* a damped spring from point_a to point_b */
extern const SporeLinkType spore_link_ball;   /* the points of both bodies at point_a stay together */
extern const SporeLinkType spore_link_hinge;  /* the same with an axis: holds two points `length` apart */
extern const SporeLinkType spore_link_weld;   /* the same without rotation: holds four points */
/* The point of body_a at point_a stays on the line of body_b through that point: a straight line along `direction`,
 * or the line of a body along a curve, on which the nearest point is used. */
extern const SporeLinkType spore_link_slide;
/* The line of body_a passes through the point of body_b at point_a. An active body_a keeps its origin where the
 * device puts it, and is rotated about the origin until its line passes through the point: a trocar (remote centre of
 * motion). */
extern const SporeLinkType spore_link_port;

extern const SporeLinkType *const spore_link_types[];           /* NULL at the end */
const SporeLinkType *spore_link_type_find(const char *element); /* NULL: there is none */

#endif
