/* Legends as they are drawn: what stands in their rows, and pictures of them where no toolkit draws. */
#ifndef SPORE_UI_RENDER_LEGEND_H
#define SPORE_UI_RENDER_LEGEND_H

#include "ui/render/stage.h"

/* Rows of a legend, from the top. */
typedef enum SporeLegendRowKind {
  SPORE_LEGEND_LINE, /* text */
  SPORE_LEGEND_BAR,  /* the scale of colours */
  SPORE_LEGEND_TINT, /* a bar of one colour */
  SPORE_LEGEND_ENDS, /* text at the beginning of the bar, and end_text at its end */
  SPORE_LEGEND_KEY   /* a patch of colour, and text */
} SporeLegendRowKind;
typedef struct SporeLegendRow {
  SporeLegendRowKind kind;
  const char *text, *end_text; /* NULL where there is none */
  const double *colour;        /* of the tint, of the key: of a screen, 0..1 */
} SporeLegendRow;
#define SPORE_LEGEND_ROWS (6 + SPORE_STAGE_LINK_KINDS)

/* On which legends and figures stand over a picture, and their letters: of a screen and an opacity, 0..1. [1]: in the
 * light room. */
extern const double spore_legend_ground[2][4], spore_legend_letters[2][3];

/* The rows of the legend, which own nothing: they are valid until the legend is cleared. brief: without remarks, where
 * it has a scale. Returns their number. */
guint spore_legend_rows(const SporeStageLegend *legend, gboolean brief, SporeLegendRow rows[SPORE_LEGEND_ROWS]);

/* Draws the legends into a picture (as of spore_renderer_read), one above the other at the lower right. light: on a
 * light ground. Returns how many found no room; G_MAXUINT with a GError: this build, or this machine, draws no text. */
guint spore_legends_draw(const SporeStageLegend *legends, guint count, gboolean light, guint8 *pixels, int width,
                         int height, gsize stride, GError **error);

#endif
