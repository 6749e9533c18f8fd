/* What all generators share: where they start from, and the regions of the asset that they make. */
#include "core/author/generator.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/scene/generated.h"

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

/* The last of a region's own parameters is what shall be there. */
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

/* The table of generators. */

static gboolean is_named(const char *names, gsize length, const char *name) {
  gsize size = strlen(name);
  for (gsize at = 0; at + size <= length; at++)
    if (strncmp(names + at, name, size) == 0 && (at == 0 || names[at - 1] == ' ') &&
        (at + size == length || names[at + size] == ' '))
      return TRUE;
  return FALSE;
}

const SporeElement *const *spore_generator_elements(void) {
  static const SporeElement *elements[SPORE_GENERATORS_MOST + 1];
  static gsize ready;
  if (g_once_init_enter(&ready)) {
    gsize count = 0;
    for (gsize i = 0; spore_generators[i]; i++) {
      g_assert(count < SPORE_GENERATORS_MOST);
      if (!spore_generators[i]->elements) continue;
      g_assert(spore_generators[i]->elements->size <= SPORE_GENERATOR_FIELDS);
      elements[count++] = spore_generators[i]->elements;
    }
    g_once_init_leave(&ready, 1);
  }
  return elements;
}

gboolean spore_generator_takes(const SporeGeneratorType *type, const SporeParameter *parameter) {
  return spore_generated_is_option(parameter) && (!type->only || g_strv_contains(type->only, parameter->name));
}

int spore_generator_way(const SporeGeneratorType *type, const char *option) {
  int way = 0;
  for (const char *at = type->ways; at; way++) {
    const char *end = strchr(at, '|');
    if (is_named(at, end ? (gsize)(end - at) : strlen(at), option)) return way;
    at = end ? end + 1 : NULL;
  }
  return -1;
}

SporeParameterTable spore_generator_table(const SporeGeneratorType *type) {
  const SporeElement *const *elements = spore_generator_elements();
  while (strcmp((*elements)->element, type->element) != 0) elements++;
  return (SporeParameterTable){(*elements)->parameters, (*elements)->count, (*elements)->size};
}

void spore_generator_choose_way(const SporeGeneratorType *type, int way, void *fields) {
  SporeParameterTable table = spore_generator_table(type);
  for (size_t i = 0; i < table.count; i++) {
    const SporeParameter *parameter = &table.parameters[i];
    int other = spore_generator_way(type, parameter->name);
    if (other < 0 || other == way || parameter->minimum > 0) continue;
    const SporeValue nothing = {.type = parameter->type};
    spore_parameter_store(parameter, &nothing, fields);
  }
}
