/* What the files of the budget share. */
#ifndef SPORE_AUTHOR_BUDGET_PRIVATE_H
#define SPORE_AUTHOR_BUDGET_PRIVATE_H

#include "core/author/budget.h"
#include "core/scene/variation.h"

/* A body that physics moves. */
typedef struct SporeBudgetSubject {
  const char *name;
  guint32 body;
  SporeIntegratorKind integrator; /* as it is */
  gsize substeps;
  int level; /* as it is */
  gboolean levels[SPORE_LOD_COUNT];
  gboolean keeps_level, keeps_integrator, particles;
  gboolean sweeps;                        /* its elements can be met one after the other */
  double limit_s[SPORE_INTEGRATOR_COUNT]; /* the largest stable step of explicit methods; of implicit ones infinite */
} SporeBudgetSubject;

/* A choice for the whole scene; -1: as it is. */
typedef struct SporeBudgetChoice {
  double dt_s;
  int nonlinear, linear;
  int *integrator, *level; /* one a subject */
  SporeAccuracyPoint point;
} SporeBudgetChoice;

typedef struct SporeBudgetSearch SporeBudgetSearch;
/* Runs and judges a choice. FALSE: cancelled, or no memory. */
typedef gboolean (*SporeBudgetMeasure)(SporeBudgetSearch *search, SporeBudgetChoice *choice, gboolean timed_only,
                                       SporeAccuracyPoint *point, SporeError *error);

/* A search while it goes on. */
struct SporeBudgetSearch {
  const SporeBudgetOptions *options;
  SporeBudget *result;
  SporeAccuracyReport *report;
  gsize count;
  SporeBudgetSubject *subjects;
  GPtrArray *tried; /* of SporeBudgetChoice; the first is the scene as it is */
  SporeProgressShare share;
  SporeBudgetMeasure measure;
  double limit;   /* s on the processor for a simulated s */
  double until_s; /* on the processor: the search ends then */
  gboolean ended; /* for want of time */
};

/* budget_choice.c */
/* Whether an integrator is tried: all are but static, which finds a balance, and explicit_euler, since symplectic_euler
 * does the same work, is of the same order and bears larger steps. */
gboolean spore_budget_may_pay(int integrator);
SporeBudgetChoice *spore_budget_choice_new(const SporeBudgetSearch *search, double dt_s);
SporeBudgetChoice *spore_budget_choice_copy(const SporeBudgetSearch *search, const SporeBudgetChoice *choice);
void spore_budget_choice_free(gpointer choice);
gboolean spore_budget_choice_equal(const SporeBudgetSearch *search, const SporeBudgetChoice *a,
                                   const SporeBudgetChoice *b);
/* The choice that a point of the study is: all bodies alike, as far as they can be. */
SporeBudgetChoice *spore_budget_choice_of_point(const SporeBudgetSearch *search, const SporeAccuracyPoint *point);
/* As a variation of the scene. settings: one a subject, to be kept as long. */
SporeVariation spore_budget_choice_variation(const SporeBudgetSearch *search, const SporeBudgetChoice *choice,
                                             SporeBodySetting *settings);
/* Whether it is sound, or else the scene as it is is not, either. */
gboolean spore_budget_choice_is_valid(const SporeBudgetSearch *search, const SporeBudgetChoice *choice);
/* Whether it is valid and costs no more than it may. */
gboolean spore_budget_choice_fits(const SporeBudgetSearch *search, const SporeBudgetChoice *choice);
/* Whether a is to be taken rather than b: it fits, is nearer, or as near and cheaper; where neither fits, cheaper. */
gboolean spore_budget_choice_is_better(const SporeBudgetSearch *search, const SporeBudgetChoice *a,
                                       const SporeBudgetChoice *b);

/* budget_try.c */
/* SporeBudgetMeasure over the stretch of the study. */
gboolean spore_budget_measure(SporeBudgetSearch *search, SporeBudgetChoice *choice, gboolean timed_only,
                              SporeAccuracyPoint *point, SporeError *error);
gboolean spore_budget_was_tried(const SporeBudgetSearch *search, const SporeBudgetChoice *choice);
/* Tries a choice, which `tried` takes over; *best becomes it where it is better. FALSE: cancelled, or no memory. */
gboolean spore_budget_try(SporeBudgetSearch *search, SporeBudgetChoice *choice, SporeBudgetChoice **best,
                          SporeError *error);

/* budget_search.c */
/* The best choice that was found, which `tried` owns. NULL: cancelled, or no memory. */
SporeBudgetChoice *spore_budget_search(SporeBudgetSearch *search, SporeError *error);

/* budget_together.c */
/* Tries several changes of the best choice at once, by what each of them did alone. FALSE: cancelled, or no memory. */
gboolean spore_budget_try_together(SporeBudgetSearch *search, SporeBudgetChoice **best, SporeError *error);

#endif
