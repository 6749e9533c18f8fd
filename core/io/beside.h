/* Reads the file that another file keeps a part of its content in. */
#ifndef SPORE_IO_BESIDE_H
#define SPORE_IO_BESIDE_H

#include <glib.h>

#include "core/scene/error.h"

/* The content of the file `name`, which has to lie in the folder of `file` or in a folder below, behind `size` bytes of
 * `head`. The name leads nowhere else, and no link is followed. The file is a regular one and has at most `most` bytes.
 * g_bytes_unref; NULL with an error whose place is `file`. */
GBytes *spore_beside_read(const char *file, const char *name, const void *head, gsize size, gsize most, GError **error);

#endif
