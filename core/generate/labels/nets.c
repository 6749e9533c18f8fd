/* Nets between labels: faces between voxels, and the smoothing of their corners (Gibson 1998, "Constrained elastic
 * surface nets"). */
#include "core/generate/labels/nets.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"

#define MOST_FACES 30000000 /* with the nodes about 2 GB */
#define ROUNDS 12           /* of smoothing: more move little within the slack */
#define LAMBDA 0.5f
#define MU (-0.53f) /* Taubin 1995: what shrinks is blown up again */
#define NONE UINT32_MAX

/* The corners of the layers below and above a layer of voxels: numbers of nodes, or NONE. */
typedef struct Scan {
  SporeLabelNet *net;
  const SporeLabelMap *map;
  const bool *wanted;
  uint32_t *plane[2];
} Scan;

static size_t corners_of_plane(const SporeLabelMap *map) { return (map->size[0] + 1) * (map->size[1] + 1); }

/* The label at an index that may be one outside; 0: nothing, or not wanted. */
static uint16_t label_at(const Scan *s, int64_t i, int64_t j, int64_t k) {
  const size_t *n = s->map->size;
  if (i < 0 || j < 0 || k < 0 || i >= (int64_t)n[0] || j >= (int64_t)n[1] || k >= (int64_t)n[2]) return 0;
  const uint16_t label = s->map->labels[((size_t)k * n[1] + (size_t)j) * n[0] + (size_t)i];
  return s->wanted[label] ? label : 0;
}

/* The node at a corner; layer: of the corner, k or k + 1 of the voxels at hand. NONE: no memory. */
static uint32_t node_at(Scan *s, size_t i, size_t j, size_t k, size_t above) {
  SporeLabelNet *net = s->net;
  uint32_t *number = &s->plane[(k + above) % 2][j * (s->map->size[0] + 1) + i];
  if (*number != NONE) return *number;
  uint32_t *corners = spore_room_for_one(net->corner, net->node_count, &net->node_capacity, 4096, 3 * sizeof *corners);
  if (!corners) return NONE;
  net->corner = corners;
  uint32_t *corner = corners + 3 * net->node_count;
  corner[0] = (uint32_t)i, corner[1] = (uint32_t)j, corner[2] = (uint32_t)(k + above);
  *number = (uint32_t)net->node_count++;
  return *number;
}

/* Adds the face above voxel (i, j, k) along an axis. at: the lowest corner of the face; one of its indices may be 0. */
static bool add_face(Scan *s, size_t axis, const size_t at[3], size_t layer, uint16_t below, uint16_t above) {
  SporeLabelNet *net = s->net;
  const size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
  SporeLabelFace *faces = spore_room_for_one(net->faces, net->face_count, &net->face_capacity, 4096, sizeof *faces);
  if (!faces) return false;
  net->faces = faces;
  SporeLabelFace *face = &net->faces[net->face_count++];
  face->label[0] = below, face->label[1] = above;
  for (size_t c = 0; c < 4; c++) {
    size_t corner[3] = {at[0], at[1], at[2]};
    corner[u] += c == 1 || c == 2, corner[v] += c >= 2;
    face->node[c] = node_at(s, corner[0], corner[1], layer, corner[2] - layer);
    if (face->node[c] == NONE) return false;
  }
  return true;
}

/* Faces along the three axes that lie above the voxel (i, j, k), whose indices may be -1. */
static bool add_faces(Scan *s, int64_t i, int64_t j, int64_t k) {
  const uint16_t own = label_at(s, i, j, k);
  for (size_t axis = 0; axis < 3; axis++) {
    const int64_t next[3] = {i + (axis == 0), j + (axis == 1), k + (axis == 2)};
    const uint16_t other = label_at(s, next[0], next[1], next[2]);
    if (own == other || next[(axis + 1) % 3] < 0 || next[(axis + 2) % 3] < 0) continue;
    const size_t at[3] = {(size_t)next[0], (size_t)next[1], (size_t)next[2]};
    if (!add_face(s, axis, at, (size_t)MAX(k, 0), own, other)) return false;
  }
  return true;
}

/* Whether a voxel of a row may differ from the next along some axis. */
static bool may_differ(const SporeLabelMap *map, const uint16_t *row, size_t i, bool last_row, bool last_layer) {
  const size_t *n = map->size;
  if (i + 1 == n[0] || last_row || last_layer) return true;
  return row[i] != row[i + 1] || row[i] != row[i + n[0]] || row[i] != row[i + n[0] * n[1]];
}

static bool scan_layer(Scan *s, int64_t k) {
  const size_t *n = s->map->size;
  for (int64_t j = -1; j < (int64_t)n[1]; j++) {
    if (!add_faces(s, -1, j, k)) return false;
    const uint16_t *row = j < 0 || k < 0 ? NULL : s->map->labels + ((size_t)k * n[1] + (size_t)j) * n[0];
    for (size_t i = 0; i < n[0]; i++)
      if ((!row || may_differ(s->map, row, i, (size_t)j + 1 == n[1], (size_t)k + 1 == n[2])) &&
          !add_faces(s, (int64_t)i, j, k))
        return false;
  }
  return true;
}

static bool scan(Scan *s, const SporeProgress *progress, SporeError *error) {
  const size_t layers = s->map->size[2], corners = corners_of_plane(s->map) * sizeof *s->plane[0];
  memset(s->plane[0], 0xff, corners);
  for (int64_t k = -1; k < (int64_t)layers; k++) {
    if (!spore_progress_step(progress, (double)(k + 1) / (double)layers, _("looking for borders"), error)) return false;
    memset(s->plane[(k + 1) % 2], 0xff, k < 0 ? 0 : corners);
    if (!scan_layer(s, k)) return spore_generate_no_memory(error);
    if (s->net->face_count > MOST_FACES)
      return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                             _("the surfaces have over %u faces of voxels; expected fewer; halve the volume's "
                               "resolution, or take fewer labels"),
                             MOST_FACES);
  }
  return true;
}

bool spore_label_net_create(SporeLabelNet *net, const SporeLabelMap *map, const bool *wanted,
                            const SporeProgress *progress, SporeError *error) {
  *net = (SporeLabelNet){0};
  Scan s = {.net = net, .map = map, .wanted = wanted};
  for (int p = 0; p < 2; p++) s.plane[p] = SPORE_NEW_ARRAY(uint32_t, corners_of_plane(map));
  bool done = ((s.plane[0] && s.plane[1]) || spore_generate_no_memory(error)) && scan(&s, progress, error);
  spore_free(s.plane[0]);
  spore_free(s.plane[1]);
  net->moved = done ? SPORE_NEW_ARRAY(float, 3 * net->node_count) : NULL;
  return done && (net->moved || spore_generate_no_memory(error));
}

void spore_label_net_clear(SporeLabelNet *net) {
  spore_free(net->corner);
  spore_free(net->moved);
  spore_free(net->faces);
  *net = (SporeLabelNet){0};
}

/* Adds to each node's sum what its neighbours around a face are away from it. */
static void pull(const SporeLabelNet *net, const SporeLabelFace *face, float *sum, uint8_t *degree) {
  for (size_t c = 0; c < 4; c++) {
    const uint32_t a = face->node[c], b = face->node[(c + 1) % 4];
    for (size_t k = 0; k < 3; k++) {
      const float way = (float)net->corner[3 * (size_t)b + k] - (float)net->corner[3 * (size_t)a + k] +
                        net->moved[3 * (size_t)b + k] - net->moved[3 * (size_t)a + k];
      sum[3 * (size_t)a + k] += way;
      sum[3 * (size_t)b + k] -= way;
    }
    degree[a]++, degree[b]++;
  }
}

/* Moves a node by a share of the mean, and back into its ball. */
static void move(float *moved, const float *sum, float share) {
  float square = 0;
  for (int k = 0; k < 3; k++) {
    moved[k] += share * sum[k];
    square += moved[k] * moved[k];
  }
  const float most = (float)SPORE_LABEL_NET_SLACK, shrink = square > most * most ? most / sqrtf(square) : 1;
  for (int k = 0; k < 3; k++) moved[k] *= shrink;
}

bool spore_label_net_smooth(SporeLabelNet *net, const SporeProgress *progress, SporeError *error) {
  float *sum = SPORE_NEW_ARRAY(float, 3 * net->node_count);
  uint8_t *degree = SPORE_NEW_ARRAY(uint8_t, net->node_count);
  bool done = (sum && degree) || spore_generate_no_memory(error);
  for (int half = 0; done && half < 2 * ROUNDS; half++) {
    done = spore_progress_step(progress, (double)half / (2 * ROUNDS), _("smoothing the surfaces"), error);
    memset(sum, 0, 3 * net->node_count * sizeof *sum);
    memset(degree, 0, net->node_count);
    for (size_t f = 0; f < net->face_count; f++) pull(net, &net->faces[f], sum, degree);
    for (size_t i = 0; i < net->node_count; i++)
      if (degree[i]) move(net->moved + 3 * i, sum + 3 * i, (half % 2 ? MU : LAMBDA) / (float)degree[i]);
  }
  spore_free(sum);
  spore_free(degree);
  return done;
}
