/* Points of linear mappings as weighted sums of nodes, one kernel for each level of the processor. */
#include "core/body/mapping_kernels.h"

#include <assert.h>

void SPORE_LEVEL_NAME(spore_mapping_combine)(const SporeMapping *mapping, const double *values, double *combined) {
  assert(mapping->kind == SPORE_MAPPING_LINEAR);
  for (size_t i = 0; i < mapping->point_count; i++, combined += 3) {
    uint32_t k = mapping->row_start[i], end = mapping->row_start[i + 1];
#if SPORE_WIDTH > 2
    __m256d sum = _mm256_setzero_pd();
    for (; k < end; k++) {
      __m256d value = spore_load_three(values + 3 * (size_t)mapping->block[k]);
      sum = _mm256_add_pd(sum, _mm256_mul_pd(_mm256_set1_pd(mapping->weight[k]), value));
    }
    _mm_storeu_pd(combined, _mm256_castpd256_pd128(sum));
    _mm_store_sd(combined + 2, _mm256_extractf128_pd(sum, 1));
#else
    double sum[3] = {0, 0, 0};
    for (; k < end; k++)
      for (size_t c = 0; c < 3; c++) sum[c] += mapping->weight[k] * values[3 * (size_t)mapping->block[k] + c];
    for (size_t c = 0; c < 3; c++) combined[c] = sum[c];
#endif
  }
}
