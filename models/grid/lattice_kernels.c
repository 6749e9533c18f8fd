/* Forces, energy and Jacobian of a lattice. */
#include "models/grid/lattice.h"

#include <assert.h>

#include "models/tetrahedra/neo_hookean_law.h"

#define MODES SPORE_LATTICE_MODES

/* The four rows of a run's corners, SPORE_LANES + 1 long. */
typedef struct Rows {
  const double *row[4];
  double room[4][3 * (SPORE_LANES + 1)]; /* of a run that is shorter: beyond its end, the last edge again and again */
} Rows;

SPORE_INLINE void rows_of(const SporeLatticeRun *run, const double *x, Rows *rows) {
  assert(run->count > 0 && run->count <= SPORE_LANES);
  for (int r = 0; r < 4; r++) {
    rows->row[r] = x + 3 * (size_t)run->row[r];
    if (run->count == SPORE_LANES) continue;
    size_t nodes = run->count + 1;
    double *room = rows->room[r];
    for (size_t i = 0; i < 3 * nodes; i++) room[i] = rows->row[r][i];
    for (size_t i = 3 * nodes; i < 3 * (SPORE_LANES + 1); i++) room[i] = room[i - 3] + (room[i - 3] - room[i - 6]);
    rows->row[r] = room;
  }
}

/* From the corners of cells to their modes; mode 0 is that of the distances from corner 0. */
SPORE_INLINE void modes_of(const SporeLattice *lattice, const Rows *rows, size_t lane, SporeVd3 mode[8]) {
  SPORE_UNROLL for (unsigned c = 0; c < 8; c++) mode[c] = spore_vd3_load(rows->row[c >> 1] + 3 * (lane + (c & 1)));
  SPORE_UNROLL for (unsigned c = 8; c-- > 0;) mode[c] = spore_vd3_sub(mode[c], mode[0]);
  SPORE_UNROLL for (unsigned bit = 1; bit < 8; bit *= 2) SPORE_UNROLL for (unsigned c = 0; c < 8; c++) {
    if (c & bit) continue;
    SporeVd3 low = mode[c], high = mode[c + bit];
    mode[c] = spore_vd3_add(low, high), mode[c + bit] = spore_vd3_sub(high, low);
  }
  SPORE_UNROLL for (unsigned m = 1; m < 8; m++) mode[m] =
      spore_vd3_scale(spore_vd_all(lattice->mode_scale[m]), mode[m]);
}

/* The transpose of its signs. */
SPORE_INLINE void corners_of(SporeVd3 mode[8]) {
  mode[0] = (SporeVd3){0};
  SPORE_UNROLL for (unsigned bit = 1; bit < 8; bit *= 2) SPORE_UNROLL for (unsigned c = 0; c < 8; c++) {
    if (c & bit) continue;
    SporeVd3 low = mode[c], high = mode[c + bit];
    mode[c] = spore_vd3_sub(low, high), mode[c + bit] = spore_vd3_add(low, high);
  }
}

/* Modes of one sign, along the grid's axes 0, 1, 2, and of several. */
static const unsigned single[3] = {4, 2, 1}, several[4] = {3, 5, 6, 7};

SPORE_INLINE SporeVd33 gradient_of(const SporeVd3 mode[8]) {
  SporeVd33 f;
  SPORE_UNROLL for (int k = 0; k < 3; k++) {
    SporeVd3 column = mode[single[k]];
    f.m[k] = column.x, f.m[3 + k] = column.y, f.m[6 + k] = column.z;
  }
  return f;
}

SPORE_INLINE void set_columns(const SporeVd33 *stress, SporeVd3 mode[8]) {
  SPORE_UNROLL for (int k = 0; k < 3; k++) mode[single[k]] = spore_vd33_column(stress, k);
}

/* Stiffness of W. */
static double variation_modulus(SporeElasticity elasticity) {
  double nu = elasticity.lambda / (2 * (elasticity.lambda + elasticity.mu));
  return 2 * elasticity.mu * (1 + nu) / (1 + nu * nu);
}

/* F^T a */
SPORE_INLINE SporeVd3 pulled_back(const SporeVd33 *f, SporeVd3 a) {
  return (SporeVd3){spore_vd3_dot(spore_vd33_column(f, 0), a), spore_vd3_dot(spore_vd33_column(f, 1), a),
                    spore_vd3_dot(spore_vd33_column(f, 2), a)};
}

/* Adds to the stress of F and of W what resists the rates of Green's strain and of F^T W. */
SPORE_INLINE void add_viscous(SporeElasticity elasticity, const SporeVd3 shape[8], const SporeVd3 rate[8],
                              SporeVd33 *stress, SporeVd3 pull[8]) {
  SporeVd33 f = gradient_of(shape), df = gradient_of(rate);
  SporeVd modulus = spore_vd_all(elasticity.viscosity * variation_modulus(elasticity));
  spore_add_viscous(elasticity, &f, &df, spore_vd33_product(&f, &df), stress);
  SPORE_UNROLL for (int n = 0; n < 4; n++) {
    unsigned m = several[n];
    SporeVd3 change = spore_vd3_add(pulled_back(&df, shape[m]), pulled_back(&f, rate[m]));
    change = spore_vd3_scale(modulus, change);
    spore_vd33_add_outer(stress, shape[m], change);
    pull[m] = spore_vd3_add(pull[m], spore_vd33_apply(&f, change));
  }
}

SPORE_INLINE void add_run_forces(const SporeLattice *lattice, const SporeLatticeRun *run, SporeElasticity elasticity,
                                 Law law, const double *q, const double *shape, const double *v, double *f) {
  double pulls[8][3 * SPORE_LANES], modulus = variation_modulus(elasticity);
  Rows at, at_shape, speed;
  rows_of(run, q, &at);
  if (elasticity.viscosity > 0) rows_of(run, v, &speed);
  if (elasticity.viscosity > 0 && shape != q) rows_of(run, shape, &at_shape);
  for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
    SporeVd3 mode[8], pull[8], other[8], rate[8];
    modes_of(lattice, &at, lane, mode);
    SporeVd33 gradient = gradient_of(mode);
    SporePoint point = spore_point_of(&gradient);
    SporeVd33 stress = law_stress(law, &point, spore_bulk_pressure(law.bulk, law_volume(law, &point)));
    SPORE_UNROLL for (int n = 0; n < 4; n++) pull[several[n]] =
        spore_vd3_scale(spore_vd_all(modulus), mode[several[n]]);
    if (elasticity.viscosity > 0) {
      modes_of(lattice, &speed, lane, rate);
      if (shape != q) modes_of(lattice, &at_shape, lane, other);
      add_viscous(elasticity, shape != q ? other : mode, rate, &stress, pull);
    }
    set_columns(&stress, pull);
    SporeVd volume = spore_vd_load(run->volume + lane);
    SPORE_UNROLL for (unsigned m = 1; m < 8; m++) pull[m] = spore_vd3_scale(volume * lattice->mode_scale[m], pull[m]);
    corners_of(pull);
    SPORE_UNROLL for (unsigned c = 0; c < 8; c++) spore_vd3_store(pulls[c] + 3 * lane, pull[c]);
  }
  for (unsigned c = 0; c < 8; c++) {
    double *to = f + 3 * ((size_t)run->row[c >> 1] + (c & 1));
    for (size_t i = 0; i < 3 * (size_t)run->count; i++) to[i] -= pulls[c][i];
  }
}

void SPORE_LEVEL_NAME(spore_lattice_force)(const SporeLattice *lattice, size_t slab, SporeElasticity elasticity,
                                           const double *q, const double *shape, const double *v, double *f) {
  assert(slab < lattice->voxels.size[0]);
  assert(f != q && f != v);
  Law law = law_of(elasticity);
  for (size_t r = lattice->slab_start[slab]; r < lattice->slab_start[slab + 1]; r++)
    add_run_forces(lattice, lattice->runs + r, elasticity, law, q, shape, v, f);
}

double SPORE_LEVEL_NAME(spore_lattice_potential)(const SporeLattice *lattice, SporeElasticity elasticity,
                                                 const double *q) {
  Law law = law_of(elasticity);
  double lanes[SPORE_LANES] = {0}, modulus = variation_modulus(elasticity);
  for (size_t r = 0; r < lattice->run_count; r++) {
    Rows rows;
    rows_of(lattice->runs + r, q, &rows);
    for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
      SporeVd3 mode[8];
      modes_of(lattice, &rows, lane, mode);
      SporeVd33 gradient = gradient_of(mode);
      SporePoint point = spore_point_of(&gradient);
      SporeVd density = law_density(law, &point) + spore_bulk_density(law.bulk, law_volume(law, &point));
      SPORE_UNROLL for (int n = 0; n < 4; n++) density +=
          0.5 * modulus * spore_vd3_dot(mode[several[n]], mode[several[n]]);
      SporeVd volume = spore_vd_load(lattice->runs[r].volume + lane);
      spore_vd_store(lanes + lane, spore_vd_load(lanes + lane) + volume * density);
    }
  }
  return spore_lanes_sum(lanes);
}

/* The derivatives of the stresses of the modes by the modes, scaled: [m][n], 1..7 each; [n][m] is the transpose. */
typedef SporeVd33 ModeBlocks[8][8];

SPORE_INLINE void set_pair(ModeBlocks blocks, unsigned m, unsigned n, const SporeVd33 *block, SporeVd scale) {
  SPORE_UNROLL for (int i = 0; i < 9; i++) blocks[m][n].m[i] = scale * block->m[i];
  if (m != n) blocks[n][m] = spore_vd33_transpose(&blocks[m][n]);
}

/* a b^T */
SPORE_INLINE SporeVd33 outer(SporeVd3 a, SporeVd3 b) {
  SporeVd33 product = {0};
  spore_vd33_add_outer(&product, a, b);
  return product;
}

/* Of add_viscous; weight: volume and scale. between: of F with itself. */
SPORE_INLINE void add_mode_viscosity(const SporeLattice *lattice, SporeElasticity elasticity, SporeVd weight,
                                     const SporeVd3 shape[8], SporeElementBlocks *between, ModeBlocks blocks) {
  const SporeVd33 identity = {.m = {spore_vd_all(1), {0}, {0}, {0}, spore_vd_all(1), {0}, {0}, {0}, spore_vd_all(1)}};
  SporeVd33 f = gradient_of(shape), across = spore_vd33_transpose(&f), square = spore_vd33_multiply(&f, &across);
  SporeVd modulus = weight * variation_modulus(elasticity);
  spore_add_viscosity(weight, elasticity.mu, elasticity.lambda, &identity, &f, between);
  for (int n = 0; n < 4; n++) {
    unsigned m = several[n];
    SporeVd33 self = outer(spore_vd3_scale(modulus, shape[m]), shape[m]);
    SPORE_UNROLL for (int i = 0; i < 9; i++) {
      between->m[0].m[i] += self.m[i], between->m[3].m[i] += self.m[i], between->m[5].m[i] += self.m[i];
      blocks[m][m].m[i] += modulus * (lattice->mode_scale[m] * lattice->mode_scale[m]) * square.m[i];
    }
    for (int k = 0; k < 3; k++) {
      SporeVd33 coupled = outer(shape[m], spore_vd33_column(&f, k));
      set_pair(blocks, single[k], m, &coupled, modulus * (lattice->mode_scale[m] * lattice->mode_scale[single[k]]));
    }
  }
}

SPORE_INLINE void add_mode_stiffness(const SporeLattice *lattice, SporeElasticity elasticity, Law law, SporeVd weight,
                                     const SporeVd3 mode[8], SporeElementBlocks *between, ModeBlocks blocks) {
  const SporeVd33 identity = {.m = {spore_vd_all(1), {0}, {0}, {0}, spore_vd_all(1), {0}, {0}, {0}, spore_vd_all(1)}};
  SporeVd33 gradient = gradient_of(mode);
  SporePoint point = spore_point_turned(&gradient);
  law_add_stiffness(law, weight, &identity, &point, spore_bulk_pressure(law.bulk, law_volume(law, &point)), law.bulk.k,
                    false, between);
  for (int n = 0; n < 4; n++) {
    unsigned m = several[n];
    SporeVd modulus = weight * (variation_modulus(elasticity) * lattice->mode_scale[m] * lattice->mode_scale[m]);
    SPORE_UNROLL for (int i = 0; i < 9; i += 4) blocks[m][m].m[i] += modulus;
  }
}

/* The transpose of the modes' signs, of 3x3 matrices. */
static void spread(SporeVd33 mode[8]) {
  for (unsigned bit = 1; bit < 8; bit *= 2)
    for (unsigned c = 0; c < 8; c++) {
      if (c & bit) continue;
      SPORE_UNROLL for (int i = 0; i < 9; i++) {
        SporeVd low = mode[c].m[i], high = mode[c + bit].m[i];
        mode[c].m[i] = low - high, mode[c + bit].m[i] = low + high;
      }
    }
}

/* From modes to corners on both sides: blocks [m][n] become those of corner m and mode n, and then those of two
 * corners. Corners are added in descending order, so that a node gets its entries in the same order whatever the width
 * of a vector. */
static void add_blocks(const SporeLattice *lattice, size_t run, size_t lane, ModeBlocks blocks,
                       SporeBlockMatrix *matrix) {
  assert(run < lattice->run_count && lane < SPORE_LANES);
  SporeBlockRows rows[8];
  size_t lanes = lattice->runs[run].count;
  lanes = lanes < lane ? 0 : lanes - lane < SPORE_WIDTH ? lanes - lane : SPORE_WIDTH;
  for (unsigned n = 1; n < 8; n++) {
    SporeVd33 column[8];
    for (unsigned m = 0; m < 8; m++) column[m] = blocks[m][n];
    spread(column);
    for (unsigned m = 0; m < 8; m++) blocks[m][n] = column[m];
  }
  for (unsigned a = 8; a-- > 0;) {
    blocks[a][0] = (SporeVd33){0};
    spread(blocks[a]);
    for (unsigned b = 0; b < 8; b++) spore_store_block(&rows[b], &blocks[a][b]);
    for (size_t i = 0; i < lanes; i++)
      for (unsigned b = 0; b < 8; b++) {
        size_t place = lattice->blocks[SPORE_LANES * run + lane + i][8 * a + b];
        spore_block_add_rows(matrix->values + 9 * place, rows[b], i);
      }
  }
}

static void add_run_matrix(const SporeLattice *lattice, size_t r, SporeElasticity elasticity, Law law, const double *q,
                           const double *shape, double stiffness_scale, double damping_scale,
                           SporeBlockMatrix *matrix) {
  const SporeLatticeRun *run = lattice->runs + r;
  double viscous = damping_scale * elasticity.viscosity;
  Rows at, at_shape;
  rows_of(run, q, &at);
  rows_of(run, shape, &at_shape);
  for (size_t lane = 0; lane < SPORE_LANES; lane += SPORE_WIDTH) {
    SporeVd3 mode[8];
    SporeVd volume = spore_vd_load(run->volume + lane);
    SporeElementBlocks between = {0};
    ModeBlocks blocks = {0};
    if (stiffness_scale != 0) {
      modes_of(lattice, &at, lane, mode);
      add_mode_stiffness(lattice, elasticity, law, volume * stiffness_scale, mode, &between, blocks);
    }
    if (viscous != 0) {
      modes_of(lattice, &at_shape, lane, mode);
      add_mode_viscosity(lattice, elasticity, volume * viscous, mode, &between, blocks);
    }
    int pair = 0;
    for (int a = 0; a < 3; a++)
      for (int b = a; b < 3; b++, pair++)
        set_pair(blocks, single[a], single[b], &between.m[pair],
                 spore_vd_all(lattice->mode_scale[single[a]] * lattice->mode_scale[single[b]]));
    add_blocks(lattice, r, lane, blocks, matrix);
  }
}

void SPORE_LEVEL_NAME(spore_lattice_jacobian)(const SporeLattice *lattice, size_t slab, SporeElasticity elasticity,
                                              const double *q, const double *shape, double stiffness_scale,
                                              double damping_scale, SporeBlockMatrix *matrix) {
  assert(slab < lattice->voxels.size[0]);
  assert(stiffness_scale >= 0);
  Law law = law_of(elasticity);
  for (size_t r = lattice->slab_start[slab]; r < lattice->slab_start[slab + 1]; r++)
    add_run_matrix(lattice, r, elasticity, law, q, shape, stiffness_scale, damping_scale, matrix);
}
