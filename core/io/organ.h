/* Inserts an imported mesh into a document, for `spore import` and for the editor. */
#ifndef SPORE_IO_ORGAN_H
#define SPORE_IO_ORGAN_H

#include "core/scene/document.h"

/* Inserts a mesh asset named `name` (NULL: after `file`), its content as a waiting blob, and a body that shows the
 * mesh. The body is unmovable until it gets a mechanical model. unit and frame index spore_length_units and
 * spore_mesh_frames. Returns the body. NULL with a GError: objects inserted before the failure stay, so call it inside
 * a group where that matters. */
SporeObject *spore_organ_insert(SporeDocument *document, const char *name, const char *file, GBytes *content, int unit,
                                int frame, GError **error);

/* Makes a valid object name of any text. Letters with marks lose their marks; without any Latin letter the name is
 * "organ". g_free. */
char *spore_organ_name(const char *text);

/* Name of a file with this content, distinguished from other files of that name by a hash: "NAME-1a2b3c4d.EXTENSION".
 * g_free. */
char *spore_content_file_name(const char *name, const char *extension, gconstpointer content, gsize size);

#endif
