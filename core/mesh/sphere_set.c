#include <assert.h>
#include <math.h>

#include "core/base/text.h"
#include "core/mesh/common.h"

#define WEIGHT_MAXIMUM 1000.0

bool spore_sphere_set_allocate(SporeSphereSet *set, size_t count, SporeError *error) {
  *set = (SporeSphereSet){0};
  if (count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, count);
  *set = (SporeSphereSet){.count = count, .spheres = SPORE_NEW_ARRAY(double, 4 * count)};
  if (set->spheres) return true;
  *set = (SporeSphereSet){0};
  return spore_mesh_no_memory(error);
}

bool spore_sphere_set_add_weights(SporeSphereSet *set, SporeError *error) {
  assert(!set->weights);
  set->weights = SPORE_NEW_ARRAY(double, set->count);
  return set->weights || spore_mesh_no_memory(error);
}

void spore_sphere_set_clear(SporeSphereSet *set) {
  spore_free(set->spheres);
  spore_free(set->weights);
  *set = (SporeSphereSet){0};
}

static bool check_level(const SporeSphereSet *set, SporeError *error) {
  if (set->weights ? set->level >= 0 && set->level <= SPORE_MESH_COORDINATE_MAXIMUM : set->level == 0) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the level of the sphere set is %g; a length of 0 to %g m, and 0 without weights, was "
                           "expected; correct it or generate the spheres again"),
                         set->level, SPORE_MESH_COORDINATE_MAXIMUM);
}

bool spore_sphere_set_validate(const SporeSphereSet *set, SporeError *error) {
  if (set->count > SPORE_MESH_MAXIMUM) return spore_mesh_too_large(error, set->count);
  if (!set->count)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the sphere set is empty; at least one sphere was expected; generate the spheres again"));
  if (!spore_mesh_check_points(set->spheres, set->count, 4, _("sphere"), error) || !check_level(set, error))
    return false;
  for (size_t i = 0; i < set->count; i++) {
    double radius = set->spheres[4 * i + 3];
    if (!(radius > 0 && radius <= SPORE_MESH_COORDINATE_MAXIMUM))
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("sphere %zu has the radius %g; a number above 0 and at most %g m was expected; correct "
                               "or remove that sphere"),
                             i, radius, SPORE_MESH_COORDINATE_MAXIMUM);
    if (set->weights && !(set->weights[i] > 0 && set->weights[i] <= WEIGHT_MAXIMUM))
      return spore_error_set(
          error, SPORE_ERROR_INPUT, NULL,
          _("sphere %zu has the weight %g; a number above 0 and at most %g was expected; correct it"), i,
          set->weights[i], WEIGHT_MAXIMUM);
  }
  return true;
}
