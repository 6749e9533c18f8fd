/* A film: pictures one after the other, encoded as VP9 in a WebM file, in memory. */
#ifndef SPORE_UI_RENDER_FILM_H
#define SPORE_UI_RENDER_FILM_H

#include <glib.h>

#include "core/base/cancel.h"
#include "core/scene/error.h"

typedef struct SporeFilm SporeFilm;

/* A film of pictures of that size, pixels, fps a second. NULL with a GError: a side is odd (the colours of a film have
 * half its size), there is no memory, or this build makes no films (SPORE_ERROR_UNSUPPORTED). */
SporeFilm *spore_film_new(int width, int height, double fps, GError **error);
void spore_film_free(SporeFilm *film); /* NULL is allowed */
/* Adds the next picture: rows of `stride` bytes, top first, as spore_renderer_draw gives them. */
gboolean spore_film_add(SporeFilm *film, const guint8 *pixels, gsize stride, GError **error);
/* Encodes what is left and returns the file. Nothing can be added any more. NULL with a GError; cancel (may be NULL) is
 * asked between two pictures. */
GBytes *spore_film_end(SporeFilm *film, const SporeCancel *cancel, GError **error);

#endif
