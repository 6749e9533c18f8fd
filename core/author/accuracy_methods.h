/* The methods of an accuracy study, of what a user chose: integrators, each with solvers. */
#ifndef SPORE_AUTHOR_ACCURACY_METHODS_H
#define SPORE_AUTHOR_ACCURACY_METHODS_H

#include <glib.h>

#include "core/measure/accuracy.h"

/* methods: of SporeAccuracyMethod, added to. nonlinear, linear: of int, kinds of solvers, may be empty. */
/* Adds the method with each of the solvers, where it has anything to solve and names none itself. */
void spore_accuracy_methods_add(GArray *methods, SporeAccuracyMethod method, const GArray *nonlinear,
                                const GArray *linear);
/* Adds the usual implicit methods with each of the solvers; without solvers nothing, which leaves the choice to the
 * study. */
void spore_accuracy_methods_add_usual(GArray *methods, const GArray *nonlinear, const GArray *linear);

#endif
