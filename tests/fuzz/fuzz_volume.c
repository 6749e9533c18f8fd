/* Label maps of strangers: whatever the bytes, an answer that holds what its header promises, or a message. */
#include <glib.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "app/helpers/volume.h"
#include "fuzz.h"

const unsigned fuzz_rounds = 4000;
const char *const fuzz_words[] = {"n+1",
                                  "NRRD0004\n",
                                  "sizes: ",
                                  "sizes: 4000000000 1 1\n",
                                  "space directions: ",
                                  "nan",
                                  "1e308",
                                  "\x1f\x8b\x08",
                                  "encoding: gzip\n",
                                  "type: double\n",
                                  "\xff\x7f",
                                  "endian: big\n",
                                  "dimension: 3\n",
                                  "\n\n",
                                  "<Label Key=\"3\">liver</Label>",
                                  NULL};

/* The survey of the same bytes: labels that lie in the volume, or a message. */
static void check_survey(const uint8_t *content, size_t size) {
  SporeHelperFailure failure = {0};
  void *result = NULL;
  size_t result_size = 0;
  if (spore_volume_survey(content, size, &result, &result_size, &failure)) {
    SporeVolumeSurvey answer;
    SporeVolumeLabel label;
    g_assert_cmpuint(result_size, >=, sizeof answer);
    memcpy(&answer, result, sizeof answer);
    g_assert_cmpuint(result_size, ==, sizeof answer + answer.count * sizeof label);
    for (uint64_t i = 0; i < answer.count; i++) {
      memcpy(&label, (const char *)result + sizeof answer + i * sizeof label, sizeof label);
      g_assert_true(label.voxels > 0 && memchr(label.name, 0, sizeof label.name));
      for (int k = 0; k < 3; k++)
        g_assert_true(label.lower[k] <= label.upper[k] && label.upper[k] < answer.volume.size[k]);
    }
  } else
    g_assert_true(failure.message && strchr(failure.message, ';') && memchr(failure.detail, 0, sizeof failure.detail));
  free(result);
}

int LLVMFuzzerTestOneInput(const uint8_t *content, size_t size) {
  SporeHelperFailure failure = {0};
  void *result = NULL;
  size_t result_size = 0;
  if (spore_volume_decode(content, size, &result, &result_size, &failure)) {
    SporeVolumeAnswer answer;
    g_assert_cmpuint(result_size, >, sizeof answer);
    memcpy(&answer, result, sizeof answer);
    uint64_t voxels = answer.size[0] * answer.size[1] * answer.size[2];
    g_assert_cmpuint(result_size, ==, sizeof answer + voxels * sizeof(uint16_t));
    for (int i = 0; i < 12; i++) g_assert_true(isfinite(answer.axes[i]));
  } else
    g_assert_true(failure.message && strchr(failure.message, ';') && memchr(failure.detail, 0, sizeof failure.detail));
  free(result);
  check_survey(content, size);
  return 0;
}
