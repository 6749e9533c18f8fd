/* A build without the renderer: pages have no pictures, and say so. */
#include <glib/gi18n.h>

#include "app/cli/run_pictures.h"

struct SporeRunPictures {
  GPtrArray *none;
};

SporeRunPictures *spore_run_pictures_new(SporeRun *run) {
  SporeRunPictures *pictures = g_new0(SporeRunPictures, 1);
  pictures->none = g_ptr_array_new();
  return pictures;
}

void spore_run_pictures_free(SporeRunPictures *pictures) {
  if (pictures) g_ptr_array_unref(pictures->none);
  g_free(pictures);
}

void spore_run_pictures_look(SporeRunPictures *pictures) {}

SporeReportPictures spore_run_pictures_get(const SporeRunPictures *pictures) {
  return (SporeReportPictures){pictures->none, _("this build has no renderer")};
}
