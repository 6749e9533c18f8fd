/* Puts the methods of an accuracy study together. */
#include "core/author/accuracy_methods.h"

#include "core/integrate/integrator.h"

void spore_accuracy_methods_add(GArray *methods, SporeAccuracyMethod method, const GArray *nonlinear,
                                const GArray *linear) {
  gboolean implicit = spore_integrator(method.integrator)->implicit;
  for (guint n = 0; n < MAX(1, implicit && method.nonlinear < 0 ? nonlinear->len : 1); n++)
    for (guint l = 0; l < MAX(1, implicit && method.linear < 0 ? linear->len : 1); l++) {
      SporeAccuracyMethod with = method;
      if (implicit && method.nonlinear < 0 && nonlinear->len) with.nonlinear = g_array_index(nonlinear, int, n);
      if (implicit && method.linear < 0 && linear->len) with.linear = g_array_index(linear, int, l);
      g_array_append_val(methods, with);
    }
}

void spore_accuracy_methods_add_usual(GArray *methods, const GArray *nonlinear, const GArray *linear) {
  static const SporeIntegratorKind usual[] = {SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_TR_BDF2,
                                              SPORE_INTEGRATOR_IMPLICIT_MIDPOINT, SPORE_INTEGRATOR_BDF2};
  if (nonlinear->len == 0 && linear->len == 0) return;
  for (gsize i = 0; i < G_N_ELEMENTS(usual); i++)
    spore_accuracy_methods_add(methods, (SporeAccuracyMethod){usual[i], -1, -1}, nonlinear, linear);
}
