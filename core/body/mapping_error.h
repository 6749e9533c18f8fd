/* How well points follow a body: motions whose outcome is known, against where the mapping puts the points. */
#ifndef SPORE_SIM_MAPPING_ERROR_H
#define SPORE_SIM_MAPPING_ERROR_H

#include "core/body/model.h"

/* Largest errors over the points, m. */
typedef struct SporeMappingError {
  double rest;     /* as placed at rest */
  double rigid;    /* turned by 1 rad about an oblique axis and moved away */
  double affine;   /* nodes stretched by half, squeezed and sheared: 0 to rounding for weights of sum 1. NAN: the
                      points follow a frame, which does not deform */
  double bend;     /* nodes bent to a parabola by a tenth of the body's length, the points too: falls with the square
                      of the distance between nodes. Of points on frames along a line, bent to an arc of a circle as deep,
                      which turns sections: what these would stretch is left. NAN as affine */
  double leverage; /* largest sum of absolute weights of a point: 1 where it lies among what carries it */
  double crowd;    /* of points on frames along a line: greatest curvature of the line at rest times distance from it;
                      above 1 what surrounds the line folds on the inside of that bend. 0 of others */
  size_t crowd_point;
  double torn;        /* of a surface on such frames: share of its edges that lead to another loop of the line */
  double crowd_share; /* of the points, with more than 1 */
} SporeMappingError;

/* points: as mapped, 3 each, body's frame. False: no memory. */
bool spore_mapping_measure(const SporeModel *model, const SporeMapping *mapping, const double *points,
                           SporeMappingError *measured, SporeError *error);

#endif
