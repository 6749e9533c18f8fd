/* Pieces that are kept apart: each cell of a lattice is given to the piece that has its place, so that cells of two
 * pieces share faces. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define BESIDE 1e-4 /* of the diagonal: distance from a surface at which the pieces on its sides are looked up */
#define SPIKE_ROUNDS 3
#define ISLAND 1 /* wanted cells: smaller islands of a piece are given to the piece around them */
#define LOST 2   /* edges of the lattice: a point farther from all borders of the cells has none */
#define CELLS_A_REPORT 1024

typedef struct Parting {
  SporeTetrahedraWork *work;
  SporeBvh *tree[SPORE_TETRAHEDRA_PIECES]; /* of each piece */
} Parting;

/* Edge of a cell as large as the wanted ones. */
static double wanted_edge(const SporeTetrahedraWork *work) {
  const SporeTetrahedraOptions *options = &work->options;
  return options->cells ? cbrt(work->volume / (SPORE_TETRAHEDRA_CELL * (double)options->cells)) : options->size;
}

/* A wall inside another piece that is nowhere deeper than a cell is a second wall of that piece, and has no cells. */
static void choose_pieces(SporeTetrahedraWork *work) {
  const double edge = wanted_edge(work);
  for (size_t i = 0; i < work->piece_count; i++) {
    SporeTetrahedraPiece *piece = work->piece + i;
    const bool inner = piece->role == SPORE_PIECE_INSIDE && piece->in >= 0 && piece->depth[1] > edge;
    piece->parted = piece->role == SPORE_PIECE_BOUNDS || piece->role == SPORE_PIECE_MERGED || inner;
  }
}

/* 1 + the piece of the least area around a place; 0: there is none. */
static uint32_t piece_around(const Parting *parting, SporeVec3 p) {
  for (size_t i = parting->work->piece_count; i-- > 0;)
    if (parting->work->piece[i].parted && spore_bvh_inside(parting->tree[i], p)) return (uint32_t)(i + 1);
  return 0;
}

/* 1 + the nearest piece: of cells beyond the surface, in thin walls and at holes that are closed. */
static uint32_t nearest_piece(const Parting *parting, SporeVec3 p) {
  uint32_t nearest = 1;
  double least = HUGE_VAL;
  for (size_t i = 0; i < parting->work->piece_count; i++) {
    if (!parting->work->piece[i].parted) continue;
    const double distance = spore_bvh_distance(parting->tree[i], p, NULL, NULL);
    if (distance < least) least = distance, nearest = (uint32_t)(i + 1);
  }
  return nearest;
}

static bool label_cells(const Parting *parting, SporeTetrahedralMesh *mesh, SporeError *error) {
  mesh->labels = SPORE_NEW_ARRAY(uint32_t, mesh->tetrahedron_count);
  if (!mesh->labels) return spore_mesh_no_memory(error);
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
    SporeVec3 middle = {0, 0, 0};
    if (c % CELLS_A_REPORT == 0 && !spore_tetrahedra_progress(parting->work, 1, _("looking at the pieces"), error))
      return false;
    for (size_t k = 0; k < 4; k++)
      middle = spore_vec3_add_scaled(middle, 0.25, spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * c + k]));
    mesh->labels[c] = piece_around(parting, middle);
    if (!mesh->labels[c]) mesh->labels[c] = nearest_piece(parting, middle);
  }
  return true;
}

/* The label that at least two of the neighbours have, other than the cell's own, where one of own label is left at
 * most; else the cell's own. */
static uint32_t smoother(const SporeTetrahedralMesh *mesh, const uint32_t *across, size_t cell) {
  const uint32_t own = mesh->labels[cell];
  uint32_t label[4];
  int inner = 0, alike = 0;
  for (size_t k = 0; k < 4; k++) {
    label[k] = across[4 * cell + k] == UINT32_MAX ? 0 : mesh->labels[across[4 * cell + k]];
    inner += label[k] != 0;
    alike += label[k] == own;
  }
  for (size_t k = 0; k < 4; k++) {
    int same = 0;
    for (size_t n = 0; n < 4; n++) same += label[n] == label[k];
    if (label[k] && label[k] != own && alike <= 1 && same >= 2 && same == inner - alike) return label[k];
  }
  return own;
}

/* Cells that stick out into another piece are given to that piece. */
static bool remove_spikes(SporeTetrahedralMesh *mesh, SporeError *error) {
  uint32_t *across;
  if (!spore_tetrahedral_mesh_neighbours(mesh, &across)) return spore_mesh_no_memory(error);
  for (int round = 0; round < SPIKE_ROUNDS; round++)
    for (size_t c = 0; c < mesh->tetrahedron_count; c++) mesh->labels[c] = smoother(mesh, across, c);
  spore_free(across);
  return true;
}

/* Keeps the inner points of the surface that have different pieces on their two sides. */
static bool find_borders(const Parting *parting, SporeError *error) {
  SporeTetrahedraWork *work = parting->work;
  work->borders = SPORE_NEW_ARRAY(double, 3 * work->inner_count);
  work->border_sides = SPORE_NEW_ARRAY(uint32_t, 2 * work->inner_count);
  if (!work->borders || !work->border_sides) return spore_mesh_no_memory(error);
  for (size_t i = 0; i < work->inner_count; i++) {
    const SporeVec3 p = spore_vec3_load(work->inner + 3 * i);
    uint32_t triangle = 0;
    spore_bvh_distance(work->tree, p, NULL, &triangle);
    const uint32_t *n = work->surface.triangles + 3 * (size_t)triangle;
    const double *v = work->surface.vertices;
    const SporeVec3 normal = spore_vec3_normalise(
        spore_mesh_area_vector(spore_mesh_vertex(v, n[0]), spore_mesh_vertex(v, n[1]), spore_mesh_vertex(v, n[2])),
        spore_vec3(0, 0, 0));
    const uint32_t behind = piece_around(parting, spore_vec3_add_scaled(p, -BESIDE, normal)),
                   before = piece_around(parting, spore_vec3_add_scaled(p, BESIDE, normal));
    if (!behind || !before || behind == before) continue;
    work->border_sides[2 * work->border_count] = behind, work->border_sides[2 * work->border_count + 1] = before;
    spore_vec3_store(work->borders + 3 * work->border_count++, p);
  }
  return true;
}

/* Leaves out points that no border of the cells is near: a piece is too thin for the lattice there. Such a point would
 * let other borders move as far. */
static bool drop_lost_borders(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error) {
  const double near = LOST * cbrt(work->volume / (SPORE_TETRAHEDRA_CELL * (double)mesh->tetrahedron_count));
  SporeTriangleMesh borders = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  const size_t all = work->border_count;
  if (!all) return true;
  if (!spore_tetrahedral_mesh_borders(mesh, &borders.triangles, &borders.triangle_count, error)) return false;
  SporeBvh *tree = borders.triangle_count ? spore_bvh_create(&borders, error) : NULL;
  const bool done = tree || !borders.triangle_count;
  work->border_count = 0;
  for (size_t i = 0; tree && i < all; i++) {
    const SporeVec3 p = spore_vec3_load(work->borders + 3 * i);
    const size_t to = work->border_count;
    if (spore_bvh_distance(tree, p, NULL, NULL) > near) continue;
    spore_vec3_store(work->borders + 3 * to, p);
    memmove(work->border_sides + 2 * to, work->border_sides + 2 * i, 2 * sizeof *work->border_sides);
    work->border_count++;
  }
  work->border_lost = 1 - (double)work->border_count / (double)all;
  spore_bvh_free(tree);
  spore_free(borders.triangles);
  return done;
}

bool spore_tetrahedra_part(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error) {
  Parting parting = {.work = work};
  choose_pieces(work);
  const bool done =
      spore_tetrahedra_piece_trees(work, parting.tree, error) && find_borders(&parting, error) &&
      label_cells(&parting, mesh, error) && remove_spikes(mesh, error) &&
      spore_tetrahedra_join_islands(mesh, ISLAND * SPORE_TETRAHEDRA_CELL * pow(wanted_edge(work), 3), error) &&
      drop_lost_borders(work, mesh, error);
  for (size_t i = 0; i < SPORE_TETRAHEDRA_PIECES; i++) spore_bvh_free(parting.tree[i]);
  return done;
}

bool spore_tetrahedra_measure_parted(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh,
                                     SporeTetrahedraReport *report, SporeError *error) {
  SporeTriangleMesh borders = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  report->border_lost = work->border_lost;
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) work->piece[mesh->labels[c] - 1].cells++;
  if (!spore_tetrahedral_mesh_borders(mesh, &borders.triangles, &borders.triangle_count, error)) return false;
  report->shared_faces = borders.triangle_count;
  SporeBvh *tree = borders.triangle_count ? spore_bvh_create(&borders, error) : NULL;
  for (size_t i = 0; tree && i < work->border_count; i++)
    report->border_distance =
        fmax(report->border_distance, spore_bvh_distance(tree, spore_vec3_load(work->borders + 3 * i), NULL, NULL));
  const bool done = tree || !borders.triangle_count;
  spore_bvh_free(tree);
  spore_free(borders.triangles);
  return done;
}
