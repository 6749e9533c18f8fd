#include "core/io/mesh_import.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/helper.h"
#include "core/io/import_wire.h"
#include "core/io/mesh_format.h"
#include "core/io/off.h"

const char *const spore_length_units[] = {"m", "cm", "mm", "um", "in", NULL};
const double spore_length_unit_m[] = {1, 1e-2, 1e-3, 1e-6, 0.0254};
const char *const spore_mesh_frames[] = {"Y_UP", "RAS", "LPS", NULL};

#define WELD 1e-6 /* of the diagonal */
static const SporeHelperLimits import_limits = {.time_s = 60, .memory = G_GUINT64_CONSTANT(6) << 30, .output = 1 << 30};

static SporeVec3 to_spore_axes(SporeVec3 p, int frame) {
  switch (frame) {
  case 1:
    return spore_vec3(p.x, p.z, -p.y);
  case 2:
    return spore_vec3(-p.x, p.z, p.y);
  default:
    return p;
  }
}

static void apply_unit_and_frame(SporeTriangleMesh *mesh, int unit, int frame) {
  for (gsize i = 0; i < mesh->vertex_count; i++) {
    SporeVec3 p = spore_vec3_scale(spore_length_unit_m[unit], spore_vec3_load(mesh->vertices + 3 * i));
    spore_vec3_store(mesh->vertices + 3 * i, to_spore_axes(p, frame));
  }
}

/* The helper is not believed: its counts must agree with what it sent, to the byte. */
static gboolean read_answer(const char *place, GBytes *answer, SporeTriangleMesh *mesh, GError **error) {
  gsize size;
  const char *bytes = g_bytes_get_data(answer, &size);
  SporeImportAnswer head = {0};
  if (size >= sizeof head) memcpy(&head, bytes, sizeof head);
  if (head.vertex_count > SPORE_MESH_MAXIMUM || head.triangle_count > SPORE_MESH_MAXIMUM)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("the mesh has more than %u vertices or triangles; expected fewer; decimate it first"),
                             SPORE_MESH_MAXIMUM);
  gsize vertex_bytes = head.vertex_count * 3 * sizeof(double),
        triangle_bytes = head.triangle_count * 3 * sizeof(guint32);
  if (size != sizeof head + vertex_bytes + triangle_bytes)
    return spore_error_raise(
        error, SPORE_ERROR_INTERNAL, place,
        _("the import helper gave a wrong answer; expected a mesh; give another format, and report this"));
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_triangle_mesh_allocate(mesh, head.vertex_count, head.triangle_count, &failure)) {
    spore_error_at(&failure, place);
    return spore_error_propagate(&failure, error);
  }
  memcpy(mesh->vertices, bytes + sizeof head, vertex_bytes);
  memcpy(mesh->triangles, bytes + sizeof head + vertex_bytes, triangle_bytes);
  if (head.passed_over)
    g_message(_("%s: %llu points and lines were passed over; only triangles are read"), place,
              (unsigned long long)head.passed_over);
  return TRUE;
}

static gboolean decode_in_helper(const char *place, SporeMeshFormat format, const void *content, gsize size,
                                 SporeTriangleMesh *mesh, const SporeProgress *progress, GError **error) {
  if (!SPORE_HAVE_ASSIMP)
    return spore_error_raise(
        error, SPORE_ERROR_UNSUPPORTED, place,
        _("this is %s, and this build of SPORE reads OFF alone; expected OFF; convert the mesh, or "
          "install libassimp-dev and build SPORE again"),
        spore_mesh_format_names[format]);
  SporeImportRequest head = {format};
  char *request = g_try_malloc(sizeof head + size);
  if (!request)
    return spore_error_raise(error, SPORE_ERROR_MEMORY, place,
                             _("there is not enough memory to import it; close other programs"));
  memcpy(request, &head, sizeof head);
  memcpy(request + sizeof head, content, size);
  GBytes *bytes = g_bytes_new_take(request, sizeof head + size);
  GBytes *answer = spore_helper_run("spore-import", place, bytes, &import_limits, progress, error);
  g_bytes_unref(bytes);
  if (!answer) return FALSE;
  gboolean done = read_answer(place, answer, mesh, error);
  g_bytes_unref(answer);
  return done;
}

/* A surface without border, each edge of which two triangles share, has an outside: triangles that look inward are
 * turned. Others are left as they are: nothing says where their outside is. */
static bool turn_outward(SporeTriangleMesh *mesh, SporeError *error) {
  SporeMeshReport report;
  if (!spore_triangle_mesh_report(mesh, &report, error)) return false;
  if (report.boundary_edges + report.nonmanifold_edges > 0) return true;
  gsize size = 3 * mesh->triangle_count * sizeof *mesh->triangles;
  g_autofree uint32_t *before = g_memdup2(mesh->triangles, size);
  if (!spore_triangle_mesh_orient(mesh, error)) return false;
  mesh->reoriented = memcmp(before, mesh->triangles, size) != 0;
  return true;
}

/* Checks what came, brings it to metres and SPORE's axes, welds it and turns it outward. */
static gboolean finish(const char *place, int unit, int frame, SporeTriangleMesh *mesh, GError **error) {
  apply_unit_and_frame(mesh, unit, frame);
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_triangle_mesh_validate(mesh, &failure) || !spore_triangle_mesh_weld(mesh, WELD, &failure) ||
      !turn_outward(mesh, &failure)) {
    spore_error_at(&failure, place);
    return spore_error_propagate(&failure, error);
  }
  return TRUE;
}

gboolean spore_mesh_decode(const char *place, const char *file, const void *content, gsize size, int unit, int frame,
                           SporeTriangleMesh *mesh, const SporeProgress *progress, GError **error) {
  if (!place) place = file ? file : "";
  g_assert(unit >= 0 && unit < (int)G_N_ELEMENTS(spore_length_unit_m) && frame >= 0 && frame < 3);
  SporeMeshFormat format;
  *mesh = (SporeTriangleMesh){0};
  if (!spore_mesh_format_find(place, file, content, size, &format, error)) return FALSE;
  size = spore_mesh_format_extent(format, content, size);
  gboolean done = format == SPORE_MESH_OFF ? spore_off_parse(place, content, size, mesh, error)
                                           : decode_in_helper(place, format, content, size, mesh, progress, error);
  if (done && finish(place, unit, frame, mesh, error)) return TRUE;
  spore_triangle_mesh_clear(mesh);
  return FALSE;
}

int spore_mesh_frame_hint(const void *content, gsize size) {
  char *head = g_strndup(content, MIN(size, 4096));
  for (gsize i = 0; i < MIN(size, 4096); i++) head[i] = head[i] ? g_ascii_toupper(head[i]) : ' ';
  int hint = strstr(head, "SPACE=RAS") ? 1 : strstr(head, "SPACE=LPS") ? 2 : -1;
  g_free(head);
  return hint;
}
