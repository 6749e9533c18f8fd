/* Rows of the exercise's lists: a step, and a metric with its thresholds. Each row shows an object of the document, and
 * what a run has made of it. */
#ifndef SPORE_UI_PANELS_EXERCISE_ROWS_H
#define SPORE_UI_PANELS_EXERCISE_ROWS_H

#include <gtk/gtk.h>

#include "core/exercise/exercise.h"
#include "core/scene/document.h"

/* The columns of a table of metrics. */
typedef enum SporeMetricColumn {
  SPORE_METRIC_NAME,
  SPORE_METRIC_FIGURE,
  SPORE_METRIC_GOOD_FROM,
  SPORE_METRIC_PASS_FROM,
  SPORE_METRIC_MARK,
  SPORE_METRIC_COLUMNS
} SporeMetricColumn;

GtkWidget *spore_step_row_new(const SporeObject *step);
/* columns: size groups that hold the rows' cells to one width. */
GtkWidget *spore_metric_row_new(const SporeObject *metric, GtkSizeGroup *const columns[SPORE_METRIC_COLUMNS]);
/* Titles above the rows of metrics. */
GtkWidget *spore_metric_heads_new(GtkSizeGroup *const columns[SPORE_METRIC_COLUMNS]);
/* Id of the row's object. */
guint32 spore_exercise_row_id(GtkWidget *row);
/* Shows what the document says. number: of the step, from 1. */
void spore_step_row_refresh(GtkWidget *row, const SporeObject *step, guint number);
void spore_metric_row_refresh(GtkWidget *row, const SporeObject *metric);
/* Shows what the run says; NULL: there is no run, or it has no such part. */
void spore_step_row_show(GtkWidget *row, const SporeStepState *state);
void spore_metric_row_show(GtkWidget *row, const SporeMetricState *state);

#endif
