/* What a body carries along: how well what is drawn of it, and the spheres that are felt, follow what moves it. */
#ifndef SPORE_SCENE_CARRIED_H
#define SPORE_SCENE_CARRIED_H

#include "core/scene/compile.h"
#include "core/body/mapping_error.h"

#define SPORE_CARRIED_TORN 2e-2 /* of the edges drawn, that may lead from one loop of a line to another */

typedef enum SporeCarriedUnit { SPORE_CARRIED_VISUAL, SPORE_CARRIED_COLLISION, SPORE_CARRIED_COUNT } SporeCarriedUnit;
extern const char *const spore_carried_units[]; /* "visual", "collision", NULL: elements of a body */

typedef struct SporeCarried {
  size_t count;            /* vertices, or spheres */
  SporeMappingError error; /* of the level that the body starts at */
  double size;             /* m: diagonal of the box around the mechanical unit's geometry */
  size_t off;              /* how many lie off that geometry by more than 1e-6 of its size: outside tetrahedra or a
                              closed surface, off an open one, farther from a curve than its radius. They are carried
                              by what is nearest, extended beyond it */
  size_t apart;            /* spheres that do not reach it: off by more than their radius */
  double farthest;         /* m: how far off the farthest lies */
  SporeVec3 place;         /* of that one, body's frame */
  bool framed;             /* vertices go with frames along a line, however far off it they lie */
  SporeVec3 crowd_place;   /* of error.crowd_point, body's frame */
} SporeCarried;

/* FALSE: the body has no such points of its own (those of its geometry follow it exactly), is not moved by physics, or
 * is one of particles; or with a GError: its model cannot carry them. */
gboolean spore_carried_measure(const SporeSimulation *simulation, SporeDocument *document, SporeObject *body,
                               SporeCarriedUnit unit, SporeCarried *carried, GError **error);

#endif
