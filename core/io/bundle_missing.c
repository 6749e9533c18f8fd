/* What a build without libarchive says of bundles. */
#include <glib/gi18n.h>

#include "core/io/bundle.h"

static gpointer refuse(const char *place, GError **error) {
  spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, place, "%s",
                    _("this build knows no bundles; expected one with libarchive; install libarchive-dev and build "
                      "SPORE again, or give a .spore file"));
  return NULL;
}

SporeDocument *spore_bundle_load(const SporeSchema *schema, const char *file, const SporeProgress *progress,
                                 GError **error) {
  return refuse(file, error);
}

SporeDocument *spore_bundle_parse(const SporeSchema *schema, const char *file, const void *content, gsize size,
                                  const SporeProgress *progress, GError **error) {
  return refuse(file, error);
}

GByteArray *spore_bundle_format(SporeDocument *document, const char *place, const SporeProgress *progress,
                                GError **error) {
  return refuse(place, error);
}
