/* Edge and face flips (Freitag and Ollivier-Gooch 1997, "Tetrahedral mesh improvement using swapping and
 * smoothing"): the cells around an edge are replaced by the best others that fill the same ring (Klincsek 1980), and
 * two cells at a face by three around the edge across it. Each flip raises the least angle of the cells that it
 * changes. */
#include <math.h>
#include <string.h>

#include "core/generate/common/stars.h"
#include "core/mesh/common.h"

#define RING 8    /* cells around an edge at most */
#define GAIN 1e-3 /* degrees by which a flip must raise the least angle */
#define GONE UINT32_MAX
#define FLAT 0.1 /* of the cube of its longest edge: six times the largest volume of a boundary sliver */

typedef struct {
  SporeStars *stars;
  bool *touched;   /* of cells that existed at the beginning */
  uint32_t *made;  /* new cells, 4 corners each */
  uint32_t *label; /* of new cells */
  size_t made_count, made_room, cell_count;
  bool no_memory;
} Flips;

static double quality_of(const Flips *flips, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  const double *v = flips->stars->mesh->vertices;
  SporeVec3 corner[4] = {spore_mesh_vertex(v, a), spore_mesh_vertex(v, b), spore_mesh_vertex(v, c),
                         spore_mesh_vertex(v, d)};
  return spore_tetrahedron_quality(corner);
}

static bool has(const uint32_t cell[4], uint32_t v) {
  return cell[0] == v || cell[1] == v || cell[2] == v || cell[3] == v;
}

static uint32_t label_of(const Flips *flips, uint32_t cell) {
  return flips->stars->labels ? flips->stars->labels[cell] : 0;
}

static void make(Flips *flips, uint32_t a, uint32_t b, uint32_t c, uint32_t d, uint32_t label) {
  if (flips->made_count == flips->made_room) {
    size_t room = 2 * flips->made_room + 256;
    uint32_t *made = spore_reallocate(flips->made, 4 * flips->made_room, 4 * room, sizeof *made);
    if (made) flips->made = made;
    uint32_t *labels = made ? spore_reallocate(flips->label, flips->made_room, room, sizeof *labels) : NULL;
    if (labels) flips->label = labels;
    flips->no_memory = flips->no_memory || !made || !labels;
    if (flips->no_memory) return;
    flips->made_room = room;
  }
  memcpy(flips->made + 4 * flips->made_count, (const uint32_t[4]){a, b, c, d}, 4 * sizeof(uint32_t));
  flips->label[flips->made_count++] = label;
}

static void drop(Flips *flips, uint32_t cell) {
  flips->touched[cell] = true;
  flips->stars->mesh->tetrahedra[4 * (size_t)cell] = GONE;
}

/* The cells around the edge a-b in order, counter-clockwise about a to b, and the vertices between them. 0: the edge
 * is on the boundary, the ring is too long, some cell was touched, or labels differ. */
static int ring_of(const Flips *flips, uint32_t a, uint32_t b, uint32_t cells[RING], uint32_t ring[RING]) {
  const SporeStars *stars = flips->stars;
  uint32_t from[RING], to[RING], found[RING];
  int count = 0;
  for (size_t i = stars->first[a]; i < stars->first[a + 1]; i++) {
    const uint32_t *cell = stars->mesh->tetrahedra + 4 * (size_t)stars->cells[i];
    if (flips->touched[stars->cells[i]]) return 0;
    if (!has(cell, b)) continue;
    uint32_t others[2];
    int n = 0;
    for (int k = 0; k < 4; k++)
      if (cell[k] != a && cell[k] != b) others[n++] = cell[k];
    if (count == RING ||
        label_of(flips, stars->cells[i]) != (count ? label_of(flips, found[0]) : label_of(flips, stars->cells[i])))
      return 0;
    bool turned = quality_of(flips, a, b, others[0], others[1]) < 0;
    found[count] = stars->cells[i], from[count] = others[turned], to[count++] = others[!turned];
  }
  if (count < 3) return 0;
  int at = 0;
  for (int i = 0; i < count; i++) {
    cells[i] = found[at], ring[i] = from[at];
    int next = 0;
    while (next < count && from[next] != to[at]) next++;
    if (next == count) return 0;
    at = next;
  }
  return at == 0 ? count : 0;
}

/* The best triangulation of a ring. Each triangle makes two cells with the ends of the edge. choice[i][j]: the third
 * corner of the triangle on the side i-j. */
static double best_filling(const Flips *flips, uint32_t a, uint32_t b, const uint32_t *ring, int n,
                           int choice[RING][RING]) {
  double best[RING][RING];
  for (int i = 0; i + 1 < n; i++) best[i][i + 1] = 180;
  for (int span = 2; span < n; span++)
    for (int i = 0; i + span < n; i++) {
      int j = i + span;
      best[i][j] = -2;
      for (int k = i + 1; k < j; k++) {
        double q = fmin(best[i][k], best[k][j]);
        if (q <= best[i][j]) continue;
        q = fmin(q, quality_of(flips, ring[i], ring[k], ring[j], b));
        if (q > best[i][j]) q = fmin(q, quality_of(flips, ring[i], ring[j], ring[k], a));
        if (q > best[i][j]) best[i][j] = q, choice[i][j] = k;
      }
    }
  return best[0][n - 1];
}

static void fill_ring(Flips *flips, uint32_t a, uint32_t b, const uint32_t *ring, int i, int j, uint32_t label,
                      int choice[RING][RING]) {
  if (j - i < 2) return;
  int k = choice[i][j];
  make(flips, ring[i], ring[k], ring[j], b, label);
  make(flips, ring[i], ring[j], ring[k], a, label);
  fill_ring(flips, a, b, ring, i, k, label, choice);
  fill_ring(flips, a, b, ring, k, j, label, choice);
}

static bool remove_edge(Flips *flips, uint32_t a, uint32_t b) {
  uint32_t cells[RING], ring[RING];
  int choice[RING][RING], n = ring_of(flips, a, b, cells, ring);
  if (!n) return false;
  double before = 180;
  for (int i = 0; i < n; i++) before = fmin(before, flips->stars->quality[cells[i]]);
  if (best_filling(flips, a, b, ring, n, choice) < before + GAIN) return false;
  uint32_t label = label_of(flips, cells[0]);
  for (int i = 0; i < n; i++) drop(flips, cells[i]);
  fill_ring(flips, a, b, ring, 0, n - 1, label, choice);
  return true;
}

/* The other cell at a face; GONE: there is none that may be changed. */
static uint32_t across(const Flips *flips, uint32_t cell, uint32_t a, uint32_t b, uint32_t c) {
  const SporeStars *stars = flips->stars;
  for (size_t i = stars->first[a]; i < stars->first[a + 1]; i++) {
    uint32_t other = stars->cells[i];
    const uint32_t *corner = stars->mesh->tetrahedra + 4 * (size_t)other;
    if (other == cell || flips->touched[other] || !has(corner, a) || !has(corner, b) || !has(corner, c)) continue;
    return label_of(flips, other) == label_of(flips, cell) ? other : GONE;
  }
  return GONE;
}

/* faces[f]: counter-clockwise seen from corner f, which is above. */
static const uint8_t faces[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};

static bool remove_face(Flips *flips, uint32_t cell, int f) {
  const uint32_t *corner = flips->stars->mesh->tetrahedra + 4 * (size_t)cell;
  uint32_t ring[3] = {corner[faces[f][0]], corner[faces[f][1]], corner[faces[f][2]]}, d = corner[f];
  uint32_t other = across(flips, cell, ring[0], ring[1], ring[2]);
  if (other == GONE) return false;
  const uint32_t *beyond = flips->stars->mesh->tetrahedra + 4 * (size_t)other;
  uint32_t e = GONE;
  for (int k = 0; k < 4; k++)
    if (beyond[k] != ring[0] && beyond[k] != ring[1] && beyond[k] != ring[2]) e = beyond[k];
  double before = fmin(flips->stars->quality[cell], flips->stars->quality[other]) + GAIN;
  for (int i = 0; i < 3; i++)
    if (quality_of(flips, e, d, ring[i], ring[(i + 1) % 3]) < before) return false;
  uint32_t label = label_of(flips, cell);
  drop(flips, cell);
  drop(flips, other);
  for (int i = 0; i < 3; i++) make(flips, e, d, ring[i], ring[(i + 1) % 3], label);
  return true;
}

/* Removes a flat cell with two faces on the boundary, if the boundary remains a surface: the edge between the other
 * two faces was inside. */
static bool remove_sliver(Flips *flips, uint32_t cell) {
  const SporeTetrahedralMesh *mesh = flips->stars->mesh;
  const uint32_t *corner = mesh->tetrahedra + 4 * (size_t)cell;
  int inner[4], count = 0;
  for (int f = 0; f < 4; f++) {
    bool neighbour = false;
    for (size_t i = flips->stars->first[corner[faces[f][0]]]; i < flips->stars->first[corner[faces[f][0]] + 1]; i++) {
      uint32_t other = flips->stars->cells[i];
      const uint32_t *c = mesh->tetrahedra + 4 * (size_t)other;
      if (flips->touched[other]) return false;
      neighbour = neighbour || (other != cell && has(c, corner[faces[f][1]]) && has(c, corner[faces[f][2]]));
    }
    if (neighbour) inner[count++] = f;
  }
  if (count != 2) return false;
  /* the faces across corners inner[0] and inner[1] share the edge of the other two corners */
  uint32_t ends[2], cells[RING], ring[RING];
  int n = 0;
  for (int k = 0; k < 4; k++)
    if (k != inner[0] && k != inner[1]) ends[n++] = corner[k];
  if (!ring_of(flips, ends[0], ends[1], cells, ring)) return false;
  SporeVec3 p[4];
  double longest = 0;
  for (int k = 0; k < 4; k++) p[k] = spore_mesh_vertex(mesh->vertices, corner[k]);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < i; j++) longest = fmax(longest, spore_vec3_distance(p[i], p[j]));
  if (spore_vec3_volume(p[0], p[1], p[2], p[3]) > FLAT * longest * longest * longest) return false;
  drop(flips, cell);
  return true;
}

/* Removes the dropped cells and appends the new ones. */
static bool settle(Flips *flips, uint32_t **labels) {
  SporeTetrahedralMesh *mesh = flips->stars->mesh;
  size_t kept = 0, total;
  for (size_t t = 0; t < flips->cell_count; t++) {
    if (mesh->tetrahedra[4 * t] == GONE) continue;
    memmove(mesh->tetrahedra + 4 * kept, mesh->tetrahedra + 4 * t, 4 * sizeof(uint32_t));
    if (labels) (*labels)[kept] = (*labels)[t];
    kept++;
  }
  mesh->tetrahedron_count = kept;
  total = kept + flips->made_count;
  if (!flips->made_count) return true;
  uint32_t *cells = spore_reallocate(mesh->tetrahedra, 4 * kept, 4 * total, sizeof *cells);
  uint32_t *grown = labels && cells ? spore_reallocate(*labels, kept, total, sizeof *grown) : NULL;
  if (cells) mesh->tetrahedra = cells;
  if (grown) *labels = grown;
  if (!cells || (labels && !grown)) return false;
  memcpy(cells + 4 * kept, flips->made, 4 * flips->made_count * sizeof *cells);
  if (labels) memcpy(grown + kept, flips->label, flips->made_count * sizeof *grown);
  mesh->tetrahedron_count = total;
  return true;
}

static bool better(Flips *flips, uint32_t cell) {
  uint32_t corner[4];
  memcpy(corner, flips->stars->mesh->tetrahedra + 4 * (size_t)cell, sizeof corner);
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < i; j++)
      if (remove_edge(flips, corner[i], corner[j])) return true;
  for (int f = 0; f < 4; f++)
    if (remove_face(flips, cell, f)) return true;
  return !flips->stars->labels && remove_sliver(flips, cell);
}

long spore_stars_flip(SporeStars *stars, uint32_t **labels, double goal, SporeError *error) {
  size_t count = stars->mesh->tetrahedron_count;
  Flips flips = {.stars = stars, .touched = SPORE_NEW_ARRAY(bool, count), .cell_count = count};
  long done = 0;
  flips.no_memory = !flips.touched;
  for (size_t t = 0; t < count && !flips.no_memory; t++)
    if (stars->quality[t] < goal && !flips.touched[t]) done += better(&flips, (uint32_t)t);
  /* without memory some cells were dropped and not replaced: the mesh is not usable, and the caller gives up */
  if (flips.no_memory || !settle(&flips, labels)) {
    spore_mesh_no_memory(error);
    done = -1;
  }
  spore_free(flips.touched);
  spore_free(flips.made);
  spore_free(flips.label);
  return done;
}
