/* A WebM file in memory: one track of VP9 pictures (Matroska, RFC 9559, with the subset of elements that WebM allows).
 */
#ifndef SPORE_UI_RENDER_WEBM_H
#define SPORE_UI_RENDER_WEBM_H

#include <glib.h>

#include "core/scene/error.h"

typedef struct SporeWebm SporeWebm;

/* A file of pictures of that size, pixels, of which each is shown for 1/fps s. */
SporeWebm *spore_webm_new(int width, int height, double fps);
void spore_webm_free(SporeWebm *webm); /* NULL is allowed */
/* Adds the next picture as the encoder made it. key: needs no picture before it; the first picture is one. FALSE with a
 * GError: the file would grow beyond 2 GB. */
gboolean spore_webm_add(SporeWebm *webm, const void *picture, gsize size, gboolean key, GError **error);
/* The whole file. Nothing can be added any more. */
GBytes *spore_webm_end(SporeWebm *webm);

#endif
