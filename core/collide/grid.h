/* Broad and narrow phase: which spheres of a world touch.
 *
 * Spheres lie in hashed regular grids of cells, one grid for each class of radius. Cells of a class are twice as wide
 * as those of the class below, and at least as wide as the spheres in them, so that any mixture of radii costs O(n)
 * time and memory. An entry of the table carries the number of the step that wrote it and counts as empty in any other
 * step: the table is never emptied. Unmovable spheres have a table of their own, filled at creation. A pair is looked
 * for from its sphere of the smaller class, and a pair with an unmovable sphere from the moving one: each pair is found
 * exactly once.
 *
 * The grid remembers near pairs, and looks for new pairs only when a sphere has left the ball in which its near pairs
 * were looked for (L. Verlet, "Computer 'Experiments' on Classical Fluids I", Phys. Rev. 159, 1967). The contacts found
 * do not depend on that. */
#ifndef SPORE_COLLIDE_GRID_H
#define SPORE_COLLIDE_GRID_H

#include <stdbool.h>

#include "core/base/error.h"
#include "core/collide/sphere.h"

typedef struct SporeGrid SporeGrid;

/* What the pair filter knows of a body; one that is neither passive nor active never moves. Two bodies pair when at
 * least one of them is passive, or one is active and the other never moves, and they are not of one group; a body pairs
 * with itself when it is passive and asks for it. */
typedef struct SporeGridBody {
  bool passive;   /* moved by physics */
  bool active;    /* moved by a device or a track */
  bool self;      /* its spheres collide with each other */
  bool soft;      /* passive, and its spheres move against each other */
  uint32_t group; /* bodies of one group never pair with each other; 0: none */
} SporeGridBody;

/* Spheres of one body whose gap at rest is below this part of the sum of their radii never collide with each other. */
#define SPORE_GRID_SELF_MARGIN 0.1

/* `rest` holds the spheres with every passive body at rest, wherever it stands; unmovable ones first and already where
 * they will stay. bodies: body_count, indexed by spheres->body. Room for contact_capacity contacts (0: a default).
 * Everything is copied. Refuses radii outside 1e-9..1e9 m, unmovable spheres that are not finite, body
 * indices out of range; NULL then, or without memory. */
SporeGrid *spore_grid_create(const SporeSpheres *rest, const SporeGridBody *bodies, size_t body_count,
                             size_t contact_capacity, SporeError *error);
void spore_grid_free(SporeGrid *grid);

/* Makes room for more contacts; between steps only. What was detected is lost. False: no memory, all as before. */
bool spore_grid_reserve(SporeGrid *grid, size_t contact_capacity);

/* Finds the contacts of spheres that start the step at `centre` and move with `velocity` for dt_s (0: as they stand).
 * A contact is a pair that overlaps now (depth > 0), or a fast one (SPORE_SPHERES_FAST) that meets within the step: its
 * normal is then the one at first touch, and its depth (<= 0) grows along the normal to 0 at that time,
 * depth + t (-gap_speed) = 0. Of two bodies that are not soft, also one slower than fast that meets within
 * SPORE_SPHERES_AHEAD steps: what falls gets faster in the step.
 *
 * Contacts are ordered by (a, b). Coincident centres: the normal opposes the relative velocity, and is +y where there
 * is none. Spheres that are not finite touch nothing. Count and layout of the spheres and the radii are as at creation.
 * Allocates nothing. Returns the number of contacts; *missed: pairs that found no room (then call spore_grid_reserve
 * with spore_grid_capacity + missed, and detect again). */
size_t spore_grid_detect(SporeGrid *grid, const SporeSpheres *spheres, double dt_s, size_t *missed);

/* Two bodies that do not move, asleep or unmovable, are not looked at for contacts with each other. */
void spore_grid_set_asleep(SporeGrid *grid, uint32_t body, bool asleep);

/* Sets a body apart, or no more: it has no contacts, and its pairs are told by spore_grid_apart. */
void spore_grid_set_apart(SporeGrid *grid, uint32_t body, bool apart);

/* Those of the last detection; valid until the next one. */
const SporeContact *spore_grid_contacts(const SporeGrid *grid);
size_t spore_grid_capacity(const SporeGrid *grid);

/* Pairs that the last detection found to have passed each other in the step before: on the straight way from `before`
 * to `centre` they came nearer than both ends of that way, and then overlapped by more than the smaller radius (depth).
 * The normal points against the way of a past b, at the speed -gap_speed. By (a, b); returns their number, of which no
 * more are kept than contacts are. */
size_t spore_grid_passed(const SporeGrid *grid, const SporeContact **passed);

/* Pairs of spheres of which one at least is of a body that is set apart, and that may touch in the step that the last
 * detection was for. By (a, b); returns their number. */
size_t spore_grid_apart(const SporeGrid *grid, const SporePair **pairs);

/* Pairs of bodies, a body with itself included, that the filter lets through. */
size_t spore_grid_body_pairs(const SporeGridBody *bodies, size_t body_count);

#endif
