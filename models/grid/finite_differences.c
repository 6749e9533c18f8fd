/* Elasticity by finite differences on a regular grid inside a closed surface: Meseure et al. 2003 name it as future
 * work. What a cell does is in models/grid/lattice.h; here are the model's making and its parameters. */
#include <assert.h>

#include "core/base/memory.h"
#include "models/common/nodal.h"
#include "models/common/tissues.h"
#include "models/grid/lattice.h"
#include "models/registry.h"

#define WHOLE 0.25 /* of the volume in cells that the surface does not cut: with less, it is thin */

typedef struct GridFields {
  double young_modulus, poisson_ratio, density, mass_damping, stiffness_damping;
  int64_t cells;
} GridFields;

typedef struct Body {
  SporeModel base;
  SporeLattice lattice;
  SporeElasticity elasticity;
  double mass_damping; /* 1/s */
  bool thin;
} Body;

static const SporeParameter parameters[] = {
    SPORE_INTEGER_FIELD(GridFields, cells, 1, 1000, 10, SPORE_CHANGE_REBUILD,
                        N_("Cells along the longest side of the surface's box; they are about as long the other ways. "
                           "With twice as many the error is about a quarter.")),
    SPORE_TISSUE_YOUNG_MODULUS(GridFields),
    SPORE_REAL_FIELD(GridFields, poisson_ratio, "", 0, 0.49999, 0.4, SPORE_CHANGE_LIVE,
                     N_("Poisson's ratio; near 0.5 volume is kept.")),
    SPORE_TISSUE_DENSITY_AND_DAMPING(GridFields),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a grid"));
}

static void destroy(SporeModel *model) {
  Body *body = (Body *)model;
  spore_lattice_clear(&body->lattice);
  spore_model_clear(&body->base);
  spore_free(body);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  return spore_lattice_pattern(&((const Body *)model)->lattice, blocks);
}

/* In a matrix of the pattern that the world will make too. */
static bool find_blocks(Body *body) {
  SporeBlockMatrix matrix;
  if (!spore_model_matrix_create(&body->base, &matrix)) return false;
  spore_lattice_find_blocks(&body->lattice, &matrix);
  spore_block_matrix_clear(&matrix);
  return true;
}

static void tune(Body *body, const GridFields *fields) {
  body->elasticity = spore_elasticity(fields->young_modulus, fields->poisson_ratio, fields->stiffness_damping);
  body->mass_damping = fields->mass_damping;
}

/* Whether few of the filled cells are filled wholly. */
static bool is_thin(const SporeVoxels *voxels) {
  double whole = 0, all = 0;
  for (size_t cell = 0; cell < spore_voxels_count(voxels); cell++) {
    double share = voxels->share[cell];
    all += share;
    if (share == 1) whole += share;
  }
  return whole < WHOLE * all;
}

static bool build(Body *body, const SporeGeometry *geometry, const GridFields *fields, SporeError *error) {
  SporeVoxels voxels;
  if (!spore_voxels_create(&voxels, geometry->surface, (size_t)fields->cells, geometry->cancel, error)) return false;
  body->thin = is_thin(&voxels);
  if (!spore_lattice_create(&body->lattice, &voxels)) return no_memory(error);
  if (!spore_model_init(&body->base, &spore_finite_differences, body->lattice.node_count, false, error)) return false;
  spore_lattice_add_mass(&body->lattice, fields->density * body->lattice.voxels.volume, geometry->regions,
                         body->base.block_mass);
  if (!find_blocks(body)) return no_memory(error);
  tune(body, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  Body *body = SPORE_NEW(Body);
  if (!body) {
    no_memory(error);
    return NULL;
  }
  if (build(body, geometry, fields, error)) return &body->base;
  destroy(&body->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_finite_differences);
  spore_nodal_place(((const Body *)model)->lattice.rest, model->block_count, pose, velocity, spin, q, v);
}

typedef struct Loop {
  const Body *body;
  const double *q, *shape, *v;
  double *f;
  double stiffness_scale, damping_scale;
  SporeBlockMatrix *matrix;
  size_t odd; /* whether it goes through the odd slabs */
} Loop;

/* Through the even slabs, then through the odd ones. work: of a run, in units of roughly 10 ns. */
static void run(Loop *loop, size_t work, void (*compute)(void *data, size_t index)) {
  const SporeLattice *lattice = &loop->body->lattice;
  SporePool *pool = spore_pool_for(loop->body->base.pool, work * lattice->run_count / 2);
  for (loop->odd = 0; loop->odd < 2; loop->odd++)
    spore_pool_run(pool, (lattice->voxels.size[0] + 1 - loop->odd) / 2, compute, loop);
}

static void add_slab_forces(void *data, size_t index) {
  const Loop *loop = data;
  SPORE_KERNEL(spore_lattice_force)
  (&loop->body->lattice, 2 * index + loop->odd, loop->body->elasticity, loop->q, loop->shape, loop->v, loop->f);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  assert(model->type == &spore_finite_differences);
  const Body *body = (const Body *)model;
  Loop loop = {.body = body, .q = q, .shape = shape, .v = v, .f = f};
  run(&loop, 10, add_slab_forces);
  spore_nodal_damp(model, body->mass_damping, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_finite_differences);
  const Body *body = (const Body *)model;
  return SPORE_KERNEL(spore_lattice_potential)(&body->lattice, body->elasticity, q);
}

static void add_slab_jacobian(void *data, size_t index) {
  const Loop *loop = data;
  SPORE_KERNEL(spore_lattice_jacobian)
  (&loop->body->lattice, 2 * index + loop->odd, loop->body->elasticity, loop->q, loop->shape, loop->stiffness_scale,
   loop->damping_scale, loop->matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  assert(model->type == &spore_finite_differences);
  assert(matrix->block_count >= model->block_count);
  const Body *body = (const Body *)model;
  Loop loop = {.body = body,
               .q = q,
               .shape = shape,
               .stiffness_scale = stiffness_scale,
               .damping_scale = damping_scale,
               .matrix = matrix};
  run(&loop, 150, add_slab_jacobian);
  spore_nodal_damp_jacobian(model, damping_scale * body->mass_damping, matrix);
}

static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_finite_differences);
  return spore_lattice_strain(&((const Body *)model)->lattice, q);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_finite_differences);
  return spore_lattice_map(&((const Body *)model)->lattice, points, count, cancel, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_finite_differences);
  tune((Body *)model, fields);
  return true;
}

static const char *doubt(const SporeModel *model) {
  if (!((const Body *)model)->thin) return NULL;
  return _(
      "most of the grid's cells are cut by the surface, so that its thin parts bend less than they should; ask for "
      "more cells, or choose a model of tetrahedra");
}

const SporeModelType spore_finite_differences = {
    .name = "finite_differences",
    .label = N_("Finite differences"),
    .doc =
        N_("A solid on a regular grid of points inside a closed surface: no tetrahedra are needed. With two cells "
           "across it bends as it should to 3 %, where linear tetrahedra bend half as far, and that up to a "
           "Poisson's ratio of 0.49999; with one cell it bends a tenth to a quarter too far. Forces cost half of those "
           "of tetrahedra with as many points, a matrix somewhat more. For large strains it is as neo-Hookean "
           "tetrahedra, and comes back when it was crushed flat; corners of cells that went through each other can "
           "stay so. Cells that the surface cuts count by the share that lies inside."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(GridFields)},
    .geometry = SPORE_GEOMETRY_SOLID,
    .regions = true,
    .presets = spore_tissue_presets,
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .potential = potential,
    .strain = strain,
    .map = map,
    .pattern = pattern,
    .jacobian = jacobian,
    .retune = retune,
    .doubt = doubt,
};
