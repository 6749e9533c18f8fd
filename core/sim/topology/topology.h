/* Changes of topology while the world runs: ties between nodes that are cut or tear, nodes of tetrahedra that are
 * split, and lines whose control points are inserted and removed. Room for all changes is made when the world is
 * created. */
#ifndef SPORE_SIM_TOPOLOGY_H
#define SPORE_SIM_TOPOLOGY_H

#include "core/linalg/block_matrix.h"
#include "core/sim/state/state.h"

/* What a body keeps whose matrix changes its pattern while the world runs. */
typedef struct SporeChangingMatrix {
  SporeBlockPattern pattern;
  SporeBlockRoom room;
  uint8_t *pinned;    /* a flag a block: a pin holds it */
  bool factor_is_old; /* the pattern changed since the factor was made: spore_world_tidy makes a new one */
  uint64_t step;      /* number of the step in which the pattern last changed */
} SporeChangingMatrix;

/* A body whose nodes a cut may split: see node_splitting.c. */
typedef struct SporeNodeSplitting {
  bool possible;
  bool wanted;         /* something was cut in this step */
  bool split;          /* nodes were split since time 0 */
  size_t corner_start; /* index of the body's first tetrahedron in SporeCuts.corners */
} SporeNodeSplitting;

/* A line that is refined where it bends: see spline_refinement.c. */
typedef struct SporeSplineRefinement {
  bool possible;
  size_t break_start; /* index of the line's first break in SporeLines.breaks */
  SporeLineState state;
  uint64_t looks, look_ns, changed, change_ns; /* number and duration of looks and changes */
} SporeSplineRefinement;

/* A mapping to a body whose nodes may be split, and the corners by which its blocks are found again. */
typedef struct SporeAttachedMapping {
  uint32_t body;
  SporeMapping *mapping;
  uint32_t *places; /* owned; see spore_mapping_find_places */
} SporeAttachedMapping;

/* The changes of topology of a world. */
typedef struct SporeTopology {
  SporeCuts cuts;
  uint64_t cut_run;     /* changes whenever the list of cuts begins anew, by a reset */
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
/* Stage: tears ties that are strained too much. */
void spore_world_tear(SporeWorld *world);
/* To be called after the body lost ties: adapts the body's spheres, and makes the solver forget the model as it was. */
void spore_body_was_cut(SporeWorld *world, uint32_t body);

/* node_splitting.c: tetrahedra whose nodes cuts split. */
/* Makes spare nodes in the models that may be cut, before the world is laid out. */
bool spore_world_reserve_nodes(const SporeWorldDescription *description, SporeError *error);
/* Makes what node splitting needs, after links and tools were made. False: no memory. */
bool spore_world_create_splitting(SporeWorld *world);
/* Stage: splits nodes, in the next state. */
void spore_world_split_nodes(SporeWorld *world);
void spore_world_reset_splitting(SporeWorld *world);

/* spline_refinement.c */
/* Makes room, after links and tools were made. False: no memory. */
bool spore_world_create_refinement(SporeWorld *world);
/* Stage: inserts and removes control points of lines, in the next state. */
void spore_world_refine_splines(SporeWorld *world);
void spore_world_reset_refinement(SporeWorld *world);

/* changing_matrix.c */
/* Lists the blocks of the body that stand still: first those that `pinned` marks, then spare nodes. */
void spore_body_list_held(SporeBody *body);
/* Gives the body's matrix the present pattern of its model, within the room that was made. */
void spore_body_lay_out_matrix(SporeBody *body);

#endif
