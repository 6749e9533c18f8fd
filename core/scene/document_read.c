/* Reading a document: objects found by id, name or path, their values, and listeners to its changes. */
#include "core/scene/document_private.h"

#include <string.h>

/* Finding. */

SporeObject *spore_document_root(const SporeDocument *document) { return document->root; }

SporeObject *spore_document_section(const SporeDocument *document, const char *element) {
  return spore_object_child_of(document->root, element);
}

static gboolean is_attached(const SporeObject *object) {
  for (; object; object = object->parent)
    if (object->detached) return FALSE;
  return TRUE;
}

SporeObject *spore_document_by_id(const SporeDocument *document, guint32 id) {
  SporeObject *object = g_hash_table_lookup(document->objects, GUINT_TO_POINTER(id));
  return object && is_attached(object) ? object : NULL;
}

const SporeObject *spore_document_removed(const SporeDocument *document, guint32 id) {
  const SporeObject *object = g_hash_table_lookup(document->objects, GUINT_TO_POINTER(id));
  return object && !is_attached(object) ? object : NULL;
}

gboolean spore_element_in_list(const char *elements, const char *element) {
  size_t length = strlen(element);
  for (const char *at = elements; at; at = strchr(at, '|'), at += at != NULL)
    if (strncmp(at, element, length) == 0 && (at[length] == '\0' || at[length] == '|')) return TRUE;
  return FALSE;
}

/* The index of objects by name, made at the first request after a change. */
static GHashTable *index_names(const SporeDocument *document) {
  GHashTable *names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, (GDestroyNotify)g_ptr_array_unref);
  for (guint s = 0; s < document->root->children->len; s++) {
    const SporeObject *section = spore_object_child(document->root, s);
    for (guint i = 0; i < section->children->len; i++) {
      SporeObject *object = spore_object_child(section, i);
      const char *name = spore_object_name(object);
      if (!name) continue;
      GPtrArray *same = g_hash_table_lookup(names, name);
      if (!same) g_hash_table_insert(names, g_strdup(name), same = g_ptr_array_new());
      g_ptr_array_add(same, object);
    }
  }
  return names;
}

void spore_document_forget_names(SporeDocument *document) { g_clear_pointer(&document->names, g_hash_table_unref); }

SporeObject *spore_document_find(const SporeDocument *document, const char *elements, const char *name) {
  if (!name) return NULL;
  if (!document->names) ((SporeDocument *)document)->names = index_names(document);
  const GPtrArray *same = g_hash_table_lookup(document->names, name);
  for (guint i = 0; same && i < same->len; i++) {
    SporeObject *object = g_ptr_array_index(same, i);
    if (spore_element_in_list(elements, object->type->element)) return object;
  }
  return NULL;
}

static SporeObject *step_into(const SporeObject *parent, const char *part) {
  for (guint i = 0; i < parent->children->len; i++) {
    SporeObject *child = spore_object_child(parent, i);
    const char *name = spore_object_name(child);
    if (strcmp(name ? name : child->type->element, part) == 0) return child;
  }
  return NULL;
}

SporeObject *spore_document_by_path(const SporeDocument *document, const char *path) {
  if (strcmp(path, document->root->type->element) == 0) return document->root;
  g_auto(GStrv) parts = g_strsplit(path, "/", -1);
  SporeObject *object = parts[0] ? document->root : NULL;
  for (char **part = parts; *part && object; part++) object = step_into(object, *part);
  return object;
}

/* Reading an object. */

guint32 spore_object_id(const SporeObject *object) { return object->id; }
const SporeObjectType *spore_object_type(const SporeObject *object) { return object->type; }
SporeObject *spore_object_parent(const SporeObject *object) { return object->parent; }
guint spore_object_child_count(const SporeObject *object) { return object->children->len; }
SporeObject *spore_object_child(const SporeObject *object, guint index) {
  return g_ptr_array_index(object->children, index);
}
int spore_object_line(const SporeObject *object) { return object->line; }
int spore_object_column(const SporeObject *object) { return object->column; }
gboolean spore_object_is_set(const SporeObject *object, guint property) { return object->slots[property].set; }

int spore_object_name_property(const SporeObject *object) {
  const SporeParameterTable *table = object->type->table;
  for (size_t i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_NAME) return (int)i;
  return -1;
}

const char *spore_object_name(const SporeObject *object) {
  int property = spore_object_name_property(object);
  return property < 0 ? NULL : object->slots[property].value.text;
}

SporeObject *spore_object_child_of(const SporeObject *object, const char *element) {
  for (guint i = 0; i < object->children->len; i++) {
    SporeObject *child = spore_object_child(object, i);
    if (strcmp(child->type->element, element) == 0) return child;
  }
  return NULL;
}

char *spore_object_path(const SporeObject *object) {
  if (!object->parent) return g_strdup(object->type->element);
  const char *name = spore_object_name(object);
  const char *part = name ? name : object->type->element;
  if (!object->parent->parent) return g_strdup(part);
  g_autofree char *above = spore_object_path(object->parent);
  return g_strdup_printf("%s/%s", above, part);
}

char *spore_object_where(const SporeObject *object) {
  const SporeDocument *document = object->document;
  const char *file = document->file ? document->file : document->bundle;
  if (!file || object->line == 0) return spore_object_path(object);
  return g_strdup_printf("%s:%d:%d", file, object->line, object->column);
}

const SporeTissue *spore_object_tissue(const SporeObject *model) {
  if (!model->type->model || !model->parent) return NULL;
  int material = (int)spore_object_number(model->parent, "material");
  return material > 0 ? &spore_tissues[material - 1] : NULL;
}

/* The value that the material of a body gives to a property of its model; NULL: none. */
static const SporeValue *material_value(const SporeObject *object, guint property) {
  const SporeTissue *tissue = spore_object_tissue(object);
  return tissue ? spore_tissue_value(tissue, &object->type->table->parameters[property]) : NULL;
}

/* The value that `defaults` or the material gives to a property that the object does not set; NULL: none. */
static const SporeValue *inherited_value(const SporeObject *object, guint property) {
  if (object->type->model) return material_value(object, property);
  if (!object->type->defaults) return NULL;
  const SporeObject *section = spore_document_section(object->document, "defaults");
  const SporeObject *defaults = spore_object_child_of(section, object->type->defaults);
  if (!defaults) return NULL;
  int same = spore_parameter_find(defaults->type->table, object->type->table->parameters[property].name);
  return same >= 0 && defaults->slots[same].set ? &defaults->slots[same].value : NULL;
}

const SporeValue *spore_object_value(const SporeObject *object, guint property) {
  if (object->slots[property].set) return &object->slots[property].value;
  const SporeValue *inherited = inherited_value(object, property);
  return inherited ? inherited : &object->type->initial[property];
}

static const SporeValue *value_by_name(const SporeObject *object, const char *property) {
  int index = spore_parameter_find(object->type->table, property);
  g_assert(index >= 0);
  return spore_object_value(object, (guint)index);
}

double spore_object_number(const SporeObject *object, const char *property) {
  return value_by_name(object, property)->number[0];
}

SporeVec3 spore_object_vector(const SporeObject *object, const char *property) {
  return spore_vec3_load(value_by_name(object, property)->number);
}

const char *spore_object_text(const SporeObject *object, const char *property) {
  return value_by_name(object, property)->text;
}

SporeObject *spore_object_reference(const SporeObject *object, const char *property) {
  int index = spore_parameter_find(object->type->table, property);
  g_assert(index >= 0);
  const char *elements = object->type->table->parameters[index].references;
  return spore_document_find(object->document, elements, spore_object_value(object, (guint)index)->text);
}

SporeObject *spore_body_model_object(const SporeObject *body) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  return mechanical && spore_object_child_count(mechanical) > 0 ? spore_object_child(mechanical, 0) : NULL;
}

SporeObject *spore_object_asset(const SporeObject *object, guint property) {
  const SporeParameter *parameter = &spore_object_type(object)->table->parameters[property];
  SporeObject *named = parameter->type == SPORE_REFERENCE ? spore_object_reference(object, parameter->name) : NULL;
  return named && g_str_equal(spore_object_type(spore_object_parent(named))->element, "assets") ? named : NULL;
}

gboolean spore_object_refers_to(const SporeObject *object, const SporeObject *target) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (gsize i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_REFERENCE &&
        spore_object_reference(object, table->parameters[i].name) == target)
      return TRUE;
  for (guint i = 0; i < spore_object_child_count(object); i++)
    if (spore_object_refers_to(spore_object_child(object, i), target)) return TRUE;
  return FALSE;
}

void spore_object_fields(const SporeObject *object, void *fields) {
  const SporeParameterTable *table = object->type->table;
  for (guint i = 0; i < table->count; i++)
    spore_parameter_store(&table->parameters[i], spore_object_value(object, i), fields);
}

/* Listening. */

guint spore_document_listen(SporeDocument *document, SporeDocumentListener listener, gpointer data) {
  SporeListenerEntry entry = {++document->last_listener, listener, data};
  g_array_append_val(document->listeners, entry);
  return entry.id;
}

void spore_document_unlisten(SporeDocument *document, guint id) {
  for (guint i = 0; i < document->listeners->len; i++)
    if (g_array_index(document->listeners, SporeListenerEntry, i).id == id) {
      g_array_remove_index(document->listeners, i);
      return;
    }
}

void spore_document_notify(SporeDocument *document, SporeChangeKind kind, SporeObject *object, guint property) {
  if (kind != SPORE_DOCUMENT_HISTORY) document->revision++;
  for (guint i = 0; i < document->listeners->len; i++) {
    SporeListenerEntry entry = g_array_index(document->listeners, SporeListenerEntry, i);
    entry.listener(document, kind, object, property, entry.data);
  }
}

guint64 spore_document_revision(const SporeDocument *document) { return document->revision; }
