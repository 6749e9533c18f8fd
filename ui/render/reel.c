/* Pictures on their way into one PNG, into a row of PNGs, or into a film. Files are renamed when all are written. */
#include "ui/render/reel.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/file_batch.h"
#include "core/io/scene_xml.h"
#include "ui/render/film.h"
#include "ui/render/renderer.h"

struct SporeReel {
  char *file;
  int width, height;
  guint64 count;         /* of pictures added */
  SporeFileBatch *batch; /* of a row; else NULL */
  SporeFilm *film;       /* of a film; else NULL */
};

/* Finds %d or %05d in a name: *length characters. NULL: none. */
static const char *find_number(const char *name, gsize *length) {
  for (const char *sign = strchr(name, '%'); sign; sign = strchr(sign + 1, '%')) {
    *length = 2;
    if (sign[1] == '0' && sign[2] >= '1' && sign[2] <= '9') *length = 4;
    if (sign[*length - 1] == 'd') return sign;
  }
  return NULL;
}

/* The file's name without its folders. */
static const char *base_name(const char *file) {
  const char *slash = strrchr(file, '/');
  return slash ? slash + 1 : file;
}

gboolean spore_reel_kind(const char *file, SporeReelKind *kind, GError **error) {
  const char *name = base_name(file);
  gsize length;
  const char *number = find_number(name, &length);
  g_autofree char *small = g_ascii_strdown(name, -1);
  gboolean is_film = g_str_has_suffix(small, ".webm");
  if (!is_film && !g_str_has_suffix(small, ".png"))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, "%s",
                             _("is the name of no picture and of no film; expected F.png, F-%05d.png (a row of "
                               "pictures) or F.webm (a film)"));
  if (number && (is_film || find_number(number + length, &length)))
    return spore_error_raise(error, SPORE_ERROR_INPUT, file, "%s",
                             is_film ? _("a film is one file, which has no number; expected a name without %d")
                                     : _("has two places for a number; expected one, such as F-%05d.png"));
  *kind = is_film ? SPORE_REEL_FILM : number ? SPORE_REEL_ROW : SPORE_REEL_PICTURE;
  return TRUE;
}

char *spore_reel_file(const char *file, guint64 number) {
  gsize length;
  const char *place = find_number(base_name(file), &length);
  if (!place) return g_strdup(file);
  g_autofree char *digits = g_strdup_printf("%" G_GUINT64_FORMAT, number);
  GString *name = g_string_new_len(file, place - file);
  for (gsize n = strlen(digits); length == 4 && n < (gsize)(place[2] - '0'); n++) g_string_append_c(name, '0');
  g_string_append(name, digits);
  g_string_append(name, place + length);
  return g_string_free(name, FALSE);
}

SporeReel *spore_reel_new(const char *file, int width, int height, double fps, GError **error) {
  SporeReelKind kind;
  if (!spore_reel_kind(file, &kind, error)) return NULL;
  SporeFilm *film = kind == SPORE_REEL_FILM ? spore_film_new(width, height, fps, error) : NULL;
  if (kind == SPORE_REEL_FILM && !film) return NULL;
  SporeReel *reel = g_new0(SporeReel, 1);
  reel->file = g_strdup(file);
  reel->width = width, reel->height = height;
  reel->film = film;
  if (kind == SPORE_REEL_ROW) reel->batch = spore_file_batch_new();
  return reel;
}

void spore_reel_free(SporeReel *reel) {
  if (!reel) return;
  if (reel->batch) spore_file_batch_free(reel->batch);
  spore_film_free(reel->film);
  g_free(reel->file);
  g_free(reel);
}

static gboolean add_to_row(SporeReel *reel, const guint8 *pixels, GError **error) {
  g_autofree char *file = spore_reel_file(reel->file, reel->count);
  g_autoptr(GBytes) picture = spore_png_encode(pixels, reel->width, reel->height, (gsize)reel->width * 4, error);
  return picture && spore_file_batch_add_path(reel->batch, file, g_bytes_get_data(picture, NULL),
                                              g_bytes_get_size(picture), error);
}

gboolean spore_reel_add(SporeReel *reel, const guint8 *pixels, GError **error) {
  gsize stride = (gsize)reel->width * 4;
  gboolean added = reel->film    ? spore_film_add(reel->film, pixels, stride, error)
                   : reel->batch ? add_to_row(reel, pixels, error)
                                 : spore_png_write(reel->file, pixels, reel->width, reel->height, stride, error);
  if (added) reel->count++;
  return added;
}

static gboolean write_film(SporeReel *reel, const SporeCancel *cancel, GError **error) {
  g_autoptr(GBytes) film = spore_film_end(reel->film, cancel, error);
  return film && spore_write_file(reel->file, g_bytes_get_data(film, NULL), g_bytes_get_size(film), error);
}

gboolean spore_reel_end(SporeReel *reel, const SporeCancel *cancel, GError **error) {
  if (reel->film) return write_film(reel, cancel, error);
  return !reel->batch || spore_file_batch_commit(reel->batch, error);
}
