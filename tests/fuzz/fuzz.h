/* A fuzz target: one file a target, with libFuzzer's entry point, so that the same code runs here from a fixed seed
 * (driver.c) and under clang's fuzzer for as long as one likes. */
#ifndef SPORE_TESTS_FUZZ_FUZZ_H
#define SPORE_TESTS_FUZZ_FUZZ_H

#include <stddef.h>
#include <stdint.h>

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size);

/* What driver.c puts in between: NULL-terminated. */
extern const char *const fuzz_words[];
/* Inputs to try, from the corpus on. */
extern const unsigned fuzz_rounds;

#endif
