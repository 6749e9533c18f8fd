/* The operations on a mesh that an author may choose, as a table, with the figures before and after. */
#include "core/generate/surface/surface.h"

#include <math.h>

#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/mesh/edit.h"
#include "core/mesh/simplify.h"

#define WELD 1e-6     /* of the diagonal: a clean merges vertices nearer than this */
#define SAMPLES 20000 /* per surface, for the Hausdorff distance */
#define MEASURING 0.3 /* share of the progress */

const SporeMeshOperation spore_mesh_operations[SPORE_MESH_OPERATIONS] = {
    [SPORE_MESH_WELD] = {.name = "weld",
                         .label = N_("Weld"),
                         .doc = N_("Merge vertices nearer than D of the diagonal"),
                         .argument = "D",
                         .argument_label = N_("of the diagonal"),
                         .minimum = 1e-9,
                         .maximum = 0.1,
                         .usual = 1e-4},
    [SPORE_MESH_CLEAN] = {.name = "clean",
                          .label = N_("Clean"),
                          .doc = N_("Remove duplicate triangles and those without area")},
    [SPORE_MESH_ORIENT] = {.name = "orient",
                           .label = N_("Orient"),
                           .doc = N_("Turn neighbouring triangles alike, closed pieces outward")},
    [SPORE_MESH_FILL_HOLES] = {.name = "fill-holes",
                               .label = N_("Fill holes"),
                               .doc = N_("Close holes of at most EDGES edges (default 0: all)"),
                               .argument = "EDGES",
                               .argument_label = N_("edges at most (0: all)"),
                               .argument_optional = true,
                               .maximum = 1e6,
                               .whole = true},
    [SPORE_MESH_SMOOTH] = {.name = "smooth",
                           .label = N_("Smooth"),
                           .doc = N_("Smooth in N rounds that keep the volume (Taubin)"),
                           .argument = "N",
                           .argument_label = N_("rounds"),
                           .minimum = 1,
                           .maximum = 1000,
                           .usual = 10,
                           .whole = true},
    [SPORE_MESH_DECIMATE] = {.name = "triangles",
                             .label = N_("Decimate"),
                             .doc = N_("Leave about N triangles, where the shape loses least"),
                             .argument = "N",
                             .argument_label = N_("triangles"),
                             .minimum = 4,
                             .maximum = SPORE_MESH_MAXIMUM,
                             .usual = 5000,
                             .whole = true},
};

bool spore_mesh_figures(const SporeTriangleMesh *mesh, SporeMeshFigures *figures, SporeError *error) {
  figures->vertices = mesh->vertex_count;
  figures->triangles = mesh->triangle_count;
  return spore_triangle_mesh_report(mesh, &figures->report, error);
}

bool spore_mesh_argument_is_valid(const SporeMeshOperation *operation, double argument) {
  return !operation->argument || (argument >= operation->minimum && argument <= operation->maximum &&
                                  (!operation->whole || argument == floor(argument)));
}

static bool check_argument(const SporeMeshOperation *operation, double argument, SporeError *error) {
  if (spore_mesh_argument_is_valid(operation, argument)) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, operation->name,
                         operation->whole ? _("%g is out of range; expected a whole number from %g to %g; give one")
                                          : _("%g is out of range; expected a number from %g to %g; give one"),
                         argument, operation->minimum, operation->maximum);
}

/* Following the edge of a hole needs triangles of consistent orientation. A piece that is closed by filling is then
 * turned outward. */
static bool fill_holes(SporeTriangleMesh *mesh, size_t most_edges, const SporeProgress *progress, SporeError *error) {
  return spore_triangle_mesh_orient(mesh, error) && spore_triangle_mesh_fill_holes(mesh, most_edges, progress, error) &&
         spore_triangle_mesh_orient(mesh, error);
}

/* The vertices in excess of half the triangles come from pieces and handles, which stay. */
static bool decimate(SporeTriangleMesh *mesh, size_t triangles, const SporeProgress *progress, SporeError *error) {
  if (mesh->triangle_count <= triangles) return true;
  double more = (double)mesh->vertex_count - 0.5 * (double)mesh->triangle_count;
  SporeSimplifyOptions options = {.vertices = (size_t)fmax(4, round(0.5 * (double)triangles + more))};
  SporeSimplifyReport report;
  SporeTriangleMesh result;
  if (!spore_triangle_mesh_simplify(mesh, &options, &result, &report, progress, error)) return false;
  spore_triangle_mesh_clear(mesh);
  *mesh = result;
  return true;
}

static bool apply(SporeTriangleMesh *mesh, SporeMeshOperationKind kind, double argument, const SporeProgress *progress,
                  SporeError *error) {
  switch (kind) {
  case SPORE_MESH_WELD:
    return spore_triangle_mesh_weld(mesh, argument, error);
  case SPORE_MESH_CLEAN:
    return spore_triangle_mesh_clean(mesh, WELD, error);
  case SPORE_MESH_ORIENT:
    return spore_triangle_mesh_orient(mesh, error);
  case SPORE_MESH_FILL_HOLES:
    return fill_holes(mesh, (size_t)argument, progress, error);
  case SPORE_MESH_SMOOTH:
    return spore_triangle_mesh_smooth(mesh, (size_t)argument, progress, error);
  case SPORE_MESH_DECIMATE:
    return decimate(mesh, (size_t)argument, progress, error);
  case SPORE_MESH_OPERATIONS:
    break;
  }
  return spore_error_set(error, SPORE_ERROR_INTERNAL, NULL, _("there is no such operation on a mesh; report this"));
}

bool spore_mesh_operate(SporeTriangleMesh *mesh, SporeMeshOperationKind operation, double argument,
                        SporeMeshChange *change, const SporeProgress *progress, SporeError *error) {
  if (!check_argument(&spore_mesh_operations[operation], argument, error)) return false;
  SporeProgressShare doing = {progress, 0, 1 - MEASURING}, measuring = {progress, 1 - MEASURING, MEASURING};
  SporeProgress in_doing = spore_progress_of_share(&doing), in_measuring = spore_progress_of_share(&measuring);
  SporeMeshChange ignored;
  SporeTriangleMesh result;
  if (!change) change = &ignored;
  *change = (SporeMeshChange){.operation = operation, .argument = argument};
  if (!spore_mesh_figures(mesh, &change->before, error) || !spore_triangle_mesh_copy(&result, mesh, error))
    return false;
  bool done = apply(&result, operation, argument, &in_doing, error) &&
              spore_mesh_figures(&result, &change->after, error) &&
              spore_surface_distance(mesh, &result, SAMPLES, &change->moved, &in_measuring, error);
  if (done) {
    spore_triangle_mesh_clear(mesh);
    *mesh = result;
  } else spore_triangle_mesh_clear(&result);
  return done;
}
