/* A net as in the benchmark of SOFA: mass points in a lattice, with springs along edges and diagonals. */
#include "tests/bench/sofa/lattice_net.h"

#include <glib.h>

#include "models/common/nodal.h"
#include "models/net/springs.h"

/* Edges and diagonals differ in stiffness, so each are a set of springs of their own. */
enum { EDGES, DIAGONALS, KINDS };

typedef struct Net {
  SporeModel base;
  double *start, *rest; /* block_count x 3 */
  double mass_damping;
  SporeSprings springs[KINDS];
  size_t *diagonal; /* block_count: where the diagonal blocks lie in the model's matrix */
} Net;

static void lay_flat(const LatticeNet *net, unsigned column, unsigned row, double *x) {
  spore_vec3_store(x, spore_vec3((column - 0.5 * (net->columns - 1)) * net->spacing, 0,
                                 (row - 0.5 * (net->rows - 1)) * net->spacing));
}

static void lay(const LatticeNet *net, LatticePlace place_node, double *points) {
  for (unsigned r = 0; r < net->rows; r++)
    for (unsigned c = 0; c < net->columns; c++) place_node(net, c, r, points + 3 * ((size_t)r * net->columns + c));
}

void lattice_net_points(const LatticeNet *net, double *points) { lay(net, net->start ? net->start : lay_flat, points); }

static void add_key(GArray *keys, const LatticeNet *net, unsigned column, unsigned row, int along_column,
                    int along_row) {
  int other_column = (int)column + along_column, other_row = (int)row + along_row;
  if (other_column < 0 || other_column >= (int)net->columns || other_row >= (int)net->rows) return;
  uint64_t a = row * net->columns + column, b = (uint64_t)other_row * net->columns + (uint64_t)other_column;
  uint64_t key = a << 32 | b;
  g_array_append_val(keys, key);
}

static void add_springs(Net *model, const LatticeNet *net) {
  for (int kind = 0; kind < KINDS; kind++) {
    GArray *keys = g_array_new(FALSE, FALSE, sizeof(uint64_t));
    for (unsigned r = 0; r < net->rows; r++)
      for (unsigned c = 0; c < net->columns; c++) {
        add_key(keys, net, c, r, 1, kind == EDGES ? 0 : 1);
        add_key(keys, net, c, r, kind == EDGES ? 0 : -1, 1);
      }
    SporeSprings *springs = &model->springs[kind];
    g_assert_true(
        spore_springs_create(springs, (uint64_t *)(void *)keys->data, keys->len, model->rest, model->base.block_count));
    springs->stiffness = net->tension / (net->spacing * (kind == EDGES ? 1 : G_SQRT2));
    springs->damping = net->stiffness_damping * springs->stiffness;
    g_array_unref(keys);
  }
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  const Net *net = (const Net *)model;
  return spore_springs_pattern(&net->springs[EDGES], blocks) && spore_springs_pattern(&net->springs[DIAGONALS], blocks);
}

static void find_blocks(Net *net) {
  SporeBlockPattern blocks;
  SporeBlockMatrix matrix;
  spore_block_pattern_init(&blocks, net->base.block_count);
  g_assert_true(pattern(&net->base, &blocks) && spore_block_matrix_create(&matrix, &blocks));
  for (int kind = 0; kind < KINDS; kind++) spore_springs_find_blocks(&net->springs[kind], &matrix);
  for (size_t i = 0; i < net->base.block_count; i++) net->diagonal[i] = matrix.diagonal[i];
  spore_block_matrix_clear(&matrix);
  spore_block_pattern_clear(&blocks);
}

static void destroy(SporeModel *model) {
  Net *net = (Net *)model;
  for (int kind = 0; kind < KINDS; kind++) spore_springs_clear(&net->springs[kind]);
  g_free(net->start);
  g_free(net->rest);
  g_free(net->diagonal);
  spore_model_clear(&net->base);
  g_free(net);
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  spore_nodal_place(((const Net *)model)->start, model->block_count, pose, velocity, spin, q, v);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  const Net *net = (const Net *)model;
  spore_springs_force(net->springs, KINDS, model->pool, q, shape, v, 0, f);
  for (size_t i = 0; i < model->q_count; i++) f[i] -= net->mass_damping * model->block_mass[i / 3] * v[i];
}

static double potential(const SporeModel *model, const double *q) {
  const Net *net = (const Net *)model;
  return spore_springs_potential(&net->springs[EDGES], q) + spore_springs_potential(&net->springs[DIAGONALS], q);
}

static void tangent(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  const Net *net = (const Net *)model;
  spore_springs_jacobian(net->springs, KINDS, model->pool, at, matrix);
  for (size_t i = 0; i < model->block_count; i++)
    for (int k = 0; k < 3; k++)
      matrix->values[9 * net->diagonal[i] + 4 * k] += at->damping_scale * net->mass_damping * model->block_mass[i];
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  tangent(model, &at, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  g_assert_true(count == 0 || count == model->block_count); /* a sphere a node */
  return spore_mapping_init_identity(mapping, count);
}

static const SporeModelType type = {.name = "lattice_net",
                                    .label = "Lattice net",
                                    .doc = "A net for benchmarks.",
                                    .destroy = destroy,
                                    .place = place,
                                    .force = force,
                                    .potential = potential,
                                    .map = map,
                                    .pattern = pattern,
                                    .jacobian = jacobian,
                                    .tangent = tangent};

SporeModel *lattice_net_new(const LatticeNet *net) {
  Net *model = g_new0(Net, 1);
  size_t nodes = (size_t)net->columns * net->rows;
  g_assert_true(spore_model_init(&model->base, &type, nodes, false, NULL));
  for (size_t i = 0; i < nodes; i++) model->base.block_mass[i] = net->mass / (double)nodes;
  model->mass_damping = net->mass_damping;
  model->start = g_new0(double, 3 * nodes);
  model->diagonal = g_new0(size_t, nodes);
  model->rest = g_new0(double, 3 * nodes);
  lattice_net_points(net, model->start);
  lay(net, lay_flat, model->rest);
  add_springs(model, net);
  find_blocks(model);
  return &model->base;
}
