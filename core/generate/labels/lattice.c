/* The lattice from which the organs are cut: each cell gets the label with the largest share. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/labels/private.h"

#define MOST_CUBES ((size_t)12 << 20)
#define CELLS_A_CUBE 12
#define SAMPLES 5 /* of a cell: its centre, and halfway from the centre to each corner */

/* Nodes are the corners of the cubes, then the centres of the cubes. A cell joins an edge of the square between two
 * neighbouring cubes with the centres of both cubes. Each square has four cells. All cells are congruent, with no
 * dihedral angle below 60 degrees. */
typedef struct Lattice {
  double lower[3], edge;
  size_t n[3];
} Lattice;

static size_t cube_count(const Lattice *l) { return l->n[0] * l->n[1] * l->n[2]; }
static size_t corner_count(const Lattice *l) { return (l->n[0] + 1) * (l->n[1] + 1) * (l->n[2] + 1); }
static size_t cube_index(const Lattice *l, const size_t c[3]) { return (c[2] * l->n[1] + c[1]) * l->n[0] + c[0]; }
static size_t corner_index(const Lattice *l, const size_t c[3]) {
  return (c[2] * (l->n[1] + 1) + c[1]) * (l->n[0] + 1) + c[0];
}

static SporeVec3 node_place(const Lattice *l, size_t node) {
  size_t corners = corner_count(l);
  bool middle = node >= corners;
  size_t at = middle ? node - corners : node, nx = l->n[0] + !middle, ny = l->n[1] + !middle;
  double shift = middle ? 0.5 : 0;
  return spore_vec3(l->lower[0] + l->edge * ((double)(at % nx) + shift),
                    l->lower[1] + l->edge * ((double)(at / nx % ny) + shift),
                    l->lower[2] + l->edge * ((double)(at / nx / ny) + shift));
}

/* Nodes of cell q of a cube, ordered so that the volume is positive. False: no neighbouring cube on that side. */
static bool cell_nodes(const Lattice *l, const size_t cube[3], int q, size_t node[4]) {
  int axis = q / 4, side = q % 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
  static const uint8_t around[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  size_t next[3] = {cube[0], cube[1], cube[2]}, first[3], second[3];
  if (++next[axis] >= l->n[axis]) return false;
  memcpy(first, next, sizeof first);
  memcpy(second, next, sizeof second);
  first[u] += around[side][0], first[v] += around[side][1];
  second[u] += around[(side + 1) % 4][0], second[v] += around[(side + 1) % 4][1];
  node[0] = corner_count(l) + cube_index(l, cube);
  node[1] = corner_index(l, first);
  node[2] = corner_index(l, second);
  node[3] = corner_count(l) + cube_index(l, next);
  return true;
}

uint16_t spore_label_of_cell(const SporeLabelField *field, const SporeVec3 corner[4]) {
  SporeLabelShare sum[SAMPLES * SPORE_LABEL_MOST], shares[SPORE_LABEL_MOST];
  SporeVec3 middle = {0, 0, 0};
  int labels = 0;
  for (int k = 0; k < 4; k++) middle = spore_vec3_add_scaled(middle, 0.25, corner[k]);
  for (int s = 0; s < SAMPLES; s++) {
    SporeVec3 p = s ? spore_vec3_scale(0.5, spore_vec3_add(middle, corner[s - 1])) : middle;
    int count = spore_label_field_shares(field, p, shares);
    for (int i = 0; i < count; i++) labels = spore_label_add(sum, labels, shares[i]);
  }
  return spore_label_winner(sum, labels);
}

/* Labels all cells, CELLS_A_CUBE for each cube. *count: number of labels above 0. */
static bool label_cells(const Lattice *l, const SporeLabelField *field, uint16_t *labels, size_t *count,
                        const SporeProgress *progress, SporeError *error) {
  *count = 0;
  for (size_t k = 0; k < l->n[2]; k++)
    for (size_t j = 0; j < l->n[1]; j++) {
      if (!spore_progress_step(progress, ((double)k + (double)j / (double)l->n[1]) / (double)l->n[2],
                               _("labelling cells"), error))
        return false;
      for (size_t i = 0; i < l->n[0]; i++)
        for (int q = 0; q < CELLS_A_CUBE; q++) {
          const size_t cube[3] = {i, j, k};
          size_t node[4];
          SporeVec3 corner[4];
          uint16_t *label = &labels[CELLS_A_CUBE * cube_index(l, cube) + (size_t)q];
          if (!cell_nodes(l, cube, q, node)) continue;
          for (int c = 0; c < 4; c++) corner[c] = node_place(l, node[c]);
          *label = spore_label_of_cell(field, corner);
          *count += *label > 0;
        }
    }
  return true;
}

/* Makes the mesh of the labelled cells. `number`: scratch, one for each node. */
static bool build(const Lattice *l, const uint16_t *labels, size_t count, uint32_t *number, SporeTetrahedralMesh *mesh,
                  SporeError *error) {
  size_t nodes = corner_count(l) + cube_count(l), used = 0, at = 0, node[4];
  uint32_t *cells = SPORE_NEW_ARRAY(uint32_t, 4 * count);
  for (int pass = 0; cells && pass < 2; pass++) {
    for (size_t c = 0, cell = 0; c < cube_count(l); c++) {
      const size_t cube[3] = {c % l->n[0], c / l->n[0] % l->n[1], c / l->n[0] / l->n[1]};
      for (int q = 0; q < CELLS_A_CUBE; q++, cell++) {
        if (!labels[cell] || !cell_nodes(l, cube, q, node)) continue;
        for (int k = 0; k < 4; k++) {
          if (pass == 0) number[node[k]] = 1;
          else cells[4 * at + (size_t)k] = number[node[k]] - 1;
        }
        at += pass;
      }
    }
    for (size_t i = 0; pass == 0 && i < nodes; i++)
      if (number[i]) number[i] = (uint32_t)++used;
  }
  bool done = cells && spore_tetrahedral_mesh_allocate(mesh, used, count, error);
  if (done) {
    mesh->labels = SPORE_NEW_ARRAY(uint32_t, count);
    done = mesh->labels != NULL;
    memcpy(mesh->tetrahedra, cells, 4 * count * sizeof *cells);
  }
  at = 0;
  for (size_t cell = 0; done && cell < CELLS_A_CUBE * cube_count(l); cell++)
    if (labels[cell]) mesh->labels[at++] = labels[cell];
  for (size_t i = 0; done && i < nodes; i++)
    if (number[i]) spore_vec3_store(mesh->vertices + 3 * (size_t)(number[i] - 1), node_place(l, i));
  spore_free(cells);
  return done || spore_generate_no_memory(error);
}

bool spore_label_lattice(const SporeLabelField *field, const double lower[3], const double upper[3], double edge,
                         SporeTetrahedralMesh *mesh, size_t *count, const SporeProgress *progress, SporeError *error) {
  Lattice l = {.edge = edge};
  double cubes = 1;
  for (int k = 0; k < 3; k++) {
    double n = ceil((upper[k] - lower[k]) / edge) + 3;
    cubes *= n;
    if (cubes > (double)MOST_CUBES) break;
    l.n[k] = (size_t)n;
    l.lower[k] = 0.5 * (lower[k] + upper[k] - n * edge);
  }
  if (cubes > (double)MOST_CUBES)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("so fine a lattice has over %zu cubes around the organs; expected fewer; ask for fewer or "
                             "larger cells, or crop the volume"),
                           MOST_CUBES);
  uint16_t *labels = SPORE_NEW_ARRAY(uint16_t, CELLS_A_CUBE * cube_count(&l));
  uint32_t *number = mesh ? SPORE_NEW_ARRAY(uint32_t, corner_count(&l) + cube_count(&l)) : NULL;
  bool done = labels && (number || !mesh);
  if (!done) spore_generate_no_memory(error);
  done = done && label_cells(&l, field, labels, count, progress, error) &&
         (!mesh || build(&l, labels, *count, number, mesh, error));
  spore_free(labels);
  spore_free(number);
  return done;
}
