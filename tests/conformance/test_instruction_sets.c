/* Every registered model computes the same bits with every instruction set that this machine has. */
#include "core/base/cpu.h"
#include "tests/conformance/specimen.h"

/* What a model says of a state, all in one array: forces at two shapes, energy, Jacobian and its product with v. */
static double *answers(const SporeModel *model, const State *state, size_t *count) {
  SporeBlockMatrix matrix = {0};
  size_t blocks = 0;
  if (model->type->jacobian) {
    SporeBlockPattern pattern;
    spore_block_pattern_init(&pattern, model->block_count);
    g_assert_true(model->type->pattern(model, &pattern) && spore_block_matrix_create(&matrix, &pattern));
    spore_block_pattern_clear(&pattern);
    model->type->jacobian(model, state->q, state->q, state->v, 0.3, 0.7, &matrix);
    blocks = matrix.row_start[matrix.block_count];
  }
  size_t n = state->v_count;
  *count = 3 * n + 1 + 9 * blocks;
  double *all = vector_new(*count);
  State shape = state_moved(model, state, state->v, 0.01);
  model->type->force(model, state->q, state->q, state->v, all);
  model->type->force(model, state->q, shape.q, state->v, all + n);
  if (blocks) spore_block_matrix_multiply_add(&matrix, state->v, all + 2 * n);
  all[3 * n] = model->type->potential(model, state->q);
  for (size_t i = 0; i < 9 * blocks; i++) all[3 * n + 1 + i] = matrix.values[i];
  state_clear(&shape);
  spore_block_matrix_clear(&matrix);
  return all;
}

static void check_instruction_sets(gconstpointer data) {
  const Specimen *specimen = data;
  SporeModel *model = specimen_model(specimen);
  GRand *random = g_rand_new_with_seed(8);
  const double noise[] = {0, 0.1, 0.5, 2, 20};
  for (int trial = 0; trial < 30; trial++) {
    State state = state_random(model, random, trial % 3 ? 1 : 0.2, noise[trial % 5] * specimen->size);
    for (size_t i = 0; trial % 6 == 5 && i < model->block_count; i++) state.q[3 * i + 1] = 0.1;
    size_t count;
    spore_cpu_limit(SPORE_CPU_BASELINE);
    double *expected = answers(model, &state, &count);
    for (int level = 0; level < SPORE_CPU_LEVELS; level++) {
      spore_cpu_limit(level);
      double *found = answers(model, &state, &count);
      g_assert_cmpmem(expected, count * sizeof(double), found, count * sizeof(double));
      g_free(found);
    }
    g_free(expected);
    state_clear(&state);
  }
  g_rand_free(random);
  model->type->destroy(model);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  specimen_add_tests("/conformance/instruction_sets", check_instruction_sets, NULL);
  return g_test_run();
}
