/* Changes of topology: cutting and tearing, node splitting, and spline refinement. */
#ifndef SPORE_SIM_TOPOLOGY_H
#define SPORE_SIM_TOPOLOGY_H

#include "core/linalg/block_matrix.h"
#include "core/sim/state/state.h"

/* A matrix whose pattern changes while the world runs, and room for its patterns. */
typedef struct SporeChangingMatrix {
  SporeBlockPattern pattern;
  SporeBlockRoom room;
  uint8_t *pinned;    /* a flag of each block: a pin holds it */
  bool factor_is_old; /* the pattern changed since the factor was made */
  uint64_t step;      /* in which the pattern changed */
} SporeChangingMatrix;

/* A body whose nodes a cut may split: see node_splitting.c. */
typedef struct SporeNodeSplitting {
  bool possible;
  bool wanted;         /* something was cut in this step */
  bool split;          /* nodes were split since time 0 */
  size_t corner_start; /* its first tetrahedron in the corners of all such bodies */
} SporeNodeSplitting;

/* A line that is refined where it bends: see spline_refinement.c. */
typedef struct SporeSplineRefinement {
  bool possible;
  size_t break_start; /* its first knot among those of all such lines */
  SporeLineState state;
  uint64_t looks, look_ns, changed, change_ns; /* number and duration of looks and changes */
} SporeSplineRefinement;

/* A mapping onto a body whose nodes are split, and the corners of tetrahedra that its blocks are. */
typedef struct SporeAttachedMapping {
  uint32_t body;
  SporeMapping *mapping;
  uint32_t *places; /* owned */
} SporeAttachedMapping;

typedef struct SporeTopology {
  SporeCuts cuts;
  uint64_t cut_run;     /* differs: the list of cuts was emptied since */
  size_t tearing_count; /* number of bodies that may tear */
  size_t attached_count;
  SporeAttachedMapping *attached;
  size_t line_count; /* number of lines that are refined */
  SporeLines lines;
} SporeTopology;

void spore_world_clear_topology(SporeWorld *world);

/* cutting.c: bodies lose ties between their nodes. */
bool spore_world_create_cutting(SporeWorld *world); /* false: no memory */
void spore_world_reset_cutting(SporeWorld *world);
/* Stage: tears ties that are strained too much. */
void spore_world_tear(SporeWorld *world);
/* After the body lost ties: its spheres follow, and its model counts as changed. */
void spore_body_was_cut(SporeWorld *world, uint32_t body);

/* node_splitting.c: tetrahedra whose nodes cuts split. */
/* Gives models spare nodes, before the world is laid out. */
bool spore_world_reserve_nodes(const SporeWorldDescription *description, SporeError *error);
/* Makes room for splitting, after links and tools were made. False: no memory. */
bool spore_world_create_splitting(SporeWorld *world);
/* Stage: splits nodes, in the next state. */
void spore_world_split_nodes(SporeWorld *world);
void spore_world_reset_splitting(SporeWorld *world);

/* spline_refinement.c */
/* Makes room for refinement, after links and tools were made. False: no memory. */
bool spore_world_create_refinement(SporeWorld *world);
/* Stage: inserts and removes control points of lines, in the next state. */
void spore_world_refine_splines(SporeWorld *world);
void spore_world_reset_refinement(SporeWorld *world);

/* changing_matrix.c */
/* Lists the held blocks: those in `pinned` first, then spare nodes. */
void spore_body_list_held(SporeBody *body);

#endif
