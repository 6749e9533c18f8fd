/* Shapes that are open or in pieces, and what falls into pieces. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cells.h"
#include "core/base/memory.h"
#include "tests/mesh/shapes.h"
#include "tests/sanitized.h"

static const double low[3] = {0, 0, 0}, high[3] = {0.1, 0.1, 0.1};

/* A sheet of no thickness, an open cup, one triangle, two parts: each is made by a method, or refused in words. */
static void test_open_shapes(void) {
  SporeTriangleMesh plate = {0}, cup = {0}, parts = {0}, other = {0};
  shape_box(&plate, low, high, 4);
  gsize kept = 0; /* of a box, the triangles of the side z = 0 */
  for (gsize t = 0; t < plate.triangle_count; t++) {
    const uint32_t *c = plate.triangles + 3 * t;
    if (plate.vertices[3 * c[0] + 2] + plate.vertices[3 * c[1] + 2] + plate.vertices[3 * c[2] + 2] > 0) continue;
    memmove(plate.triangles + 3 * kept++, c, 12);
  }
  plate.triangle_count = kept;
  check_refused(&plate, (SporeTetrahedraOptions){CHAIN, .cells = 200}, SPORE_ERROR_INPUT, "encloses nothing");
  plate.triangle_count = 1;
  check_refused(&plate, (SporeTetrahedraOptions){CHAIN, .cells = 200}, SPORE_ERROR_INPUT, "encloses nothing");
  spore_triangle_mesh_clear(&plate);

  shape_ball(&cup, 0.05, 6);
  kept = 0;
  for (gsize t = 0; t < cup.triangle_count; t++)
    if (cup.vertices[3 * cup.triangles[3 * t] + 2] <= 0.01)
      memmove(cup.triangles + 3 * kept++, cup.triangles + 3 * t, 12);
  cup.triangle_count = kept;
  Result result = fill(&cup, (SporeTetrahedraOptions){CHAIN, .cells = 300, .tolerance = 0.1}, "repaired");
  g_assert_cmpfloat(result.report.volume, >, 2e-4);
  g_assert_cmpfloat(result.report.volume, <, 4.5e-4);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&parts, 0.03, 6);
  shape_ball(&other, 0.03, 6);
  shape_move(&other, 0.1, 0, 0);
  shape_append(&parts, &other);
  spore_triangle_mesh_clear(&other);
  result = fill(&parts, (SporeTetrahedraOptions){CHAIN, .cells = 400}, "direct");
  g_assert_cmpfloat(fabs(result.report.volume_change), <, 0.08);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A ball with a small one beside it at a neck that no cell is as thin as: what breaks off goes, and is said. One by
 * itself stays. */
static void test_small_components(void) {
  SporeTriangleMesh organ = {0}, other = {0};
  shape_ball(&organ, 0.03, 24);
  for (gsize i = 0; i < organ.vertex_count; i++) {
    double *p = organ.vertices + 3 * i, z = p[2] / 0.03, wide = z > 0 ? 1 : z > -0.7 ? 0.01 : 0.4;
    p[0] *= wide, p[1] *= wide, p[2] *= 2;
  }
  Result result = fill(&organ, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 600}, "voxels");
  uint32_t *pieces;
  size_t count;
  g_assert_true(spore_tetrahedral_mesh_pieces(&result.mesh, &pieces, &count, NULL));
  spore_free(pieces);
  g_assert_cmpuint(count, ==, 1);
  g_assert_cmpuint(result.report.pieces, ==, 1);
  g_assert_cmpuint(result.report.pieces_given, ==, 1);
  g_assert_cmpfloat(result.report.small_components, >, 0.001);
  g_assert_cmpfloat(result.report.small_components, <, 0.02);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&organ, 0.03, 8);
  shape_ball(&other, 0.006, 8);
  shape_move(&other, 0.05, 0, 0);
  shape_append(&organ, &other);
  spore_triangle_mesh_clear(&other);
  result = fill(&organ, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_VOXELS, .cells = 1500}, "voxels");
  g_assert_cmpuint(result.report.pieces, ==, 2);
  g_assert_cmpuint(result.report.pieces_given, ==, 2);
  g_assert_cmpfloat(result.report.small_components, ==, 0);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A ball of 30 mm, then a part that is appended to it as part 1, "vessel". The caller clears the surface and parts. */
static SporeTriangleMesh organ_with(SporeTriangleMesh *part, uint32_t **parts) {
  SporeTriangleMesh organ = {0};
  shape_ball(&organ, 0.03, 10);
  size_t own = organ.triangle_count;
  shape_append(&organ, part);
  spore_triangle_mesh_clear(part);
  *parts = SPORE_NEW_ARRAY(uint32_t, organ.triangle_count);
  g_assert_nonnull(*parts);
  for (size_t t = own; t < organ.triangle_count; t++) (*parts)[t] = 1;
  return organ;
}

/* Fills the two and checks the remarks of the second: they hold `words` (NULL: nothing on pieces is said). */
static Result fill_two(SporeTriangleMesh *part, SporeTetrahedraOptions options, const char *words) {
  static const char *const names[] = {"organ", "vessel"};
  uint32_t *parts;
  SporeTriangleMesh organ = organ_with(part, &parts);
  options.method = SPORE_TETRAHEDRA_VOXELS;
  options.cells = 300;
  options.tolerance = 0.05;
  options.parts = parts;
  options.part_names = names;
  Result result = fill(&organ, options, "voxels");
  spore_free(parts);
  char *remarks = spore_tetrahedra_remarks(&result.mesh, &options, &result.report);
  g_test_message("%s", remarks);
  g_assert_true(strstr(remarks, "organ: ") != NULL && strstr(remarks, words) != NULL);
  g_free(remarks);
  return result;
}

/* Drops the triangles beyond z, so that the shape is open there. */
static void cut_above(SporeTriangleMesh *mesh, double z) {
  size_t kept = 0;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *c = mesh->triangles + 3 * t;
    if (mesh->vertices[3 * c[0] + 2] + mesh->vertices[3 * c[1] + 2] + mesh->vertices[3 * c[2] + 2] > 3 * z) continue;
    memmove(mesh->triangles + 3 * kept++, c, 3 * sizeof *c);
  }
  mesh->triangle_count = kept;
}

#define VOLUME(radius) (4 / 3. * 3.14159265 * (radius) * (radius) * (radius))

/* A vessel that enters the organ, with an open end: one solid, and its hole is told. The same beside the organ and
 * closed: neither merged nor holed. */
static void test_merged(void) {
  SporeTriangleMesh vessel = {0};
  shape_capsule(&vessel, 0.008, 0.03, 5);
  shape_move(&vessel, 0, 0, 0.05);
  cut_above(&vessel, 0.055); /* at a row of 40 vertices */
  Result result = fill_two(&vessel, (SporeTetrahedraOptions){0}, "merged with what it lies in");
  const SporeTetrahedraPiece *piece = result.report.piece + 1;
  g_assert_cmpuint(result.report.piece_count, ==, 2);
  g_assert_cmpstr(piece->name, ==, "vessel");
  g_assert_cmpint(piece->role, ==, SPORE_PIECE_MERGED);
  g_assert_cmpint(piece->in, ==, 0);
  g_assert_cmpuint(piece->holes, ==, 1);
  g_assert_cmpuint(piece->open_edges, ==, 40);
  g_assert_cmpuint(result.report.pieces, ==, 1);
  g_assert_cmpint(result.report.piece[0].holes, ==, 0);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_capsule(&vessel, 0.008, 0.03, 5);
  shape_move(&vessel, 0.05, 0, 0);
  result = fill_two(&vessel, (SporeTetrahedraOptions){0}, "vessel: ");
  g_assert_cmpint(result.report.piece[1].role, ==, SPORE_PIECE_BOUNDS);
  g_assert_cmpuint(result.report.piece[1].holes, ==, 0);
  g_assert_cmpuint(result.report.pieces, ==, 2);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A second wall half a millimetre inside is left out, and told with its distance; turned round it bounds a cavity, and
 * so it does where hollow is asked for. */
static void test_inside(void) {
  SporeTriangleMesh wall = {0};
  shape_ball(&wall, 0.0295, 10);
  Result result = fill_two(&wall, (SporeTetrahedraOptions){0},
                           "vessel: 1200 triangles, 59 x 59 x 59 mm; a wall inside "
                           "organ, 0.5 to 0.5 mm");
  g_assert_cmpint(result.report.piece[1].role, ==, SPORE_PIECE_INSIDE);
  g_assert_cmpfloat(result.report.piece[1].depth[0], >, 4e-4);
  g_assert_cmpfloat(result.report.piece[1].depth[1], <, 5.5e-4);
  g_assert_cmpfloat(fabs(result.report.volume / VOLUME(0.03) - 1), <, 0.05);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&wall, 0.018, 10);
  shape_turn(&wall);
  result = fill_two(&wall, (SporeTetrahedraOptions){0}, "bounds a cavity in organ");
  g_assert_cmpint(result.report.piece[1].role, ==, SPORE_PIECE_CAVITY);
  g_assert_cmpfloat(fabs(result.report.volume / (VOLUME(0.03) - VOLUME(0.018)) - 1), <, 0.08);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&wall, 0.018, 10);
  result = fill_two(&wall, (SporeTetrahedraOptions){.hollow = true}, "bounds a cavity in organ");
  g_assert_cmpfloat(fabs(result.report.volume / (VOLUME(0.03) - VOLUME(0.018)) - 1), <, 0.08);
  g_assert_cmpfloat(result.report.inner_share, ==, 0);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Hollow leaves alone what is not wholly inside, and what lies in a cavity is solid again. */
static void test_hollow_nests(void) {
  SporeTriangleMesh other = {0}, core = {0};
  shape_ball(&other, 0.02, 10);
  shape_move(&other, 0.025, 0, 0);
  Result result = fill_two(&other, (SporeTetrahedraOptions){.hollow = true}, "merged with what it lies in");
  g_assert_cmpfloat(result.report.volume, >, VOLUME(0.03));
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_ball(&other, 0.02, 10);
  shape_ball(&core, 0.01, 6);
  shape_append(&other, &core);
  spore_triangle_mesh_clear(&core);
  result = fill_two(&other, (SporeTetrahedraOptions){.hollow = true},
                    "vessel (1): 1200 triangles, 40 x 40 x 40 mm; "
                    "bounds a cavity in organ");
  g_assert_cmpfloat(fabs(result.report.volume / (VOLUME(0.03) - VOLUME(0.02) + VOLUME(0.01)) - 1), <, 0.08);
  g_assert_cmpuint(result.report.pieces, ==, 2);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* The largest piece alone, with the cavity in it; the vessel goes, and that is told. */
static void test_largest(void) {
  SporeTriangleMesh vessel = {0}, cavity = {0};
  shape_capsule(&vessel, 0.008, 0.03, 5);
  shape_move(&vessel, 0, 0, 0.04);
  shape_ball(&cavity, 0.015, 8);
  shape_turn(&cavity);
  shape_append(&vessel, &cavity);
  spore_triangle_mesh_clear(&cavity);
  Result result =
      fill_two(&vessel, (SporeTetrahedraOptions){.largest = true}, "pieces left out, as asked: 1; the largest");
  g_assert_cmpuint(result.report.unwanted, ==, 1);
  g_assert_cmpuint(result.report.piece_count, ==, 2);
  g_assert_cmpint(result.report.piece[1].role, ==, SPORE_PIECE_CAVITY);
  g_assert_cmpfloat(fabs(result.report.volume / (VOLUME(0.03) - VOLUME(0.015)) - 1), <, 0.08);
  spore_tetrahedral_mesh_clear(&result.mesh);

  shape_capsule(&vessel, 0.008, 0.03, 5);
  shape_move(&vessel, 0, 0, 0.04);
  result = fill_two(&vessel, (SporeTetrahedraOptions){0}, "merged");
  g_assert_cmpuint(result.report.unwanted, ==, 0);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* An open sheet beside the organ encloses nothing. A lone closed organ has nothing to tell. */
static void test_sheet(void) {
  SporeTriangleMesh sheet = {0};
  shape_box(&sheet, (double[3]){0.04, 0.04, -0.01}, (double[3]){0.06, 0.06, 0.02}, 4);
  cut_above(&sheet, -0.0095);
  Result result = fill_two(&sheet, (SporeTetrahedraOptions){0}, "a sheet that encloses nothing: left out");
  g_assert_cmpint(result.report.piece[1].role, ==, SPORE_PIECE_SHEET);
  spore_tetrahedral_mesh_clear(&result.mesh);

  SporeTriangleMesh lone = {0};
  SporeTetrahedraOptions options = {.method = SPORE_TETRAHEDRA_VOXELS, .cells = 300, .tolerance = 0.1};
  shape_ball(&lone, 0.03, 8);
  result = fill(&lone, options, "voxels");
  char *remarks = spore_tetrahedra_remarks(&result.mesh, &options, &result.report);
  g_assert_cmpstr(remarks, ==, "");
  g_free(remarks);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* A flat septum in the middle of the organ. */
static SporeTriangleMesh septum(void) {
  SporeTriangleMesh sheet = {0};
  shape_box(&sheet, (double[3]){-0.012, -0.012, 0}, (double[3]){0.012, 0.012, 0.01}, 4);
  cut_above(&sheet, 0.0005);
  return sheet;
}

/* A tube of 8 mm through the middle of the organ, open at both ends. */
static SporeTriangleMesh open_tube(void) {
  SporeTriangleMesh tube = {0};
  shape_capsule(&tube, 0.008, 0.012, 5);
  cut_above(&tube, 0.0125);
  shape_turn(&tube);
  for (size_t i = 0; i < tube.vertex_count; i++) tube.vertices[3 * i + 2] *= -1; /* a mirror turns triangles over */
  cut_above(&tube, 0.0125);
  return tube;
}

/* Whether the remarks hold the words. */
static void check_told(const Result *result, SporeTetrahedraOptions options, const char *words, bool told) {
  char *remarks = spore_tetrahedra_remarks(&result->mesh, &options, &result->report);
  if ((strstr(remarks, words) != NULL) != told) g_error("%s: %s", words, remarks);
  g_free(remarks);
}

/* Each kind of wall inside is told with its pieces, its holes and the remedy, and no other kind is: a tube that is open
 * at both ends, turned outward and inward, a septum, a second wall, a chamber, a ball that is turned inside out. What
 * `hollow` made of a chamber is as asked, and one ball beside another one is no wall. */
static void test_walls(void) {
  static const char *const words[] = {
      "open tubes or sheets inside: ", "open tubes or sheets inside that are turned inward: ",
      "second walls close inside another one: ", "closed pieces inside, as chambers or parts of an organ: ",
      "closed pieces inside that are turned inside out: "};
  static const struct {
    double radius; /* of a ball; 0: the tube; below 0: the septum */
    double beside; /* m */
    bool turned, hollow;
    SporePieceWall wall;
    double solid; /* volume */
  } cases[] = {{.wall = SPORE_WALL_OPEN, .solid = VOLUME(0.03)},
               {.turned = true, .wall = SPORE_WALL_LUMEN, .solid = VOLUME(0.03) - 0.025 * 3.14159265 * 6.4e-5},
               {.radius = -1, .wall = SPORE_WALL_OPEN, .solid = VOLUME(0.03)},
               {.radius = -1, .turned = true, .wall = SPORE_WALL_OPEN, .solid = VOLUME(0.03)},
               {.radius = 0.0295, .wall = SPORE_WALL_DOUBLED, .solid = VOLUME(0.03)},
               {.radius = 0.018, .wall = SPORE_WALL_CLOSED, .solid = VOLUME(0.03)},
               {.radius = 0.018, .turned = true, .wall = SPORE_WALL_TURNED, .solid = VOLUME(0.03) - VOLUME(0.018)},
               {.radius = 0.018, .hollow = true, .wall = SPORE_WALL_NONE, .solid = VOLUME(0.03) - VOLUME(0.018)},
               {.radius = 0.018, .beside = 0.06, .wall = SPORE_WALL_NONE, .solid = VOLUME(0.03) + VOLUME(0.018)}};
  for (size_t i = 0; i < G_N_ELEMENTS(cases); i += tests_sanitized ? 2 : 1) {
    SporeTriangleMesh part = {0};
    if (cases[i].radius > 0) shape_ball(&part, cases[i].radius, 8);
    else part = cases[i].radius < 0 ? septum() : open_tube();
    if (cases[i].turned) shape_turn(&part);
    shape_move(&part, cases[i].beside, 0, 0);
    const SporeTetrahedraOptions options = {.hollow = cases[i].hollow};
    Result result = fill_two(&part, options, "vessel: ");
    g_assert_cmpint(result.report.piece[1].wall, ==, cases[i].wall);
    g_assert_cmpint(result.report.piece[0].wall, ==, SPORE_WALL_NONE);
    g_assert_cmpint(result.report.piece[1].in, ==, cases[i].beside > 0 ? -1 : 0);
    for (int kind = 0; kind < (int)G_N_ELEMENTS(words); kind++)
      check_told(&result, options, words[kind], kind + 1 == (int)cases[i].wall);
    check_told(&result, options, ": 1 (vessel); holes: 2; ", cases[i].radius == 0);
    check_told(&result, options, ": 1 (vessel); holes: 1; ", cases[i].radius < 0);
    g_assert_cmpfloat(fabs(result.report.volume / cases[i].solid - 1), <, 0.08);
    spore_tetrahedral_mesh_clear(&result.mesh);
  }
}

/* The number of the label's cells, and of the nodes that they share with those of another label. */
static void count_cells(const SporeTetrahedralMesh *mesh, uint32_t label, size_t *cells, size_t *shared) {
  bool *own = SPORE_NEW_ARRAY(bool, mesh->vertex_count), *other = SPORE_NEW_ARRAY(bool, mesh->vertex_count);
  g_assert_true(own && other);
  *cells = *shared = 0;
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
    *cells += mesh->labels[c] == label;
    for (size_t k = 0; k < 4; k++) (mesh->labels[c] == label ? own : other)[mesh->tetrahedra[4 * c + k]] = true;
  }
  for (size_t v = 0; v < mesh->vertex_count; v++) *shared += own[v] && other[v];
  spore_free(own);
  spore_free(other);
}

/* m^3 of the cells with that label. */
static double volume_of(const SporeTetrahedralMesh *mesh, uint32_t label) {
  double volume = 0;
  for (size_t c = 0; c < mesh->tetrahedron_count; c++) {
    SporeVec3 p[4];
    for (size_t k = 0; k < 4; k++) p[k] = spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->tetrahedra[4 * c + k]);
    if (mesh->labels[c] == label) volume += fabs(spore_vec3_volume(p[0], p[1], p[2], p[3])) / 6;
  }
  return volume;
}

/* A vessel that enters the organ, and a chamber in it, each with cells of its own: faces are shared, each has its
 * volume, and the outside is as near as where all are merged. A second wall of half a millimetre gets none. */
static void test_apart(void) {
  static const char *const names[] = {"organ", "vessel"};
  SporeTriangleMesh vessel = {0}, chamber = {0}, wall = {0};
  shape_capsule(&vessel, 0.008, 0.03, 5);
  shape_move(&vessel, 0, 0, 0.04);
  shape_ball(&chamber, 0.012, 8);
  shape_move(&chamber, 0, 0, -0.01);
  shape_append(&vessel, &chamber);
  shape_ball(&wall, 0.0295, 10);
  shape_append(&vessel, &wall);
  spore_triangle_mesh_clear(&chamber);
  spore_triangle_mesh_clear(&wall);
  uint32_t *parts;
  SporeTriangleMesh organ = organ_with(&vessel, &parts);
  SporeTetrahedraOptions options = {CHAIN, .cells = 2500, .apart = true, .parts = parts, .part_names = names};
  Result result = fill(&organ, options, "voxels");
  spore_free(parts);
  size_t all = 0, cells, shared;
  for (size_t i = 0; i < result.report.piece_count; i++) {
    const SporeTetrahedraPiece *piece = result.report.piece + i;
    count_cells(&result.mesh, (uint32_t)(i + 1), &cells, &shared);
    g_test_message("%s: %zu cells, volume %.4g ml, %zu nodes shared", piece->name, cells,
                   1e6 * volume_of(&result.mesh, (uint32_t)(i + 1)), shared);
    g_assert_cmpuint(cells, ==, piece->cells);
    g_assert_true(piece->parted == (cells > 0) && (cells == 0 || shared > 10));
    all += cells;
  }
  g_assert_cmpuint(result.report.piece_count, ==, 4);
  g_assert_false(result.report.piece[1].parted); /* the wall is the second in area */
  g_assert_cmpuint(all, ==, result.mesh.tetrahedron_count);
  check_cells(&result, 2500);
  g_assert_cmpuint(result.report.pieces, ==, 1);
  g_assert_cmpuint(result.report.shared_faces, >, 50);
  g_assert_cmpfloat(result.report.hausdorff, <, 0.01);
  g_assert_cmpfloat(result.report.border_distance, <, 0.015); /* half an edge */
  g_assert_cmpfloat(fabs(volume_of(&result.mesh, 4) / VOLUME(0.012) - 1), <, 0.1);
  char *remarks = spore_tetrahedra_remarks(&result.mesh, &options, &result.report);
  g_test_message("%s", remarks);
  g_assert_nonnull(strstr(remarks, "cells of its own: "));
  g_assert_nonnull(strstr(remarks, "pieces kept apart share "));
  g_assert_nonnull(strstr(remarks, "a wall inside "));
  g_assert_null(strstr(remarks, "merged with others"));
  for (size_t i = 0; i < result.report.piece_count; i++) g_assert_cmpint(result.report.piece[i].merged, ==, -1);
  g_assert_cmpfloat(fabs(result.report.piece[3].thickness / 0.016 - 1), <, 0.2); /* of a ball 4/3 of the radius */
  g_free(remarks);
  spore_tetrahedral_mesh_clear(&result.mesh);

  SporeTriangleMesh lone = {0};
  shape_ball(&lone, 0.03, 8);
  check_refused(&lone, (SporeTetrahedraOptions){CHAIN, .cells = 300, .apart = true, .curvature = 20}, SPORE_ERROR_INPUT,
                "leave these out");
  check_refused(&lone, (SporeTetrahedraOptions){.method = SPORE_TETRAHEDRA_DIRECT, .cells = 300, .apart = true},
                SPORE_ERROR_INPUT, "leave these out");
  spore_triangle_mesh_clear(&lone);
}

/* Plates that cross the organ, and a speck beside it: few cells cannot have them. The number of cells is met, plates
 * are merged, the speck is left out, and each is told with its thickness and the number of cells that would do. */
static void test_apart_thin(void) {
  SporeTriangleMesh plates = {0}, plate = {0};
  for (int i = 0; i < 3; i++) {
    const double z = 0.014 * (i - 1), wide = 0.024 + 0.004 * i;
    shape_box(&plate, (double[3]){-wide, -wide, z}, (double[3]){wide, wide, z + 0.006}, 4);
    shape_append(&plates, &plate);
    spore_triangle_mesh_clear(&plate);
  }
  shape_ball(&plate, 0.0008, 2);
  shape_move(&plate, 0, 0, 0.06);
  shape_append(&plates, &plate);
  spore_triangle_mesh_clear(&plate);
  uint32_t *parts;
  static const char *const names[] = {"organ", "vessel"};
  SporeTriangleMesh organ = organ_with(&plates, &parts);
  SporeTetrahedraOptions options = {CHAIN,         .cells = 300,   .tolerance = 0.05,
                                    .apart = true, .parts = parts, .part_names = names};
  Result result = fill(&organ, options, "voxels");
  spore_free(parts);
  char *remarks = spore_tetrahedra_remarks(&result.mesh, &options, &result.report);
  g_test_message("%zu cells; %s", result.mesh.tetrahedron_count, remarks);
  check_cells(&result, 300);
  size_t merged = 0, all = 0;
  for (size_t i = 0; i < result.report.piece_count; i++) {
    const SporeTetrahedraPiece *piece = result.report.piece + i;
    all += piece->cells;
    merged += piece->merged >= 0;
    g_assert_true(i == 4 ? piece->cells == 0 && piece->merged < 0 : (piece->cells > 0) == (piece->merged < 0));
    g_assert_cmpfloat(piece->thickness, >, i == 4 ? 0.0005 : 0.002);
  }
  g_assert_cmpuint(all, ==, result.mesh.tetrahedron_count);
  g_assert_cmpuint(merged, >=, 1);
  g_assert_cmpint(result.report.piece[0].merged, ==, -1); /* the organ is the largest */
  g_assert_nonnull(strstr(remarks, "mm thick, too thin for cells of its own: merged with "));
  g_assert_nonnull(
      strstr(remarks, "mm thick, too thin for cells of its own, and nothing is around it: left out; about "));
  g_assert_nonnull(strstr(remarks, "300 cells were asked for: pieces too thin for so few were merged with others: "));
  g_free(remarks);
  spore_tetrahedral_mesh_clear(&result.mesh);
}

/* Where so few cells are too far from the surface, that is said with a number that does: meshed again with that
 * number, they are within the tolerance, and nothing is said. */
static void test_far(void) {
  for (int shape = tests_sanitized ? 2 : 0; shape < 3; shape++) {
    size_t cells = 200;
    for (int turn = 0; turn < 2; turn++) {
      SporeTriangleMesh organ = {0}, vessel = {0};
      shape_ball(&organ, 0.03, 12);
      shape_capsule(&vessel, shape == 1 ? 0.002 : 0.005, 0.04, 6);
      shape_move(&vessel, 0, 0, 0.04);
      if (shape) shape_append(&organ, &vessel);
      spore_triangle_mesh_clear(&vessel);
      const SporeTetrahedraOptions options = {.method = SPORE_TETRAHEDRA_VOXELS, .cells = cells, .tolerance = 0.01};
      Result result = fill(&organ, options, "voxels");
      char *remarks = spore_tetrahedra_remarks(&result.mesh, &options, &result.report);
      const char *told = strstr(remarks, ": try ");
      g_test_message("%zu cells: %s", cells, remarks);
      g_assert_true((told != NULL) == (turn == 0));
      if (told) cells = (size_t)strtoul(told + strlen(": try "), NULL, 10);
      g_assert_true((result.report.hausdorff > options.tolerance) == (turn == 0));
      g_free(remarks);
      spore_tetrahedral_mesh_clear(&result.mesh);
    }
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tetrahedra/open-shapes", test_open_shapes);
  g_test_add_func("/tetrahedra/small components", test_small_components);
  g_test_add_func("/tetrahedra/merged", test_merged);
  g_test_add_func("/tetrahedra/inside", test_inside);
  g_test_add_func("/tetrahedra/hollow-nests", test_hollow_nests);
  g_test_add_func("/tetrahedra/largest", test_largest);
  g_test_add_func("/tetrahedra/sheet", test_sheet);
  g_test_add_func("/tetrahedra/walls", test_walls);
  g_test_add_func("/tetrahedra/apart", test_apart);
  g_test_add_func("/tetrahedra/apart_thin", test_apart_thin);
  g_test_add_func("/tetrahedra/far", test_far);
  return g_test_run();
}
