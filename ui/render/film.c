/* Films by libvpx: VP9 of constant quality, 8 bits, colours at half the size, BT.709 in the studio's range. */
#include "ui/render/film.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>
#include <vpx/vp8cx.h>
#include <vpx/vpx_encoder.h>

#include "ui/render/webm.h"

#define QUALITY 24 /* 0 is best, 63 worst */
#define CPU_USED 5 /* 0 is slowest, 9 fastest */
#define MOST_THREADS 8
#define KEY_S 5 /* at most so long from a picture that needs no other to the next one */

struct SporeFilm {
  vpx_codec_ctx_t codec;
  vpx_image_t image;
  gboolean is_open;
  gint64 count; /* of pictures given */
  SporeWebm *webm;
};

static gboolean refuse(SporeFilm *film, GError **error) {
  const char *detail = vpx_codec_error_detail(&film->codec);
  return spore_error_raise(error, SPORE_ERROR_MEMORY, _("film"),
                           _("cannot be encoded: %s; make its pictures smaller, or close other programs"),
                           detail ? detail : vpx_codec_error(&film->codec));
}

/* How many columns of tiles, as a power of two: a column is at least 256 pixels wide. Threads share them. The number of
 * threads changes no film. */
static int tile_columns(int width) {
  int power = 0;
  while (power < 3 && width >> (power + 1) >= 256) power++;
  return power;
}

static gboolean open_codec(SporeFilm *film, int width, int height, double fps) {
  vpx_codec_iface_t *vp9 = vpx_codec_vp9_cx();
  vpx_codec_enc_cfg_t settings;
  if (vpx_codec_enc_config_default(vp9, &settings, 0) != VPX_CODEC_OK) return FALSE;
  settings.g_w = (unsigned)width, settings.g_h = (unsigned)height;
  settings.g_timebase = (vpx_rational_t){1000, (int)lround(1000 * fps)};
  settings.g_threads = MIN(g_get_num_processors(), MOST_THREADS);
  settings.rc_end_usage = VPX_Q;
  settings.kf_max_dist = (unsigned)MAX(1, lround(KEY_S * fps));
  if (vpx_codec_enc_init(&film->codec, vp9, &settings, 0) != VPX_CODEC_OK) return FALSE;
  film->is_open = TRUE;
  return vpx_codec_control(&film->codec, VP8E_SET_CPUUSED, CPU_USED) == VPX_CODEC_OK &&
         vpx_codec_control(&film->codec, VP8E_SET_CQ_LEVEL, QUALITY) == VPX_CODEC_OK &&
         vpx_codec_control(&film->codec, VP9E_SET_ROW_MT, 1) == VPX_CODEC_OK &&
         vpx_codec_control(&film->codec, VP9E_SET_TILE_COLUMNS, tile_columns(width)) == VPX_CODEC_OK &&
         vpx_codec_control(&film->codec, VP9E_SET_COLOR_SPACE, VPX_CS_BT_709) == VPX_CODEC_OK &&
         vpx_codec_control(&film->codec, VP9E_SET_COLOR_RANGE, VPX_CR_STUDIO_RANGE) == VPX_CODEC_OK;
}

SporeFilm *spore_film_new(int width, int height, double fps, GError **error) {
  if (width % 2 || height % 2) {
    spore_error_raise(error, SPORE_ERROR_INPUT, _("film"),
                      _("%d x %d pixels; expected even sides; the next such size is %dx%d"), width, height,
                      width + width % 2, height + height % 2);
    return NULL;
  }
  SporeFilm *film = g_new0(SporeFilm, 1);
  film->webm = spore_webm_new(width, height, fps);
  if (!vpx_img_alloc(&film->image, VPX_IMG_FMT_I420, (unsigned)width, (unsigned)height, 16)) {
    spore_error_raise(error, SPORE_ERROR_MEMORY, _("film"), "%s",
                      _("not enough memory for the picture; make it smaller"));
  } else if (!open_codec(film, width, height, fps)) {
    refuse(film, error);
  } else {
    return film;
  }
  spore_film_free(film);
  return NULL;
}

void spore_film_free(SporeFilm *film) {
  if (!film) return;
  if (film->is_open) vpx_codec_destroy(&film->codec);
  vpx_img_free(&film->image);
  spore_webm_free(film->webm);
  g_free(film);
}

/* Colours. */

/* Luma and chroma of BT.709 (ITU-R BT.709-6, 3.2 to 3.5): Kr = 0.2126, Kb = 0.0722; luma 16 to 235, chroma 16 to 240.
 * In units of 1/65536 of a step. */
static int luma(int r, int g, int b) { return (11966 * r + 40254 * g + 4064 * b + (16 << 16) + 32768) >> 16; }

/* r, g, b: sums over four pixels. */
static int blue_chroma(int r, int g, int b) {
  return (-6595 * r - 22189 * g + 28784 * b + (128 << 18) + (1 << 17)) >> 18;
}

static int red_chroma(int r, int g, int b) {
  return (28784 * r - 26145 * g - 2639 * b + (128 << 18) + (1 << 17)) >> 18;
}

/* Two rows of pixels: two of luma, one of each chroma. */
static void convert_rows(const guint8 *upper, const guint8 *lower, int width, guint8 *const luma_rows[2], guint8 *blue,
                         guint8 *red) {
  for (int x = 0; x < width; x += 2) {
    int sum[3] = {0, 0, 0};
    for (int k = 0; k < 4; k++) {
      guint32 pixel;
      memcpy(&pixel, (k < 2 ? upper : lower) + 4 * (gsize)(x + k % 2), 4);
      int r = (int)(pixel >> 16 & 255), g = (int)(pixel >> 8 & 255), b = (int)(pixel & 255);
      luma_rows[k / 2][x + k % 2] = (guint8)luma(r, g, b);
      sum[0] += r, sum[1] += g, sum[2] += b;
    }
    blue[x / 2] = (guint8)blue_chroma(sum[0], sum[1], sum[2]);
    red[x / 2] = (guint8)red_chroma(sum[0], sum[1], sum[2]);
  }
}

static guint8 *row(const vpx_image_t *image, int plane, int y) {
  return image->planes[plane] + (gssize)y * image->stride[plane];
}

static void convert(vpx_image_t *image, const guint8 *pixels, gsize stride) {
  for (int y = 0; y < (int)image->d_h; y += 2) {
    guint8 *const luma_rows[2] = {row(image, VPX_PLANE_Y, y), row(image, VPX_PLANE_Y, y + 1)};
    const guint8 *upper = pixels + (gsize)y * stride;
    convert_rows(upper, upper + stride, (int)image->d_w, luma_rows, row(image, VPX_PLANE_U, y / 2),
                 row(image, VPX_PLANE_V, y / 2));
  }
}

/* Pictures. */

/* Takes what the encoder has made so far. *any: whether that was something. */
static gboolean take(SporeFilm *film, gboolean *any, GError **error) {
  vpx_codec_iter_t next = NULL;
  const vpx_codec_cx_pkt_t *packet;
  *any = FALSE;
  while ((packet = vpx_codec_get_cx_data(&film->codec, &next))) {
    if (packet->kind != VPX_CODEC_CX_FRAME_PKT) continue;
    *any = TRUE;
    gboolean key = packet->data.frame.flags & VPX_FRAME_IS_KEY;
    if (!spore_webm_add(film->webm, packet->data.frame.buf, packet->data.frame.sz, key, error)) return FALSE;
  }
  return TRUE;
}

gboolean spore_film_add(SporeFilm *film, const guint8 *pixels, gsize stride, GError **error) {
  gboolean any;
  convert(&film->image, pixels, stride);
  if (vpx_codec_encode(&film->codec, &film->image, film->count++, 1, 0, VPX_DL_GOOD_QUALITY) != VPX_CODEC_OK)
    return refuse(film, error);
  return take(film, &any, error);
}

GBytes *spore_film_end(SporeFilm *film, const SporeCancel *cancel, GError **error) {
  gboolean any = TRUE;
  while (any) {
    if (spore_cancel_asked(cancel)) {
      spore_error_raise(error, SPORE_ERROR_CANCELLED, _("film"), _("cancelled"));
      return NULL;
    }
    if (vpx_codec_encode(&film->codec, NULL, 0, 0, 0, VPX_DL_GOOD_QUALITY) != VPX_CODEC_OK) {
      refuse(film, error);
      return NULL;
    }
    if (!take(film, &any, error)) return NULL;
  }
  return spore_webm_end(film->webm);
}
