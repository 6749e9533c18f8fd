/* Axes of plots: which values they span, where a value stands, what they are marked at. */
#include "core/measure/plot_axis.h"

#include <math.h>
#include <string.h>

bool spore_plot_axis_shows(const SporePlotAxis *axis, double value) {
  return isfinite(value) && (!axis->logarithmic || value > 0);
}

double spore_plot_axis_place(const SporePlotAxis *axis, double value) {
  double low = axis->low, high = axis->high;
  if (axis->logarithmic) value = log(value), low = log(low), high = log(high);
  return axis->from + (axis->to - axis->from) * (value - low) / (high - low);
}

static void add_tick(SporePlotAxis *axis, double value) {
  double slack = 1e-9 * (axis->high - axis->low);
  if (axis->ticks < SPORE_PLOT_TICKS && value >= axis->low - slack && value <= axis->high + slack)
    axis->tick[axis->ticks++] = value;
}

/* 1, 2 and 5 of each decade, or 1 alone over many. */
static void tick_decades(SporePlotAxis *axis) {
  static const double steps[] = {1, 2, 5};
  int first = (int)floor(log10(axis->low)), last = (int)ceil(log10(axis->high)), each = last - first > 3 ? 1 : 3;
  int stride = 1 + (last - first) / SPORE_PLOT_TICKS;
  for (int decade = first; decade <= last; decade += stride)
    for (int k = 0; k < each; k++) add_tick(axis, steps[k] * pow(10, decade));
}

static void tick_evenly(SporePlotAxis *axis) {
  double rough = (axis->high - axis->low) / 6, unit = pow(10, floor(log10(rough))), step = unit;
  if (rough > 5 * unit) step = 10 * unit;
  else if (rough > 2 * unit) step = 5 * unit;
  else if (rough > unit) step = 2 * unit;
  double first = ceil(axis->low / step);
  for (double k = 0; k < SPORE_PLOT_TICKS && (first + k) * step <= axis->high + 1e-9 * fabs(axis->high); k++)
    add_tick(axis, (first + k) * step);
}

size_t spore_plot_ticks(double low, double high, double tick[SPORE_PLOT_TICKS]) {
  SporePlotAxis axis = {.low = low, .high = high};
  tick_evenly(&axis);
  memcpy(tick, axis.tick, axis.ticks * sizeof *tick);
  return axis.ticks;
}

static void span(SporePlotAxis *axis, double value, double *low, double *high) {
  if (!spore_plot_axis_shows(axis, value)) return;
  *low = fmin(*low, value);
  *high = fmax(*high, value);
}

bool spore_plot_axis_fit(SporePlotAxis *axis, const SporePlotPanel *panel, bool vertical) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (size_t l = 0; l < panel->line_count; l++)
    for (size_t i = 0; i < panel->lines[l].count; i++) {
      const SporePlotLine *line = &panel->lines[l];
      span(axis, (vertical ? line->y : line->x)[i], &low, &high);
      if (vertical && line->low && line->high)
        span(axis, line->low[i], &low, &high), span(axis, line->high[i], &low, &high);
    }
  if (!(low <= high)) return false;
  if (axis->logarithmic) {
    axis->low = low / 1.2, axis->high = high * 1.2;
    tick_decades(axis);
  } else {
    axis->low = low >= 0 ? 0 : low - 0.05 * (high - low);
    axis->high = high + (high > axis->low ? 0.05 * (high - axis->low) : 1);
    tick_evenly(axis);
  }
  return true;
}
