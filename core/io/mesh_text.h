/* Brings the text of a mesh file to the form that readers expect. */
#ifndef SPORE_IO_MESH_TEXT_H
#define SPORE_IO_MESH_TEXT_H

#include <glib.h>

/* Where the content is UTF-16 with its mark (the first two bytes): the same text in UTF-8, in *held (spore_free; NULL
 * where nothing was changed). Skips the mark of UTF-8, and blank lines before the word "ply". *content and *size: what
 * there is to read. FALSE: there is not enough memory. */
gboolean spore_mesh_text(const char **content, gsize *size, char **held);

#endif
