/* Plots as SVG: panels side by side with lines through measured points. Lines differ by colour, by the shape of their
 * points and by their dashes, so that they can be told apart in black and white. */
#ifndef SPORE_MEASURE_PLOT_H
#define SPORE_MEASURE_PLOT_H

#include <stdbool.h>
#include <stddef.h>

#include "core/base/error.h"

/* A line through points, in this order. Points that are not finite, or not above 0 on a logarithmic axis, are left out.
 */
typedef struct SporePlotLine {
  const char *label; /* translated; lines of the same index in the panels look the same, and there is one legend */
  size_t count;
  const double *x, *y;
  bool scattered;              /* points alone, not joined; lines of many points are drawn without them */
  const bool *hollow, *ringed; /* count: points drawn empty, and with a ring around; NULL: none */
  const double *low, *high;    /* count: a bar from low to high at each point; NULL: none */
} SporePlotLine;

typedef struct SporePlotPanel {
  const char *x_label, *y_label; /* translated, with units */
  bool log_x, log_y;
  const SporePlotLine *lines;
  size_t line_count;
  const char *mark_label; /* of a vertical line at mark_x; NULL: none */
  double mark_x;
  double shade_below;      /* a grey band from there down, on a logarithmic axis; 0: none */
  const char *shade_label; /* in the band */
  bool label_lines;        /* labels stand at the ends of the lines, too */
} SporePlotPanel;

/* Colours of lines, "#rrggbb", of Okabe and Ito (2008), which people with colour blindness can distinguish. Line i has
 * colour i % SPORE_PLOT_COLOURS. */
#define SPORE_PLOT_COLOURS 6
extern const char *const spore_plot_colours[SPORE_PLOT_COLOURS];
/* Dashes of line i, and what its points look like. */
typedef struct SporePlotStyle {
  size_t dash_count;    /* 0: the line is whole */
  double dash[4];       /* pixels drawn, left out, drawn, left out */
  size_t corner_count;  /* 0: points are circles of radius 1 */
  double corner[12][2]; /* x to the right, y downwards, around (0, 0) */
} SporePlotStyle;
extern const SporePlotStyle spore_plot_styles[SPORE_PLOT_COLOURS];
/* Values that a linear axis from low to high is marked at, low < high: multiples of 1, 2 or 5 of a power of 10. Returns
 * their number. */
#define SPORE_PLOT_TICKS 24
size_t spore_plot_ticks(double low, double high, double tick[SPORE_PLOT_TICKS]);

/* An SVG document in UTF-8, to be freed with spore_free; numbers are in the C locale. note: lines of text below the
 * panels, may be NULL. The legend is that of the first panel. NULL: no memory, or no panel has a point to show. */
char *spore_plot_svg(const char *title, const char *note, const SporePlotPanel *panels, size_t panel_count,
                     SporeError *error);

#endif
