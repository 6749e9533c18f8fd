/* Progress of long work: reported, cancelled, and shared out among its parts. */
#include "core/base/progress.h"

#include "core/base/text.h"

bool spore_progress_step(const SporeProgress *progress, double fraction, const char *stage, SporeError *error) {
  if (spore_progress(progress, fraction, stage)) return true;
  return spore_error_set(error, SPORE_ERROR_CANCELLED, NULL, _("cancelled"));
}

bool spore_progress_part(const SporeProgressPart *part, double fraction, const char *stage, SporeError *error) {
  return spore_progress_step(part->whole, part->first + part->share * fraction, stage, error);
}

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
