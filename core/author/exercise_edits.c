/* Adds, orders, judges and removes the steps and metrics of an exercise. */
#include "core/author/exercise_edits.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/addition.h"
#include "core/author/edits.h"
#include "core/exercise/exercise.h"

static gboolean is_in_exercise(const SporeObject *object) {
  const SporeObject *parent = object ? spore_object_parent(object) : NULL;
  return parent && g_str_equal(spore_object_type(parent)->element, "exercise");
}

gboolean spore_step_is(const SporeObject *object) {
  return is_in_exercise(object) && spore_event_kind_find(spore_object_type(object)->element);
}

gboolean spore_metric_is(const SporeObject *object) {
  return is_in_exercise(object) && spore_metric_kind_find(spore_object_type(object)->element);
}

static const SporeParameter *parameter_of(const SporeObjectType *type, const char *name) {
  int index = spore_parameter_find(type->table, name);
  return index < 0 ? NULL : &type->table->parameters[index];
}

/* What is picked first and second. */
static const SporeParameter *parameter_of_end(const SporeObjectType *type, guint end) {
  if (end > 0) return parameter_of(type, "container");
  const SporeParameter *point = parameter_of(type, "point");
  return point ? point : parameter_of(type, "body");
}

guint spore_step_end_count(const SporeObjectType *type) { return parameter_of(type, "container") ? 2 : 1; }

const char *spore_step_end_doc(const SporeObjectType *type, guint end) { return _(parameter_of_end(type, end)->doc); }

static gboolean refuse(const SporeObjectType *type, const char *message, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, _(type->label), "%s", message);
}

static gboolean check_ends(const SporeObjectType *type, const SporeLinkEnd *ends, guint count, GError **error) {
  guint wanted = spore_step_end_count(type);
  gboolean place = parameter_of(type, "point") != NULL;
  if (count < wanted) return refuse(type, _("one more click is needed; click on it"), error);
  for (guint end = 0; end < wanted && !place; end++)
    if (!ends[end].body) return refuse(type, _("nothing was met there; expected a body; click on one"), error);
  if (wanted > 1 && ends[0].body == ends[1].body)
    return refuse(type, _("what is put in and what holds it are one body; click on another body"), error);
  return TRUE;
}

/* The first tool of the scene that a reference may name; NULL: there is none. */
static SporeObject *find_tool(SporeDocument *document, const SporeParameter *reference) {
  const SporeObject *tools = spore_document_section(document, "tools");
  g_auto(GStrv) elements = g_strsplit(reference->references, "|", -1);
  for (guint i = 0; i < spore_object_child_count(tools); i++) {
    SporeObject *tool = spore_object_child(tools, i);
    if (g_strv_contains((const char *const *)elements, spore_object_type(tool)->element)) return tool;
  }
  return NULL;
}

static const SporeObjectType *step_type(SporeDocument *document, const char *element) {
  const SporeObject *section = spore_document_section(document, "exercise");
  return spore_event_kind_find(element) ? spore_object_type_child(spore_object_type(section), element) : NULL;
}

gboolean spore_edit_can_add_step(SporeDocument *document, const char *element, GError **error) {
  const SporeObjectType *type = step_type(document, element);
  const SporeParameter *tool = type ? parameter_of(type, "tool") : NULL;
  if (!type)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "exercise", _("no step \"%s\"; expected one of: %s"), element,
                             SPORE_STEP_ELEMENTS);
  if (!tool || find_tool(document, tool)) return TRUE;
  g_autofree char *names = g_strdelimit(g_strdup(tool->references), "|", ' ');
  return spore_error_raise(error, SPORE_ERROR_INPUT, _(type->label),
                           _("the scene has no tool that can do it; expected one of: %s; add such a tool first"),
                           names);
}

static gboolean write_ends(SporeDocument *document, SporeObject *step, const SporeLinkEnd *ends, GError **error) {
  const SporeObjectType *type = spore_object_type(step);
  for (guint end = 0; end < spore_step_end_count(type); end++) {
    const SporeParameter *parameter = parameter_of_end(type, end);
    gboolean done =
        parameter->type == SPORE_REFERENCE
            ? spore_document_set_text(document, step, parameter->name, spore_object_name(ends[end].body), error)
            : spore_edit_set_vector(document, step, parameter->name, ends[end].place, error);
    if (!done) return FALSE;
  }
  return TRUE;
}

/* A place is reached by something: where no body is named, a tool has to be. */
static gboolean write_tool(SporeDocument *document, SporeObject *step, GError **error) {
  const SporeObjectType *type = spore_object_type(step);
  if (!parameter_of(type, "point")) return TRUE;
  const SporeObject *tool = find_tool(document, parameter_of(type, "tool"));
  return spore_document_set_text(document, step, "tool", spore_object_name(tool), error);
}

SporeObject *spore_edit_add_step(SporeDocument *document, const char *element, const SporeLinkEnd *ends, guint count,
                                 GError **error) {
  const SporeObjectType *type = step_type(document, element);
  if (!spore_edit_can_add_step(document, element, error) || !check_ends(type, ends, count, error)) return NULL;
  const char *body = ends[0].body && !parameter_of(type, "point") ? spore_object_name(ends[0].body) : NULL;
  g_autofree char *path = body ? g_strdup_printf("exercise/%s:%s_%s", element, body, element)
                               : g_strdup_printf("exercise/%s:%s", element, element);
  spore_document_begin(document, _("Add step"));
  SporeObject *step = spore_edit_add(document, path, error);
  gboolean done = step && write_ends(document, step, ends, error) && write_tool(document, step, error);
  return spore_edit_finish(document, done) ? step : NULL;
}

gboolean spore_edit_aim_step(SporeDocument *document, SporeObject *step, const SporeLinkEnd *ends, guint count,
                             GError **error) {
  if (!check_ends(spore_object_type(step), ends, count, error)) return FALSE;
  spore_document_begin(document, _("Aim step elsewhere"));
  return spore_edit_finish(document, write_ends(document, step, ends, error));
}

static gboolean is_fluid(const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body);
  return model && spore_object_type(model)->model->particles;
}

static gboolean fits(const SporeMetricKind *kind, const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body);
  if (kind->needs_strain) return model && spore_object_type(model)->model->strain;
  return !kind->needs_fluid || is_fluid(body);
}

/* `wanted` where it is of the right kind, else the first body of the scene that is, where the metric means nothing
 * without one. */
static const SporeObject *find_body(SporeDocument *document, const SporeMetricKind *kind, const SporeObject *wanted) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  if (wanted && fits(kind, wanted)) return wanted;
  if (!kind->needs_body) return NULL;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *body = spore_object_child(bodies, i);
    if (fits(kind, body)) return body;
  }
  return NULL;
}

/* What the metric is about. FALSE with a GError: the scene has no such thing. */
static gboolean write_subject(SporeDocument *document, SporeObject *metric, const SporeObject *wanted, GError **error) {
  const SporeObjectType *type = spore_object_type(metric);
  const SporeMetricKind *kind = spore_metric_kind_find(type->element);
  const SporeObject *body = parameter_of(type, "body") ? find_body(document, kind, wanted) : NULL;
  const SporeObject *camera = kind->needs_view ? find_tool(document, parameter_of(type, "camera")) : NULL;
  if (kind->needs_fluid && !body)
    return refuse(type, _("the scene has no fluid; expected a body of particles; add one first"), error);
  if (kind->needs_strain && !body)
    return refuse(type,
                  _("the scene has no tissue whose strain is known; expected a net, a deformable surface, a spline, "
                    "an intestine, a grid, or tetrahedra that are not condensed; add one first"),
                  error);
  if (kind->needs_body && !body) return refuse(type, _("the scene has no body; expected one; add it first"), error);
  if (kind->needs_view && !camera) return refuse(type, _("the scene has no camera; expected one; add it first"), error);
  return (!body || spore_document_set_text(document, metric, "body", spore_object_name(body), error)) &&
         (!camera || spore_document_set_text(document, metric, "camera", spore_object_name(camera), error));
}

SporeObject *spore_edit_add_metric(SporeDocument *document, const char *element, const SporeObject *body,
                                   GError **error) {
  if (!spore_metric_kind_find(element)) {
    spore_error_raise(error, SPORE_ERROR_INPUT, "exercise", _("no metric \"%s\"; spore schema lists them"), element);
    return NULL;
  }
  g_autofree char *path = g_strdup_printf("exercise/%s:%s", element, element);
  spore_document_begin(document, _("Add metric"));
  SporeObject *metric = spore_edit_add(document, path, error);
  gboolean done = metric && write_subject(document, metric, body, error);
  return spore_edit_finish(document, done) ? metric : NULL;
}

static guint index_of(const SporeObject *parent, const SporeObject *child) {
  guint index = 0;
  while (spore_object_child(parent, index) != child) index++;
  return index;
}

gboolean spore_edit_move_part(SporeDocument *document, SporeObject *part, int by, GError **error) {
  SporeObject *section = spore_object_parent(part);
  gboolean step = spore_step_is(part);
  gint64 count = spore_object_child_count(section);
  for (gint64 i = (gint64)index_of(section, part) + by; i >= 0 && i < count; i += by)
    if (spore_step_is(spore_object_child(section, (guint)i)) == step)
      return spore_document_move(document, part, section, (guint)i, error);
  return FALSE;
}

/* Steps that wait for this one wait for what it waits for. */
static gboolean pass_on_waiting(SporeDocument *document, const SporeObject *step, GError **error) {
  const SporeObject *section = spore_object_parent(step);
  const char *after = spore_object_text(step, "after");
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    SporeObject *other = spore_object_child(section, i);
    if (!spore_step_is(other) || spore_object_reference(other, "after") != step) continue;
    guint property = (guint)spore_parameter_find(spore_object_type(other)->table, "after");
    if (after ? !spore_document_set_text(document, other, "after", after, error)
              : !spore_document_unset(document, other, property, error))
      return FALSE;
  }
  return TRUE;
}

gboolean spore_edit_remove_part(SporeDocument *document, SporeObject *part, GError **error) {
  gboolean step = spore_step_is(part);
  spore_document_begin(document, step ? _("Remove step") : _("Remove metric"));
  gboolean done = (!step || pass_on_waiting(document, part, error)) && spore_document_remove(document, part, error);
  return spore_edit_finish(document, done);
}

gboolean spore_edit_set_threshold(SporeDocument *document, SporeObject *metric, const char *property, const char *text,
                                  GError **error) {
  const SporeObjectType *type = spore_object_type(metric);
  const SporeMetricKind *kind = spore_metric_kind_find(type->element);
  g_autofree char *given = g_strstrip(g_strdup(text)),
                  *with_unit = g_strdup_printf("%s %s", given, kind->units[0].name);
  double value;
  if (!*given) return spore_document_unset(document, metric, (guint)spore_parameter_find(type->table, property), error);
  if (!spore_threshold_read(kind, with_unit, &value))
    return spore_document_set_text(document, metric, property, g_strchomp(with_unit), error);
  const char *wrong = spore_threshold_read(kind, given, &value);
  if (!wrong) return spore_document_set_text(document, metric, property, given, error);
  g_autofree char *path = spore_object_path(metric);
  return spore_error_raise(error, SPORE_ERROR_INPUT, path, wrong, given, kind->units[0].name);
}
