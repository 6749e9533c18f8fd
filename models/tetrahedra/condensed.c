/* Condensed linear tetrahedra for haptics (Bro-Nielsen and Cotin 1996, "Real-time volumetric deformable models for
 * surgery simulation using finite elements and condensation"): with the nodes inside eliminated once,
 *   K* = K_ss - K_si K_ii^-1 K_is,
 * the surface alone is computed, and in balance it moves exactly as that of the whole solid does. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/linalg/block_cholesky.h"
#include "models/common/surface_map.h"
#include "models/registry.h"
#include "models/tetrahedra/linear_solid.h"

#define SURFACE_MAXIMUM 1000 /* nodes: their stiffness takes 72 MB */
#define NO_NODE UINT32_MAX

/* What is needed while inner nodes are eliminated. */
typedef struct Condensation {
  uint32_t *node;   /* of each vertex: its node on the surface, or NO_NODE */
  uint32_t *vertex; /* of each node */
  uint8_t *held;    /* vertices on the surface */
  SporeBlockMatrix full;
  SporeBlockCholesky inner;
  double *moved, *pull; /* 3 a vertex */
} Condensation;

static void condensation_clear(Condensation *work) {
  spore_free(work->node);
  spore_free(work->vertex);
  spore_free(work->held);
  spore_block_matrix_clear(&work->full);
  spore_block_cholesky_clear(&work->inner);
  spore_free(work->moved);
  spore_free(work->pull);
}

/* Numbers the vertices of the surface in their order; *count: how many. */
static void number_surface(Condensation *work, const SporeTetrahedralMesh *mesh, const uint32_t *triangles,
                           size_t triangle_count, size_t *count) {
  for (size_t k = 0; k < 3 * triangle_count; k++) work->held[triangles[k]] = 1;
  *count = 0;
  for (uint32_t i = 0; i < mesh->vertex_count; i++) {
    work->node[i] = work->held[i] ? (uint32_t)*count : NO_NODE;
    if (work->held[i]) work->vertex[(*count)++] = i;
  }
}

static bool set_surface(SporeLinearSolid *body, Condensation *work) {
  const SporeTetrahedralMesh *mesh = &body->nodes.mesh;
  uint32_t *triangles = NULL;
  size_t triangle_count = 0, count = 0;
  work->node = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  work->vertex = SPORE_NEW_ARRAY(uint32_t, mesh->vertex_count);
  work->held = SPORE_NEW_ARRAY(uint8_t, mesh->vertex_count);
  bool made =
      work->node && work->vertex && work->held && spore_tetrahedral_mesh_boundary(mesh, &triangles, &triangle_count);
  if (made) number_surface(work, mesh, triangles, triangle_count, &count);
  made = made && spore_triangle_mesh_allocate(&body->surface, count, triangle_count, NULL);
  for (size_t i = 0; made && i < count; i++)
    memcpy(body->surface.vertices + 3 * i, mesh->vertices + 3 * (size_t)work->vertex[i], 3 * sizeof(double));
  for (size_t k = 0; made && k < 3 * triangle_count; k++) body->surface.triangles[k] = work->node[triangles[k]];
  spore_free(triangles);
  return made;
}

static bool check_size(const SporeLinearSolid *body, SporeError *error) {
  if (body->surface.vertex_count <= SURFACE_MAXIMUM) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the surface has %zu nodes, each of which pulls on all others; at most %d were expected; "
                           "generate fewer cells, or choose linear tetrahedra"),
                         body->surface.vertex_count, SURFACE_MAXIMUM);
}

/* The stiffness of a surface on which each node pulls on all others. */
static bool create_dense(SporeLinearSolid *body) {
  size_t count = body->surface.vertex_count;
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, count);
  bool made = true;
  for (uint32_t i = 0; made && i < count; i++)
    for (uint32_t j = 0; made && j < i; j++) made = spore_block_pattern_add(&pattern, i, j);
  made = made && spore_block_matrix_create(&body->stiffness, &pattern);
  spore_block_pattern_clear(&pattern);
  return made;
}

/* Moves node j along an axis by 1 m with the inner nodes in balance: the displacements go to work->moved, the forces to
 * work->pull. */
static void move_one(Condensation *work, uint32_t j, int axis) {
  assert(j < work->full.block_count && axis >= 0 && axis < 3);
  size_t n = work->full.block_count, unit = 3 * (size_t)work->vertex[j] + (size_t)axis;
  memset(work->moved, 0, 3 * n * sizeof(double));
  memset(work->pull, 0, 3 * n * sizeof(double));
  work->moved[unit] = 1;
  spore_block_matrix_multiply_add(&work->full, work->moved, work->pull);
  for (size_t i = 0; i < 3 * n; i++) work->pull[i] = work->held[i / 3] ? 0 : -work->pull[i];
  spore_block_cholesky_solve(&work->inner, work->pull, work->moved);
  work->moved[unit] = 1;
  memset(work->pull, 0, 3 * n * sizeof(double));
  spore_block_matrix_multiply_add(&work->full, work->moved, work->pull);
}

/* Column by column. shares: for each vertex and node, how much the inner vertex follows the node; the shares of a
 * vertex add up to 1. False: cancelled. */
static bool condense(SporeLinearSolid *body, Condensation *work, double *shares, const SporeCancel *cancel) {
  assert(body->stiffness.block_count == body->surface.vertex_count);
  size_t count = body->surface.vertex_count;
  for (uint32_t j = 0; j < count; j++) {
    if (spore_cancel_asked(cancel)) return false;
    for (int axis = 0; axis < 3; axis++) {
      move_one(work, j, axis);
      for (size_t i = 0; i < work->full.block_count; i++)
        shares[i * count + j] += work->moved[3 * i + (size_t)axis] / 3;
      for (uint32_t i = 0; i < count; i++) /* dense and sorted: block (i, j) is number i count + j */
        for (size_t k = 0; k < 3; k++)
          body->stiffness.values[9 * (i * count + j) + 3 * k + (size_t)axis] =
              work->pull[3 * (size_t)work->vertex[i] + k];
    }
  }
  return true;
}

/* The mass of an inner vertex goes to the nodes that the vertex follows, by their shares. A few shares are negative and
 * count as 0. */
static void share_masses(SporeLinearSolid *body, const Condensation *work, double *shares, const double *mass) {
  size_t count = body->surface.vertex_count;
  for (size_t i = 0; i < work->full.block_count; i++) {
    double total = 0, *share = shares + i * count;
    for (size_t j = 0; j < count; j++) total += share[j] = fmax(share[j], 0);
    for (size_t j = 0; j < count; j++)
      if (work->held[i]) body->base.block_mass[j] += work->vertex[j] == i ? mass[i] : 0;
      else body->base.block_mass[j] += mass[i] * share[j] / total;
  }
}

/* K* is symmetric but for rounding; solvers need symmetry to the last bit. */
static void make_symmetric(SporeBlockMatrix *matrix) {
  assert(matrix->row_start[matrix->block_count] == matrix->block_count * matrix->block_count);
  size_t count = matrix->block_count;
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j <= i; j++)
      for (size_t k = 0; k < 9; k++) {
        double *one = matrix->values + 9 * (i * count + j) + k;
        double *other = matrix->values + 9 * (j * count + i) + 3 * (k % 3) + k / 3;
        *one = *other = 0.5 * (*one + *other);
      }
}

static bool eliminate(SporeLinearSolid *body, Condensation *work, const SporeLinearFields *fields,
                      const SporeCancel *cancel, SporeError *error) {
  size_t n = body->nodes.count;
  double *mass = SPORE_NEW_ARRAY(double, n), *shares = SPORE_NEW_ARRAY(double, n * body->surface.vertex_count);
  work->moved = SPORE_NEW_ARRAY(double, 3 * n);
  work->pull = SPORE_NEW_ARRAY(double, 3 * n);
  bool made = mass && shares && work->moved && work->pull &&
              spore_linear_stiffness(&body->nodes, fields->poisson_ratio, &work->full) &&
              spore_block_cholesky_create(&work->inner, &work->full, SPORE_FACTOR_AUTOMATIC, HUGE_VAL, cancel) &&
              create_dense(body);
  if (!made) spore_linear_solid_no_memory(error);
  if (made && !spore_block_cholesky_factorise(&work->inner, &work->full, NULL, work->held, false))
    made = spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the nodes inside cannot be eliminated; tetrahedra of a better shape were expected; "
                             "generate them again"));
  if (made) {
    spore_tetrahedron_nodes_add_mass(&body->nodes, fields->density, mass);
    made = condense(body, work, shares, cancel);
    if (made) share_masses(body, work, shares, mass), make_symmetric(&body->stiffness);
  }
  spore_free(mass);
  spore_free(shares);
  return made;
}

static bool build(SporeLinearSolid *body, const SporeGeometry *geometry, const SporeLinearFields *fields,
                  SporeError *error) {
  Condensation work = {0};
  bool made = spore_tetrahedron_nodes_create(&body->nodes, geometry->tetrahedra, false, geometry->regions) &&
              set_surface(body, &work);
  if (!made) spore_linear_solid_no_memory(error);
  made = made && check_size(body, error) &&
         spore_model_init(&body->base, &spore_condensed_tetrahedra, body->surface.vertex_count, false, error) &&
         eliminate(body, &work, fields, geometry->cancel, error);
  if (made && !spore_linear_solid_finish(body, fields)) made = spore_linear_solid_no_memory(error);
  condensation_clear(&work);
  return made;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  return spore_linear_solid_create(build, geometry, fields, error);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_condensed_tetrahedra);
  return spore_surface_map(&((const SporeLinearSolid *)model)->surface, NULL, points, count, cancel, model->map_slack,
                           mapping, error);
}

const SporeModelType spore_condensed_tetrahedra = {
    .name = "condensed_tetrahedra",
    .label = N_("Condensed tetrahedra"),
    .doc =
        N_("The surface of a solid of linear tetrahedra alone: what is inside was eliminated when it was made, and in "
           "balance the surface moves exactly as the whole would. Made for haptics with integrator static and up to a "
           "few hundred nodes on the surface, as each of them pulls on all others; while it moves, the mass inside is "
           "carried by the surface. For small strains only, and where no part turns by more than about 0.2 rad "
           "against the others. With few cells across or a Poisson's ratio near 0.5 it bends less than it should."),
    .create = create,
    .map = map,
    SPORE_LINEAR_SOLID_SLOTS,
};
