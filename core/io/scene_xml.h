/* Reads and writes scene files (.spore). */
#ifndef SPORE_IO_SCENE_XML_H
#define SPORE_IO_SCENE_XML_H

#include "core/scene/document.h"

/* Readers of meshes, spheres and tetrahedra for a document. */
extern const SporeAssetReaders spore_io_readers;

/* Whether a file of that name is a scene: it ends in .spore or .sporez. */
gboolean spore_scene_is_name(const char *file);
/* Loads a scene, from a bundle, too (core/io/bundle.h). NULL with a GError "FILE:LINE:COLUMN: ..." at the first fault.
 * The document has spore_io_readers. */
SporeDocument *spore_scene_load(const SporeSchema *schema, const char *file, GError **error);
/* As spore_scene_load, from memory. `file` (may be NULL) is the name in messages and gives the folder. */
SporeDocument *spore_scene_parse(const SporeSchema *schema, const char *file, const char *text, gsize size,
                                 GError **error);
/* Text of the scene: only properties that the author set, with the author's comments and order. g_free. */
char *spore_scene_format(const SporeDocument *document, gsize *size);
/* Saves the scene and waiting blobs, each by temporary file, fsync and rename; blobs first, the scene last. Saving into
 * another folder copies the assets that objects name. After a failure the files on disk and the document are as before.
 */
gboolean spore_scene_save(SporeDocument *document, const char *file, GError **error);

/* Writes a file whole or not at all: temporary file beside it, fsync, rename, fsync of the folder. */
gboolean spore_write_file(const char *file, const void *content, gsize size, GError **error);
/* Whether the file can be written, as far as the file system tells beforehand: asked before long work whose result is
 * written there. makes_folders: a folder that is missing will be made. */
gboolean spore_file_may_be_written(const char *file, gboolean makes_folders, GError **error);

#endif
