/* Relocations one at a time. A ball of little worth is put beside a ball of large burden. Both are refitted with their
 * neighbours, while all other balls stay. Only the groups of samples that the refitted balls can reach are evaluated
 * again, so the cost of a trial does not depend on the number of balls. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/spheres/fit.h"

#define SPLIT_SHARE 0.5 /* of a ball's burden: the expected gain of a split */
#define MOST_ACTIVE 40  /* balls refitted in a trial */
#define TRIAL_ROUNDS 8
#define WORK_LEAST 32000 /* groups of samples evaluated, after which no more trials are made */
#define WORK_PER_BALL 48
#define PATIENCE 12 /* passes without gain, after which the search ends */

typedef struct Local {
  SporeFit *fit;
  double *least, *loss; /* groups: least value at the middle for a ball to matter there; loss of the samples */
  double *saved_least, *saved_loss; /* the same before the trial, for groups in the trial */
  SporeField saved;                 /* the field before the trial, for groups in the trial */
  uint32_t *groups;                 /* in the trial */
  size_t group_count;
  bool *taken;                                           /* groups: in the trial */
  uint32_t active[MOST_ACTIVE];                          /* balls refitted */
  double before[4 * MOST_ACTIVE], last[4 * MOST_ACTIVE]; /* active balls before the trial; before the round */
  double found[4 * MOST_ACTIVE];                         /* active balls at the least loss */
  double known[4 * MOST_ACTIVE];                         /* see SporeFit, before the trial */
  size_t active_count, work, most_work;
} Local;

static size_t group_first(size_t g) { return g * SPORE_GROUP * SPORE_BLOCK; }
static size_t group_size(const Local *l, size_t g) {
  size_t first = group_first(g), padded = l->fit->samples->points.block_count * SPORE_BLOCK;
  return padded - first < SPORE_GROUP * SPORE_BLOCK ? padded - first : SPORE_GROUP * SPORE_BLOCK;
}

static double group_loss(const Local *l, size_t g) {
  const SporeFit *fit = l->fit;
  const double *best = fit->field.best, *depth = fit->samples->depth, *weight = fit->samples->weight;
  double sum = 0;
  for (size_t i = group_first(g), end = i + group_size(l, g); i < end; i++)
    sum += weight[i] * spore_fit_sample_loss(fit, best[i] - depth[i]);
  return sum;
}

static void evaluate_group(Local *l, size_t g) {
  l->least[g] = spore_field_evaluate_group(&l->fit->field, &l->fit->samples->points, &l->fit->balls, g);
  l->loss[g] = group_loss(l, g);
  l->work++;
}

static void copy_field(const Local *l, SporeField *to, const SporeField *from, size_t g) {
  size_t first = group_first(g), size = group_size(l, g);
  memcpy(to->best + first, from->best + first, size * sizeof *to->best);
  memcpy(to->second + first, from->second + first, size * sizeof *to->second);
  memcpy(to->owner + first, from->owner + first, size * sizeof *to->owner);
}

static void take_group(Local *l, size_t g) {
  l->taken[g] = true;
  l->groups[l->group_count++] = (uint32_t)g;
  l->saved_least[g] = l->least[g], l->saved_loss[g] = l->loss[g];
  copy_field(l, &l->saved, &l->fit->field, g);
}

/* Adds to the trial each group in which an active ball, at its present place, may be best or second best. */
static void take_groups(Local *l) {
  const SporePoints *points = &l->fit->samples->points;
  const SporeBalls *balls = &l->fit->balls;
  for (size_t g = 0; g < points->group_count; g++) {
    const double *middle = points->group + 4 * g;
    for (size_t i = 0; i < l->active_count && !l->taken[g]; i++) {
      size_t b = l->active[i];
      double value = balls->r[b] - spore_vec3_distance(spore_balls_centre(balls, b), spore_vec3_load(middle));
      if (value >= l->least[g]) take_group(l, g);
    }
  }
}

static double trial_loss(const Local *l, const double *loss) {
  double sum = 0;
  for (size_t i = 0; i < l->group_count; i++) sum += loss[l->groups[i]];
  return sum;
}

static void store_active(const Local *l, double *spheres) {
  const SporeBalls *balls = &l->fit->balls;
  for (size_t i = 0; i < l->active_count; i++) {
    spore_vec3_store(spheres + 4 * i, spore_balls_centre(balls, l->active[i]));
    spheres[4 * i + 3] = balls->r[l->active[i]];
  }
}

static void load_active(Local *l, const double *spheres) {
  for (size_t i = 0; i < l->active_count; i++)
    spore_balls_set(&l->fit->balls, l->active[i], spore_vec3_load(spheres + 4 * i), spheres[4 * i + 3]);
}

static void evaluate_trial(Local *l) {
  take_groups(l);
  for (size_t i = 0; i < l->group_count; i++) evaluate_group(l, l->groups[i]);
}

static void add_active(Local *l, size_t ball) {
  for (size_t i = 0; i < l->active_count; i++)
    if (l->active[i] == ball) return;
  if (l->active_count < MOST_ACTIVE) l->active[l->active_count++] = (uint32_t)ball;
}

/* The pair and the balls that overlap a ball of the pair. */
static void choose_active(Local *l, size_t spare, size_t target) {
  const SporeBalls *balls = &l->fit->balls;
  const size_t pair[2] = {target, spare};
  l->active_count = 0;
  add_active(l, target);
  add_active(l, spare);
  for (int p = 0; p < 2; p++)
    for (size_t i = 0; i < balls->count; i++)
      if (spore_vec3_distance(spore_balls_centre(balls, i), spore_balls_centre(balls, pair[p])) <
          balls->r[i] + balls->r[pair[p]])
        add_active(l, i);
  for (size_t i = 0; i < l->active_count; i++)
    memcpy(l->known + 4 * i, l->fit->known + 4 * (size_t)l->active[i], 4 * sizeof *l->known);
}

static void step_active(Local *l, double damping) {
  SporeFit *fit = l->fit;
  for (size_t i = 0; i < l->active_count; i++)
    memset(fit->normal + 14 * (size_t)l->active[i], 0, 14 * sizeof *fit->normal);
  bool *is_active = fit->marked + fit->balls.count;
  for (size_t i = 0; i < l->active_count; i++) is_active[l->active[i]] = true;
  for (size_t i = 0; i < l->group_count; i++)
    for (size_t k = group_first(l->groups[i]), end = k + group_size(l, l->groups[i]); k < end; k++)
      if (is_active[fit->field.owner[k]]) spore_fit_add_normal(fit, k, fit->normal + 14 * (size_t)fit->field.owner[k]);
  for (size_t i = 0; i < l->active_count; i++) {
    double sphere[4];
    size_t ball = l->active[i];
    is_active[ball] = false;
    spore_fit_step_ball(fit, ball, fit->normal + 14 * ball, damping, sphere);
    spore_balls_set(&fit->balls, ball, spore_vec3_load(sphere), sphere[3]);
  }
}

static void end_trial(Local *l) {
  for (size_t i = 0; i < l->group_count; i++) l->taken[l->groups[i]] = false;
  l->group_count = 0;
}

static void undo_trial(Local *l) {
  load_active(l, l->before);
  for (size_t i = 0; i < l->active_count; i++)
    memcpy(l->fit->known + 4 * (size_t)l->active[i], l->known + 4 * i, 4 * sizeof *l->known);
  for (size_t i = 0; i < l->group_count; i++) {
    size_t g = l->groups[i];
    copy_field(l, &l->fit->field, &l->saved, g);
    l->least[g] = l->saved_least[g], l->loss[g] = l->saved_loss[g];
  }
}

/* Steps all active balls in rounds; keeps the state of least loss. */
static void refit(Local *l) {
  double damping = 1e-2, best = HUGE_VAL;
  bool at_best = false;
  for (int round = 0; round < TRIAL_ROUNDS; round++) {
    double now = trial_loss(l, l->loss), old = trial_loss(l, l->saved_loss);
    if (now - old < best) best = now - old, store_active(l, l->found);
    store_active(l, l->last);
    step_active(l, damping);
    evaluate_trial(l);
    double more = trial_loss(l, l->loss) - trial_loss(l, l->saved_loss);
    at_best = more < best;
    if (more - (now - old) > 0.002 * now) {
      load_active(l, l->last);
      evaluate_trial(l);
      damping *= 4;
    } else damping = fmax(0.6 * damping, 1e-4);
  }
  if (at_best) return;
  load_active(l, l->found);
  evaluate_trial(l);
}

/* True: the split lowers the loss and is kept. */
static bool try_split(Local *l, size_t spare, size_t target) {
  choose_active(l, spare, target);
  store_active(l, l->before);
  take_groups(l);
  spore_fit_split(l->fit, target, spare);
  evaluate_trial(l);
  refit(l);
  bool better = trial_loss(l, l->loss) < trial_loss(l, l->saved_loss) * (1 - 1e-6);
  if (!better) undo_trial(l);
  end_trial(l);
  return better;
}

/* Trials over pairs without balls that already changed in this pass. *paid: number of trials that were kept. False:
 * cancelled. */
static bool pass(Local *l, double shake, size_t *paid, const SporeProgressPart *progress, SporeError *error) {
  SporeFit *fit = l->fit;
  size_t n = fit->balls.count, next = 0, tried = 0, most = n / 8 + 2;
  spore_fit_weigh(fit);
  spore_fit_rank(fit, shake);
  memset(fit->marked, 0, n * sizeof *fit->marked);
  *paid = 0;
  for (size_t i = 0; i < n && tried < most && l->work < l->most_work; i++) {
    uint32_t target = fit->heaviest[i];
    if (fit->marked[target]) continue;
    while (next < n && (fit->marked[fit->order[next]] || fit->order[next] == target)) next++;
    if (next == n || fit->worth[fit->order[next]] >= SPLIT_SHARE * fit->burden[target]) break;
    uint32_t spare = fit->order[next];
    fit->marked[target] = fit->marked[spare] = true;
    tried++;
    if (!spore_progress_part(progress, fmin(1, (double)l->work / (double)l->most_work), _("Fitting spheres"), error))
      return false;
    if (!try_split(l, spare, target)) continue;
    ++*paid;
    for (size_t k = 0; k < l->active_count; k++) fit->marked[l->active[k]] = true;
  }
  return true;
}

static bool open_local(Local *l, SporeFit *fit) {
  size_t groups = fit->samples->points.group_count;
  *l = (Local){.fit = fit,
               .least = SPORE_NEW_ARRAY(double, groups),
               .loss = SPORE_NEW_ARRAY(double, groups),
               .saved_least = SPORE_NEW_ARRAY(double, groups),
               .saved_loss = SPORE_NEW_ARRAY(double, groups),
               .groups = SPORE_NEW_ARRAY(uint32_t, groups),
               .taken = SPORE_NEW_ARRAY(bool, groups)};
  return spore_field_create(&l->saved, &fit->samples->points, 1) && l->least && l->loss && l->saved_least &&
         l->saved_loss && l->groups && l->taken;
}

static void close_local(Local *l) {
  spore_free(l->least);
  spore_free(l->loss);
  spore_free(l->saved_least);
  spore_free(l->saved_loss);
  spore_free(l->groups);
  spore_free(l->taken);
  spore_field_clear(&l->saved);
}

bool spore_fit_relocate(SporeFit *fit, const SporeProgressPart *progress, SporeError *error) {
  Local local;
  double shake = 0;
  int failures = 0;
  bool done = open_local(&local, fit);
  if (!done) spore_generate_no_memory(error);
  for (size_t g = 0; done && g < fit->samples->points.group_count; g++) {
    evaluate_group(&local, g);
    if (g % 64 == 0) done = spore_progress_part(progress, 0, _("Fitting spheres"), error);
  }
  local.work = 0;
  local.most_work = WORK_PER_BALL * fit->balls.count;
  if (local.most_work < WORK_LEAST) local.most_work = WORK_LEAST;
  while (done && failures < PATIENCE && local.work < local.most_work) {
    size_t paid;
    done = pass(&local, shake, &paid, progress, error);
    if (paid) failures = 0;
    else failures++, shake = fmin(shake + 0.1, 0.6);
    spore_progress_show_images(progress, &fit->solid->symmetry, &fit->balls, fit->bound);
  }
  close_local(&local);
  return done;
}
