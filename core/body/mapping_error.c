/* Error of a mapping: how far its points are off under motions that are known. */
#include "core/body/mapping_error.h"

#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"

#define BEND 0.1 /* of the length: how far an end goes off the line */

/* Sum of the absolute weights of a point of a linear mapping; 1 for other mappings. */
static double leverage_of(const SporeMapping *mapping, size_t point) {
  assert(point < mapping->point_count);
  double sum = 0;
  if (mapping->kind != SPORE_MAPPING_LINEAR) return 1;
  for (uint32_t k = mapping->row_start[point]; k < mapping->row_start[point + 1]; k++) sum += fabs(mapping->weight[k]);
  return sum;
}

/* x' = centre + stretch (x - centre) + shift + along^2 aside, along the longest side of the box around the nodes.
 * With a radius: that side becomes an arc of a circle, in its plane with aside, and planes across the side stay square
 * to the arc. */
typedef struct Field {
  SporeVec3 centre, shift, along, aside;
  SporeMat3 stretch;
  double radius;
} Field;

static SporeVec3 arc_at(const Field *field, SporeVec3 arm) {
  assert(field->radius > 0);
  double along = spore_vec3_dot(field->along, arm), aside = spore_vec3_dot(field->aside, arm);
  double angle = along / field->radius, within = field->radius - aside;
  SporeVec3 moved = spore_vec3_add_scaled(arm, within * sin(angle) - along, field->along);
  return spore_vec3_add_scaled(moved, within * (1 - cos(angle)), field->aside);
}

static SporeVec3 field_at(const Field *field, SporeVec3 x) {
  SporeVec3 arm = spore_vec3_sub(x, field->centre);
  double along = spore_vec3_dot(field->along, arm);
  if (field->radius > 0) return spore_vec3_add(field->centre, arc_at(field, arm));
  SporeVec3 moved = spore_vec3_add(field->shift, spore_mat3_apply(field->stretch, arm));
  return spore_vec3_add(field->centre, spore_vec3_add_scaled(moved, along * along, field->aside));
}

static Field still(const double *nodes, size_t count, int *longest, double *length) {
  assert(count == 0 || nodes);
  double lower[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, upper[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  for (size_t i = 0; i < 3 * count; i++) {
    lower[i % 3] = fmin(lower[i % 3], nodes[i]);
    upper[i % 3] = fmax(upper[i % 3], nodes[i]);
  }
  *longest = 0;
  for (int k = 1; k < 3; k++)
    if (upper[k] - lower[k] > upper[*longest] - lower[*longest]) *longest = k;
  *length = upper[*longest] - lower[*longest];
  return (Field){.centre = spore_vec3_scale(0.5, spore_vec3_add(spore_vec3_load(lower), spore_vec3_load(upper))),
                 .stretch = {{1, 0, 0, 0, 1, 0, 0, 0, 1}}};
}

static Field affine_field(const double *nodes, size_t count) {
  int longest;
  double length;
  Field field = still(nodes, count, &longest, &length);
  field.stretch = (SporeMat3){{1.5, 0.3, 0, 0, 0.8, 0.2, -0.1, 0, 0.9}};
  field.shift = spore_vec3(0.1 * length, -0.2 * length, 0.3 * length);
  return field;
}

static Field bend_field(const double *nodes, size_t count) {
  int longest;
  double length, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Field field = still(nodes, count, &longest, &length);
  field.along = spore_vec3_load(axes[longest]);
  if (length > 0) field.aside = spore_vec3_scale(4 * BEND / length, spore_vec3_load(axes[(longest + 1) % 3]));
  return field;
}

static Field arc_field(const double *nodes, size_t count) {
  Field field = bend_field(nodes, count);
  double depth = spore_vec3_length(field.aside); /* 1 / (2 radius) */
  field.radius = depth > 0 ? 0.5 / depth : 0;
  field.aside = spore_vec3_normalise(field.aside, field.along);
  return field;
}

/* The model and mapping to measure, with room for a state and for places of the points. */
typedef struct Trial {
  const SporeModel *model;
  const SporeMapping *mapping;
  const double *points;
  double *q, *v, *at;
} Trial;

static void place(Trial *trial, SporePose pose) {
  const SporeVec3 none = {0, 0, 0};
  trial->model->type->place(trial->model, pose, none, none, trial->q, trial->v);
}

static double after_pose(Trial *trial, SporePose pose) {
  double worst = 0;
  place(trial, pose);
  spore_mapping_positions(trial->mapping, trial->q, trial->at);
  for (size_t i = 0; i < trial->mapping->point_count; i++) {
    SporeVec3 expected = spore_pose_apply(pose, spore_vec3_load(trial->points + 3 * i));
    worst = fmax(worst, spore_vec3_distance(expected, spore_vec3_load(trial->at + 3 * i)));
  }
  return worst;
}

static double after_field(Trial *trial, Field (*make)(const double *nodes, size_t count)) {
  double worst = 0;
  size_t nodes = trial->model->node_count;
  place(trial, spore_pose_identity());
  Field field = make(trial->q, nodes);
  for (size_t i = 0; i < nodes; i++)
    spore_vec3_store(trial->q + 3 * i, field_at(&field, spore_vec3_load(trial->q + 3 * i)));
  spore_mapping_positions(trial->mapping, trial->q, trial->at);
  for (size_t i = 0; i < trial->mapping->point_count; i++) {
    SporeVec3 expected = field_at(&field, spore_vec3_load(trial->points + 3 * i));
    worst = fmax(worst, spore_vec3_distance(expected, spore_vec3_load(trial->at + 3 * i)));
  }
  return worst;
}

static void run_trials(Trial *trial, SporeMappingError *measured) {
  *measured = (SporeMappingError){0};
  const SporePose turned = {{0.3, -0.2, 0.1}, spore_quat_from_rotation_vector(spore_vec3(0.48, -0.6, 0.64))};
  bool follows_nodes = trial->mapping->kind == SPORE_MAPPING_LINEAR || trial->mapping->kind == SPORE_MAPPING_IDENTITY;
  bool framed = trial->mapping->kind == SPORE_MAPPING_FRAMES;
  measured->rest = after_pose(trial, spore_pose_identity());
  measured->rigid = after_pose(trial, turned);
  measured->affine = follows_nodes ? after_field(trial, affine_field) : NAN;
  measured->bend = follows_nodes ? after_field(trial, bend_field) : framed ? after_field(trial, arc_field) : NAN;
  measured->leverage = 1;
  if (framed) measured->torn = trial->mapping->frames->torn;
  if (framed)
    measured->crowd = spore_line_frames_crowd(trial->mapping->frames, &measured->crowd_point, &measured->crowd_share);
  for (size_t i = 0; i < trial->mapping->point_count; i++)
    measured->leverage = fmax(measured->leverage, leverage_of(trial->mapping, i));
}

bool spore_mapping_measure(const SporeModel *model, const SporeMapping *mapping, const double *points,
                           SporeMappingError *measured, SporeError *error) {
  assert(model && mapping && measured);
  assert(mapping->point_count == 0 || points);
  Trial trial = {model,
                 mapping,
                 points,
                 SPORE_NEW_ARRAY(double, model->q_count),
                 SPORE_NEW_ARRAY(double, 3 * model->block_count),
                 SPORE_NEW_ARRAY(double, 3 * mapping->point_count)};
  bool made = trial.q && trial.v && trial.at;
  if (made) run_trials(&trial, measured);
  else spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), mapping->point_count);
  spore_free(trial.q);
  spore_free(trial.v);
  spore_free(trial.at);
  return made;
}
