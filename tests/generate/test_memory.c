/* Generators while memory runs short: each allocation of the kernel fails, at its first and at its last turn on every
 * way by which a small input comes to it. A generator then refuses for want of memory, or does without; nothing leaks
 * (the sanitizer looks). */
#include <glib.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/generate/centreline/centreline.h"
#include "core/generate/labels/labels.h"
#include "core/generate/sheet/sheet.h"
#include "core/generate/surface/surface.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "tests/mesh/shapes.h"
#include "tests/ways.h"

/* Made before anything fails. */
static SporeTriangleMesh ball, coarse, box, capsule, two;

static bool surface(GError **to) {
  SporeTriangleMesh result = {0};
  SporeSurfaceReport report;
  SporeError error = SPORE_ERROR_INIT;
  bool fine = spore_surface_from_mesh(&ball, &(SporeSimplifyOptions){.vertices = 40}, &result, &report, NULL, &error);
  spore_triangle_mesh_clear(&result);
  return fine || spore_error_propagate(&error, to);
}

static bool wall(GError **to) {
  SporeTriangleMesh inner = {0}, both = {0};
  SporeWallReport report;
  SporeError error = SPORE_ERROR_INIT;
  bool fine = spore_wall_inner(&coarse, 0.012, 4, &inner, &report, NULL, &error) &&
              spore_wall_solid(&coarse, &inner, &both, &error);
  spore_triangle_mesh_clear(&both);
  spore_triangle_mesh_clear(&inner);
  return fine || spore_error_propagate(&error, to);
}

/* All of them, on a box that has a hole and whose triangles share no corner. */
static bool operations(GError **to) {
  SporeTriangleMesh mesh = {0};
  SporeError error = SPORE_ERROR_INIT;
  bool fine = spore_triangle_mesh_copy(&mesh, &box, &error);
  for (int kind = 0; fine && kind < SPORE_MESH_OPERATIONS; kind++) {
    const SporeMeshOperation *operation = &spore_mesh_operations[kind];
    double argument = operation->argument ? fmax(operation->usual, operation->minimum) : 0;
    fine = spore_mesh_operate(&mesh, (SporeMeshOperationKind)kind, argument, NULL, NULL, &error);
  }
  spore_triangle_mesh_clear(&mesh);
  return fine || spore_error_propagate(&error, to);
}

static bool centreline(GError **to) {
  SporeCurve curve = {0};
  SporeCentrelineOptions options = {.ends_given = true, .ends = {{0, 0, -0.015}, {0, 0, 0.015}}, .points = 9};
  SporeCentrelineReport report;
  SporeError error = SPORE_ERROR_INIT;
  bool fine = spore_centreline_from_mesh(&capsule, &options, &curve, &report, NULL, &error) &&
              spore_centreline_measure(&capsule, &curve, &report, &error);
  spore_curve_clear(&curve);
  return fine || spore_error_propagate(&error, to);
}

static bool sheet(GError **to) {
  SporeTriangleMesh patch = {0};
  SporeSheetReport report;
  double *distance = NULL;
  const SporeSheetOptions options = {
      .corners_given = true,
      .corners = {{0.01, 0.01, 0.02}, {-0.01, 0.01, 0.02}, {-0.01, -0.01, 0.02}, {0.01, -0.01, 0.02}},
      .control_points = 6};
  SporeError error = SPORE_ERROR_INIT;
  bool fine = spore_sheet_from_mesh(&coarse, &options, &patch, &distance, &report, NULL, &error);
  spore_free(distance);
  spore_triangle_mesh_clear(&patch);
  return fine || spore_error_propagate(&error, to);
}

static bool lattice(GError **to) {
  SporeTetrahedralMesh cells = {0};
  SporeTetrahedraReport report;
  SporeTetrahedraOptions options = {.method = SPORE_TETRAHEDRA_VOXELS, .size = 0.02};
  bool fine = spore_tetrahedra_from_mesh("ball", &coarse, &options, &cells, &report, NULL, to);
  spore_tetrahedral_mesh_clear(&cells);
  return fine;
}

/* A vessel that enters an organ, kept apart. */
static bool apart(GError **to) {
  SporeTetrahedralMesh cells = {0};
  SporeTetrahedraReport report;
  SporeTetrahedraOptions options = {.method = SPORE_TETRAHEDRA_VOXELS, .size = 0.02, .apart = true};
  bool fine = spore_tetrahedra_from_mesh("two", &two, &options, &cells, &report, NULL, to);
  spore_tetrahedral_mesh_clear(&cells);
  return fine;
}

/* Two organs that touch. */
#define VOXELS 4
static bool label_cells(GError **to) {
  uint16_t voxels[VOXELS * VOXELS * VOXELS] = {0};
  for (size_t z = 1; z < VOXELS - 1; z++)
    for (size_t y = 1; y < VOXELS - 1; y++)
      for (size_t x = 1; x < VOXELS - 1; x++) voxels[(z * VOXELS + y) * VOXELS + x] = x < VOXELS / 2 ? 1 : 2;
  const double edge = 0.002;
  SporeLabelMap map = {
      .size = {VOXELS, VOXELS, VOXELS}, .labels = voxels, .axes = {edge, 0, 0, 0, 0, edge, 0, 0, 0, 0, edge, 0}};
  SporeTriangleMesh skin = {0};
  SporeTetrahedralMesh cells = {0};
  SporeLabelTetrahedraReport report = {0};
  SporeError error = SPORE_ERROR_INIT;
  SporeLabelSurface surface = {.label = 1};
  if (!spore_label_surface(&map, 1, &skin, NULL, &error)) return spore_error_propagate(&error, to);
  spore_triangle_mesh_clear(&skin);
  if (!spore_label_surfaces(&map, &surface, 1, NULL, &error)) return spore_error_propagate(&error, to);
  spore_triangle_mesh_clear(&surface.mesh);
  bool fine =
      spore_label_tetrahedra("map", &map, &(SporeLabelTetrahedraOptions){.size = 0.002}, &cells, &report, NULL, to);
  spore_tetrahedral_mesh_clear(&cells);
  g_clear_pointer(&report.labels, g_array_unref);
  return fine;
}

typedef struct Part {
  const char *path;
  WaysWork *work;
} Part;

static void fail_each(gconstpointer data) {
  const Part *part = data;
  ways_fail_each(part->work);
}

int main(int argc, char **argv) {
  static const Part parts[] = {{"/generate/memory/surface", surface},       {"/generate/memory/wall", wall},
                               {"/generate/memory/operations", operations}, {"/generate/memory/centreline", centreline},
                               {"/generate/memory/sheet", sheet},           {"/generate/memory/lattice", lattice},
                               {"/generate/memory/labels", label_cells},    {"/generate/memory/apart", apart}};
  g_test_init(&argc, &argv, NULL);
  shape_ball(&ball, 0.02, 6);
  shape_ball(&coarse, 0.02, 4);
  shape_capsule(&capsule, 0.01, 0.012, 4);
  shape_ball(&two, 0.02, 4);
  shape_move(&two, 0, 0, 0.02);
  shape_append(&two, &capsule);
  shape_box(&box, (double[3]){0, 0, 0}, (double[3]){0.02, 0.02, 0.02}, 4);
  shape_unweld(&box);
  box.triangle_count--;
  for (size_t i = 0; i < G_N_ELEMENTS(parts); i++) g_test_add_data_func(parts[i].path, &parts[i], fail_each);
  int status = g_test_run();
  ways_clear();
  SporeTriangleMesh *inputs[] = {&ball, &coarse, &capsule, &box, &two};
  for (size_t i = 0; i < G_N_ELEMENTS(inputs); i++) spore_triangle_mesh_clear(inputs[i]);
  return status;
}
