/* The events that make a step of an exercise done. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/exercise/exercise_private.h"

#define NAMED                                                                                                          \
  SPORE_ROW_NAME(SporeEventFields, name, N_("Name of the step.")),                                                     \
      SPORE_ROW_REFERENCE(SporeEventFields, after, after, SPORE_STEP_ELEMENTS,                                         \
                          N_("Step that must be done before this one counts; none: it counts from the start.")),       \
  {                                                                                                                    \
    .name = "hint", .type = SPORE_TEXT, .unit = "", .offset = offsetof(SporeEventFields, hint),                        \
    .change = SPORE_CHANGE_REBUILD, .doc = N_("What the trainee is told when the step is next.")                       \
  }
#define TOOL(elements)                                                                                                 \
  SPORE_ROW_REFERENCE(SporeEventFields, tool, tool, elements, N_("Instrument that does it; none: any that can."))
#define BODY SPORE_ROW_BODY(SporeEventFields, body, body, N_("Body that it is done to."))
#define BODY_OR_TOOL                                                                                                   \
  SPORE_ROW_BODY(SporeEventFields, body, body, N_("Body whose middle has to get there; none: the instrument has to."))
#define COUNT(text) SPORE_ROW_COUNT(SporeEventFields, count, 1, 1e9, 1, text)
#define STAYS                                                                                                          \
  {                                                                                                                    \
    .name = "stays", .type = SPORE_BOOLEAN, .unit = "", .offset = offsetof(SporeEventFields, stays),                   \
    .change = SPORE_CHANGE_REBUILD,                                                                                    \
    .doc =                                                                                                             \
        N_("Whether it has to last until the steps that wait for it are done: when it ends before, it is an error, "   \
           "and the step has to be done again.")                                                                       \
  }
#define TIME(start, text) SPORE_ROW_REAL(SporeEventFields, time, "s", 0, 3600, start, text)

typedef const SporeExercise *Exercise;

static bool is_held(Exercise exercise, const SporeWorld *world, uint32_t instrument, uint32_t body) {
  if (instrument == SPORE_NO_PART || exercise->instruments[instrument].tool == SPORE_NO_PART) return false;
  return spore_world_tool_holds(world, exercise->instruments[instrument].tool, body) > 0;
}

/* Contacts and holds. */

#define DROP_REACH 1.02 /* of the radii: drops are put out of what they touch */

/* Whether an instrument touches drops of a fluid that is an effect, which nothing feels. */
static bool is_wetted(Exercise exercise, uint32_t body, const SporeWorld *world, uint32_t instrument) {
  const SporeSpheres *all = spore_world_spheres(world);
  const SporeModel *model = spore_world_body_model(world, body);
  if (!model || !model->type->particles || !spore_world_body_is_effect(world, body)) return false;
  size_t start = 0, end;
  while (start < all->count && all->body[start] != body) start++;
  end = start + spore_world_body_sphere_count(world, body);
  for (size_t s = 0; s < all->count; s++)
    for (size_t d = start; d < end && exercise->instrument_of[all->body[s]] == instrument; d++)
      if (spore_vec3_distance(spore_vec3_load(all->centre + 3 * s), spore_vec3_load(all->centre + 3 * d)) <
          DROP_REACH * (all->radius[s] + all->radius[d]))
        return true;
  return false;
}

static bool is_touched(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  if (instrument == SPORE_NO_PART) return false;
  for (size_t i = 0; i < spore_world_contact_count(world); i++) {
    SporeTouch touch = spore_world_contact(world, i);
    uint32_t other = touch.body_a == step->from.body ? touch.body_b : touch.body_a;
    bool is_of_body = touch.body_a == step->from.body || touch.body_b == step->from.body;
    if (is_of_body && touch.force > 0 && exercise->instrument_of[other] == instrument) return true;
  }
  return is_wetted(exercise, step->from.body, world, instrument);
}

static const SporeParameter touched_rows[] = {NAMED, TOOL(SPORE_INSTRUMENT_ELEMENTS), BODY,
                                              TIME(0, N_("How long it has to be touched without a break."))};
static const SporeEventKind touched = {.element = "touched",
                                       .label = N_("Touched"),
                                       .doc = N_("An instrument presses on a body."),
                                       .parameters = SPORE_TABLE(touched_rows, SporeEventFields),
                                       .needs_body = true,
                                       .happens = is_touched};

static bool is_grasped(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  return is_held(exercise, world, instrument, step->from.body);
}

static const SporeParameter grasped_rows[] = {NAMED, TOOL("grasper|clamp"), BODY, STAYS};
static const SporeEventKind grasped = {.element = "grasped",
                                       .label = N_("Grasped"),
                                       .doc = N_("Jaws hold a body."),
                                       .parameters = SPORE_TABLE(grasped_rows, SporeEventFields),
                                       .needs_body = true,
                                       .happens = is_grasped};

static const SporeParameter clamped_rows[] = {NAMED, TOOL("clamp"), BODY, STAYS};
static const SporeEventKind clamped = {.element = "clamped",
                                       .label = N_("Clamped"),
                                       .doc = N_("A clamp or a clip holds a body."),
                                       .parameters = SPORE_TABLE(clamped_rows, SporeEventFields),
                                       .needs_body = true,
                                       .happens = is_grasped};

static const SporeParameter held_rows[] = {NAMED, TOOL("grasper|clamp"), BODY,
                                           TIME(1, N_("How long it has to be held without a break.")), STAYS};
static const SporeEventKind held = {.element = "held",
                                    .label = N_("Held for a time"),
                                    .doc = N_("Jaws hold a body for a time."),
                                    .parameters = SPORE_TABLE(held_rows, SporeEventFields),
                                    .needs_body = true,
                                    .happens = is_grasped};

static bool is_lifted(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  SporeVec3 middle = spore_body_middle(world, step->from.body);
  if (!is_held(exercise, world, instrument, step->from.body)) {
    if (step->holder == instrument) step->holder = SPORE_NO_PART;
    return false;
  }
  if (step->holder == SPORE_NO_PART) step->holder = instrument, step->last = middle;
  return spore_vec3_dot(spore_vec3_sub(middle, step->last), exercise->up) >= step->from.fields.height;
}

static const SporeParameter lifted_rows[] = {
    NAMED, SPORE_ROW_REFERENCE(SporeEventFields, tool, tool, "grasper|clamp", N_("Instrument that lifts.")), BODY,
    SPORE_ROW_REAL(SporeEventFields, height, "m", 1e-6, 10, 0.01,
                   N_("How far its middle has to rise against gravity from where jaws took hold of it."))};
static const SporeEventKind lifted = {.element = "lifted",
                                      .label = N_("Lifted"),
                                      .doc = N_("Jaws hold a body and raise it."),
                                      .parameters = SPORE_TABLE(lifted_rows, SporeEventFields),
                                      .needs_body = true,
                                      .happens = is_lifted};

/* What tools do. A tool did it to the body where both counts grew in the same step of the world. */

/* Counts once a look, whichever of several tools it was. */
static bool add_amount(Exercise exercise, SporeStepRun *step, bool tool_did, uint64_t to_body) {
  if (tool_did && step->counted != exercise->looks) step->amount += to_body, step->counted = exercise->looks;
  return step->amount >= (uint64_t)step->from.fields.count;
}

static SporeToolState tool_state(Exercise exercise, const SporeWorld *world, uint32_t instrument) {
  uint32_t tool = instrument == SPORE_NO_PART ? SPORE_NO_PART : exercise->instruments[instrument].tool;
  return tool == SPORE_NO_PART ? (SporeToolState){0} : spore_world_tool_state(world, tool);
}

static bool is_coagulated(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  uint32_t body = step->from.body;
  return add_amount(exercise, step, tool_state(exercise, world, instrument).coagulated > 0,
                    spore_world_body_marks(world, body).coagulated - exercise->marks[body].coagulated);
}

static bool is_cut(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  uint32_t body = step->from.body;
  SporeToolState now = tool_state(exercise, world, instrument);
  return add_amount(exercise, step, now.cut > 0 && now.cut > exercise->before[instrument].cut,
                    spore_world_body_marks(world, body).cut - exercise->marks[body].cut);
}

static bool is_pierced(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  uint32_t body = step->from.body;
  SporeToolState now = tool_state(exercise, world, instrument);
  return add_amount(exercise, step, now.pierced > 0 && now.pierced > exercise->before[instrument].pierced,
                    spore_world_body_marks(world, body).pierced - exercise->marks[body].pierced);
}

static bool is_sucked(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  uint32_t body = step->from.body;
  SporeToolState now = tool_state(exercise, world, instrument);
  return add_amount(exercise, step, now.taken > 0 && now.taken > exercise->before[instrument].taken,
                    spore_world_body_marks(world, body).sucked - exercise->marks[body].sucked);
}

static const SporeParameter coagulated_rows[] = {
    NAMED, TOOL("bipolar"), BODY, COUNT(N_("Ties and elements that have to be heated, counted again in each step."))};
static const SporeEventKind coagulated = {.element = "coagulated",
                                          .label = N_("Coagulated"),
                                          .doc = N_("Bipolar forceps coagulate a body."),
                                          .parameters = SPORE_TABLE(coagulated_rows, SporeEventFields),
                                          .needs_body = true,
                                          .lasting = true,
                                          .happens = is_coagulated};

static const SporeParameter cut_rows[] = {NAMED, TOOL("scissors"), BODY, COUNT(N_("Ties that have to be cut."))};
static const SporeEventKind cut = {.element = "cut",
                                   .label = N_("Cut"),
                                   .doc = N_("Scissors cut a body."),
                                   .parameters = SPORE_TABLE(cut_rows, SporeEventFields),
                                   .needs_body = true,
                                   .lasting = true,
                                   .happens = is_cut};

static const SporeParameter pierced_rows[] = {NAMED, TOOL("needle"), BODY,
                                              COUNT(N_("Surfaces that have to be pierced."))};
static const SporeEventKind pierced = {.element = "pierced",
                                       .label = N_("Pierced"),
                                       .doc = N_("A needle goes through the surface of a body."),
                                       .parameters = SPORE_TABLE(pierced_rows, SporeEventFields),
                                       .needs_body = true,
                                       .lasting = true,
                                       .happens = is_pierced};

static const SporeParameter sucked_rows[] = {NAMED, TOOL("suction"), BODY,
                                             COUNT(N_("Particles that have to be taken away."))};
static const SporeEventKind sucked = {.element = "sucked",
                                      .label = N_("Sucked away"),
                                      .doc = N_("Suction takes particles of a fluid away."),
                                      .parameters = SPORE_TABLE(sucked_rows, SporeEventFields),
                                      .needs_body = true,
                                      .lasting = true,
                                      .happens = is_sucked};

/* Places. */

static SporeVec3 point_of(Exercise exercise, const SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  if (step->from.body != SPORE_NO_BODY) return spore_body_middle(world, step->from.body);
  assert(instrument != SPORE_NO_PART);
  return spore_instrument_point(exercise, world, instrument);
}

/* Whether the way of the last step crosses the ring, in its direction. */
static bool passes(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  const SporeEventFields *fields = &step->from.fields;
  SporeVec3 centre = spore_vec3_load(fields->point), now = point_of(exercise, step, world, instrument);
  SporeVec3 along = spore_vec3_normalise(spore_vec3_load(fields->direction), spore_vec3(1, 0, 0)), before = step->last;
  bool known = step->known;
  step->last = now, step->known = true;
  double from = spore_vec3_dot(spore_vec3_sub(before, centre), along);
  double to = spore_vec3_dot(spore_vec3_sub(now, centre), along);
  if (!known || !(from < 0 && to >= 0)) return false;
  SporeVec3 through = spore_vec3_add_scaled(before, -from / (to - from), spore_vec3_sub(now, before));
  return spore_vec3_distance(through, centre) <= fields->radius;
}

static const SporeParameter passed_rows[] = {
    NAMED,
    SPORE_ROW_REFERENCE(SporeEventFields, tool, tool, SPORE_INSTRUMENT_ELEMENTS,
                        N_("Instrument whose tip has to get there, where no body is named.")),
    BODY_OR_TOOL,
    SPORE_ROW_PLACE(SporeEventFields, point, N_("Middle of the ring.")),
    SPORE_ROW_DIRECTION(SporeEventFields, direction, 1, 0, 0, N_("Which way through the ring.")),
    SPORE_ROW_REAL(SporeEventFields, radius, "m", 1e-6, 10, 0.01, N_("Radius of the ring."))};
static const SporeEventKind passed = {.element = "passed_through",
                                      .label = N_("Passed through"),
                                      .doc = N_("A body or an instrument passes through a ring."),
                                      .parameters = SPORE_TABLE(passed_rows, SporeEventFields),
                                      .happens = passes};

static bool is_reached(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  SporeVec3 point = point_of(exercise, step, world, instrument);
  return spore_vec3_distance(point, spore_vec3_load(step->from.fields.point)) <= step->from.fields.radius;
}

static const SporeParameter reached_rows[] = {
    NAMED,
    SPORE_ROW_REFERENCE(SporeEventFields, tool, tool, SPORE_INSTRUMENT_ELEMENTS,
                        N_("Instrument whose tip has to get there, where no body is named.")),
    BODY_OR_TOOL,
    SPORE_ROW_PLACE(SporeEventFields, point, N_("Place to reach.")),
    SPORE_ROW_REAL(SporeEventFields, radius, "m", 1e-6, 10, 0.01, N_("How near it has to come.")),
    TIME(0, N_("How long it has to stay there without a break."))};
static const SporeEventKind reached = {.element = "reached",
                                       .label = N_("Reached"),
                                       .doc = N_("A body or an instrument reaches a place."),
                                       .parameters = SPORE_TABLE(reached_rows, SporeEventFields),
                                       .happens = is_reached};

static bool is_bagged(Exercise exercise, SporeStepRun *step, const SporeWorld *world, uint32_t instrument) {
  (void)exercise, (void)instrument;
  return spore_share_within(world, step->from.body, step->from.container) >= step->from.fields.share;
}

static const SporeParameter bagged_rows[] = {
    NAMED, BODY, SPORE_ROW_BODY(SporeEventFields, container, container, N_("The bag or dish.")),
    SPORE_ROW_REAL(SporeEventFields, share, "", 0.01, 1, 0.9,
                   N_("Part of the body's nodes that have to lie within the hull of 26 sides around the bag.")),
    TIME(0, N_("How long it has to stay there without a break."))};
static const SporeEventKind bagged = {.element = "bagged",
                                      .label = N_("Put into the bag"),
                                      .doc = N_("A body is put into a bag or a dish."),
                                      .parameters = SPORE_TABLE(bagged_rows, SporeEventFields),
                                      .needs_body = true,
                                      .happens = is_bagged};

const SporeEventKind *const spore_event_kinds[] = {&touched, &grasped, &lifted,  &clamped, &coagulated, &cut, &pierced,
                                                   &sucked,  &passed,  &reached, &held,    &bagged,     NULL};

const SporeEventKind *spore_event_kind_find(const char *element) {
  assert(element);
  const SporeEventKind *const *kind = spore_event_kinds;
  while (*kind && strcmp((*kind)->element, element)) kind++;
  return *kind;
}

/* Whether a name is among those that bars join. */
static bool is_listed(const char *names, const char *name) {
  size_t length = strlen(name);
  for (const char *at = names; *at;) {
    size_t end = strcspn(at, "|");
    if (end == length && memcmp(at, name, length) == 0) return true;
    at += end + (at[end] == '|');
  }
  return false;
}

bool spore_event_kind_allows(const SporeEventKind *kind, const char *tool) {
  int index = spore_parameter_find(&kind->parameters, "tool");
  return index >= 0 && is_listed(kind->parameters.parameters[index].references, tool);
}
