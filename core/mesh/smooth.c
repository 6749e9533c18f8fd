/* Smooths a surface and keeps the volume of each closed piece. */
#include <math.h>
#include <string.h>

#include "core/base/text.h"
#include "core/mesh/common.h"
#include "core/mesh/edit.h"
#include "core/mesh/half_edges.h"

#define LAMBDA 0.5
#define MU (-0.53)
#define VOLUME_ROUNDS 12
#define VOLUME_TOLERANCE 1e-10 /* of the volume */
#define LOST 0.01              /* of the volume: a piece further off was too thin for so many rounds */
#define SPIKY 1.2              /* of the area: a piece with more area was too thin as well */

/* The pairs of vertices that attract each other: those on an edge. A vertex on an open edge is attracted along open
 * edges only, so that a rim does not shrink into the surface. */
typedef struct Smoothing {
  SporeTriangleMesh *mesh;
  uint32_t *edges; /* edge_count x 2 */
  bool *open_edge; /* edge_count */
  size_t edge_count;
  bool *open;       /* vertex_count: on an open edge */
  uint32_t *degree; /* vertex_count: number of neighbours that attract the vertex */
  double *pull;     /* vertex_count x 3 */
  double *normals;  /* vertex_count x 3 */
  double *before;   /* vertex_count x 3: to go back to when cancelled */
} Smoothing;

static bool collect_edges(Smoothing *s) {
  SporeHalfEdges halves;
  if (!spore_half_edges_create(&halves, s->mesh->triangles, s->mesh->triangle_count)) return false;
  s->edges = SPORE_NEW_ARRAY(uint32_t, 2 * halves.count);
  s->open_edge = SPORE_NEW_ARRAY(bool, halves.count);
  bool done = s->edges && s->open_edge;
  for (size_t i = 0, end; done && i < halves.count; i = end) {
    end = spore_half_edges_end(&halves, i);
    uint32_t a = (uint32_t)(halves.edge[i] >> 32), b = (uint32_t)halves.edge[i];
    s->edges[2 * s->edge_count] = a, s->edges[2 * s->edge_count + 1] = b;
    s->open_edge[s->edge_count++] = end - i == 1;
    if (end - i == 1) s->open[a] = s->open[b] = true;
  }
  spore_half_edges_clear(&halves);
  return done;
}

static bool pulls(const Smoothing *s, size_t edge, uint32_t vertex) { return !s->open[vertex] || s->open_edge[edge]; }

static void count_neighbours(Smoothing *s) {
  for (size_t e = 0; e < s->edge_count; e++)
    for (int k = 0; k < 2; k++) s->degree[s->edges[2 * e + k]] += pulls(s, e, s->edges[2 * e + k]);
}

/* x += factor (mean of the neighbours - x) */
static void diffuse(Smoothing *s, double factor) {
  double *x = s->mesh->vertices;
  memset(s->pull, 0, 3 * s->mesh->vertex_count * sizeof(double));
  for (size_t e = 0; e < s->edge_count; e++) {
    uint32_t a = s->edges[2 * e], b = s->edges[2 * e + 1];
    SporeVec3 ab = spore_vec3_sub(spore_mesh_vertex(x, b), spore_mesh_vertex(x, a));
    if (pulls(s, e, a)) spore_vec3_accumulate(s->pull + 3 * (size_t)a, ab);
    if (pulls(s, e, b)) spore_vec3_accumulate(s->pull + 3 * (size_t)b, spore_vec3_scale(-1, ab));
  }
  for (size_t i = 0; i < s->mesh->vertex_count; i++)
    if (s->degree[i])
      spore_vec3_accumulate(x + 3 * i,
                            spore_vec3_scale(factor / (double)s->degree[i], spore_vec3_load(s->pull + 3 * i)));
}

/* Volume of a piece, computed about its first corner so that a distant piece loses no digits; and the derivative of the
 * volume, m^2, when all its vertices move along their normals. */
typedef struct Piece {
  SporeVec3 origin;
  double wanted, volume, growth, area, area_before;
  bool open, started;
} Piece;

static void measure(const Smoothing *s, const uint32_t *pieces, const double *normals, Piece *piece, size_t count) {
  for (size_t p = 0; p < count; p++) piece[p].volume = piece[p].growth = piece[p].area = 0, piece[p].started = false;
  for (size_t t = 0; t < s->mesh->triangle_count; t++) {
    const uint32_t *v = s->mesh->triangles + 3 * t;
    Piece *to = piece + pieces[t];
    SporeVec3 a = spore_mesh_vertex(s->mesh->vertices, v[0]), b = spore_mesh_vertex(s->mesh->vertices, v[1]),
              c = spore_mesh_vertex(s->mesh->vertices, v[2]);
    if (!to->started) to->origin = a, to->started = true;
    SporeVec3 area = spore_mesh_area_vector(a, b, c);
    to->area += spore_vec3_length(area);
    for (int k = 0; k < 3; k++) to->growth += spore_vec3_dot(area, spore_mesh_vertex(normals, v[k])) / 3;
    to->volume += spore_vec3_dot(spore_vec3_sub(a, to->origin),
                                 spore_vec3_cross(spore_vec3_sub(b, to->origin), spore_vec3_sub(c, to->origin))) /
                  6;
    for (int k = 0; k < 3; k++) to->open |= s->open[v[k]];
  }
}

static void measure_anew(Smoothing *s, const uint32_t *pieces, Piece *piece, size_t count) {
  spore_triangle_mesh_normals(s->mesh->vertices, s->mesh->vertex_count, s->mesh->triangles, s->mesh->triangle_count,
                              s->normals);
  measure(s, pieces, s->normals, piece, count);
}

/* Moves the vertices of each closed piece along their normals until it has its volume back (Newton). A vertex that
 * pieces share takes the step of the last of them. */
static bool restore_volumes(Smoothing *s, const uint32_t *pieces, Piece *piece, size_t count) {
  size_t n = s->mesh->vertex_count;
  double *step = SPORE_NEW_ARRAY(double, n);
  bool off = step != NULL;
  for (int round = 0; off && round < VOLUME_ROUNDS; round++) {
    measure_anew(s, pieces, piece, count);
    off = false;
    for (size_t t = 0; t < s->mesh->triangle_count; t++) {
      const Piece *of = piece + pieces[t];
      double wanting = of->wanted - of->volume;
      bool moves = !of->open && of->growth > 0 && fabs(wanting) > VOLUME_TOLERANCE * fabs(of->wanted);
      off |= moves;
      for (int k = 0; k < 3; k++) step[s->mesh->triangles[3 * t + (size_t)k]] = moves ? wanting / of->growth : 0;
    }
    for (size_t i = 0; i < n; i++)
      spore_vec3_accumulate(s->mesh->vertices + 3 * i, spore_vec3_scale(step[i], spore_vec3_load(s->normals + 3 * i)));
  }
  bool done = step != NULL;
  spore_free(step);
  return done;
}

/* Takes back the smoothing of a closed piece that has collapsed: its volume is not restored, or its area has increased.
 */
static void take_back_lost(Smoothing *s, const uint32_t *pieces, Piece *piece, size_t count) {
  measure_anew(s, pieces, piece, count);
  for (size_t t = 0; t < s->mesh->triangle_count; t++) {
    const Piece *of = piece + pieces[t];
    bool sound = fabs(of->wanted - of->volume) <= LOST * fabs(of->wanted) && of->area <= SPIKY * of->area_before;
    if (sound || of->open) continue;
    for (size_t k = 0; k < 3; k++) {
      size_t v = 3 * (size_t)s->mesh->triangles[3 * t + k];
      memcpy(s->mesh->vertices + v, s->before + v, 3 * sizeof(double));
    }
  }
}

static bool run(Smoothing *s, size_t rounds, const SporeProgress *progress, SporeError *error) {
  uint32_t *pieces;
  size_t count;
  if (!spore_triangle_mesh_pieces(s->mesh, &pieces, &count, error)) return false;
  Piece *piece = SPORE_NEW_ARRAY(Piece, count);
  bool done = piece != NULL || spore_mesh_no_memory(error);
  if (done) measure_anew(s, pieces, piece, count);
  for (size_t p = 0; done && p < count; p++) piece[p].wanted = piece[p].volume, piece[p].area_before = piece[p].area;
  for (size_t i = 0; done && i < rounds; i++) {
    done = spore_progress_step(progress, (double)i / (double)rounds, _("smoothing"), error);
    diffuse(s, LAMBDA);
    diffuse(s, MU);
  }
  done = done && (restore_volumes(s, pieces, piece, count) || spore_mesh_no_memory(error));
  if (done) take_back_lost(s, pieces, piece, count);
  spore_free(piece);
  spore_free(pieces);
  return done;
}

bool spore_triangle_mesh_smooth(SporeTriangleMesh *mesh, size_t rounds, const SporeProgress *progress,
                                SporeError *error) {
  size_t n = mesh->vertex_count;
  if (!n || !mesh->triangle_count) return true;
  Smoothing s = {.mesh = mesh,
                 .open = SPORE_NEW_ARRAY(bool, n),
                 .degree = SPORE_NEW_ARRAY(uint32_t, n),
                 .pull = SPORE_NEW_ARRAY(double, 3 * n),
                 .normals = SPORE_NEW_ARRAY(double, 3 * n),
                 .before = SPORE_NEW_ARRAY(double, 3 * n)};
  bool ready = s.open && s.degree && s.pull && s.normals && s.before && collect_edges(&s), done = false;
  if (ready) {
    memcpy(s.before, mesh->vertices, 3 * n * sizeof(double));
    count_neighbours(&s);
    done = run(&s, rounds, progress, error);
    if (!done) memcpy(mesh->vertices, s.before, 3 * n * sizeof(double));
  } else spore_mesh_no_memory(error);
  spore_free(s.edges);
  spore_free(s.open_edge);
  spore_free(s.open);
  spore_free(s.degree);
  spore_free(s.pull);
  spore_free(s.normals);
  spore_free(s.before);
  return done;
}
