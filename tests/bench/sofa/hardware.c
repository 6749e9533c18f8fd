/* Measures what the processor can do at most: memory bandwidth and floating-point operations. */
#include "tests/bench/sofa/hardware.h"

#include <math.h>
#include <stdlib.h>
#include <time.h>

#if defined(__x86_64__) && !defined(__SANITIZE_ADDRESS__)
#define WIDEST __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define WIDEST
#endif

enum { LANES = 8, CHAINS = 12, ROUNDS = 5 };
static volatile double sink;

static double cpu_s(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

WIDEST static double read_all(const double *values, size_t count) {
  double sum[CHAINS][LANES] = {{0}}, total = 0;
  for (size_t i = 0; i + CHAINS * LANES <= count; i += CHAINS * LANES)
    for (int c = 0; c < CHAINS; c++)
      for (int k = 0; k < LANES; k++) sum[c][k] += values[i + (size_t)(c * LANES + k)];
  for (int c = 0; c < CHAINS; c++)
    for (int k = 0; k < LANES; k++) total += sum[c][k];
  return total;
}

WIDEST static double compute(size_t rounds) {
  double x[CHAINS][LANES], total = 0;
  for (int c = 0; c < CHAINS; c++)
    for (int k = 0; k < LANES; k++) x[c][k] = 1 + 0.01 * c + 0.001 * k;
  for (size_t i = 0; i < rounds; i++)
    for (int c = 0; c < CHAINS; c++)
      for (int k = 0; k < LANES; k++) x[c][k] = x[c][k] * 0.999 + 1e-3;
  for (int c = 0; c < CHAINS; c++)
    for (int k = 0; k < LANES; k++) total += x[c][k];
  return total;
}

double hardware_bandwidth(size_t bytes) {
  static double known[8 * sizeof(size_t)];
  size_t count = CHAINS * LANES, index = 0;
  while (count * sizeof(double) < bytes) count *= 2, index++;
  if (known[index] > 0) return known[index];
  double *values = calloc(count, sizeof *values), best = HUGE_VAL;
  size_t passes = 1 + (size_t)(1 << 26) / (count * sizeof *values);
  for (int round = 0; values && round < ROUNDS; round++) {
    double begin = cpu_s();
    for (size_t i = 0; i < passes; i++) sink = read_all(values, count);
    best = fmin(best, cpu_s() - begin);
  }
  free(values);
  return known[index] = 1e-9 * (double)(passes * count * sizeof *values) / best;
}

double hardware_peak(void) {
  static double known;
  const size_t rounds = 2000000;
  for (int round = 0; known == 0 || round < ROUNDS; round++) {
    if (known > 0 && round == 0) return known;
    double begin = cpu_s();
    sink = compute(rounds);
    known = fmax(known, 1e-9 * 2 * CHAINS * LANES * (double)rounds / (cpu_s() - begin));
  }
  return known;
}
