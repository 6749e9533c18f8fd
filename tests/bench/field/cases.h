/* The cases of tests/bench/peers/case.h as systems of this folder. */
#ifndef SPORE_BENCH_FIELD_CASES_H
#define SPORE_BENCH_FIELD_CASES_H

#include "tests/bench/field/method.h"
#include "tests/bench/peers/case.h"

/* NULL: there is no such case. */
System *case_system(const CaseRun *run, const char *name);
/* NULL: there is no such method. */
const Method *case_method(const char *name);

#endif
