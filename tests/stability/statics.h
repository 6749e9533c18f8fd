/* A model by itself, held at some of its nodes: where it comes to rest under a load, and how it first swings. */
#ifndef SPORE_TESTS_STATICS_H
#define SPORE_TESTS_STATICS_H

#include <glib.h>

#include "core/body/model.h"

/* A model with some control points held and a load on the others, N. */
typedef struct Statics {
  SporeModel *model;
  size_t n;
  gboolean *held;
  double *load, *q, *still, *matrix; /* matrix: n x n */
} Statics;

/* Takes the model, at rest in its own frame. */
Statics statics_new(SporeModel *model);
void statics_free(Statics *statics);
/* Newton's method with a line search on the energy. Returns the force that is left, relative to the load and
 * what the held points bear. */
double statics_balance(Statics *statics);
/* Lowest angular frequency of modes along `axis` (0 x, 1 y, 2 z), by inverse iteration, rad/s. */
double statics_lowest_frequency(Statics *statics, size_t axis);

#endif
