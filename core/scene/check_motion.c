/* Checks of the start: overlaps of bodies, bodies that would fall, and what the compiled simulation reports. */
#include <glib/gi18n.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/scene/check_private.h"
#include "core/scene/compile.h"
#include "core/scene/fidelity.h"
#include "core/scene/schema_fields.h"
#include "core/scene/work_estimate.h"
#include "core/sim/solve/method_trial.h"

#define NOTED_OVERLAP 0.1 /* of the smaller radius: touching bodies overlap by less */
#define WARNED_OVERLAP 0.5
/* Of the speed that a contact stops: what the author gave it, and what it falls at, or jostles at as a fluid. */
#define NOTED_SPEED 0.1
#define NOTED_FALL 0.5

/* A sphere where it stands at the start. */
typedef struct Ball {
  SporeVec3 centre;
  double radius;
  guint body;
} Ball;

/* The deepest overlap of a body with an earlier body. */
typedef struct Overlap {
  guint other;
  double depth, share; /* m; of the smaller radius */
} Overlap;

/* The bodies at the start. */
typedef struct Start {
  SporeCheck *check;
  GPtrArray *bodies; /* SporeObject * */
  GArray *roles;     /* SporeRole, of the bodies */
  GArray *groups;    /* gint64, of the bodies */
  GArray *absent;    /* gboolean, of the bodies: of particles that emitters keep back, all of them */
  GArray *balls;     /* of Ball, along x */
  SporeVec3 gravity; /* m/s^2 */
  double *drops;     /* m, of the bodies: how far each falls; HUGE_VAL: for ever; 0: not, or it lies on something */
} Start;

static SporeRole role_of(const Start *start, guint body) { return g_array_index(start->roles, SporeRole, body); }

static gboolean may_touch(const Start *start, guint a, guint b) {
  gint64 group = g_array_index(start->groups, gint64, a);
  return a != b && (group == 0 || group != g_array_index(start->groups, gint64, b));
}

static const SporeModelParticles *particles_of(const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body);
  return model ? spore_object_type(model)->model->particles : NULL;
}

/* Adds the collision spheres of a body's model that are in the world. Only the world knows their places. */
static void place_own_spheres(Start *start, SporeObject *body, guint index, const SporeSimulation *simulation) {
  const SporeSpheres *spheres = spore_world_spheres(simulation->world);
  guint32 owner = spore_simulation_body_of(simulation, body);
  for (size_t i = 0; i < spheres->count; i++) {
    const double *centre = spheres->centre + 3 * i;
    if (spheres->body[i] != owner || (particles_of(body) && spore_particle_is_out(centre))) continue;
    Ball ball = {spore_vec3_load(centre), spheres->radius[i], index};
    g_array_append_val(start->balls, ball);
  }
}

static gboolean is_absent(SporeObject *body, const SporeSimulation *simulation) {
  guint32 index = simulation && particles_of(body) ? spore_simulation_body_of(simulation, body) : SPORE_NO_BODY;
  return index != SPORE_NO_BODY && spore_world_body_model(simulation->world, index) &&
         spore_world_particle_count(simulation->world, index) == 0;
}

/* simulation: NULL where the scene cannot be compiled. */
static void place_body(Start *start, SporeObject *body, const SporeSimulation *simulation) {
  guint index = start->bodies->len;
  g_ptr_array_add(start->bodies, body);
  const SporeObject *collision = spore_object_child_of(body, "collision");
  SporeObject *asset = collision ? spore_object_reference(collision, "spheres") : NULL;
  const SporeSphereSet *set = asset ? spore_document_spheres(start->check->document, asset, NULL) : NULL;
  SporeBodyFields fields;
  spore_object_fields(body, &fields);
  SporeRole role = (SporeRole)fields.role;
  SporeCollisionFields touch = {0};
  if (collision) spore_object_fields(collision, &touch);
  g_array_append_val(start->roles, role);
  g_array_append_val(start->groups, touch.contact.group);
  gboolean absent = is_absent(body, simulation);
  g_array_append_val(start->absent, absent);
  if (simulation && spore_body_has_own_spheres(body)) place_own_spheres(start, body, index, simulation);
  SporePose pose = spore_body_pose(body);
  g_autofree double *radius = set ? g_new(double, set->count) : NULL;
  if (set) spore_spheres_radii(set, radius, 1);
  for (size_t i = 0; set && i < set->count; i++) {
    Ball ball = {spore_pose_apply(pose, spore_vec3_load(&set->spheres[4 * i])), radius[i], index};
    g_array_append_val(start->balls, ball);
  }
}

static gint by_left_end(gconstpointer a, gconstpointer b) {
  const Ball *one = a, *other = b;
  double difference = (one->centre.x - one->radius) - (other->centre.x - other->radius);
  return (difference > 0) - (difference < 0);
}

/* Overlaps. */

static void meet(const Start *start, const Ball *a, const Ball *b, Overlap *overlaps) {
  if (!may_touch(start, a->body, b->body)) return;
  if (role_of(start, a->body) != SPORE_PASSIVE && role_of(start, b->body) != SPORE_PASSIVE) return;
  double depth = a->radius + b->radius - spore_vec3_distance(a->centre, b->centre);
  Overlap *overlap = &overlaps[MAX(a->body, b->body)];
  if (depth <= overlap->depth) return;
  *overlap = (Overlap){MIN(a->body, b->body), depth, depth / fmin(a->radius, b->radius)};
}

/* Sweeps along x: only pairs of balls whose intervals on the x axis overlap are compared. */
static void find_overlaps(const Start *start, Overlap *overlaps) {
  for (guint i = 0; i < start->balls->len; i++) {
    const Ball *a = &g_array_index(start->balls, Ball, i);
    for (guint j = i + 1; j < start->balls->len; j++) {
      const Ball *b = &g_array_index(start->balls, Ball, j);
      if (b->centre.x - b->radius >= a->centre.x + a->radius) break;
      meet(start, a, b, overlaps);
    }
  }
}

static void check_overlaps(const Start *start) {
  g_autofree Overlap *overlaps = g_new0(Overlap, MAX(start->bodies->len, 1));
  find_overlaps(start, overlaps);
  for (guint i = 0; i < start->bodies->len; i++) {
    const Overlap *overlap = &overlaps[i];
    if (overlap->share < NOTED_OVERLAP) continue;
    const SporeObject *body = start->bodies->pdata[i], *other = start->bodies->pdata[overlap->other];
    spore_check_say(start->check, overlap->share < WARNED_OVERLAP ? SPORE_NOTE : SPORE_WARNING, body,
                    _("move them apart, or generate spheres that fit more closely"),
                    _("\"%s\" and \"%s\" overlap by %.3g mm at the start: the contact pushes them apart"),
                    spore_object_name(body), spore_object_name(other), overlap->depth * 1e3);
  }
}

/* Loose bodies. */

/* How far the ball falls along the unit vector `down` until it meets the ball `under`, m; HUGE_VAL: it does not. */
static double drop_to(const Start *start, const Ball *falling, const Ball *under, SporeVec3 down) {
  if (!may_touch(start, under->body, falling->body)) return HUGE_VAL;
  SporeVec3 apart = spore_vec3_sub(under->centre, falling->centre);
  double along = spore_vec3_dot(apart, down), reach = under->radius + falling->radius;
  double beside = spore_vec3_length(spore_vec3_add_scaled(apart, -along, down));
  if (!(along > -reach && beside < reach)) return HUGE_VAL;
  return fmax(along - sqrt(reach * reach - beside * beside), 0);
}

/* Air holds smoke up. */
static gboolean is_smoke(const SporeObject *body) {
  const SporeModelParticles *particles = particles_of(body);
  return particles && particles->puff;
}

/* Whether an effect moves the body that does not fall; drops do. */
static gboolean is_effect(const Start *start, const SporeObject *body) {
  return !particles_of(body) && spore_fidelity_is_effect(start->check->document, body);
}

/* Whether the body falls: physics moves it, and no link holds it. */
static gboolean is_loose(const Start *start, guint body) {
  const SporeObject *object = start->bodies->pdata[body];
  return role_of(start, body) == SPORE_PASSIVE && !g_array_index(start->absent, gboolean, body) && !is_smoke(object) &&
         !is_effect(start, object) && !spore_check_is_used(start->check, object, SPORE_HOLDING);
}

/* Whether what falls on the body may come to lie there. */
static gboolean may_carry(const Start *start, guint body) {
  return !is_loose(start, body) && !is_smoke(start->bodies->pdata[body]);
}

/* How far the body falls until it meets another, m; HUGE_VAL: nothing that could carry it lies under it. */
static double drop_of(const Start *start, guint body, SporeVec3 down) {
  double drop = HUGE_VAL;
  gboolean carried = FALSE;
  for (guint i = 0; i < start->balls->len && !(carried && drop <= 0); i++) {
    const Ball *falling = &g_array_index(start->balls, Ball, i);
    if (falling->body != body) continue;
    for (guint j = 0; j < start->balls->len; j++) {
      const Ball *under = &g_array_index(start->balls, Ball, j);
      double way = drop_to(start, falling, under, down);
      carried = carried || (isfinite(way) && may_carry(start, under->body));
      drop = fmin(drop, way);
    }
  }
  return carried ? drop : HUGE_VAL;
}

static void find_drops(Start *start) {
  SporeEnvironmentFields environment;
  spore_object_fields(spore_document_section(start->check->document, "environment"), &environment);
  start->gravity = spore_vec3_load(environment.gravity);
  start->drops = g_new0(double, MAX(start->bodies->len, 1));
  if (spore_vec3_length(start->gravity) == 0) return;
  SporeVec3 down = spore_vec3_normalise(start->gravity, start->gravity);
  for (guint i = 0; i < start->bodies->len; i++)
    if (is_loose(start, i)) start->drops[i] = drop_of(start, i, down);
}

static void check_loose(const Start *start) {
  for (guint i = 0; i < start->bodies->len; i++) {
    const SporeObject *body = start->bodies->pdata[i];
    if (isfinite(start->drops[i])) continue;
    spore_check_say(start->check, SPORE_NOTE, body,
                    _("pin it, tie it with a spring, or put an unmovable body under it"),
                    _("\"%s\" is held by nothing, and nothing that could carry it lies under it: it falls"),
                    spore_object_name(body));
    if (!particles_of(body)) spore_check_offer(start->check, SPORE_FIX_HOLD);
  }
}

/* Says how fast bodies may come for contacts to stop them, where they come nearly as fast, or faster. */
static void check_impacts(const Start *start, const SporeSimulation *simulation) {
  for (guint i = 0; i < start->bodies->len; i++) {
    SporeObject *body = start->bodies->pdata[i];
    guint32 index = spore_simulation_body_of(simulation, body);
    SporeStoppingSpeed stopping;
    if (index == SPORE_NO_BODY || !spore_world_stopping_speed(simulation->world, index, &stopping)) continue;
    double fall = isfinite(start->drops[i]) ? 2 * spore_vec3_length(start->gravity) * start->drops[i] : 0;
    double comes = sqrt(stopping.moves * stopping.moves + fall);
    double noted = particles_of(body) ? NOTED_FALL : NOTED_SPEED;
    if (stopping.moves <= noted * stopping.stops && comes <= NOTED_FALL * stopping.stops) continue;
    const char *other = spore_world_body_name(simulation->world, stopping.other);
    double factor = pow(comes / stopping.stops, 2); /* not finite where contacts have no stiffness */
    g_autofree char *stiffer =
        isfinite(factor) ? g_strdup_printf(_("make contacts %.3g times as stiff, or let it come more slowly"), factor)
                         : g_strdup(_("give contacts a stiffness, or let it come more slowly"));
    gboolean stops = comes <= stopping.stops;
    spore_check_say(
        start->check, stops ? SPORE_NOTE : SPORE_WARNING, body, stops ? _("make contacts stiffer for more") : stiffer,
        _("\"%s\" comes at up to %.3g m/s, and a single contact, as with \"%s\", stops it up to %.3g m/s: r sqrt(k/m) "
          "of its sphere, more with damping or where several touch at once"),
        spore_object_name(body), comes, other, stopping.stops);
  }
}

/* Warns of a contact margin greater than the body's smallest sphere. Neighbouring spheres are then within the margin
 * from the start: such a pair is tested in each step, and may never be seen approaching. */
static void check_margin(const Start *start, guint body) {
  const SporeObject *collision = spore_object_child_of(start->bodies->pdata[body], "collision");
  double margin = collision ? spore_object_number(collision, "margin") : 0, least = HUGE_VAL;
  for (guint i = 0; i < start->balls->len; i++) {
    const Ball *ball = &g_array_index(start->balls, Ball, i);
    if (ball->body == body) least = fmin(least, ball->radius);
  }
  if (!(margin > least)) return;
  spore_check_say(
      start->check, SPORE_WARNING, collision, _("take about a quarter of that radius"),
      _("the margin of \"%s\" is %.3g m, more than the radius of its smallest sphere, %.3g m: of a sphere no more "
        "than its radius counts, pairs that far apart cost as much as contacts, and neighbours that near never meet"),
      spore_object_name(start->bodies->pdata[body]), margin, least);
  char value[G_ASCII_DTOSTR_BUF_SIZE];
  spore_check_offer_set(start->check, collision, "margin", g_ascii_formatd(value, sizeof value, "%.2g", least / 4));
}

/* Reports what each model says that it computes badly. */
static void check_doubts(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    guint32 index = spore_simulation_body_of(simulation, body);
    const SporeModel *model = index == SPORE_NO_BODY ? NULL : spore_world_body_model(simulation->world, index);
    const char *doubt = model && model->type->doubt ? model->type->doubt(model) : NULL;
    if (!doubt) continue;
    g_autoptr(GError) error = NULL;
    spore_error_raise(&error, SPORE_ERROR_INPUT, NULL, "%s", doubt);
    spore_check_say_error(check, SPORE_WARNING, spore_object_child(spore_object_child_of(body, "mechanical"), 0),
                          error);
  }
}

typedef struct SayWork {
  SporeCheck *check;
  const SporeObject *body;
} SayWork;

static void say_work(gpointer data, const char *sentence, const char *remedy) {
  const SayWork *to = data;
  spore_check_say(to->check, SPORE_WARNING, to->body, remedy, "%s", sentence);
}

/* Warns of what takes long to make or to run. */
static void check_work(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    guint32 index = spore_simulation_body_of(simulation, body);
    if (index == SPORE_NO_BODY) continue;
    SayWork to = {check, body};
    spore_body_say_work(simulation->world, index, say_work, &to);
  }
}

/* The passive body that a fault of compiling is about; NULL: it is about something else. */
static SporeObject *body_of_fault(SporeDocument *document, const GError *fault) {
  const SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    g_autofree char *where = spore_object_where(body), *place = g_strdup_printf("%s: ", where);
    if (g_str_has_prefix(fault->message, place) && spore_object_child_of(body, "mechanical")) return body;
  }
  return NULL;
}

/* The body's method by its name. */
static SporeIntegratorKind integrator_of(const SporeWorld *world, guint32 body) {
  SporeMethod method;
  int kind = 0;
  if (!spore_world_body_method(world, body, &method)) return SPORE_INTEGRATOR_DEFAULT;
  while (kind < SPORE_INTEGRATOR_COUNT && !g_str_equal(spore_integrator_names[kind], method.integrator.name)) kind++;
  return (SporeIntegratorKind)kind;
}

/* Substeps of which each is as short as the body's method bears; 0: another number does not help. Asks a copy of the
 * scene in which the body has the most substeps there may be. */
static guint64 substeps_needed(SporeCheck *check, guint32 id) {
  SporeDocument *copy = spore_document_copy(check->document);
  SporeObject *body = spore_document_by_id(copy, id), *mechanical = spore_object_child_of(body, "mechanical");
  g_autofree char *most = g_strdup_printf("%d", SPORE_SUBSTEPS_MAXIMUM);
  double step_s = spore_object_number(spore_document_section(copy, "solver"), "time_step"), needed = 0;
  SporeSimulation *simulation = spore_document_set_text(copy, mechanical, "substeps", most, NULL)
                                    ? spore_simulation_new(copy, NULL, NULL, check->cancel, NULL)
                                    : NULL;
  guint32 index = simulation ? spore_simulation_body_of(simulation, body) : SPORE_NO_BODY;
  SporeStepLimit limit;
  if (index != SPORE_NO_BODY &&
      spore_world_predict_step(simulation->world, index, integrator_of(simulation->world, index), &limit, NULL) &&
      limit.dt_s > 0)
    needed = ceil(step_s / limit.dt_s);
  spore_simulation_free(simulation);
  spore_document_free(copy);
  return needed > 1 && needed <= SPORE_SUBSTEPS_MAXIMUM ? (guint64)needed : 0;
}

/* Where the step is too long for a body, more substeps are what can be done without asking. */
static void offer_substeps(SporeCheck *check, const GError *fault) {
  SporeObject *body = body_of_fault(check->document, fault);
  guint64 needed = body ? substeps_needed(check, spore_object_id(body)) : 0;
  g_autofree char *text = g_strdup_printf("%" G_GUINT64_FORMAT, needed);
  if (needed > 0) spore_check_offer_set(check, spore_object_child_of(body, "mechanical"), "substeps", text);
}

/* Checks what shows only when the scene is compiled: models that refuse their geometry, pins that hold nothing, a time
 * step too large for the stiffness. */
static SporeSimulation *check_compiled(SporeCheck *check) {
  g_autoptr(GError) error = NULL;
  SporeSimulation *simulation = spore_simulation_new(check->document, NULL, NULL, check->cancel, &error);
  if (simulation || spore_cancel_asked(check->cancel)) return simulation;
  spore_check_say_error(check, SPORE_FAULT, NULL, error);
  if (g_error_matches(error, SPORE_ERROR, SPORE_ERROR_INPUT)) offer_substeps(check, error);
  return NULL;
}

void spore_check_motion(SporeCheck *check) {
  Start start = {.check = check,
                 .bodies = g_ptr_array_new(),
                 .roles = g_array_new(FALSE, FALSE, sizeof(SporeRole)),
                 .groups = g_array_new(FALSE, FALSE, sizeof(gint64)),
                 .absent = g_array_new(FALSE, FALSE, sizeof(gboolean)),
                 .balls = g_array_new(FALSE, FALSE, sizeof(Ball))};
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  SporeSimulation *simulation = check->faults == 0 ? check_compiled(check) : NULL;
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    place_body(&start, spore_object_child(bodies, i), simulation);
  if (simulation) spore_check_mapping(check, simulation);
  if (simulation) check_doubts(check, simulation);
  if (simulation) check_work(check, simulation);
  if (simulation) spore_check_link_points(check, simulation);
  if (simulation) spore_check_pins(check, simulation);
  if (simulation) spore_check_levels(check, simulation);
  if (simulation) spore_check_poses(check, simulation);
  find_drops(&start);
  if (simulation) check_impacts(&start, simulation);
  spore_simulation_free(simulation);
  g_array_sort(start.balls, by_left_end);
  check_overlaps(&start);
  for (guint i = 0; i < start.bodies->len; i++) check_margin(&start, i);
  check_loose(&start);
  g_free(start.drops);
  g_ptr_array_unref(start.bodies);
  g_array_unref(start.roles);
  g_array_unref(start.groups);
  g_array_unref(start.absent);
  g_array_unref(start.balls);
}
