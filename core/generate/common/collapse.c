/* Conditions under which an edge collapse keeps the topology: Dey, Edelsbrunner, Guha and Nekhayev 1999, "Topology
 * preserving edge contraction", for the cells and for the faces between labels. */
#include "core/generate/common/collapse.h"

#include <math.h>
#include <string.h>

#include "core/mesh/common.h"

#define MOST_TURN 0.3 /* least cosine between a face's normals before and after */

static const uint32_t *cell_of(const SporeCollapse *c, uint32_t cell) {
  return c->stars->mesh->tetrahedra + 4 * (size_t)cell;
}

static bool has(const uint32_t *corners, int count, uint32_t v) {
  for (int k = 0; k < count; k++)
    if (corners[k] == v) return true;
  return false;
}

static SporeVec3 place_of(const SporeCollapse *c, uint32_t v) { return spore_mesh_vertex(c->stars->mesh->vertices, v); }

bool spore_collapse_create(SporeCollapse *c, SporeError *error) {
  c->touched = SPORE_NEW_ARRAY(bool, c->stars->mesh->tetrahedron_count);
  c->mark = SPORE_NEW_ARRAY(uint32_t, c->stars->mesh->vertex_count);
  c->ring_mark = SPORE_NEW_ARRAY(uint32_t, c->stars->mesh->vertex_count);
  return (c->touched && c->mark && c->ring_mark) || spore_mesh_no_memory(error);
}

void spore_collapse_clear(SporeCollapse *c) {
  spore_free(c->touched);
  spore_free(c->mark);
  spore_free(c->ring_mark);
  c->touched = NULL, c->mark = c->ring_mark = NULL;
}

/* Collects the cells that are removed and the cells that change; false: too many, or touched before. */
static bool gather_cells(SporeCollapse *c, uint32_t a, uint32_t b) {
  const SporeStars *stars = c->stars;
  c->dying_count = c->changed_count = 0;
  if (stars->first[a + 1] - stars->first[a] > SPORE_COLLAPSE_CELLS ||
      stars->first[b + 1] - stars->first[b] > SPORE_COLLAPSE_CELLS)
    return false;
  for (int side = 0; side < 2; side++) {
    uint32_t v = side ? b : a, other = side ? a : b;
    for (size_t i = stars->first[v]; i < stars->first[v + 1]; i++) {
      uint32_t cell = stars->cells[i];
      if (c->touched[cell]) return false;
      if (!has(cell_of(c, cell), 4, other)) c->changed[c->changed_count++] = cell;
      else if (!side) c->dying[c->dying_count++] = cell;
    }
  }
  return c->dying_count > 0;
}

/* Whether a label could be left with fewer cells than it keeps. */
static bool takes_too_many(const SporeCollapse *c) {
  for (size_t i = 0; c->kept && i < c->dying_count; i++) {
    const uint32_t label = c->stars->mesh->labels[c->dying[i]];
    if (c->left[label] < c->kept[label] + c->dying_count) return true;
  }
  return false;
}

static void mark_neighbours(SporeCollapse *c, uint32_t *mark, uint32_t v, bool skin) {
  size_t begin = skin ? c->skin->first[v] : c->stars->first[v],
         end = skin ? c->skin->first[v + 1] : c->stars->first[v + 1];
  for (size_t i = begin; i < end; i++) {
    const uint32_t *corner = skin ? c->skin->corners + 3 * (size_t)c->skin->faces[i] : cell_of(c, c->stars->cells[i]);
    for (int k = 0; k < (skin ? 3 : 4); k++) mark[corner[k]] = c->stamp;
  }
}

/* The number of vertices marked in both, each counted once: `mark` is cleared for each of them. */
static size_t count_common(SporeCollapse *c, uint32_t v, bool skin, uint32_t not_a, uint32_t not_b) {
  size_t begin = skin ? c->skin->first[v] : c->stars->first[v],
         end = skin ? c->skin->first[v + 1] : c->stars->first[v + 1];
  size_t count = 0;
  for (size_t i = begin; i < end; i++) {
    const uint32_t *corner = skin ? c->skin->corners + 3 * (size_t)c->skin->faces[i] : cell_of(c, c->stars->cells[i]);
    for (int k = 0; k < (skin ? 3 : 4); k++) {
      uint32_t x = corner[k];
      if (x == not_a || x == not_b || c->mark[x] != c->stamp) continue;
      c->mark[x] = 0;
      count++;
    }
  }
  return count;
}

/* The link condition for vertices: the vertices next to both ends are exactly those of the cells at the edge. */
static bool vertices_allow(SporeCollapse *c, uint32_t a, uint32_t b) {
  size_t ring = 0;
  c->stamp++;
  for (size_t i = 0; i < c->dying_count; i++)
    for (int k = 0; k < 4; k++) {
      uint32_t x = cell_of(c, c->dying[i])[k];
      if (x == a || x == b || c->ring_mark[x] == c->stamp) continue;
      c->ring_mark[x] = c->stamp;
      ring++;
    }
  mark_neighbours(c, c->mark, a, false);
  return count_common(c, b, false, a, b) == ring;
}

static bool is_dying(const SporeCollapse *c, uint32_t x, uint32_t y) {
  for (size_t i = 0; i < c->dying_count; i++)
    if (has(cell_of(c, c->dying[i]), 4, x) && has(cell_of(c, c->dying[i]), 4, y)) return true;
  return false;
}

static bool has_triangle(const SporeCollapse *c, uint32_t v, uint32_t x, uint32_t y) {
  for (size_t i = c->stars->first[v]; i < c->stars->first[v + 1]; i++)
    if (has(cell_of(c, c->stars->cells[i]), 4, x) && has(cell_of(c, c->stars->cells[i]), 4, y)) return true;
  return false;
}

/* The link condition for triangles: two triangles, one at each end, coincide after the collapse only if they belong
 * to a cell at the edge. */
static bool triangles_allow(const SporeCollapse *c, uint32_t a, uint32_t b) {
  for (size_t i = 0; i < c->changed_count; i++) {
    const uint32_t *corner = cell_of(c, c->changed[i]);
    if (!has(corner, 4, a)) continue;
    for (int k = 0; k < 4; k++)
      for (int l = 0; l < k; l++) {
        uint32_t x = corner[k], y = corner[l];
        if (c->ring_mark[x] != c->stamp || c->ring_mark[y] != c->stamp) continue;
        if (!is_dying(c, x, y) && has_triangle(c, b, x, y)) return false;
      }
  }
  return true;
}

/* Whether a face at a would coincide with one at b: no cell would be left between them. */
static bool leaves_nothing(const SporeCollapse *c, uint32_t a, uint32_t b) {
  const SporeSkin *skin = c->skin;
  for (size_t i = skin->first[a]; i < skin->first[a + 1]; i++) {
    const uint32_t *face = skin->corners + 3 * (size_t)skin->faces[i];
    if (has(face, 3, b)) continue;
    for (size_t j = skin->first[b]; j < skin->first[b + 1]; j++) {
      const uint32_t *other = skin->corners + 3 * (size_t)skin->faces[j];
      int shared = 0;
      if (has(other, 3, a)) continue;
      for (int k = 0; k < 3; k++) shared += has(other, 3, face[k]);
      if (shared == 2) return true;
    }
  }
  return false;
}

/* The link condition on the skin: the vertices that are next to both ends on the skin are exactly those of its faces
 * at the edge. */
static bool skin_allows(SporeCollapse *c, uint32_t a, uint32_t b) {
  size_t wings = 0;
  c->face_count = 0;
  for (int side = 0; side < 2; side++)
    for (size_t i = c->skin->first[side ? b : a]; i < c->skin->first[(side ? b : a) + 1]; i++) {
      uint32_t face = c->skin->faces[i];
      bool both = has(c->skin->corners + 3 * (size_t)face, 3, side ? a : b);
      if (both && side) continue;
      if (c->face_count == SPORE_COLLAPSE_FACES) return false;
      wings += both;
      c->face[c->face_count++] = face;
    }
  if (!wings) return true;
  if (leaves_nothing(c, a, b)) return false;
  c->stamp++;
  mark_neighbours(c, c->mark, a, true);
  return count_common(c, b, true, a, b) == wings;
}

static bool same_sides(const uint32_t *a, int a_count, const uint32_t *b, int b_count) {
  return a_count == b_count && a_count <= SPORE_SKIN_SIDES && !memcmp(a, b, (size_t)a_count * sizeof *a);
}

/* Which ends may be removed: an end that lies between the same labels as the edge. */
static void sides_allow(const SporeCollapse *c, uint32_t a, uint32_t b, bool *a_goes, bool *b_goes) {
  uint32_t of_a[SPORE_SKIN_SIDES], of_b[SPORE_SKIN_SIDES], of_edge[SPORE_SKIN_SIDES];
  int na = spore_skin_sides(c->skin, a, UINT32_MAX, of_a), nb = spore_skin_sides(c->skin, b, UINT32_MAX, of_b),
      ne = spore_skin_sides(c->skin, a, b, of_edge);
  *a_goes = same_sides(of_a, na, of_edge, ne);
  *b_goes = same_sides(of_b, nb, of_edge, ne);
}

static double quality_at(const SporeCollapse *c, uint32_t a, uint32_t b, SporeVec3 p) {
  double least = 180;
  for (size_t i = 0; i < c->changed_count && least >= c->floor; i++) {
    const uint32_t *cell = cell_of(c, c->changed[i]);
    SporeVec3 corner[4];
    for (int k = 0; k < 4; k++) corner[k] = cell[k] == a || cell[k] == b ? p : place_of(c, cell[k]);
    least = fmin(least, spore_tetrahedron_quality(corner));
  }
  return least;
}

/* The remaining faces, with the edge's vertex at p; false: a face would turn over. */
static bool face_places(const SporeCollapse *c, uint32_t a, uint32_t b, SporeVec3 p, double (*corners)[9],
                        uint32_t *kept, size_t *count) {
  *count = 0;
  for (size_t i = 0; i < c->face_count; i++) {
    const uint32_t *corner = c->skin->corners + 3 * (size_t)c->face[i];
    if (has(corner, 3, a) && has(corner, 3, b)) continue;
    SporeVec3 before[3], after[3];
    for (int k = 0; k < 3; k++) {
      before[k] = place_of(c, corner[k]);
      after[k] = corner[k] == a || corner[k] == b ? p : before[k];
      spore_vec3_store(corners[*count] + 3 * k, after[k]);
    }
    SporeVec3 n = spore_mesh_area_vector(before[0], before[1], before[2]),
              m = spore_mesh_area_vector(after[0], after[1], after[2]);
    if (spore_vec3_dot(n, m) < MOST_TURN * spore_vec3_length(n) * spore_vec3_length(m)) return false;
    kept[(*count)++] = c->face[i];
  }
  return *count > 0;
}

/* Largest distance of the points of these faces from the remaining faces; stores the new hosts. HUGE_VAL: not below
 * `limit`. */
static double points_off(SporeCollapse *c, double (*corners)[9], const uint32_t *kept, size_t kept_count,
                         double limit) {
  const SporeSkin *skin = c->skin;
  double most = 0;
  size_t at = 0;
  for (size_t i = 0; i < c->face_count; i++) {
    const uint32_t *sides = skin->sides + 2 * (size_t)c->face[i];
    for (size_t j = skin->first_point[c->face[i]]; j < skin->first_point[c->face[i] + 1]; j++, at++) {
      if (at == SPORE_COLLAPSE_POINTS) return HUGE_VAL;
      SporeVec3 p = spore_vec3_load(c->points->places + 3 * (size_t)skin->points[j]);
      double least = HUGE_VAL;
      for (size_t k = 0; k < kept_count; k++) {
        if (memcmp(skin->sides + 2 * (size_t)kept[k], sides, 2 * sizeof *sides)) continue;
        SporeVec3 gap = spore_vec3_sub(p, spore_triangle_nearest(p, corners[k]));
        double squared = spore_vec3_dot(gap, gap);
        if (squared < least) least = squared, c->host[at] = kept[k];
      }
      most = fmax(most, sqrt(least));
      if (most >= limit) return HUGE_VAL;
    }
  }
  return most;
}

static double faces_off(const SporeCollapse *c, double (*corners)[9], size_t count, double limit) {
  double most = 0;
  for (size_t k = 0; k < count && most < limit; k++) {
    SporeVec3 middle = {0, 0, 0};
    for (int i = 0; i < 3; i++) middle = spore_vec3_add_scaled(middle, 1.0 / 3, spore_vec3_load(corners[k] + 3 * i));
    most = fmax(most, spore_bvh_distance(c->surface, middle, NULL, NULL));
  }
  return most < limit ? most : HUGE_VAL;
}

/* Largest distance of the skin with the edge's vertex at p; HUGE_VAL: the vertex cannot be there. */
static double cost_at(SporeCollapse *c, uint32_t a, uint32_t b, SporeVec3 p, double limit) {
  double corners[SPORE_COLLAPSE_FACES][9];
  uint32_t kept[SPORE_COLLAPSE_FACES];
  size_t count;
  if (quality_at(c, a, b, p) < c->floor) return HUGE_VAL;
  if (!c->face_count) return 0;
  if (!face_places(c, a, b, p, corners, kept, &count)) return HUGE_VAL;
  double most = points_off(c, corners, kept, count, limit);
  if (most < limit && c->surface) most = fmax(most, faces_off(c, corners, count, limit));
  return most < limit ? most : HUGE_VAL;
}

static void settle_hosts(SporeCollapse *c, uint32_t a, uint32_t b) {
  size_t at = 0;
  for (size_t i = 0; i < c->face_count; i++)
    for (size_t j = c->skin->first_point[c->face[i]]; j < c->skin->first_point[c->face[i] + 1]; j++, at++) {
      const uint32_t *corner = c->skin->corners + 3 * (size_t)c->best_host[at];
      for (int k = 0; k < 3; k++)
        c->points->hosts[3 * (size_t)c->skin->points[j] + (size_t)k] = corner[k] == a ? b : corner[k];
    }
}

/* Removes vertex a and moves b to p. */
static void perform(SporeCollapse *c, uint32_t a, uint32_t b, SporeVec3 p) {
  SporeTetrahedralMesh *mesh = c->stars->mesh;
  settle_hosts(c, a, b);
  spore_vec3_store(mesh->vertices + 3 * (size_t)b, p);
  for (size_t i = 0; i < c->changed_count; i++) {
    uint32_t *corner = mesh->tetrahedra + 4 * (size_t)c->changed[i];
    for (int k = 0; k < 4; k++)
      if (corner[k] == a) corner[k] = b;
    c->touched[c->changed[i]] = true;
  }
  for (size_t i = 0; i < c->dying_count; i++) {
    mesh->tetrahedra[4 * (size_t)c->dying[i]] = UINT32_MAX;
    if (c->kept) c->left[mesh->labels[c->dying[i]]]--;
    c->touched[c->dying[i]] = true;
  }
}

/* Largest present distance of the points of the faces around the edge. */
static double off_now(const SporeCollapse *c) {
  double most = 0;
  for (size_t i = 0; i < c->face_count; i++)
    for (size_t j = c->skin->first_point[c->face[i]]; j < c->skin->first_point[c->face[i] + 1]; j++)
      most = fmax(most, c->points->off[c->skin->points[j]]);
  return most;
}

bool spore_collapse_edge(SporeCollapse *c, uint32_t a, uint32_t b) {
  bool a_goes, b_goes;
  if (!gather_cells(c, a, b) || takes_too_many(c)) return false;
  sides_allow(c, a, b, &a_goes, &b_goes);
  if ((!a_goes && !b_goes) || !vertices_allow(c, a, b) || !triangles_allow(c, a, b) || !skin_allows(c, a, b))
    return false;
  SporeVec3 pa = place_of(c, a), pb = place_of(c, b), middle = spore_vec3_scale(0.5, spore_vec3_add(pa, pb));
  if (c->face_count && c->surface) spore_bvh_distance(c->surface, middle, &middle, NULL);
  const SporeVec3 places[4] = {middle, pa, pb, spore_vec3_scale(0.5, spore_vec3_add(pa, pb))};
  const bool allowed[4] = {a_goes && b_goes, b_goes, a_goes,
                           a_goes && b_goes && c->face_count && c->surface && c->stars->labels};
  double best = fmax(c->limit, off_now(c) * (1 + 1e-9));
  int choice = -1;
  for (int i = 0; i < 3 + (choice < 0); i++) { /* of a border, the middle off the surface too */
    double cost = allowed[i] ? cost_at(c, a, b, places[i], best) : HUGE_VAL;
    if (!(cost < best)) continue;
    best = cost, choice = i;
    memcpy(c->best_host, c->host, sizeof c->host);
    if (!c->face_count) break;
  }
  if (choice < 0) return false;
  if (choice == 1 || (choice == 0 && !a_goes)) perform(c, b, a, places[choice]);
  else perform(c, a, b, places[choice]);
  return true;
}
