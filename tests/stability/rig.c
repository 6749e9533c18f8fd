/* Builds worlds for the tests of stability: models, bodies, spheres, pins and links. */
#include "tests/stability/rig.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "core/base/memory.h"

static void free_set(gpointer set) {
  spore_sphere_set_clear(set);
  g_free(set);
}

unsigned rig_steps(unsigned whole, unsigned part) {
  if (tests_sanitized) g_test_message("under sanitizers: %u steps of %u", part, whole);
  return tests_sanitized ? part : whole;
}

Rig *rig_new(void) {
  Rig *rig = g_new0(Rig, 1);
  rig->bodies = g_array_new(FALSE, TRUE, sizeof(SporeBodyDescription));
  rig->links = g_array_new(FALSE, TRUE, sizeof(SporeLinkDescription));
  rig->tools = g_array_new(FALSE, TRUE, sizeof(SporeToolDescription));
  rig->fields = g_ptr_array_new_with_free_func(g_free);
  rig->sets = g_ptr_array_new_with_free_func(free_set);
  spore_parameters_set_initial(&spore_solver_parameters, &rig->description.solver);
  return rig;
}

void rig_free(Rig *rig) {
  spore_world_free(rig->world);
  for (guint i = 0; !rig->world && i < rig->bodies->len; i++) {
    const SporeBodyDescription *body = &g_array_index(rig->bodies, SporeBodyDescription, i);
    SporeModel *const models[] = {body->model, body->lod.model[0], body->lod.model[1]};
    for (size_t k = 0; k < G_N_ELEMENTS(models); k++)
      if (models[k]) models[k]->type->destroy(models[k]);
  }
  g_array_unref(rig->bodies);
  g_array_unref(rig->links);
  g_array_unref(rig->tools);
  g_ptr_array_unref(rig->fields);
  g_ptr_array_unref(rig->sets);
  g_free(rig);
}

static void *fields_from(const SporeParameterTable *table, va_list arguments) {
  char *fields = spore_allocate(1, table->size);
  spore_parameters_set_initial(table, fields);
  for (const char *name; (name = va_arg(arguments, const char *));) {
    int index = spore_parameter_find(table, name);
    g_assert_cmpint(index, >=, 0);
    double value = va_arg(arguments, double);
    const SporeParameter *parameter = &table->parameters[index];
    spore_parameter_store(parameter, &(SporeValue){.type = parameter->type, .number = {value}}, fields);
  }
  SporeError error = SPORE_ERROR_INIT;
  if (!spore_parameters_check(table, fields, &error)) g_error("%s", error.message);
  return fields;
}

void *rig_fields(const SporeModelType *type, ...) {
  va_list arguments;
  va_start(arguments, type);
  void *fields = fields_from(&type->parameters, arguments);
  va_end(arguments);
  return fields;
}

static SporeModel *create(const SporeModelType *type, SporeTriangleMesh *surface, SporeTetrahedralMesh *tetrahedra,
                          SporeError *error, va_list arguments) {
  void *fields = fields_from(&type->parameters, arguments);
  SporeGeometry geometry = {.surface = surface, .tetrahedra = tetrahedra};
  SporeModel *model = type->create(&geometry, fields, error);
  spore_free(fields);
  if (surface) spore_triangle_mesh_clear(surface);
  if (tetrahedra) spore_tetrahedral_mesh_clear(tetrahedra);
  return model;
}

static SporeModel *must(SporeModel *model, const SporeError *error) {
  if (!model) g_error("%s: %s", error->place, error->message);
  return model;
}

SporeModel *rig_surface_model(const SporeModelType *type, SporeTriangleMesh *mesh, ...) {
  SporeError error = SPORE_ERROR_INIT;
  va_list arguments;
  va_start(arguments, mesh);
  SporeModel *model = create(type, mesh, NULL, &error, arguments);
  va_end(arguments);
  return must(model, &error);
}

SporeModel *rig_curve_model(const SporeModelType *type, SporeCurve *curve, ...) {
  SporeError error = SPORE_ERROR_INIT;
  va_list arguments;
  va_start(arguments, curve);
  void *fields = fields_from(&type->parameters, arguments);
  va_end(arguments);
  SporeModel *model = type->create(&(SporeGeometry){.curve = curve}, fields, &error);
  spore_free(fields);
  spore_curve_clear(curve);
  return must(model, &error);
}

SporeModel *rig_solid_model(const SporeModelType *type, SporeTetrahedralMesh *mesh, ...) {
  SporeError error = SPORE_ERROR_INIT;
  va_list arguments;
  va_start(arguments, mesh);
  SporeModel *model = create(type, NULL, mesh, &error, arguments);
  va_end(arguments);
  return must(model, &error);
}

SporeModel *rig_tetrahedra_model(SporeTetrahedralMesh *mesh, ...) {
  SporeError error = SPORE_ERROR_INIT;
  va_list arguments;
  va_start(arguments, mesh);
  SporeModel *model = create(&spore_corotational_tetrahedra, NULL, mesh, &error, arguments);
  va_end(arguments);
  return must(model, &error);
}

SporeModel *rig_fluid_model(SporeTriangleMesh *mesh, int particles, ...) {
  SporeError error = SPORE_ERROR_INIT;
  const SporeParameterTable *table = &spore_lennard_jones.parameters;
  va_list arguments;
  va_start(arguments, particles);
  char *fields = fields_from(table, arguments);
  va_end(arguments);
  int64_t count = particles;
  memcpy(fields + table->parameters[spore_parameter_find(table, "particles")].offset, &count, sizeof count);
  SporeModel *model = spore_lennard_jones.create(&(SporeGeometry){.surface = mesh}, fields, &error);
  spore_free(fields);
  spore_triangle_mesh_clear(mesh);
  return must(model, &error);
}

SporeModel *rig_try_tetrahedra(SporeTetrahedralMesh *mesh, SporeError *error, ...) {
  va_list arguments;
  va_start(arguments, error);
  SporeModel *model = create(&spore_corotational_tetrahedra, NULL, mesh, error, arguments);
  va_end(arguments);
  return model;
}

static SporeBodyDescription *add(Rig *rig, const char *name, SporeRole role, SporeModel *model,
                                 const SporeSphereSet *spheres) {
  SporeBodyDescription body = {.name = name,
                               .role = role,
                               .model = model,
                               .integrator = SPORE_INTEGRATOR_DEFAULT,
                               .pose = spore_pose_identity(),
                               .spheres = spheres};
  spore_parameters_set_initial(&spore_contact_parameters, &body.contact);
  g_array_append_val(rig->bodies, body);
  return &g_array_index(rig->bodies, SporeBodyDescription, rig->bodies->len - 1);
}

SporeBodyDescription *rig_passive(Rig *rig, const char *name, SporeModel *model, const SporeSphereSet *spheres) {
  return add(rig, name, SPORE_PASSIVE, model, spheres);
}

SporeBodyDescription *rig_unmovable(Rig *rig, const char *name, const SporeSphereSet *spheres) {
  return add(rig, name, SPORE_UNMOVABLE, NULL, spheres);
}

SporeBodyDescription *rig_active(Rig *rig, const char *name, const SporeSphereSet *spheres) {
  return add(rig, name, SPORE_ACTIVE, NULL, spheres);
}

void rig_pin(Rig *rig, guint body, SporeVec3 point, double radius) {
  SporeLinkDescription pin = {.name = "pin",
                              .type = &spore_link_pin,
                              .body_a = body,
                              .body_b = SPORE_NO_BODY,
                              .point_a = point,
                              .radius = radius};
  g_array_append_val(rig->links, pin);
}

const SporeSphereSet *rig_spheres(Rig *rig, const double *points, size_t count, double radius) {
  SporeSphereSet *set = g_new0(SporeSphereSet, 1);
  g_assert_true(spore_sphere_set_allocate(set, count, NULL));
  for (size_t i = 0; i < count; i++) {
    memcpy(set->spheres + 4 * i, points + 3 * i, 3 * sizeof(double));
    set->spheres[4 * i + 3] = radius;
  }
  g_ptr_array_add(rig->sets, set);
  return set;
}

const SporeSphereSet *rig_sphere(Rig *rig, double radius) {
  const double origin[3] = {0, 0, 0};
  return rig_spheres(rig, origin, 1, radius);
}

const SporeSphereSet *rig_floor(Rig *rig, unsigned columns, unsigned rows, double spacing, double radius) {
  double *points = g_new(double, 3 * (size_t)columns * rows), *p = points;
  for (unsigned c = 0; c < columns; c++)
    for (unsigned r = 0; r < rows; r++, p += 3)
      spore_vec3_store(p, spore_vec3((c - 0.5 * (columns - 1)) * spacing, -radius, (r - 0.5 * (rows - 1)) * spacing));
  const SporeSphereSet *set = rig_spheres(rig, points, (size_t)columns * rows, radius);
  g_free(points);
  return set;
}

static SporeWorld *build(Rig *rig, SporePool *pool, SporeError *error) {
  rig->description.bodies = (const SporeBodyDescription *)(const void *)rig->bodies->data;
  rig->description.body_count = rig->bodies->len;
  rig->description.links = (const SporeLinkDescription *)(const void *)rig->links->data;
  rig->description.link_count = rig->links->len;
  rig->description.tools = (const SporeToolDescription *)(const void *)rig->tools->data;
  rig->description.tool_count = rig->tools->len;
  return rig->world = spore_world_create(&rig->description, pool, error);
}

SporeWorld *rig_try_build(Rig *rig, SporeError *error) { return build(rig, NULL, error); }

SporeWorld *rig_build_on(Rig *rig, SporePool *pool) {
  SporeError error = SPORE_ERROR_INIT;
  if (!build(rig, pool, &error)) g_error("%s: %s", error.place, error.message);
  return rig->world;
}

SporeWorld *rig_build(Rig *rig) { return rig_build_on(rig, NULL); }

SporeLinkDescription *rig_link(Rig *rig, const char *name, const SporeLinkType *kind, uint32_t a, uint32_t b,
                               SporeVec3 at) {
  SporeLinkDescription link = {.name = name,
                               .type = kind,
                               .body_a = a,
                               .body_b = b,
                               .point_a = at,
                               .point_b = at,
                               .direction = {0, 1, 0},
                               .stiffness = 1e5,
                               .damping = -1};
  g_array_append_val(rig->links, link);
  return &g_array_index(rig->links, SporeLinkDescription, rig->links->len - 1);
}

gboolean rig_finite(const SporeWorld *world) {
  for (uint32_t b = 0; b < spore_world_body_count(world); b++) {
    const SporeModel *model = spore_world_body_model(world, b);
    const double *q = spore_world_q(world, b), *v = spore_world_v(world, b);
    for (size_t i = 0; i < (model ? model->q_count : 7); i++)
      if (!isfinite(q[i])) return FALSE;
    for (size_t i = 0; i < (model ? 3 * model->block_count : 6); i++)
      if (!isfinite(v[i])) return FALSE;
  }
  return TRUE;
}

double rig_energy(const SporeWorld *world) {
  if (!rig_finite(world)) return NAN;
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal + energy.gravity + energy.contact;
}

gboolean rig_any_frozen(const SporeWorld *world) {
  for (uint32_t b = 0; b < spore_world_body_count(world); b++)
    if (spore_world_body_frozen(world, b)) return TRUE;
  return FALSE;
}

void rig_run(SporeWorld *world, unsigned steps) {
  for (unsigned i = 0; i < steps; i++) spore_world_step(world);
}

const char *rig_last_message(const SporeWorld *world) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  if (!monitor->message_count) return "";
  return monitor->messages[(monitor->message_count - 1) % SPORE_MONITOR_MESSAGES].text;
}

gboolean rig_said(const SporeWorld *world, const char *start) {
  const SporeMonitor *monitor = spore_world_monitor(world);
  for (uint64_t i = 0; i < MIN(monitor->message_count, SPORE_MONITOR_MESSAGES); i++)
    if (g_str_has_prefix(monitor->messages[i].text, start)) return TRUE;
  return FALSE;
}

SporeToolDescription *rig_tool(Rig *rig, const SporeToolType *type, const char *name, uint32_t body) {
  SporeToolFields *fields = g_malloc0(type->parameters.size);
  spore_parameters_set_initial(&type->parameters, fields);
  fields->name = name;
  g_ptr_array_add(rig->fields, fields);
  SporeToolDescription tool = {type, {body, SPORE_NO_BODY, SPORE_NO_BODY}, fields};
  g_array_append_val(rig->tools, tool);
  return &g_array_index(rig->tools, SporeToolDescription, rig->tools->len - 1);
}

void *rig_tool_fields(const SporeToolDescription *tool) { return (void *)(uintptr_t)tool->fields; }

static bool mover_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                           SporeDeviceState *state) {
  const RigMover *mover = (const RigMover *)device;
  *state = (SporeDeviceState){.t_ns = (uint64_t)(time_s * 1e9), .orientation = {1, 0, 0, 0}};
  spore_vec3_store(state->position, spore_vec3_add_scaled(mover->from, time_s, mover->velocity));
  spore_vec3_store(state->velocity, mover->velocity);
  return true;
}

static void mover_close(SporeDevice *device) {}

const SporeDeviceType rig_mover_type = {.name = "mover", .doc = "", .exchange = mover_exchange, .close = mover_close};
