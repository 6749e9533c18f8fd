/* Scales properties of bodies that go by their units. */
#include "core/scene/scaling.h"

#include <math.h>
#include <string.h>

static gboolean is_scaled(const SporeParameter *parameter, SporeScaled what) {
  static const char *const units[][5] = {[SPORE_SCALED_STIFFNESS] = {"N/m", "N/m^2", "N/m^3", "Pa"},
                                         [SPORE_SCALED_MASS] = {"kg", "kg/m", "kg/m^2", "kg/m^3"},
                                         [SPORE_SCALED_CONTACT] = {"N/m"}};
  if (parameter->type != SPORE_REAL) return FALSE;
  for (const char *const *unit = units[what]; *unit; unit++)
    if (strcmp(parameter->unit, *unit) == 0) return TRUE;
  return FALSE;
}

SporeObject *spore_object_scaled_unit(const SporeObject *body, SporeScaled what) {
  if (what == SPORE_SCALED_CONTACT) return spore_object_child_of(body, "collision");
  SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  return mechanical && spore_object_child_count(mechanical) > 0 ? spore_object_child(mechanical, 0) : NULL;
}

int spore_object_scale(SporeDocument *document, SporeObject *body, SporeScaled what, double factor) {
  SporeObject *unit = spore_object_scaled_unit(body, what);
  if (!unit) return -1;
  const SporeParameterTable *table = spore_object_type(unit)->table;
  int set = -1;
  for (guint p = 0; p < table->count; p++) {
    const SporeParameter *parameter = &table->parameters[p];
    if (!is_scaled(parameter, what)) continue;
    double before = spore_object_value(unit, p)->number[0];
    SporeValue value = {.type = SPORE_REAL,
                        .number = {fmin(fmax(before * factor, parameter->minimum), parameter->maximum)}};
    if (before != 0 && spore_document_set(document, unit, p, &value, NULL)) set = (int)p;
  }
  return set;
}
