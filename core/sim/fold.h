/* Terms that hang on nodes of one body alone, such as its contacts with what does not move: they are added to the
 * body's own matrix, so that a factor of it knows them. Private to the room. */
#ifndef SPORE_SIM_FOLD_H
#define SPORE_SIM_FOLD_H

#include "core/sim/group.h"

/* The body whose matrix has room for a term between these ends; SPORE_NO_BODY: none, it couples what no one matrix
 * holds. A term between ends that do not move hangs on nothing, and is not asked for. */
uint32_t spore_group_folds(const SporeGroup *group, const SporeEnd *a, const SporeEnd *b);
/* Adds J^T k J to the matrix, J the motion of end a relative to end b; `folds` of those ends is not SPORE_NO_BODY. */
void spore_body_fold(SporeBody *body, const SporeEnd *a, const SporeEnd *b, const SporeMat3 *k);
/* Whether some contact or link of the island is not folded. */
bool spore_group_couples(SporeGroup *group);

/* What the bending of a rail on this body adds, of a term whose other end physics does not move. */
void spore_body_fold_bend(SporeBody *body, const SporeRailBend *bend);

#endif
