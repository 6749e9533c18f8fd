/* How far a run lets give what should hold: points that links hold together, and lines that keep their length. */
#ifndef SPORE_MEASURE_STRETCH_H
#define SPORE_MEASURE_STRETCH_H

#include "core/sim/world.h"

#define SPORE_STRETCH_PIECES 16 /* of a line, even in its parameter */

/* Lengths at rest of the lines of a world. */
typedef struct SporeStretch {
  size_t line_count;
  uint32_t *bodies; /* line_count: those that are lines */
  double *rest;     /* line_count x SPORE_STRETCH_PIECES, m */
} SporeStretch;

/* Of a world at time 0. To be freed by spore_stretch_clear. False: no memory. */
bool spore_stretch_create(SporeStretch *stretch, const SporeWorld *world, SporeError *error);
void spore_stretch_clear(SporeStretch *stretch);
/* The largest part by which a piece of a line is longer or shorter than at rest. snapshot: of the world's present
 * state. Not a number: no body is a line. */
double spore_stretch_of_lines(const SporeStretch *stretch, const SporeWorld *world, const SporeSnapshot *snapshot);
/* The largest distance between points that a link holds together, when the last step began, m; 0 where all links are
 * springs. Links that broke do not count. Not a number: the world has no links. */
double spore_stretch_gap(const SporeWorld *world);

#endif
