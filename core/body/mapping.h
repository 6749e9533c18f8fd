/* Mapping: how points (collision spheres, visual vertices, attachments) follow a body's degrees of freedom.
 *
 * Positions come from the configuration q, velocities from the generalised velocity v (blocks of 3), and forces go
 * back by the transpose, so that virtual work is conserved: f . v_points = F . v. */
#ifndef SPORE_SIM_MAPPING_H
#define SPORE_SIM_MAPPING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/base/error.h"
#include "core/math/quat.h"
#include "core/body/line_frames.h"

typedef enum SporeMappingKind {
  SPORE_MAPPING_FIXED,    /* points never move; no degrees of freedom behind them */
  SPORE_MAPPING_IDENTITY, /* point i is block i: p = q[3i..3i+2] */
  SPORE_MAPPING_RIGID,  /* q = position (3), quaternion wxyz (4); v = velocity (3), angular velocity (3), world axes */
  SPORE_MAPPING_LINEAR, /* p_i = sum over the row of weight * q[3 block..], weights sum to 1 */
  SPORE_MAPPING_FRAMES  /* points go with frames along a line: what is drawn alone, neither links nor contacts */
} SporeMappingKind;

typedef struct SporeMapping {
  SporeMappingKind kind;
  size_t point_count;
  double *points;          /* fixed: world positions; rigid: in the body's frame; else NULL; point_count x 3 */
  uint32_t *row_start;     /* linear: point_count + 1 */
  uint32_t *block;         /* linear: row_start[point_count] */
  double *weight;          /* linear: same length */
  SporeLineFrames *frames; /* frames: from spore_allocate */
  double *anchors; /* of points on and about a line whose knots come and go: parameter of the place next to them, and
                      from there to them in the body's frame at rest, 4 a point; rows have room then; NULL: none */
} SporeMapping;

/* Constructors copy; arrays from spore_allocate. */
bool spore_mapping_init_points(SporeMapping *mapping, SporeMappingKind fixed_or_rigid, const double *points,
                               size_t count, SporeError *error);
bool spore_mapping_init_identity(SporeMapping *mapping, size_t count);
/* Rows of equal length `width`: blocks and weights are count x width; zero weights are dropped. */
bool spore_mapping_init_linear(SporeMapping *mapping, size_t count, size_t width, const uint32_t *blocks,
                               const double *weights, SporeError *error);
/* Not for two threads at once, here and below. */
bool spore_mapping_init_frames(SporeMapping *mapping, const SporeLine *line, const SporeTriangleMesh *mesh,
                               SporeError *error);
void spore_mapping_clear(SporeMapping *mapping);

/* Points that hang on tetrahedra whose nodes change. Finds for each entry of a linear mapping a corner, of 4
 * tetrahedron_count, that is its block, of one and the same tetrahedron in each row; UINT32_MAX: there is none. Others
 * have no places. False: no memory. */
bool spore_mapping_find_places(const SporeMapping *mapping, const uint32_t *corners, size_t tetrahedron_count,
                               size_t node_count, uint32_t **places);
/* Each entry takes the block that its corner has now. */
void spore_mapping_follow(SporeMapping *mapping, const uint32_t *places, const uint32_t *corners);

/* All points at once; out is point_count x 3. */
void spore_mapping_positions(const SporeMapping *mapping, const double *q, double *positions);
void spore_mapping_velocities(const SporeMapping *mapping, const double *q, const double *v, double *velocities);
/* f += J^T forces; forces is point_count x 3. */
void spore_mapping_add_forces(const SporeMapping *mapping, const double *q, const double *forces, double *f);

/* One point. */
SporeVec3 spore_mapping_position(const SporeMapping *mapping, size_t point, const double *q);
SporeVec3 spore_mapping_velocity(const SporeMapping *mapping, size_t point, const double *q, const double *v);
void spore_mapping_add_force(const SporeMapping *mapping, size_t point, const double *q, SporeVec3 force, double *f);
/* Adds J^T K J of one point to 3x3 diagonal blocks (block_count x 9): what a block-Jacobi preconditioner needs; of
 * frames nothing. */
void spore_mapping_add_diagonal(const SporeMapping *mapping, size_t point, const double *q, const SporeMat3 *k,
                                double *blocks);

#endif
