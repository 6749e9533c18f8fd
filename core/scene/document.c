/* Makes, loads and frees a document and its objects. */
#include "core/scene/document_private.h"

/* Objects. */

static void free_comments(GArray *comments) {
  if (!comments) return;
  for (guint i = 0; i < comments->len; i++) g_free(g_array_index(comments, SporeComment, i).text);
  g_array_unref(comments);
}

void spore_comments_add(GArray **comments, const char *text, guint lines_before) {
  if (!*comments) *comments = g_array_new(FALSE, FALSE, sizeof(SporeComment));
  SporeComment comment = {g_strdup(text), lines_before};
  g_array_append_val(*comments, comment);
}

void spore_object_free(SporeObject *object) {
  for (size_t i = 0; i < object->type->table->count; i++) {
    spore_value_clear(&object->slots[i].value);
    g_free(object->slots[i].source);
  }
  g_free(object->slots);
  g_array_unref(object->order);
  g_ptr_array_unref(object->children);
  free_comments(object->before);
  free_comments(object->beside);
  free_comments(object->tail);
  g_free(object);
}

SporeObject *spore_object_new(SporeDocument *document, const SporeObjectType *type) {
  SporeObject *object = g_new0(SporeObject, 1);
  object->id = ++document->last_id;
  object->type = type;
  object->document = document;
  object->detached = TRUE;
  object->children = g_ptr_array_new();
  object->slots = g_new0(SporeSlot, type->table->count);
  object->order = g_array_new(FALSE, FALSE, sizeof(guint));
  object->lines_before = 1;
  g_hash_table_insert(document->objects, GUINT_TO_POINTER(object->id), object);
  return object;
}

static void attach(SporeObject *object, SporeObject *parent, guint index) {
  g_ptr_array_insert(parent->children, (gint)index, object);
  object->parent = parent;
  object->detached = FALSE;
}

/* The document. */

SporeDocument *spore_document_new(const SporeSchema *schema) {
  SporeDocument *document = g_new0(SporeDocument, 1);
  document->schema = schema;
  document->objects = g_hash_table_new_full(NULL, NULL, NULL, (GDestroyNotify)spore_object_free);
  document->declaration = TRUE;
  document->undo = g_ptr_array_new();
  document->redo = g_ptr_array_new();
  document->open = g_array_new(FALSE, FALSE, sizeof(SporeEdit));
  document->marks = g_array_new(FALSE, FALSE, sizeof(guint));
  document->listeners = g_array_new(FALSE, FALSE, sizeof(SporeListenerEntry));
  spore_assets_init(document);
  document->root = spore_object_new(document, spore_schema_root(schema));
  document->root->detached = FALSE;
  const GPtrArray *sections = document->root->type->children;
  for (guint i = 0; i < sections->len; i++)
    attach(spore_object_new(document, g_ptr_array_index(sections, i)), document->root, i);
  return document;
}

void spore_document_free(SporeDocument *document) {
  if (!document) return;
  spore_history_free(document);
  g_hash_table_unref(document->objects);
  g_array_unref(document->listeners);
  spore_assets_free(document);
  spore_document_forget_names(document);
  g_free(document->file);
  g_free(document->bundle);
  g_free(document);
}

const SporeSchema *spore_document_schema(const SporeDocument *document) { return document->schema; }
const char *spore_document_file(const SporeDocument *document) { return document->file; }

void spore_document_set_file(SporeDocument *document, const char *file) {
  char *copy = g_strdup(file);
  g_free(document->file);
  document->file = copy;
  g_clear_pointer(&document->bundle, g_free);
}

const char *spore_document_bundle(const SporeDocument *document) { return document->bundle; }

void spore_document_set_bundle(SporeDocument *document, const char *bundle) {
  char *copy = g_strdup(bundle);
  spore_document_set_file(document, NULL);
  document->bundle = copy;
}

SporeObject *spore_document_load_object(SporeDocument *document, SporeObject *parent, const SporeObjectType *type,
                                        int line, int column) {
  SporeObject *object;
  if (!parent) {
    object = document->root;
  } else if (parent == document->root) {
    object = spore_object_child_of(parent, type->element);
  } else {
    object = spore_object_new(document, type);
    attach(object, parent, parent->children->len);
  }
  object->line = line, object->column = column;
  object->written = TRUE;
  return object;
}

void spore_document_load_value(SporeObject *object, guint property, SporeValue *value, char *source) {
  SporeSlot *slot = &object->slots[property];
  *slot = (SporeSlot){.set = TRUE, .position = object->order->len, .value = *value, .source = source};
  g_array_append_val(object->order, property);
  value->text = NULL;
}
