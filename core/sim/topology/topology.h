/* Changes of topology: ties between nodes that are cut or tear, nodes that are split, and lines that are refined. */
#ifndef SPORE_SIM_TOPOLOGY_H
#define SPORE_SIM_TOPOLOGY_H

#include "core/linalg/block_matrix.h"
#include "core/sim/state/state.h"

/* A matrix whose pattern changes while the world runs, and room for its patterns. */
typedef struct SporeChangingMatrix {
  SporeBlockPattern pattern;
  SporeBlockRoom room;
  uint8_t *pinned;    /* a flag a block: a pin holds it */
  bool factor_is_old; /* the pattern changed since the factor was made */
  uint64_t step;      /* when the pattern changed */
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
  size_t break_start; /* its first knot in those of all such lines */
  SporeLineState state;
  uint64_t looks, look_ns, changed, change_ns; /* number and duration of looks and changes */
} SporeSplineRefinement;

/* A mapping onto a body whose nodes are split, and where its blocks are found anew. */
typedef struct SporeAttachedMapping {
  uint32_t body;
  SporeMapping *mapping;
  uint32_t *places; /* owned */
} SporeAttachedMapping;

typedef struct SporeTopology {
  SporeCuts cuts;
  uint64_t cut_run;     /* another number: the cuts began anew */
  size_t tearing_count; /* bodies that may tear */
  size_t attached_count;
  SporeAttachedMapping *attached;
  size_t line_count; /* lines that are refined */
  SporeLines lines;
} SporeTopology;

void spore_world_clear_topology(SporeWorld *world);

/* cutting.c: bodies that lose ties between their nodes. */
bool spore_world_create_cutting(SporeWorld *world); /* false: no memory */
void spore_world_reset_cutting(SporeWorld *world);
/* Stage: tears what is strained too much. */
void spore_world_tear(SporeWorld *world);
/* After the body lost ties: its spheres follow, and its model counts as changed. */
void spore_body_was_cut(SporeWorld *world, uint32_t body);

/* node_splitting.c: tetrahedra whose nodes cuts split. */
/* Nodes in reserve, before the world is laid out. */
bool spore_world_reserve_nodes(const SporeWorldDescription *description, SporeError *error);
/* What splitting needs, after links and tools were made. False: no memory. */
bool spore_world_create_splitting(SporeWorld *world);
/* Stage: splits nodes, in the next state. */
void spore_world_split_nodes(SporeWorld *world);
void spore_world_reset_splitting(SporeWorld *world);

/* spline_refinement.c */
/* Room, after links and tools were made. False: no memory. */
bool spore_world_create_refinement(SporeWorld *world);
/* Stage: inserts and removes control points of lines, in the next state. */
void spore_world_refine_splines(SporeWorld *world);
void spore_world_reset_refinement(SporeWorld *world);

/* changing_matrix.c */
/* Lists the blocks that are held, from `pinned`: pins first, then spare nodes. */
void spore_body_list_held(SporeBody *body);

#endif
