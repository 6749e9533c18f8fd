/* Models whose elements can be met one after the other: a sweep agrees with the force, keeps momentum, and computes the
 * same bits with every instruction set; also where the model was cut or heated. */
#include "core/base/cpu.h"
#include "tests/conformance/specimen.h"

static gboolean applies(const SporeModelType *type) { return type->sweep != NULL; }

static void make_elastic(const SporeModelType *type, SporeModel *model, const void *fields) {
  int at = spore_parameter_find(&type->parameters, "stiffness_damping");
  g_assert_cmpint(at, >=, 0);
  g_autofree char *elastic = g_memdup2(fields, type->parameters.size);
  spore_parameter_store(&type->parameters.parameters[at], &(SporeValue){.type = SPORE_REAL}, elastic);
  g_assert_true(type->retune(model, elastic, NULL));
}

/* The model, without viscosity where that is all that hinders, or NULL where this one cannot. */
static SporeModel *sweeping_model(const Specimen *specimen) {
  SporeModel *model = specimen_model(specimen);
  if (!spore_model_sweeps(model)) make_elastic(specimen->type, model, specimen->fields);
  if (spore_model_sweeps(model)) {
    g_assert_true(model->type->sweep->prepare(model, NULL));
    return model;
  }
  model->type->destroy(model);
  g_test_skip("its elements cannot be met one after the other");
  return NULL;
}

/* How a sweep of h seconds moves the nodes, which moved by h v before that, none of them held. */
static double *moved_by_sweep(SporeModel *model, const State *state, double h) {
  size_t n = model->node_count;
  double *rows = vector_new(4 * n), *before = vector_new(3 * n), *moved = vector_new(3 * n);
  for (size_t i = 0; i < n; i++) {
    for (size_t k = 0; k < 3; k++) {
      rows[4 * i + k] = state->q[3 * i + k];
      before[3 * i + k] = state->q[3 * i + k] - h * state->v[3 * i + k];
    }
    rows[4 * i + 3] = 1 / model->block_mass[i];
  }
  model->type->sweep->sweep(model, &(SporeSweep){.h = h, .before = before, .now = rows});
  for (size_t i = 0; i < n; i++)
    for (size_t k = 0; k < 3; k++) moved[3 * i + k] = rows[4 * i + k] - state->q[3 * i + k];
  g_free(rows);
  g_free(before);
  return moved;
}

/* m moved / h^2 is the force, to first order in h; the sum of m moved is 0 where no damping by mass is. */
static void check_agreement(SporeModel *model, const State *state, const char *which) {
  double apart[2];
  g_autofree double *force = model_force(model, state);
  for (int fine = 0; fine < 2; fine++) {
    double h = fine ? 2e-6 : 4e-6, sum[3] = {0}, size = 0;
    g_autofree double *moved = moved_by_sweep(model, state, h);
    for (size_t i = 0; i < 3 * model->node_count; i++) {
      moved[i] *= model->block_mass[i / 3] / (h * h);
      sum[i % 3] += moved[i];
      size += fabs(moved[i]);
    }
    apart[fine] = vector_distance(moved, force, state->v_count) / vector_length(force, state->v_count);
    for (int k = 0; k < 3; k++) g_assert_cmpfloat(fabs(sum[k]), <=, 1e-4 * size);
  }
  g_test_message("%s: sweep and force %.2g apart, %.2g at half the step", which, apart[0], apart[1]);
  g_assert_cmpfloat(apart[1], <, 0.05);
  g_assert_cmpfloat(apart[1], <, 0.6 * apart[0] + 1e-4);
}

/* A blade through the middle of all nodes. */
static void cut_open(SporeModel *model, const State *state, SporeCuts *cuts) {
  static const double corners[9] = {-1, -1, 0.1, 1, -1, -0.2, 0, 2, 0.1};
  double triangle[9] = {0};
  size_t edges = 0;
  for (size_t i = 0; i < 3 * model->node_count; i++)
    for (size_t k = i % 3; k < 9; k += 3) triangle[k] += state->q[i] / (double)model->node_count;
  for (size_t k = 0; k < 9; k++) triangle[k] += corners[k];
  g_assert_true(model->type->cut->prepare(model, &edges));
  cuts->edges = g_new0(SporeCutEdge, edges);
  cuts->capacity = edges;
  g_assert_cmpuint(model->type->cut->cut(model, state->q, triangle, 0, cuts), >, 0);
}

static void check_sweep(gconstpointer data) {
  SporeModel *model = sweeping_model(data);
  if (!model) return;
  const Specimen *specimen = data;
  GRand *random = g_rand_new_with_seed(8);
  State state = state_random(model, random, 1.05, 0.05 * specimen->size);
  check_agreement(model, &state, "whole");
  const SporeHeat heat = {
      .point = spore_vec3_load(state.q), .radius = 2 * specimen->size, .dose = 0.5, .shrinkage = 0.2, .stiffening = 4};
  g_assert_true(model->type->heat->prepare(model));
  g_assert_cmpuint(model->type->heat->coagulate(model, state.q, &heat), >, 0);
  check_agreement(model, &state, "heated");
  SporeCuts cuts = {0};
  if (model->type->cut->prepare) {
    cut_open(model, &state, &cuts);
    check_agreement(model, &state, "heated and cut");
  }
  model->type->mend(model);
  check_agreement(model, &state, "mended");
  g_free(cuts.edges);
  g_rand_free(random);
  state_clear(&state);
  model->type->destroy(model);
}

static void check_instruction_sets(gconstpointer data) {
  SporeModel *model = sweeping_model(data);
  if (!model) return;
  const Specimen *specimen = data;
  GRand *random = g_rand_new_with_seed(8);
  const double noise[] = {0, 0.1, 0.5, 2, 20};
  for (int trial = 0; trial < 20; trial++) {
    State state = state_random(model, random, trial % 3 ? 1 : 0.2, noise[trial % 5] * specimen->size);
    for (size_t i = 0; trial % 6 == 5 && i < model->block_count; i++) state.q[3 * i + 1] = 0.1;
    spore_cpu_limit(SPORE_CPU_BASELINE);
    g_autofree double *expected = moved_by_sweep(model, &state, 1e-3);
    for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
      spore_cpu_limit(level);
      g_autofree double *found = moved_by_sweep(model, &state, 1e-3);
      g_assert_cmpmem(expected, state.v_count * sizeof(double), found, state.v_count * sizeof(double));
    }
    state_clear(&state);
  }
  g_rand_free(random);
  model->type->destroy(model);
}

/* Nodes of springs that meet are parted along the line at rest, as their force is. */
static void check_collapsed(gconstpointer data) {
  SporeModel *model = sweeping_model(data);
  if (!model) return;
  State state = state_new(model, (SporePose){{0, 0, 0}, {1, 0, 0, 0}}, (SporeVec3){0, 0, 0}, (SporeVec3){0, 0, 0});
  for (size_t i = 3; i < state.q_count; i++) state.q[i] = state.q[i % 3];
  g_autofree double *moved = moved_by_sweep(model, &state, 1e-3);
  for (size_t i = 0; i < state.v_count; i++) g_assert_true(isfinite(moved[i]));
  state_clear(&state);
  model->type->destroy(model);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  specimen_add_tests("/conformance/sweep/force", check_sweep, applies);
  specimen_add_tests("/conformance/sweep/instruction_sets", check_instruction_sets, applies);
  specimen_add_tests("/conformance/sweep/collapsed", check_collapsed, applies);
  return g_test_run();
}
