/* Mapping: how points (collision spheres, visual vertices, attachments) follow a body's degrees of freedom.
 *
 * Positions come from the configuration q, velocities from the generalised velocity v (blocks of 3), and forces go
 * back by the transpose, so that virtual work is conserved: f . v_points = F . v. */
#ifndef SPORE_SIM_MAPPING_H
#define SPORE_SIM_MAPPING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/base/cancel.h"
#include "core/base/error.h"
#include "core/math/quat.h"
#include "core/body/line_frames.h"

/* How the points of a mapping follow q and v. */
typedef enum SporeMappingKind {
  SPORE_MAPPING_FIXED,    /* points never move; no degrees of freedom behind them */
  SPORE_MAPPING_IDENTITY, /* point i is block i: p = q[3i..3i+2] */
  SPORE_MAPPING_RIGID,    /* q: position (3), quaternion wxyz (4); v: velocity (3), angular velocity (3), world axes */
  SPORE_MAPPING_LINEAR,   /* p_i = sum over row i of weight * q[3 block .. 3 block + 2]; the weights sum to 1 */
  SPORE_MAPPING_FRAMES    /* points follow frames along a line; for what is only drawn, not for links and contacts */
} SporeMappingKind;

/* A mapping of point_count points. It owns its arrays, which are from spore_allocate. */
typedef struct SporeMapping {
  SporeMappingKind kind;
  size_t point_count;
  double *points;      /* fixed: world positions; rigid: in the body's frame; else NULL; point_count x 3, m */
  uint32_t *row_start; /* linear: point_count + 1: row i is row_start[i] .. row_start[i + 1] - 1 of block and weight */
  uint32_t *block;     /* linear: row_start[point_count] */
  double *weight;      /* linear: row_start[point_count] */
  SporeLineFrames *frames; /* frames */
  double *anchors; /* linear, of points along a line whose control points come and go: point_count x 4; the parameter of
                      the place on the line nearest to the point, and the vector from that place to the point in the
                      body's frame at rest, m. Rows have room for changes then. NULL: none */
} SporeMapping;

/* Constructors fill *mapping, which may be uninitialised, and copy what they are given. False: no memory, or as said
 * below; *mapping is empty then. Free a mapping by spore_mapping_clear. */

/* Points that never move, or points of a rigid body. points: count x 3, m, as SporeMapping.points. */
bool spore_mapping_init_points(SporeMapping *mapping, SporeMappingKind fixed_or_rigid, const double *points,
                               size_t count, SporeError *error);
/* Points that are the first `count` nodes themselves. Allocates nothing; always true. */
bool spore_mapping_init_identity(SporeMapping *mapping, size_t count);
/* Rows of `width` entries each. blocks, weights: count x width; zero weights are dropped. False: the weights of a row
 * do not sum to 1 to 1e-6. */
bool spore_mapping_init_linear(SporeMapping *mapping, size_t count, size_t width, const uint32_t *blocks,
                               const double *weights, SporeError *error);
/* Vertices of a mesh (body's frame at rest) that follow frames along a line. Such a mapping has room for one
 * evaluation: two threads must not evaluate it at once. */
bool spore_mapping_init_frames(SporeMapping *mapping, const SporeLine *line, const SporeTriangleMesh *mesh,
                               SporeError *error);
/* Frees the arrays and zeroes the mapping. A zeroed mapping is allowed. */
void spore_mapping_clear(SporeMapping *mapping);
/* What a model asks before it maps one more point. False: the mapping was cancelled, and *error says so. */
bool spore_mapping_goes_on(const SporeCancel *cancel, SporeError *error);

/* Finds by which tetrahedra the points of a linear mapping move, before a cut splits nodes. For each entry of the
 * mapping, (*places)[entry] is the index in `corners` of a corner that is the entry's block; all entries of a row get
 * corners of one tetrahedron. UINT32_MAX: no tetrahedron has all blocks of the row.
 * corners: tetrahedron_count x 4 nodes, each below node_count. *places: from spore_allocate; NULL for a mapping of
 * another kind. False: no memory. */
bool spore_mapping_find_places(const SporeMapping *mapping, const uint32_t *corners, size_t tetrahedron_count,
                               size_t node_count, uint32_t **places);
/* Gives each entry of the mapping the node that its corner has now. places: as found above; corners: as there, after
 * nodes were split. Does nothing for a mapping of another kind. */
void spore_mapping_follow(SporeMapping *mapping, const uint32_t *places, const uint32_t *corners);

/* Positions of all points at q, m. positions: point_count x 3. */
void spore_mapping_positions(const SporeMapping *mapping, const double *q, double *positions);
/* Velocities J v of all points at q, m/s. velocities: point_count x 3. */
void spore_mapping_velocities(const SporeMapping *mapping, const double *q, const double *v, double *velocities);
/* f += J^T forces. forces: point_count x 3, N, on the points; f: 3 doubles a block of v. */
void spore_mapping_add_forces(const SporeMapping *mapping, const double *q, const double *forces, double *f);

/* Position of one point at q, m. */
SporeVec3 spore_mapping_position(const SporeMapping *mapping, size_t point, const double *q);
/* Velocity of one point at q, m/s. */
SporeVec3 spore_mapping_velocity(const SporeMapping *mapping, size_t point, const double *q, const double *v);
/* f += J^T force, for a force (N) on one point. */
void spore_mapping_add_force(const SporeMapping *mapping, size_t point, const double *q, SporeVec3 force, double *f);
/* Adds the diagonal 3x3 blocks of J^T K J for one point to `blocks` (9 doubles a block of v): what a block-Jacobi
 * preconditioner needs. K: 3x3, N/m. Adds nothing for fixed points and for frames. */
void spore_mapping_add_diagonal(const SporeMapping *mapping, size_t point, const double *q, const SporeMat3 *k,
                                double *blocks);

#endif
