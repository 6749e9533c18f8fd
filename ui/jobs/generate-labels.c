/* Tetrahedra of all organs of a label map at once, with shared faces where they touch. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

static const SporeLabelFigures *figures_of(const SporeGenerateWork *work, guint i) {
  return &g_array_index(work->label_report.labels, SporeLabelFigures, i);
}

/* Place of a label in the report. */
static guint place_of(const SporeGenerateWork *work, guint32 label) {
  guint i = 0;
  while (i + 1 < work->label_report.labels->len && figures_of(work, i)->label != label) i++;
  return i;
}

static void measure_organs(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->tetrahedra.tetrahedron_count;
  quality->values = g_new(double, quality->count);
  for (gsize i = 0; i < quality->count; i++) quality->values[i] = place_of(work, work->tetrahedra.labels[i]) + 1;
}

/* Faces between organs are inside, and seen where the mesh is cut open. */
static void show_cells(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_cells(&work->tetrahedra, places, candidate);
}

static const SporeGenerateQuality qualities[] = {
    {N_("Organ"), "", TRUE, measure_organs, show_cells},
    {N_("Least angle"), "°", FALSE, spore_generate_measure_angles, show_cells},
};

const SporeGenerateType spore_generate_labels = {
    .shows = "labels",
    .cells = TRUE,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
};
