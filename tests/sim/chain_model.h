/* A model small enough to know everything about: particles in a row, springs between neighbours, each particle also
 * tied to its rest place. For tests of the world that need no model of the program. */
#ifndef TESTS_SIM_CHAIN_MODEL_H
#define TESTS_SIM_CHAIN_MODEL_H

#include "core/sim/world.h"

typedef struct ChainFields {
  int64_t count;
  int64_t reach;    /* how many next particles the pattern has blocks for, though springs lead to one; 0: as 1 */
  double mass;      /* kg, of a particle */
  double spacing;   /* m, along x */
  double stiffness; /* N/m, between neighbours; length 0 forbidden */
  double damping;   /* N s/m, of each particle against the world */
  double anchor;    /* N/m, to the rest place */
  double poison_at; /* forces are not a number where the first particle is above this height; infinite: never */
} ChainFields;

extern const SporeModelType chain_model;
SporeModel *chain_create(ChainFields fields);

/* Descriptions with sensible values, for tests to change. */
SporeWorldDescription world_description(SporeBodyDescription *bodies, size_t body_count);
SporeBodyDescription passive_body(const char *name, SporeModel *model, SporeVec3 position);

#endif
