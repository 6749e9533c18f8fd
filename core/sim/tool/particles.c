/* Particles that leave the world, by suction or by dissolving, and particles that come into it from emitters. The
 * number of unknowns stays: a particle out of the world is held far away from all bodies and other particles, out of
 * the reach of all forces. */
#include <assert.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/parameter_rows.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

#define PARKING_M (2 * SPORE_PARTICLES_OUT_M) /* along x */
#define LANE_M 1.                             /* along y: from one body to the next, wider than any particle reaches */
#define GAP_SPACINGS 10. /* between particles out of the world, in mean distances of the fluid's particles */
#define NEAREST 1.1      /* of that distance: a particle that comes nearer to another would be thrown out */
#define TRIES 8          /* random places in an emitter's mouth that are tried for a particle in a step */

/* Parking. */

bool spore_body_is_fluid(const SporeBody *body) { return body->model && body->model->type->particles; }

static SporeVec3 parking_place(const SporeBody *body, size_t particle) {
  assert(body->parking_gap > 0);
  return (SporeVec3){PARKING_M + body->parking_gap * (double)particle, body->parking_lane, 0};
}

static double spacing(const SporeBody *body) { return body->parking_gap / GAP_SPACINGS; }

/* Makes room to hold all particles of the body, and sets their distance out of the world. */
static bool make_parking(SporeWorld *world, SporeBody *body) {
  assert(spore_body_is_fluid(body));
  const double *q = world->state.rest_q + body->q_offset;
  double lower[3] = {INFINITY, INFINITY, INFINITY}, upper[3] = {-INFINITY, -INFINITY, -INFINITY}, volume = 1;
  if (body->parking_gap > 0) return true;
  for (size_t i = 0; i < 3 * body->block_count; i++) {
    lower[i % 3] = fmin(lower[i % 3], q[i]);
    upper[i % 3] = fmax(upper[i % 3], q[i]);
  }
  for (int k = 0; k < 3; k++) volume *= fmax(upper[k] - lower[k], 1e-6);
  for (size_t b = 0; b < world->body_count; b++) body->parking_lane += world->bodies[b].parking_gap > 0 ? LANE_M : 0;
  body->parking_gap = GAP_SPACINGS * cbrt(volume / (double)body->block_count);
  uint32_t *held = spore_reallocate(body->held.blocks, body->held.count, body->block_count, sizeof *held);
  if (held) body->held.blocks = held;
  return held != NULL;
}

void spore_body_find_parked(SporeBody *body, const double *q) {
  assert(body->held.blocks && body->held.pin_count <= body->held.count);
  body->held.count = body->held.pin_count;
  for (size_t i = 0; i < body->block_count; i++)
    if (spore_particle_is_out(q + 3 * i)) body->held.blocks[body->held.count++] = (uint32_t)i;
}

size_t spore_world_particle_count(const SporeWorld *world, uint32_t index) {
  assert(index < world->body_count);
  const SporeBody *body = &world->bodies[index];
  return body->block_count - (body->held.count - body->held.pin_count);
}

/* Removes the forces of the particle's contacts of the last step: they belong to its old place. */
static void drop_contacts(SporeWorld *world, const SporeBody *body, size_t particle) {
  assert(particle < body->block_count);
  if (body->collision.spheres.kind != SPORE_MAPPING_IDENTITY || body->collision.spheres.point_count == 0) return;
  uint32_t sphere = (uint32_t)(body->collision.start + particle);
  for (size_t i = 0; i < world->contact.count; i++) {
    SporeContactTerm *term = &world->contact.terms[i];
    if (term->sphere_a != sphere && term->sphere_b != sphere) continue;
    term->law.stiffness = term->law.friction = 0;
    term->stretch = (SporeVec3){0, 0, 0};
  }
}

/* Age of a particle that dissolves, s. */
static double *age_of(SporeBody *body, double *q, size_t particle) {
  assert(body->model->life_s > 0 && particle < body->model->node_count);
  return &q[3 * body->model->node_count + particle];
}

static void put(SporeWorld *world, SporeBody *body, size_t particle, SporeVec3 at, SporeVec3 velocity) {
  assert(particle < body->block_count);
  world->solve.watch.started = body->effect.settled = false;
  spore_vec3_store(world->state.next_q + body->q_offset + 3 * particle, at);
  if (body->model->life_s > 0) *age_of(body, world->state.next_q + body->q_offset, particle) = 0;
  spore_vec3_store(world->state.next_v + body->v_offset + 3 * particle, velocity);
  drop_contacts(world, body, particle);
  body->history.step_s = 0;
}

void spore_world_take_particle(SporeWorld *world, SporeBody *body, size_t particle) {
  assert(body->held.count < body->block_count && particle < body->block_count);
  body->held.blocks[body->held.count++] = (uint32_t)particle;
  put(world, body, particle, parking_place(body, particle), (SporeVec3){0, 0, 0});
}

/* Dissolving. */

static bool dissolves(const SporeBody *body) { return body->model && body->model->life_s > 0; }

static void dissolve(SporeWorld *world, SporeBody *body) {
  double *q = world->state.next_q + body->q_offset;
  if (body->sleep.asleep || body->frozen) return; /* and its particles do not age */
  for (size_t i = 0; i < body->block_count; i++)
    if (*age_of(body, q, i) >= body->model->life_s && !spore_particle_is_out(q + 3 * i))
      spore_world_take_particle(world, body, i);
}

/* Whether a tool that the body leads coagulated something in this step. */
static bool coagulates(const SporeWorld *world, uint32_t body) {
  for (size_t i = 0; i < world->tools.count; i++) {
    const SporeTool *tool = world->tools.all[i];
    SporeToolState state = {0};
    if (tool->bodies[0] != body || !tool->type->state) continue;
    tool->type->state(tool, &state);
    if (state.coagulated > 0) return true;
  }
  return false;
}

/* Whether a flow is on: always, or by what its body does. */
static bool flows(const SporeWorld *world, int trigger, uint32_t body) {
  if (trigger == SPORE_FLOW_COAGULATION) return coagulates(world, body);
  uint32_t button = trigger == SPORE_FLOW_SECOND_BUTTON ? SPORE_SECOND_BUTTON : SPORE_FIRST_BUTTON;
  return trigger == SPORE_FLOW_ALWAYS || spore_tool_button(world, body, button);
}

double spore_flow_due(const SporeWorld *world, double rate, int trigger, uint32_t body, double due) {
  assert(rate >= 0 && due >= 0);
  double most = rate * world->solver.time_step;
  return flows(world, trigger, body) ? fmin(due + most, fmax(most, 1)) : 0;
}

/* Emission. */

/* Enough clamps are closed on the bleeding body, near the wound. */
static bool is_pinched(const SporeWorld *world, const SporeEmitter *emitter) {
  SporePose frame = spore_emitter_frame(world, emitter);
  SporeVec3 mouth = spore_pose_apply(frame, emitter->point);
  int64_t closed = 0;
  for (size_t i = 0; i < world->tools.count; i++) {
    const SporeTool *tool = world->tools.all[i];
    closed +=
        tool->type->pinches && tool->type->pinches(world, tool, emitter->source, mouth, emitter->fields.clamp_distance);
  }
  return closed >= emitter->fields.clamps;
}

/* A cut opens the wound, coagulation closes it; where both come in one step, it is closed. Clamps keep it from
 * bleeding as long as they are closed. */
static bool bleeds(const SporeWorld *world, SporeEmitter *emitter) {
  SporeBodyMarks now = world->bodies[emitter->source].marks;
  if (now.cut > emitter->marks.cut) emitter->bleeds = true;
  if (now.coagulated > emitter->marks.coagulated) emitter->bleeds = false;
  emitter->marks = now;
  return emitter->bleeds && !is_pinched(world, emitter);
}

/* Uniform in 0..1, the same on every machine. */
static double next_random(uint64_t *state) {
  *state = *state * 6364136223846793005u + 1442695040888963407u;
  return (double)(*state >> 11) * 0x1p-53;
}

static bool is_jet(const SporeEmitter *emitter) { return emitter->fields.flow > 0; }

/* Smoke may overlap, and so may what is poured as an effect: drops part gently. Particles of a jet come as near as in
 * the fluid, since no more of them come out than there is room for in the jet. */
static bool is_free(const SporeWorld *world, const SporeEmitter *emitter, SporeVec3 at) {
  const SporeBody *body = &world->bodies[emitter->body];
  const double *q = world->state.next_q + body->q_offset;
  double nearest = is_jet(emitter) ? cbrt(body->model->particle_volume) : NEAREST * spacing(body);
  if (dissolves(body) || (is_jet(emitter) && body->effect.on)) return true;
  for (size_t i = 0; i < body->block_count; i++)
    if (spore_vec3_distance(spore_vec3_load(q + 3 * i), at) < nearest) return false;
  return true;
}

/* How far out of the mouth a particle is that the flow let out within the step, m: the first of them are farther. */
static double way_ahead(const SporeEmitter *emitter) {
  return is_jet(emitter) ? emitter->fields.speed * (emitter->due - 1) / emitter->fields.rate : 0;
}

/* Finds a place in the mouth, or in the jet before it, without a particle. */
static bool find_place(const SporeWorld *world, SporeEmitter *emitter, const SporePose *frame, SporeVec3 *at) {
  SporeVec3 middle = spore_vec3_add_scaled(emitter->point, way_ahead(emitter), emitter->direction);
  SporeVec3 one = spore_vec3_cross(emitter->direction,
                                   fabs(emitter->direction.x) < 0.5 ? (SporeVec3){1, 0, 0} : (SporeVec3){0, 1, 0});
  one = spore_vec3_normalise(one, (SporeVec3){0, 0, 1});
  SporeVec3 other = spore_vec3_cross(emitter->direction, one);
  for (int i = 0; i < TRIES; i++) {
    double radius = emitter->fields.radius * sqrt(next_random(&emitter->tries));
    double angle = 6.283185307179586 * next_random(&emitter->tries);
    SporeVec3 local = spore_vec3_add_scaled(middle, radius * cos(angle), one);
    *at = spore_pose_apply(*frame, spore_vec3_add_scaled(local, radius * sin(angle), other));
    if (is_free(world, emitter, *at)) return true;
  }
  return false;
}

/* Of a jet, the part of a particle that is left over in a step comes in a later one, so that nothing of its flow is
 * lost. */
static double due_of(const SporeWorld *world, const SporeEmitter *emitter, int trigger) {
  double rate = emitter->fields.rate, most = rate * world->solver.time_step;
  if (!is_jet(emitter)) return spore_flow_due(world, rate, trigger, emitter->source, emitter->due);
  return flows(world, trigger, emitter->source) ? fmin(emitter->due + most, 1 + most) : 0;
}

/* As an effect: what is due is counted, and no particle is put. */
static void seep(SporeWorld *world, SporeEmitter *emitter) {
  SporeBody *body = &world->bodies[emitter->body];
  double count = floor(emitter->due), volume = count * body->model->particle_volume;
  emitter->due -= count;
  emitter->seeped += volume;
  body->marks.seeped += (uint64_t)count;
  if (is_jet(emitter)) world->tools.counts.poured += volume;
}

static void emit(SporeWorld *world, SporeEmitter *emitter) {
  assert(emitter->body < world->body_count && spore_body_is_fluid(&world->bodies[emitter->body]));
  SporeBody *body = &world->bodies[emitter->body];
  const SporeEmitterFields *fields = &emitter->fields;
  double time_s = (double)(world->state.step + 1) * world->solver.time_step;
  bool wound = fields->trigger == SPORE_FLOW_WOUND;
  if (wound && !bleeds(world, emitter)) return;
  bool none_left = !emitter->effect && body->held.count == body->held.pin_count;
  if (time_s < fields->start || body->frozen || none_left) return;
  emitter->due = due_of(world, emitter, wound ? SPORE_FLOW_ALWAYS : fields->trigger);
  if (emitter->due < 1) return;
  if (emitter->effect) {
    seep(world, emitter);
    return;
  }
  if (spore_body_lies_still(body)) {
    spore_world_wake(world, emitter->body); /* it gets particles after the next step */
    return;
  }
  SporePose frame = spore_emitter_frame(world, emitter);
  SporeVec3 velocity = spore_quat_rotate(frame.orientation, spore_vec3_scale(fields->speed, emitter->direction));
  SporeVec3 at;
  while (emitter->due >= 1 && body->held.count > body->held.pin_count && find_place(world, emitter, &frame, &at)) {
    put(world, body, body->held.blocks[--body->held.count], at, velocity);
    emitter->due--;
    body->marks.poured++;
    if (is_jet(emitter)) world->tools.counts.poured += body->model->particle_volume;
  }
}

bool spore_world_exchanges_particles(const SporeWorld *world) {
  for (size_t i = 0; i < world->tools.count; i++)
    if (world->tools.all[i]->type->takes_particles) return true;
  for (size_t b = 0; b < world->body_count; b++)
    if (dissolves(&world->bodies[b])) return true;
  return world->tools.emitter_count > 0;
}

void spore_world_exchange_particles(SporeWorld *world) {
  for (size_t b = 0; b < world->body_count; b++)
    if (dissolves(&world->bodies[b])) dissolve(world, &world->bodies[b]);
  for (size_t i = 0; i < world->tools.count; i++)
    if (world->tools.all[i]->type->exchange) world->tools.all[i]->type->exchange(world, world->tools.all[i]);
  for (size_t i = 0; i < world->tools.emitter_count; i++) emit(world, &world->tools.emitters[i]);
}

static void begin(SporeEmitter *emitter) {
  emitter->due = 0, emitter->tries = 1;
  emitter->effect = emitter->effect_at_start;
  emitter->seeped = emitter->seen = 0;
  emitter->bleeds = false, emitter->marks = (SporeBodyMarks){0};
}

void spore_world_reset_particles(SporeWorld *world) {
  for (size_t i = 0; i < world->tools.emitter_count; i++) begin(&world->tools.emitters[i]);
  for (size_t b = 0; b < world->body_count; b++) {
    SporeBody *body = &world->bodies[b];
    if (body->parking_gap > 0) spore_body_find_parked(body, world->state.q + body->q_offset);
  }
}

/* Setting up. */

static bool is_bipolar(const SporeWorld *world, uint32_t body) {
  for (size_t i = 0; i < world->tools.count; i++)
    if (world->tools.all[i]->bodies[0] == body && world->tools.all[i]->type->heats) return true;
  return false;
}

static const char *emitter_fault(const SporeWorld *world, const SporeEmitterDescription *from) {
  if (from->body >= world->body_count || !spore_body_is_fluid(&world->bodies[from->body]))
    return _("what comes out is not a fluid of particles; expected a body with such a model; choose one");
  bool to_world = from->source == SPORE_NO_BODY, wound = from->fields.trigger == SPORE_FLOW_WOUND;
  const SporeBody *source = from->source < world->body_count ? &world->bodies[from->source] : NULL;
  if (wound && (!source || !source->model))
    return _("the mouth is in nothing that can be cut, so that nothing comes out; expected the body that bleeds; "
             "choose it, or another trigger");
  if (!to_world && !source)
    return _("the mouth is in a body that is not there; expected another one, or none; choose one");
  if (!spore_vec3_is_finite(from->point) || !spore_vec3_is_finite(from->direction) ||
      !(spore_vec3_length(from->direction) > 0))
    return _("the mouth has no direction; expected a vector of any length but 0; set it");
  if (from->fields.trigger == SPORE_FLOW_COAGULATION && !is_bipolar(world, from->source))
    return _("the mouth is in nothing that coagulates, so that nothing comes out; expected the body of a bipolar tool; "
             "choose it, or another trigger");
  bool button = from->fields.trigger == SPORE_FLOW_BUTTON || from->fields.trigger == SPORE_FLOW_SECOND_BUTTON;
  if (from->fields.flow > 0 && !(from->fields.radius > 0))
    return _("the mouth has a flow, and no width that it could go through; expected a radius above 0; set it");
  if (button && (to_world || world->bodies[from->source].role != SPORE_ACTIVE))
    return _("the mouth is in nothing that a device moves, so that no button lets anything out; expected an active "
             "body; choose one, or let it flow always");
  return NULL;
}

/* The reserve is checked here, since the number of particles is known only once the surface is filled. */
static bool check_emitter(const SporeWorld *world, const SporeEmitterDescription *from, SporeError *error) {
  char place[200];
  snprintf(place, sizeof place, "effects/%s", from->name ? from->name : "");
  const char *fault = emitter_fault(world, from);
  if (fault) return spore_error_set(error, SPORE_ERROR_INPUT, place, "%s", fault);
  size_t left = spore_world_particle_count(world, from->body), reserve = (size_t)from->fields.reserve;
  return reserve <= left ||
         spore_error_set(error, SPORE_ERROR_INPUT, place,
                         _("the reserve is %zu, but only %zu particles of the fluid are not kept back yet; expected at "
                           "most %zu; set it to that, or give the fluid more particles"),
                         reserve, left, left);
}

/* Keeps back the last `count` particles that are still in the world. */
static void keep_back(SporeWorld *world, SporeBody *body, size_t count) {
  assert(count <= body->block_count - (body->held.count - body->held.pin_count));
  for (size_t i = body->block_count; i-- > 0 && count > 0;) {
    double *q = world->state.rest_q + body->q_offset + 3 * i;
    if (spore_particle_is_out(q)) continue;
    spore_vec3_store(q, parking_place(body, i));
    spore_vec3_store(world->state.rest_v + body->v_offset + 3 * i, (SporeVec3){0, 0, 0});
    body->held.blocks[body->held.count++] = (uint32_t)i;
    count--;
  }
}

/* What comes out with a flow: as many particles as make up its volume, as fast as it goes through the mouth. */
static void set_flow(SporeEmitterFields *fields, double particle_volume) {
  if (!(fields->flow > 0)) return;
  fields->rate = fields->flow / particle_volume;
  fields->speed = fields->flow / (3.141592653589793 * fields->radius * fields->radius);
}

static void make_emitter(SporeWorld *world, SporeEmitter *emitter, const SporeEmitterDescription *from) {
  *emitter = (SporeEmitter){
      .body = from->body, .source = from->source, .fields = from->fields, .effect_at_start = from->effect};
  begin(emitter);
  set_flow(&emitter->fields, world->bodies[from->body].model->particle_volume);
  spore_emitter_set_mouth(world, emitter, from->point, from->direction);
  keep_back(world, &world->bodies[from->body], (size_t)from->fields.reserve);
}

static bool make_parkings(SporeWorld *world, const SporeWorldDescription *description) {
  bool sucks = false, made = true;
  for (size_t i = 0; i < world->tools.count; i++) sucks |= world->tools.all[i]->type->takes_particles;
  for (size_t b = 0; made && b < world->body_count; b++)
    if ((sucks && spore_body_is_fluid(&world->bodies[b])) || dissolves(&world->bodies[b]))
      made = make_parking(world, &world->bodies[b]);
  for (size_t i = 0; made && i < description->emitter_count; i++) {
    uint32_t fluid = description->emitters[i].body;
    if (fluid < world->body_count && spore_body_is_fluid(&world->bodies[fluid]))
      made = make_parking(world, &world->bodies[fluid]);
  }
  return made;
}

bool spore_world_create_particles(SporeWorld *world, const SporeWorldDescription *description, SporeError *error) {
  world->tools.emitters = SPORE_NEW_ARRAY(SporeEmitter, description->emitter_count);
  if (!world->tools.emitters || !make_parkings(world, description))
    return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for the particles"));
  for (size_t i = 0; i < description->emitter_count; i++) {
    const SporeEmitterDescription *from = &description->emitters[i];
    if (!check_emitter(world, from, error)) return false;
    make_emitter(world, &world->tools.emitters[world->tools.emitter_count++], from);
  }
  return true;
}

/* The parameters of emitters. */

const char *const spore_flow_triggers[] = {"always", "button", NULL};

static const char *const triggers[] = {"always", "button", "coagulation", "wound", "second_button", NULL};

static const SporeParameter rows[] = {
    SPORE_ROW_REAL(
        SporeEmitterFields, flow, "m^3/s", 0, 1, 0,
        N_("Volume that comes out in a second: a jet out of a tube as wide as the mouth, whose speed follows "
           "from both; an irrigator pours 1 l/min, 1.667e-5. 0: rate and speed say what comes.")),
    SPORE_ROW_REAL(SporeEmitterFields, rate, "1/s", 0, 1e9, 50,
                   N_("Particles that come out in a second, at most: none comes where one still is.")),
    SPORE_ROW_REAL(SporeEmitterFields, speed, "m/s", 0, 100, 0.05, N_("How fast they come out.")),
    SPORE_ROW_REAL(SporeEmitterFields, radius, "m", 0, 1, 0.001, N_("Radius of the mouth that they come out of.")),
    SPORE_ROW_REAL(SporeEmitterFields, start, "s", 0, 1e9, 0, N_("When the first comes out.")),
    SPORE_ROW_COUNT(SporeEmitterFields, reserve, 0, 1e6, 100,
                    N_("Particles of the fluid that are kept back at the start, to come out here.")),
    SPORE_ROW_CHOICE(
        SporeEmitterFields, trigger, triggers,
        N_("When they come out: always; while the first button is down on the device of the instrument "
           "that the mouth is in; while that instrument coagulates tissue; from the moment when the body "
           "that the mouth is in is cut until that body is coagulated; or while the second button is down.")),
    SPORE_ROW_REAL(SporeEmitterFields, clamp_distance, "m", 0, 1, 0.02,
                   N_("A wound gives nothing while clamps are closed on its body nearer than this to the mouth; 0: no "
                      "clamp stops it.")),
    SPORE_ROW_COUNT(SporeEmitterFields, clamps, 1, 10, 1,
                    N_("How many clamps it takes to stop a wound: 2 where blood comes from both sides of it.")),
};
const SporeParameterTable spore_emitter_parameters = SPORE_TABLE(rows, SporeEmitterFields);
