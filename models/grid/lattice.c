/* Making a lattice: nodes, runs of cells, places in the matrix, masses. */
#include "models/grid/lattice.h"

#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "models/common/stretch.h"

#define NO_NODE UINT32_MAX

static size_t place_of(const SporeVoxels *voxels, size_t i, size_t j, size_t k) {
  assert(i <= voxels->size[0] && j <= voxels->size[1] && k <= voxels->size[2]);
  return (i * (voxels->size[1] + 1) + j) * (voxels->size[2] + 1) + k;
}

uint32_t spore_lattice_corner(const SporeLattice *lattice, size_t i, size_t j, size_t k, unsigned corner) {
  assert(corner < 8);
  return lattice->node[place_of(&lattice->voxels, i + (corner >> 2), j + (corner >> 1 & 1), k + (corner & 1))];
}

/* Calls for each filled cell, in their order. */
typedef void (*Visit)(SporeLattice *lattice, size_t i, size_t j, size_t k, void *data);

static void each_cell(SporeLattice *lattice, Visit visit, void *data) {
  const SporeVoxels *voxels = &lattice->voxels;
  for (size_t i = 0; i < voxels->size[0]; i++)
    for (size_t j = 0; j < voxels->size[1]; j++)
      for (size_t k = 0; k < voxels->size[2]; k++)
        if (voxels->share[spore_voxels_at(voxels, i, j, k)] > 0) visit(lattice, i, j, k, data);
}

static void mark_corners(SporeLattice *lattice, size_t i, size_t j, size_t k, void *data) {
  for (unsigned c = 0; c < 8; c++)
    lattice->node[place_of(&lattice->voxels, i + (c >> 2), j + (c >> 1 & 1), k + (c & 1))] = 0;
}

/* Numbers the corners of filled cells, row after row. */
static bool number_nodes(SporeLattice *lattice) {
  const SporeVoxels *voxels = &lattice->voxels;
  size_t places = (voxels->size[0] + 1) * (voxels->size[1] + 1) * (voxels->size[2] + 1);
  lattice->node = SPORE_NEW_ARRAY(uint32_t, places);
  if (!lattice->node) return false;
  for (size_t p = 0; p < places; p++) lattice->node[p] = NO_NODE;
  each_cell(lattice, mark_corners, NULL);
  for (size_t p = 0; p < places; p++)
    if (lattice->node[p] != NO_NODE) lattice->node[p] = (uint32_t)lattice->node_count++;
  lattice->rest = SPORE_NEW_ARRAY(double, 3 * lattice->node_count);
  if (!lattice->rest) return false;
  for (size_t p = 0; p < places; p++) {
    const size_t at[3] = {p / (voxels->size[2] + 1) / (voxels->size[1] + 1),
                          p / (voxels->size[2] + 1) % (voxels->size[1] + 1), p % (voxels->size[2] + 1)};
    if (lattice->node[p] == NO_NODE) continue;
    for (int k = 0; k < 3; k++)
      lattice->rest[3 * (size_t)lattice->node[p] + (size_t)voxels->axis[k]] =
          voxels->lower[k] + (double)at[k] * voxels->cell[k];
  }
  return true;
}

typedef struct Runs {
  SporeLatticeRun *runs; /* NULL: counts */
  size_t count, length;  /* cells of the last one */
  size_t next;           /* the number of the cell that would continue it */
} Runs;

static void add_cell(SporeLattice *lattice, size_t i, size_t j, size_t k, void *data) {
  Runs *runs = data;
  const SporeVoxels *voxels = &lattice->voxels;
  size_t cell = spore_voxels_at(voxels, i, j, k);
  if (cell != runs->next || k == 0 || runs->length == SPORE_LANES) {
    runs->count++, runs->length = 0;
    for (unsigned r = 0; runs->runs && r < 4; r++)
      runs->runs[runs->count - 1].row[r] = spore_lattice_corner(lattice, i, j, k, 2 * r);
    lattice->slab_start[i + 1] = (uint32_t)runs->count;
  }
  runs->next = cell + 1, runs->length++;
  if (!runs->runs) return;
  SporeLatticeRun *run = &runs->runs[runs->count - 1];
  run->volume[run->count++] = voxels->share[cell] * voxels->cell[0] * voxels->cell[1] * voxels->cell[2];
}

static bool make_runs(SporeLattice *lattice) {
  Runs runs = {.next = SIZE_MAX};
  lattice->slab_start = SPORE_NEW_ARRAY(uint32_t, lattice->voxels.size[0] + 1);
  if (!lattice->slab_start) return false;
  each_cell(lattice, add_cell, &runs);
  for (size_t i = 0; i < lattice->voxels.size[0]; i++)
    if (lattice->slab_start[i + 1] < lattice->slab_start[i]) lattice->slab_start[i + 1] = lattice->slab_start[i];
  lattice->run_count = runs.count;
  lattice->runs = SPORE_NEW_ARRAY(SporeLatticeRun, lattice->run_count);
  lattice->blocks = spore_allocate(SPORE_LANES * lattice->run_count, sizeof *lattice->blocks);
  if (!lattice->runs || !lattice->blocks) return false;
  runs = (Runs){.runs = lattice->runs, .next = SIZE_MAX};
  each_cell(lattice, add_cell, &runs);
  return true;
}

/* A difference along an axis is one sign over 4 edges. Bending about axis b of a bar along a: u_a = c x_a x_b has the
 * strain c x_b, whose mean square is c^2 cell_b^2 / 12; for the mode of a and b, which has both, the mean of both is
 * taken. The mode of all three likewise. */
static void set_scales(SporeLattice *lattice) {
  const double *cell = lattice->voxels.cell;
  for (unsigned mode = 1; mode <= SPORE_LATTICE_MODES; mode++) {
    double product = 1, squares = 0;
    int signs = 0;
    for (int k = 0; k < 3; k++) {
      if (!(mode >> (2 - k) & 1)) continue;
      product *= 0.5 * cell[k], squares += cell[k] * cell[k] / 12, signs++;
    }
    double spread = signs == 1 ? 1 : sqrt(squares / signs);
    if (signs == 3) spread *= spread;
    lattice->mode_scale[mode] = spread / (8 * product);
  }
}

bool spore_lattice_create(SporeLattice *lattice, SporeVoxels *voxels) {
  assert(voxels->share);
  *lattice = (SporeLattice){.voxels = *voxels};
  *voxels = (SporeVoxels){0};
  set_scales(lattice);
  return number_nodes(lattice) && make_runs(lattice);
}

void spore_lattice_clear(SporeLattice *lattice) {
  spore_voxels_clear(&lattice->voxels);
  spore_free(lattice->rest);
  spore_free(lattice->node);
  spore_free(lattice->slab_start);
  spore_free(lattice->runs);
  spore_free(lattice->blocks);
  *lattice = (SporeLattice){0};
}

/* Node of corner c of a run's cell. */
static uint32_t corner_of(const SporeLatticeRun *run, size_t lane, unsigned c) {
  assert(lane < run->count && c < 8);
  return run->row[c >> 1] + (uint32_t)lane + (c & 1);
}

bool spore_lattice_pattern(const SporeLattice *lattice, SporeBlockPattern *pattern) {
  for (size_t r = 0; r < lattice->run_count; r++)
    for (size_t lane = 0; lane < lattice->runs[r].count; lane++)
      for (unsigned a = 0; a < 8; a++)
        for (unsigned b = a + 1; b < 8; b++)
          if (!spore_block_pattern_add(pattern, corner_of(lattice->runs + r, lane, a),
                                       corner_of(lattice->runs + r, lane, b)))
            return false;
  return true;
}

void spore_lattice_find_blocks(SporeLattice *lattice, const SporeBlockMatrix *matrix) {
  assert(matrix->block_count == lattice->node_count);
  for (size_t r = 0; r < lattice->run_count; r++)
    for (size_t lane = 0; lane < lattice->runs[r].count; lane++)
      for (unsigned a = 0; a < 8; a++)
        for (unsigned b = 0; b < 8; b++)
          lattice->blocks[SPORE_LANES * r + lane][8 * a + b] = (uint32_t)spore_block_matrix_find(
              matrix, corner_of(lattice->runs + r, lane, a), corner_of(lattice->runs + r, lane, b));
}

static SporeVec3 middle_of(const SporeLattice *lattice, const SporeLatticeRun *run, size_t lane) {
  SporeVec3 sum = {0, 0, 0};
  for (unsigned c = 0; c < 8; c++)
    sum = spore_vec3_add(sum, spore_vec3_load(lattice->rest + 3 * (size_t)corner_of(run, lane, c)));
  return spore_vec3_scale(0.125, sum);
}

void spore_lattice_add_mass(SporeLattice *lattice, double total, const SporeRegions *regions, double *mass) {
  assert(total > 0 && mass);
  double volume = 0;
  for (size_t r = 0; r < lattice->run_count; r++)
    for (size_t lane = 0; lane < lattice->runs[r].count; lane++) volume += lattice->runs[r].volume[lane];
  for (size_t r = 0; r < lattice->run_count; r++)
    for (size_t lane = 0; lane < lattice->runs[r].count; lane++) {
      SporeLatticeRun *run = &lattice->runs[r];
      SporeRegionFactors factors = spore_regions_at(regions, middle_of(lattice, run, lane));
      for (unsigned c = 0; c < 8; c++)
        mass[corner_of(run, lane, c)] += 0.125 * total * run->volume[lane] / volume * factors.density;
      run->volume[lane] *= factors.stiffness;
    }
}

/* F at the middle of the cell: the modes of one sign. */
static void find_gradient(const SporeLattice *lattice, const SporeLatticeRun *run, size_t lane, const double *q,
                          SporeVec3 f[3]) {
  for (unsigned k = 0; k < 3; k++) {
    unsigned side = 4u >> k;
    f[k] = (SporeVec3){0, 0, 0};
    for (unsigned c = 0; c < 8; c++)
      f[k] = spore_vec3_add_scaled(f[k], c & side ? lattice->mode_scale[side] : -lattice->mode_scale[side],
                                   spore_vec3_load(q + 3 * (size_t)corner_of(run, lane, c)));
  }
}

double spore_lattice_strain(const SporeLattice *lattice, const double *q) {
  assert(lattice->run_count > 0);
  double most = 0;
  for (size_t r = 0; r < lattice->run_count; r++)
    for (size_t lane = 0; lane < lattice->runs[r].count; lane++) {
      SporeVec3 f[3];
      find_gradient(lattice, &lattice->runs[r], lane, q, f);
      most = spore_stretch_square(f, most);
    }
  return sqrt(most) - 1;
}
