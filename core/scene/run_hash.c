/* Hashes what a run of a scene depends on. */
#include "core/scene/run_hash.h"

#include <string.h>

#include "core/base/hash.h"

static guint64 hash_text(guint64 hash, const char *text) {
  return text ? spore_hash(hash, text, strlen(text) + 1) : spore_hash(hash, "", 1);
}

/* The content of the file that a track names. */
static guint64 hash_file(guint64 hash, SporeDocument *document, const char *file) {
  g_autoptr(GBytes) content = file ? spore_document_read_asset(document, file, NULL) : NULL;
  gsize size = 0;
  const void *bytes = content ? g_bytes_get_data(content, &size) : NULL;
  return bytes ? spore_hash(hash, bytes, size) : hash_text(hash, file);
}

/* An asset counts by its content, anything else by its name. */
static guint64 hash_reference(guint64 hash, SporeDocument *document, SporeObject *object, const char *property) {
  SporeObject *target = spore_object_reference(object, property), *parent = target ? spore_object_parent(target) : NULL;
  gboolean asset = parent && strcmp(spore_object_type(parent)->element, "assets") == 0;
  g_autofree char *content = asset ? spore_document_asset_hash(document, target) : NULL;
  return hash_text(hash, content ? content : spore_object_text(object, property));
}

/* The number of a property; a body's integrator and substeps that are left to the solver count as the solver's. A model
 * of rates chooses them by itself then. */
static void resolve(SporeDocument *document, SporeObject *object, const char *property, double number[3]) {
  gboolean mechanical = strcmp(spore_object_type(object)->element, "mechanical") == 0;
  gboolean integrator = strcmp(property, "integrator") == 0, substeps = strcmp(property, "substeps") == 0;
  SporeObject *model = spore_object_child_count(object) > 0 ? spore_object_child(object, 0) : NULL;
  if (!mechanical || !model || number[0] != 0 || !(integrator || substeps)) return;
  if (spore_object_type(model)->model && spore_object_type(model)->model->rates) return;
  number[0] = spore_object_number(spore_document_section(document, "solver"), property) + (integrator ? 1 : 0);
}

static guint64 hash_property(guint64 hash, SporeDocument *document, SporeObject *object, guint property) {
  const SporeParameter *parameter = &spore_object_type(object)->table->parameters[property];
  const SporeValue *value = spore_object_value(object, property);
  if (parameter->type == SPORE_REFERENCE) return hash_reference(hash, document, object, parameter->name);
  if (parameter->type == SPORE_FILE) return hash_file(hash, document, value->text);
  double number[3];
  memcpy(number, value->number, sizeof number);
  resolve(document, object, parameter->name, number);
  return hash_text(spore_hash(hash, number, sizeof number), value->text);
}

static gboolean is_shown_alone(const char *element) {
  static const char *const elements[] = {"meta", "units", "assets", "exercise", "visual", "camera", NULL};
  return g_strv_contains(elements, element);
}

/* How far an instrument gets through a port is shown to authors, and so are folders; a run does not keep to them. */
static gboolean is_of_a_run(const SporeObjectType *type, const char *property) {
  if (strcmp(type->element, "body") == 0 && strcmp(property, "folder") == 0) return FALSE;
  return strcmp(type->element, "port") != 0 || !g_str_has_prefix(property, "reach_");
}

/* Properties of a body's fidelity that advice is not about. */
static gboolean is_advice(const SporeObjectType *type, const char *property) {
  static const char *const properties[] = {"mode", "advice", "advice_hash", NULL};
  return strcmp(type->element, "fidelity") == 0 && g_strv_contains(properties, property);
}

static guint64 hash_object(guint64 hash, SporeDocument *document, SporeObject *object, gboolean advised) {
  const SporeObjectType *type = spore_object_type(object);
  if (is_shown_alone(type->element)) return hash;
  if (!advised && strcmp(type->element, "fidelity") == 0 && spore_object_child_count(object) == 0) return hash;
  hash = hash_text(hash, type->element);
  for (guint i = 0; i < type->table->count; i++) {
    const char *property = type->table->parameters[i].name;
    if (is_of_a_run(type, property) && (advised || !is_advice(type, property)))
      hash = hash_property(hash, document, object, i);
  }
  for (guint i = 0; i < spore_object_child_count(object); i++)
    hash = hash_object(hash, document, spore_object_child(object, i), advised);
  return hash_text(hash, "/"); /* no element has that name: the object ends */
}

guint64 spore_document_run_hash(SporeDocument *document) {
  return hash_object(SPORE_HASH_INIT, document, spore_document_root(document), TRUE);
}

guint64 spore_document_advice_hash(SporeDocument *document) {
  return hash_object(SPORE_HASH_INIT, document, spore_document_root(document), FALSE);
}
