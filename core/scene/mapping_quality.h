/* Quality of a body's mappings: how well its drawn mesh and its collision spheres follow the geometry that physics
 * moves. */
#ifndef SPORE_SCENE_MAPPING_QUALITY_H
#define SPORE_SCENE_MAPPING_QUALITY_H

#include "core/scene/compile.h"
#include "core/body/mapping_error.h"

#define SPORE_MAPPING_QUALITY_TORN 2e-2 /* largest share of drawn edges that may join two loops of a line */

typedef enum SporeMappedUnit { SPORE_MAPPED_VISUAL, SPORE_MAPPED_COLLISION, SPORE_MAPPED_UNITS } SporeMappedUnit;
extern const char *const spore_mapped_unit_names[]; /* "visual", "collision", NULL: elements of a body */

typedef struct SporeMappingQuality {
  size_t count;            /* vertices, or spheres */
  SporeMappingError error; /* at the level of detail that the body starts with */
  double size;             /* m: diagonal of the box around the mechanical unit's geometry */
  size_t off; /* number of points that lie off that geometry by more than 1e-6 of its size: outside of tetrahedra or of
                 a closed surface, off an open surface, farther from a curve than its radius. Such a point is
                 extrapolated from the nearest part of the geometry */
  size_t apart;          /* spheres that do not reach the geometry: they lie off by more than their radius */
  double farthest;       /* m: distance of the farthest point from the geometry */
  SporeVec3 place;       /* the farthest point, body's frame */
  bool framed;           /* vertices follow frames along a line, at any distance from it */
  SporeVec3 crowd_place; /* of error.crowd_point, body's frame */
} SporeMappingQuality;

/* FALSE without a GError: there is nothing to measure. The body has no such points of its own (those of its geometry
 * follow it exactly), or physics does not move it, or it consists of particles. FALSE with a GError: its model cannot
 * map the points. */
gboolean spore_mapping_quality_measure(const SporeSimulation *simulation, SporeDocument *document, SporeObject *body,
                                       SporeMappedUnit unit, SporeMappingQuality *quality, GError **error);

#endif
