/* Makes levels of detail. How much coarser a level is follows from how the model tells its fineness. */
#include "core/author/level_edits.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/edits.h"
#include "core/io/mesh_import.h"
#include "core/sim/lod/lod_type.h"

/* By level, coarse first: parts of a number of cells, of points along a line, of cells along an edge. */
static const char *const elements[] = {"coarse", "medium"};
static const double cells_part[] = {0.25, 0.5}, line_part[] = {0.4, 0.6}, edge_part[] = {0.63, 0.8};

/* The parameters by which models tell how fine they are. */
static const struct {
  const char *parameter;
  const double *part;
} counts[] = {{"cells", edge_part},
              {"control_points", line_part},
              {"control_points_u", edge_part},
              {"control_points_v", edge_part}};

static int grade_of(const char *element) { return g_str_equal(element, elements[0]) ? 0 : 1; }

/* The settings of the coarser model: NULL: it has no number that can be less. g_free. */
static char *settings_of(const SporeObject *model, int grade) {
  const SporeParameterTable *table = spore_object_type(model)->table;
  g_autoptr(GString) text = g_string_new(NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(counts); i++) {
    int index = spore_parameter_find(table, counts[i].parameter);
    if (index < 0) continue;
    double now = spore_object_value(model, (guint)index)->number[0];
    double less = fmax(table->parameters[index].minimum, nearbyint(counts[i].part[grade] * now));
    if (less < now) g_string_append_printf(text, text->len ? " %s=%.0f" : "%s=%.0f", counts[i].parameter, less);
  }
  return text->len ? g_strdup(text->str) : NULL;
}

static gboolean needs_tetrahedra(const SporeObject *model) {
  const SporeModelType *type = spore_object_type(model)->model;
  return type && type->geometry == SPORE_GEOMETRY_TETRAHEDRA;
}

gboolean spore_level_may(SporeDocument *document, SporeObject *body, const char *element, GError **error) {
  g_autofree char *path = spore_object_path(body);
  const SporeObject *model = spore_body_model_object(body), *fidelity = spore_object_child_of(body, "fidelity");
  if (!model || (SporeRole)spore_object_number(body, "role") != SPORE_PASSIVE)
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, "%s",
                             _("the body does not move by physics, so that it has no levels; give it a model first"));
  if (fidelity && spore_object_child_of(fidelity, element))
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, "%s",
                             _("the body has a level of that name already; change it, or delete it first"));
  g_autofree char *settings = settings_of(model, grade_of(element));
  if (settings || needs_tetrahedra(model)) return TRUE;
  const SporeModelType *type = spore_object_type(model)->model;
  return spore_error_raise(error, SPORE_ERROR_INPUT, path,
                           _("the model %s has no number of which a level could have less; expected tetrahedra, a "
                             "spline, or finite differences"),
                           type ? _(type->label) : spore_object_type(model)->element);
}

/* Fewer tetrahedra of the same mesh. */
static SporeGenerateWork *generation(SporeDocument *document, SporeObject *body, int grade, GError **error) {
  SporeObject *asset = spore_edit_body_tetrahedra(document, body);
  const SporeTetrahedralMesh *mesh = asset ? spore_document_tetrahedra(document, asset, error) : NULL;
  if (!mesh) return NULL;
  SporeGenerateOptions options = spore_generate_options_of(document, body, SPORE_GENERATE_TETRAHEDRA);
  spore_generate_set_count(&options, (size_t)fmax(1, cells_part[grade] * (double)mesh->tetrahedron_count));
  return spore_generate_work_new(document, body, &options, error);
}

SporeLevelWork *spore_level_work_new(SporeDocument *document, SporeObject *body, const char *element, GError **error) {
  int grade = grade_of(element);
  if (!spore_level_may(document, body, element, error)) return NULL;
  SporeLevelWork *work = g_new0(SporeLevelWork, 1);
  *work = (SporeLevelWork){.body = spore_object_id(body), .element = elements[grade]};
  work->settings = settings_of(spore_body_model_object(body), grade);
  if (!work->settings) work->generate = generation(document, body, grade, error);
  if (work->settings || work->generate) return work;
  spore_level_work_free(work);
  return NULL;
}

void spore_level_work_free(gpointer data) {
  SporeLevelWork *work = data;
  g_clear_pointer(&work->generate, spore_generate_work_unref);
  g_free(work->settings);
  g_free(work);
}

gboolean spore_level_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeLevelWork *work = data;
  return !work->generate || spore_generate_work_run(work->generate, progress, error);
}

/* The tetrahedra as an asset that remembers how it was made. The same ones may be there already, from a level that was
 * given back. */
static SporeObject *keep(const SporeLevelWork *work, SporeDocument *document, const SporeObject *body, GError **error) {
  const SporeGenerateWork *made = work->generate;
  const SporeGeneratedFrom from = {made->source, made->source_hash, &made->options.fields, made->regions,
                                   made->region_count};
  g_autofree char *name = g_strdup_printf("%s_%s", spore_object_name(body), work->element);
  gsize size;
  char *text = spore_medit_format(&made->tetrahedra, &size);
  SporeObject *asset = spore_edit_put_asset(document, "tetrahedra", name, "mesh", text, size, error);
  if (!asset || spore_object_text(asset, "source")) return asset;
  return spore_edit_remember_source(document, asset, &from, error) ? asset : NULL;
}

static SporeObject *apply(const SporeLevelWork *work, SporeDocument *document, SporeObject *body, GError **error) {
  SporeObject *asset = work->generate ? keep(work, document, body, error) : NULL;
  if (work->generate && !asset) return NULL;
  SporeObject *fidelity = spore_edit_child_or_new(document, body, "fidelity", error);
  SporeObject *level =
      fidelity ? spore_document_insert(document, fidelity, work->element, NULL, G_MAXUINT, error) : NULL;
  if (!level || (asset && !spore_document_set_text(document, level, "geometry", spore_object_name(asset), error)) ||
      (work->settings && !spore_document_set_text(document, level, "settings", work->settings, error)))
    return NULL;
  return level;
}

SporeObject *spore_level_work_apply(const SporeLevelWork *work, SporeDocument *document, GError **error) {
  SporeObject *body = spore_document_by_id(document, work->body);
  if (!body || (work->generate && !spore_generate_work_holds(work->generate, document))) {
    spore_error_raise(error, SPORE_ERROR_INPUT, body ? spore_object_name(body) : NULL,
                      _("the mesh or its regions changed meanwhile and the result was dropped; generate it again"));
    return NULL;
  }
  if (!spore_level_may(document, body, work->element, error)) return NULL;
  spore_document_begin(document, _("Add level"));
  SporeObject *level = apply(work, document, body, error);
  return spore_edit_finish(document, level != NULL) ? level : NULL;
}

/* Removing. */

static gboolean remove_level(SporeDocument *document, SporeObject *level, GError **error) {
  SporeObject *fidelity = spore_object_parent(level), *asset = spore_object_reference(level, "geometry");
  int first = spore_parameter_find(spore_object_type(fidelity)->table, "level");
  gboolean begins =
      g_str_equal(spore_lod_names[(int)spore_object_number(fidelity, "level")], spore_object_type(level)->element);
  if (begins && !spore_document_unset(document, fidelity, (guint)first, error)) return FALSE;
  if (!spore_document_remove(document, level, error)) return FALSE;
  return !asset || spore_edit_is_used(document, asset) || spore_document_remove(document, asset, error);
}

gboolean spore_edit_remove_level(SporeDocument *document, const char *path, GError **error) {
  SporeObject *level = spore_document_by_path(document, path);
  const char *element = level ? spore_object_type(level)->element : "";
  if (!g_str_equal(element, elements[0]) && !g_str_equal(element, elements[1]))
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, "%s",
                             _("there is no such level of detail; choose one of the list"));
  spore_document_begin(document, _("Delete level"));
  return spore_edit_finish(document, remove_level(document, level, error));
}
