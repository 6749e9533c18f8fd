#include <math.h>

#include "core/generate/label_parts.h"

void spore_label_field_init(SporeLabelField *field, const SporeLabelMap *map, const bool *wanted) {
  const double *a = map->axes;
  SporeVec3 i = {a[0], a[4], a[8]}, j = {a[1], a[5], a[9]}, k = {a[2], a[6], a[10]}, origin = {a[3], a[7], a[11]};
  double volume = spore_vec3_dot(i, spore_vec3_cross(j, k));
  const SporeVec3 rows[3] = {spore_vec3_cross(j, k), spore_vec3_cross(k, i), spore_vec3_cross(i, j)};
  field->map = map;
  field->wanted = wanted;
  for (int r = 0; r < 3; r++) {
    SporeVec3 row = spore_vec3_scale(1 / volume, rows[r]);
    field->inverse[4 * r] = row.x, field->inverse[4 * r + 1] = row.y, field->inverse[4 * r + 2] = row.z;
    field->inverse[4 * r + 3] = -spore_vec3_dot(row, origin);
  }
}

static uint16_t label_of(const SporeLabelField *field, int64_t i, int64_t j, int64_t k) {
  const size_t *n = field->map->size;
  if (i < 0 || j < 0 || k < 0 || i >= (int64_t)n[0] || j >= (int64_t)n[1] || k >= (int64_t)n[2]) return 0;
  uint16_t label = field->map->labels[((size_t)k * n[1] + (size_t)j) * n[0] + (size_t)i];
  return field->wanted[label] ? label : 0;
}

void spore_label_field_shares(const SporeLabelField *field, SporeVec3 p, uint16_t label[SPORE_LABEL_CORNERS],
                              double share[SPORE_LABEL_CORNERS]) {
  const double *m = field->inverse;
  int64_t at[3];
  double part[3];
  for (int r = 0; r < 3; r++) {
    double index = m[4 * r] * p.x + m[4 * r + 1] * p.y + m[4 * r + 2] * p.z + m[4 * r + 3];
    at[r] = (int64_t)floor(index);
    part[r] = index - (double)at[r];
  }
  for (int c = 0; c < SPORE_LABEL_CORNERS; c++) {
    int x = c & 1, y = c >> 1 & 1, z = c >> 2;
    label[c] = label_of(field, at[0] + x, at[1] + y, at[2] + z);
    share[c] = (x ? part[0] : 1 - part[0]) * (y ? part[1] : 1 - part[1]) * (z ? part[2] : 1 - part[2]);
  }
}
