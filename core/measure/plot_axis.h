/* One direction of a plot's panel. */
#ifndef SPORE_MEASURE_PLOT_AXIS_H
#define SPORE_MEASURE_PLOT_AXIS_H

#include "core/measure/plot.h"

/* Values low .. high lie at pixels from .. to, which the caller sets. */
typedef struct SporePlotAxis {
  double low, high, from, to;
  bool logarithmic;
  double tick[SPORE_PLOT_TICKS]; /* values that the axis is marked at */
  size_t ticks;
} SporePlotAxis;

/* Fits the values of the panel with a little room; a linear axis of values that are not negative begins at 0. False: no
 * value can be shown. */
bool spore_plot_axis_fit(SporePlotAxis *axis, const SporePlotPanel *panel, bool vertical);
/* Whether the value has a place on the axis. */
bool spore_plot_axis_shows(const SporePlotAxis *axis, double value);
/* Pixel of a value that the axis shows. */
double spore_plot_axis_place(const SporePlotAxis *axis, double value);

#endif
