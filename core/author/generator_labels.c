/* The generator of tetrahedra of a label map: all organs at once, with shared faces where they touch. */
#include "core/author/generator.h"

#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"
#include "core/scene/schema_tables.h"

typedef struct SporeLabelMapFields {
  const char *name, *file;
} SporeLabelMapFields;

static const SporeParameter label_map_parameters[] = {
    NAME(SporeLabelMapFields, N_("Name by which tetrahedra refer to the label map.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeLabelMapFields, file),
     .required = true,
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("File of the label map (NIfTI, NRRD), inside the scene's folder.")},
};

static const SporeElement map_elements[] = {
    {"label_map", N_("Label map"), N_("What each voxel of an image belongs to: organs are generated from it."),
     TABLE(label_map_parameters, SporeLabelMapFields)},
    {NULL},
};

/* Label maps come from a file, not from the mesh that a body shows. */
static SporeObject *no_target(SporeDocument *document, SporeObject *body) { return NULL; }

static const char *const label_uses[] = {"linked_bodies", "bodies", "one_body", "asset", NULL}; /* as SporeLabelUse */
static const SporeParameter label_purpose = SPORE_GENERATOR_PURPOSE(
    label_uses,
    N_("What Apply makes: a body of each organ, linked where they share faces or free of each other, one body of all "
       "that hangs together at shared faces, or an asset alone."));

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

/* The place of a label of the report in the source. */
static gsize place_of(const SporeGenerateWork *work, guint16 label) {
  gsize i = 0;
  while (spore_label_source_label(work->options.labels, i) != label) i++;
  return i;
}

static const SporeLabelFigures *figures_of(const SporeGenerateWork *work, guint i) {
  return &g_array_index(work->label_report.labels, SporeLabelFigures, i);
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GArray) labels = g_array_new(FALSE, FALSE, sizeof(guint32)),
                    guessed = g_array_new(FALSE, FALSE, sizeof(gboolean));
  for (guint i = 0; i < work->label_report.labels->len; i++) {
    const SporeLabelFigures *figures = figures_of(work, i);
    guint32 label = figures->label;
    if (!figures->cells) continue; /* the label is finer than the cells: no cell has it */
    const gsize place = place_of(work, figures->label);
    const gboolean guess = spore_label_source_is_guessed(work->options.labels, place);
    g_ptr_array_add(names, spore_label_source_name(work->options.labels, place));
    g_array_append_val(labels, label);
    g_array_append_val(guessed, guess);
  }
  const SporeLabelBodies bodies = {.file = work->source,
                                   .content = spore_label_source_content(work->options.labels),
                                   .fields = &work->options.fields.tetrahedra,
                                   .mesh = &work->tetrahedra,
                                   .labels = (const guint32 *)(const void *)labels->data,
                                   .names = (char *const *)names->pdata,
                                   .guessed = (const gboolean *)(const void *)guessed->data,
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
    g_autofree char *name = spore_label_source_name(work->options.labels, place_of(work, figures->label));
    if (figures->cells)
      g_string_append_printf(text, _("\n%s: %zu cells, %.4g ml (%+.2f %%)"), name, figures->cells,
                             1e6 * figures->volume, 100 * (figures->volume / figures->voxel_volume - 1));
    else g_string_append_printf(text, _("\n%s: finer than the cells"), name);
  }
  return g_string_free(text, FALSE);
}

const SporeGeneratorType spore_generator_labels = {
    .name = "labels",
    .command = "tetrahedra",
    .element = "tetrahedra",
    .elements = map_elements,
    .only = (const char *const[]){"cells", "size", NULL},
    .count = "cells",
    .ways = "cells | size",
    .purpose = &label_purpose,
    .target = no_target,
    .shows = "labels",
    .title = N_("Organs of %s"),
    .working = N_("Generating tetrahedra"),
    .count_label = N_("Tetrahedra"),
    .run = run,
    .apply = apply,
    .facts = facts,
};
