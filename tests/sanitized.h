/* Whether sanitizers look for wrong memory accesses, which takes four times as long and more: then a part of a long
 * test that comes by all the code is enough. The run without them judges the whole. */
#ifndef TESTS_SANITIZED_H
#define TESTS_SANITIZED_H

#include <stdbool.h>

#ifdef __SANITIZE_ADDRESS__
static const bool tests_sanitized = true;
#else
static const bool tests_sanitized = false;
#endif

#endif
