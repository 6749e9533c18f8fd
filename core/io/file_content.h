/* Reading a whole file. */
#ifndef SPORE_IO_FILE_CONTENT_H
#define SPORE_IO_FILE_CONTENT_H

#include <glib.h>

/* The content of a regular file of at most `largest` bytes; waits for no pipe and no device. NULL with an errno in
 * *fault: EISDIR (a folder), EINVAL (no regular file), EFBIG (larger), or what the system said. */
GByteArray *spore_file_content(const char *file, gsize largest, int *fault);

#endif
