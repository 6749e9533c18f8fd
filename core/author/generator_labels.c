/* The generator of tetrahedra of a label map: all organs at once, with shared faces where they touch. */
#include "core/author/generator.h"

#include <glib/gi18n.h>

#include "core/author/anatomy.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "core/author/generator_work.h"
#include "core/author/label_choice.h"
#include "core/author/label_surroundings.h"
#include "core/scene/schema_tables.h"

#define SOFT_SHARE 0.7 /* of the time, where surroundings are made too */

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

/* The place of a label in the source. */
static gsize place_of(const SporeGenerateWork *work, guint16 label) {
  gsize i = 0;
  while (spore_label_source_label(work->options.labels, i) != label) i++;
  return i;
}

static const SporeLabelFigures *figures_of(const SporeGenerateWork *work, guint i) {
  return &g_array_index(work->label_report.labels, SporeLabelFigures, i);
}

/* Those labels of the source that were chosen for it. GArray of guint16. */
static GArray *chosen_for(const SporeGenerateWork *work, SporeLabelChoice choice) {
  GArray *chosen = g_array_new(FALSE, FALSE, sizeof(guint16));
  for (gsize i = 0; i < spore_label_source_count(work->options.labels); i++) {
    guint16 label = spore_label_source_label(work->options.labels, i);
    if (spore_label_choice(&work->options, i) == choice) g_array_append_val(chosen, label);
  }
  return chosen;
}

static gboolean make_soft(SporeGenerateWork *work, const SporeLabelMap *map, const GArray *soft,
                          const SporeProgress *progress, GError **error) {
  const SporeTetrahedraFields *fields = &work->options.fields.tetrahedra;
  g_autofree double *weights = g_new(double, soft->len);
  SporeLabelTetrahedraOptions options = {.cells = fields->size > 0 ? 0 : (size_t)fields->cells,
                                         .size = fields->size,
                                         .labels = (const uint16_t *)(const void *)soft->data,
                                         .label_count = soft->len,
                                         .weights = weights};
  for (guint i = 0; i < soft->len; i++) {
    g_autofree char *name = spore_label_source_name(work->options.labels, place_of(work, options.labels[i]));
    weights[i] = spore_anatomy_cell_weight(name);
  }
  return spore_label_tetrahedra(work->source, map, &options, &work->tetrahedra, &work->label_report, progress, error);
}

static gboolean make_surroundings(SporeGenerateWork *work, const SporeLabelMap *map, const GArray *around,
                                  const SporeProgress *progress, GError **error) {
  work->surroundings = spore_label_surroundings_new();
  for (guint i = 0; i < around->len; i++) {
    const guint16 label = g_array_index(around, guint16, i);
    const gsize place = place_of(work, label);
    const SporeLabelSurrounding one = {.surface = {.label = label},
                                       .name = spore_label_source_name(work->options.labels, place),
                                       .guessed = spore_label_source_is_guessed(work->options.labels, place)};
    g_array_append_val(work->surroundings, one);
  }
  return spore_label_surroundings_make(work->surroundings, map, progress, error);
}

static gboolean run(SporeGenerateWork *work, const SporeProgress *progress, GError **error) {
  const SporeLabelMap *map = spore_label_source_read(work->options.labels, progress, error);
  if (!map || work->options.listing) return map != NULL;
  g_autoptr(GArray) soft = chosen_for(work, SPORE_LABEL_SOFT), around = chosen_for(work, SPORE_LABEL_AROUND);
  if (!soft->len && !around->len)
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->source,
                             _("no organ is chosen; at least one was expected; choose some of the list"));
  SporeProgressShare share = {.whole = progress, .share = around->len ? SOFT_SHARE : 1};
  const SporeProgress part = spore_progress_of_share(&share);
  if (soft->len && !make_soft(work, map, soft, &part, error)) return FALSE;
  if (!around->len) return TRUE;
  share.done = soft->len ? SOFT_SHARE : 0, share.share = 1 - share.done;
  return make_surroundings(work, map, around, &part, error);
}

static gboolean apply_soft(const SporeGenerateWork *work, SporeDocument *document, GError **error) {
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

/* Holds the soft bodies from the place `first` on, which would fall out of sight otherwise. */
static gboolean hold_from(SporeDocument *document, guint first, GError **error) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = first; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if ((SporeRole)spore_object_number(body, "role") == SPORE_PASSIVE && !spore_edit_add_pin(document, body, error))
      return FALSE;
  }
  return TRUE;
}

static gboolean apply_all(const SporeGenerateWork *work, SporeDocument *document, GError **error) {
  GArray *around = work->surroundings;
  const guint before = spore_object_child_count(spore_document_section(document, "bodies"));
  if (work->label_report.labels && (!apply_soft(work, document, error) || !hold_from(document, before, error)))
    return FALSE;
  return !around ||
         spore_edit_add_surroundings(document, (SporeLabelSurrounding *)(void *)around->data, around->len, NULL, error);
}

static gboolean apply(const SporeGenerateWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  spore_document_begin(document, _("Generate tetrahedra"));
  return spore_edit_finish(document, apply_all(work, document, error));
}

/* What the map holds, before anything is made. */
static char *list_facts(const SporeGenerateWork *work) {
  const SporeLabelSource *source = work->options.labels;
  double volume = 0;
  for (gsize i = 0; i < spore_label_source_count(source); i++) volume += spore_label_source_volume(source, i);
  return g_strdup_printf(_("%zu organs, %.4g ml in all\nSay in the list which are soft, which stand around them and "
                           "which are left out; Apply makes them, Mesh shows them first"),
                         spore_label_source_count(source), 1e6 * volume);
}

static void add_label(GString *text, const SporeGenerateWork *work, const SporeLabelFigures *figures) {
  g_autofree char *name = spore_label_source_name(work->options.labels, place_of(work, figures->label));
  if (figures->cells)
    g_string_append_printf(text, _("\n%s: %zu cells (%.0f %%), %.4g ml (%+.2f %%)"), name, figures->cells,
                           100 * (double)figures->cells / (double)work->tetrahedra.tetrahedron_count,
                           1e6 * figures->volume, 100 * (figures->volume / figures->voxel_volume - 1));
  else g_string_append_printf(text, _("\n%s: finer than the cells"), name);
}

static void add_surroundings(GString *text, const GArray *surroundings) {
  gsize triangles = 0;
  for (guint i = 0; surroundings && i < surroundings->len; i++)
    triangles += g_array_index(surroundings, SporeLabelSurrounding, i).surface.mesh.triangle_count;
  if (surroundings)
    g_string_append_printf(text, _("\nAround them: %u unmovable, %zu triangles"), surroundings->len, triangles);
}

static char *facts(const SporeGenerateWork *work) {
  const SporeLabelTetrahedraReport *report = &work->label_report;
  if (work->options.listing) return list_facts(work);
  GString *text = g_string_new(NULL);
  g_string_append_printf(text, _("%zu tetrahedra in %.1f s"), work->tetrahedra.tetrahedron_count, report->seconds);
  if (report->labels)
    g_string_append_printf(text, _("\nLeast angle %.1f°, mean %.1f°\nShared faces: %zu"),
                           report->quality.min_dihedral_deg, report->quality.mean_dihedral_deg, report->shared_faces);
  if (!spore_label_source_content(work->options.labels))
    g_string_append(text, _("\nToo large a file for the scene to keep: it will not tell when the file changes"));
  for (guint i = 0; report->labels && i < report->labels->len; i++) add_label(text, work, figures_of(work, i));
  add_surroundings(text, work->surroundings);
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
