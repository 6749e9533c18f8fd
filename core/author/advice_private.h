/* Between the files of the advisor. */
#ifndef SPORE_AUTHOR_ADVICE_PRIVATE_H
#define SPORE_AUTHOR_ADVICE_PRIVATE_H

#include "core/author/advice.h"

/* Why the element has its verdict, translated; g_free. simulation: for the names of bodies and steps. */
char *spore_advice_reason(const SporeAdviceElement *element, const SporeExerciseState *exercise,
                          const SporeSimulation *simulation);

#endif
