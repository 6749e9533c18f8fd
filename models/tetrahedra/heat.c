#include "models/tetrahedra/heat.h"

#include <assert.h>
#include <string.h>

#include "core/base/memory.h"

bool spore_tetrahedra_heat_create(SporeTetrahedraHeat *heated, const SporeTetrahedra *tetrahedra) {
  assert(!heated->whole);
  size_t batches = tetrahedra->batch_count, lanes = batches * SPORE_LANES;
  heated->whole = SPORE_NEW_ARRAY(SporeTetrahedronBatch, batches);
  heated->dose = SPORE_NEW_ARRAY(double, lanes);
  heated->length = SPORE_NEW_ARRAY(double, lanes);
  heated->stiffness = SPORE_NEW_ARRAY(double, lanes);
  if (!heated->whole || !heated->dose || !heated->length || !heated->stiffness) return false;
  memcpy(heated->whole, tetrahedra->batches, batches * sizeof *heated->whole);
  for (size_t i = 0; i < lanes; i++) heated->length[i] = heated->stiffness[i] = 1;
  return true;
}

void spore_tetrahedra_heat_clear(SporeTetrahedraHeat *heated) {
  spore_free(heated->whole);
  spore_free(heated->dose);
  spore_free(heated->length);
  spore_free(heated->stiffness);
  *heated = (SporeTetrahedraHeat){0};
}

static SporeVec3 middle_of(const SporeTetrahedronBatch *batch, size_t lane, const double *q) {
  SporeVec3 sum = {0, 0, 0};
  for (int a = 0; a < 4; a++) sum = spore_vec3_add(sum, spore_vec3_load(q + 3 * (size_t)batch->node[a][lane]));
  return spore_vec3_scale(0.25, sum);
}

/* With energy density W at F of a shape l times as long, in its volume: l^3 k V W(F / l). */
static void set_shape(SporeTetrahedronBatch *batch, size_t lane, const SporeTetrahedronBatch *whole, double length,
                      double stiffness) {
  assert(length > 0 && stiffness > 0);
  for (int k = 0; k < 9; k++) batch->inverse[k][lane] = whole->inverse[k][lane] / length;
  batch->volume[lane] = whole->volume[lane] * stiffness * length * length * length;
}

static bool coagulate(SporeTetrahedra *tetrahedra, SporeTetrahedraHeat *heated, size_t n, size_t lane,
                      const SporeHeat *heat) {
  assert(n < tetrahedra->batch_count && lane < tetrahedra->lanes[n]);
  size_t at = n * SPORE_LANES + lane;
  double dose = spore_heat_dose(heat, heated->dose[at]);
  if (dose <= 0) return false;
  heated->dose[at] += dose;
  heated->length[at] -= heat->shrinkage * dose;
  heated->stiffness[at] += (heat->stiffening - 1) * dose;
  set_shape(&tetrahedra->batches[n], lane, &heated->whole[n], heated->length[at], heated->stiffness[at]);
  return true;
}

size_t spore_tetrahedra_coagulate(SporeTetrahedra *tetrahedra, SporeTetrahedraHeat *heated, const double *q,
                                  const SporeHeat *heat) {
  assert(heated->whole && heat->radius >= 0);
  size_t count = 0;
  for (size_t n = 0; n < tetrahedra->batch_count; n++)
    for (size_t lane = 0; lane < tetrahedra->lanes[n]; lane++)
      if (spore_vec3_distance(middle_of(&tetrahedra->batches[n], lane, q), heat->point) < heat->radius)
        count += coagulate(tetrahedra, heated, n, lane, heat);
  return count;
}

void spore_tetrahedra_cool(SporeTetrahedra *tetrahedra, SporeTetrahedraHeat *heated) {
  if (!heated->whole) return;
  memcpy(tetrahedra->batches, heated->whole, tetrahedra->batch_count * sizeof *heated->whole);
  for (size_t i = 0; i < tetrahedra->batch_count * SPORE_LANES; i++) {
    heated->dose[i] = 0;
    heated->length[i] = heated->stiffness[i] = 1;
  }
}
