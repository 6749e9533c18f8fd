/* The step of the default scenes of SOFA: one linearised implicit Euler step, solved by a few conjugate gradients. */
#include "tests/bench/sofa/sofa_step.h"

#include <glib.h>
#include <string.h>

#include "core/linalg/pcg.h"

typedef struct Operator {
  const SporeBlockMatrix *matrix;
  const uint8_t *held;
} Operator;

static void filter(const uint8_t *held, size_t blocks, double *x) {
  for (size_t i = 0; i < blocks; i++)
    if (held[i]) memset(x + 3 * i, 0, 3 * sizeof *x);
}

static void multiply(void *data, const double *x, double *y) {
  const Operator *operator= data;
  memset(y, 0, 3 * operator->matrix->block_count * sizeof * y);
  spore_block_matrix_multiply_add(operator->matrix, x, y);
  filter(operator->held, operator->matrix->block_count, y);
}

static void no_preconditioner(void *data, const double *r, double *z) {
  const Operator *operator= data;
  memcpy(z, r, 3 * operator->matrix->block_count * sizeof * z);
}

static void create_matrix(const SporeModel *model, SporeBlockMatrix *matrix) {
  SporeBlockPattern pattern;
  spore_block_pattern_init(&pattern, model->block_count);
  g_assert_true(model->type->pattern(model, &pattern) && spore_block_matrix_create(matrix, &pattern));
  spore_block_pattern_clear(&pattern);
}

/* (M + h D + h^2 K) dv = h f - h^2 K v; v += dv; q += h v. Returns the relative residual. */
static double step(const SporeModel *model, SporeVec3 gravity, const uint8_t *held, double h, size_t iterations,
                   SporeBlockMatrix *matrix, double *q, double *v, double *work) {
  size_t n = 3 * model->block_count;
  double *rhs = work, *dv = work + n, *scratch = work + 2 * n;
  memset(rhs, 0, n * sizeof *rhs);
  spore_block_matrix_zero(matrix);
  model->type->jacobian(model, q, q, v, h, 0, matrix);
  spore_block_matrix_multiply_add(matrix, v, rhs);
  for (size_t i = 0; i < n; i++) rhs[i] = -rhs[i];
  model->type->force(model, q, q, v, rhs);
  for (size_t i = 0; i < model->block_count; i++)
    spore_vec3_accumulate(rhs + 3 * i, spore_vec3_scale(model->block_mass[i], gravity));
  for (size_t i = 0; i < n; i++) rhs[i] *= h;
  filter(held, model->block_count, rhs);
  spore_block_matrix_zero(matrix);
  model->type->jacobian(model, q, q, v, h * h, h, matrix);
  for (size_t i = 0; i < model->block_count; i++)
    for (int k = 0; k < 3; k++) matrix->values[9 * (size_t)matrix->diagonal[i] + 4 * k] += model->block_mass[i];
  Operator data = {matrix, held};
  SporeLinearOperator operator= {&data, n, multiply, no_preconditioner};
  SporeLinearResult result = spore_pcg(&operator, rhs, SOFA_TOLERANCE, iterations, dv, scratch);
  for (size_t i = 0; i < n; i++) v[i] += dv[i];
  for (size_t i = 0; i < n; i++) q[i] += h * v[i];
  return result.residual;
}

double sofa_run(const SporeModel *model, SporeVec3 gravity, const uint8_t *held, double h, unsigned steps,
                size_t iterations, double *q, double *v) {
  SporeBlockMatrix matrix;
  create_matrix(model, &matrix);
  double *work = g_new0(double, (2 + SPORE_PCG_SCRATCH) * 3 * model->block_count), sum = 0;
  for (unsigned i = 0; i < steps; i++) sum += step(model, gravity, held, h, iterations, &matrix, q, v, work);
  g_free(work);
  spore_block_matrix_clear(&matrix);
  return sum / steps;
}
