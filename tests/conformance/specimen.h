/* Models to try every check on: each registered type, built from every shape of the geometry it takes. */
#ifndef SPORE_TESTS_SPECIMEN_H
#define SPORE_TESTS_SPECIMEN_H

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/registry.h"
#include "tests/conformance/shapes.h"

typedef struct Specimen {
  const SporeModelType *type;
  char *name; /* "mass_spring_net/box" */
  SporeTriangleMesh surface;
  SporeTetrahedralMesh tetrahedra;
  SporeCurve curve, root;
  SporeGeometry geometry;
  void *fields; /* defaults */
  double size;  /* m, typical edge */
  gboolean twists;
} Specimen;

/* Calls check once for every specimen whose type `applies` (NULL: all), as test PREFIX/NAME. */
void specimen_add_tests(const char *prefix, GTestDataFunc check, gboolean (*applies)(const SporeModelType *type));

/* Kinds of body that a type makes of the same geometry (its parameter `element`, whether it resists twist, or has a
 * root): their names from 0 on, then NULL; "" where there is but one. */
const char *specimen_variant(const SporeModelType *type, int variant);
void specimen_set_variant(const SporeModelType *type, int variant, void *fields);

/* In a check, data is the specimen. */
SporeModel *specimen_model(const Specimen *specimen); /* never NULL; destroy through its type */
/* A specimen of the same type with other vertex numbers; specimen_free. */
Specimen *specimen_relabelled(const Specimen *specimen, const uint32_t *order);
void specimen_free(Specimen *specimen);

/* State of a model. */
typedef struct State {
  size_t q_count, v_count;
  double *q, *v;
} State;
State state_new(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin);
State state_copy(const State *state);
void state_clear(State *state);
/* A random pose and motion; nodes are then scaled by `stretch` about the frame and each moved by up to `noise` m. */
State state_random(const SporeModel *model, GRand *random, double stretch, double noise);
/* The state as it is when the whole scene is moved by `pose`. */
void state_transform(const SporeModel *model, State *state, SporePose pose);
/* Moves along generalised velocity w for h seconds. */
State state_moved(const SporeModel *model, const State *state, const double *w, double h);

double *vector_new(size_t count); /* zeroed, g_free */
double *vector_random(GRand *random, size_t count, double amplitude);
double vector_dot(const double *a, const double *b, size_t count);
double vector_length(const double *a, size_t count);
double vector_distance(const double *a, const double *b, size_t count);
double *model_force(const SporeModel *model, const State *state); /* g_free */

#endif
