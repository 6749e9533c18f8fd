/* Thresholds of metrics: numbers with a unit. */
#include <math.h>
#include <string.h>

#include "core/base/number.h"
#include "core/base/text.h"
#include "core/exercise/metric.h"

const char *spore_threshold_read(const SporeMetricKind *kind, const char *text, double *value) {
  double number;
  size_t length = spore_number_read(text, strlen(text), &number);
  if (length == 0 || !isfinite(number)) return _("\"%s\" is no number; expected one and the unit \"%s\"; correct it");
  const char *unit = text + length + strspn(text + length, " ");
  for (size_t i = 0; i < SPORE_METRIC_UNITS && kind->units[i].name; i++) {
    if (strcmp(unit, kind->units[i].name) != 0) continue;
    *value = number * kind->units[i].scale;
    return NULL;
  }
  return *unit ? _("\"%s\" has a unit that this is not measured in; expected \"%s\"; correct it")
               : _("\"%s\" has no unit; expected \"%s\"; write it behind the number");
}
