/* Hashed regular grids, one for each class of radius. Private to core/collide. */
#ifndef SPORE_COLLIDE_CELLS_H
#define SPORE_COLLIDE_CELLS_H

#include <stdbool.h>

#include "core/collide/bounds.h"
#include "core/collide/sphere.h"

#define SPORE_CELL_CLASSES 64
#define SPORE_CELL_NONE UINT32_MAX
#define SPORE_CELL_MIXED UINT32_MAX /* in place of a body: spheres of several */

/* Class k has cells of width[k] = width[0] 2^k. The cells are laid out from origin, which lies among the spheres, so
 * that cells are exact far from the origin of the scene too. */
typedef struct SporeCellScale {
  SporeVec3 origin;
  double width[SPORE_CELL_CLASSES], inverse[SPORE_CELL_CLASSES];
} SporeCellScale;

/* Class 0 fits spheres of the smallest radius; some class fits spheres of the usual radius tightly. */
SporeCellScale spore_cell_scale(SporeVec3 origin, double smallest_radius, double usual_radius);

typedef struct SporeCell {
  int32_t x, y, z, class; /* which cell */
  uint32_t first, count;  /* its spheres in the sorted arrays */
  uint32_t body;          /* the one body of all of them, or SPORE_CELL_MIXED */
  uint32_t next_in_class; /* another cell of the class, or SPORE_CELL_NONE */
  SporeBounds bounds;     /* of its spheres with their reach */
} SporeCell;

typedef struct SporeCellSlot {
  uint64_t stamp;
  int32_t x, y, z, class;
  uint32_t cell;
} SporeCellSlot;

/* Spheres in their cells. Sizes are fixed at creation. */
typedef struct SporeCells {
  size_t capacity, cell_count;
  SporeCell *cells; /* capacity */
  /* Spheres sorted by cell. The reach of a sphere is the radius of a ball about the middle of its way through the step;
   * the sphere stays in that ball. */
  double *middle;   /* 4 a sphere: x y z reach, m */
  uint32_t *sphere; /* index in SporeSpheres */
  uint32_t *body;
  uint32_t *cell_of; /* scratch: cell of each sphere, unsorted */
  double *unsorted;  /* balls before sorting, as middle */
  SporeCellSlot *slots;
  size_t slot_mask;
  uint64_t stamp;
  uint64_t classes; /* bit k: some cell is of class k */
  uint32_t class_head[SPORE_CELL_CLASSES], class_count[SPORE_CELL_CLASSES];
  double class_reach[SPORE_CELL_CLASSES]; /* largest reach */
} SporeCells;

bool spore_cells_create(SporeCells *cells, size_t capacity); /* false: no memory, *cells cleared */
void spore_cells_clear(SporeCells *cells);
/* Balls that spheres first..first+count-1 stay in during the step (4 a sphere: middle and reach); reach < 0 where a
 * sphere is not finite. Returns the longest way of one, m, or somewhat more. */
double spore_cells_find_balls(const SporeSpheres *spheres, size_t first, size_t count, double dt_s, double *balls);
/* Makes those balls hold the ways of the spheres in the step before, too. */
void spore_cells_add_ways(const SporeSpheres *spheres, size_t first, size_t count, double *balls);
/* Puts spheres first..first+count-1, count <= capacity, with the balls in cells->unsorted, into cells: those whose ball
 * touches the region of their body; all where regions is NULL. */
void spore_cells_fill(SporeCells *cells, const SporeCellScale *scale, const SporeSpheres *spheres, size_t first,
                      size_t count, const SporeBounds *regions);
/* Index of a cell, or SPORE_CELL_NONE. */
uint32_t spore_cells_find(const SporeCells *cells, int32_t x, int32_t y, int32_t z, int32_t class);
/* Index of the cell along one axis that a coordinate, relative to the origin, lies in; held within 32 bits. */
int32_t spore_cell_index(double coordinate, double inverse_width);

#endif
