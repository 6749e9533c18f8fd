/* SPORE's side of the tetrahedra helper. The helper's answer is not trusted: its size must match to the byte, and the
 * mesh is validated like any other. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/generate/tetrahedra/private.h"
#include "core/io/helper.h"

/* For each task. */
static const SporeHelperLimits limits = {.time_s = 120, .memory = G_GUINT64_CONSTANT(8) << 30, .output = 1 << 30};

static GBytes *make_request(SporeTetrahedraRequest head, const SporeTriangleMesh *surface, const SporeSizing *sizing) {
  head.vertex_count = surface->vertex_count;
  head.triangle_count = surface->triangle_count;
  head.sizing_spacing = sizing->spacing;
  gsize nodes = 1;
  for (int k = 0; k < 3; k++) {
    nodes *= sizing->count[k];
    head.sizing_count[k] = sizing->count[k];
    head.sizing_lower[k] = sizing->lower[k];
  }
  GByteArray *bytes = g_byte_array_new();
  g_byte_array_append(bytes, (const guint8 *)&head, sizeof head);
  g_byte_array_append(bytes, (const guint8 *)surface->vertices, (guint)(3 * surface->vertex_count * sizeof(double)));
  g_byte_array_append(bytes, (const guint8 *)surface->triangles,
                      (guint)(3 * surface->triangle_count * sizeof(guint32)));
  g_byte_array_append(bytes, (const guint8 *)sizing->size, (guint)(nodes * sizeof(double)));
  return g_byte_array_free_to_bytes(bytes);
}

/* Finds the vertices and corners in an answer, without a copy. FALSE: the answer is malformed. */
static gboolean open_answer(GBytes *answer, guint64 corners, SporeTetrahedraAnswer *head, const double **vertices,
                            const guint32 **indices) {
  gsize size;
  const char *bytes = g_bytes_get_data(answer, &size);
  if (size < sizeof *head) return FALSE;
  memcpy(head, bytes, sizeof *head);
  if (head->corners != corners || head->vertex_count > SPORE_MESH_MAXIMUM || head->cell_count > SPORE_MESH_MAXIMUM)
    return FALSE;
  gsize vertex_bytes = head->vertex_count * 3 * sizeof(double), corner_bytes = head->cell_count * corners * 4;
  *vertices = (const double *)(const void *)(bytes + sizeof *head);
  *indices = (const guint32 *)(const void *)(bytes + sizeof *head + vertex_bytes);
  return size == sizeof *head + vertex_bytes + corner_bytes;
}

static gboolean wrong_answer(GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INTERNAL, NULL,
                           _("the tetrahedra helper gave a wrong answer; expected a mesh; report this"));
}

static gboolean read_surface(GBytes *answer, SporeTriangleMesh *surface, GError **error) {
  SporeTetrahedraAnswer head;
  const double *vertices;
  const guint32 *corners;
  SporeError failure = SPORE_ERROR_INIT;
  if (!open_answer(answer, 3, &head, &vertices, &corners)) return wrong_answer(error);
  if (!spore_triangle_mesh_allocate(surface, head.vertex_count, head.cell_count, &failure))
    return spore_error_propagate(&failure, error);
  memcpy(surface->vertices, vertices, 3 * head.vertex_count * sizeof(double));
  memcpy(surface->triangles, corners, 3 * head.cell_count * sizeof(guint32));
  if (spore_triangle_mesh_validate(surface, &failure)) return TRUE;
  spore_triangle_mesh_clear(surface);
  return spore_error_propagate(&failure, error);
}

static gboolean read_tetrahedra(GBytes *answer, SporeTetrahedralMesh *mesh, GError **error) {
  SporeTetrahedraAnswer head;
  const double *vertices;
  const guint32 *corners;
  SporeError failure = SPORE_ERROR_INIT;
  if (!open_answer(answer, 4, &head, &vertices, &corners)) return wrong_answer(error);
  if (!spore_tetrahedral_mesh_allocate(mesh, head.vertex_count, head.cell_count, &failure))
    return spore_error_propagate(&failure, error);
  memcpy(mesh->vertices, vertices, 3 * head.vertex_count * sizeof(double));
  memcpy(mesh->tetrahedra, corners, 4 * head.cell_count * sizeof(guint32));
  if (spore_tetrahedral_mesh_validate(mesh, &failure)) return TRUE;
  spore_tetrahedral_mesh_clear(mesh);
  return spore_error_propagate(&failure, error);
}

static GBytes *ask(SporeTetrahedraWork *work, SporeTetrahedraRequest head, const SporeTriangleMesh *surface,
                   const SporeSizing *sizing, GError **error) {
  SporeProgress progress = {spore_tetrahedra_report, work};
  GBytes *request = make_request(head, surface, sizing);
  GBytes *answer = spore_helper_run("spore-tetrahedra", NULL, request, &limits, &progress, error);
  g_bytes_unref(request);
  return answer;
}

gboolean spore_tetrahedra_prepare(SporeTetrahedraWork *work, SporeTetrahedraTask task, double alpha,
                                  size_t most_vertices, SporeTriangleMesh *surface, GError **error) {
  double none = 1;
  SporeSizing sizing = {.count = {1, 1, 1}, .spacing = 1, .size = &none};
  SporeTetrahedraRequest head = {.task = task, .alpha = alpha, .offset = alpha / 20, .most_vertices = most_vertices};
  GBytes *answer = ask(work, head, &work->surface, &sizing, error);
  gboolean done = answer && read_surface(answer, surface, error);
  if (answer) g_bytes_unref(answer);
  return done;
}

gboolean spore_tetrahedra_refine(SporeTetrahedraWork *work, const SporeTriangleMesh *surface, const SporeSizing *sizing,
                                 SporeTetrahedraFinish finish, size_t most_vertices, SporeTetrahedralMesh *mesh,
                                 GError **error) {
  SporeTetrahedraRequest head = {.task = SPORE_TETRAHEDRA_MESH, .finish = finish, .most_vertices = most_vertices};
  GBytes *answer = ask(work, head, surface, sizing, error);
  gboolean done = answer && read_tetrahedra(answer, mesh, error);
  if (answer) g_bytes_unref(answer);
  return done;
}
