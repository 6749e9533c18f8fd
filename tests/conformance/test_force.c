/* Every registered model: forces are the gradient of the energy, Jacobians those of the forces, and both know neither
 * where the scene's axes point nor how its nodes are numbered. */
#include "tests/conformance/specimen.h"

/* U along w by central differences is -f.w, for a random state at rest speed. */
static void check_gradient(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(1);
  double worst = 0, step = 1e-6 * specimen->size;
  for (int trial = 0; trial < 20; trial++) {
    State state = state_random(model, random, 1, 0.4 * specimen->size);
    memset(state.v, 0, state.v_count * sizeof(double));
    double *w = vector_random(random, state.v_count, 1), *f = model_force(model, &state);
    State ahead = state_moved(model, &state, w, step), behind = state_moved(model, &state, w, -step);
    double difference = (model->type->potential(model, ahead.q) - model->type->potential(model, behind.q)) / (2 * step);
    double scale = vector_length(f, state.v_count) * vector_length(w, state.v_count);
    double error = fabs(difference + vector_dot(f, w, state.v_count));
    worst = fmax(worst, scale > 0 ? error / scale : error);
    state_clear(&state);
    state_clear(&ahead);
    state_clear(&behind);
    g_free(w);
    g_free(f);
  }
  g_test_message("%s: worst relative error %.2e", specimen->name, worst);
  g_assert_cmpfloat(worst, <, 1e-7);
  g_rand_free(random);
  model->type->destroy(model);
}

static gboolean has_jacobian(const SporeModelType *type) { return type->jacobian != NULL; }
static gboolean has_force_along(const SporeModelType *type) { return type->force_along != NULL; }
static gboolean has_tangent(const SporeModelType *type) { return type->tangent != NULL; }

static gboolean has_stiffness(const SporeModelType *type) { return type->stiffness != NULL; }
/* Of nodes alone, and nothing around them: what smoke loses goes to the air (tests/stability/test_smoke.c). */
static gboolean is_alone(const SporeModelType *type) {
  return !type->inertia && !(type->particles && type->particles->puff);
}

static void make_matrix(const SporeModel *model, SporeBlockMatrix *matrix) {
  g_assert_nonnull(model->type->pattern);
  g_assert_true(spore_model_matrix_create(model, matrix));
}

/* A frame turns the axes that its torque is measured along: its own derivative has half of w x torque more than the
 * symmetric matrix. */
static void add_turning(const SporeModel *model, const State *state, const double *w, double *change) {
  size_t turning = 3 * model->node_count;
  if (spore_model_is_nodal(model)) return;
  double *f = model_force(model, state);
  SporeVec3 lost = spore_vec3_cross(spore_vec3_load(w + turning), spore_vec3_load(f + turning));
  spore_vec3_accumulate(change + turning, spore_vec3_scale(0.5, lost));
  g_free(f);
}

static State displaced(const SporeModel *model, const State *state, const double *w, double step, gboolean damping) {
  if (!damping) return state_moved(model, state, w, step);
  State moved = state_copy(state);
  for (size_t i = 0; i < state->v_count; i++) moved.v[i] += step * w[i];
  return moved;
}

/* Relative distance of A w from -(f(ahead) - f(behind)) / 2 step, with positions (or speeds) moved along w. */
static double matrix_error(const SporeModel *model, const State *state, const SporeBlockMatrix *matrix, const double *w,
                           double step, gboolean damping) {
  double *product = vector_new(state->v_count);
  spore_block_matrix_multiply_add(matrix, w, product);
  State ahead = displaced(model, state, w, step, damping), behind = displaced(model, state, w, -step, damping);
  double *fa = model_force(model, &ahead), *fb = model_force(model, &behind);
  for (size_t i = 0; i < state->v_count; i++) fa[i] = -(fa[i] - fb[i]) / (2 * step);
  if (!damping) add_turning(model, state, w, fa);
  double error = vector_distance(fa, product, state->v_count) / vector_length(product, state->v_count);
  state_clear(&ahead);
  state_clear(&behind);
  g_free(fa);
  g_free(fb);
  g_free(product);
  return error;
}

static double jacobian_error(const SporeModel *model, const State *state, const double *w, double step,
                             gboolean damping) {
  SporeBlockMatrix matrix;
  make_matrix(model, &matrix);
  model->type->jacobian(model, state->q, state->q, state->v, damping ? 0 : 1, damping ? 1 : 0, &matrix);
  double error = matrix_error(model, state, &matrix, w, step, damping);
  spore_block_matrix_clear(&matrix);
  return error;
}

/* Whether the matrix is that of small strains. */
static gboolean is_linear(const SporeModelType *type) {
  return type == &spore_linear_tetrahedra || type == &spore_condensed_tetrahedra;
}

/* How far to stretch a model so that nothing is clamped: a neo-Hookean one to where its volume pushes neither way. */
static double unclamped_stretch(const SporeModelType *type) {
  if (is_linear(type)) return 1 + 1e-12;
  return type == &spore_neo_hookean_tetrahedra || type == &spore_finite_differences ? 1.065 : 1.5;
}

/* Where nothing is clamped the Jacobian is exact. */
static void check_jacobian(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(2);
  double worst[2] = {0, 0};
  for (int trial = 0; trial < 20; trial++) {
    double stretch = unclamped_stretch(model->type);
    double noise = specimen->twists ? 0 : 0.1 * (stretch - 1) * specimen->size; /* exact where there is no twist */
    State state = state_random(model, random, stretch, noise);
    double *w = vector_random(random, state.v_count, 1);
    worst[1] = fmax(worst[1], jacobian_error(model, &state, w, 1, TRUE)); /* linear in v: any step does */
    memset(state.v, 0, state.v_count * sizeof(double));
    worst[0] = fmax(worst[0], jacobian_error(model, &state, w, 1e-5 * specimen->size, FALSE));
    state_clear(&state);
    g_free(w);
  }
  g_test_message("%s: worst relative error, stiffness %.2e, damping %.2e", specimen->name, worst[0], worst[1]);
  g_assert_cmpfloat(worst[0], <, 1e-7);
  g_assert_cmpfloat(worst[1], <, 1e-10);
  g_rand_free(random);
  model->type->destroy(model);
}

/* The whole stiffness for balance is exact where what is compressed buckles, too, and has negative directions there:
 * what the Jacobian leaves out. Nothing says so of twist. */
static void check_stiffness(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(11);
  double worst = 0, of_jacobian = 0;
  for (int trial = 0; trial < 20; trial++) {
    State state = state_random(model, random, 0.8, specimen->twists ? 0 : 0.05 * specimen->size);
    memset(state.v, 0, state.v_count * sizeof(double));
    double *w = vector_random(random, state.v_count, 1), step = 1e-5 * specimen->size;
    SporeBlockMatrix matrix;
    make_matrix(model, &matrix);
    SporeTangent at = {.q = state.q, .shape = state.q, .v = state.v, .stiffness_scale = 1, .whole = true};
    model->type->stiffness(model, &at, &matrix);
    worst = fmax(worst, matrix_error(model, &state, &matrix, w, step, FALSE));
    of_jacobian = fmax(of_jacobian, jacobian_error(model, &state, w, step, FALSE));
    spore_block_matrix_clear(&matrix);
    state_clear(&state);
    g_free(w);
  }
  g_test_message("%s: worst relative error %.2e, of the Jacobian %.2e", specimen->name, worst, of_jacobian);
  g_assert_cmpfloat(worst, <, 1e-7);
  g_assert_cmpfloat(of_jacobian, >, 1e-4);
  g_rand_free(random);
  model->type->destroy(model);
}

/* How far the tangent at q after a step from `from` is from that at q, relative to the latter. */
static double promise_error(const SporeModel *model, const State *state, const double *from) {
  SporeBlockMatrix shown, promised;
  make_matrix(model, &shown);
  make_matrix(model, &promised);
  SporeTangent at = {.q = state->q, .shape = state->q, .v = state->v, .stiffness_scale = 1, .whole = true};
  model->type->tangent(model, &at, &shown);
  at.from = from;
  model->type->tangent(model, &at, &promised);
  size_t count = 9 * (size_t)shown.row_start[shown.block_count];
  double error = vector_distance(shown.values, promised.values, count) / vector_length(shown.values, count);
  spore_block_matrix_clear(&shown);
  spore_block_matrix_clear(&promised);
  return error;
}

/* The whole tangent is exact where what is compressed buckles, too, and what a step promised is wrong by its square. */
static void check_tangent(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(7);
  double worst = 0, of_step = 0, of_half = 0, none = 0;
  for (int trial = 0; trial < 20; trial++) {
    State state = state_random(model, random, 0.8, 0.05 * specimen->size);
    memset(state.v, 0, state.v_count * sizeof(double));
    double *w = vector_random(random, state.v_count, 1);
    SporeBlockMatrix matrix;
    make_matrix(model, &matrix);
    SporeTangent at = {.q = state.q, .shape = state.q, .v = state.v, .stiffness_scale = 1, .whole = true};
    model->type->tangent(model, &at, &matrix);
    worst = fmax(worst, matrix_error(model, &state, &matrix, w, 1e-5 * specimen->size, FALSE));
    State near = state_moved(model, &state, w, 1e-3 * specimen->size);
    State nearer = state_moved(model, &state, w, 5e-4 * specimen->size);
    none = fmax(none, promise_error(model, &state, state.q));
    of_step += promise_error(model, &state, near.q);
    of_half += promise_error(model, &state, nearer.q);
    state_clear(&nearer);
    state_clear(&near);
    spore_block_matrix_clear(&matrix);
    state_clear(&state);
    g_free(w);
  }
  g_test_message("%s: worst relative error %.2e, promise of a step off by %.2e, of half of it by %.2e", specimen->name,
                 worst, of_step / 20, of_half / 20);
  g_assert_cmpfloat(worst, <, 1e-7);
  g_assert_cmpfloat(none, <, 1e-14);
  g_assert_cmpfloat(of_step / of_half, >, 3.5);
  g_assert_cmpfloat(of_step / of_half, <, 4.5);
  g_rand_free(random);
  model->type->destroy(model);
}

static double *dense(const SporeBlockMatrix *matrix) {
  size_t n = 3 * matrix->block_count;
  double *a = vector_new(n * n);
  for (size_t i = 0; i < matrix->block_count; i++)
    for (uint32_t k = matrix->row_start[i]; k < matrix->row_start[i + 1]; k++)
      for (size_t e = 0; e < 9; e++)
        a[(3 * i + e / 3) * n + 3 * matrix->column[k] + e % 3] = matrix->values[9 * (size_t)k + e];
  return a;
}

/* Cholesky in place; false at the first pivot that is not positive. */
static gboolean is_positive_definite(double *a, size_t n) {
  for (size_t j = 0; j < n; j++) {
    for (size_t k = 0; k < j; k++) a[j * n + j] -= a[j * n + k] * a[j * n + k];
    if (!(a[j * n + j] > 0)) return FALSE;
    a[j * n + j] = sqrt(a[j * n + j]);
    for (size_t i = j + 1; i < n; i++) {
      for (size_t k = 0; k < j; k++) a[i * n + j] -= a[i * n + k] * a[j * n + k];
      a[i * n + j] /= a[j * n + j];
    }
  }
  return TRUE;
}

static double asymmetry(const double *a, size_t n, double *greatest) {
  double difference = 0;
  *greatest = 0;
  for (size_t i = 0; i < n; i++)
    for (size_t j = 0; j < n; j++) {
      difference = fmax(difference, fabs(a[i * n + j] - a[j * n + i]));
      *greatest = fmax(*greatest, fabs(a[i * n + j]));
    }
  return difference;
}

/* Viscosity taken at another shape is linear in v there, and the Jacobian is exactly that, in any state that the model
 * is meant for. */
static void check_viscosity(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(11);
  gboolean small = is_linear(model->type);
  State state = state_random(model, random, small ? 1 : 0.8, small ? 0 : 0.5 * specimen->size);
  State shape = state_random(model, random, 1, small ? 0 : 0.5 * specimen->size);
  SporeBlockMatrix matrix;
  make_matrix(model, &matrix);
  model->type->jacobian(model, state.q, shape.q, state.v, 0, 1, &matrix);
  double *product = vector_new(state.v_count), *at_rest = vector_new(state.v_count), *still = vector_new(state.v_count);
  double *moving = vector_new(state.v_count);
  spore_block_matrix_multiply_add(&matrix, state.v, product);
  model->type->force(model, state.q, shape.q, still, at_rest);
  model->type->force(model, state.q, shape.q, state.v, moving);
  for (size_t i = 0; i < state.v_count; i++) moving[i] = at_rest[i] - moving[i];
  g_assert_cmpfloat(vector_distance(moving, product, state.v_count), <=,
                    1e-10 * (vector_length(product, state.v_count) + vector_length(at_rest, state.v_count)));
  g_assert_cmpfloat(vector_dot(product, state.v, state.v_count), >, 0); /* it takes energy */
  g_free(product);
  g_free(at_rest);
  g_free(still);
  g_free(moving);
  spore_block_matrix_clear(&matrix);
  state_clear(&state);
  state_clear(&shape);
  g_rand_free(random);
  model->type->destroy(model);
}

/* Where nodes moved from the shape along v, force_along is force. */
static void check_force_along(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  if (model->type->force_along) {
    const double h = 0.004;
    GRand *random = g_rand_new_with_seed(12);
    State shape = state_random(model, random, 1, 0.1 * specimen->size), state = state_random(model, random, 1, 0);
    double *along = vector_new(state.v_count), *force = vector_new(state.v_count);
    for (int round = 0; round < 2; round++) { /* the second time at another shape: nothing is left of the first */
      for (size_t i = 0; i < 3 * model->node_count; i++) {
        shape.q[i] += 1e-3 * round;
        if (i % 7 == 0) shape.q[i] += 1e-3 * specimen->size * round;
        state.q[i] = shape.q[i] + h * state.v[i];
      }
      memset(along, 0, state.v_count * sizeof *along);
      memset(force, 0, state.v_count * sizeof *force);
      model->type->force_along(model, state.q, shape.q, state.v, h, along);
      model->type->force(model, state.q, shape.q, state.v, force);
      g_assert_cmpfloat(vector_length(force, state.v_count), >, 0);
      g_assert_cmpfloat(vector_distance(along, force, state.v_count), <=, 1e-11 * vector_length(force, state.v_count));
    }
    g_free(along);
    g_free(force);
    state_clear(&state);
    state_clear(&shape);
    g_rand_free(random);
  }
  model->type->destroy(model);
}

/* Squeezed to a fifth from all sides nothing of it resists any more: no stiffness is left. */
static gboolean may_give_way(const SporeModelType *type) { return type == &spore_saint_venant_kirchhoff_tetrahedra; }

/* Any state, also crushed, inverted and collapsed to a plane: symmetric, finite, not indefinite. */
static void check_definite(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(3);
  const double noise[] = {0, 0.1, 0.5, 2, 20};
  for (int trial = 0; trial < 30; trial++) {
    State state = state_random(model, random, trial % 3 ? 1 : 0.2, noise[trial % 5] * specimen->size);
    for (size_t i = 0; trial % 6 == 5 && i < model->node_count; i++) state.q[3 * i + 1] = 0.1;
    SporeBlockMatrix matrix;
    make_matrix(model, &matrix);
    model->type->jacobian(model, state.q, state.q, state.v, 1, trial % 2 ? 0.01 : 0, &matrix);
    size_t n = 3 * matrix.block_count;
    double *a = dense(&matrix), greatest, difference = asymmetry(a, n, &greatest);
    g_assert_true(isfinite(greatest) && (greatest > 0 || may_give_way(model->type)));
    g_assert_cmpfloat(difference, <=, 1e-12 * greatest);
    for (size_t i = 0; i < n; i++) a[i * n + i] += 1e-10 * greatest;
    g_assert_true(greatest == 0 || is_positive_definite(a, n));
    g_free(a);
    spore_block_matrix_clear(&matrix);
    state_clear(&state);
  }
  g_rand_free(random);
  model->type->destroy(model);
}

/* Internal forces of nodes, damping included, add up to no force and no torque. */
static void check_momentum(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(4);
  double worst = 0;
  for (int trial = 0; trial < 20; trial++) {
    State state = state_random(model, random, 1, 0.5 * specimen->size);
    double *f = model_force(model, &state), scale = 0;
    SporeVec3 force = {0, 0, 0}, torque = {0, 0, 0};
    for (size_t i = model->node_count; i < model->block_count; i++)
      torque = spore_vec3_add(torque, spore_vec3_load(f + 3 * i));
    for (size_t i = 0; i < model->node_count; i++) {
      SporeVec3 fi = spore_vec3_load(f + 3 * i);
      force = spore_vec3_add(force, fi);
      torque = spore_vec3_add(torque, spore_vec3_cross(spore_vec3_load(state.q + 3 * i), fi));
      scale += spore_vec3_length(fi);
    }
    worst = fmax(worst, (spore_vec3_length(force) + spore_vec3_length(torque)) / scale);
    g_free(f);
    state_clear(&state);
  }
  g_test_message("%s: worst relative sum %.2e", specimen->name, worst);
  g_assert_cmpfloat(worst, <, 1e-12);
  g_rand_free(random);
  model->type->destroy(model);
}

/* The model without what stands still in the scene and pushes it about, as the uneven air does smoke. */
static SporeModel *alone(const Specimen *specimen) {
  const SporeParameterTable *table = &specimen->type->parameters;
  int swirl = spore_parameter_find(table, "swirl");
  if (swirl >= 0) *(double *)(void *)((char *)specimen->fields + table->parameters[swirl].offset) = 0;
  return specimen_model(specimen);
}

/* f and M of the moved scene are the moved f and M, and U is the same. */
static void check_frame(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = alone(specimen);
  GRand *random = g_rand_new_with_seed(6);
  for (int trial = 0; trial < 10; trial++) {
    State state = state_random(model, random, 1, 0.4 * specimen->size), moved = state_copy(&state);
    SporePose pose = {shape_random_vector(random, 1), shape_random_rotation(random)};
    state_transform(model, &moved, pose);
    double *f = model_force(model, &state), *g = model_force(model, &moved);
    double *m = vector_new(9 * model->block_count), *n = vector_new(9 * model->block_count);
    spore_model_mass(model, state.q, m);
    spore_model_mass(model, moved.q, n);
    double u = model->type->potential(model, state.q), size = vector_length(f, state.v_count);
    SporeMat3 r = spore_quat_to_mat3(pose.orientation);
    g_assert_cmpfloat(fabs(u - model->type->potential(model, moved.q)), <=, 1e-9 * u);
    for (size_t i = 0; i < model->block_count; i++) {
      SporeVec3 turned = spore_mat3_apply(r, spore_vec3_load(f + 3 * i));
      g_assert_cmpfloat(spore_vec3_distance(turned, spore_vec3_load(g + 3 * i)), <=, 1e-9 * size);
      SporeMat3 block;
      memcpy(block.m, m + 9 * i, sizeof block.m);
      block = spore_mat3_multiply(spore_mat3_multiply(r, block), spore_mat3_transpose(r));
      double largest = vector_length(block.m, 9);
      g_assert_cmpfloat(vector_distance(block.m, n + 9 * i, 9), <=, 1e-9 * largest);
    }
    g_free(f);
    g_free(g);
    g_free(m);
    g_free(n);
    state_clear(&state);
    state_clear(&moved);
  }
  g_rand_free(random);
  model->type->destroy(model);
}

/* to[i]: the node of `renamed` that rests where node i of `model` does. */
static void find_nodes(const SporeModel *model, const SporeModel *renamed, uint32_t *to) {
  const SporeVec3 still = {0, 0, 0};
  State here = state_new(model, spore_pose_identity(), still, still);
  State there = state_new(renamed, spore_pose_identity(), still, still);
  for (size_t i = 0; i < model->node_count; i++) {
    double least = HUGE_VAL;
    for (size_t j = 0; j < renamed->node_count; j++) {
      double distance = spore_vec3_distance(spore_vec3_load(here.q + 3 * i), spore_vec3_load(there.q + 3 * j));
      if (distance < least) least = distance, to[i] = (uint32_t)j;
    }
    g_assert_cmpfloat(least, <, 1e-12);
  }
  state_clear(&here);
  state_clear(&there);
}

static void check_labels(gconstpointer data) {
  const Specimen *specimen = data;
  GRand *random = g_rand_new_with_seed(7);
  SporeModel *model = specimen_model(specimen);
  uint32_t *order = shape_order(specimen->surface.vertex_count + specimen->tetrahedra.vertex_count, random);
  Specimen *other = specimen_relabelled(specimen, order);
  SporeModel *renamed = specimen_model(other);
  g_assert_cmpuint(model->block_count, ==, renamed->block_count);
  uint32_t *node = g_new(uint32_t, model->node_count);
  find_nodes(model, renamed, node);
  State state = state_random(model, random, 1, 0.4 * specimen->size), same = state_copy(&state);
  for (size_t i = 0; i < model->node_count; i++)
    for (size_t k = 0; k < 3; k++) {
      same.q[3 * (size_t)node[i] + k] = state.q[3 * i + k];
      same.v[3 * (size_t)node[i] + k] = state.v[3 * i + k];
    }
  double *f = model_force(model, &state), *g = model_force(renamed, &same);
  double *m = vector_new(9 * model->block_count), *n = vector_new(9 * model->block_count);
  spore_model_mass(model, state.q, m);
  spore_model_mass(renamed, same.q, n);
  double scale = vector_length(f, state.v_count);
  for (size_t i = 0; i < model->block_count; i++) {
    size_t j = i < model->node_count ? node[i] : i;
    g_assert_cmpfloat(vector_distance(f + 3 * i, g + 3 * j, 3), <=, 1e-9 * scale);
    g_assert_cmpfloat(vector_distance(m + 9 * i, n + 9 * j, 9), <=, 1e-9 * vector_length(m + 9 * i, 9));
  }
  g_free(f);
  g_free(g);
  g_free(m);
  g_free(n);
  g_free(node);
  g_free(order);
  state_clear(&state);
  state_clear(&same);
  model->type->destroy(model);
  renamed->type->destroy(renamed);
  specimen_free(other);
  g_rand_free(random);
}

static gboolean has_strain(const SporeModelType *type) { return type->strain != NULL; }

/* What is as much longer everywhere as its nodes are drawn apart has that strain, wherever it is and however turned. */
static void check_strain(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(11);
  for (double stretch = 0.8; stretch < 1.5; stretch += 0.2) {
    State state = state_random(model, random, stretch, 0);
    uint64_t before = spore_allocation_count();
    g_assert_cmpfloat_with_epsilon(model->type->strain(model, state.q), stretch - 1, 1e-6);
    g_assert_cmpuint(spore_allocation_count(), ==, before);
    state_clear(&state);
  }
  g_rand_free(random);
  model->type->destroy(model);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  specimen_add_tests("/conformance/gradient", check_gradient, NULL);
  specimen_add_tests("/conformance/jacobian", check_jacobian, has_jacobian);
  specimen_add_tests("/conformance/tangent", check_tangent, has_tangent);
  specimen_add_tests("/conformance/stiffness", check_stiffness, has_stiffness);
  specimen_add_tests("/conformance/viscosity", check_viscosity, has_jacobian);
  specimen_add_tests("/conformance/force_along", check_force_along, has_force_along);
  specimen_add_tests("/conformance/definite", check_definite, has_jacobian);
  specimen_add_tests("/conformance/momentum", check_momentum, is_alone);
  specimen_add_tests("/conformance/frame", check_frame, NULL);
  specimen_add_tests("/conformance/strain", check_strain, has_strain);
  specimen_add_tests("/conformance/labels", check_labels, NULL);
  return g_test_run();
}
