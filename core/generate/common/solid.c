/* The solid of a surface: an octree of cells that contains it, its volume, and the regions of denser sampling. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/solid.h"

#define CELL_BUDGET 12000 /* cells are divided while fewer than this are on the boundary */
#define MOST_DIVISIONS 12
#define VOLUME_TRIES 32768 /* points that estimate the volume */
#define LEAST_FILLING 1e-3 /* of the volume of the cells: below this the surface is taken to enclose nothing */

typedef struct Cells {
  double *cells; /* x 4 */
  bool *inside;
  size_t count, capacity;
} Cells;

static bool cells_add(Cells *cells, const double lower[3], double edge, bool inside) {
  size_t capacity = cells->capacity; /* of both arrays */
  double *places = spore_room_for_one(cells->cells, cells->count, &capacity, 4096, 4 * sizeof *places);
  if (places) cells->cells = places;
  bool *sides = places ? spore_room_for_one(cells->inside, cells->count, &cells->capacity, 4096, sizeof *sides) : NULL;
  if (!sides) return false;
  cells->inside = sides;
  double *cell = cells->cells + 4 * cells->count;
  memcpy(cell, lower, 3 * sizeof *cell);
  cell[3] = edge;
  cells->inside[cells->count++] = inside;
  return true;
}

/* Classifies the cell by the depth of its centre: an outside cell is dropped, any other is added, with a mark if it
 * is wholly inside. */
static bool cells_sift(Cells *next, const SporeBvh *bvh, const double lower[3], double edge) {
  SporeVec3 middle = spore_vec3(lower[0] + edge / 2, lower[1] + edge / 2, lower[2] + edge / 2);
  double depth = spore_bvh_depth(bvh, middle), reach = edge * (sqrt(3) / 2);
  return depth < -reach || cells_add(next, lower, edge, depth > reach);
}

static bool divide_cells(const Cells *cells, Cells *next, const SporeBvh *bvh) {
  for (size_t i = 0; i < cells->count; i++) {
    const double *cell = cells->cells + 4 * i;
    if (cells->inside[i]) {
      if (!cells_add(next, cell, cell[3], true)) return false;
      continue;
    }
    double half = cell[3] / 2;
    for (int k = 0; k < 8; k++) {
      double lower[3] = {cell[0] + (k & 1 ? half : 0), cell[1] + (k & 2 ? half : 0), cell[2] + (k & 4 ? half : 0)};
      if (!cells_sift(next, bvh, lower, half)) return false;
    }
  }
  return true;
}

static size_t boundary_cells(const Cells *cells) {
  size_t count = 0;
  for (size_t i = 0; i < cells->count; i++) count += !cells->inside[i];
  return count;
}

/* The leaves of an octree around the solid: fine at the surface, as deep as the budget allows. */
static bool build_cells(SporeSolid *solid, const SporeMeshReport *report) {
  double edge = 0;
  for (int k = 0; k < 3; k++) edge = fmax(edge, report->upper[k] - report->lower[k]);
  Cells cells = {0};
  bool done = cells_add(&cells, report->lower, edge * (1 + 1e-9), false);
  for (int division = 0; done && division < MOST_DIVISIONS; division++) {
    size_t boundary = boundary_cells(&cells);
    if (!boundary || 4 * boundary > CELL_BUDGET) break;
    Cells next = {0};
    done = divide_cells(&cells, &next, solid->bvh);
    spore_free(cells.cells);
    spore_free(cells.inside);
    cells = next;
  }
  solid->cells = cells.cells;
  solid->cell_inside = cells.inside;
  solid->cell_count = cells.count;
  solid->cell_end = done ? SPORE_NEW_ARRAY(double, cells.count) : NULL;
  if (!solid->cell_end) return false;
  double sum = 0;
  for (size_t i = 0; i < cells.count; i++) solid->cell_end[i] = sum += pow(cells.cells[4 * i + 3], 3);
  return true;
}

static bool sum_areas(SporeSolid *solid) {
  solid->triangle_end = SPORE_NEW_ARRAY(double, solid->mesh.triangle_count);
  double sum = 0;
  for (size_t t = 0; solid->triangle_end && t < solid->mesh.triangle_count; t++) {
    SporeVec3 p[3];
    for (int k = 0; k < 3; k++)
      p[k] = spore_vec3_load(solid->mesh.vertices + 3 * (size_t)solid->mesh.triangles[3 * t + k]);
    sum += 0.5 * spore_vec3_length(spore_vec3_cross(spore_vec3_sub(p[1], p[0]), spore_vec3_sub(p[2], p[0])));
    solid->triangle_end[t] = sum;
  }
  return solid->triangle_end;
}

static void estimate_volume(SporeSolid *solid) {
  SporeRandom random = {1};
  size_t hits = 0;
  double p[3];
  for (size_t i = 0; i < VOLUME_TRIES; i++)
    hits += spore_solid_try(solid, ((double)i + spore_random_unit(&random)) / VOLUME_TRIES, &random, p);
  double filling = (double)hits / VOLUME_TRIES;
  solid->volume = filling > LEAST_FILLING ? filling * solid->cell_end[solid->cell_count - 1] : 0;
}

static void turn(SporeTriangleMesh *mesh) {
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    uint32_t swap = mesh->triangles[3 * t + 1];
    mesh->triangles[3 * t + 1] = mesh->triangles[3 * t + 2];
    mesh->triangles[3 * t + 2] = swap;
  }
}

static void forget_cells(SporeSolid *solid) {
  spore_bvh_free(solid->bvh);
  spore_free(solid->cells);
  spore_free(solid->cell_end);
  spore_free(solid->cell_inside);
  solid->bvh = NULL;
  solid->cells = solid->cell_end = NULL;
  solid->cell_inside = NULL;
}

static bool find_volume(SporeSolid *solid, const SporeMeshReport *report, SporeError *error) {
  solid->bvh = spore_bvh_create(&solid->mesh, error);
  if (!solid->bvh) return false;
  if (!build_cells(solid, report)) return spore_generate_no_memory(error);
  if (solid->cell_count) estimate_volume(solid);
  return true;
}

bool spore_solid_create(SporeSolid *solid, const SporeTriangleMesh *mesh, SporeError *error) {
  SporeMeshReport report;
  *solid = (SporeSolid){0};
  if (!spore_triangle_mesh_validate(mesh, error) || !spore_triangle_mesh_report(mesh, &report, error)) return false;
  bool done = spore_triangle_mesh_copy(&solid->mesh, mesh, error);
  solid->diagonal = report.diagonal;
  for (int attempt = 0; done && attempt < 2 && !(solid->volume > 0); attempt++) {
    forget_cells(solid);
    if (attempt || report.volume < 0) turn(&solid->mesh);
    done = find_volume(solid, &report, error);
  }
  if (done && !(solid->volume > 0))
    done =
        spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                        _("the surface encloses no volume (%zu open edges, %zu edges with neighbours turned apart); a "
                          "closed surface was expected; close its holes or turn its triangles alike, or take it for a "
                          "sheet (spore spheres --thickness)"),
                        report.boundary_edges, report.misoriented_edges);
  if (done && !sum_areas(solid)) done = spore_generate_no_memory(error);
  if (!done) spore_solid_clear(solid);
  return done;
}

void spore_solid_clear(SporeSolid *solid) {
  forget_cells(solid);
  spore_free(solid->triangle_end);
  spore_triangle_mesh_clear(&solid->mesh);
  *solid = (SporeSolid){0};
}

double spore_solid_factor(const SporeSolid *solid, SporeVec3 p) {
  double factor = 0;
  for (size_t i = 0; i < solid->region_count; i++) {
    const SporeGenerateRegion *region = &solid->regions[i];
    if (spore_vec3_distance(p, spore_vec3_load(region->centre)) <= region->radius) factor = fmax(factor, region->value);
  }
  return factor > 0 ? factor : 1;
}
