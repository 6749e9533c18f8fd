/* Terms that hang on nodes of one body alone, such as its contacts with what does not move: they are added to the
 * body's own matrix, so that a factor of it knows them. Private to the room. */
#ifndef SPORE_SIM_LOCAL_ASSEMBLY_H
#define SPORE_SIM_LOCAL_ASSEMBLY_H

#include "core/sim/solve/island_system.h"

/* The body whose matrix has room for a term between these ends; SPORE_NO_BODY: none, it couples what no one matrix
 * holds. A term between ends that do not move hangs on nothing, and is not asked for. */
uint32_t spore_island_system_local_body(const SporeIslandSystem *system, const SporeEnd *a, const SporeEnd *b);
/* Adds J^T k J to the matrix, J the motion of end a relative to end b; `folds` of those ends is not SPORE_NO_BODY. */
void spore_body_assemble_term(SporeBody *body, const SporeEnd *a, const SporeEnd *b, const SporeMat3 *k);
/* Whether some contact or link of the island is not folded. */
bool spore_island_system_couples(SporeIslandSystem *system);

/* What the bending of a curve joint on this body adds, of a term whose other end physics does not move. */
void spore_body_assemble_bend(SporeBody *body, const SporeCurveJointBend *bend);

#endif
