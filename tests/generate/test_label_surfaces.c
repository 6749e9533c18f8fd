/* Surfaces of labels among others: closed, within half a voxel of the voxels by an independent measure, and of few
 * triangles; parts that touch at an edge or a corner; what is refused or cancelled, maps of specks among it. */
#include <glib.h>
#include <math.h>

#include "core/generate/labels/labels.h"
#include "core/generate/labels/private.h"

#define SIDE 26

typedef struct Map {
  uint16_t voxels[SIDE * SIDE * SIDE];
  SporeLabelMap map;
} Map;

static uint16_t label_at(const Map *m, int i, int j, int k) {
  if (i < 0 || j < 0 || k < 0 || i >= SIDE || j >= SIDE || k >= SIDE) return 0;
  return m->voxels[(k * SIDE + j) * SIDE + i];
}

static void put(Map *m, int i, int j, int k, uint16_t label) { m->voxels[(k * SIDE + j) * SIDE + i] = label; }

/* Voxels of 1 x 2 x 3 mm; mirrored: the first index runs backward. */
static Map *new_map(bool mirrored) {
  Map *m = g_new0(Map, 1);
  m->map = (SporeLabelMap){.size = {SIDE, SIDE, SIDE},
                           .labels = m->voxels,
                           .axes = {mirrored ? -0.001 : 0.001, 0, 0, 0.1, 0, 0.002, 0, 0, 0, 0, 0.003, -0.2}};
  return m;
}

/* Two balls that press against each other, and a slab that the edge of the volume cuts. */
static void fill(Map *m) {
  for (int k = 0; k < SIDE; k++)
    for (int j = 0; j < SIDE; j++)
      for (int i = 0; i < SIDE; i++) {
        const int across = (j - 12) * (j - 12) + (k - 12) * (k - 12);
        if (k < 3) put(m, i, j, k, 7);
        else if (i < 13 && (i - 8) * (i - 8) + across < 49) put(m, i, j, k, 1);
        else if (i >= 13 && (i - 17) * (i - 17) + across < 49) put(m, i, j, k, 2);
      }
}

/* Distance (voxels) from a place, in indices, to the nearest face of the label's voxels. */
static double from_faces(const Map *m, uint16_t label, const double x[3]) {
  double best = HUGE_VAL;
  for (int k = -1; k < SIDE; k++)
    for (int j = -1; j < SIDE; j++)
      for (int i = -1; i < SIDE; i++)
        for (int axis = 0; axis < 3; axis++) {
          const int at[3] = {i, j, k};
          if ((label_at(m, i, j, k) == label) ==
              (label_at(m, i + (axis == 0), j + (axis == 1), k + (axis == 2)) == label))
            continue;
          double square = pow(x[axis] - at[axis] - 0.5, 2);
          for (int e = 0; e < 3; e++)
            if (e != axis) square += pow(fmax(fabs(x[e] - at[e]) - 0.5, 0), 2);
          best = fmin(best, square);
        }
  return sqrt(best);
}

static double volume_of(const Map *m, uint16_t label) {
  gsize count = 0;
  for (gsize i = 0; i < G_N_ELEMENTS(m->voxels); i++) count += m->voxels[i] == label;
  return (double)count * spore_label_map_voxel_volume(&m->map);
}

static void check_closed(const SporeTriangleMesh *mesh, SporeMeshReport *report) {
  SporeError error = SPORE_ERROR_INIT;
  g_assert_true(spore_triangle_mesh_report(mesh, report, &error));
  g_assert_true(report->closed);
  g_assert_cmpfloat(report->volume, >, 0);
}

static void check_near(const Map *m, const SporeLabelSurface *surface) {
  const double *a = m->map.axes;
  double off = 0;
  for (gsize i = 0; i < surface->mesh.vertex_count; i++) {
    const double *p = surface->mesh.vertices + 3 * i;
    const double x[3] = {(p[0] - a[3]) / a[0], (p[1] - a[7]) / a[5], (p[2] - a[11]) / a[10]};
    off = fmax(off, from_faces(m, surface->label, x));
  }
  g_test_message("label %u: %zu triangles of %zu, %.3f voxels off, its vertices %.3f", surface->label,
                 surface->mesh.triangle_count, surface->triangles_before, surface->off, off);
  g_assert_cmpfloat(surface->off, <=, SPORE_LABEL_SURFACE_OFF);
  g_assert_cmpfloat(off, <=, surface->off + 1e-6);
  g_assert_cmpuint(3 * surface->mesh.triangle_count, <, surface->triangles_before);
}

/* The volume of a ball of voxels is kept within 3 %; a cut slab's, which loses at its sharp edges, within 6 %. */
static void test_organs(gconstpointer mirrored) {
  g_autofree Map *m = new_map(GPOINTER_TO_INT(mirrored));
  SporeLabelSurface surfaces[3] = {{.label = 1}, {.label = 2}, {.label = 7}};
  SporeError error = SPORE_ERROR_INIT;
  fill(m);
  g_assert_true(spore_label_surfaces(&m->map, surfaces, 3, NULL, &error));
  for (int s = 0; s < 3; s++) {
    SporeMeshReport report;
    check_closed(&surfaces[s].mesh, &report);
    g_assert_cmpuint(report.components, ==, 1);
    const double change = report.volume / volume_of(m, surfaces[s].label) - 1;
    g_test_message("volume %+.2f %%", 100 * change);
    g_assert_cmpfloat(fabs(change), <, s < 2 ? 0.03 : 0.06);
    check_near(m, &surfaces[s]);
    spore_triangle_mesh_clear(&surfaces[s].mesh);
  }
}

/* Each part that touches another at an edge or a corner alone has its own surface. */
static void test_touching(void) {
  static const struct {
    int voxels[5][3];
    gsize count, pieces;
  } cases[] = {{{{5, 5, 5}}, 1, 1},
               {{{5, 5, 5}, {6, 6, 5}}, 2, 2},
               {{{5, 5, 5}, {6, 6, 6}}, 2, 2},
               {{{5, 5, 5}, {6, 6, 5}, {5, 6, 6}, {6, 5, 6}}, 4, 4},
               {{{5, 5, 5}, {6, 6, 5}, {6, 5, 5}}, 3, 1},
               {{{5, 5, 5}, {6, 6, 5}, {5, 5, 6}, {6, 6, 6}, {5, 6, 6}}, 5, 1},
               {{{0, 0, 0}, {SIDE - 1, SIDE - 1, SIDE - 1}}, 2, 2}};
  for (gsize c = 0; c < G_N_ELEMENTS(cases); c++) {
    g_autofree Map *m = new_map(false);
    SporeLabelSurface surface = {.label = 9};
    SporeError error = SPORE_ERROR_INIT;
    SporeMeshReport report;
    for (gsize v = 0; v < cases[c].count; v++)
      put(m, cases[c].voxels[v][0], cases[c].voxels[v][1], cases[c].voxels[v][2], 9);
    g_assert_true(spore_label_surfaces(&m->map, &surface, 1, NULL, &error));
    check_closed(&surface.mesh, &report);
    g_assert_cmpuint(report.components, ==, cases[c].pieces);
    g_assert_cmpfloat(surface.off, <=, SPORE_LABEL_SURFACE_OFF);
    spore_triangle_mesh_clear(&surface.mesh);
  }
}

/* A label that fills the map ends at its edge. */
static void test_whole(void) {
  g_autofree Map *m = new_map(false);
  SporeLabelSurface surface = {.label = 65535};
  SporeError error = SPORE_ERROR_INIT;
  SporeMeshReport report;
  for (gsize i = 0; i < G_N_ELEMENTS(m->voxels); i++) m->voxels[i] = 65535;
  g_assert_true(spore_label_surfaces(&m->map, &surface, 1, NULL, &error));
  check_closed(&surface.mesh, &report);
  g_assert_cmpfloat(fabs(report.volume / volume_of(m, 65535) - 1), <, 0.06);
  spore_triangle_mesh_clear(&surface.mesh);
}

static bool report_until(void *data, double fraction, const char *stage) {
  int *left = data;
  return (*left)-- > 0;
}

static void test_refused(void) {
  g_autofree Map *m = new_map(false);
  SporeLabelSurface surfaces[2] = {{.label = 1}, {.label = 5}};
  SporeError error = SPORE_ERROR_INIT;
  int turns = 0, left;
  fill(m);
  g_assert_false(spore_label_surfaces(&m->map, surfaces, 2, NULL, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_nonnull(strstr(error.message, "label 5"));
  g_assert_null(surfaces[0].mesh.vertices);
  surfaces[1].label = 2;
  for (bool done = false; !done; turns++) {
    const SporeProgress progress = {.report = report_until, .data = &left};
    error = (SporeError)SPORE_ERROR_INIT;
    left = turns;
    done = spore_label_surfaces(&m->map, surfaces, 2, &progress, &error);
    if (done) break;
    g_assert_cmpint(error.code, ==, SPORE_ERROR_CANCELLED);
    g_assert_null(surfaces[0].mesh.vertices);
    g_assert_null(surfaces[1].mesh.vertices);
  }
  g_test_message("cancelled at %d turns", turns);
  g_assert_cmpint(turns, >, 50); /* each layer, each round of smoothing, each surface */
  for (int s = 0; s < 2; s++) spore_triangle_mesh_clear(&surfaces[s].mesh);
}

/* One voxel of each cube of two; in half of the cases they touch, by corners, those of the cubes around. */
static void scatter(Map *m, bool touching) {
  for (int i = 0; i < SIDE * SIDE * SIDE; i++) {
    const int x = i % SIDE, y = i / SIDE % SIDE, z = i / SIDE / SIDE;
    if (touching ? (x + y + z) % 2 == 0 : x % 2 == 0 && y % 2 == 0 && z % 2 == 0) put(m, x, y, z, 3);
  }
}

/* Specks are refused where they are far more than the cells and most of what there is; not beside a larger organ, not
 * where they hang together by corners, and not where cells are as small. */
static void test_specks(void) {
  static const struct {
    int organ, touching;
    size_t cells;
    double least;
    bool refused;
  } cases[] = {{.cells = 100, .least = 22, .refused = true},
               {.organ = 20, .cells = 100, .least = 50},
               {.touching = true, .cells = 100, .least = 88},
               {.cells = 220, .least = 10},
               {.cells = 100, .least = 1}};
  for (gsize c = 0; c < G_N_ELEMENTS(cases); c++) {
    g_autofree Map *m = new_map(false);
    g_autofree bool *wanted = g_new0(bool, 65536);
    SporeError error = SPORE_ERROR_INIT;
    wanted[3] = wanted[4] = true;
    scatter(m, cases[c].touching);
    for (int i = 0; i < cases[c].organ * SIDE * SIDE; i++) m->voxels[i] = 4;
    g_assert_cmpint(spore_label_check_specks(&m->map, wanted, cases[c].cells, cases[c].least, NULL, &error), ==,
                    !cases[c].refused);
    g_assert_cmpint(error.code, ==, cases[c].refused ? SPORE_ERROR_INPUT : 0);
    g_assert_true(!cases[c].refused || g_str_has_prefix(error.message, "2197 specks"));
  }
}

/* The same by the whole generator. */
static void test_specks_early(void) {
  g_autofree Map *m = new_map(false);
  SporeTetrahedralMesh cells;
  SporeLabelTetrahedraReport report;
  g_autoptr(GError) error = NULL;
  scatter(m, false);
  g_assert_false(spore_label_tetrahedra("map", &m->map, &(SporeLabelTetrahedraOptions){.cells = 100}, &cells, &report,
                                        NULL, &error));
  g_assert_nonnull(strstr(error->message, "specks"));
}

/* Two halves of a block share the cells by volume, and by weight: neither gets less than nearly its share. */
static void test_shares(void) {
  static const double weights[][2] = {{1, 1}, {2, 0.5}, {0.5, 2}};
  static const uint16_t labels[2] = {1, 2};
  g_autofree Map *m = new_map(false);
  for (int i = 0; i < SIDE * SIDE * SIDE; i++) m->voxels[i] = i / SIDE / SIDE < SIDE / 2 ? 1 : 2;
  for (gsize c = 0; c < G_N_ELEMENTS(weights); c++) {
    SporeLabelTetrahedraOptions options = {.cells = 300, .labels = labels, .label_count = 2, .weights = weights[c]};
    SporeTetrahedralMesh cells;
    SporeLabelTetrahedraReport report;
    g_assert_true(spore_label_tetrahedra("map", &m->map, &options, &cells, &report, NULL, NULL));
    const SporeLabelFigures *of = (const SporeLabelFigures *)(const void *)report.labels->data;
    const double first = (double)of[0].cells, share = first / (double)cells.tetrahedron_count,
                 wanted = weights[c][0] / (weights[c][0] + weights[c][1]);
    g_test_message("%zu cells, %.3f of them in the first half; %.3f wanted", cells.tetrahedron_count, share, wanted);
    g_assert_cmpfloat(fabs(share - wanted), <, 0.1);
    g_assert_cmpfloat(fabs((double)cells.tetrahedron_count / 300 - 1), <, 0.05);
    g_array_unref(report.labels);
    spore_tetrahedral_mesh_clear(&cells);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_data_func("/label-surfaces/organs", GINT_TO_POINTER(false), test_organs);
  g_test_add_data_func("/label-surfaces/mirrored", GINT_TO_POINTER(true), test_organs);
  g_test_add_func("/label-surfaces/touching", test_touching);
  g_test_add_func("/label-surfaces/whole", test_whole);
  g_test_add_func("/label-surfaces/refused", test_refused);
  g_test_add_func("/label-surfaces/specks", test_specks);
  g_test_add_func("/label-surfaces/specks early", test_specks_early);
  g_test_add_func("/label-surfaces/shares", test_shares);
  return g_test_run();
}
