/* The list of the kinds of links. */
#include <string.h>

#include "core/sim/link/link_type.h"

const SporeLinkType *const spore_link_types[] = {
    &spore_link_pin,  &spore_link_spring, &spore_link_ball, &spore_link_hinge,
    &spore_link_weld, &spore_link_slide,  &spore_link_port, NULL,
};

const SporeLinkType *spore_link_type_find(const char *element) {
  const SporeLinkType *const *type = spore_link_types;
  while (*type && strcmp((*type)->element, element)) type++;
  return *type;
}
