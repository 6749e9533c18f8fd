/* Photographs (JPEG) as PNG, the one kind of picture that scenes keep. Libc, libjpeg and libpng alone. */
#ifndef SPORE_HELPERS_PHOTOGRAPH_H
#define SPORE_HELPERS_PHOTOGRAPH_H

#include <stdbool.h>
#include <stddef.h>

#define SPORE_PHOTOGRAPH_SIDE_MAXIMUM 8192 /* pixels, as SPORE_TEXTURE_SIDE_MAXIMUM */

/* Whether the content begins as a JPEG does. */
bool spore_photograph_is(const void *content, size_t size);
/* Width and height, as its head says them. False: it cannot be read, or is too large. */
bool spore_photograph_size(const void *content, size_t size, int *width, int *height);
/* Its pixels, red green blue, upper row first; free. NULL: as spore_photograph_convert. */
unsigned char *spore_photograph_pixels(const void *content, size_t size, int *width, int *height);
/* *png: malloc'ed. False: the photograph cannot be decoded as red, green and blue, is cut off or too large, or there is
 * no memory for it. */
bool spore_photograph_convert(const void *content, size_t size, void **png, size_t *png_size);

#endif
