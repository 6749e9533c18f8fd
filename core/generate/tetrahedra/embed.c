/* The solid is embedded in a lattice finer than the wanted cells, so that the lattice has thin walls and slits. The
 * lattice is then coarsened. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/common/common.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define CELLS_A_CUBE 12 /* of the lattice */
#define EDGE_SCALE 0.7  /* circumradius bound of cells whose edges have length 1 */
#define FINE 12.0       /* cells of the first lattice for each wanted cell */
#define USUAL 5000.0    /* wanted cells: above this, the first lattice has fewer cells for each wanted cell */
#define LEAST_FINE 2.0
#define FINER 2.5 /* times as many cells in the next lattice */
#define MOST_LATTICES 2
#define MOST_WIDENINGS 2
#define MOST_FINE 1000000.0
#define NEAR 0.9 /* of the tolerance: the wanted distance of a lattice */
#define POINTS 4 /* of the surface, for each cell */
#define LEAST_POINTS 1000
#define BORDER_TURNS 2  /* of moving the borders between pieces, before the lattice is coarsened */
#define MOST_APART 1.05 /* times as many cells as wanted: of more, a thin piece is merged */
#define NEAR_APART 1    /* wanted edges: the skin is not moved farther, as long as there are pieces to merge */
#define GOAL 14         /* degrees, for the least angle */
#define REGION 0.8      /* edge of the lattice, as a share of the least size of a region */

/* Edge of a lattice with this number of cells. */
static double edge_of(const SporeTetrahedraWork *work, double cells) {
  return cbrt(CELLS_A_CUBE * work->volume / cells);
}

/* Makes a lattice and widens thin walls and slits until the lattice has them. */
static bool stuff(SporeTetrahedraWork *work, double edge, SporeTetrahedralMesh *mesh, SporeError *error) {
  double missed = HUGE_VAL;
  for (int i = 0; missed > (i > 1 ? NEAR * work->options.tolerance : 0); i++) {
    spore_tetrahedral_mesh_clear(mesh);
    if (!spore_tetrahedra_stuff(work, edge, mesh, error)) return false;
    if (i == MOST_WIDENINGS) break;
    if (!work->thin.walls && mesh->tetrahedron_count && !spore_tetrahedra_close(work, mesh, error)) return false;
    if (!spore_tetrahedra_find_thin(work, mesh, edge, &missed, error)) return false;
  }
  return true;
}

/* Runs before coarsening: coarsening would turn a small component into one cell of full size. */
static bool drop_small(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error) {
  SporeTetrahedraReport pieces;
  bool done = spore_tetrahedra_drop_small(work, mesh, &pieces, error);
  work->thin.small_components = done ? pieces.small_components : 0;
  return done;
}

/* Makes a lattice near the surface. A lattice that is too far is replaced by a finer one. */
static bool make_fine(SporeTetrahedraWork *work, double cells, SporeTetrahedralMesh *mesh, SporeError *error) {
  const double from = work->fraction, share = work->share;
  double distance = HUGE_VAL;
  bool done = true;
  for (int i = 0; i < MOST_LATTICES && done && distance > NEAR * work->options.tolerance; i++) {
    work->fraction = from + share * i / MOST_LATTICES, work->share = share / MOST_LATTICES;
    done = stuff(work, edge_of(work, cells), mesh, error);
    if (done && mesh->tetrahedron_count) {
      double inner, area;
      done = spore_tetrahedra_mend(mesh, error) && drop_small(work, mesh, error) &&
             spore_tetrahedra_near(work, spore_tetrahedra_bounds(work), 1, mesh, error) &&
             spore_tetrahedra_distances(work, mesh, &distance, &inner, &area, error);
    }
    if (FINER * cells > MOST_FINE) break;
    cells *= FINER;
  }
  work->fraction = from, work->share = share;
  if (!done || mesh->tetrahedron_count) return done;
  return spore_error_set(error, SPORE_ERROR_NUMERICAL, NULL,
                         _("no node of a lattice lies inside; expected walls no thinner than the cells; ask for more "
                           "cells or a smaller size"));
}

/* Number of cells that the sizes give. */
static double count_of(const SporeSizing *sizing, const SporeTetrahedralMesh *mesh) {
  double sum = 0;
  for (size_t t = 0; t < mesh->tetrahedron_count; t++) {
    SporeVec3 p[4];
    double middle[3] = {0, 0, 0};
    for (size_t k = 0; k < 4; k++) {
      p[k] = spore_mesh_vertex(mesh->vertices, mesh->tetrahedra[4 * t + k]);
      middle[0] += 0.25 * p[k].x, middle[1] += 0.25 * p[k].y, middle[2] += 0.25 * p[k].z;
    }
    sum += spore_vec3_volume(p[0], p[1], p[2], p[3]) /
           (6 * SPORE_TETRAHEDRA_CELL * pow(spore_sizing_at(sizing, middle), 3));
  }
  return sum;
}

/* plan->grid: edge lengths for the wanted number of cells. */
static void size_edges(SporeSizingPlan *plan, const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh) {
  const SporeTetrahedraOptions *options = &work->options;
  const size_t nodes = plan->grid.count[0] * plan->grid.count[1] * plan->grid.count[2];
  double edge = options->cells ? cbrt(work->volume / (SPORE_TETRAHEDRA_CELL * (double)options->cells)) : options->size;
  for (int i = 0; i < 8; i++) {
    spore_sizing_plan_scale(plan, EDGE_SCALE * edge);
    for (size_t n = 0; n < nodes; n++) plan->grid.size[n] /= EDGE_SCALE;
    if (!options->cells) return;
    edge *= cbrt(fmin(fmax(count_of(&plan->grid, mesh) / (double)options->cells, 0.5), 2));
  }
}

/* Chooses the number of cells of the first lattice. */
static bool choose_fine(const SporeTetrahedraWork *work, double *cells, SporeError *error) {
  const SporeTetrahedraOptions *options = &work->options;
  double wanted =
      options->cells ? (double)options->cells : work->volume / (SPORE_TETRAHEDRA_CELL * pow(options->size, 3));
  double fine = wanted * fmin(fmax(FINE * USUAL / wanted, LEAST_FINE), FINE), least = HUGE_VAL;
  for (size_t r = 0; r < options->region_count; r++) least = fmin(least, options->regions[r].value);
  *cells = fmax(fine, CELLS_A_CUBE * work->volume / pow(REGION * least, 3));
  if (*cells <= fmax(fine, MOST_FINE)) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("cells as small as a region asks for take a lattice of %.0f; expected at most %.0f; ask for "
                           "larger ones there, or leave out the method"),
                         *cells, MOST_FINE);
}

/* Coarsens the mesh. limits: as of spore_tetrahedra_coarsen. */
static bool reduce(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, const SporeSizing *sizing, size_t cells,
                   const double limits[2], SporeError *error) {
  const SporeProgress progress = {spore_tetrahedra_report, work};
  SporeSkinPoints points = {0};
  const bool done = spore_tetrahedra_points(work, mesh, POINTS * cells + LEAST_POINTS, &points, error) &&
                    spore_tetrahedra_coarsen(mesh, spore_tetrahedra_bounds(work), &points, sizing, cells, NULL,
                                             SPORE_TETRAHEDRA_KEPT, limits, &progress, error) &&
                    spore_tetrahedral_mesh_drop_unused(mesh, error);
  spore_skin_points_clear(&points);
  return done;
}

/* Coarsens a mesh whose pieces are kept apart. Where that leaves too many cells, the thin piece that costs most is
 * merged, and so on. */
static bool reduce_apart(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, const SporeSizing *sizing, size_t cells,
                         SporeError *error) {
  const double edge = cbrt(work->volume / (SPORE_TETRAHEDRA_CELL * (double)cells));
  double limits[2] = {spore_coarsen_limits[0], NEAR_APART};
  bool merged = work->options.cells > 0;
  while (merged) {
    if (!reduce(work, mesh, sizing, cells, limits, error)) return false;
    limits[0] = NEAR_APART;
    if ((double)mesh->tetrahedron_count <= MOST_APART * (double)cells) break;
    if (!spore_tetrahedra_merge_thin(work, mesh, edge, &merged, error)) return false;
  }
  limits[1] = spore_coarsen_limits[1];
  return reduce(work, mesh, sizing, cells, limits, error);
}

/* Makes the cells of a lattice fewer, of the wanted sizes. */
static bool make_fewer(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error) {
  SporeSizingPlan plan;
  if (!spore_sizing_plan_create(&plan, work, &work->surface, error)) return false;
  size_edges(&plan, work, mesh);
  const size_t cells = work->options.cells ? work->options.cells : (size_t)ceil(count_of(&plan.grid, mesh));
  const bool done = mesh->labels ? reduce_apart(work, mesh, &plan.grid, cells, error)
                                 : reduce(work, mesh, &plan.grid, cells, spore_coarsen_limits, error);
  spore_sizing_plan_clear(&plan);
  return done;
}

bool spore_tetrahedra_voxels(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeError *error) {
  const double from = work->fraction, share = work->share;
  const SporeProgress progress = {spore_tetrahedra_report, work};
  double cells;
  *mesh = (SporeTetrahedralMesh){0};
  work->share = 0.4 * share;
  bool done = choose_fine(work, &cells, error) && make_fine(work, cells, mesh, error);
  if (done && work->options.apart)
    done = spore_tetrahedra_part(work, mesh, error) &&
           spore_tetrahedra_near(work, spore_tetrahedra_bounds(work), BORDER_TURNS, mesh, error) &&
           spore_tetrahedra_measure_places(work, mesh, error);
  work->fraction = from + 0.4 * share, work->share = 0.5 * share;
  done = done && make_fewer(work, mesh, error);
  work->fraction = from + 0.9 * share, work->share = 0.1 * share;
  done = done &&
         spore_tetrahedra_improve(mesh, mesh->labels ? &mesh->labels : NULL, spore_tetrahedra_bounds(work), GOAL,
                                  &progress, error) &&
         spore_tetrahedra_near(work, spore_tetrahedra_bounds(work), 4, mesh, error) &&
         spore_tetrahedral_mesh_validate(mesh, error);
  work->fraction = from, work->share = share;
  if (!done) spore_tetrahedral_mesh_clear(mesh);
  return done;
}
