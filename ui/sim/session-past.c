/* What went into a run since time 0. */
#include "ui/sim/session-past.h"

#include <string.h>

#define NOT_APPLIED G_MAXUINT64

typedef struct {
  gsize number;
  guint64 step; /* in which it was applied */
  SporeCommand command;
} Posted;

struct SporePast {
  guint hands;
  GArray **inputs; /* of each hand: SporePastInput, each only where it differs from the one before */
  GArray *posted;  /* in order of number, and of step */
};

SporePast *spore_past_new(guint hands) {
  SporePast *past = g_new0(SporePast, 1);
  past->hands = hands;
  past->inputs = g_new0(GArray *, hands);
  for (guint i = 0; i < hands; i++) past->inputs[i] = g_array_new(FALSE, FALSE, sizeof(SporePastInput));
  past->posted = g_array_new(FALSE, FALSE, sizeof(Posted));
  return past;
}

void spore_past_free(SporePast *past) {
  if (!past) return;
  for (guint i = 0; i < past->hands; i++) g_array_unref(past->inputs[i]);
  g_free(past->inputs);
  g_array_unref(past->posted);
  g_free(past);
}

void spore_past_clear(SporePast *past) {
  for (guint i = 0; i < past->hands; i++) g_array_set_size(past->inputs[i], 0);
  g_array_set_size(past->posted, 0);
}

/* The clock of the device moves nothing. */
static gboolean is_same(const SporePastInput *one, const SporePastInput *other) {
  SporeDeviceState a = one->state, b = other->state;
  a.t_ns = b.t_ns = 0;
  return memcmp(&a, &b, sizeof a) == 0 && one->driven == other->driven && one->led == other->led;
}

void spore_past_add(SporePast *past, guint hand, const SporePastInput *input) {
  GArray *inputs = past->inputs[hand];
  const SporePastInput *last = inputs->len > 0 ? &g_array_index(inputs, SporePastInput, inputs->len - 1) : NULL;
  if (last && (input->time_s <= last->time_s || is_same(input, last))) return;
  g_array_append_val(inputs, *input);
}

/* Inputs that are no later than the time. */
static guint count_until(const GArray *inputs, double time_s) {
  guint from = 0, to = inputs->len;
  while (from < to) {
    guint middle = from + (to - from) / 2;
    if (g_array_index(inputs, SporePastInput, middle).time_s <= time_s) from = middle + 1;
    else to = middle;
  }
  return from;
}

const SporePastInput *spore_past_find(const SporePast *past, guint hand, double time_s) {
  const GArray *inputs = past->inputs[hand];
  guint count = count_until(inputs, time_s);
  return count > 0 ? &g_array_index(inputs, SporePastInput, count - 1) : NULL;
}

void spore_past_post(SporePast *past, gsize number, const SporeCommand *command) {
  const Posted posted = {number, NOT_APPLIED, *command};
  if (!command->fields) g_array_append_val(past->posted, posted);
}

void spore_past_applied(SporePast *past, gsize applied, guint64 step) {
  for (guint i = past->posted->len; i > 0; i--) {
    Posted *posted = &g_array_index(past->posted, Posted, i - 1);
    if (posted->step != NOT_APPLIED) break;
    if (posted->number <= applied) posted->step = step;
  }
}

/* Commands of steps before this one. */
static guint count_before(const GArray *posted, guint64 step) {
  guint from = 0, to = posted->len;
  while (from < to) {
    guint middle = from + (to - from) / 2;
    if (g_array_index(posted, Posted, middle).step < step) from = middle + 1;
    else to = middle;
  }
  return from;
}

const SporeCommand *spore_past_command(const SporePast *past, guint64 step, guint i) {
  guint at = count_before(past->posted, step) + i;
  if (at >= past->posted->len || g_array_index(past->posted, Posted, at).step != step) return NULL;
  return &g_array_index(past->posted, Posted, at).command;
}

void spore_past_cut(SporePast *past, guint64 step, double time_s) {
  for (guint i = 0; i < past->hands; i++) g_array_set_size(past->inputs[i], count_until(past->inputs[i], time_s));
  g_array_set_size(past->posted, count_before(past->posted, step));
}
