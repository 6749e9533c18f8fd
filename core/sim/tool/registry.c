/* Registry of tools: the list of their kinds. */
#include <assert.h>
#include <string.h>

#include "core/sim/tool/tool_type.h"

const SporeToolType *const spore_tool_types[] = {
    &spore_grasper, &spore_clamp, &spore_scissors, &spore_suction, &spore_bipolar, &spore_needle, NULL,
};

const SporeToolType *spore_tool_type_find(const char *element) {
  assert(element);
  const SporeToolType *const *type = spore_tool_types;
  while (*type && strcmp((*type)->element, element)) type++;
  return *type;
}
