/* One model of each registered type and shape, and the states that the conformance tests put it in. */
#include "tests/conformance/specimen.h"

#include <string.h>

static void wave(SporeTriangleMesh *mesh) {
  for (size_t i = 0; i < mesh->vertex_count; i++) {
    double *x = mesh->vertices + 3 * i;
    x[2] = 0.01 * sin(40 * x[0]) * cos(30 * x[1]) + 0.3 * x[0] * x[0];
  }
}

static void shape(Specimen *specimen, const char *name) {
  if (!strcmp(name, "box")) shape_box(&specimen->surface, spore_vec3(0.03, -0.02, 0.05), spore_vec3(0.1, 0.06, 0.04));
  if (!strcmp(name, "closed")) shape_block_surface(&specimen->surface, 4, 1, 1, spore_vec3(0.08, 0.02, 0.03));
  if (!strcmp(name, "flat_sheet")) shape_sheet(&specimen->surface, 5, 4, 0.02, FALSE);
  if (!strcmp(name, "wavy_sheet")) {
    shape_sheet(&specimen->surface, 6, 6, 0.02, TRUE);
    wave(&specimen->surface);
  }
  if (!strcmp(name, "needle")) shape_box(&specimen->surface, spore_vec3(0, 0, 0.2), spore_vec3(1e-3, 2e-3, 0.5));
  if (!strcmp(name, "block")) shape_block(&specimen->tetrahedra, 3, 2, 2, spore_vec3(0.06, 0.04, 0.05));
  if (!strcmp(name, "straight")) shape_line(&specimen->curve, 3, 1, 0.01);
  if (!strcmp(name, "helix")) shape_helix(&specimen->curve, 60, 0.15, 0.2, 0.01);
  if (!strcmp(name, "one_cell")) shape_block(&specimen->tetrahedra, 1, 1, 1, spore_vec3(0.02, 0.02, 0.02));
}

/* The same curve, smaller, about its middle. */
static void shape_inside(SporeCurve *inside, const SporeCurve *curve) {
  SporeVec3 middle = {0, 0, 0};
  g_assert_true(spore_curve_allocate(inside, curve->count, NULL));
  for (size_t i = 0; i < curve->count; i++)
    middle = spore_vec3_add_scaled(middle, 1.0 / (double)curve->count, spore_vec3_load(curve->points + 4 * i));
  for (size_t i = 0; i < curve->count; i++) {
    SporeVec3 away = spore_vec3_sub(spore_vec3_load(curve->points + 4 * i), middle);
    spore_vec3_store(inside->points + 4 * i, spore_vec3_add_scaled(middle, 0.4, away));
    inside->points[4 * i + 3] = curve->points[4 * i + 3];
  }
}

/* The parameter by which the type makes another kind of body of the same geometry, or NULL. */
static const SporeParameter *variants_of(const SporeModelType *type) {
  int index = spore_parameter_find(&type->parameters, "element");
  if (index < 0) index = spore_parameter_find(&type->parameters, "twist_modulus");
  return index < 0 ? NULL : &type->parameters.parameters[index];
}

const char *specimen_variant(const SporeModelType *type, int variant) {
  static const char *const twist[] = {"", "twist", NULL}, *const rooted[] = {"", "rooted", NULL};
  const SporeParameter *parameter = variants_of(type);
  if (type->root) return rooted[variant];
  if (!parameter) return variant == 0 ? "" : NULL;
  return parameter->type == SPORE_CHOICE ? parameter->choices[variant] : twist[variant];
}

/* Of a grid fewer cells than it has by itself. */
static void set_cells(const SporeModelType *type, void *fields) {
  const SporeValue value = {.type = SPORE_INTEGER, .number = {3}};
  int index = spore_parameter_find(&type->parameters, "cells");
  if (index >= 0) spore_parameter_store(&type->parameters.parameters[index], &value, fields);
}

void specimen_set_variant(const SporeModelType *type, int variant, void *fields) {
  const SporeParameter *parameter = variants_of(type);
  if (!parameter) return;
  SporeValue value = {.type = parameter->type, .number = {variant}};
  if (value.type == SPORE_REAL) value.number[0] *= 3e5; /* Pa */
  spore_parameter_store(parameter, &value, fields);
}

static Specimen *specimen_new(const SporeModelType *type, const char *name, int variant) {
  Specimen *specimen = g_new0(Specimen, 1);
  const char *kind = specimen_variant(type, variant);
  specimen->type = type;
  specimen->name = g_strdup_printf("%s/%s%s%s", type->name, name, *kind ? "/" : "", kind);
  specimen->twists = !strcmp(kind, "twist");
  /* A helix: what moves its points farther may straighten its bends, whose stiffness is then clamped. */
  specimen->size = !strcmp(name, "needle") ? 1e-3 : !strcmp(name, "helix") ? 0.01 : 0.02;
  specimen->fields = g_malloc0(type->parameters.size);
  spore_parameters_set_initial(&type->parameters, specimen->fields);
  specimen_set_variant(type, variant, specimen->fields);
  set_cells(type, specimen->fields);
  shape(specimen, name);
  specimen->geometry = (SporeGeometry){&specimen->surface, &specimen->tetrahedra, &specimen->curve};
  if (type->root && variant) {
    shape_inside(&specimen->root, &specimen->curve);
    specimen->geometry.root = &specimen->root;
  }
  return specimen;
}

void specimen_free(Specimen *specimen) {
  spore_triangle_mesh_clear(&specimen->surface);
  spore_tetrahedral_mesh_clear(&specimen->tetrahedra);
  spore_curve_clear(&specimen->curve);
  spore_curve_clear(&specimen->root);
  g_free(specimen->fields);
  g_free(specimen->name);
  g_free(specimen);
}

static const char *const *shapes_for(const SporeModelType *type) {
  static const char *const surfaces[] = {"closed", "flat_sheet", "wavy_sheet", NULL};
  static const char *const solids[] = {"box", "needle", NULL};
  static const char *const blocks[] = {"block", "one_cell", NULL};
  static const char *const lines[] = {"straight", "helix", NULL};
  static const char *const containers[] = {"box", "closed", NULL}; /* particles and grids do not go into a needle */
  static const char *const none[] = {"parameters", NULL};
  if (type == &spore_spline_2d) return surfaces + 1; /* open ones */
  if (type->particles || type == &spore_finite_differences) return containers;
  switch (type->geometry) {
  case SPORE_GEOMETRY_SURFACE:
    return surfaces;
  case SPORE_GEOMETRY_SOLID:
    return solids;
  case SPORE_GEOMETRY_TETRAHEDRA:
    return blocks;
  case SPORE_GEOMETRY_CURVE:
    return lines;
  default:
    return none;
  }
}

static void add_test(const char *prefix, GTestDataFunc check, Specimen *specimen) {
  char *path = g_strdup_printf("%s/%s", prefix, specimen->name);
  g_test_add_data_func_full(path, specimen, check, (GDestroyNotify)(void (*)(void))specimen_free);
  g_free(path);
}

void specimen_add_tests(const char *prefix, GTestDataFunc check, gboolean (*applies)(const SporeModelType *type)) {
  for (SporeModelRegistry type = spore_model_registry; *type; type++)
    for (const char *const *name = shapes_for(*type); *name; name++)
      for (int variant = 0; specimen_variant(*type, variant) && (!applies || applies(*type)); variant++)
        add_test(prefix, check, specimen_new(*type, *name, variant));
}

SporeModel *specimen_model(const Specimen *specimen) {
  SporeError error = SPORE_ERROR_INIT;
  SporeModel *model = specimen->type->create(&specimen->geometry, specimen->fields, &error);
  if (!model) g_error("%s: %s: %s", specimen->name, error.place, error.message);
  return model;
}

Specimen *specimen_relabelled(const Specimen *specimen, const uint32_t *order) {
  Specimen *other = g_new0(Specimen, 1);
  other->type = specimen->type;
  other->name = g_strdup(specimen->name);
  other->size = specimen->size;
  other->fields = g_memdup2(specimen->fields, specimen->type->parameters.size);
  if (specimen->surface.vertex_count) shape_relabel_triangles(&other->surface, &specimen->surface, order);
  if (specimen->tetrahedra.vertex_count) shape_relabel_tetrahedra(&other->tetrahedra, &specimen->tetrahedra, order);
  if (specimen->curve.count) { /* its points are not the model's nodes */
    g_assert_true(spore_curve_allocate(&other->curve, specimen->curve.count, NULL));
    memcpy(other->curve.points, specimen->curve.points, 4 * specimen->curve.count * sizeof(double));
  }
  other->geometry = (SporeGeometry){&other->surface, &other->tetrahedra, &other->curve};
  other->geometry.root = specimen->geometry.root;
  return other;
}

State state_new(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin) {
  State state = {model->q_count, 3 * model->block_count, vector_new(model->q_count),
                 vector_new(3 * model->block_count)};
  model->type->place(model, pose, velocity, spin, state.q, state.v);
  return state;
}

State state_copy(const State *state) {
  return (State){state->q_count, state->v_count, g_memdup2(state->q, state->q_count * sizeof(double)),
                 g_memdup2(state->v, state->v_count * sizeof(double))};
}

void state_clear(State *state) {
  g_free(state->q);
  g_free(state->v);
}

State state_random(const SporeModel *model, GRand *random, double stretch, double noise) {
  SporePose pose = {shape_random_vector(random, 0.5), shape_random_rotation(random)};
  State state = state_new(model, pose, shape_random_vector(random, 0.3), shape_random_vector(random, 2));
  if (spore_model_is_rigid(model)) return state;
  for (size_t i = 0; i < model->node_count; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(state.q + 3 * i), pose.position);
    SporeVec3 moved = spore_vec3_add_scaled(pose.position, stretch, arm);
    spore_vec3_store(state.q + 3 * i, spore_vec3_add(moved, shape_random_vector(random, noise)));
    spore_vec3_accumulate(state.v + 3 * i, shape_random_vector(random, 0.2));
  }
  return state;
}

void state_transform(const SporeModel *model, State *state, SporePose pose) {
  for (size_t i = 0; i < model->node_count; i++)
    spore_vec3_store(state->q + 3 * i, spore_pose_apply(pose, spore_vec3_load(state->q + 3 * i)));
  if (!spore_model_is_nodal(model)) {
    double *orientation = state->q + 3 * model->node_count;
    spore_quat_store(orientation, spore_quat_multiply(pose.orientation, spore_quat_load(orientation)));
  }
  for (size_t i = 0; i < model->block_count; i++)
    spore_vec3_store(state->v + 3 * i, spore_quat_rotate(pose.orientation, spore_vec3_load(state->v + 3 * i)));
}

State state_moved(const SporeModel *model, const State *state, const double *w, double h) {
  State moved = state_copy(state);
  if (model->type->drift) {
    double *after = vector_new(state->v_count);
    model->type->drift(model, state->q, w, h, moved.q, after);
    g_free(after);
  } else
    for (size_t i = 0; i < state->q_count; i++) moved.q[i] += h * w[i];
  return moved;
}

double *vector_new(size_t count) { return g_new0(double, count); }

double *vector_random(GRand *random, size_t count, double amplitude) {
  double *vector = vector_new(count);
  for (size_t i = 0; i < count; i++) vector[i] = g_rand_double_range(random, -amplitude, amplitude);
  return vector;
}

double vector_dot(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += a[i] * b[i];
  return sum;
}

double vector_length(const double *a, size_t count) { return sqrt(vector_dot(a, a, count)); }

double vector_distance(const double *a, const double *b, size_t count) {
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum);
}

double *model_force(const SporeModel *model, const State *state) {
  double *f = vector_new(state->v_count);
  model->type->force(model, state->q, state->q, state->v, f);
  return f;
}
