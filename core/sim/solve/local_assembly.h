/* Local assembly: a term on nodes of one body, such as its contact with an unmovable body, is added to the body's own
 * matrix, so that a factor of the matrix contains the term. Private to the room. */
#ifndef SPORE_SIM_LOCAL_ASSEMBLY_H
#define SPORE_SIM_LOCAL_ASSEMBLY_H

#include "core/sim/solve/island_system.h"

/* The body whose matrix has room for a term between these ends; SPORE_NO_BODY: none, the term is a coupling. At least
 * one of the ends must move by physics. */
uint32_t spore_island_system_local_body(const SporeIslandSystem *system, const SporeEnd *a, const SporeEnd *b);
/* Adds J^T k J to the matrix, J the motion of end a relative to end b. spore_island_system_local_body of these ends
 * must be the body. */
void spore_body_assemble_term(SporeBody *body, const SporeEnd *a, const SporeEnd *b, const SporeMat3 *k);
/* Whether some contact or link of the island is a coupling. */
bool spore_island_system_couples(SporeIslandSystem *system);

/* Adds the bending of a curve joint on this body, where physics does not move the other end of the term. */
void spore_body_assemble_bend(SporeBody *body, const SporeCurveJointBend *bend);

#endif
