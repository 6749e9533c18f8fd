#include "core/io/scene_format.h"
#include "core/io/scene_xml.h"
#include "core/scene/document_private.h"

static void forget_places(SporeDocument *document) {
  GHashTableIter iterator;
  gpointer object;
  g_hash_table_iter_init(&iterator, document->objects);
  while (g_hash_table_iter_next(&iterator, NULL, &object)) ((SporeObject *)object)->line = 0;
}

SporeDocument *spore_scene_copy(const SporeDocument *document, GError **error) {
  gsize size;
  g_autofree char *text = spore_scene_format(document, &size);
  SporeDocument *copy = spore_scene_parse(document->schema, document->file, text, size, error);
  if (!copy) return NULL;
  forget_places(copy);
  spore_document_share_assets(copy, document);
  return copy;
}
