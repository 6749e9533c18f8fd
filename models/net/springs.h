/* Springs of one kind between the nodes of a model, laid out by node. */
#ifndef SPORE_MODELS_NET_SPRINGS_H
#define SPORE_MODELS_NET_SPRINGS_H

#include "core/base/threads.h"
#include "core/linalg/block_matrix.h"
#include "core/math/simd.h"
#include "core/math/vec3.h"
#include "core/body/model.h"
#include "models/net/springs_sweep.h"

/* A spring between nodes at distance l pulls with stiffness (l - length) along the line between the nodes, and damps
 * the rate of that distance. Where the nodes meet and there is no line, the line at rest takes its place.
 *
 * The springs of a node lie together, so that the force of the node is added up in registers and written once: every
 * spring is computed at both of its ends, which costs less than adding to both ends in memory. Nodes with equally many
 * springs are put in groups of SPORE_LANES; a slot of a group holds one spring of each of its nodes. The nodes of a
 * group belong to one chunk: SPORE_SPRINGS_CHUNK consecutive nodes of the model. The entries of a chunk are written by
 * its own groups alone, whatever the kind of springs, so that chunks may be computed on several threads. */
#define SPORE_SPRINGS_CHUNK 512

/* The directions of the springs in the shape along which they were damped last. An implicit step evaluates forces at
 * one shape many times. */
typedef struct SporeSpringsLines {
  bool ready;
  size_t count;  /* of entries of shape */
  double *shape; /* three a node */
  double *along; /* slot x 4 x lane: the lines, x y z, 0 where there is no spring, and one over the square of each */
} SporeSpringsLines;

struct SporeSprings {
  size_t chunk_count;    /* of the model */
  uint32_t *chunk_start; /* chunk_count + 1: its first group */
  size_t group_count;
  uint32_t *node;       /* group_count x SPORE_LANES, of a chunk those with most springs first; then node 0 */
  uint8_t *lanes;       /* group: how many of its lanes hold nodes */
  uint32_t *slot_start; /* group_count + 1 */
  uint32_t *neighbour;  /* slot x lane: the node at the other end; the node itself where it has no more springs */
  bool *is_run;         /* slot: its neighbours' numbers follow one another, as in grids */
  bool *node_is_run;    /* group: its nodes' numbers do */
  double *length;       /* slot x lane, at rest, m; -0.0 where it has no more springs */
  uint32_t *block;      /* slot x lane: where (node, neighbour) lies in the model's matrix */
  uint32_t *diagonal;   /* as node: where (node, node) lies */
  const double *rest;   /* positions of nodes at rest, borrowed */
  double stiffness;     /* N/m, of each; 0: there are none */
  double *share;        /* slot x lane: of that stiffness; NULL: all have it whole */
  double *dose;         /* as share: how far coagulated, 0 to 1 */
  double damping;       /* N s/m, of each */
  SporeSpringsLines *lines;
  SporeSpringsSweep sweep; /* empty where no spore_springs_order was asked for */
};

/* One spring for each pair of nodes, `keys` as in SporePairs; no pair twice. rest: node_count x 3, borrowed. Stiffness
 * and damping are left 0. False: no memory; *springs may then be cleared. */
bool spore_springs_create(SporeSprings *springs, const uint64_t *keys, size_t count, const double *rest,
                          size_t node_count);
void spore_springs_clear(SporeSprings *springs);

bool spore_springs_pattern(const SporeSprings *springs, SporeBlockPattern *pattern);
/* Looks up where the springs' blocks lie, once the matrix of all of the model's patterns is known. */
void spore_springs_find_blocks(SporeSprings *springs, const SporeBlockMatrix *matrix);

/* Fills the chunk's part of lines->along, at `shape`. */
SPORE_DECLARE_KERNEL(void, spore_springs_chunk_lines, const SporeSprings *springs, size_t chunk, const double *shape);
/* along_lines: damped along those, or else along what q shows. h: q is their shape moved along v for h seconds; 0: it
 * may be anywhere. */
SPORE_DECLARE_KERNEL(void, spore_springs_chunk_force, const SporeSprings *springs, size_t chunk, const double *q,
                     const double *v, bool along_lines, double h, double *f);
SPORE_DECLARE_KERNEL(double, spore_springs_potential, const SporeSprings *springs, const double *q);
SPORE_DECLARE_KERNEL(void, spore_springs_chunk_jacobian, const SporeSprings *springs, size_t chunk,
                     const SporeTangent *at, bool along_lines, SporeBlockMatrix *matrix);

/* f += the forces of several kinds of springs between the same nodes, damped along the lines that they have in
 * `shape`. h: q = shape + h v, s; 0: it may be anywhere. */
void spore_springs_force(const SporeSprings *springs, size_t kinds, SporePool *pool, const double *q,
                         const double *shape, const double *v, double h, double *f);
static inline double spore_springs_potential(const SporeSprings *springs, const double *q) {
  return springs->stiffness > 0 ? SPORE_KERNEL(spore_springs_potential)(springs, q) : 0;
}
/* Under compression the stiffness across the spring is negative, and left out unless the tangent is to be whole. */
void spore_springs_jacobian(const SporeSprings *springs, size_t kinds, SporePool *pool, const SporeTangent *at,
                            SporeBlockMatrix *matrix);

/* Whether any is longer by more than this part of its length at rest. */
SPORE_DECLARE_KERNEL(bool, spore_springs_exceed, const SporeSprings *springs, const double *q, double strain);

/* The largest part by which one is longer than at rest, in any of several kinds; -1 where there are none. */
double spore_springs_strain(const SporeSprings *springs, size_t kinds, const double *q);

/* springs_cut.c: springs may go, and come back all together. */
typedef struct SporeSpringsWhole { /* as they were */
  uint32_t *neighbour, *block;
  double *length;
  bool *is_run;
  uint32_t *place; /* node: where it is in springs->node; UINT32_MAX: it has no springs */
} SporeSpringsWhole;
/* False: no memory; forget it then. */
bool spore_springs_keep(const SporeSprings *springs, size_t node_count, SporeSpringsWhole *whole);
void spore_springs_restore(SporeSprings *springs, const SporeSpringsWhole *whole);
void spore_springs_forget(SporeSpringsWhole *whole);

#define SPORE_NO_SPRING SIZE_MAX
/* Slot x lane at node a of the spring to b that there was, gone or not; SPORE_NO_SPRING: there was none. */
size_t spore_springs_find(const SporeSprings *springs, const SporeSpringsWhole *whole, uint32_t a, uint32_t b);
/* Whether there is one still. */
static inline bool spore_springs_tie(const SporeSprings *springs, const SporeSpringsWhole *whole, uint32_t a,
                                     uint32_t b) {
  size_t at = spore_springs_find(springs, whole, a, b);
  return at != SPORE_NO_SPRING && springs->neighbour[at] == b;
}
/* Calls visit(data, lower node, higher node, length at rest) for each, in a fixed order; it may take that one away. */
void spore_springs_visit(const SporeSprings *springs, void (*visit)(void *data, uint32_t a, uint32_t b, double length),
                         void *data);
/* Takes the spring away; false where there is none. */
bool spore_springs_part(SporeSprings *springs, const SporeSpringsWhole *whole, uint32_t a, uint32_t b);

/* Room for stiffnesses of their own. False: no memory. */
bool spore_springs_share(SporeSprings *springs);
/* Coagulates those whose ends are both in the heat; returns their number. */
size_t spore_springs_coagulate(SporeSprings *springs, const SporeSpringsWhole *whole, const double *q,
                               const SporeHeat *heat);

#endif
