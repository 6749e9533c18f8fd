/* The source of a result, for all generators: the mesh, the regions of the asset, and what the asset remembers. */
#include "core/author/generator_work.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"

SporeObject *spore_edit_generator_source(SporeDocument *document, SporeObject *body, SporeObject *target,
                                         GError **error) {
  SporeObject *shown = spore_edit_visual_mesh(document, body, NULL);
  if (shown && shown != target) return shown;
  const char *source = target ? spore_object_text(target, "source") : NULL;
  SporeObject *mesh = source ? spore_document_find(document, "mesh", source) : NULL;
  return mesh ? mesh : spore_edit_visual_mesh(document, body, error);
}

const char *spore_region_element(const SporeObjectType *holder) {
  for (guint i = 0; i < holder->children->len; i++) {
    const SporeObjectType *child = g_ptr_array_index(holder->children, i);
    if (spore_parameter_find(child->table, "centre") >= 0 && spore_parameter_find(child->table, "radius") >= 0)
      return child->element;
  }
  return NULL;
}

/* Reads a region. The last of its own parameters is its setting (density, size). */
static void read_region(const SporeObject *object, SporeGenerateRegion *region) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  const SporeValue *centre = spore_object_value(object, (guint)spore_parameter_find(table, "centre"));
  memcpy(region->centre, centre->number, sizeof region->centre);
  region->radius = spore_object_number(object, "radius");
  region->value = spore_object_value(object, (guint)table->count - 1)->number[0];
}

gboolean spore_edit_generator_regions(const SporeObject *asset, SporeGenerateRegion *regions, gsize *count,
                                      GError **error) {
  *count = 0;
  for (guint i = 0; asset && i < spore_object_child_count(asset); i++) {
    if (*count == SPORE_GENERATE_REGIONS)
      return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(asset),
                               _("it has more than %d regions; a generator takes no more; delete some"),
                               SPORE_GENERATE_REGIONS);
    read_region(spore_object_child(asset, i), &regions[(*count)++]);
  }
  return TRUE;
}

SporeGeneratedFrom spore_generate_work_from(const SporeGenerateWork *work) {
  return (SporeGeneratedFrom){work->source, work->source_hash, &work->options.fields,
                              work->regions + work->own_region_count, work->region_count - work->own_region_count};
}
