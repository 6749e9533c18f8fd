/* Progress of a part of longer work. */
#include "core/base/progress.h"

static bool report_share(void *data, double fraction, const char *stage) {
  const SporeProgressShare *share = data;
  return spore_progress(share->whole, share->done + share->share * fraction, stage);
}

static void show_share(void *data, const double *spheres, size_t count) {
  const SporeProgressShare *share = data;
  if (share->whole && share->whole->show) share->whole->show(share->whole->data, spheres, count);
}

SporeProgress spore_progress_of_share(SporeProgressShare *share) {
  return (SporeProgress){report_share, share, show_share};
}
