/* A body that is a spline sheet: the patch of a surface between four corners. */
#include "core/author/sheet_body.h"

#include "core/author/edits.h"

static gboolean set_count(SporeDocument *document, SporeObject *model, const char *name, size_t count, GError **error) {
  g_autofree char *text = g_strdup_printf("%zu", count);
  return spore_document_set_text(document, model, name, text, error);
}

static gboolean set_smoothing(SporeDocument *document, SporeObject *model, double smoothing, GError **error) {
  char text[G_ASCII_DTOSTR_BUF_SIZE];
  int place = spore_parameter_find(spore_object_type(model)->table, "smoothing");
  if (!(smoothing > 0)) return spore_document_unset(document, model, (guint)place, error);
  return spore_document_set_text(document, model, "smoothing", g_ascii_dtostr(text, sizeof text, smoothing), error);
}

/* A body that is a sheet already keeps its material. */
static SporeObject *sheet_model(SporeDocument *document, SporeObject *body, SporeObject *patch, GError **error) {
  SporeObject *mechanical = spore_edit_child_or_new(document, body, "mechanical", error);
  SporeObject *model = spore_body_model_object(body);
  if (!mechanical || !spore_document_set_text(document, mechanical, "geometry", spore_object_name(patch), error))
    return NULL;
  if (model && g_str_equal(spore_object_type(model)->element, "spline_2d")) return model;
  if (model && !spore_document_remove(document, model, error)) return NULL;
  return spore_document_insert(document, mechanical, "spline_2d", NULL, G_MAXUINT, error);
}

/* Spheres of this patch stay, to be generated again. */
static gboolean drop_foreign_spheres(SporeDocument *document, SporeObject *body, const SporeObject *patch,
                                     GError **error) {
  SporeObject *spheres = spore_edit_used_asset(document, body, "collision", "spheres", "spheres");
  if (!spheres || spore_object_reference(spheres, "source") == patch) return TRUE;
  return spore_document_remove(document, spore_object_child_of(body, "collision"), error);
}

gboolean spore_sheet_body_fill(SporeDocument *document, SporeObject *body, SporeObject *patch,
                               const SporeSheetReport *sheet, double smoothing, GError **error) {
  SporeObject *model = sheet_model(document, body, patch, error);
  if (!model || !set_count(document, model, "control_points_u", sheet->control_points[0], error) ||
      !set_count(document, model, "control_points_v", sheet->control_points[1], error) ||
      !set_smoothing(document, model, smoothing, error) || !drop_foreign_spheres(document, body, patch, error))
    return FALSE;
  SporeObject *visual = spore_edit_child_or_new(document, body, "visual", error);
  int role = spore_parameter_find(spore_object_type(body)->table, "role");
  return visual && spore_document_set_text(document, visual, "mesh", spore_object_name(patch), error) &&
         spore_document_unset(document, body, (guint)role, error);
}

SporeObject *spore_sheet_body_beside(SporeDocument *document, SporeObject *organ, GError **error) {
  static const char *const copied[] = {"position", "rotation"};
  g_autofree char *name = g_strdup_printf("%s_sheet", spore_object_name(organ));
  SporeObject *bodies = spore_document_section(document, "bodies");
  SporeObject *body = spore_document_insert(document, bodies, "body", name, G_MAXUINT, error);
  for (gsize i = 0; body && i < G_N_ELEMENTS(copied); i++) {
    guint place = (guint)spore_parameter_find(spore_object_type(organ)->table, copied[i]);
    const SporeValue *value = spore_object_value(organ, place);
    if (!spore_value_equal(value, &spore_object_type(organ)->initial[place]) &&
        !spore_document_set(document, body, place, value, error))
      return NULL;
  }
  return body;
}
