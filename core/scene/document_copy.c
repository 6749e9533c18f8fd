/* Copies a document for another thread; the objects keep their ids. */
#include "core/scene/document_private.h"

/* An object of the copy, and the id that it shall have. */
typedef struct Twin {
  SporeObject *object;
  guint32 id;
} Twin;

static void copy_values(const SporeObject *from, SporeObject *to) {
  for (guint i = 0; i < from->order->len; i++) {
    guint property = g_array_index(from->order, guint, i);
    SporeValue value;
    if (!spore_value_copy(&value, &from->slots[property].value)) g_error("not enough memory");
    spore_document_load_value(to, property, &value, NULL);
  }
}

static void copy_object(const SporeObject *from, SporeObject *to, GArray *twins) {
  const Twin twin = {to, from->id};
  g_array_append_val(twins, twin);
  to->written = from->written;
  copy_values(from, to);
  for (guint i = 0; i < from->children->len; i++) {
    const SporeObject *child = spore_object_child(from, i);
    copy_object(child, spore_document_load_object(to->document, to, child->type, child->line, child->column), twins);
  }
}

static void give_ids(SporeDocument *copy, const GArray *twins, guint32 last_id) {
  g_hash_table_steal_all(copy->objects);
  for (guint i = 0; i < twins->len; i++) {
    const Twin *twin = &g_array_index(twins, Twin, i);
    twin->object->id = twin->id;
    g_hash_table_insert(copy->objects, GUINT_TO_POINTER(twin->id), twin->object);
  }
  copy->last_id = last_id;
}

SporeDocument *spore_document_copy(const SporeDocument *document) {
  SporeDocument *copy = spore_document_new(document->schema);
  g_autoptr(GArray) twins = g_array_new(FALSE, FALSE, sizeof(Twin));
  if (document->bundle) spore_document_set_bundle(copy, document->bundle);
  else spore_document_set_file(copy, document->file);
  copy->declaration = document->declaration;
  copy->root->line = document->root->line, copy->root->column = document->root->column;
  copy_object(document->root, copy->root, twins);
  give_ids(copy, twins, document->last_id);
  spore_document_share_assets(copy, document);
  return copy;
}
