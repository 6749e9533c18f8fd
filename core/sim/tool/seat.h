/* A place on tissue, with which something sits there moves and turns: the mouth of a wound, or a clip. */
#ifndef SPORE_SIM_SEAT_H
#define SPORE_SIM_SEAT_H

#include "core/body/mapping.h"
#include "core/math/mat3.h"
#include "core/math/quat.h"

#define SPORE_NO_POINT UINT32_MAX

/* Points of a body in a state: its nodes, or others that follow it. Borrowed. */
typedef struct SporeSeatPoints {
  const double *q; /* of the body, in the state */
  uint32_t count;
  const SporeMapping *mapping; /* of the points; NULL: they are the nodes, 3 numbers each at the start of q */
} SporeSeatPoints;

/* A seat goes with the point that was nearest to it when the seat was found, and turns with the triangle of that point
 * and two near it, or with the line to one of them where all lie on a line. */
typedef struct SporeSeat {
  uint32_t point;
  uint32_t beside[2]; /* points near that one, by which the seat turns */
  SporeMat3 triangle; /* of the three when it was found: along the first side, in the plane, and across it */
  bool on_a_line;     /* the three are no triangle: the seat turns by the first side alone */
} SporeSeat;

/* Finds the seat at a place (world, m), by the points in that state. There is one point at least. */
void spore_seat_find(SporeSeat *seat, const SporeSeatPoints *points, SporeVec3 place);
/* Where its point is in a state (world, m), and how it has turned since it was found. Points: as then, or fewer: then
 * the seat is at the last, and unturned. */
SporePose spore_seat_frame(const SporeSeat *seat, const SporeSeatPoints *points);

#endif
