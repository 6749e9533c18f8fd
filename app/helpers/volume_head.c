/* What the headers of all formats of volumes share: sizes of voxels, and whether a header can be. */
#include <math.h>

#include "app/helpers/volume.h"

#define N_(text) text

const size_t spore_voxel_bytes[SPORE_VOXEL_TYPES] = {1, 1, 2, 2, 4, 4, 8, 8, 4, 8};

bool spore_volume_head_check(const SporeVolumeHead *head, SporeHelperFailure *failure) {
  const uint64_t *size = head->answer.size;
  const double *a = head->answer.axes;
  uint64_t voxels = 1;
  for (int i = 0; i < 3; i++) {
    if (size[i] == 0 || size[i] > SPORE_VOLUME_VOXELS / voxels)
      return spore_helper_fail(failure,
                               N_("the volume is empty or too large; expected at most 268 million voxels; crop "
                                  "it or halve its resolution"),
                               "%llu x %llu x %llu", (unsigned long long)size[0], (unsigned long long)size[1],
                               (unsigned long long)size[2]);
    voxels *= size[i];
  }
  double volume =
      a[0] * (a[5] * a[10] - a[6] * a[9]) - a[1] * (a[4] * a[10] - a[6] * a[8]) + a[2] * (a[4] * a[9] - a[5] * a[8]);
  double product = 1;
  for (int k = 0; k < 3; k++) product *= sqrt(a[k] * a[k] + a[4 + k] * a[4 + k] + a[8 + k] * a[8 + k]);
  bool finite = true;
  for (int i = 0; i < 12; i++) finite = finite && isfinite(a[i]) && fabs(a[i]) < 1e6;
  if (!finite || !(fabs(volume) > 1e-6 * product) || !(product > 1e-30))
    return spore_helper_fail(failure,
                             N_("its voxels have no size or no direction; expected three axes that span a "
                                "space; save it again with its geometry"),
                             "%g %g %g, %g %g %g, %g %g %g", a[0], a[1], a[2], a[4], a[5], a[6], a[8], a[9], a[10]);
  return true;
}
