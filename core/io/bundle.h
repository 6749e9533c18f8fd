/* Bundles (.sporez): a scene and the files that it names, in one zip. A bundle is read into memory, and no file is
 * unpacked. A build without libarchive reads and writes none, and says so. */
#ifndef SPORE_IO_BUNDLE_H
#define SPORE_IO_BUNDLE_H

#include "core/base/progress.h"
#include "core/scene/document.h"

/* What a bundle may hold at most. */
#define SPORE_BUNDLE_FILES 4096u
#define SPORE_BUNDLE_BYTES (1u << 30)      /* of the bundle, and of its files together */
#define SPORE_BUNDLE_ANY_RATIO (64u << 20) /* bytes that any bundle may unpack to, however small it is */
#define SPORE_BUNDLE_RATIO 100u            /* more than that: so many times its own size */

/* Whether a file of that name is a bundle: it ends in .sporez. */
gboolean spore_bundle_is_name(const char *file);

/* Opens a bundle. The document has no file: the files that its scene names wait in it as blobs, as if they had just
 * been imported, and spore_document_bundle names the bundle. Whatever else lies in the bundle is not unpacked. NULL
 * with a GError, which begins with `file`, where the bundle is damaged, holds more than it may, holds links, doubled
 * names or names that lead elsewhere, is encrypted, or does not hold one scene with all of its files. */
SporeDocument *spore_bundle_load(const SporeSchema *schema, const char *file, const SporeProgress *progress,
                                 GError **error);
/* The same from memory. */
SporeDocument *spore_bundle_parse(const SporeSchema *schema, const char *file, const void *content, gsize size,
                                  const SporeProgress *progress, GError **error);

/* The content of a bundle of the document and of all files that it names, which can be opened again. The same document
 * gives the same bytes. place: begins messages. NULL with a GError: a file cannot be read, or there is more than a
 * bundle may hold. */
GByteArray *spore_bundle_format(SporeDocument *document, const char *place, const SporeProgress *progress,
                                GError **error);

#endif
