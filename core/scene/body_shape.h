/* The shape of a body as its assets give it: how far a point lies outside, and where the body is nearest. */
#ifndef SPORE_SCENE_BODY_SHAPE_H
#define SPORE_SCENE_BODY_SHAPE_H

#include "core/mesh/bvh.h"
#include "core/scene/compile.h"

/* A mesh or a curve as a shape, in the body's frame at rest. */
typedef struct SporeShape {
  SporeGeometryKind kind;
  SporeBvh *surface;       /* a triangle mesh, or the boundary of tetrahedra; NULL: the shape is a curve */
  const SporeCurve *curve; /* borrowed from the document; a tube of its radii */
  double size;             /* m: diagonal of the box around it */
  double edge;             /* m: mean edge; of a curve, mean distance from point to point */
} SporeShape;

/* The shape of the geometry that physics moves, for a model of such a geometry. FALSE: there is none that can be read;
 * *shape is empty then. */
gboolean spore_shape_of_geometry(SporeDocument *document, const SporeObject *body, SporeGeometryKind kind,
                                 SporeShape *shape);
void spore_shape_clear(SporeShape *shape);
/* How far p lies outside, m; 0: it does not. *nearest, unless NULL: the point of the shape nearest to p; p itself where
 * it is inside. */
double spore_shape_outside(const SporeShape *shape, SporeVec3 p, SporeVec3 *nearest);

/* A place of a body: see spore_body_find_place. */
typedef struct SporeBodyPlace {
  SporeVec3
      nearest; /* point of the body nearest to the place, or one beside it that the body carries; world at time 0, m */
  double outside;   /* how far the place lies outside the body, m */
  double allowed;   /* how far it may, m: one mean edge of what is nearest */
  gboolean carried; /* the body can carry the place itself */
} SporeBodyPlace;

/* Finds where the body is nearest to a point `at` (world at time 0, m). The body is its geometry and its drawn mesh, or
 * its spheres where it has neither; spheres allow their mean radius. Where `at` is of the body, outside <= allowed. To
 * be called before the first step. FALSE: the body has none of these. */
gboolean spore_body_find_place(const SporeSimulation *simulation, SporeDocument *document, guint32 body, SporeVec3 at,
                               SporeBodyPlace *place);

#endif
