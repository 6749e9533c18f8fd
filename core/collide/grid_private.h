/* Inside of the grid. Private to core/collide. */
#ifndef SPORE_COLLIDE_GRID_PRIVATE_H
#define SPORE_COLLIDE_GRID_PRIVATE_H

#include "core/collide/cells.h"
#include "core/collide/grid.h"

enum {
  SPORE_GRID_PASSIVE = 1,
  SPORE_GRID_SELF = 2,
  SPORE_GRID_ASLEEP = 4,
  SPORE_GRID_ACTIVE = 8,
  SPORE_GRID_SOFT = 16,
  SPORE_GRID_APART = 32
};

/* Steps without lists after one that did not pay; twice as many for each in a row. */
#define SPORE_GRID_SHORTEST_PAUSE 8

struct SporeGrid {
  size_t count, static_count, body_count, capacity;
  size_t sleeping, apart; /* bodies */
  unsigned char *bodies;  /* SPORE_GRID_ flags */
  uint32_t *group;        /* of the bodies; NULL: nobody is in one */
  SporeCellScale scale;
  SporeCells unmovable, moving; /* moving.unsorted: balls with their skins */
  double *balls;                /* count x 4: ball that a sphere stays in during this step; reach < 0: not finite */
  /* A sphere outside the region of its body needs no cell; the region is the part of space that the body shares with
   * bodies it pairs with. Regions are computed only where there are so few bodies that trying every pair of bodies
   * costs no more than the spheres do; else NULL. */
  SporeBounds *bounds, *regions; /* body_count */
  /* Pairs of one body that touch at rest: for sphere a, those b > a, ascending. NULL: no body collides with itself. */
  uint32_t *excluded_start; /* count + 1 */
  uint32_t *excluded;

  double smallest;        /* radius, m */
  double ahead;           /* steps that pairs are looked ahead for */
  bool lone;              /* all that moves is one body, which does not meet itself */
  bool fast;              /* some sphere moves so far in this step that it may pass another */
  bool strides;           /* some sphere did so in the step before, or does so now: it may have passed another */
  SporeContact *contacts; /* capacity */
  SporeContact *passed;   /* capacity: see spore_grid_passed */
  size_t passed_count;
  SporePair *apart_pairs; /* capacity: see spore_grid_apart */
  size_t apart_count;
  size_t pair_capacity, pair_count, missed_pairs;
  SporePair *pairs, *sorted_pairs; /* pair_capacity; pairs: by (a, b) once found */
  uint32_t *bucket;                /* count + 1 */
  bool listed;                     /* pairs belong to the balls in moving.unsorted */
  uint32_t list_steps;             /* that they have served for */
  uint32_t pause, pause_left;      /* steps */
};

/* broad_phase.c */
/* Whether two balls, x y z reach, touch. */
static inline bool spore_balls_touch(const double *a, const double *b) {
  double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2], reach = a[3] + b[3];
  return x * x + y * y + z * z < reach * reach;
}
void spore_grid_add_bounds(SporeBounds *bounds, const SporeSpheres *spheres, size_t first, size_t count,
                           const double *balls);
/* Pairs that the filter lets through whose balls touch: moving ones of moving.unsorted. Not in order. */
void spore_grid_find_pairs(SporeGrid *grid, const SporeSpheres *spheres);
/* By (a, b). */
void spore_grid_sort_pairs(SporeGrid *grid);

#endif
