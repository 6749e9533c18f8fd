/* Tetrahedra in a surface. */
#include <glib/gi18n.h>

#include "core/author/generated_edits.h"
#include "core/generate/tetrahedra/tetrahedra.h"
#include "ui/jobs/generate-types.h"

static void measure_cells(const SporeGenerateWork *work, SporeQuality *quality,
                          double (*figure)(const SporeTetrahedraQuality *found)) {
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) {
    SporeTetrahedralMesh one = {work->tetrahedra.vertex_count, 1, work->tetrahedra.vertices,
                                work->tetrahedra.tetrahedra + 4 * i};
    SporeTetrahedraQuality found;
    spore_tetrahedral_mesh_quality(&one, &found);
    quality->values[i] = figure(&found);
  }
}

static double angle(const SporeTetrahedraQuality *found) { return found->min_dihedral_deg; }
static double radius_ratio(const SporeTetrahedraQuality *found) { return found->worst_radius_ratio; }
static double volume(const SporeTetrahedraQuality *found) { return 1e9 * found->volume; }

void spore_generate_measure_angles(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, angle);
}
static void measure_ratios(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, radius_ratio);
}
static void measure_volumes(const SporeGenerateWork *work, SporeQuality *quality) {
  measure_cells(work, quality, volume);
}

static void show_cells(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_cells(&work->tetrahedra, places, candidate);
}

static const SporeGenerateQuality qualities[] = {
    {N_("Least angle"), "°", FALSE, spore_generate_measure_angles, show_cells},
    {N_("Radius ratio"), "", FALSE, measure_ratios, show_cells},
    {N_("Volume"), "mm³", FALSE, measure_volumes, show_cells},
};

const SporeGenerateType spore_generate_tetrahedra = {
    .shows = "tetrahedra",
    .counts = (const size_t[]){300, 600, 1200, 2500, 5000, 10000, 0},
    .error_label = N_("Distance"),
    .worth = 0.1,
    .cells = TRUE,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
};
