/* The source of a result, for all generators: the mesh, the regions of the asset, and what the asset remembers. */
#include "core/author/generator_work.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/scene/region.h"

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
    if (spore_parameter_find(child->table, "name") >= 0 && spore_parameter_find(child->table, "centre") >= 0 &&
        spore_parameter_find(child->table, "radius") >= 0)
      return child->element;
  }
  return NULL;
}

/* Reads the balls of a region. The last of its own parameters is its setting (density, size). */
static void read_region(const SporeObject *object, gsize index, SporeGenerateRegion *regions) {
  guint count, setting = (guint)spore_object_type(object)->table->count - 1;
  g_autofree double *balls = spore_region_balls(object, &count);
  for (guint i = 0; i < count; i++) {
    regions[i] = (SporeGenerateRegion){
        .radius = balls[4 * i + 3], .value = spore_object_value(object, setting)->number[0], .region = index};
    memcpy(regions[i].centre, balls + 4 * i, sizeof regions[i].centre);
  }
}

gboolean spore_edit_generator_regions(const SporeObject *asset, SporeGenerateRegion *regions, gsize *count,
                                      GError **error) {
  *count = 0;
  for (guint i = 0; asset && i < spore_object_child_count(asset); i++) {
    const SporeObject *region = spore_object_child(asset, i);
    guint balls = spore_region_ball_count(region);
    if (balls > SPORE_GENERATE_REGIONS - *count)
      return spore_error_raise(error, SPORE_ERROR_INPUT, spore_object_name(asset),
                               _("its regions are more than %d balls, dabs of the brush included; a generator takes no "
                                 "more; delete some, or paint with a wider brush"),
                               SPORE_GENERATE_REGIONS);
    read_region(region, i, regions + *count);
    *count += balls;
  }
  return TRUE;
}

SporeGeneratedFrom spore_generate_work_from(const SporeGenerateWork *work) {
  return (SporeGeneratedFrom){work->source, work->source_hash, &work->options.fields,
                              work->regions + work->own_region_count, work->region_count - work->own_region_count};
}
