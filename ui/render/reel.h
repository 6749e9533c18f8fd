/* Where pictures go, one after the other, as the name of the file asks: F.png is one picture, F-%05d.png a row of them,
 * F.webm a film. */
#ifndef SPORE_UI_RENDER_REEL_H
#define SPORE_UI_RENDER_REEL_H

#include <glib.h>

#include "core/base/cancel.h"
#include "core/scene/error.h"

typedef enum SporeReelKind { SPORE_REEL_PICTURE, SPORE_REEL_ROW, SPORE_REEL_FILM } SporeReelKind;

/* The kind that the name asks for. FALSE with a GError: it asks for none. */
gboolean spore_reel_kind(const char *file, SporeReelKind *kind, GError **error);
/* The file that the picture of that number, from 0, goes to. g_free. */
char *spore_reel_file(const char *file, guint64 number);

typedef struct SporeReel SporeReel;
/* width, height: of each picture, pixels; fps: pictures a second, of a film. NULL with a GError. */
SporeReel *spore_reel_new(const char *file, int width, int height, double fps, GError **error);
/* Takes back what was not ended. NULL is allowed. */
void spore_reel_free(SporeReel *reel);
/* Adds the next picture: rows of 4 * width bytes, as spore_renderer_draw gives them. A single picture is written at
 * once. */
gboolean spore_reel_add(SporeReel *reel, const guint8 *pixels, GError **error);
/* Writes all, or nothing: what was there stays then. cancel (may be NULL) is asked until the writing begins. */
gboolean spore_reel_end(SporeReel *reel, const SporeCancel *cancel, GError **error);

#endif
