/* What is drawn of tetrahedra after node splitting. A vertex of the surface follows the tetrahedron that holds it. A
 * triangle with corners on both sides of a cut follows one of its tetrahedra as a whole, so that the surface opens
 * along the cut. Faces that were inside are drawn in the colour of raw flesh. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "ui/render/stage_body.h"

#define WIDTH 4 /* nodes that move a vertex */

static const float raw_flesh[3] = {0.36f, 0.045f, 0.035f};

/* The surface as it will be drawn: a row of WIDTH nodes for each vertex. */
typedef struct Draft {
  const SporeStageBody *body;
  const uint32_t *corners;
  gsize count;
  uint32_t *blocks, *triangles;
  uint32_t *twins; /* of each vertex, that of the whole surface */
  double *weights;
} Draft;

static void add_whole_row(Draft *draft, gsize vertex) {
  const SporeMapping *whole = &draft->body->whole_surface;
  const uint32_t *places = draft->body->surface_places;
  guint filled = 0;
  for (uint32_t k = whole->row_start[vertex]; k < whole->row_start[vertex + 1] && filled < WIDTH; k++, filled++) {
    draft->blocks[WIDTH * draft->count + filled] =
        places[k] == UINT32_MAX ? whole->block[k] : draft->corners[places[k]];
    draft->weights[WIDTH * draft->count + filled] = whole->weight[k];
  }
  draft->twins[draft->count++] = (uint32_t)vertex;
}

/* Adds a row with the barycentric coordinates of the vertex in the tetrahedron. */
static void add_row(Draft *draft, gsize vertex, uint32_t tetrahedron) {
  const SporeTetrahedralMesh *cells = draft->body->cells;
  SporeVec3 corner[4], p = spore_vec3_load(draft->body->rest + 3 * vertex);
  for (int k = 0; k < 4; k++)
    corner[k] = spore_vec3_load(cells->vertices + 3 * (gsize)cells->tetrahedra[4 * (gsize)tetrahedron + k]);
  double volume = spore_vec3_volume(corner[0], corner[1], corner[2], corner[3]), rest = 1;
  for (int k = 0; k < 4; k++) {
    SporeVec3 with[4] = {corner[0], corner[1], corner[2], corner[3]};
    with[k] = p;
    double share = k < 3 ? spore_vec3_volume(with[0], with[1], with[2], with[3]) / volume : rest;
    rest -= share;
    draft->blocks[WIDTH * draft->count + k] = draft->corners[4 * (gsize)tetrahedron + k];
    draft->weights[WIDTH * draft->count + k] = share;
  }
  draft->twins[draft->count++] = (uint32_t)vertex;
}

/* The tetrahedron that moves a vertex; UINT32_MAX: none. */
static uint32_t home_of(const SporeStageBody *body, uint32_t vertex) {
  uint32_t place = body->surface_places[body->whole_surface.row_start[vertex]];
  return place == UINT32_MAX ? place : place / 4;
}

/* Whether the corners of the triangle follow different copies of one node. */
static gboolean is_straddling(const Draft *draft, const uint32_t *triangle) {
  const SporeStageBody *body = draft->body;
  const SporeMapping *whole = &body->whole_surface;
  uint32_t place[3 * WIDTH];
  guint count = 0;
  for (int c = 0; c < 3; c++)
    for (uint32_t k = whole->row_start[triangle[c]]; k < whole->row_start[triangle[c] + 1]; k++)
      if (body->surface_places[k] != UINT32_MAX) place[count++] = body->surface_places[k];
  for (guint i = 0; i < count; i++)
    for (guint j = 0; j < i; j++)
      if (body->cells->tetrahedra[place[i]] == body->cells->tetrahedra[place[j]] &&
          draft->corners[place[i]] != draft->corners[place[j]])
        return TRUE;
  return FALSE;
}

static void draft_triangles(Draft *draft) {
  const SporeStageBody *body = draft->body;
  for (gsize t = 0; t < body->whole_count; t++) {
    const uint32_t *triangle = body->whole_triangles + 3 * t;
    memcpy(draft->triangles + 3 * t, triangle, 3 * sizeof *triangle);
    uint32_t home = home_of(body, triangle[0]);
    if (home == UINT32_MAX || !is_straddling(draft, triangle)) continue;
    for (int k = 0; k < 3; k++) {
      draft->triangles[3 * t + (gsize)k] = (uint32_t)draft->count;
      add_row(draft, triangle[k], home);
    }
  }
}

/* Shows the draft in place of the last surface. */
static void show_draft(SporeStage *stage, SporeStageBody *body, Draft *draft) {
  SporeTriangleMesh mesh = {.vertex_count = draft->count, .triangle_count = body->whole_count};
  SporeMapping mapping;
  if (!spore_mapping_init_linear(&mapping, draft->count, WIDTH, draft->blocks, draft->weights, NULL)) return;
  spore_mapping_clear(&body->surface.mapping);
  body->surface.mapping = mapping;
  mesh.vertices = g_new(double, 3 * draft->count);
  spore_mapping_positions(&mapping, body->q, mesh.vertices);
  mesh.triangles = draft->triangles;
  draft->triangles = NULL;
  spore_stage_body_show_surface(stage, body, &mesh);
  spore_stage_body_lay_texture(stage, body, mesh.vertices, body->places); /* the triangles keep their order */
  spore_stage_body_stain_anew(body, draft->twins);
  g_free(mesh.vertices);
}

static void keep_whole(SporeStageBody *body) {
  if (body->whole_triangles) return;
  body->whole_triangles = body->triangles;
  body->whole_count = body->triangle_count;
  body->whole_surface = body->surface.mapping;
  spore_mapping_init_identity(&body->surface.mapping, body->surface.count);
}

static void divide_surface(SporeStage *stage, SporeStageBody *body, const uint32_t *corners) {
  gboolean first = !body->whole_triangles;
  if (!body->surface_handle || !body->rest || !body->surface_places || (first && body->own_triangles)) return;
  keep_whole(body);
  gsize most = body->whole_surface.point_count + 3 * body->whole_count;
  Draft draft = {.body = body, .corners = corners};
  draft.blocks = g_new0(uint32_t, WIDTH * most);
  draft.weights = g_new0(double, WIDTH *most);
  draft.twins = g_new(uint32_t, most);
  draft.triangles = SPORE_NEW_ARRAY(uint32_t, 3 * body->whole_count);
  if (draft.triangles) {
    for (gsize i = 0; i < body->whole_surface.point_count; i++) add_whole_row(&draft, i);
    draft_triangles(&draft);
    show_draft(stage, body, &draft);
  }
  spore_free(draft.triangles);
  g_free(draft.blocks);
  g_free(draft.weights);
  g_free(draft.twins);
}

/* Faces that were inside. */

static guint64 face_key(const uint32_t *face, const uint32_t *whole_of) {
  uint32_t a = whole_of[face[0]], b = whole_of[face[1]], c = whole_of[face[2]], least = MIN(a, MIN(b, c)),
           most = MAX(a, MAX(b, c)), middle = a ^ b ^ c ^ least ^ most;
  return ((guint64)least << 42) ^ ((guint64)middle << 21) ^ most;
}

static GHashTable *outer_faces(const SporeTetrahedralMesh *cells, const uint32_t *same) {
  GHashTable *outer = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, NULL);
  uint32_t *faces = NULL;
  gsize count = 0;
  if (spore_tetrahedral_mesh_boundary(cells, &faces, &count))
    for (gsize i = 0; i < count; i++) {
      guint64 key = face_key(faces + 3 * i, same);
      g_hash_table_add(outer, g_memdup2(&key, sizeof key));
    }
  spore_free(faces);
  return outer;
}

/* For each node after splitting, the node of the whole mesh. */
static uint32_t *find_whole(const SporeStageBody *body, const uint32_t *corners) {
  uint32_t *whole_of = g_new0(uint32_t, body->q_count / 3 + body->cells->vertex_count);
  for (gsize i = 0; i < body->cells->vertex_count; i++) whole_of[i] = (uint32_t)i;
  for (gsize i = 0; i < 4 * body->cells->tetrahedron_count; i++) whole_of[corners[i]] = body->cells->tetrahedra[i];
  return whole_of;
}

/* Puts the outer faces of the whole mesh first, and returns their number. */
static gsize sort_faces(const SporeStageBody *body, const uint32_t *corners, uint32_t *faces, gsize count) {
  uint32_t *whole_of = find_whole(body, corners);
  GHashTable *outer = outer_faces(body->cells, whole_of);
  gsize first = 0;
  for (gsize i = 0; i < count; i++) {
    guint64 key = face_key(faces + 3 * i, whole_of);
    if (!g_hash_table_contains(outer, &key)) continue;
    for (int k = 0; k < 3; k++) {
      uint32_t kept = faces[3 * first + (gsize)k];
      faces[3 * first + (gsize)k] = faces[3 * i + (gsize)k];
      faces[3 * i + (gsize)k] = kept;
    }
    first++;
  }
  g_hash_table_destroy(outer);
  g_free(whole_of);
  return first;
}

static void show_inside(SporeStage *stage, SporeStageBody *body, const uint32_t *faces, gsize count) {
  SporeSurfaceStyle style = body->style;
  memcpy(style.colour, raw_flesh, sizeof raw_flesh);
  style.wetness = fmaxf(style.wetness, 0.9f);
  if (body->inside_handle) spore_renderer_remove(stage->renderer, body->inside_handle);
  body->inside_handle = 0;
  if (count == 0) return;
  body->inside_handle = spore_renderer_add_surface(stage->renderer, body->q, body->q_count / 3, faces, count, &style);
  spore_renderer_set_visible(stage->renderer, body->inside_handle,
                             stage->options.surfaces && spore_stage_shows(stage, body->object));
}

/* Shows the outer faces where the surface is the boundary of the tetrahedra. */
static void show_outside(SporeStage *stage, SporeStageBody *body, const uint32_t *corners, const uint32_t *faces,
                         gsize count) {
  SporeTriangleMesh mesh = {.vertex_count = body->q_count / 3, .triangle_count = count, .vertices = body->q};
  if (!body->surface_handle || body->surface.mapping.kind != SPORE_MAPPING_IDENTITY || body->rest) return;
  mesh.triangles = SPORE_NEW_ARRAY(uint32_t, 3 * count);
  if (!mesh.triangles) return;
  memcpy(mesh.triangles, faces, 3 * count * sizeof *faces);
  body->surface.mapping.point_count = mesh.vertex_count;
  spore_stage_body_show_surface(stage, body, &mesh);
  g_autofree uint32_t *whole_of = find_whole(body, corners);
  spore_stage_body_stain_anew(body, whole_of);
}

static void divide_faces(SporeStage *stage, SporeStageBody *body, const uint32_t *corners) {
  SporeTetrahedralMesh now = *body->cells;
  uint32_t *faces = NULL;
  gsize count = 0;
  now.tetrahedra = g_memdup2(corners, 4 * now.tetrahedron_count * sizeof *corners);
  if (spore_tetrahedral_mesh_boundary(&now, &faces, &count)) {
    gsize outer = sort_faces(body, corners, faces, count);
    show_outside(stage, body, corners, faces, outer);
    show_inside(stage, body, faces + 3 * outer, count - outer);
  }
  g_free(now.tetrahedra);
  spore_free(faces);
}

/* Updates the wire to the edges after splitting. */
static void divide_wire(SporeStageBody *body, const uint32_t *corners) {
  uint32_t *edges = NULL;
  gsize count = 0;
  if (!body->wire_handle || body->nodes.mapping.kind != SPORE_MAPPING_IDENTITY ||
      !spore_edges_of_tetrahedra(corners, body->cells->tetrahedron_count, &edges, &count))
    return;
  spore_free(body->edges);
  body->edges = edges;
  body->edge_count = count;
  body->segments = g_renew(double, body->segments, 6 * count);
  body->nodes.count = body->nodes.mapping.point_count = body->q_count / 3;
  body->nodes.positions = g_renew(double, body->nodes.positions, body->q_count);
}

void spore_stage_body_divide(SporeStage *stage, SporeStageBody *body, const SporeCuts *cuts) {
  if (!body->cells || body->divided == cuts->parted) return;
  const uint32_t *corners = cuts->corners + 4 * body->corner_start;
  gboolean whole = memcmp(corners, body->cells->tetrahedra, 4 * body->cells->tetrahedron_count * sizeof *corners) == 0;
  body->divided = cuts->parted;
  if (whole && !body->inside_handle) return;
  spore_mapping_follow(&body->centres.mapping, body->centre_places, corners);
  divide_surface(stage, body, corners);
  divide_faces(stage, body, corners);
  divide_wire(body, corners);
}
