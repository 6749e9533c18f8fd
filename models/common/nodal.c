#include "models/common/nodal.h"

#include <assert.h>
#include <stdio.h>

#include "core/base/text.h"

void spore_nodal_place(const double *rest, size_t count, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q,
                       double *v) {
  assert(count == 0 || (rest && q && v));
  assert(q != v || count == 0);
  SporeMat3 rotation = spore_quat_to_mat3(pose.orientation);
  for (size_t i = 0; i < count; i++) {
    SporeVec3 arm = spore_mat3_apply(rotation, spore_vec3_load(rest + 3 * i));
    spore_vec3_store(q + 3 * i, spore_vec3_add(pose.position, arm));
    spore_vec3_store(v + 3 * i, spore_vec3_add(velocity, spore_vec3_cross(spin, arm)));
  }
}

void spore_nodal_damp(const SporeModel *model, double coefficient, const double *v, double *f) {
  assert(coefficient >= 0);
  assert(f != v || model->block_count == 0);
  if (coefficient == 0) return;
  for (size_t i = 0; i < 3 * model->block_count; i++) f[i] -= coefficient * model->block_mass[i / 3] * v[i];
}

void spore_nodal_damp_jacobian(const SporeModel *model, double coefficient, SporeBlockMatrix *matrix) {
  assert(coefficient >= 0);
  assert(matrix->block_count >= model->block_count);
  if (coefficient == 0) return;
  for (size_t i = 0; i < model->block_count; i++)
    for (size_t k = 0; k < 3; k++)
      matrix->values[9 * (size_t)matrix->diagonal[i] + 4 * k] += coefficient * model->block_mass[i];
}

bool spore_nodal_check_mass(const SporeModel *model, const char *element, SporeError *error) {
  assert(model->block_mass && element);
  for (size_t i = 0; i < model->block_count; i++) {
    if (model->block_mass[i] > 0) continue;
    char place[64];
    snprintf(place, sizeof place, "vertex %zu", i);
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("no %s with a size holds this vertex, so that it has no mass; every vertex of a moving "
                             "body needs mass; clean the mesh or remove the vertex"),
                           element);
  }
  return true;
}

bool spore_nodal_check_surface(const SporeTriangleMesh *mesh, SporeError *error) {
  if (mesh && mesh->triangle_count > 0) return spore_triangle_mesh_validate(mesh, error);
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("there is no surface; the model is made of one with triangles; give the body a mesh"));
}
