/* Which of the instruction sets that kernels are compiled for is used: see core/math/simd.h. All levels compute the
 * same bits; higher ones are quicker. */
#ifndef SPORE_BASE_CPU_H
#define SPORE_BASE_CPU_H

typedef enum SporeCpuLevel {
  SPORE_CPU_BASELINE, /* what every processor of the family has: SSE2 on x86-64, NEON on arm64 */
  SPORE_CPU_AVX2,
  SPORE_CPU_AVX512, /* F, BW, DQ, VL */
  SPORE_CPU_LEVELS
} SporeCpuLevel;

/* The highest level that this program was built with, this processor has, and spore_cpu_limit and the environment
 * variable SPORE_CPU (one of the names below, read once) allow. */
SporeCpuLevel spore_cpu_level(void);
/* For tests and measurements: no kernel above `highest` from now on. */
void spore_cpu_limit(SporeCpuLevel highest);
const char *spore_cpu_level_name(SporeCpuLevel level); /* "baseline", "avx2", "avx512" */

#endif
