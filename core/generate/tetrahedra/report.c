/* The figures of generated tetrahedra, and the remarks for the user. */

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/generate/tetrahedra/private.h"

#define LEAST_SAID 5e-4 /* share of the surface: a smaller share would print as 0.0 % and gets no remark */
#define MOST_MORE 8.0   /* times as many cells as there are: edges of half the length */
#define MANY 1.1        /* times as many cells as wanted */

/* Remarks on pieces of the mesh that are not connected, where the surface is. */
static void say_apart(GString *text, const SporeTetrahedraReport *report) {
  if (report->small_components > 0)
    g_string_append_printf(text,
                           _("left out: small components that hung together with nothing, %.2g %% of the volume\n"),
                           100 * report->small_components);
  if (report->pieces > report->pieces_given)
    g_string_append_printf(
        text,
        _("the cells fall into %zu pieces, the surface into %zu: parts are thinner than a cell; ask for more "
          "cells, or for smaller ones there by a region\n"),
        report->pieces, report->pieces_given);
}

/* Remarks on differences between the solid and the surface, and what to do about them. */
static void say_left_out(GString *text, const SporeTetrahedraOptions *options, const SporeTetrahedraReport *report) {
  if (report->inner_share >= LEAST_SAID && !options->apart)
    g_string_append_printf(
        text,
        _("%.1f %% of the surface are walls inside the solid, up to %.2f %% of the diagonal from its outside: "
          "they are left out, and what they enclose is filled; for cells of their own, keep the pieces apart\n"),
        100 * report->inner_share, 100 * report->inner_distance);
  spore_tetrahedra_say_walls(text, report);
  if (report->thickened > 0)
    g_string_append_printf(
        text,
        _("%.1f %% of the surface bound walls that are too thin for the cells of the lattice: they are made "
          "about %.3g mm thick; ask for more cells, or for smaller ones there by a region\n"),
        100 * report->thickened, 1e3 * report->thickness);
  if (report->widened > 0)
    g_string_append_printf(
        text,
        _("%.1f %% of the surface bound slits that are too narrow for the cells of the lattice: they are made "
          "about %.3g mm wide; ask for more cells, or for smaller ones there by a region\n"),
        100 * report->widened, 1e3 * report->thickness);
}

/* A remark on cells that are farther from the surface than asked for. The distance of smooth parts falls with the
 * square of the edges' length; parts that were lost as too thin come back in finer cells. */
static void say_far(GString *text, const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                    const SporeTetrahedraReport *report) {
  const double wanted = options->tolerance > 0 ? options->tolerance : SPORE_TETRAHEDRA_TOLERANCE;
  if (!options->cells || !(report->hausdorff > wanted)) return;
  const double ratio = report->hausdorff / wanted, count = (double)mesh->tetrahedron_count;
  const double more = 100 * ceil(fmin(ratio * ratio, MOST_MORE) * count / 100);
  g_string_append_printf(
      text, _("the cells are %.2g %% of the diagonal away from the surface, %.2g %% were asked for: try %.0f cells\n"),
      100 * report->hausdorff, 100 * wanted, more);
}

/* A remark on pieces that were kept apart. */
static void say_apart_faces(GString *text, const SporeTetrahedraOptions *options, const SporeTetrahedraReport *report) {
  if (!options->apart) return;
  g_string_append_printf(text,
                         _("pieces kept apart share %zu faces, at most %.2f %% of the diagonal from their surfaces\n"),
                         report->shared_faces, 100 * report->border_distance);
  if (report->border_lost >= LEAST_SAID)
    g_string_append_printf(text,
                           _("%.1f %% of the surfaces between pieces have no such faces: a piece is too thin there\n"),
                           100 * report->border_lost);
}

/* A remark on pieces that were merged, as they are too thin for so few cells. */
static void say_merged(GString *text, const SporeTetrahedraOptions *options, const SporeTetrahedraReport *report) {
  size_t merged = 0;
  double enough = 0;
  for (size_t i = 0; i < report->piece_count; i++) {
    const SporeTetrahedraPiece *piece = report->piece + i;
    if (piece->merged < 0) continue;
    merged++;
    const double cells = spore_tetrahedra_cells_for(report, piece);
    if (cells <= SPORE_TETRAHEDRA_CELLS) enough = fmax(enough, cells);
  }
  if (enough > 0)
    g_string_append_printf(text,
                           _("%zu cells were asked for: pieces too thin for so few were merged with others: %zu; about "
                             "%.0f cells would do for all that cells can show\n"),
                           options->cells, merged, enough);
}

/* Remarks on requests that were not met. */
static void say_missed(GString *text, const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                       const SporeTetrahedraReport *report) {
  if (options->cells && (double)mesh->tetrahedron_count > MANY * (double)options->cells)
    g_string_append_printf(
        text,
        options->apart
            ? _("%zu cells were asked for: fewer than %zu would tear thin parts, make cells too flat, or move the "
                "borders of pieces thinner than the cells; ask for more, merge the pieces, or leave out thin ones\n")
            : _("%zu cells were asked for: fewer than %zu would tear thin parts, or make cells too flat; ask for "
                "more, or give a plainer surface\n"),
        options->cells, mesh->tetrahedron_count);
  if (options->fill && report->filled > 0)
    g_string_append_printf(text, _("cavities of %.3g ml were filled\n"), 1e6 * report->filled);
  else if (options->fill)
    g_string_append(text, _("nothing was filled: no cavity is closed off; give a gap, and openings narrower than it "
                            "are closed\n"));
}

char *spore_tetrahedra_remarks(const SporeTetrahedralMesh *mesh, const SporeTetrahedraOptions *options,
                               const SporeTetrahedraReport *report) {
  GString *text = g_string_new(NULL);
  spore_tetrahedra_say_pieces(text, options, report);
  say_apart(text, report);
  say_left_out(text, options, report);
  say_apart_faces(text, options, report);
  say_merged(text, options, report);
  say_far(text, mesh, options, report);
  say_missed(text, mesh, options, report);
  return g_string_free(text, FALSE);
}

static void report_pieces(const SporeTetrahedraWork *work, SporeTetrahedraReport *report) {
  report->piece_count = work->piece_count;
  report->piece_total = work->pieces;
  report->unwanted = work->unwanted;
  memcpy(report->piece, work->piece, sizeof report->piece);
}

/* Shares of the surface that the solid does not show as given. */
static void report_left_out(const SporeTetrahedraWork *work, SporeTetrahedraReport *report) {
  const double bounding = (double)work->bounding_count;
  report->inner_share = (double)work->inner_count / (bounding + (double)work->inner_count);
  if (report->method != SPORE_TETRAHEDRA_VOXELS) return;
  report->thickened = fmin((double)work->thin.wall_count / bounding, 1);
  report->widened = fmin((double)work->thin.slit_count / bounding, 1);
  report->small_components += work->thin.small_components;
  report->thickness = report->thickened > 0 || report->widened > 0 ? 2 * work->thin.reach : 0;
}

bool spore_tetrahedra_measure(SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh,
                              SporeTetrahedraReport *report, SporeError *error) {
  if (!spore_tetrahedra_progress(work, 0, _("measuring the distance"), error)) return false;
  spore_tetrahedral_mesh_quality(mesh, &report->quality);
  report_left_out(work, report);
  if (mesh->labels && !spore_tetrahedra_measure_parted(work, mesh, report, error)) return false;
  report_pieces(work, report);
  return spore_tetrahedra_distances(work, mesh, &report->hausdorff, &report->inner_distance, &report->area, error);
}

void spore_tetrahedra_to_metres(SporeTetrahedraReport *report, const SporeTetrahedraWork *work,
                                SporeTetrahedralMesh *mesh, double diagonal, const double centre[3]) {
  for (gsize i = 0; i < 3 * mesh->vertex_count; i++) mesh->vertices[i] = mesh->vertices[i] * diagonal + centre[i % 3];
  report->quality.volume *= pow(diagonal, 3);
  report->volume = report->quality.volume;
  report->volume_given = work->volume * pow(diagonal, 3);
  report->filled = (work->filled + work->filled_by_method) * pow(diagonal, 3);
  report->area *= diagonal * diagonal;
  report->thickness *= diagonal;
  for (size_t i = 0; i < report->piece_count; i++) {
    SporeTetrahedraPiece *piece = report->piece + i;
    for (int k = 0; k < 3; k++) piece->size[k] *= diagonal;
    piece->depth[0] *= diagonal, piece->depth[1] *= diagonal;
    piece->area *= diagonal * diagonal;
    piece->thickness *= diagonal;
  }
  report->area_given = work->area * diagonal * diagonal;
  report->volume_change = report->volume / report->volume_given - 1;
  report->area_change = report->area / report->area_given - 1;
}
