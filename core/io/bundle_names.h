/* Names in bundles, and the table at the end of a zip: what is checked before a library reads anything. */
#ifndef SPORE_IO_BUNDLE_NAMES_H
#define SPORE_IO_BUNDLE_NAMES_H

#include <glib.h>

#include "core/scene/error.h"

/* Refuses a name that is no plain path below the bundle: absolute, with "." or "..", or with characters that no such
 * path has. `name` may be NULL and any bytes. */
gboolean spore_bundle_check_name(const char *place, const char *name, GError **error);
/* Refuses a set of names in which one is also the folder of another. */
gboolean spore_bundle_check_folders(const char *place, GHashTable *names, GError **error);
/* Refuses what is no zip, a zip that is cut short, and one whose table of files is damaged or too long, so that the
 * library which reads the table takes little memory. */
gboolean spore_bundle_check_table(const char *place, const void *content, gsize size, GError **error);

#endif
