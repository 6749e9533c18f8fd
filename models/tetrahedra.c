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

#define FLAT 1e-12 /* six volumes against the longest edge cubed: below, a tetrahedron is flat */

typedef struct TetrahedraFields {
  double young_modulus, poisson_ratio, density, mass_damping, stiffness_damping;
} TetrahedraFields;

/* Kernels by level of the processor. */
typedef struct Material {
  void (*const *force)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity, const double *q,
                       const double *shape, const double *v, double *f);
  double (*const *potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity, const double *q);
  void (*const *jacobian)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity, const double *q,
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

/* Rest shape of the elements, and a quarter of their mass to each corner. */
static bool set_elements(Body *body, double density, SporeError *error) {
  const SporeTetrahedralMesh *mesh = &body->mesh;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    const uint32_t *corners = mesh->tetrahedra + 4 * t;
    size_t batch = t % body->tetrahedra.batch_count, lane = t / body->tetrahedra.batch_count;
    SporeVec3 gradient[3];
    double six_volumes = spore_tetrahedron_gradients(mesh->vertices, corners, gradient);
    double edge = longest_edge(mesh, corners);
    if (!(six_volumes > FLAT * edge * edge * edge)) return refuse_element(t, six_volumes / 6, edge, error);
    set_element(body->tetrahedra.batches + batch, lane, corners, gradient, six_volumes / 6);
    for (size_t free = lane; lane == 0 && ++free < SPORE_LANES;) /* until others come: the same without a volume */
      set_element(body->tetrahedra.batches + batch, free, corners, gradient, 0);
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
  size_t nodes = mesh->vertex_count, count = mesh->tetrahedron_count;
  if (!spore_model_init(&body->base, type, nodes, false, error) || !copy_mesh(body, mesh, error)) return false;
  SporeTetrahedra *tetrahedra = &body->tetrahedra;
  tetrahedra->count = count;
  tetrahedra->batch_count = (count + SPORE_LANES - 1) / SPORE_LANES;
  tetrahedra->batches = SPORE_NEW_ARRAY(SporeTetrahedronBatch, tetrahedra->batch_count);
  tetrahedra->blocks = spore_allocate(tetrahedra->batch_count, sizeof *tetrahedra->blocks);
  body->diagonal = SPORE_NEW_ARRAY(uint32_t, nodes);
  if (!tetrahedra->batches || !tetrahedra->blocks || !body->diagonal) return no_memory(error);
  if (!set_elements(body, fields->density, error)) return false;
  if (!find_blocks(body)) return no_memory(error);
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

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  const Body *body = (const Body *)model;
  body->material->force[spore_cpu_level()](&body->tetrahedra, body->elasticity, q, shape, v, f);
  if (body->mass_damping == 0) return;
  for (size_t i = 0; i < body->base.q_count; i++) f[i] -= body->mass_damping * body->base.block_mass[i / 3] * v[i];
}

static double potential(const SporeModel *model, const double *q) {
  const Body *body = (const Body *)model;
  return body->material->potential[spore_cpu_level()](&body->tetrahedra, body->elasticity, q);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const Body *body = (const Body *)model;
  body->material->jacobian[spore_cpu_level()](&body->tetrahedra, body->elasticity, q, shape, stiffness_scale,
                                              damping_scale, matrix);
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
