/* The figures of an exercise. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/exercise/exercise_private.h"

#define TEXT(field, text)                                                                                              \
  {                                                                                                                    \
    .name = #field, .type = SPORE_TEXT, .unit = "", .offset = offsetof(SporeMetricFields, field),                      \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define GRADED                                                                                                         \
  SPORE_ROW_NAME(SporeMetricFields, name, N_("Name of the metric.")),                                                  \
      TEXT(good, N_("Threshold from which it is good, a number with its unit; none: it is not judged by that.")),      \
      TEXT(pass, N_("Threshold from which it passes, a number with its unit; none: good is asked for.")),              \
      TEXT(source, N_("Where the thresholds come from.")),                                                             \
      SPORE_ROW_REAL(SporeMetricFields, weight, "", 0, 1e6, 1, N_("Weight of its mark in the score."))
#define TOOL                                                                                                           \
  SPORE_ROW_REFERENCE(SporeMetricFields, tool, tool, SPORE_INSTRUMENT_ELEMENTS,                                        \
                      N_("Instrument that it is about; none: all of them together."))
#define SECONDS .units = {{"s", 1}, {"min", 60}}
#define COUNTED .units = {{"", 1}}
#define NEWTONS .units = {{"N", 1}, {"mN", 1e-3}}

typedef const SporeExercise *Exercise;
typedef const SporeMetricRun *Metric;

static bool is_meant(Metric metric, uint32_t instrument) { return spore_is_meant(metric->from.instrument, instrument); }

/* Time. */

static double time_so_far(Exercise exercise, Metric metric) {
  (void)metric;
  return exercise->time_s;
}
static const SporeParameter time_rows[] = {GRADED};
static const SporeMetricKind time_taken = {.element = "time_taken",
                                           .label = N_("Time"),
                                           .doc = N_("How long the exercise takes."),
                                           .parameters = SPORE_TABLE(time_rows, SporeMetricFields),
                                           SECONDS,
                                           .value = time_so_far};

/* Motion. */

/* Keeps where the instrument is, and adds the way that it went, which is returned. */
static double follow(SporeTrace *trace, SporeVec3 now) {
  memmove(trace->at + 1, trace->at, 3 * sizeof trace->at[0]);
  trace->at[0] = now;
  if (trace->seen < 4) trace->seen++;
  double way = trace->seen > 1 ? spore_vec3_distance(now, trace->at[1]) : 0;
  trace->path += way;
  return way;
}

static void add_paths(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  (void)h;
  for (uint32_t i = 0; i < exercise->instrument_count; i++)
    if (is_meant(metric, i)) follow(&metric->traces[i], spore_instrument_point(exercise, world, i));
}

static double sum_paths(Exercise exercise, Metric metric) {
  double sum = 0;
  for (uint32_t i = 0; i < exercise->instrument_count; i++) sum += metric->traces[i].path;
  return sum;
}
static const SporeParameter path_rows[] = {GRADED, TOOL};
static const SporeMetricKind path_length = {.element = "path_length",
                                            .label = N_("Path length"),
                                            .doc = N_("How far the tips of instruments travel."),
                                            .parameters = SPORE_TABLE(path_rows, SporeMetricFields),
                                            .units = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}},
                                            .traces = true,
                                            .look = add_paths,
                                            .value = sum_paths};

/* `sum` of a trace: straight distances between the places where it was when steps were done. */
static void add_ways(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  add_paths(exercise, metric, world, h);
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    SporeTrace *trace = &metric->traces[i];
    if (trace->seen == 1) trace->stopped = trace->at[0];
    if (trace->seen <= 1 || !exercise->step_was_done) continue;
    trace->sum += spore_vec3_distance(trace->at[0], trace->stopped);
    trace->stopped = trace->at[0];
  }
}

static double economy_of(Exercise exercise, Metric metric) {
  double straight = 0, path = sum_paths(exercise, metric);
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    const SporeTrace *trace = &metric->traces[i];
    straight += trace->sum + spore_vec3_distance(trace->at[0], trace->stopped);
  }
  return path > 0 ? fmin(straight / path, 1) : NAN;
}
static const SporeParameter economy_rows[] = {GRADED, TOOL};
static const SporeMetricKind economy = {
    .element = "economy",
    .label = N_("Economy of motion"),
    .doc = N_("Straight ways between the places where steps were done, over the ways that were gone: 1 at best."),
    .parameters = SPORE_TABLE(economy_rows, SporeMetricFields),
    .units = {{"", 1}, {"%", 1e-2}},
    .more_is_better = true,
    .traces = true,
    .look = add_ways,
    .value = economy_of};

/* `sum` of a trace: square of the jerk over time, m^2/s^5; `time`: how long it was followed. */
static void add_jerks(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  add_paths(exercise, metric, world, h);
  for (uint32_t i = 0; h > 0 && i < exercise->instrument_count; i++) {
    SporeTrace *trace = &metric->traces[i];
    if (trace->seen < 4) continue;
    const SporeVec3 *at = trace->at;
    SporeVec3 third = spore_vec3_add_scaled(spore_vec3_sub(at[0], at[3]), -3, spore_vec3_sub(at[1], at[2]));
    trace->sum += spore_vec3_dot(third, third) / (h * h * h * h * h);
    trace->time += h;
  }
}

/* sqrt(1/2 int jerk^2 dt T^5 / L^2): T. Kitazawa, Y. Goto, Y. Urushihara, "Quantitative evaluation of reaching
 * movements", 1993. The mean by length of all instruments. */
static double jerk_of(Exercise exercise, Metric metric) {
  double sum = 0, path = sum_paths(exercise, metric);
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    const SporeTrace *trace = &metric->traces[i];
    sum += sqrt(0.5 * trace->sum * pow(trace->time, 5)); /* L / L^2 = 1 / L, less the weight L / sum of L */
  }
  return path > 0 ? sum / path : NAN;
}
static const SporeParameter smoothness_rows[] = {GRADED, TOOL};
static const SporeMetricKind smoothness = {
    .element = "smoothness",
    .label = N_("Smoothness (jerk)"),
    .doc = N_("Normalised jerk of instruments: sqrt(1/2 int jerk^2 dt T^5 / L^2), without unit; less is smoother."),
    .parameters = SPORE_TABLE(smoothness_rows, SporeMetricFields),
    COUNTED,
    .traces = true,
    .look = add_jerks,
    .value = jerk_of};

static void count_movements(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    if (!is_meant(metric, i)) continue;
    SporeTrace *trace = &metric->traces[i];
    double way = follow(trace, spore_instrument_point(exercise, world, i)), speed = metric->from.fields.speed;
    bool moves = way > h * (trace->on ? 0.5 * speed : speed);
    metric->count += moves && !trace->on;
    trace->on = moves;
  }
}

static double count_of(Exercise exercise, Metric metric) {
  (void)exercise;
  return (double)metric->count;
}
static const SporeParameter movements_rows[] = {
    GRADED, TOOL,
    SPORE_ROW_REAL(SporeMetricFields, speed, "m/s", 1e-6, 10, 0.01,
                   N_("Faster than this a movement begins; slower than half of this it ends."))};
static const SporeMetricKind movements = {.element = "movements",
                                          .label = N_("Number of movements"),
                                          .doc = N_("How often instruments set out."),
                                          .parameters = SPORE_TABLE(movements_rows, SporeMetricFields),
                                          COUNTED,
                                          .traces = true,
                                          .look = count_movements,
                                          .value = count_of};

/* Contacts and forces. */

/* Adds a bit for each instrument whose spheres overlap the sphere. */
static uint64_t overlapping(Exercise exercise, const SporeSpheres *spheres, size_t sphere) {
  uint64_t found = 0;
  uint32_t own = exercise->instrument_of[spheres->body[sphere]];
  SporeVec3 centre = spore_vec3_load(spheres->centre + 3 * sphere);
  for (size_t s = 0; s < spheres->count; s++) {
    uint32_t other = exercise->instrument_of[spheres->body[s]];
    if (other == SPORE_NO_PART || other == own) continue;
    double away = spore_vec3_distance(centre, spore_vec3_load(spheres->centre + 3 * s));
    if (away < spheres->radius[sphere] + spheres->radius[s]) found |= UINT64_C(1) << other;
  }
  return found;
}

/* Instruments that an instrument overlaps. The world looks for no contacts between bodies that devices move. */
static uint64_t touching(Exercise exercise, const SporeWorld *world, uint32_t instrument) {
  const SporeSpheres *spheres = spore_world_spheres(world);
  uint64_t found = 0;
  for (size_t s = 0; s < spheres->count; s++)
    if (exercise->instrument_of[spheres->body[s]] == instrument) found |= overlapping(exercise, spheres, s);
  return found;
}

static unsigned bits(uint64_t set) {
  unsigned count = 0;
  for (; set; set &= set - 1) count++;
  return count;
}

static void count_collisions(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    if (!is_meant(metric, i)) continue;
    uint64_t now = touching(exercise, world, i);
    /* Of all instruments, a pair counts once: at the first of the two. */
    if (metric->from.instrument == SPORE_NO_PART) now &= i < 63 ? ~UINT64_C(0) << (i + 1) : 0;
    if (h > 0) metric->count += bits(now & ~metric->traces[i].touching); /* not what overlaps when it begins */
    metric->traces[i].touching = now;
  }
}
static const SporeParameter collisions_rows[] = {GRADED, TOOL};
static const SporeMetricKind collisions = {.element = "collisions",
                                           .label = N_("Collisions of instruments"),
                                           .doc = N_("How often spheres of two instruments begin to overlap."),
                                           .parameters = SPORE_TABLE(collisions_rows, SporeMetricFields),
                                           COUNTED,
                                           .traces = true,
                                           .look = count_collisions,
                                           .value = count_of};

/* Force of contacts and links on all bodies of the instrument together, N. */
static double force_on(Exercise exercise, const SporeWorld *world, uint32_t instrument) {
  SporeVec3 sum = {0, 0, 0};
  for (int k = 0; k < SPORE_TOOL_BODIES; k++) {
    uint32_t body = exercise->instruments[instrument].bodies[k];
    if (body != SPORE_NO_BODY) sum = spore_vec3_add(sum, spore_vec3_load(spore_world_reaction(world, body)));
  }
  return spore_vec3_length(sum);
}

static void add_forces(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    double force = is_meant(metric, i) ? force_on(exercise, world, i) : 0;
    metric->peak = fmax(metric->peak, force);
    metric->sum += h * force;
    metric->time += force > metric->from.fields.force ? h : 0;
  }
}

static double peak_of(Exercise exercise, Metric metric) {
  (void)exercise;
  return metric->peak;
}
static const SporeParameter peak_rows[] = {GRADED, TOOL};
static const SporeMetricKind peak_force = {
    .element = "peak_force",
    .label = N_("Peak force"),
    .doc = N_("Largest force of contacts and holds on an instrument, of all its bodies together."),
    .parameters = SPORE_TABLE(peak_rows, SporeMetricFields),
    NEWTONS,
    .look = add_forces,
    .value = peak_of};

static double mean_of(Exercise exercise, Metric metric) {
  (void)exercise;
  return metric->time > 0 ? metric->sum / metric->time : 0;
}
static const SporeParameter mean_rows[] = {GRADED, TOOL};
static const SporeMetricKind mean_force = {
    .element = "mean_force",
    .label = N_("Mean force"),
    .doc = N_("Mean force of contacts and holds on an instrument, over the time in which there is one."),
    .parameters = SPORE_TABLE(mean_rows, SporeMetricFields),
    NEWTONS,
    .look = add_forces,
    .value = mean_of};

static double seconds_of(Exercise exercise, Metric metric) {
  (void)exercise;
  return metric->time;
}
static const SporeParameter excess_rows[] = {
    GRADED, TOOL, SPORE_ROW_REAL(SporeMetricFields, force, "N", 0, 1e6, 2, N_("Force above which time counts."))};
static const SporeMetricKind excess_force = {
    .element = "excess_force",
    .label = N_("Time of excess force"),
    .doc = N_("How long an instrument felt more than a force, of each instrument apart."),
    .parameters = SPORE_TABLE(excess_rows, SporeMetricFields),
    SECONDS,
    .look = add_forces,
    .value = seconds_of};

/* What comes to harm, or is lost. */

static void look_for_blood(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  (void)exercise, (void)h;
  const SporeModel *model = spore_world_body_model(world, metric->from.body);
  uint64_t out = spore_particles_out(world, metric->from.body);
  double millilitres = model->block_mass[0] / metric->from.fields.density * 1e6;
  metric->sum = millilitres * ((double)out - (double)metric->start);
}

static double sum_of(Exercise exercise, Metric metric) {
  (void)exercise;
  return metric->sum;
}
static const SporeParameter blood_rows[] = {
    GRADED, SPORE_ROW_BODY(SporeMetricFields, body, body, N_("Fluid that is lost.")),
    SPORE_ROW_REAL(SporeMetricFields, density, "kg/m^3", 1, 1e5, 1060,
                   N_("Density by which the mass of particles becomes a volume; blood has 1060."))};
static const SporeMetricKind blood_lost = {.element = "blood_lost",
                                           .label = N_("Blood lost"),
                                           .doc =
                                               N_("Volume of the particles that came out since the start, those that "
                                                  "were sucked away as well, and what seeped out as an effect."),
                                           .parameters = SPORE_TABLE(blood_rows, SporeMetricFields),
                                           .units = {{"ml", 1}, {"l", 1e3}},
                                           .needs_body = true,
                                           .needs_fluid = true,
                                           .look = look_for_blood,
                                           .value = sum_of};

static void add_strain(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  (void)exercise;
  const SporeModel *model = spore_world_body_model(world, metric->from.body);
  if (!model->type->strain) return; /* its level of detail knows none */
  double strain = model->type->strain(model, spore_world_q(world, metric->from.body));
  metric->peak = fmax(metric->peak, strain);
  metric->sum += h * fmax(strain, 0);
  metric->time += strain > metric->from.fields.strain ? h : 0;
}

#define STRAINED SPORE_ROW_BODY(SporeMetricFields, body, body, N_("Tissue that is strained."))
#define RATIOS .units = {{"", 1}, {"%", 1e-2}}

static const SporeParameter peak_strain_rows[] = {GRADED, STRAINED};
static const SporeMetricKind peak_strain = {
    .element = "peak_strain",
    .label = N_("Peak strain"),
    .doc = N_("Largest strain of a body's elements, springs or pieces of line: by which part they are longer than at "
              "rest."),
    .parameters = SPORE_TABLE(peak_strain_rows, SporeMetricFields),
    RATIOS,
    .needs_body = true,
    .needs_strain = true,
    .look = add_strain,
    .value = peak_of};

static double strain_of_time(Exercise exercise, Metric metric) {
  return exercise->time_s > 0 ? metric->sum / exercise->time_s : 0;
}
static const SporeParameter mean_strain_rows[] = {GRADED, STRAINED};
static const SporeMetricKind mean_strain = {
    .element = "mean_strain",
    .label = N_("Mean strain"),
    .doc = N_("Mean over the time of a body's largest strain; 0 counts while nothing is longer than at rest."),
    .parameters = SPORE_TABLE(mean_strain_rows, SporeMetricFields),
    RATIOS,
    .needs_body = true,
    .needs_strain = true,
    .look = add_strain,
    .value = strain_of_time};

static const SporeParameter excess_strain_rows[] = {
    GRADED, STRAINED,
    SPORE_ROW_REAL(SporeMetricFields, strain, "", 0, 1e6, 0.5, N_("Strain above which time counts."))};
static const SporeMetricKind excess_strain = {.element = "excess_strain",
                                              .label = N_("Time of excess strain"),
                                              .doc = N_("How long a body was somewhere strained by more than a limit."),
                                              .parameters = SPORE_TABLE(excess_strain_rows, SporeMetricFields),
                                              SECONDS,
                                              .needs_body = true,
                                              .needs_strain = true,
                                              .look = add_strain,
                                              .value = seconds_of};

static void add_unseen(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  bool seen = true;
  for (uint32_t i = 0; i < exercise->instrument_count; i++)
    if (is_meant(metric, i))
      seen &= spore_view_sees(&exercise->views[metric->from.view], world, spore_instrument_point(exercise, world, i));
  metric->time += seen ? 0 : h;
}
static const SporeParameter unseen_rows[] = {
    GRADED, TOOL, SPORE_ROW_REFERENCE(SporeMetricFields, camera, camera, "camera", N_("Camera that has to see it."))};
static const SporeMetricKind out_of_view = {
    .element = "out_of_view",
    .label = N_("Out of view"),
    .doc = N_("How long the tip of an instrument was outside what the camera sees, as wide as it is high; without a "
              "tool, that of any."),
    .parameters = SPORE_TABLE(unseen_rows, SporeMetricFields),
    SECONDS,
    .needs_view = true,
    .look = add_unseen,
    .value = seconds_of};

/* Whether the body touches anything but instruments. */
static bool lies_on_something(Exercise exercise, const SporeWorld *world, uint32_t body) {
  for (size_t i = 0; i < spore_world_contact_count(world); i++) {
    SporeTouch touch = spore_world_contact(world, i);
    uint32_t other = touch.body_a == body ? touch.body_b : touch.body_a;
    if ((touch.body_a == body || touch.body_b == body) && exercise->instrument_of[other] == SPORE_NO_PART) return true;
  }
  return false;
}

static size_t holds(Exercise exercise, const SporeWorld *world, uint32_t instrument, uint32_t body) {
  uint32_t tool = exercise->instruments[instrument].tool;
  return tool == SPORE_NO_PART ? 0 : spore_world_tool_holds(world, tool, body);
}

static bool is_held_by_any(Exercise exercise, const SporeWorld *world, uint32_t body) {
  bool held = false;
  for (uint32_t i = 0; i < exercise->instrument_count && !held; i++) held = holds(exercise, world, i, body) > 0;
  return held;
}

/* Begins to follow a body that the instrument holds, of those that the metric is about. */
static void follow_hold(Exercise exercise, const SporeMetricRun *metric, const SporeWorld *world, uint32_t instrument) {
  SporeTrace *trace = &metric->traces[instrument];
  uint32_t wanted = metric->from.body;
  trace->on = false;
  for (uint32_t b = 0; b < exercise->body_count && !trace->on; b++) {
    trace->on = (wanted == SPORE_NO_BODY || wanted == b) && holds(exercise, world, instrument, b) > 0;
    trace->held = b;
  }
}

static void count_drops(Exercise exercise, SporeMetricRun *metric, const SporeWorld *world, double h) {
  (void)h;
  for (uint32_t i = 0; i < exercise->instrument_count; i++) {
    SporeTrace *trace = &metric->traces[i];
    if (!is_meant(metric, i) || exercise->instruments[i].tool == SPORE_NO_PART) continue;
    if (trace->on && holds(exercise, world, i, trace->held) > 0) continue;
    bool torn = spore_world_tool_state(world, exercise->instruments[i].tool).lost > 0;
    bool stays = lies_on_something(exercise, world, trace->held) || is_held_by_any(exercise, world, trace->held);
    if (trace->on) metric->count += torn || !stays;
    follow_hold(exercise, metric, world, i);
  }
}
static const SporeParameter drops_rows[] = {
    GRADED, TOOL, SPORE_ROW_BODY(SporeMetricFields, body, body, N_("Body that jaws hold; none: any."))};
static const SporeMetricKind drops = {
    .element = "drops",
    .label = N_("Drops"),
    .doc = N_("How often a body tears out of jaws, or is let go where it lies on nothing and no other jaws hold it."),
    .parameters = SPORE_TABLE(drops_rows, SporeMetricFields),
    COUNTED,
    .traces = true,
    .look = count_drops,
    .value = count_of};

static double errors_of(Exercise exercise, Metric metric) {
  (void)metric;
  return (double)spore_exercise_errors(exercise);
}
static const SporeParameter errors_rows[] = {GRADED};
static const SporeMetricKind errors = {
    .element = "errors",
    .label = N_("Errors of order"),
    .doc = N_("How often a tool began what cannot be undone before it was its turn, or what had to last "
              "ended."),
    .parameters = SPORE_TABLE(errors_rows, SporeMetricFields),
    COUNTED,
    .value = errors_of};

const SporeMetricKind *const spore_metric_kinds[] = {
    &time_taken, &path_length, &economy,      &smoothness,  &movements,   &collisions,
    &peak_force, &mean_force,  &excess_force, &peak_strain, &mean_strain, &excess_strain,
    &blood_lost, &out_of_view, &drops,        &errors,      NULL};

const SporeMetricKind *spore_metric_kind_find(const char *element) {
  assert(element);
  const SporeMetricKind *const *kind = spore_metric_kinds;
  while (*kind && strcmp((*kind)->element, element)) kind++;
  return *kind;
}
