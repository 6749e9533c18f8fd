/* Tissues: the table of measured quantities, and look-ups in it. */
#include "core/body/tissue.h"

#include <assert.h>
#include <string.h>

#include "core/base/text.h"

#define UNIT_young_modulus "Pa"
#define UNIT_poisson_ratio ""
#define UNIT_density "kg/m^3"
#define UNIT_stiffness_damping "s"
#define UNIT_tear_strain ""
#define UNIT_friction ""

#define Q(quantity, typical, minimum, maximum, source)                                                                 \
  {#quantity, UNIT_##quantity, {SPORE_REAL, {typical}, NULL}, minimum, maximum, source},
#define T(name, label, source, quantities) {#name, label, source, {quantities{0}}},
const SporeTissue spore_tissues[] = {SPORE_TISSUES{0}};
#undef T
#define T(name, label, source, quantities) #name,
const char *const spore_material_names[] = {"none", SPORE_TISSUES NULL};
#undef T
#undef Q
const char *const spore_tissue_wanted[] = {"young_modulus", "poisson_ratio", "density", "stiffness_damping", NULL};

const SporeTissueQuantity *spore_tissue_find(const SporeTissue *tissue, const char *parameter) {
  assert(tissue && parameter);
  for (const SporeTissueQuantity *quantity = tissue->quantities; quantity->name; quantity++)
    if (strcmp(quantity->name, parameter) == 0) return quantity;
  return NULL;
}

bool spore_tissue_fills(const char *parameter) {
  return strcmp(parameter, "tear_strain") != 0 && strcmp(parameter, "friction") != 0;
}

const SporeValue *spore_tissue_value(const SporeTissue *tissue, const SporeParameter *parameter) {
  assert(parameter->name);
  const SporeTissueQuantity *quantity =
      spore_tissue_fills(parameter->name) ? spore_tissue_find(tissue, parameter->name) : NULL;
  if (!quantity || quantity->typical.type != parameter->type) return NULL;
  double value = quantity->typical.number[0];
  return value >= parameter->minimum && value <= parameter->maximum ? &quantity->typical : NULL;
}
