#include "core/generate/tetrahedra.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/generate/surface_distance.h"
#include "core/generate/tetrahedra_wire.h"
#include "core/io/helper.h"

#define MOST_CELLS 5000000u
#define SAMPLES 20000  /* a surface, for the Hausdorff distance */
#define MEASURING 0.05 /* share of the progress */

static const char *const method_names[SPORE_TETRAHEDRA_METHODS] = {"direct", "repaired", "wrapped"};
/* For each attempt. */
static const SporeHelperLimits tetrahedra_limits = {
    .time_s = 120, .memory = G_GUINT64_CONSTANT(8) << 30, .output = 1 << 30};

typedef struct {
  const SporeTriangleMesh *surface;
  SporeMeshReport report;
  double centre[3];
  const SporeTetrahedraOptions *options;
  const SporeProgress *progress;
} Task;

static gboolean raise_at(const char *place, SporeError *failure, GError **error) {
  spore_error_at(failure, place);
  return spore_error_propagate(failure, error);
}

static gboolean check_options(const char *place, const Task *task, GError **error) {
  const SporeTetrahedraOptions *options = task->options;
  if (!options->cells && !(options->size > 0 && isfinite(options->size)))
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, place,
        _("the cells' size is %g m; expected a length above 0, or a number of cells; give one of them"), options->size);
  double regular = pow(options->size, 3) / (6 * sqrt(2)); /* volume of a regular cell of that edge */
  double cells = options->cells ? (double)options->cells : fabs(task->report.volume) / regular;
  if (cells > MOST_CELLS)
    return spore_error_raise(error, SPORE_ERROR_INPUT, place,
                             _("that makes about %.0f cells; expected at most %u; ask for fewer or larger ones"), cells,
                             MOST_CELLS);
  return TRUE;
}

/* The surface about the origin with a diagonal of 1, so that no library meets organs in micrometres or kilometres. */
static GBytes *make_request(const Task *task, SporeTetrahedraMethod method) {
  const SporeTriangleMesh *surface = task->surface;
  SporeTetrahedraRequest head = {method, task->options->cells, task->options->size / task->report.diagonal,
                                 surface->vertex_count, surface->triangle_count};
  gsize vertices = 3 * surface->vertex_count, corners = 3 * surface->triangle_count;
  gsize size = sizeof head + vertices * sizeof(double) + corners * sizeof(guint32);
  char *bytes = g_malloc(size);
  memcpy(bytes, &head, sizeof head);
  double *scaled = (double *)(void *)(bytes + sizeof head);
  for (gsize i = 0; i < vertices; i++) scaled[i] = (surface->vertices[i] - task->centre[i % 3]) / task->report.diagonal;
  memcpy(bytes + sizeof head + vertices * sizeof(double), surface->triangles, corners * sizeof(guint32));
  return g_bytes_new_take(bytes, size);
}

/* The helper is not believed: sizes must agree to the byte, and the mesh is validated like any other. */
static gboolean read_answer(const Task *task, GBytes *answer, SporeTetrahedralMesh *mesh, GError **error) {
  gsize size;
  const char *bytes = g_bytes_get_data(answer, &size);
  SporeTetrahedraAnswer head = {0};
  if (size >= sizeof head) memcpy(&head, bytes, sizeof head);
  gboolean sane = head.vertex_count <= SPORE_MESH_MAXIMUM && head.tetrahedron_count <= SPORE_MESH_MAXIMUM;
  gsize vertex_bytes = sane ? head.vertex_count * 3 * sizeof(double) : 0;
  gsize corner_bytes = sane ? head.tetrahedron_count * 4 * sizeof(guint32) : 0;
  if (!sane || size != sizeof head + vertex_bytes + corner_bytes)
    return spore_error_raise(error, SPORE_ERROR_INTERNAL, NULL,
                             _("the tetrahedra helper gave a wrong answer; expected a mesh; report this"));
  SporeError failure = SPORE_ERROR_INIT;
  if (!spore_tetrahedral_mesh_allocate(mesh, head.vertex_count, head.tetrahedron_count, &failure))
    return spore_error_propagate(&failure, error);
  memcpy(mesh->vertices, bytes + sizeof head, vertex_bytes);
  memcpy(mesh->tetrahedra, bytes + sizeof head + vertex_bytes, corner_bytes);
  for (gsize i = 0; i < 3 * mesh->vertex_count; i++)
    mesh->vertices[i] = mesh->vertices[i] * task->report.diagonal + task->centre[i % 3];
  if (spore_tetrahedral_mesh_validate(mesh, &failure)) return TRUE;
  spore_tetrahedral_mesh_clear(mesh);
  return spore_error_propagate(&failure, error);
}

static bool report_attempt(void *data, double fraction, const char *stage) {
  const Task *task = data;
  return spore_progress(task->progress, (1 - MEASURING) * fraction, stage);
}

static gboolean attempt(Task *task, SporeTetrahedraMethod method, SporeTetrahedralMesh *mesh, GError **error) {
  SporeProgress progress = {report_attempt, task};
  GBytes *request = make_request(task, method);
  GBytes *answer = spore_helper_run("spore-tetrahedra", NULL, request, &tetrahedra_limits, &progress, error);
  g_bytes_unref(request);
  if (!answer) return FALSE;
  gboolean done = read_answer(task, answer, mesh, error);
  g_bytes_unref(answer);
  return done;
}

/* The first method that works. */
static gboolean run_chain(Task *task, const char *place, SporeTetrahedralMesh *mesh, SporeTetrahedraReport *report,
                          GError **error) {
  GString *tried = g_string_new(NULL);
  gboolean done = FALSE, hopeless = FALSE;
  for (int method = 0; method < SPORE_TETRAHEDRA_METHODS && !done && !hopeless; method++) {
    GError *failure = NULL;
    report->method = method_names[method];
    done = attempt(task, (SporeTetrahedraMethod)method, mesh, &failure);
    if (done) break;
    hopeless = failure->code == SPORE_ERROR_CANCELLED || failure->code == SPORE_ERROR_UNSUPPORTED;
    if (hopeless) spore_error_raise(error, (SporeErrorCode)failure->code, place, "%s", failure->message);
    g_string_append_printf(tried, "%s%s: %.*s", tried->len ? ", " : "", report->method,
                           (int)strcspn(failure->message, ";"), failure->message);
    g_error_free(failure);
  }
  if (!done && !hopeless)
    spore_error_raise(error, SPORE_ERROR_NUMERICAL, place,
                      _("no tetrahedra could be made (%s); expected a surface that encloses a volume; close its holes, "
                        "simplify it, or ask for another number of cells"),
                      tried->str);
  g_string_free(tried, TRUE);
  return done;
}

static bool report_measuring(void *data, double fraction, const char *stage) {
  return spore_progress(data, 1 - MEASURING + MEASURING * fraction, stage);
}

static bool measure(const Task *task, const SporeTetrahedralMesh *mesh, SporeTetrahedraReport *report,
                    SporeError *error) {
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  SporeProgress progress = {report_measuring, (void *)task->progress};
  spore_tetrahedral_mesh_quality(mesh, &report->quality);
  bool done = spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count) ||
              spore_error_set(error, SPORE_ERROR_MEMORY, NULL,
                              _("there is not enough memory for the result; close other programs"));
  done = done && spore_surface_distance(task->surface, &boundary, SAMPLES, &report->hausdorff, &progress, error);
  spore_free(boundary.triangles);
  report->hausdorff /= task->report.diagonal;
  double volume = fabs(task->report.volume);
  report->volume_change = volume > 0 ? report->quality.volume / volume - 1 : 0;
  return done;
}

gboolean spore_tetrahedra_from_mesh(const char *place, const SporeTriangleMesh *surface,
                                    const SporeTetrahedraOptions *options, SporeTetrahedralMesh *result,
                                    SporeTetrahedraReport *report, const SporeProgress *progress, GError **error) {
  Task task = {.surface = surface, .options = options, .progress = progress};
  SporeTetrahedraReport ignored;
  SporeError failure = SPORE_ERROR_INIT;
  guint64 started = spore_clock_ns();
  if (!report) report = &ignored;
  *report = (SporeTetrahedraReport){0};
  *result = (SporeTetrahedralMesh){0};
  if (!SPORE_HAVE_CGAL)
    return spore_error_raise(
        error, SPORE_ERROR_UNSUPPORTED, place,
        _("this build of SPORE makes no tetrahedra; expected CGAL; install libcgal-dev and build SPORE "
          "again, or give a .mesh file"));
  if (!spore_triangle_mesh_validate(surface, &failure) || !spore_triangle_mesh_report(surface, &task.report, &failure))
    return raise_at(place, &failure, error);
  if (!(task.report.diagonal > 0) || surface->triangle_count < 4)
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, place,
        _("the surface of %zu triangles encloses nothing; expected one that encloses a volume; give another mesh"),
        surface->triangle_count);
  for (int axis = 0; axis < 3; axis++) task.centre[axis] = 0.5 * (task.report.lower[axis] + task.report.upper[axis]);
  if (!check_options(place, &task, error) || !run_chain(&task, place, result, report, error)) return FALSE;
  if (!measure(&task, result, report, &failure)) {
    spore_tetrahedral_mesh_clear(result);
    return raise_at(place, &failure, error);
  }
  report->seconds = 1e-9 * (double)(spore_clock_ns() - started);
  return TRUE;
}
