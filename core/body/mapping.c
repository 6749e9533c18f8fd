/* Mappings: points that follow a body, their velocities, and forces back to the body. */
#include "core/body/mapping.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/body/mapping_kernels.h"

static bool no_memory(SporeMapping *mapping, SporeError *error) {
  spore_mapping_clear(mapping);
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory to map points onto a body"));
}

bool spore_mapping_init_points(SporeMapping *mapping, SporeMappingKind fixed_or_rigid, const double *points,
                               size_t count, SporeError *error) {
  assert(fixed_or_rigid == SPORE_MAPPING_FIXED || fixed_or_rigid == SPORE_MAPPING_RIGID);
  assert(count == 0 || points);
  *mapping = (SporeMapping){.kind = fixed_or_rigid, .point_count = count};
  mapping->points = SPORE_NEW_ARRAY(double, 3 * count);
  if (!mapping->points) return no_memory(mapping, error);
  if (count) memcpy(mapping->points, points, 3 * count * sizeof *points);
  return true;
}

bool spore_mapping_init_identity(SporeMapping *mapping, size_t count) {
  *mapping = (SporeMapping){.kind = SPORE_MAPPING_IDENTITY, .point_count = count};
  return true;
}

bool spore_mapping_goes_on(const SporeCancel *cancel, SporeError *error) {
  return !spore_cancel_asked(cancel) || spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
}

static bool row_is_affine(const double *weights, size_t width) {
  double sum = 0;
  for (size_t k = 0; k < width; k++) sum += weights[k];
  return fabs(sum - 1) <= 1e-6;
}

bool spore_mapping_init_linear(SporeMapping *mapping, size_t count, size_t width, const uint32_t *blocks,
                               const double *weights, SporeError *error) {
  assert(count == 0 || (width > 0 && blocks && weights));
  *mapping = (SporeMapping){.kind = SPORE_MAPPING_LINEAR, .point_count = count};
  size_t entries = 0;
  for (size_t k = 0; k < count * width; k++) entries += weights[k] != 0;
  if (entries > UINT32_MAX) return no_memory(mapping, error);
  mapping->row_start = SPORE_NEW_ARRAY(uint32_t, count + 1);
  mapping->block = SPORE_NEW_ARRAY(uint32_t, entries);
  mapping->weight = SPORE_NEW_ARRAY(double, entries);
  if (!mapping->row_start || !mapping->block || !mapping->weight) return no_memory(mapping, error);
  uint32_t filled = 0;
  for (size_t i = 0; i < count; i++) {
    if (!row_is_affine(weights + i * width, width)) {
      spore_mapping_clear(mapping);
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("the weights of point %zu do not add up to 1; expected an affine combination; "
                               "check the geometry near that point for flat elements"),
                             i);
    }
    for (size_t k = i * width; k < (i + 1) * width; k++) {
      if (weights[k] == 0) continue;
      mapping->block[filled] = blocks[k];
      mapping->weight[filled++] = weights[k];
    }
    mapping->row_start[i + 1] = filled;
  }
  return true;
}

bool spore_mapping_init_frames(SporeMapping *mapping, const SporeLine *line, const SporeTriangleMesh *mesh,
                               SporeError *error) {
  *mapping = (SporeMapping){.kind = SPORE_MAPPING_FRAMES, .point_count = mesh->vertex_count};
  mapping->frames = SPORE_NEW(SporeLineFrames);
  if (!mapping->frames) return no_memory(mapping, error);
  if (spore_line_frames_init(mapping->frames, line, mesh, error)) return true;
  spore_mapping_clear(mapping);
  return false;
}

void spore_mapping_clear(SporeMapping *mapping) {
  if (mapping->frames) spore_line_frames_clear(mapping->frames);
  spore_free(mapping->frames);
  spore_free(mapping->points);
  spore_free(mapping->row_start);
  spore_free(mapping->block);
  spore_free(mapping->weight);
  spore_free(mapping->anchors);
  *mapping = (SporeMapping){0};
}

/* The corners of node i: list[start[i] .. start[i + 1]). */
static bool list_corners(const uint32_t *corners, size_t count, size_t node_count, uint32_t **start, uint32_t **list) {
  *start = SPORE_NEW_ARRAY(uint32_t, node_count + 2);
  *list = SPORE_NEW_ARRAY(uint32_t, count);
  if (!*start || !*list) return false;
  for (size_t i = 0; i < count; i++) {
    assert(corners[i] < node_count);
    (*start)[corners[i] + 2]++;
  }
  for (size_t i = 0; i < node_count; i++) (*start)[i + 2] += (*start)[i + 1];
  for (size_t i = 0; i < count; i++) (*list)[(*start)[corners[i] + 1]++] = (uint32_t)i;
  return true;
}

/* Whether all blocks are nodes of the tetrahedron. Sets their corners. */
static bool place_row(const uint32_t *block, size_t count, const uint32_t *corners, uint32_t tetrahedron,
                      uint32_t *places) {
  for (size_t k = 0; k < count; k++) {
    uint32_t at = 4 * tetrahedron, end = at + 4;
    while (at < end && corners[at] != block[k]) at++;
    if (at == end) return false;
    places[k] = at;
  }
  return true;
}

static void find_row(const SporeMapping *mapping, size_t point, const uint32_t *corners, const uint32_t *start,
                     const uint32_t *list, uint32_t *places) {
  assert(point < mapping->point_count);
  uint32_t first = mapping->row_start[point], count = mapping->row_start[point + 1] - first;
  if (count == 0) return;
  const uint32_t *block = mapping->block + first;
  for (uint32_t i = start[block[0]]; i < start[block[0] + 1]; i++)
    if (place_row(block, count, corners, list[i] / 4, places + first)) return;
  for (uint32_t k = 0; k < count; k++) places[first + k] = UINT32_MAX;
}

bool spore_mapping_find_places(const SporeMapping *mapping, const uint32_t *corners, size_t tetrahedron_count,
                               size_t node_count, uint32_t **places) {
  assert(tetrahedron_count == 0 || corners);
  uint32_t *start = NULL, *list = NULL;
  *places = NULL;
  if (mapping->kind != SPORE_MAPPING_LINEAR) return true;
  *places = SPORE_NEW_ARRAY(uint32_t, mapping->row_start[mapping->point_count]);
  bool made = *places && list_corners(corners, 4 * tetrahedron_count, node_count, &start, &list);
  for (size_t i = 0; made && i < mapping->point_count; i++) find_row(mapping, i, corners, start, list, *places);
  spore_free(start);
  spore_free(list);
  return made;
}

void spore_mapping_follow(SporeMapping *mapping, const uint32_t *places, const uint32_t *corners) {
  assert(corners);
  if (mapping->kind != SPORE_MAPPING_LINEAR || !places) return;
  for (uint32_t k = 0; k < mapping->row_start[mapping->point_count]; k++)
    if (places[k] != UINT32_MAX) mapping->block[k] = corners[places[k]];
}

static SporeVec3 linear_combination(const SporeMapping *mapping, size_t point, const double *values) {
  SporeVec3 sum = {0, 0, 0};
  for (uint32_t k = mapping->row_start[point]; k < mapping->row_start[point + 1]; k++)
    sum = spore_vec3_add_scaled(sum, mapping->weight[k], spore_vec3_load(values + 3 * (size_t)mapping->block[k]));
  return sum;
}

/* From the body's origin to the point, in world axes. */
static SporeVec3 lever(const SporeMapping *mapping, size_t point, const double *q) {
  assert(mapping->points && q);
  return spore_quat_rotate(spore_quat_load(q + 3), spore_vec3_load(mapping->points + 3 * point));
}

SporeVec3 spore_mapping_position(const SporeMapping *mapping, size_t point, const double *q) {
  assert(point < mapping->point_count);
  double place[3];
  switch (mapping->kind) {
  case SPORE_MAPPING_FIXED:
    return spore_vec3_load(mapping->points + 3 * point);
  case SPORE_MAPPING_IDENTITY:
    return spore_vec3_load(q + 3 * point);
  case SPORE_MAPPING_RIGID:
    return spore_vec3_add(spore_vec3_load(q), lever(mapping, point, q));
  case SPORE_MAPPING_FRAMES:
    spore_line_frames_positions(mapping->frames, point, q, place);
    return spore_vec3_load(place);
  case SPORE_MAPPING_LINEAR:
    break;
  }
  return linear_combination(mapping, point, q);
}

SporeVec3 spore_mapping_velocity(const SporeMapping *mapping, size_t point, const double *q, const double *v) {
  assert(point < mapping->point_count && v);
  double speed[3];
  switch (mapping->kind) {
  case SPORE_MAPPING_FIXED:
    return (SporeVec3){0, 0, 0};
  case SPORE_MAPPING_IDENTITY:
    return spore_vec3_load(v + 3 * point);
  case SPORE_MAPPING_RIGID:
    return spore_vec3_add(spore_vec3_load(v), spore_vec3_cross(spore_vec3_load(v + 3), lever(mapping, point, q)));
  case SPORE_MAPPING_FRAMES:
    spore_line_frames_velocities(mapping->frames, point, q, v, speed);
    return spore_vec3_load(speed);
  case SPORE_MAPPING_LINEAR:
    break;
  }
  return linear_combination(mapping, point, v);
}

void spore_mapping_add_force(const SporeMapping *mapping, size_t point, const double *q, SporeVec3 force, double *f) {
  assert(point < mapping->point_count && f);
  double one[3];
  switch (mapping->kind) {
  case SPORE_MAPPING_FIXED:
    break;
  case SPORE_MAPPING_IDENTITY:
    spore_vec3_accumulate(f + 3 * point, force);
    break;
  case SPORE_MAPPING_RIGID:
    spore_vec3_accumulate(f, force);
    spore_vec3_accumulate(f + 3, spore_vec3_cross(lever(mapping, point, q), force));
    break;
  case SPORE_MAPPING_FRAMES:
    spore_vec3_store(one, force);
    spore_line_frames_add_forces(mapping->frames, point, q, one, f);
    break;
  case SPORE_MAPPING_LINEAR:
    for (uint32_t k = mapping->row_start[point]; k < mapping->row_start[point + 1]; k++)
      spore_vec3_accumulate(f + 3 * (size_t)mapping->block[k], spore_vec3_scale(mapping->weight[k], force));
    break;
  }
}

static void add_block(double *block, double scale, const SporeMat3 *k) {
  for (int e = 0; e < 9; e++) block[e] += scale * k->m[e];
}

void spore_mapping_add_diagonal(const SporeMapping *mapping, size_t point, const double *q, const SporeMat3 *k,
                                double *blocks) {
  assert(point < mapping->point_count && blocks);
  switch (mapping->kind) {
  case SPORE_MAPPING_FRAMES:
  case SPORE_MAPPING_FIXED:
    break;
  case SPORE_MAPPING_IDENTITY:
    add_block(blocks + 9 * point, 1, k);
    break;
  case SPORE_MAPPING_RIGID: {
    /* The point's velocity is v + w x r = v - [r]x w, so J^T K J has [r]x^T K [r]x for the rotation. */
    SporeMat3 r = spore_mat3_skew(lever(mapping, point, q));
    SporeMat3 turned = spore_mat3_multiply(spore_mat3_transpose(r), spore_mat3_multiply(*k, r));
    add_block(blocks, 1, k);
    add_block(blocks + 9, 1, &turned);
    break;
  }
  case SPORE_MAPPING_LINEAR:
    for (uint32_t e = mapping->row_start[point]; e < mapping->row_start[point + 1]; e++)
      add_block(blocks + 9 * (size_t)mapping->block[e], mapping->weight[e] * mapping->weight[e], k);
    break;
  }
}

void spore_mapping_positions(const SporeMapping *mapping, const double *q, double *positions) {
  assert(mapping->point_count == 0 || positions);
  size_t n = mapping->point_count;
  switch (mapping->kind) {
  case SPORE_MAPPING_FIXED:
    memcpy(positions, mapping->points, 3 * n * sizeof *q);
    break;
  case SPORE_MAPPING_IDENTITY:
    memcpy(positions, q, 3 * n * sizeof *q);
    break;
  case SPORE_MAPPING_RIGID: {
    SporeMat3 rotation = spore_quat_to_mat3(spore_quat_load(q + 3));
    for (size_t i = 0; i < n; i++) {
      SporeVec3 arm = spore_mat3_apply(rotation, spore_vec3_load(mapping->points + 3 * i));
      spore_vec3_store(positions + 3 * i, spore_vec3_add(spore_vec3_load(q), arm));
    }
    break;
  }
  case SPORE_MAPPING_FRAMES:
    spore_line_frames_positions(mapping->frames, SPORE_LINE_ALL, q, positions);
    break;
  case SPORE_MAPPING_LINEAR:
    SPORE_KERNEL(spore_mapping_combine)(mapping, q, positions);
    break;
  }
}

void spore_mapping_velocities(const SporeMapping *mapping, const double *q, const double *v, double *velocities) {
  assert(mapping->point_count == 0 || velocities);
  size_t n = mapping->point_count;
  switch (mapping->kind) {
  case SPORE_MAPPING_FIXED:
    memset(velocities, 0, 3 * n * sizeof *v);
    break;
  case SPORE_MAPPING_IDENTITY:
    memcpy(velocities, v, 3 * n * sizeof *v);
    break;
  case SPORE_MAPPING_RIGID: {
    SporeMat3 rotation = spore_quat_to_mat3(spore_quat_load(q + 3));
    SporeVec3 linear = spore_vec3_load(v), spin = spore_vec3_load(v + 3);
    for (size_t i = 0; i < n; i++) {
      SporeVec3 arm = spore_mat3_apply(rotation, spore_vec3_load(mapping->points + 3 * i));
      spore_vec3_store(velocities + 3 * i, spore_vec3_add(linear, spore_vec3_cross(spin, arm)));
    }
    break;
  }
  case SPORE_MAPPING_FRAMES:
    spore_line_frames_velocities(mapping->frames, SPORE_LINE_ALL, q, v, velocities);
    break;
  case SPORE_MAPPING_LINEAR:
    SPORE_KERNEL(spore_mapping_combine)(mapping, v, velocities);
    break;
  }
}

void spore_mapping_add_forces(const SporeMapping *mapping, const double *q, const double *forces, double *f) {
  assert(mapping->point_count == 0 || (forces && f));
  if (mapping->kind == SPORE_MAPPING_FRAMES) {
    spore_line_frames_add_forces(mapping->frames, SPORE_LINE_ALL, q, forces, f);
    return;
  }
  for (size_t i = 0; i < mapping->point_count; i++)
    spore_mapping_add_force(mapping, i, q, spore_vec3_load(forces + 3 * i), f);
}
