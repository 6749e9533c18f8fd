/* A curved needle with its thread.
 *
 * The needle has no spheres that touch. Its tip meets tissue where it crosses a surface. The crossed place of the
 * tissue is held at the tip, and the tip presses on it. The tip pierces when it presses with the piercing force, or has
 * pushed the surface by the piercing depth. From then on that place of the tissue slides along the needle, and behind
 * the swage along the thread: a spring along a curve joint (core/constraint/curve_joint.c), with friction. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define BEHIND 0.05 /* of the needle's length, behind its tip: where the search for a crossed surface begins */

#define SPANS 24 /* of the path along the needle */

/* State of a stitch: its place of tissue moves from the tip along the needle onto the thread. */
typedef enum SporeStitchState {
  SPORE_STITCH_FREE,
  SPORE_STITCH_PRESSED, /* the tip presses on it */
  SPORE_STITCH_ON_NEEDLE,
  SPORE_STITCH_ON_THREAD
} SporeStitchState;

typedef struct SporeStitch {
  SporeStitchState state;
  uint32_t body;
  SporeVec3 touched; /* where the tip first pressed; world, m */
  SporeCurveJoint needle, thread;
} SporeStitch;

/* Surface of a body that can be pierced: triangles of its nodes. */
typedef struct SporeSkin {
  uint32_t body;
  size_t count;
  uint32_t *triangles;
} SporeSkin;

/* The springs of a needle are: one for the thread's end at the swage, then two for each stitch, along the needle and
 * along the thread. */
typedef struct SporeNeedle {
  SporeTool tool;
  SporeNeedleFields fields;
  double path[3 * (SPANS + 3)]; /* in the body's frame, from the tip to the swage, m */
  double length;                /* m */
  uint32_t thread;              /* SPORE_NO_BODY: none */
  bool from_end;                /* the thread's last point is at the swage, not its first */
  size_t skin_count;
  SporeSkin *skins;
  SporeStitch *stitches; /* fields.stitches */
  size_t pierced;        /* so far */
} SporeNeedle;

static size_t spring_count(const void *fields) { return 1 + 2 * (size_t)((const SporeNeedleFields *)fields)->stitches; }

static const SporeModel *thread_model(const SporeWorld *world, uint32_t thread) {
  const SporeModel *model = thread < world->body_count ? world->bodies[thread].model : NULL;
  return model && model->type->line ? model : NULL;
}

/* Present knots of the thread; none: the needle has no thread. */
static SporeSplineKnots thread_knots(const SporeWorld *world, const SporeNeedle *needle) {
  const SporeModel *model = thread_model(world, needle->thread);
  return model ? model->type->line->path(model) : (SporeSplineKnots){0};
}

/* The end of the thread nearest to the swage, as a control point; *off: its distance, in lengths of the thread. */
static size_t thread_end(const SporeWorld *world, const SporeToolDescription *from, double *off) {
  assert(from->bodies[SPORE_TOOL_THREAD] < world->body_count);
  SporeVec3 swage = spore_vec3_load(((const SporeNeedleFields *)from->fields)->swage);
  const SporeModel *model = thread_model(world, from->bodies[SPORE_TOOL_THREAD]);
  const double *q = world->state.rest_q + world->bodies[from->bodies[SPORE_TOOL_THREAD]].q_offset;
  SporeSplineKnots knots = model->type->line->path(model);
  size_t last = knots.span_count + 2;
  double first_off = spore_vec3_distance(spore_vec3_load(q), swage);
  double last_off = spore_vec3_distance(spore_vec3_load(q + 3 * last), swage);
  *off = fmin(first_off, last_off) / spore_path_length(knots, q, 0, spore_spline_end(knots));
  return last_off < first_off ? last : 0;
}

static const char *fault(const SporeWorld *world, const SporeToolDescription *from) {
  const SporeNeedleFields *fields = from->fields;
  SporeVec3 tip = spore_vec3_load(fields->tip), middle = spore_vec3_load(fields->middle);
  SporeVec3 swage = spore_vec3_load(fields->swage);
  double off;
  const double *points[] = {fields->tip, fields->middle, fields->swage};
  for (size_t i = 0; i < 3; i++) {
    const char *fault = spore_tool_point_fault(points[i]);
    if (fault) return fault;
  }
  SporeVec3 a = spore_vec3_sub(middle, tip), b = spore_vec3_sub(swage, middle);
  if (!(spore_vec3_length(a) > 0) || !(spore_vec3_length(b) > 0) ||
      spore_vec3_length(spore_vec3_add(a, b)) < 1e-3 * (spore_vec3_length(a) + spore_vec3_length(b)))
    return _("tip, middle and swage of the needle do not lie along an arc; expected three points apart; set them");
  if (from->bodies[SPORE_TOOL_THREAD] == SPORE_NO_BODY) return NULL;
  if (!thread_model(world, from->bodies[SPORE_TOOL_THREAD]))
    return _("the needle's thread is no thread; expected a body along a curve, such as spline_1d; choose one");
  thread_end(world, from, &off);
  if (off > 0.01)
    return _("no end of the thread lies at the needle's swage; expected one within a hundredth of its length; move the "
             "thread or the swage");
  return NULL;
}

/* Point on the circle (or line) through three points, at this share of the way from a to c. */
static SporeVec3 arc_at(SporeVec3 a, SporeVec3 b, SporeVec3 c, double share) {
  assert(share >= 0 && share <= 1);
  SporeVec3 u = spore_vec3_sub(b, a), w = spore_vec3_sub(c, a), n = spore_vec3_cross(u, w);
  double square = spore_vec3_dot(n, n), uu = spore_vec3_dot(u, u), ww = spore_vec3_dot(w, w);
  if (square < 1e-8 * uu * ww) return spore_vec3_add_scaled(a, share, w);
  SporeVec3 to_centre = spore_vec3_scale(ww, spore_vec3_cross(n, u));
  to_centre = spore_vec3_scale(0.5 / square, spore_vec3_add_scaled(to_centre, -uu, spore_vec3_cross(n, w)));
  SporeVec3 centre = spore_vec3_add(a, to_centre), axis = spore_vec3_normalise(n, (SporeVec3){0, 0, 1});
  SporeVec3 from = spore_vec3_sub(a, centre), to = spore_vec3_sub(c, centre);
  double angle = atan2(spore_vec3_dot(axis, spore_vec3_cross(from, to)), spore_vec3_dot(from, to));
  if (angle < 0) angle += 2 * M_PI;
  SporeQuat turn = spore_quat_from_rotation_vector(spore_vec3_scale(share * angle, axis));
  return spore_vec3_add(centre, spore_quat_rotate(turn, from));
}

/* Control points lie on the arc, each at the mean of its knots. The path is off the arc by the square of a span's
 * length, times the curvature, over 6. */
static void make_path(const SporeWorld *world, SporeNeedle *needle) {
  SporeVec3 tip = needle->tool.tip =
      spore_world_to_frame(world, needle->tool.bodies[0], spore_vec3_load(needle->fields.tip));
  SporeVec3 middle = spore_world_to_frame(world, needle->tool.bodies[0], spore_vec3_load(needle->fields.middle));
  SporeVec3 swage = spore_world_to_frame(world, needle->tool.bodies[0], spore_vec3_load(needle->fields.swage));
  for (int i = 0; i < SPANS + 3; i++) {
    double mean = 0;
    for (int k = 1; k <= 3; k++) mean += fmin(fmax(i + k - 3, 0), SPANS) / (3.0 * SPANS);
    spore_vec3_store(needle->path + 3 * i, arc_at(tip, middle, swage, mean));
  }
  needle->length = spore_path_length(spore_spline_uniform(SPANS), needle->path, 0, SPANS);
}

/* Ties the end of the thread to the swage. */
static bool tie_thread(SporeWorld *world, SporeNeedle *needle, const SporeToolDescription *from) {
  assert(needle->thread < world->body_count);
  SporeSpringTerm *term = &world->links.springs[needle->tool.spring_start];
  SporeMapping *mapping = &world->links.mappings[2 * needle->tool.spring_start];
  const SporeBody *body = &world->bodies[needle->thread];
  double off, swage[3];
  size_t end = thread_end(world, from, &off);
  needle->from_end = end > 0;
  spore_vec3_store(swage, spore_world_to_frame(world, needle->tool.bodies[0], spore_vec3_load(needle->fields.swage)));
  term->a = (SporeEnd){.mapping = mapping, .body = needle->thread, .point = (uint32_t)end};
  term->b = (SporeEnd){.mapping = mapping + 1, .body = needle->tool.bodies[0]};
  double damping = 2 * sqrt(needle->fields.stiffness * body->total_mass);
  term->law = (SporeSpring){.stiffness = needle->fields.stiffness, .damping = damping};
  return spore_mapping_init_identity(mapping, body->model->block_room) &&
         spore_mapping_init_points(mapping + 1, SPORE_MAPPING_RIGID, swage, 1, NULL);
}

/* Makes the two terms of a stitch. End a of both is the same place of the tissue. */
static bool make_stitch(SporeWorld *world, SporeNeedle *needle, size_t index) {
  assert(index < (size_t)needle->fields.stitches);
  static const uint32_t blocks[SPORE_PATH_WIDTH] = {0, 1, 2, 3};
  static const double third[3] = {1. / 3, 1. / 3, 1. / 3}, quarter[4] = {0.25, 0.25, 0.25, 0.25}, origin[3] = {0};
  SporeStitch *stitch = &needle->stitches[index];
  size_t on_needle = needle->tool.spring_start + 1 + 2 * index, on_thread = on_needle + 1;
  SporeMapping *mappings = &world->links.mappings[2 * on_needle];
  stitch->needle =
      (SporeCurveJoint){.knots = spore_spline_uniform(SPANS), .points = needle->path, .mapping = mappings + 1};
  stitch->thread =
      (SporeCurveJoint){.knots = thread_knots(world, needle), .mapping = mappings + 3, .stops = needle->fields.knot};
  world->links.springs[on_needle].a.mapping = world->links.springs[on_thread].a.mapping = mappings;
  world->links.springs[on_needle].b = (SporeEnd){.mapping = mappings + 1, .body = needle->tool.bodies[0]};
  world->links.springs[on_thread].b = (SporeEnd){.mapping = mappings + 3, .body = needle->thread};
  world->links.springs[on_thread].curve = &stitch->thread;
  return spore_mapping_init_linear(mappings, 1, 3, blocks, third, NULL) &&
         spore_mapping_init_points(mappings + 1, SPORE_MAPPING_RIGID, origin, 1, NULL) &&
         spore_mapping_init_linear(mappings + 3, 1, SPORE_PATH_WIDTH, blocks, quarter, NULL);
}

static bool find_skins(const SporeWorld *world, SporeNeedle *needle) {
  needle->skins = SPORE_NEW_ARRAY(SporeSkin, world->body_count);
  for (uint32_t b = 0; needle->skins && b < world->body_count; b++) {
    const SporeModel *model = world->bodies[b].model;
    if (!model || !model->type->skin) continue;
    SporeSkin *skin = &needle->skins[needle->skin_count++];
    skin->body = b;
    if (!model->type->skin(model, &skin->triangles, &skin->count)) return false;
  }
  return needle->skins;
}

static bool make(SporeWorld *world, SporeTool *tool, const SporeToolDescription *from) {
  SporeNeedle *needle = (SporeNeedle *)tool;
  needle->fields = *(const SporeNeedleFields *)from->fields;
  needle->thread = from->bodies[SPORE_TOOL_THREAD];
  make_path(world, needle);
  if (needle->thread != SPORE_NO_BODY && !tie_thread(world, needle, from)) return false;
  needle->stitches = SPORE_NEW_ARRAY(SporeStitch, (size_t)needle->fields.stitches);
  bool made = needle->stitches && find_skins(world, needle);
  for (size_t i = 0; made && i < (size_t)needle->fields.stitches; i++) made = make_stitch(world, needle, i);
  world->links.curve_joint_count++;
  return made;
}

static void clear(SporeTool *tool) {
  SporeNeedle *needle = (SporeNeedle *)tool;
  for (size_t i = 0; needle->skins && i < needle->skin_count; i++) spore_free(needle->skins[i].triangles);
  spore_free(needle->skins);
  spore_free(needle->stitches);
}

/* Stitches. */

static size_t term_of(const SporeNeedle *needle, const SporeStitch *stitch, SporeStitchState state) {
  assert(stitch >= needle->stitches && stitch < needle->stitches + needle->fields.stitches);
  size_t index = (size_t)(stitch - needle->stitches);
  return needle->tool.spring_start + 1 + 2 * index + (state == SPORE_STITCH_ON_THREAD);
}

/* Changes the state of a stitch. The spring of the new state begins without stretch. */
static void go_to(SporeWorld *world, const SporeNeedle *needle, SporeStitch *stitch, SporeStitchState state) {
  assert(state == SPORE_STITCH_FREE || stitch->body < world->body_count);
  size_t now = term_of(needle, stitch, state);
  if (stitch->state != SPORE_STITCH_FREE) world->links.active[term_of(needle, stitch, stitch->state)] = false;
  stitch->state = state;
  if (state == SPORE_STITCH_FREE) return;
  SporeSpringTerm *term = &world->links.springs[now];
  term->stretch = term->slid = term->held = 0;
  term->force = (SporeVec3){0, 0, 0};
  world->links.active[now] = true;
  spore_world_wake(world, stitch->body);
}

static void reset(SporeWorld *world, SporeTool *tool) {
  SporeNeedle *needle = (SporeNeedle *)tool;
  for (size_t i = 0; i < (size_t)needle->fields.stitches; i++)
    go_to(world, needle, &needle->stitches[i], SPORE_STITCH_FREE);
  world->links.active[needle->tool.spring_start] = needle->thread != SPORE_NO_BODY;
  needle->pierced = 0;
}

static SporeVec3 path_at(const SporeNeedle *needle, const double *q, double parameter) {
  return spore_pose_apply(spore_pose_load(q),
                          spore_path_at(spore_spline_uniform(SPANS), needle->path, parameter).position);
}

/* Unit, ahead of the tip. */
static SporeVec3 ahead_of_tip(const SporeNeedle *needle, const double *q) {
  SporeVec3 back = spore_path_at(spore_spline_uniform(SPANS), needle->path, 0).slope;
  return spore_vec3_normalise(spore_quat_rotate(spore_quat_load(q + 3), spore_vec3_scale(-1, back)),
                              (SporeVec3){0, 0, 0});
}

static SporeVec3 tissue_at(const SporeWorld *world, const SporeSpringTerm *term) {
  assert(term->a.body < world->body_count);
  return spore_mapping_position(term->a.mapping, 0, world->state.q + world->bodies[term->a.body].q_offset);
}

static void pierce(SporeWorld *world, SporeNeedle *needle, SporeStitch *stitch) {
  assert(stitch->state == SPORE_STITCH_PRESSED);
  go_to(world, needle, stitch, SPORE_STITCH_ON_NEEDLE);
  SporeSpringTerm *term = &world->links.springs[term_of(needle, stitch, SPORE_STITCH_ON_NEEDLE)];
  term->curve = &stitch->needle;
  term->law.friction = needle->fields.friction;
  stitch->needle.start = 0;
  needle->pierced++;
  world->bodies[stitch->body].marks.pierced++;
  spore_world_report(world, _("%s: pierced %s"), needle->tool.name, world->bodies[stitch->body].name);
}

/* The tip pushes the tissue on, pierces it, or is drawn back from it. */
static void press(SporeWorld *world, SporeNeedle *needle, SporeStitch *stitch) {
  assert(stitch->state == SPORE_STITCH_PRESSED);
  const double *target = world->state.target_q + world->bodies[needle->tool.bodies[0]].q_offset;
  const SporeSpringTerm *term = &world->links.springs[term_of(needle, stitch, SPORE_STITCH_PRESSED)];
  SporeVec3 ahead = ahead_of_tip(needle, target);
  double pushed = spore_vec3_dot(ahead, spore_vec3_sub(path_at(needle, target, 0), stitch->touched));
  double force = spore_vec3_dot(ahead, term->force);
  if (pushed < 0) go_to(world, needle, stitch, SPORE_STITCH_FREE);
  else if (pushed > needle->fields.depth || force > needle->fields.force) pierce(world, needle, stitch);
}

/* Moves the curve joint to the place of its path nearest to the tissue. Returns how far the tissue is beyond an end of
 * the path, m. */
static double follow(const SporeWorld *world, SporeSpringTerm *term, const double *local) {
  assert(term->curve && local);
  SporeVec3 at = tissue_at(world, term);
  term->stretch = spore_spring_term_stretch(term, world->state.sites, world->state.q);
  SporePathPlace place = spore_curve_joint_place(term->curve, local, at);
  term->curve->start = place.parameter;
  spore_curve_joint_set(term, &place);
  return spore_curve_joint_overshoot(term->curve, &place, at);
}

/* The stitch slides along the needle. Behind the swage it goes over to the thread, before the tip it comes off. */
static void slide_on_needle(SporeWorld *world, SporeNeedle *needle, SporeStitch *stitch) {
  assert(stitch->state == SPORE_STITCH_ON_NEEDLE);
  SporeSpringTerm *term = &world->links.springs[term_of(needle, stitch, SPORE_STITCH_ON_NEEDLE)];
  double beyond = follow(world, term, world->state.target_q + world->bodies[needle->tool.bodies[0]].q_offset);
  if (!(beyond > 0)) return;
  bool behind = stitch->needle.start > 0, threaded = behind && needle->thread != SPORE_NO_BODY;
  go_to(world, needle, stitch, threaded ? SPORE_STITCH_ON_THREAD : SPORE_STITCH_FREE);
  if (!threaded) return;
  SporeSpringTerm *next = &world->links.springs[term_of(needle, stitch, SPORE_STITCH_ON_THREAD)];
  stitch->thread.start = needle->from_end ? spore_spline_end(thread_knots(world, needle)) : 0;
  follow(world, next, world->state.q + world->bodies[needle->thread].q_offset);
  next->stretch = 0;
}

static void slide_on_thread(SporeWorld *world, SporeNeedle *needle, SporeStitch *stitch) {
  assert(stitch->state == SPORE_STITCH_ON_THREAD && needle->thread < world->body_count);
  SporeSpringTerm *term = &world->links.springs[term_of(needle, stitch, SPORE_STITCH_ON_THREAD)];
  double beyond = follow(world, term, world->state.q + world->bodies[needle->thread].q_offset);
  bool at_swage = needle->from_end == (stitch->thread.start > 0);
  if (!(beyond > 0) || at_swage || stitch->thread.stops) return;
  go_to(world, needle, stitch, SPORE_STITCH_FREE);
  spore_world_report(world, _("%s: its thread slipped out of %s"), needle->tool.name, world->bodies[stitch->body].name);
}

static void tear_out(SporeWorld *world, SporeNeedle *needle, SporeStitch *stitch) {
  double strength = needle->fields.strength;
  if (stitch->state < SPORE_STITCH_ON_NEEDLE || !(strength > 0)) return;
  double load = spore_vec3_length(world->links.springs[term_of(needle, stitch, stitch->state)].force);
  if (load <= strength) return;
  go_to(world, needle, stitch, SPORE_STITCH_FREE);
  if (world->state.monitor.lost_holds++ == 0)
    spore_world_report(world, _("%s: a stitch tore out of %s, it held %.3g N and can hold %.3g N"), needle->tool.name,
                       world->bodies[stitch->body].name, load, strength);
}

/* Crossings. */

typedef struct Crossing {
  uint32_t body;
  const uint32_t *corners; /* NULL: none */
  double weight[3], share; /* weights of the corners; share of the way */
} Crossing;

/* Sets the crossing to that of the way from p by d through a triangle, if it is nearer (T. Moeller and B. Trumbore,
 * "Fast, minimum storage ray/triangle intersection", 1997). */
static void cross_triangle(Crossing *crossing, uint32_t body, const uint32_t *corners, const double *q, SporeVec3 p,
                           SporeVec3 d) {
  SporeVec3 a = spore_vec3_load(q + 3 * (size_t)corners[0]);
  SporeVec3 u = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)corners[1]), a);
  SporeVec3 w = spore_vec3_sub(spore_vec3_load(q + 3 * (size_t)corners[2]), a);
  SporeVec3 across = spore_vec3_cross(d, w), from = spore_vec3_sub(p, a), turned = spore_vec3_cross(from, u);
  double determinant = spore_vec3_dot(u, across);
  if (determinant == 0) return;
  double second = spore_vec3_dot(from, across) / determinant, third = spore_vec3_dot(d, turned) / determinant;
  double share = spore_vec3_dot(w, turned) / determinant;
  if (!(second >= 0 && third >= 0 && second + third <= 1 && share >= 0 && share < crossing->share)) return;
  *crossing = (Crossing){body, corners, {1 - second - third, second, third}, share};
}

/* Whether the tip or the needle has already met the body here. */
static bool is_met(const SporeWorld *world, const SporeNeedle *needle, uint32_t body, SporeVec3 at) {
  for (size_t i = 0; i < (size_t)needle->fields.stitches; i++) {
    const SporeStitch *stitch = &needle->stitches[i];
    if (stitch->state == SPORE_STITCH_FREE || stitch->state == SPORE_STITCH_ON_THREAD || stitch->body != body) continue;
    SporeVec3 there = tissue_at(world, &world->links.springs[term_of(needle, stitch, stitch->state)]);
    if (spore_vec3_distance(there, at) < 3 * BEHIND * needle->length) return true;
  }
  return false;
}

static void touch(SporeWorld *world, SporeNeedle *needle, SporeStitch *stitch, const Crossing *crossing, SporeVec3 at) {
  assert(crossing->corners && crossing->body < world->body_count);
  const SporeModel *model = world->bodies[crossing->body].model;
  SporeSpringTerm *terms = &world->links.springs[term_of(needle, stitch, SPORE_STITCH_PRESSED)];
  SporeMapping *place = &world->links.mappings[2 * term_of(needle, stitch, SPORE_STITCH_PRESSED)];
  double mass = 0;
  for (int k = 0; k < 3; k++) {
    place->block[k] = crossing->corners[k];
    place->weight[k] = crossing->weight[k];
    mass += model->block_mass[crossing->corners[k]];
  }
  double damping = 2 * sqrt(needle->fields.stiffness * mass);
  stitch->body = crossing->body;
  stitch->touched = at;
  for (int t = 0; t < 2; t++) {
    terms[t].a.body = crossing->body;
    terms[t].law = (SporeSpring){
        .stiffness = needle->fields.stiffness, .damping = damping, .friction = t ? needle->fields.friction : 0};
  }
  terms[0].curve = NULL; /* a fixed place at the tip */
  memcpy(place[1].points, needle->path, 3 * sizeof(double));
  go_to(world, needle, stitch, SPORE_STITCH_PRESSED);
}

/* Finds the surface between the needle just behind its tip and the target of the tip, unless the tip goes back. */
static void meet(SporeWorld *world, SporeNeedle *needle) {
  size_t offset = world->bodies[needle->tool.bodies[0]].q_offset;
  const double *now = world->state.q + offset, *target = world->state.target_q + offset;
  SporeStitch *place = NULL;
  for (size_t i = 0; i < (size_t)needle->fields.stitches; i++) {
    if (needle->stitches[i].state == SPORE_STITCH_PRESSED) return;
    if (!place && needle->stitches[i].state == SPORE_STITCH_FREE) place = &needle->stitches[i];
  }
  SporeVec3 from = path_at(needle, now, BEHIND * SPANS), tip = path_at(needle, target, 0);
  SporeVec3 way = spore_vec3_sub(tip, from), moved = spore_vec3_sub(tip, path_at(needle, now, 0));
  if (!place || !(spore_vec3_dot(moved, ahead_of_tip(needle, target)) > 0)) return;
  Crossing crossing = {.share = 1};
  for (size_t s = 0; s < needle->skin_count; s++) {
    const SporeSkin *skin = &needle->skins[s];
    const double *q = world->state.q + world->bodies[skin->body].q_offset;
    for (size_t t = 0; t < skin->count; t++)
      cross_triangle(&crossing, skin->body, skin->triangles + 3 * t, q, from, way);
  }
  SporeVec3 at = spore_vec3_add_scaled(from, crossing.share, way);
  if (crossing.corners && !is_met(world, needle, crossing.body, at)) touch(world, needle, place, &crossing, at);
}

static void use(SporeWorld *world, SporeTool *tool) {
  SporeNeedle *needle = (SporeNeedle *)tool;
  for (size_t i = 0; i < (size_t)needle->fields.stitches; i++) {
    SporeStitch *stitch = &needle->stitches[i];
    tear_out(world, needle, stitch);
    if (stitch->state == SPORE_STITCH_PRESSED) press(world, needle, stitch);
    if (stitch->state == SPORE_STITCH_ON_NEEDLE) slide_on_needle(world, needle, stitch);
    else if (stitch->state == SPORE_STITCH_ON_THREAD) slide_on_thread(world, needle, stitch);
  }
  meet(world, needle);
}

static size_t count_stitches(const SporeNeedle *needle) {
  size_t count = 0;
  for (size_t i = 0; i < (size_t)needle->fields.stitches; i++)
    count += needle->stitches[i].state >= SPORE_STITCH_ON_NEEDLE;
  return count;
}

static void state(const SporeTool *tool, SporeToolState *now) {
  const SporeNeedle *needle = (const SporeNeedle *)tool;
  now->pierced = needle->pierced;
  now->stitches = count_stitches(needle);
}

static const SporeParameter rows[] = {
    SPORE_ROW_NAME(SporeNeedleFields, tool.name, N_("Name of the tool.")),
    SPORE_ROW_BODY(SporeNeedleFields, body, tool.body,
                   N_("Active body that the tool moves: the needle. It needs no spheres.")),
    SPORE_ROW_DEVICE(SporeNeedleFields),
    SPORE_ROW_BODY(SporeNeedleFields, thread, thread,
                   N_("Thread, a body along a curve that begins or ends at the swage.")),
    SPORE_ROW_PLACE(SporeNeedleFields, tip, N_("Its tip at the start, in the scene.")),
    SPORE_ROW_PLACE(SporeNeedleFields, middle, N_("A point between on its arc at the start, in the scene.")),
    SPORE_ROW_PLACE(SporeNeedleFields, swage, N_("Where it ends and the thread begins, at the start, in the scene.")),
    SPORE_ROW_REAL(SporeNeedleFields, force, "N", 0, 1e3, 0.2,
                   N_("Force of the tip on a surface above which it pierces it.")),
    SPORE_ROW_REAL(SporeNeedleFields, depth, "m", 0, 1, 0.003,
                   N_("How far the tip pushes a surface before it at most: beyond, it pierces it.")),
    SPORE_ROW_REAL(SporeNeedleFields, stiffness, "N/m", 1e-3, 1e9, 500,
                   N_("How firmly needle and thread are held where they go through tissue.")),
    SPORE_ROW_REAL(SporeNeedleFields, friction, "", 0, 10, 0.1,
                   N_("Coulomb coefficient of tissue against needle and thread.")),
    SPORE_ROW_REAL(SporeNeedleFields, strength, "N", 0, 1e6, 0,
                   N_("Force above which a stitch tears out of the tissue; 0: never.")),
    SPORE_ROW_COUNT(SporeNeedleFields, stitches, 1, 1000, 8,
                    N_("Places that needle and thread can go through at a time.")),
    {.name = "knot",
     .type = SPORE_BOOLEAN,
     .unit = "",
     .maximum = 1,
     .initial = {1},
     .offset = offsetof(SporeNeedleFields, knot),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("The thread ends in a knot that does not go through tissue; else it can be drawn out.")},
};

const SporeToolType spore_needle = {
    .element = "needle",
    .label = N_("Needle"),
    .doc = N_("A curved needle that pierces nets, surfaces and tetrahedra, and draws a thread through them."),
    .parameters = SPORE_TABLE(rows, SporeNeedleFields),
    .size = sizeof(SporeNeedle),
    .make = make,
    .spring_count = spring_count,
    .fault = fault,
    .clear = clear,
    .reset = reset,
    .use = use,
    .state = state};
