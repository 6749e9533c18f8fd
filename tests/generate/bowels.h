/* Bowels whose middle line is known: loops packed side by side, that touch or are grown together, for tests. */
#ifndef SPORE_TESTS_GENERATE_BOWELS_H
#define SPORE_TESTS_GENERATE_BOWELS_H

#include "core/mesh/mesh.h"

#define BOWEL_RADIUS 0.01 /* m, mean */

typedef struct BowelShape {
  int rows, layers;  /* rows: even */
  double row;        /* length of a row, in radii */
  double gap;        /* between the walls of neighbouring rows, in radii; below 0: the tubes overlap */
  double haustra;    /* depth of the folds, of the radius; they are as far apart as the tube is wide */
  double waves;      /* how far all is bent, in radii */
  double noise;      /* of vertices, in radii; swept tubes only */
  double unevenness; /* of the distances of the rings, 0 to 0.9; swept tubes only */
  int sectors;       /* of a swept tube; 0: the surface of the union of balls, where what overlaps is one */
  int bridges;       /* places where neighbouring rows are joined; unions only */
  double bridge;     /* their radius, in radii */
  double grid;       /* of unions, in radii: gaps that are narrower close here and there; 0: fine */
  double seam;       /* their length along the rows, in radii */
} BowelShape;

/* The line has the radius without folds. Clear both. */
void bowel_create(const BowelShape *shape, SporeTriangleMesh *mesh, SporeCurve *line);

/* A trunk of that radius that forks, each branch into two, three times. */
void bowel_tree(SporeTriangleMesh *mesh);

/* How well a line follows the known one; the ends, up to a radius and a half, are left out of all but the length. */
typedef struct BowelFit {
  double within; /* share of the known line within the local radius */
  double offset; /* mean distance of the known line, in local radii */
  double length; /* of the line over that of the known one, both smoothed over a radius */
} BowelFit;
BowelFit bowel_fit(const SporeCurve *known, const SporeCurve *line);

#endif
