/* Every registered model: points follow it, and forces on them come back without loss. */
#include "tests/conformance/specimen.h"

#include "core/body/mapping_error.h"

#define POINTS 40

/* The slot that maps: map, of what physics moves, or carry, of what is drawn. */
typedef enum Slot { MAP, CARRY } Slot;

/* A straight line that turns freely about itself: what is off it is refused by map, and rolls with nothing. */
static gboolean is_bare_line(const Specimen *specimen) {
  return strstr(specimen->name, "straight") && !specimen->twists;
}

/* Points in the body's frame. `kind` 0: vertices; 1: between them and (where the body has depth) around them. */
static double *points_of(const Specimen *specimen, Slot slot, GRand *random, int kind, size_t *count) {
  size_t vertices = specimen->surface.vertex_count + specimen->tetrahedra.vertex_count + specimen->curve.count;
  double *x = vector_new(3 * vertices);
  for (size_t i = 0; i < specimen->curve.count; i++) memcpy(x + 3 * i, specimen->curve.points + 4 * i, 3 * sizeof *x);
  if (specimen->surface.vertex_count) memcpy(x, specimen->surface.vertices, 3 * vertices * sizeof *x);
  if (specimen->tetrahedra.vertex_count) memcpy(x, specimen->tetrahedra.vertices, 3 * vertices * sizeof *x);
  if (kind == 0) {
    *count = vertices;
    return x;
  }
  gboolean flat = strstr(specimen->name, "flat_sheet") != NULL;
  double *points = vector_new(3 * POINTS);
  for (size_t i = 0; i < POINTS; i++) {
    SporeVec3 a = spore_vec3_load(x + 3 * (size_t)g_rand_int_range(random, 0, (gint32)vertices));
    SporeVec3 b = spore_vec3_load(x + 3 * (size_t)g_rand_int_range(random, 0, (gint32)vertices));
    SporeVec3 p = spore_vec3_add_scaled(a, g_rand_double(random), spore_vec3_sub(b, a));
    SporeVec3 off = shape_random_vector(random, 0.3 * specimen->size);
    if (flat) off.z = 0;
    if (slot == MAP && is_bare_line(specimen)) off = spore_vec3(0, 0, 0);
    spore_vec3_store(points + 3 * i, spore_vec3_add(p, off));
  }
  g_free(x);
  *count = POINTS;
  return points;
}

static bool try_map(const SporeModel *model, Slot slot, const double *points, size_t count, SporeMapping *mapping,
                    SporeError *error) {
  if (slot == MAP) return model->type->map(model, points, count, NULL, mapping, error);
  const SporeTriangleMesh cloud = {.vertex_count = count, .vertices = (double *)points};
  return model->type->line->map_drawn(model, &cloud, mapping, error);
}

static void map(const SporeModel *model, Slot slot, const double *points, size_t count, SporeMapping *mapping) {
  SporeError error = SPORE_ERROR_INIT;
  if (!try_map(model, slot, points, count, mapping, &error)) g_error("%s: %s", error.place, error.message);
  g_assert_cmpuint(mapping->point_count, ==, count);
}

/* How far `at` lies from the circle about the straight line that p turns in. */
static double off_line(const Specimen *specimen, SporePose pose, SporeVec3 p, SporeVec3 at) {
  const double *from = specimen->curve.points, *to = from + 4 * (specimen->curve.count - 1);
  SporeVec3 a = spore_vec3_load(from);
  SporeVec3 way = spore_vec3_normalise(spore_vec3_sub(spore_vec3_load(to), a), a);
  SporeVec3 arm = spore_vec3_sub(p, a), moved = spore_vec3_sub(spore_pose_apply_inverse(pose, at), a);
  double along = fabs(spore_vec3_dot(way, spore_vec3_sub(arm, moved)));
  return fmax(along, fabs(spore_vec3_length(arm) - spore_vec3_length(moved)));
}

static void check_rest_of(const Specimen *specimen, Slot slot) {
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(1);
  double worst = 0, worst_speed = 0;
  for (int kind = 0; kind < 2; kind++) {
    size_t count;
    double *points = points_of(specimen, slot, random, kind, &count), *at = vector_new(3 * count);
    double *speed = vector_new(3 * count);
    SporeMapping mapping;
    map(model, slot, points, count, &mapping);
    SporePose pose = {shape_random_vector(random, 0.5), shape_random_rotation(random)};
    SporeVec3 velocity = shape_random_vector(random, 1), spin = shape_random_vector(random, 3);
    State state = state_new(model, pose, velocity, spin);
    spore_mapping_positions(&mapping, state.q, at);
    spore_mapping_velocities(&mapping, state.q, state.v, speed);
    for (size_t i = 0; i < count; i++) {
      SporeVec3 expected = spore_pose_apply(pose, spore_vec3_load(points + 3 * i));
      if (slot == CARRY && is_bare_line(specimen)) { /* its roll is not known: as far along and off the line */
        worst = fmax(worst, off_line(specimen, pose, spore_vec3_load(points + 3 * i), spore_vec3_load(at + 3 * i)));
        continue;
      }
      worst = fmax(worst, spore_vec3_distance(expected, spore_vec3_load(at + 3 * i)));
      SporeVec3 arm = spore_vec3_sub(expected, pose.position);
      SporeVec3 moving = spore_vec3_add(velocity, spore_vec3_cross(spin, arm));
      worst_speed = fmax(worst_speed, spore_vec3_distance(moving, spore_vec3_load(speed + 3 * i)));
    }
    state_clear(&state);
    spore_mapping_clear(&mapping);
    g_free(points);
    g_free(at);
    g_free(speed);
  }
  g_test_message("%s: points off by %.2e m and %.2e m/s", specimen->name, worst, worst_speed);
  g_assert_cmpfloat(worst, <, 1e-13);
  g_assert_cmpfloat(worst_speed, <, 1e-12);
  g_rand_free(random);
  model->type->destroy(model);
}

static void check_rest(gconstpointer data) { check_rest_of(data, MAP); }
static void check_rest_drawn(gconstpointer data) { check_rest_of(data, CARRY); }

static void check_virtual_work_of(const Specimen *specimen, Slot slot) {
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(2);
  size_t count;
  double *points = points_of(specimen, slot, random, 1, &count), worst = 0, worst_speed = 0;
  SporeMapping mapping;
  map(model, slot, points, count, &mapping);
  for (int trial = 0; trial < 10; trial++) {
    State state = state_random(model, random, 1.2, 0.3 * specimen->size);
    double *force = vector_random(random, 3 * count, 1), *back = vector_new(state.v_count);
    double *speed = vector_new(3 * count), *ahead = vector_new(3 * count), *behind = vector_new(3 * count);
    spore_mapping_velocities(&mapping, state.q, state.v, speed);
    spore_mapping_add_forces(&mapping, state.q, force, back);
    double work = vector_dot(force, speed, 3 * count);
    double scale = vector_length(force, 3 * count) * vector_length(speed, 3 * count);
    worst = fmax(worst, fabs(work - vector_dot(back, state.v, state.v_count)) / scale);
    /* Velocities are those of the positions. */
    double h = 1e-6;
    State later = state_moved(model, &state, state.v, h), sooner = state_moved(model, &state, state.v, -h);
    spore_mapping_positions(&mapping, later.q, ahead);
    spore_mapping_positions(&mapping, sooner.q, behind);
    for (size_t i = 0; i < 3 * count; i++) ahead[i] = (ahead[i] - behind[i]) / (2 * h);
    worst_speed = fmax(worst_speed, vector_distance(ahead, speed, 3 * count) / vector_length(speed, 3 * count));
    state_clear(&state);
    state_clear(&later);
    state_clear(&sooner);
    g_free(force);
    g_free(back);
    g_free(speed);
    g_free(ahead);
    g_free(behind);
  }
  g_test_message("%s: work lost %.2e, speed off %.2e (relative)", specimen->name, worst, worst_speed);
  g_assert_cmpfloat(worst, <, 1e-13);
  g_assert_cmpfloat(worst_speed, <, 1e-8);
  spore_mapping_clear(&mapping);
  g_free(points);
  g_rand_free(random);
  model->type->destroy(model);
}

static void check_virtual_work(gconstpointer data) { check_virtual_work_of(data, MAP); }
static void check_virtual_work_drawn(gconstpointer data) { check_virtual_work_of(data, CARRY); }

/* A helix has the same curvature all along; a straight line none. */
static void check_crowd(const Specimen *specimen, const SporeMappingError *measured) {
  gboolean straight = strstr(specimen->name, "straight") != NULL;
  g_test_message("%s: crowd %.3g at point %zu, %.3g of the points above 1", specimen->name, measured->crowd,
                 measured->crowd_point, measured->crowd_share);
  g_assert_cmpint(straight, ==, measured->crowd < 1e-10);
  g_assert_cmpint(measured->crowd > 1, ==, measured->crowd_share > 0);
}

/* What is measured of a mapping: nothing at rest, after a rigid motion and, of nodes, an affine one; and a point
 * carried wrongly is seen. */
static void check_measure_of(const Specimen *specimen, Slot slot) {
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(5);
  SporeError error = SPORE_ERROR_INIT;
  SporeMapping mapping;
  SporeMappingError measured;
  size_t count;
  double *points = points_of(specimen, slot, random, 1, &count);
  map(model, slot, points, count, &mapping);
  g_assert_true(spore_mapping_measure(model, &mapping, points, &measured, &error));
  g_test_message("%s: rest %.1e, rigid %.1e, affine %.1e, bend %.1e m, leverage %.3g", specimen->name, measured.rest,
                 measured.rigid, measured.affine, measured.bend, measured.leverage);
  double rounding = 1e-15 * measured.leverage; /* places of about 1 m, up to 64 weights */
  g_assert_cmpfloat(measured.rest, <=, rounding);
  double unknown = slot == CARRY && is_bare_line(specimen) ? specimen->size : 0; /* its roll */
  g_assert_cmpfloat(measured.rigid, <=, 4 * rounding + unknown);
  bool deforms = mapping.kind != SPORE_MAPPING_RIGID && slot == MAP;
  g_assert_cmpint(deforms, ==, isfinite(measured.affine));
  g_assert_cmpint(deforms || slot == CARRY, ==, isfinite(measured.bend));
  if (deforms) g_assert_cmpfloat(measured.affine, <=, 4 * rounding);
  if (slot == CARRY) check_crowd(specimen, &measured);
  points[3] += 1e-3;
  g_assert_true(spore_mapping_measure(model, &mapping, points, &measured, &error));
  g_assert_cmpfloat(fabs(measured.rest - 1e-3), <=, rounding);
  g_assert_cmpfloat(fabs(measured.rigid - 1e-3), <=, 4 * rounding + unknown);
  spore_mapping_clear(&mapping);
  g_free(points);
  g_rand_free(random);
  model->type->destroy(model);
}

static void check_measure(gconstpointer data) { check_measure_of(data, MAP); }
static void check_measure_drawn(gconstpointer data) { check_measure_of(data, CARRY); }

static void check_without_memory_of(const Specimen *specimen, Slot slot) {
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(3);
  size_t count;
  double *points = points_of(specimen, slot, random, 1, &count);
  for (uint64_t n = 1;; n++) {
    SporeError error = SPORE_ERROR_INIT;
    SporeMapping mapping;
    spore_allocation_fail_at(n);
    SporeMappingError measured;
    bool mapped = try_map(model, slot, points, count, &mapping, &error);
    bool done = mapped && spore_mapping_measure(model, &mapping, points, &measured, &error);
    spore_allocation_fail_at(0);
    if (mapped) spore_mapping_clear(&mapping);
    if (done) break;
    g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  }
  g_free(points);
  g_rand_free(random);
  model->type->destroy(model);
}

static void check_without_memory(gconstpointer data) { check_without_memory_of(data, MAP); }
static void check_without_memory_drawn(gconstpointer data) { check_without_memory_of(data, CARRY); }

/* Counts how often it is asked, and says yes from the `at`-th time on. */
typedef struct {
  unsigned asked, at;
} Asker;

static bool answer(void *data) {
  Asker *asker = data;
  return ++asker->asked >= asker->at;
}

static gboolean has_nodes(const SporeModelType *type) { return strcmp(type->name, "rigid_body") != 0; }

/* Mapping asks for each point, and ends where it is told to. */
static void check_cancelled(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(5);
  size_t count;
  SporeMapping mapping;
  double *points = points_of(specimen, MAP, random, 1, &count);
  Asker asker = {0, UINT_MAX};
  const SporeCancel cancel = {answer, &asker};
  g_assert_true(model->type->map(model, points, count, &cancel, &mapping, NULL));
  spore_mapping_clear(&mapping);
  g_assert_cmpuint(asker.asked, ==, count);
  for (unsigned at = 1; at <= count; at += (unsigned)count / 4) {
    SporeError error = SPORE_ERROR_INIT;
    asker = (Asker){0, at};
    g_assert_false(model->type->map(model, points, count, &cancel, &mapping, &error));
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_cmpuint(asker.asked, ==, at);
  }
  g_free(points);
  g_rand_free(random);
  model->type->destroy(model);
}

static gboolean carries(const SporeModelType *type) { return type->line && type->line->map_drawn; }
static gboolean has_spheres(const SporeModelType *type) { return type->spheres != NULL; }

/* Of particles: one at each material point, which it follows exactly, apart at rest; and nothing passes between them.
 */
static void check_particle_spheres(const SporeModel *model, const SporeMapping *mapping, const SporeSphereSet *set,
                                   const double *points) {
  g_assert_cmpuint(set->count, ==, model->node_count);
  g_assert_cmpint(mapping->kind, ==, SPORE_MAPPING_IDENTITY);
  double nearest = HUGE_VAL, widest = 0;
  for (size_t i = 0; i < set->count; i++) {
    widest = fmax(widest, set->spheres[4 * i + 3]);
    for (size_t k = 0; k < i; k++)
      nearest = fmin(nearest, spore_vec3_distance(spore_vec3_load(points + 3 * i), spore_vec3_load(points + 3 * k)));
  }
  g_test_message("%zu spheres of up to %.3g m, %.3g m apart at least", set->count, widest, nearest);
  g_assert_cmpfloat(2 * widest, <, nearest);
  g_assert_cmpfloat(2 * widest, >, 0.7 * nearest);
}

/* Of a line: from end to end, each a radius from the next. */
static void check_line_spheres(const Specimen *specimen, const SporeSphereSet *set) {
  const SporeCurve *curve = &specimen->curve;
  double ends[2] = {spore_vec3_distance(spore_vec3_load(set->spheres), spore_vec3_load(curve->points)),
                    spore_vec3_distance(spore_vec3_load(set->spheres + 4 * (set->count - 1)),
                                        spore_vec3_load(curve->points + 4 * (curve->count - 1)))};
  g_assert_cmpfloat(fmax(ends[0], ends[1]), <, 1e-15);
  double apart = 0;
  for (size_t i = 1; i < set->count; i++) {
    const double *one = set->spheres + 4 * i, *before = one - 4;
    apart = fmax(apart, spore_vec3_distance(spore_vec3_load(one), spore_vec3_load(before)) / fmin(one[3], before[3]));
  }
  g_test_message("%zu spheres, at most %.6f radii from one to the next", set->count, apart);
  g_assert_cmpfloat(apart, <, 1.001);
  g_assert_cmpfloat(apart, >, 0.9);
}

/* The model's own spheres: its mapping takes them and leaves them where they are at rest. */
static void check_spheres(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  SporeError error = SPORE_ERROR_INIT;
  SporeSphereSet set = {0};
  for (uint64_t n = 1; set.count == 0; n++) {
    spore_allocation_fail_at(n);
    bool made = model->type->spheres(model, &set, &error);
    spore_allocation_fail_at(0);
    g_assert_cmpint(made, ==, set.count > 0);
    if (!made) g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
    g_assert_cmpuint(n, <, 10);
  }
  g_assert_true(spore_sphere_set_validate(&set, &error));
  double *points = vector_new(3 * set.count), *at_rest = vector_new(3 * set.count);
  for (size_t i = 0; i < set.count; i++) memcpy(points + 3 * i, set.spheres + 4 * i, 3 * sizeof *points);
  SporeMapping mapping;
  map(model, MAP, points, set.count, &mapping);
  const SporeVec3 still = {0, 0, 0};
  State state = state_new(model, spore_pose_identity(), still, still);
  spore_mapping_positions(&mapping, state.q, at_rest);
  g_assert_cmpfloat(vector_distance(points, at_rest, 3 * set.count), <, 1e-14);
  if (model->type->particles) check_particle_spheres(model, &mapping, &set, points);
  else check_line_spheres(specimen, &set);
  spore_mapping_clear(&mapping);
  spore_sphere_set_clear(&set);
  state_clear(&state);
  g_free(points);
  g_free(at_rest);
  model->type->destroy(model);
}

static gboolean turns(const SporeModelType *type) { return type->inertia != NULL; }

static SporeMat3 turning_inertia(const SporeModel *model, const State *state) {
  SporeMat3 inertia;
  double *mass = vector_new(9 * model->block_count);
  spore_model_mass(model, state->q, mass);
  memcpy(inertia.m, mass + 9 * model->node_count, sizeof inertia.m);
  g_free(mass);
  return inertia;
}

/* Free motion of a frame keeps momentum and energy. */
static void check_drift(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(4);
  State state = state_random(model, random, 1, 0);
  double energy[2];
  SporeVec3 momentum[2];
  for (int end = 0; end < 2; end++) {
    SporeVec3 spin = spore_vec3_load(state.v + 3 * model->node_count);
    momentum[end] = spore_mat3_apply(turning_inertia(model, &state), spin);
    energy[end] = 0.5 * spore_vec3_dot(spin, momentum[end]);
    /* In place: q and v may be the same arrays before and after. */
    for (int i = 0; end == 0 && i < 1000; i++) model->type->drift(model, state.q, state.v, 1e-2, state.q, state.v);
  }
  double lost = spore_vec3_distance(momentum[0], momentum[1]) / spore_vec3_length(momentum[0]);
  double gained = fabs(energy[1] / energy[0] - 1);
  g_test_message("%s: after 1000 steps angular momentum off by %.2e, energy by %.2e", specimen->name, lost, gained);
  g_assert_cmpfloat(lost, <, 1e-12);
  g_assert_cmpfloat(gained, <, 1e-6);
  state_clear(&state);
  g_rand_free(random);
  model->type->destroy(model);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  specimen_add_tests("/conformance/rest", check_rest, NULL);
  specimen_add_tests("/conformance/virtual_work", check_virtual_work, NULL);
  specimen_add_tests("/conformance/measure", check_measure, NULL);
  specimen_add_tests("/conformance/map_without_memory", check_without_memory, NULL);
  specimen_add_tests("/conformance/map_cancelled", check_cancelled, has_nodes);
  specimen_add_tests("/conformance/drawn/rest", check_rest_drawn, carries);
  specimen_add_tests("/conformance/drawn/virtual_work", check_virtual_work_drawn, carries);
  specimen_add_tests("/conformance/drawn/measure", check_measure_drawn, carries);
  specimen_add_tests("/conformance/drawn/without_memory", check_without_memory_drawn, carries);
  specimen_add_tests("/conformance/drift", check_drift, turns);
  specimen_add_tests("/conformance/spheres", check_spheres, has_spheres);
  return g_test_run();
}
