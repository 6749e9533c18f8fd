/* Pieces that are kept apart, made plainer where few cells cannot show them: islands of a piece go to the piece around
 * them, and pieces that are too thin to the piece that they touch most. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"
#include "core/mesh/half_edges.h"

#define LABELS (SPORE_TETRAHEDRA_PIECES + 1)

static SporeVec3 corner_of(const SporeTetrahedralMesh *mesh, size_t cell, size_t k) {
  return spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * cell + k]);
}

static double volume_of(const SporeTetrahedralMesh *mesh, size_t c) {
  return fabs(spore_vec3_volume(corner_of(mesh, c, 0), corner_of(mesh, c, 1), corner_of(mesh, c, 2),
                                corner_of(mesh, c, 3))) /
         6;
}

static double face_area(const SporeTetrahedralMesh *mesh, size_t c, size_t k) {
  const uint8_t *face = spore_tetrahedron_faces[k];
  return spore_vec3_length(
      spore_mesh_area_vector(corner_of(mesh, c, face[0]), corner_of(mesh, c, face[1]), corner_of(mesh, c, face[2])));
}

/* The label beyond a face; 0: none. */
static uint32_t label_across(const SporeTetrahedralMesh *mesh, uint32_t cell) {
  return cell == UINT32_MAX ? 0 : mesh->labels[cell];
}

/* Cells of one label that hang together by faces. */
typedef struct Island {
  double volume, bound[LABELS]; /* bound: area of the faces to each label; 0: to none */
  uint32_t label;
} Island;

/* Numbers the islands: island_of, one a cell. set: cells, for the search. */
static size_t find_islands(const SporeTetrahedralMesh *mesh, const uint32_t *across, uint32_t *set, size_t *island_of) {
  const size_t cells = mesh->tetrahedron_count;
  size_t count = 0;
  for (size_t c = 0; c < cells; c++) set[c] = (uint32_t)c;
  for (size_t i = 0; i < 4 * cells; i++)
    if (across[i] != UINT32_MAX && mesh->labels[across[i]] == mesh->labels[i / 4])
      spore_set_join(set, (uint32_t)(i / 4), across[i]);
  for (size_t c = 0; c < cells; c++) {
    const uint32_t root = spore_set_find(set, (uint32_t)c); /* the least member */
    island_of[c] = root == c ? count++ : island_of[root];
  }
  return count;
}

/* most: of each label, the volume of its largest island. */
static void measure_islands(const SporeTetrahedralMesh *mesh, const uint32_t *across, const size_t *island_of,
                            Island *islands, double most[LABELS]) {
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
    Island *island = islands + island_of[c];
    island->label = mesh->labels[c];
    island->volume += volume_of(mesh, c);
    for (size_t k = 0; k < 4; k++) {
      const uint32_t label = label_across(mesh, across[4 * c + k]);
      if (label != island->label) island->bound[label] += face_area(mesh, c, k);
    }
    most[island->label] = fmax(most[island->label], island->volume);
  }
}

/* The label other than 0 with the largest area; 0: there is none. */
static uint32_t touched_most(const double bound[LABELS]) {
  uint32_t most = 0;
  for (uint32_t label = 1; label < LABELS; label++)
    if (bound[label] > (most ? bound[most] : 0)) most = label;
  return most;
}

bool spore_tetrahedra_join_islands(SporeTetrahedralMesh *mesh, double least, SporeError *error) {
  const size_t cells = mesh->tetrahedron_count;
  uint32_t *across = NULL, *set = SPORE_NEW_ARRAY(uint32_t, cells);
  size_t *island_of = SPORE_NEW_ARRAY(size_t, cells);
  Island *islands = NULL;
  double most[LABELS] = {0};
  bool done = set && island_of && spore_tetrahedral_mesh_neighbours(mesh, &across);
  done = done && (islands = SPORE_NEW_ARRAY(Island, find_islands(mesh, across, set, island_of)));
  if (done) measure_islands(mesh, across, island_of, islands, most);
  for (size_t c = 0; done && c < cells; c++) {
    const Island *island = islands + island_of[c];
    const bool small = island->volume < least && island->volume < most[island->label];
    const uint32_t to = small ? touched_most(island->bound) : 0;
    if (to) mesh->labels[c] = to;
  }
  spore_free(islands);
  spore_free(island_of);
  spore_free(set);
  spore_free(across);
  return done || spore_mesh_no_memory(error);
}

/* What the cells of a label fill. */
typedef struct Place {
  size_t cells;
  double volume, area, bound[LABELS]; /* bound: as of an island */
} Place;

static double thickness_of(const Place *place) { return place->area > 0 ? 4 * place->volume / place->area : 0; }

static bool measure(const SporeTetrahedralMesh *mesh, Place places[LABELS], SporeError *error) {
  uint32_t *across = NULL;
  if (!spore_tetrahedral_mesh_neighbours(mesh, &across)) return spore_mesh_no_memory(error);
  for (size_t i = 0; i < 4 * mesh->tetrahedron_count; i++) {
    Place *place = places + mesh->labels[i / 4];
    const uint32_t label = label_across(mesh, across[i]);
    if (i % 4 == 0) place->cells++, place->volume += volume_of(mesh, i / 4);
    if (label == mesh->labels[i / 4]) continue;
    const double area = face_area(mesh, i / 4, i % 4);
    place->area += area, place->bound[label] += area;
  }
  spore_free(across);
  return true;
}

bool spore_tetrahedra_measure_places(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, SporeError *error) {
  Place places[LABELS] = {0};
  if (!measure(mesh, places, error)) return false;
  for (size_t i = 0; i < work->piece_count; i++)
    if (places[i + 1].volume > 0) work->piece[i].thickness = thickness_of(places + i + 1);
  return true;
}

/* Gives the cells of a piece to another one, and forgets the borders between these. */
static void merge(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, uint32_t label, uint32_t to) {
  size_t kept = 0;
  for (size_t c = 0; c < mesh->tetrahedron_count; c++)
    if (mesh->labels[c] == label) mesh->labels[c] = to;
  for (size_t i = 0; i < work->border_count; i++) {
    uint32_t *sides = work->border_sides + 2 * i;
    for (int k = 0; k < 2; k++)
      if (sides[k] == label) sides[k] = to;
    if (sides[0] == sides[1]) continue;
    memmove(work->border_sides + 2 * kept, sides, 2 * sizeof *sides);
    memmove(work->borders + 3 * kept++, work->borders + 3 * i, 3 * sizeof *work->borders);
  }
  work->border_count = kept;
  for (size_t i = 0; i < work->piece_count; i++)
    if (i + 1 == label || work->piece[i].merged == (int)label - 1) work->piece[i].merged = (int)to - 1;
}

/* Of the labels that are thin and touch another one, the one with most cells beyond those of that edge that its volume
 * has room for; 0: there is none. */
static uint32_t costliest(const SporeTetrahedraWork *work, const Place places[LABELS], double edge) {
  uint32_t found = 0;
  double most = 0;
  for (uint32_t label = 1; label <= work->piece_count; label++) {
    const Place *place = places + label;
    const double beyond = (double)place->cells - place->volume / (SPORE_TETRAHEDRA_CELL * pow(edge, 3));
    if (work->piece[label - 1].thickness > SPORE_TETRAHEDRA_THIN * edge || !(beyond > most)) continue;
    if (touched_most(place->bound)) found = label, most = beyond;
  }
  return found;
}

bool spore_tetrahedra_merge_thin(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, double edge, bool *merged,
                                 SporeError *error) {
  Place places[LABELS] = {0};
  if (!measure(mesh, places, error)) return false;
  const uint32_t label = costliest(work, places, edge);
  *merged = label != 0;
  if (!label) return true;
  const uint32_t other = touched_most(places[label].bound);
  const bool larger = places[label].volume > places[other].volume; /* the smaller of the two goes */
  merge(work, mesh, larger ? other : label, larger ? label : other);
  return true;
}
