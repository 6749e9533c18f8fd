/* What a build without libvpx says of films. */
#include <glib/gi18n.h>

#include "ui/render/film.h"

SporeFilm *spore_film_new(int width, int height, double fps, GError **error) {
  spore_error_raise(
      error, SPORE_ERROR_UNSUPPORTED, _("film"), "%s",
      _("this build makes no films; expected one with libvpx; install libvpx-dev and build SPORE again, or "
        "ask for a row of pictures: F-%05d.png"));
  return NULL;
}

void spore_film_free(SporeFilm *film) {}

gboolean spore_film_add(SporeFilm *film, const guint8 *pixels, gsize stride, GError **error) { return FALSE; }

GBytes *spore_film_end(SporeFilm *film, const SporeCancel *cancel, GError **error) { return NULL; }
