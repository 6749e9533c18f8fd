/* The closed surface of one label out of the net of all. */
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/labels/nets.h"
#include "core/mesh/half_edges.h"
#include "core/mesh/sort.h"

/* Corner 4 f + c is corner c of the label's face f, in the order in which the face is seen from outside the label. */
typedef struct Label {
  const SporeLabelNet *net;
  const uint32_t *own;
  size_t count; /* faces */
  uint16_t label;
  uint32_t *parent; /* 4 a face: sets of corners that are one vertex */
  uint64_t *edge;   /* 4 a face: the side from a corner to the next */
  uint32_t *side;   /* 4 a face */
} Label;

static uint32_t node_of(const Label *l, uint32_t corner) {
  const SporeLabelFace *face = &l->net->faces[l->own[corner / 4]];
  const uint32_t c = corner % 4;
  return face->node[face->label[0] == l->label ? c : (4 - c) % 4];
}

static uint32_t after(uint32_t corner) { return corner % 4 == 3 ? corner - 3 : corner + 1; }

/* Four times the middle of the voxel of the label that has the face. */
static void inner_voxel(const Label *l, uint32_t face, int64_t middle[3]) {
  const SporeLabelFace *of = &l->net->faces[l->own[face]];
  const uint32_t *first = l->net->corner + 3 * (size_t)of->node[0], *third = l->net->corner + 3 * (size_t)of->node[2];
  for (size_t k = 0; k < 3; k++) {
    middle[k] = 2 * ((int64_t)first[k] + third[k]);
    if (first[k] == third[k]) middle[k] += of->label[0] == l->label ? -2 : 2;
  }
}

static bool same_voxel(const Label *l, uint32_t a, uint32_t b) {
  int64_t one[3], other[3];
  inner_voxel(l, a / 4, one);
  inner_voxel(l, b / 4, other);
  return memcmp(one, other, sizeof one) == 0;
}

/* The two triangles' sides at an edge are one: so are the corners at its ends. */
static void join(const Label *l, uint32_t a, uint32_t b) {
  spore_set_join(l->parent, a, after(b));
  spore_set_join(l->parent, after(a), b);
}

/* Joins the faces at each edge; where two voxels of the label touch along the edge alone, each voxel's two. */
static bool join_faces(Label *l) {
  const size_t corners = 4 * l->count;
  for (uint32_t c = 0; c < corners; c++) {
    const uint64_t a = node_of(l, c), b = node_of(l, after(c));
    l->edge[c] = a < b ? a << 32 | b : b << 32 | a;
    l->side[c] = l->parent[c] = c;
  }
  if (!spore_sort_keys(l->edge, l->side, corners)) return false;
  for (size_t i = 0, end; i < corners; i = end) {
    const uint32_t *side = l->side + i;
    for (end = i + 1; end < corners && l->edge[end] == l->edge[i];) end++;
    const size_t mate = end - i == 2 || same_voxel(l, side[0], side[1]) ? 1 : same_voxel(l, side[0], side[2]) ? 2 : 3;
    join(l, side[0], side[mate]);
    if (end - i == 4) join(l, side[mate == 1 ? 2 : 1], side[mate == 3 ? 2 : 3]);
  }
  return true;
}

static SporeVec3 place_of(const SporeLabelNet *net, uint32_t node) {
  const uint32_t *corner = net->corner + 3 * (size_t)node;
  const float *moved = net->moved + 3 * (size_t)node;
  return spore_vec3(corner[0] - 0.5 + (double)moved[0], corner[1] - 0.5 + (double)moved[1],
                    corner[2] - 0.5 + (double)moved[2]);
}

/* Cuts each face along its shorter diagonal, which is the same seen from either label. */
static void cut_faces(const Label *l, const uint32_t *number, uint32_t *triangles) {
  for (uint32_t f = 0; f < l->count; f++, triangles += 6) {
    SporeVec3 p[4];
    uint32_t n[4];
    for (uint32_t c = 0; c < 4; c++) {
      p[c] = place_of(l->net, node_of(l, 4 * f + c));
      n[c] = number[spore_set_find(l->parent, 4 * f + c)];
    }
    const size_t from = spore_vec3_distance(p[0], p[2]) <= spore_vec3_distance(p[1], p[3]) ? 0 : 1;
    const uint32_t two[6] = {n[from], n[from + 1], n[from + 2], n[from], n[from + 2], n[(from + 3) % 4]};
    memcpy(triangles, two, sizeof two);
  }
}

static bool build(const Label *l, SporeTriangleMesh *surface, SporeError *error) {
  uint32_t *number = l->side, vertices = 0; /* the sides are no longer needed */
  for (uint32_t c = 0; c < 4 * l->count; c++)
    if (spore_set_find(l->parent, c) == c) number[c] = vertices++;
  if (!spore_triangle_mesh_allocate(surface, vertices, 2 * l->count, error)) return false;
  for (uint32_t c = 0; c < 4 * l->count; c++)
    if (l->parent[c] == c) spore_vec3_store(surface->vertices + 3 * (size_t)number[c], place_of(l->net, node_of(l, c)));
  cut_faces(l, number, surface->triangles);
  return true;
}

bool spore_label_net_surface(const SporeLabelNet *net, uint16_t label, const uint32_t *own, size_t count,
                             SporeTriangleMesh *surface, SporeError *error) {
  if (2 * count > SPORE_MESH_MAXIMUM)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the surface has over %u triangles; expected fewer; halve the volume's resolution"),
                           SPORE_MESH_MAXIMUM);
  Label l = {.net = net,
             .own = own,
             .count = count,
             .label = label,
             .parent = SPORE_NEW_ARRAY(uint32_t, 4 * count),
             .edge = SPORE_NEW_ARRAY(uint64_t, 4 * count),
             .side = SPORE_NEW_ARRAY(uint32_t, 4 * count)};
  bool done = (l.parent && l.edge && l.side && join_faces(&l)) || spore_generate_no_memory(error);
  done = done && build(&l, surface, error);
  spore_free(l.parent);
  spore_free(l.edge);
  spore_free(l.side);
  return done;
}
