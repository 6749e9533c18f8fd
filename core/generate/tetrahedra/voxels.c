/* Isosurface stuffing (Labelle and Shewchuk 2007, "Isosurface stuffing: fast tetrahedral meshes with good dihedral
 * angles"). A body-centred cubic lattice of tetrahedra is cut at the boundary of the solid; nodes near the surface
 * first move onto the surface. With the snapping shares of lattice.c the paper proves dihedral angles of 10.7 to 164.8
 * degrees for any solid. So the method needs only the winding number of the surface. The diagonal of a four-sided face
 * depends only on data that both cells at the face share: the lengths of the face's edges, and the parity of nodes. */
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/tetrahedra/lattice.h"
#include "core/mesh/common.h"

typedef struct {
  SporeBcc *lattice;
  const SporeTetrahedraWork *work;
  SporeTetrahedralMesh *mesh;
  size_t vertex_room, cell_room;
} Stuffing;

/* A corner of a lattice cell. */
typedef struct {
  SporeBccNode node;
  int8_t value;
} Corner;

static bool add_vertex(Stuffing *stuffing, SporeVec3 p, uint32_t *number) {
  SporeTetrahedralMesh *mesh = stuffing->mesh;
  double *vertices =
      spore_room_for_one(mesh->vertices, mesh->vertex_count, &stuffing->vertex_room, 1024, 3 * sizeof *vertices);
  if (!vertices) return false;
  mesh->vertices = vertices;
  spore_vec3_store(mesh->vertices + 3 * mesh->vertex_count, p);
  *number = (uint32_t)mesh->vertex_count++;
  return true;
}

static bool add_cell(Stuffing *stuffing, uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
  SporeTetrahedralMesh *mesh = stuffing->mesh;
  uint32_t *cells =
      spore_room_for_one(mesh->tetrahedra, mesh->tetrahedron_count, &stuffing->cell_room, 4096, 4 * sizeof *cells);
  if (!cells) return false;
  mesh->tetrahedra = cells;
  const double *v = mesh->vertices;
  bool turned = spore_vec3_volume(spore_mesh_vertex(v, a), spore_mesh_vertex(v, b), spore_mesh_vertex(v, c),
                                  spore_mesh_vertex(v, d)) < 0;
  uint32_t *corner = mesh->tetrahedra + 4 * mesh->tetrahedron_count++;
  corner[0] = a, corner[1] = turned ? c : b, corner[2] = turned ? b : c, corner[3] = d;
  return true;
}

static bool node_vertex(Stuffing *stuffing, SporeBccNode node, uint32_t *number) {
  uint32_t *known = stuffing->lattice->vertex + spore_bcc_index(stuffing->lattice, node);
  if (!*known) {
    if (!add_vertex(stuffing, spore_bcc_place(stuffing->lattice, node), number)) return false;
    *known = *number + 1;
  }
  *number = *known - 1;
  return true;
}

static int way_to(SporeBccNode from, SporeBccNode to) {
  int n = 0;
  while (spore_bcc_steps[n][0] != to.x - from.x || spore_bcc_steps[n][1] != to.y - from.y ||
         spore_bcc_steps[n][2] != to.z - from.z)
    n++;
  return n;
}

/* The vertex for the end `to` of the edge from a node inside: the cut of the edge, or the node itself if it is inside
 * or on the surface. */
static bool end_vertex(Stuffing *stuffing, SporeBccNode inside, const Corner *to, uint32_t *number) {
  if (to->value >= 0) return node_vertex(stuffing, to->node, number);
  SporeBccCut *cut = spore_bcc_cut(stuffing->lattice, stuffing->work, inside, way_to(inside, to->node));
  if (!cut) return false;
  if (!cut->vertex) {
    SporeVec3 a = spore_bcc_place(stuffing->lattice, inside), b = spore_bcc_place(stuffing->lattice, to->node);
    if (!add_vertex(stuffing, spore_vec3_add_scaled(a, cut->share, spore_vec3_sub(b, a)), number)) return false;
    cut->vertex = *number + 1;
  }
  *number = cut->vertex - 1;
  return true;
}

/* An edge along an axis, between two nodes of the same parity. */
static bool is_long(const Corner *a, const Corner *b) { return ((a->node.z ^ b->node.z) & 1) == 0; }

/* Whether `a` is the even end of a long edge; the other end is odd. */
static bool is_even(const Corner *a, const Corner *b) {
  int32_t along = a->node.x != b->node.x ? a->node.x : a->node.y != b->node.y ? a->node.y : a->node.z;
  return (along >> 1 & 1) == 0;
}

/* Three cells of a prism with the sides low[i]-high[i]. The diagonal of each four-sided face runs from low of the side
 * earlier in `order` to high of the later side. */
static bool add_prism(Stuffing *stuffing, const uint32_t low[3], const uint32_t high[3], const int order[3]) {
  int a = order[0], b = order[1], c = order[2];
  return add_cell(stuffing, low[a], low[b], low[c], high[c]) && add_cell(stuffing, low[a], low[b], high[b], high[c]) &&
         add_cell(stuffing, low[a], high[a], high[b], high[c]);
}

/* Three corners inside, d outside. */
static bool stuff_three(Stuffing *stuffing, const Corner in[3], const Corner *d) {
  uint32_t low[3], high[3];
  int last = 0, order[3];
  for (int i = 0; i < 3; i++) {
    if (!node_vertex(stuffing, in[i].node, low + i) || !end_vertex(stuffing, in[i].node, d, high + i)) return false;
    if (is_long(in + i, d)) last = i;
  }
  int b = (last + 1) % 3, c = (last + 2) % 3;
  bool even = is_even(in + b, in + c);
  order[0] = even ? b : c, order[1] = even ? c : b, order[2] = last;
  return add_prism(stuffing, low, high, order);
}

/* a and b inside, c and d outside. */
static bool stuff_two(Stuffing *stuffing, const Corner *a, const Corner *b, const Corner *c, const Corner *d) {
  uint32_t low[3], high[3];
  if (!is_long(a, b) && !is_long(a, c)) {
    const Corner *kept = c;
    c = d, d = kept;
  }
  if (!node_vertex(stuffing, a->node, low) || !node_vertex(stuffing, b->node, high) ||
      !end_vertex(stuffing, a->node, c, low + 1) || !end_vertex(stuffing, b->node, c, high + 1) ||
      !end_vertex(stuffing, a->node, d, low + 2) || !end_vertex(stuffing, b->node, d, high + 2))
    return false;
  static const int even[3] = {0, 1, 2}, odd[3] = {1, 2, 0}, across[3] = {1, 0, 2};
  return add_prism(stuffing, low, high, !is_long(a, b) ? across : is_even(a, b) ? even : odd);
}

/* a and b inside, c outside, z on the surface. */
static bool stuff_two_on(Stuffing *stuffing, const Corner *a, const Corner *b, const Corner *c, const Corner *z) {
  uint32_t va, vb, vz, cut_a, cut_b;
  if (!node_vertex(stuffing, a->node, &va) || !node_vertex(stuffing, b->node, &vb) ||
      !node_vertex(stuffing, z->node, &vz) || !end_vertex(stuffing, a->node, c, &cut_a) ||
      !end_vertex(stuffing, b->node, c, &cut_b))
    return false;
  bool from_a = is_long(a, b) ? is_even(a, b) : is_long(b, c); /* the diagonal runs from a to b's cut */
  if (from_a) return add_cell(stuffing, va, vb, cut_b, vz) && add_cell(stuffing, va, cut_b, cut_a, vz);
  return add_cell(stuffing, va, vb, cut_a, vz) && add_cell(stuffing, vb, cut_b, cut_a, vz);
}

/* Adds the part of a lattice cell that is inside. */
static bool stuff_cell(Stuffing *stuffing, const SporeBccNode nodes[4]) {
  Corner corner[4]; /* sorted: inside, on the surface, outside */
  int inside = 0, count = 0, outside = 0;
  for (int value = 1; value >= -1; value--)
    for (int i = 0; i < 4; i++) {
      int8_t found = stuffing->lattice->value[spore_bcc_index(stuffing->lattice, nodes[i])];
      if (found != value) continue;
      corner[count++] = (Corner){nodes[i], found};
      inside += value > 0, outside += value < 0;
    }
  if (!inside) return true;
  if (outside && inside == 3) return stuff_three(stuffing, corner, corner + 3);
  if (outside == 2 && inside == 2) return stuff_two(stuffing, corner, corner + 1, corner + 2, corner + 3);
  if (outside && inside == 2) return stuff_two_on(stuffing, corner, corner + 1, corner + 3, corner + 2);
  uint32_t v[4];
  for (int i = 0; i < 4; i++)
    if (!(i < inside ? node_vertex(stuffing, corner[i].node, v + i)
                     : end_vertex(stuffing, corner->node, corner + i, v + i)))
      return false;
  return add_cell(stuffing, v[0], v[1], v[2], v[3]);
}

/* Adds the cells around the edge from `node` along an axis. Each cell of the lattice is added once, at its edge along
 * the earlier axis. The four nodes around the edge are of the other parity. */
static bool stuff_edge(Stuffing *stuffing, SporeBccNode node, int axis) {
  static const int8_t around[2][4][3] = {{{1, 1, 1}, {1, -1, 1}, {1, -1, -1}, {1, 1, -1}},
                                         {{1, 1, 1}, {-1, 1, 1}, {-1, 1, -1}, {1, 1, -1}}};
  SporeBccNode nodes[4] = {node, spore_bcc_neighbour(node, 2 * axis)};
  if (!spore_bcc_has(stuffing->lattice, nodes[1])) return true;
  for (int i = 0; i < 4; i++) {
    const int8_t *p = around[axis][i], *q = around[axis][(i + 1) % 4];
    if (axis == 1 && p[2] == q[2]) continue; /* has an edge along x: added there */
    nodes[2] = (SporeBccNode){node.x + p[0], node.y + p[1], node.z + p[2]};
    nodes[3] = (SporeBccNode){node.x + q[0], node.y + q[1], node.z + q[2]};
    if (!spore_bcc_has(stuffing->lattice, nodes[2]) || !spore_bcc_has(stuffing->lattice, nodes[3])) continue;
    if (!stuff_cell(stuffing, nodes)) return false;
  }
  return true;
}

static bool stuff(Stuffing *stuffing, const SporeTetrahedraWork *work, SporeError *error) {
  const SporeBcc *lattice = stuffing->lattice;
  for (size_t z = 0; z < lattice->layers; z++) {
    if (!spore_tetrahedra_progress(work, 0.8 + 0.2 * (double)z / (double)lattice->layers, _("filling a lattice"),
                                   error))
      return false;
    for (size_t y = 0; y < lattice->rows; y++)
      for (size_t x = 0; x < lattice->columns; x++) {
        int32_t kind = (int32_t)(z & 1);
        SporeBccNode node = {(int32_t)(2 * x) + kind, (int32_t)(2 * y) + kind, (int32_t)z};
        if (!stuff_edge(stuffing, node, 0) || !stuff_edge(stuffing, node, 1)) return spore_mesh_no_memory(error);
      }
  }
  return true;
}

bool spore_tetrahedra_stuff(SporeTetrahedraWork *work, double edge, SporeTetrahedralMesh *mesh, SporeError *error) {
  *mesh = (SporeTetrahedralMesh){0};
  SporeBcc lattice;
  if (!spore_bcc_create(&lattice, work, edge, error)) return false;
  Stuffing stuffing = {.lattice = &lattice, .work = work, .mesh = mesh};
  bool done = stuff(&stuffing, work, error);
  work->filled_by_method = lattice.filled;
  spore_bcc_clear(&lattice);
  if (!done) spore_tetrahedral_mesh_clear(mesh);
  return done;
}
