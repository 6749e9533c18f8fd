/* Linear tetrahedra by mass tensors (Cotin, Delingette and Ayache 2000, "A hybrid elastic model for real-time cutting,
 * deformations, and force feedback for surgery training and simulation"): the stiffness of each edge and vertex is made
 * once, and a force is one product with it. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/nodal.h"
#include "models/common/stretch.h"
#include "models/registry.h"
#include "models/tetrahedra/linear_solid.h"
#include "models/tetrahedra/map.h"

static bool set_surface(SporeLinearSolid *body) {
  const SporeTetrahedralMesh *mesh = &body->nodes.mesh;
  SporeTriangleMesh view = {mesh->vertex_count, 0, mesh->vertices, NULL};
  bool made = spore_tetrahedral_mesh_boundary(mesh, &view.triangles, &view.triangle_count) &&
              spore_triangle_mesh_copy(&body->surface, &view, NULL);
  spore_free(view.triangles);
  return made;
}

static bool build(SporeLinearSolid *body, const SporeGeometry *geometry, const SporeLinearFields *fields,
                  SporeError *error) {
  const SporeTetrahedralMesh *mesh = geometry->tetrahedra;
  if (!spore_tetrahedron_nodes_create(&body->nodes, mesh, false, geometry->regions))
    return spore_linear_solid_no_memory(error);
  if (!spore_model_init(&body->base, &spore_linear_tetrahedra, mesh->vertex_count, false, error)) return false;
  spore_tetrahedron_nodes_add_mass(&body->nodes, fields->density, body->base.block_mass);
  if (!spore_nodal_check_mass(&body->base, "tetrahedron", error)) return false;
  return (set_surface(body) && spore_linear_stiffness(&body->nodes, fields->poisson_ratio, &body->stiffness) &&
          spore_linear_solid_finish(body, fields)) ||
         spore_linear_solid_no_memory(error);
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  return spore_linear_solid_create(build, geometry, fields, error);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_linear_tetrahedra);
  return spore_tetrahedra_map(&((const SporeLinearSolid *)model)->nodes, points, count, cancel, mapping, error);
}

static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_linear_tetrahedra);
  const SporeLinearSolid *body = (const SporeLinearSolid *)model;
  double most = 0;
  for (size_t n = 0; n < body->nodes.mesh.tetrahedron_count; n++) {
    const uint32_t *corners = body->nodes.nodes + 4 * n;
    SporeVec3 f[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, weight[3];
    spore_tetrahedron_gradients(body->place, corners, weight);
    for (int k = 0; k < 3; k++) {
      SporeVec3 edge =
          spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)corners[k + 1]), spore_vec3_load(q + 3 * (size_t)corners[0]));
      f[0] = spore_vec3_add_scaled(f[0], weight[k].x, edge);
      f[1] = spore_vec3_add_scaled(f[1], weight[k].y, edge);
      f[2] = spore_vec3_add_scaled(f[2], weight[k].z, edge);
    }
    most = spore_stretch_square(f, most);
  }
  return sqrt(most) - 1;
}

const SporeModelType spore_linear_tetrahedra = {
    .name = "linear_tetrahedra",
    .label = N_("Linear tetrahedra"),
    .doc =
        N_("A solid of linear elasticity with a stiffness made once, in a frame that turns with the whole body: a "
           "force is one product with it. For small strains only, and where no part turns by more than about 0.2 rad "
           "against the others: beyond that it swells and bends too little, and says so. It does not feel being "
           "turned inside out. With few cells across or a Poisson's ratio near 0.5 it bends less than it should. Its "
           "steps take about as long as those of neo-Hookean tetrahedra, which have no limit of strain."),
    .create = create,
    .map = map,
    .strain = strain,
    SPORE_LINEAR_SOLID_SLOTS,
};
