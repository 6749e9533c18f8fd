/* Solids of tetrahedra: the mesh's vertices are nodes, each tetrahedron a linear element. What the element does is in
 * models/tetrahedra.h; here are the models' making, assembly and parameters. */
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/fields.h"
#include "models/nodal.h"
#include "models/registry.h"
#include "models/tetrahedra.h"
#include "models/tetrahedra_map.h"
#include "models/tetrahedra_slabs.h"

#define SLAB 480 /* tetrahedra: what is worth a thread's while, some 7 us of forces */
#define SLABS_MAXIMUM 16
#define FLAT 1e-12 /* six volumes against the longest edge cubed: below, a tetrahedron is flat */

typedef struct TetrahedraFields {
  double young_modulus, poisson_ratio, density, mass_damping, stiffness_damping;
} TetrahedraFields;

/* Kernels by level of the processor. */
typedef struct Material {
  void (*const *force)(const SporeTetrahedra *tetrahedra, size_t slab, SporeElasticity elasticity, const double *q,
                       const double *shape, const double *v, double *f);
  double (*const *potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity, const double *q);
  void (*const *jacobian)(const SporeTetrahedra *tetrahedra, size_t slab, SporeElasticity elasticity, const double *q,
                          const double *shape, double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix);
} Material;

typedef struct Body {
  SporeModel base;
  const Material *material;
  SporeTetrahedralMesh mesh; /* at rest, body's frame */
  SporeTetrahedra tetrahedra;
  uint32_t *diagonal; /* block_count: where the diagonal blocks lie */
  SporeElasticity elasticity;
  double mass_damping; /* 1/s */
} Body;

static const SporeParameter parameters[] = {
    SPORE_REAL_FIELD(TetrahedraFields, young_modulus, "Pa", 1e-3, 1e15, 5000, SPORE_CHANGE_LIVE,
                     N_("Young's modulus, 2 (1 + Poisson's ratio) times the shear modulus; shear moduli: stomach 0.64, "
                        "liver 1.8, gallbladder 85, bile duct 166, hepatic artery 210 kPa (PMC6925591).")),
    SPORE_REAL_FIELD(TetrahedraFields, poisson_ratio, "", 0, 0.499, 0.4, SPORE_CHANGE_LIVE,
                     N_("Poisson's ratio; near 0.5 volume is kept, and these elements become too stiff in bending.")),
    SPORE_REAL_FIELD(TetrahedraFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume; 1060 is soft tissue.")),
    SPORE_REAL_FIELD(TetrahedraFields, mass_damping, "1/s", 0, 1e6, 0, SPORE_CHANGE_LIVE,
                     N_("Damping of all motion, as by a surrounding fluid: force per mass and speed.")),
    SPORE_REAL_FIELD(TetrahedraFields, stiffness_damping, "s", 0, 1e3, 0.01, SPORE_CHANGE_LIVE,
                     N_("Damping of deformation: viscous stress is this time times the stress of the strain rate.")),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a tetrahedral model"));
}

static void destroy(SporeModel *model) {
  Body *body = (Body *)model;
  spore_tetrahedral_mesh_clear(&body->mesh);
  spore_free(body->tetrahedra.slab_start);
  spore_free(body->tetrahedra.lanes);
  spore_free(body->tetrahedra.batches);
  spore_free(body->tetrahedra.blocks);
  spore_free(body->diagonal);
  spore_model_clear(&body->base);
  spore_free(body);
}

static bool copy_mesh(Body *body, const SporeTetrahedralMesh *mesh, SporeError *error) {
  if (!spore_tetrahedral_mesh_allocate(&body->mesh, mesh->vertex_count, mesh->tetrahedron_count, error)) return false;
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++) body->mesh.vertices[i] = mesh->vertices[i];
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++) body->mesh.tetrahedra[i] = mesh->tetrahedra[i];
  return true;
}

static double longest_edge(const SporeTetrahedralMesh *mesh, const uint32_t *corners) {
  double longest = 0;
  for (int a = 0; a < 4; a++)
    for (int b = 0; b < a; b++)
      longest = fmax(longest, spore_vec3_distance(spore_vec3_load(mesh->vertices + 3 * (size_t)corners[a]),
                                                  spore_vec3_load(mesh->vertices + 3 * (size_t)corners[b])));
  return longest;
}

static bool refuse_element(size_t t, double volume, double edge, SporeError *error) {
  char place[64];
  snprintf(place, sizeof place, "tetrahedron %zu", t);
  return spore_error_set(error, SPORE_ERROR_INPUT, place,
                         _("its volume at rest is %g m^3 with edges up to %g m; a positive volume was expected, or it "
                           "has no stiffness to compute; generate the tetrahedra again or remove this one"),
                         volume, edge);
}

static void set_element(SporeTetrahedronBatch *batch, size_t lane, const uint32_t corners[4],
                        const SporeVec3 gradient[3], double volume) {
  for (int k = 0; k < 4; k++) batch->node[k][lane] = corners[k];
  for (int k = 0; k < 3; k++) {
    batch->inverse[3 * k][lane] = gradient[k].x;
    batch->inverse[3 * k + 1][lane] = gradient[k].y;
    batch->inverse[3 * k + 2][lane] = gradient[k].z;
  }
  batch->volume[lane] = volume;
}

static size_t batches_for(size_t count) { return (count + SPORE_LANES - 1) / SPORE_LANES; }

static bool allocate_elements(SporeTetrahedra *tetrahedra, const SporeSlabs *slabs) {
  tetrahedra->slab_count = slabs->count;
  tetrahedra->slab_start = SPORE_NEW_ARRAY(uint32_t, slabs->count + 1);
  if (!tetrahedra->slab_start) return false;
  for (size_t s = 0; s < slabs->count; s++)
    tetrahedra->slab_start[s + 1] =
        tetrahedra->slab_start[s] + (uint32_t)batches_for(slabs->start[s + 1] - slabs->start[s]);
  tetrahedra->batch_count = tetrahedra->slab_start[slabs->count];
  tetrahedra->lanes = SPORE_NEW_ARRAY(uint8_t, tetrahedra->batch_count);
  tetrahedra->batches = SPORE_NEW_ARRAY(SporeTetrahedronBatch, tetrahedra->batch_count);
  tetrahedra->blocks = spore_allocate(tetrahedra->batch_count, sizeof *tetrahedra->blocks);
  return tetrahedra->lanes && tetrahedra->batches && tetrahedra->blocks;
}

/* Rest shape of a slab's elements. */
static void set_slab(Body *body, size_t slab, const uint32_t *order, size_t count) {
  SporeTetrahedra *tetrahedra = &body->tetrahedra;
  size_t start = tetrahedra->slab_start[slab], batches = tetrahedra->slab_start[slab + 1] - start;
  for (size_t i = 0; i < count; i++) {
    const uint32_t *corners = body->mesh.tetrahedra + 4 * (size_t)order[i];
    SporeTetrahedronBatch *batch = tetrahedra->batches + start + i % batches;
    SporeVec3 gradient[3];
    double volume = spore_tetrahedron_gradients(body->mesh.vertices, corners, gradient) / 6;
    size_t lane = tetrahedra->lanes[start + i % batches]++;
    set_element(batch, lane, corners, gradient, volume);
    for (size_t free = lane; lane == 0 && ++free < SPORE_LANES;) /* until others come: the same without a volume */
      set_element(batch, free, corners, gradient, 0);
  }
}

static bool set_elements(Body *body) {
  const SporeTetrahedralMesh *mesh = &body->mesh;
  size_t wanted = mesh->tetrahedron_count / SLAB;
  wanted = wanted < 1 ? 1 : wanted < SLABS_MAXIMUM ? wanted : SLABS_MAXIMUM;
  SporeSlabs slabs;
  if (!spore_slabs_create(&slabs, mesh->tetrahedra, mesh->tetrahedron_count, mesh->vertex_count, wanted)) return false;
  bool made = allocate_elements(&body->tetrahedra, &slabs);
  for (size_t s = 0; made && s < slabs.count; s++)
    set_slab(body, s, slabs.order + slabs.start[s], slabs.start[s + 1] - slabs.start[s]);
  spore_slabs_clear(&slabs);
  return made;
}

/* A quarter of an element's mass to each of its corners. */
static bool set_masses(Body *body, double density, SporeError *error) {
  const SporeTetrahedralMesh *mesh = &body->mesh;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    const uint32_t *corners = mesh->tetrahedra + 4 * t;
    SporeVec3 gradient[3];
    double six_volumes = spore_tetrahedron_gradients(mesh->vertices, corners, gradient);
    double edge = longest_edge(mesh, corners);
    if (!(six_volumes > FLAT * edge * edge * edge)) return refuse_element(t, six_volumes / 6, edge, error);
    for (int k = 0; k < 4; k++) body->base.block_mass[corners[k]] += density * six_volumes / 24;
  }
  return spore_nodal_check_mass(&body->base, "tetrahedron", error);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  const SporeTetrahedralMesh *mesh = &((const Body *)model)->mesh;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++)
    for (int a = 0; a < 4; a++)
      for (int b = 0; b < a; b++)
        if (!spore_block_pattern_add(blocks, mesh->tetrahedra[4 * t + a], mesh->tetrahedra[4 * t + b])) return false;
  return true;
}

/* Looks up each element's blocks once, in a matrix of the pattern that the world will make too. */
static bool find_blocks(Body *body) {
  SporeBlockPattern blocks;
  SporeBlockMatrix matrix;
  spore_block_pattern_init(&blocks, body->base.block_count);
  bool made = pattern(&body->base, &blocks) && spore_block_matrix_create(&matrix, &blocks);
  spore_block_pattern_clear(&blocks);
  if (!made) return false;
  for (size_t n = 0; n < body->tetrahedra.batch_count; n++)
    for (size_t lane = 0; lane < SPORE_LANES; lane++)
      for (int a = 0; a < 4; a++)
        for (int b = 0; b < 4; b++)
          body->tetrahedra.blocks[n][lane][4 * a + b] = (uint32_t)spore_block_matrix_find(
              &matrix, body->tetrahedra.batches[n].node[a][lane], body->tetrahedra.batches[n].node[b][lane]);
  for (size_t i = 0; i < body->base.block_count; i++) body->diagonal[i] = matrix.diagonal[i];
  spore_block_matrix_clear(&matrix);
  return true;
}

/* Lame's parameters from Young's modulus and Poisson's ratio. */
static void tune(Body *body, const TetrahedraFields *fields) {
  double e = fields->young_modulus, nu = fields->poisson_ratio;
  body->elasticity = (SporeElasticity){
      .mu = e / (2 * (1 + nu)), .lambda = e * nu / ((1 + nu) * (1 - 2 * nu)), .viscosity = fields->stiffness_damping};
  body->mass_damping = fields->mass_damping;
}

static bool build(Body *body, const SporeModelType *type, const SporeTetrahedralMesh *mesh,
                  const TetrahedraFields *fields, SporeError *error) {
  size_t nodes = mesh->vertex_count;
  if (!spore_model_init(&body->base, type, nodes, false, error) || !copy_mesh(body, mesh, error)) return false;
  if (!set_masses(body, fields->density, error)) return false;
  body->diagonal = SPORE_NEW_ARRAY(uint32_t, nodes);
  if (!body->diagonal || !set_elements(body) || !find_blocks(body)) return no_memory(error);
  tune(body, fields);
  return true;
}

static bool check_mesh(const SporeTetrahedralMesh *mesh, SporeError *error) {
  if (!mesh || mesh->tetrahedron_count == 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("there are no tetrahedra; this model needs a tetrahedral mesh; generate one from the "
                             "surface"));
  for (size_t i = 0; i < 3 * mesh->vertex_count; i++)
    if (!isfinite(mesh->vertices[i]))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("vertex %zu is not finite; every coordinate must be a number; mend the mesh"), i / 3);
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++)
    if (mesh->tetrahedra[i] >= mesh->vertex_count)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("tetrahedron %zu names vertex %u of %zu; every corner must exist; mend the mesh"), i / 4,
                             mesh->tetrahedra[i], mesh->vertex_count);
  return true;
}

static SporeModel *create(const SporeModelType *type, const Material *material, const SporeGeometry *geometry,
                          const void *fields, SporeError *error) {
  if (!check_mesh(geometry->tetrahedra, error)) return NULL;
  Body *body = SPORE_NEW(Body);
  if (!body) {
    no_memory(error);
    return NULL;
  }
  body->material = material;
  if (build(body, type, geometry->tetrahedra, fields, error)) return &body->base;
  destroy(&body->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  const Body *body = (const Body *)model;
  spore_nodal_place(body->mesh.vertices, body->base.block_count, pose, velocity, spin, q, v);
}

typedef struct Loop {
  const Body *body;
  const double *q, *shape, *v;
  double *f;
  double stiffness_scale, damping_scale;
  SporeBlockMatrix *matrix;
  size_t odd; /* whether it goes through the odd slabs */
} Loop;

/* Through the even slabs, then through the odd ones. work: of a batch, in units of roughly 10 ns. */
static void run(Loop *loop, size_t work, void (*compute)(void *data, size_t index)) {
  const SporeTetrahedra *tetrahedra = &loop->body->tetrahedra;
  SporePool *pool = spore_pool_for(loop->body->base.pool, work * tetrahedra->batch_count / 2);
  for (loop->odd = 0; loop->odd < 2; loop->odd++)
    spore_pool_run(pool, (tetrahedra->slab_count + 1 - loop->odd) / 2, compute, loop);
}

static void add_slab_forces(void *data, size_t index) {
  const Loop *loop = data;
  const Body *body = loop->body;
  body->material->force[spore_cpu_level()](&body->tetrahedra, 2 * index + loop->odd, body->elasticity, loop->q,
                                           loop->shape, loop->v, loop->f);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  const Body *body = (const Body *)model;
  Loop loop = {.body = body, .q = q, .shape = shape, .v = v, .f = f};
  run(&loop, 10, add_slab_forces);
  if (body->mass_damping == 0) return;
  for (size_t i = 0; i < body->base.q_count; i++) f[i] -= body->mass_damping * body->base.block_mass[i / 3] * v[i];
}

static double potential(const SporeModel *model, const double *q) {
  const Body *body = (const Body *)model;
  return body->material->potential[spore_cpu_level()](&body->tetrahedra, body->elasticity, q);
}

static void add_slab_jacobian(void *data, size_t index) {
  const Loop *loop = data;
  const Body *body = loop->body;
  body->material->jacobian[spore_cpu_level()](&body->tetrahedra, 2 * index + loop->odd, body->elasticity, loop->q,
                                              loop->shape, loop->stiffness_scale, loop->damping_scale, loop->matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const Body *body = (const Body *)model;
  Loop loop = {.body = body,
               .q = q,
               .shape = shape,
               .stiffness_scale = stiffness_scale,
               .damping_scale = damping_scale,
               .matrix = matrix};
  run(&loop, 70, add_slab_jacobian);
  for (size_t i = 0; i < body->base.block_count; i++)
    for (int k = 0; k < 3; k++)
      matrix->values[9 * (size_t)body->diagonal[i] + 4 * k] +=
          damping_scale * body->mass_damping * body->base.block_mass[i];
}

static bool map(const SporeModel *model, const double *points, size_t count, SporeMapping *mapping, SporeError *error) {
  return spore_tetrahedra_map(&((const Body *)model)->mesh, points, count, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  tune((Body *)model, fields);
  return true;
}

/* What both types have in common. */
#define SLOTS                                                                                                          \
  .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(TetrahedraFields)},                        \
  .geometry = SPORE_GEOMETRY_TETRAHEDRA, .destroy = destroy, .place = place, .force = force, .potential = potential,   \
  .map = map, .pattern = pattern, .jacobian = jacobian, .retune = retune

static SporeModel *create_corotational(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  static const Material material = {spore_corotation_force_by_level, spore_corotation_potential_by_level,
                                    spore_corotation_jacobian_by_level};
  return create(&spore_corotational_tetrahedra, &material, geometry, fields, error);
}

static SporeModel *create_neo_hookean(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  static const Material material = {spore_neo_hookean_force_by_level, spore_neo_hookean_potential_by_level,
                                    spore_neo_hookean_jacobian_by_level};
  return create(&spore_neo_hookean_tetrahedra, &material, geometry, fields, error);
}

const SporeModelType spore_corotational_tetrahedra = {
    .name = "corotational_tetrahedra",
    .label = N_("Corotational tetrahedra"),
    .doc = N_(
        "A solid of linear elastic tetrahedra, each in its own turned frame, so that large rotations cost nothing: "
        "the usual choice for organs. It comes back when it was crushed flat or a corner was pushed through; a heap of "
        "elements inside out can stay caught. With few cells "
        "across or a Poisson's ratio near 0.5 it bends less than it should: a bar 2 cells thick by half, 4 by a "
        "fifth."),
    .create = create_corotational,
    SLOTS,
};

const SporeModelType spore_neo_hookean_tetrahedra = {
    .name = "neo_hookean_tetrahedra",
    .label = N_("Neo-Hookean tetrahedra"),
    .doc =
        N_("A solid of tetrahedra that stiffen as rubber and tissue do when they are squeezed, and that turn the right "
           "way out again from any heap. The same as the corotational ones for small strains; an implicit step costs "
           "somewhat more. With few cells across or a Poisson's ratio near 0.5 it bends less than it should."),
    .create = create_neo_hookean,
    SLOTS,
};
