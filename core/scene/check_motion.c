#include <glib/gi18n.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core/scene/check_private.h"
#include "core/scene/compile.h"
#include "core/scene/schema_fields.h"
#include "core/sim/step_limit.h"

#define NOTED_OVERLAP 0.1 /* of the smaller radius: less is how things touch */
#define WARNED_OVERLAP 0.5

/* A sphere where it stands at the start. */
typedef struct Ball {
  SporeVec3 centre;
  double radius;
  guint body;
} Ball;

/* The deepest overlap of a body with one before it. */
typedef struct Overlap {
  guint other;
  double depth, share; /* m; of the smaller radius */
} Overlap;

/* The bodies at the start. */
typedef struct Start {
  SporeCheck *check;
  GPtrArray *bodies; /* SporeObject * */
  GArray *balls;     /* of Ball, along x */
} Start;

static SporeRole role_of(const SporeObject *body) { return (SporeRole)spore_object_number(body, "role"); }

static void place_body(Start *start, SporeObject *body) {
  guint index = start->bodies->len;
  g_ptr_array_add(start->bodies, body);
  const SporeObject *collision = spore_object_child_of(body, "collision");
  SporeObject *asset = collision ? spore_object_reference(collision, "spheres") : NULL;
  const SporeSphereSet *set = asset ? spore_document_spheres(start->check->document, asset, NULL) : NULL;
  SporeBodyFields fields;
  spore_object_fields(body, &fields);
  SporePose pose = {spore_vec3_load(fields.position),
                    spore_quat_from_rotation_vector(spore_vec3_load(fields.rotation))};
  for (size_t i = 0; set && i < set->count; i++) {
    Ball ball = {spore_pose_apply(pose, spore_vec3_load(&set->spheres[4 * i])), set->spheres[4 * i + 3], index};
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
  if (a->body == b->body) return;
  if (role_of(start->bodies->pdata[a->body]) != SPORE_PASSIVE &&
      role_of(start->bodies->pdata[b->body]) != SPORE_PASSIVE)
    return;
  double depth = a->radius + b->radius - spore_vec3_distance(a->centre, b->centre);
  Overlap *overlap = &overlaps[MAX(a->body, b->body)];
  if (depth <= overlap->depth) return;
  *overlap = (Overlap){MIN(a->body, b->body), depth, depth / fmin(a->radius, b->radius)};
}

/* Sweeps along x: only balls whose intervals there overlap are looked at. */
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

/* Whether a ball of another body that does not fall lies in the way of this one's fall along unit vector `down`. */
static gboolean catches(const Start *start, const Ball *falling, const Ball *under, SporeVec3 down) {
  if (under->body == falling->body || role_of(start->bodies->pdata[under->body]) != SPORE_UNMOVABLE) return FALSE;
  SporeVec3 apart = spore_vec3_sub(under->centre, falling->centre);
  double along = spore_vec3_dot(apart, down), reach = under->radius + falling->radius;
  return along > -reach && spore_vec3_length(spore_vec3_add_scaled(apart, -along, down)) < reach;
}

static gboolean has_support(const Start *start, guint body, SporeVec3 down) {
  for (guint i = 0; i < start->balls->len; i++) {
    const Ball *falling = &g_array_index(start->balls, Ball, i);
    if (falling->body != body) continue;
    for (guint j = 0; j < start->balls->len; j++)
      if (catches(start, falling, &g_array_index(start->balls, Ball, j), down)) return TRUE;
  }
  return FALSE;
}

static void check_loose(const Start *start) {
  SporeEnvironmentFields environment;
  SporeDocument *document = start->check->document;
  spore_object_fields(spore_document_section(document, "environment"), &environment);
  SporeVec3 gravity = spore_vec3_load(environment.gravity);
  if (spore_vec3_length(gravity) == 0) return;
  SporeVec3 down = spore_vec3_normalise(gravity, gravity);
  for (guint i = 0; i < start->bodies->len; i++) {
    const SporeObject *body = start->bodies->pdata[i];
    if (role_of(body) != SPORE_PASSIVE || spore_check_is_used(start->check, body, "pin|spring") ||
        has_support(start, i, down))
      continue;
    spore_check_say(
        start->check, SPORE_NOTE, body, _("pin it, tie it with a spring, or put an unmovable body under it"),
        _("\"%s\" is held by nothing, and nothing unmovable lies under it: it falls"), spore_object_name(body));
  }
}

/* The time step. */

static gboolean is_explicit(const SporeObject *body, const SporeSolverFields *solver) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  int integrator = mechanical ? (int)spore_object_number(mechanical, "integrator") - 1 : SPORE_INTEGRATOR_DEFAULT;
  if (integrator == SPORE_INTEGRATOR_DEFAULT) integrator = solver->integrator;
  return integrator == SPORE_INTEGRATOR_SYMPLECTIC_EULER;
}

static void check_step(SporeCheck *check, const SporeSimulation *simulation, guint32 index,
                       const SporeSolverFields *solver) {
  const SporeModel *model = spore_world_body_model(simulation->world, index);
  SporeObject *body = spore_document_by_id(check->document, simulation->body_object[index]);
  if (!model || !model->type->jacobian || !is_explicit(body, solver)) return;
  SporeStepLimit limit;
  SporeError fault = SPORE_ERROR_INIT;
  if (!spore_step_limit(model, spore_world_q(simulation->world, index), spore_world_v(simulation->world, index), NULL,
                        0, &limit, &fault))
    return;
  if (solver->time_step <= limit.dt_s) return;
  g_autofree char *remedy =
      g_strdup_printf(_("make the solver's time_step at most %.2g s, or its integrator implicit_euler"), limit.dt_s);
  spore_check_say(
      check, SPORE_WARNING, body, remedy,
      _("the time step of %g s is too large for the stiffness of \"%s\": symplectic_euler is stable up to %.3g s"),
      solver->time_step, spore_object_name(body), limit.dt_s);
}

/* What only shows when the scene is put together. */
static void check_compiled(SporeCheck *check) {
  GError *error = NULL;
  SporeSimulation *simulation = spore_simulation_new(check->document, NULL, NULL, &error);
  if (!simulation) {
    spore_check_say_error(check, SPORE_FAULT, NULL, error);
    g_error_free(error);
    return;
  }
  SporeSolverFields solver;
  spore_object_fields(spore_document_section(check->document, "solver"), &solver);
  for (guint32 i = 0; i < spore_world_body_count(simulation->world); i++) check_step(check, simulation, i, &solver);
  spore_simulation_free(simulation);
}

void spore_check_motion(SporeCheck *check) {
  Start start = {check, g_ptr_array_new(), g_array_new(FALSE, FALSE, sizeof(Ball))};
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) place_body(&start, spore_object_child(bodies, i));
  g_array_sort(start.balls, by_left_end);
  check_overlaps(&start);
  check_loose(&start);
  if (check->faults == 0) check_compiled(check);
  g_ptr_array_unref(start.bodies);
  g_array_unref(start.balls);
}
