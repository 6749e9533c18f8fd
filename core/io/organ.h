/* An imported mesh in a document: what `spore import` and the editor both do. */
#ifndef SPORE_IO_ORGAN_H
#define SPORE_IO_ORGAN_H

#include "core/scene/document.h"

/* A mesh asset named `name` (NULL: after `file`), its content a waiting blob, and a body that shows it, unmovable until
 * it is given a mechanical model. unit and frame index spore_length_units and spore_mesh_frames. Returns the body; NULL
 * with a GError: what was inserted by then stays, so call it inside a group where that matters. */
SporeObject *spore_organ_insert(SporeDocument *document, const char *name, const char *file, GBytes *content, int unit,
                                int frame, GError **error);

/* A name of the form that the file format allows, from any text: letters with marks lose them, where there are none of
 * the Latin script it is "organ". g_free. */
char *spore_organ_name(const char *text);

/* Name of a file with this content, told apart from others of that name by a hash: "NAME-1a2b3c4d.EXTENSION". g_free.
 */
char *spore_content_file_name(const char *name, const char *extension, gconstpointer content, gsize size);

#endif
