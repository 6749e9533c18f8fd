/* Tetrahedra of all organs of a label map at once, with shared faces where they touch. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

gboolean spore_generate_wants_label(const SporeGenerateOptions *options, gsize i) {
  return !(options->unwanted[i / 64] >> (i % 64) & 1);
}

void spore_generate_want_label(SporeGenerateOptions *options, gsize i, gboolean wanted) {
  guint64 bit = (guint64)1 << (i % 64);
  options->unwanted[i / 64] = wanted ? options->unwanted[i / 64] & ~bit : options->unwanted[i / 64] | bit;
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  const SporeTetrahedraFields *fields = &work->options.fields.tetrahedra;
  const SporeLabelMap *map = spore_label_source_read(work->options.labels, progress, error);
  if (!map) return FALSE;
  g_autoptr(GArray) wanted = g_array_new(FALSE, FALSE, sizeof(guint16));
  for (gsize i = 0; i < spore_label_source_count(work->options.labels); i++) {
    guint16 label = spore_label_source_label(work->options.labels, i);
    if (spore_generate_wants_label(&work->options, i)) g_array_append_val(wanted, label);
  }
  if (!wanted->len)
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->source,
                             _("no organ is chosen; at least one was expected; choose some of the list"));
  SporeLabelTetrahedraOptions options = {.cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                         .size = fields->size,
                                         .labels = (const uint16_t *)(const void *)wanted->data,
                                         .label_count = wanted->len};
  return spore_label_tetrahedra(work->source, map, &options, &work->tetrahedra, &work->label_report, progress, error);
}

/* The name of a label in the list of those of the report. */
static char *name_of(const SporeGenerateWork *work, guint16 label) {
  for (gsize i = 0; i < spore_label_source_count(work->options.labels); i++)
    if (spore_label_source_label(work->options.labels, i) == label)
      return spore_label_source_name(work->options.labels, i);
  return g_strdup("");
}

static const SporeLabelFigures *figures_of(const SporeGenerateWork *work, guint i) {
  return &g_array_index(work->label_report.labels, SporeLabelFigures, i);
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GArray) labels = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (guint i = 0; i < work->label_report.labels->len; i++) {
    const SporeLabelFigures *figures = figures_of(work, i);
    guint32 label = figures->label;
    if (!figures->cells) continue; /* finer than the cells */
    g_ptr_array_add(names, name_of(work, figures->label));
    g_array_append_val(labels, label);
  }
  const SporeLabelBodies bodies = {.file = work->source,
                                   .content = spore_label_source_content(work->options.labels),
                                   .fields = &work->options.fields.tetrahedra,
                                   .mesh = &work->tetrahedra,
                                   .labels = (const guint32 *)(const void *)labels->data,
                                   .names = (char *const *)names->pdata,
                                   .count = labels->len,
                                   .use = (SporeLabelUse)work->options.purpose};
  return spore_edit_use_labels(document, &bodies, error);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeLabelTetrahedraReport *report = &work->label_report;
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu tetrahedra in %.1f s\nLeast angle %.1f°, mean %.1f°\nShared faces: %zu"),
                         work->tetrahedra.tetrahedron_count, report->seconds, report->quality.min_dihedral_deg,
                         report->quality.mean_dihedral_deg, report->shared_faces);
  if (!spore_label_source_content(work->options.labels))
    g_string_append(text, _("\nToo large a file for the scene to keep: it will not tell when the file changes"));
  for (guint i = 0; i < report->labels->len; i++) {
    const SporeLabelFigures *figures = figures_of(work, i);
    g_autofree char *name = name_of(work, figures->label);
    if (figures->cells)
      g_string_append_printf(text, _("\n%s: %zu cells, %.4g ml (%+.2f %%)"), name, figures->cells,
                             1e6 * figures->volume, 100 * (figures->volume / figures->voxel_volume - 1));
    else g_string_append_printf(text, _("\n%s: finer than the cells"), name);
  }
  return g_string_free(text, FALSE);
}

/* Qualities. */

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
    .generator = &spore_generator_labels,
    .title = N_("Organs of %s"),
    .working = N_("Generating tetrahedra"),
    .count_label = N_("Tetrahedra"),
    .cells = TRUE,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
    .run = run,
    .apply = apply,
    .facts = facts,
};
