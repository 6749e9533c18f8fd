/* The table of generators: their elements, their options, and the ways that exclude each other. */
#include "core/author/generator.h"

#include <string.h>

#include "core/scene/generated.h"
#include "core/scene/schema_fields.h"

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
