/* Where the mesentery of a bowel begins: a place of its root for each point of the bowel. */
#ifndef SPORE_MESH_MESENTERY_H
#define SPORE_MESH_MESENTERY_H

#include "core/mesh/mesh.h"

#define SPORE_MESENTERY_PLACES 129 /* evenly along the root, that points may be tied to */

/* feet (count x 3, m): for each of the points (count x 3, m, in their order along the bowel) a place of the root. A
 * mesentery is one sheet that does not cross itself: places follow each other along the root as points do along the
 * bowel, in the order of the root or against it. Of all such places they are those for which the sum of weight (count)
 * times distance^2 is least; then each goes to the nearest place beside. count: above 0. False: no memory. */
bool spore_mesentery_spread(const SporeCurve *root, const double *points, const double *weight, size_t count,
                            double *feet);

#endif
