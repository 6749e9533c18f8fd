/* Which instruction sets this processor has, and which one the kernels use. */
#include "core/base/cpu.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

static const char *const names[SPORE_CPU_LEVELS] = {"baseline", "avx2", "avx512"};

static bool has_level(SporeCpuLevel level) {
#if SPORE_KERNEL_LEVELS > 1
  __builtin_cpu_init();
  if (level == SPORE_CPU_AVX2) return __builtin_cpu_supports("avx2");
  if (level == SPORE_CPU_AVX512)
    return __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl");
#endif
  return level == SPORE_CPU_BASELINE;
}

static SporeCpuLevel allowed(void) {
  const char *name = getenv("SPORE_CPU");
  for (int level = 0; name && level < SPORE_CPU_LEVELS; level++)
    if (!strcmp(name, names[level])) return (SporeCpuLevel)level;
  return SPORE_CPU_LEVELS - 1;
}

static SporeCpuLevel best_up_to(SporeCpuLevel highest) {
  SporeCpuLevel level = SPORE_CPU_BASELINE;
  while (level < highest && has_level(level + 1)) level++;
  return level;
}

static _Atomic int current = -1;

SporeCpuLevel spore_cpu_level(void) {
  int level = atomic_load_explicit(&current, memory_order_relaxed);
  if (level >= 0) return (SporeCpuLevel)level;
  SporeCpuLevel best = best_up_to(allowed());
  atomic_store_explicit(&current, (int)best, memory_order_relaxed);
  return best;
}

void spore_cpu_limit(SporeCpuLevel highest) {
  SporeCpuLevel environment = allowed();
  SporeCpuLevel level = best_up_to(highest < environment ? highest : environment);
  atomic_store_explicit(&current, (int)level, memory_order_relaxed);
}

const char *spore_cpu_level_name(SporeCpuLevel level) { return names[level]; }
