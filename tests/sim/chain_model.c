/* A small model for the tests of the world: particles in a row, joined by springs. */
#include "tests/sim/chain_model.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"

typedef struct Chain {
  SporeModel base;
  ChainFields fields;
  double *rest; /* where it was placed last */
} Chain;

#define REAL(field, low, start)                                                                                        \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REAL, .unit = "1", .minimum = low, .maximum = HUGE_VAL, .initial = {start},          \
    .offset = offsetof(ChainFields, field), .change = SPORE_CHANGE_LIVE, .doc = #field                                 \
  }

static const SporeParameter parameters[] = {
    {.name = "count",
     .type = SPORE_INTEGER,
     .unit = "1",
     .minimum = 1,
     .maximum = 1e6,
     .initial = {2},
     .offset = offsetof(ChainFields, count),
     .change = SPORE_CHANGE_RESTART,
     .doc = "count"},
    REAL(mass, 1e-12, 1),
    REAL(spacing, 1e-12, 1),
    REAL(stiffness, 0, 100),
    REAL(damping, 0, 0),
    REAL(anchor, 0, 0),
    REAL(poison_at, -HUGE_VAL, 1e300),
};

SporeModel *chain_create(ChainFields fields) { return chain_model.create(NULL, &fields, NULL); }

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  Chain *chain = SPORE_NEW(Chain);
  chain->fields = *(const ChainFields *)fields;
  size_t n = (size_t)chain->fields.count;
  spore_model_init(&chain->base, &chain_model, n, false, error);
  for (size_t i = 0; i < n; i++) chain->base.block_mass[i] = chain->fields.mass;
  chain->rest = SPORE_NEW_ARRAY(double, 3 * n);
  return &chain->base;
}

static void destroy(SporeModel *model) {
  Chain *chain = (Chain *)model;
  spore_free(chain->rest);
  spore_model_clear(&chain->base);
  spore_free(chain);
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  const Chain *chain = (const Chain *)model;
  for (size_t i = 0; i < model->block_count; i++) {
    SporeVec3 at = {(double)i * chain->fields.spacing, 0, 0};
    spore_vec3_store(q + 3 * i, spore_pose_apply(pose, at));
    spore_vec3_store(v + 3 * i, velocity);
  }
  memcpy(chain->rest, q, 3 * model->block_count * sizeof *q);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  const Chain *chain = (const Chain *)model;
  const ChainFields *fields = &chain->fields;
  for (size_t i = 0; i + 1 < model->block_count; i++) {
    SporeVec3 d = spore_vec3_sub(spore_vec3_load(q + 3 * i + 3), spore_vec3_load(q + 3 * i));
    double length = spore_vec3_length(d);
    SporeVec3 pull = spore_vec3_scale(fields->stiffness * (1 - fields->spacing / length), d);
    spore_vec3_accumulate(f + 3 * i, pull);
    spore_vec3_accumulate(f + 3 * i + 3, spore_vec3_scale(-1, pull));
  }
  for (size_t k = 0; k < 3 * model->block_count; k++)
    f[k] -= fields->anchor * (q[k] - chain->rest[k]) + fields->damping * v[k];
  if (q[1] > fields->poison_at) f[1] = NAN;
}

static double potential(const SporeModel *model, const double *q) {
  const Chain *chain = (const Chain *)model;
  double energy = 0;
  for (size_t i = 0; i + 1 < model->block_count; i++) {
    double stretch =
        spore_vec3_distance(spore_vec3_load(q + 3 * i), spore_vec3_load(q + 3 * i + 3)) - chain->fields.spacing;
    energy += 0.5 * chain->fields.stiffness * stretch * stretch;
  }
  for (size_t k = 0; k < 3 * model->block_count; k++)
    energy += 0.5 * chain->fields.anchor * (q[k] - chain->rest[k]) * (q[k] - chain->rest[k]);
  return energy;
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  const Chain *chain = (const Chain *)model;
  uint32_t *blocks = SPORE_NEW_ARRAY(uint32_t, count);
  double *weights = SPORE_NEW_ARRAY(double, count);
  bool good = blocks && weights;
  for (size_t i = 0; good && i < count; i++) {
    long nearest = lround(points[3 * i] / chain->fields.spacing);
    long last = (long)model->block_count - 1;
    blocks[i] = (uint32_t)(nearest < 0 ? 0 : nearest > last ? last : nearest);
    weights[i] = 1;
  }
  good = good ? spore_mapping_init_linear(mapping, count, 1, blocks, weights, error)
              : spore_error_set(error, SPORE_ERROR_MEMORY, NULL, "no memory");
  spore_free(blocks);
  spore_free(weights);
  return good;
}

static bool pattern(const SporeModel *model, SporeBlockPattern *pairs) {
  uint32_t reach = (uint32_t)((const Chain *)model)->fields.reach;
  for (uint32_t i = 0; i + 1 < model->block_count; i++)
    for (uint32_t k = 1; k <= (reach > 1 ? reach : 1) && i + k < model->block_count; k++)
      if (!spore_block_pattern_add(pairs, i, i + k)) return false;
  return true;
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const Chain *chain = (const Chain *)model;
  for (uint32_t i = 0; i + 1 < model->block_count; i++) {
    SporeVec3 d = spore_vec3_sub(spore_vec3_load(q + 3 * i + 3), spore_vec3_load(q + 3 * i));
    double length = spore_vec3_length(d), sideways = fmax(0, 1 - chain->fields.spacing / length);
    SporeVec3 n = spore_vec3_scale(1 / length, d);
    SporeMat3 axial = spore_mat3_outer(n, n);
    SporeMat3 k = spore_mat3_add(axial, spore_mat3_scale(sideways, spore_mat3_sub(spore_mat3_identity(), axial)));
    k = spore_mat3_scale(stiffness_scale * chain->fields.stiffness, k);
    SporeMat3 minus = spore_mat3_scale(-1, k);
    spore_block_matrix_add(matrix, i, i, k.m);
    spore_block_matrix_add(matrix, i + 1, i + 1, k.m);
    spore_block_matrix_add(matrix, i, i + 1, minus.m);
    spore_block_matrix_add(matrix, i + 1, i, minus.m);
  }
  double d = stiffness_scale * chain->fields.anchor + damping_scale * chain->fields.damping;
  SporeMat3 own = spore_mat3_diagonal(d, d, d);
  for (uint32_t i = 0; i < model->block_count; i++) spore_block_matrix_add(matrix, i, i, own.m);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  ((Chain *)model)->fields = *(const ChainFields *)fields;
  return true;
}

const SporeModelType chain_model = {
    .name = "chain",
    .label = "Chain",
    .doc = "Particles in a row.",
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(ChainFields)},
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .potential = potential,
    .map = map,
    .pattern = pattern,
    .jacobian = jacobian,
    .retune = retune,
};

SporeWorldDescription world_description(SporeBodyDescription *bodies, size_t body_count) {
  SporeWorldDescription description = {.body_count = body_count, .bodies = bodies};
  spore_parameters_set_initial(&spore_solver_parameters, &description.solver);
  return description;
}

SporeBodyDescription passive_body(const char *name, SporeModel *model, SporeVec3 position) {
  SporeBodyDescription body = {.name = name,
                               .role = SPORE_PASSIVE,
                               .model = model,
                               .integrator = SPORE_INTEGRATOR_DEFAULT,
                               .pose = spore_pose_identity()};
  body.pose.position = position;
  spore_parameters_set_initial(&spore_contact_parameters, &body.contact);
  return body;
}
