/* The verdict on a run, and the sentence that says why. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core/base/text.h"
#include "core/measure/stability_private.h"

#define MISS 0.1  /* of the load: a solution that misses more is of little use (core/sim/solve/recovery.c) */
#define GAIN 0.01 /* of the energy at work */
#define REASONS 3 /* that a detail names */

const char *const spore_stability_verdicts[] = {N_("stable"), N_("recovered"), N_("recovered"), N_("failed")};

/* Text that is put together; what has no room is cut at the end of a reason. */
typedef struct Detail {
  char *text;
  size_t size, used, reasons, more;
} Detail;

static void add(Detail *detail, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void add(Detail *detail, const char *format, ...) {
  if (detail->reasons == REASONS) {
    detail->more++;
    return;
  }
  size_t before = detail->used;
  if (detail->reasons > 0 && detail->used + 2 < detail->size) {
    memcpy(detail->text + detail->used, "; ", 3);
    detail->used += 2;
  }
  va_list arguments;
  va_start(arguments, format);
  int length = vsnprintf(detail->text + detail->used, detail->size - detail->used, format, arguments);
  va_end(arguments);
  if (length >= 0 && detail->used + (size_t)length < detail->size) {
    detail->used += (size_t)length;
    detail->reasons++;
    return;
  }
  detail->used = before;
  detail->text[before] = '\0';
  detail->more++;
}

static void end(Detail *detail) {
  if (detail->more == 0) return;
  int length = snprintf(detail->text + detail->used, detail->size - detail->used, _("; and %zu more"), detail->more);
  if (length < 0 || detail->used + (size_t)length >= detail->size) detail->text[detail->used] = '\0';
}

/* Whether what the register says means that the motion is not to be trusted. */
static bool fails(const SporeUnsolved *entry, const SporePush *push) {
  switch (entry->kind) {
  case SPORE_UNSOLVED_RESIDUAL:
    return !(entry->worst <= MISS);
  case SPORE_UNSOLVED_FROZEN:
  case SPORE_UNSOLVED_LEFT_OUT:
  case SPORE_UNSOLVED_ENERGY:
    return true;
  case SPORE_UNSOLVED_PASSED:
    return !push->deep;
  default:
    return false;
  }
}

static void add_entry(Detail *detail, const SporeWorld *world, const SporeUnsolved *entry, size_t steps) {
  const char *body = spore_world_body_name(world, entry->body);
  const SporeModel *model = spore_world_body_model(world, entry->body);
  const char *notice = entry->kind == SPORE_UNSOLVED_MODEL && model->type->notice
                           ? model->type->notice(model, spore_world_q(world, entry->body))
                           : NULL;
  if (notice) add(detail, _("%s: %s, in %llu of %zu steps"), body, notice, (unsigned long long)entry->steps, steps);
  else if (entry->unit)
    add(detail, _("%s: %s, in %llu of %zu steps (worst %.2g%s%s): %s"), body, entry->cause,
        (unsigned long long)entry->steps, steps, entry->worst, *entry->unit ? " " : "", entry->unit, entry->remedy);
  else
    add(detail, _("%s: %s, in %llu of %zu steps: %s"), body, entry->cause, (unsigned long long)entry->steps, steps,
        entry->remedy);
}

/* Adds the entries of the register that fail, or those that do not. */
static void add_entries(Detail *detail, const SporeWorld *world, const SporePush *push, size_t steps, bool failing) {
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++) {
    SporeUnsolved entry = spore_world_unsolved(world, i);
    if (fails(&entry, push) == failing) add_entry(detail, world, &entry, steps);
  }
}

static const char *name_of(const SporeWorld *world, uint32_t body) {
  return body == SPORE_NO_BODY ? "" : spore_world_body_name(world, body);
}

static void add_mended(Detail *detail, const SporeMonitor *monitor, const SporePushRun *run) {
  if (run->judged && run->gain_before > GAIN) add(detail, _("energy rose by %.2g %% before"), 100 * run->gain_before);
  if (monitor->held_inputs > 0)
    add(detail, _("inputs of devices that were held, or followed more slowly: %llu"),
        (unsigned long long)monitor->held_inputs);
  if (monitor->recoveries > 0)
    add(detail, _("steps taken again: %llu, in %llu parts"), (unsigned long long)monitor->recoveries,
        (unsigned long long)monitor->substeps);
}

static void add_stable(Detail *detail, const SporeMonitor *monitor, const SporePushRun *run) {
  if (!run->judged) add(detail, _("all solved; energy is not judged, since a body goes from balance to balance"));
  else if (run->gain > 0) add(detail, _("all solved; energy at most %.2g %% above start and work"), 100 * run->gain);
  else add(detail, _("all solved; energy never above start and work"));
  unsigned long long parted = monitor->broken_links + monitor->lost_holds + monitor->torn_springs;
  if (parted > 0) add(detail, _("links, holds or springs that gave way: %llu"), parted);
}

static bool gains(const SporePushRun *run) { return run->judged && run->gain > GAIN; }

bool spore_push_fails_by_contacts(const SporeWorld *world, const SporePush *push, const SporePushRun *run) {
  bool passed = false;
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++) {
    SporeUnsolved entry = spore_world_unsolved(world, i);
    if (!fails(&entry, push)) continue;
    if (entry.kind != SPORE_UNSOLVED_PASSED) return false;
    passed = true;
  }
  return passed && run->finite && !gains(run);
}

void spore_push_add_remedy(const SporePush *push, char *text, size_t size) {
  size_t used = strlen(text);
  bool stiffer = push->stiffer_contacts > 0;
  int length = snprintf(text + used, size - used,
                        stiffer ? _("; with contacts %g times as stiff they hold")
                                : _("; with steps %g times as small they hold"),
                        stiffer ? push->stiffer_contacts : push->smaller_steps);
  if (length < 0 || used + (size_t)length >= size) text[used] = '\0';
}

SporeStabilityVerdict spore_push_judge(const SporeWorld *world, const SporePush *push, const SporePushRun *run,
                                       char *text, size_t size) {
  Detail detail = {.text = text, .size = size};
  const SporeMonitor *monitor = spore_world_monitor(world);
  *text = '\0';
  if (!run->finite)
    add(&detail, _("%s: the state is not finite after %zu steps: take a smaller time_step"),
        name_of(world, run->fastest), run->steps);
  add_entries(&detail, world, push, run->steps, true);
  if (gains(run))
    add(&detail, _("%s: energy %.2g %% above start and work: take a smaller time_step or a method that damps"),
        name_of(world, run->fastest), 100 * run->gain);
  SporeStabilityVerdict verdict = detail.reasons > 0 ? SPORE_STABILITY_FAILED : SPORE_STABILITY_RECOVERED;
  add_entries(&detail, world, push, run->steps, false);
  add_mended(&detail, monitor, run);
  if (detail.reasons == 0) {
    verdict = SPORE_STABILITY_STABLE;
    add_stable(&detail, monitor, run);
  }
  end(&detail);
  return verdict;
}
