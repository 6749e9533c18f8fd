/* How the results of generators are measured, coloured and drawn. No GTK. */
#ifndef SPORE_UI_JOBS_GENERATE_TYPES_H
#define SPORE_UI_JOBS_GENERATE_TYPES_H

#include "ui/jobs/quality.h"
#include "ui/render/stage.h"

/* A quality of a result, by colours and as a histogram. */
typedef struct SporeGenerateQuality {
  const char *label, *unit; /* label: N_ */
  gboolean names;           /* the values are numbers of things, such as organs, and no measure of quality */
  /* Fills count, values and, where they differ, weights. */
  void (*measure)(const SporeGenerateWork *work, SporeQuality *quality);
  /* Fills the candidate. places: the values on the scale of colours (spore_quality_place); takes them. */
  void (*show)(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate);
} SporeGenerateQuality;

typedef struct SporeGenerateType {
  const char *shows; /* as a generator says */
  gboolean cells;    /* the result is of cells, and can be seen cut open */

  /* Error against number: for these numbers, ended by 0; NULL: no plot. */
  const size_t *counts;
  const char *error_label; /* N_ */
  double worth;            /* % by which twice the number must lower the error */

  const SporeGenerateQuality *qualities; /* at least one */
  gsize quality_count;
} SporeGenerateType;

/* The type that shows results of this generator. */
const SporeGenerateType *spore_generate_type(SporeGenerateKind kind);

#endif
