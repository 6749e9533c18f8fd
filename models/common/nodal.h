/* What models made of mass points share: a node is a block, q' = v. */
#ifndef SPORE_MODELS_COMMON_NODAL_H
#define SPORE_MODELS_COMMON_NODAL_H

#include "core/body/model.h"

/* Node i at pose applied to rest (3 a node), moving with the frame. */
void spore_nodal_place(const double *rest, size_t count, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q,
                       double *v);
/* Damping by mass (coefficient in 1/s) of models without rotation: force, and part of the Jacobian in a matrix of the
 * model's own pattern. */
void spore_nodal_damp(const SporeModel *model, double coefficient, const double *v, double *f);
void spore_nodal_damp_jacobian(const SporeModel *model, double coefficient, SporeBlockMatrix *matrix);
/* Refuses a node without mass: no `element` ("triangle") holds it, or only ones without size. */
bool spore_nodal_check_mass(const SporeModel *model, const char *element, SporeError *error);

/* Whether there is a surface of triangles, and one without faults. */
bool spore_nodal_check_surface(const SporeTriangleMesh *mesh, SporeError *error);

#endif
