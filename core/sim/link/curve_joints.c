/* Lines along which links slide: the straight lines of rigid bodies, and the curved lines of threads and tubes. */
#include "core/base/text.h"
#include "core/sim/link/link_rows.h"
#include "core/sim/world_private.h"

#define OFF_LINE 0.01 /* of a line's length: a point farther from the line would be pulled there with a jerk */
#define SHARP 0.5     /* rad: a line that turns by more from knot to knot slides badly, or not at all */
#define PATIENCE 20   /* steps in which control points may be added at a sharp bend before it is reported */
#define SLIPPED 1e-3  /* of a span: distance beyond the end of a line at which a point slips off */

/* The body that the line of a slide or port belongs to. */
static uint32_t line_body(const SporeLinkDescription *link) {
  return link->type->line == SPORE_LINE_OF_BODY_A ? link->body_a : link->body_b;
}

/* Whether the line belongs to a deformable body. */
bool spore_link_is_curved(const SporeWorld *world, const SporeLinkDescription *link) {
  uint32_t body = line_body(link);
  const SporeModel *model = body < world->body_count ? world->bodies[body].model : NULL;
  return link->type->line != SPORE_LINE_NONE && model && model->type->line;
}

bool spore_link_make_line(const SporeWorld *world, SporeLink *link, const SporeLinkDescription *from,
                          SporeError *error) {
  const SporeEnd *end = &world->links.springs[link->term_start].b;
  if (end->mapping->kind != SPORE_MAPPING_FIXED && end->mapping->kind != SPORE_MAPPING_RIGID)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("the line belongs to a body that deforms and has none of its own; expected one along a curve, "
          "a rigid one, or the scene; exchange the bodies, or choose another link"));
  link->base = from->point_a;
  link->along = spore_vec3_normalise(from->direction, (SporeVec3){0, 0, 0});
  if (end->mapping->kind == SPORE_MAPPING_FIXED) return true;
  const SporePose *pose = &world->bodies[end->body].rest_pose;
  link->base = spore_world_to_frame(world, end->body, link->base);
  link->along = spore_quat_rotate(spore_quat_conjugate(pose->orientation), link->along);
  return true;
}

static bool refuse_far(const SporePathPlace *place, double off, double most, SporeError *error) {
  SporeVec3 at = place->position;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the point lies %.3g m off the line of the body; expected at most %.3g m; move it there, to "
                           "(%.6g, %.6g, %.6g)"),
                         off, most, at.x, at.y, at.z);
}

bool spore_link_make_curve(SporeWorld *world, SporeLink *link, const SporeLinkDescription *from, SporeError *error) {
  static const uint32_t blocks[SPORE_PATH_WIDTH] = {0, 1, 2, 3};
  static const double weights[SPORE_PATH_WIDTH] = {0.25, 0.25, 0.25, 0.25}; /* no weight is 0: each keeps its entry */
  const SporeBody *body = &world->bodies[line_body(from)];
  const double *rest = world->state.rest_q + body->q_offset;
  SporeSplineKnots knots = body->model->type->line->path(body->model);
  SporePathPlace place = spore_path_seek(knots, rest, NULL, from->point_a);
  double off = spore_vec3_distance(place.position, from->point_a);
  double most = OFF_LINE * spore_path_length(knots, rest, 0, spore_spline_end(knots));
  if (off > most) return refuse_far(&place, off, most, error);
  SporeSpringTerm *term = &world->links.springs[link->term_start];
  SporeMapping *mapping = &world->links.mappings[2 * link->term_start];
  link->curve = (SporeCurveJoint){
      .knots = knots, .mapping = mapping + 1, .stops = from->ends == SPORE_ENDS_STOP, .start = place.parameter};
  term->curve = &link->curve;
  world->links.curve_joint_count++;
  term->law = spore_link_law(world, from);
  term->b = (SporeEnd){.mapping = mapping + 1, .body = line_body(from)};
  world->links.active[link->term_start] = true;
  uint32_t other = from->type->line == SPORE_LINE_OF_BODY_A ? from->body_b : from->body_a;
  return spore_world_attach(world, other, place.position, mapping, &term->a, error) &&
         spore_mapping_init_linear(mapping + 1, 1, SPORE_PATH_WIDTH, blocks, weights, error);
}

static SporeVec3 end_position(const SporeWorld *world, const SporeEnd *end) {
  const double *q = end->body == SPORE_NO_BODY ? NULL : world->state.q + world->bodies[end->body].q_offset;
  return spore_mapping_position(end->mapping, end->point, q);
}

/* Updates the line of a rigid body, and the point on the line that is nearest to the other end. */
static void follow_line(SporeWorld *world, const SporeLink *link, SporeSpringTerm *term) {
  SporePose frame = spore_pose_identity();
  if (term->b.mapping->kind == SPORE_MAPPING_RIGID) {
    const double *q = world->state.q + world->bodies[term->b.body].q_offset;
    frame = spore_pose_load(q);
  }
  term->law.free = spore_quat_rotate(frame.orientation, link->along);
  SporeVec3 from_base = spore_vec3_sub(end_position(world, &term->a), spore_pose_apply(frame, link->base));
  SporeVec3 point = spore_vec3_add_scaled(link->base, spore_vec3_dot(term->law.free, from_base), link->along);
  spore_vec3_store(world->links.mappings[2 * link->term_start + 1].points, point);
}

/* Reports a line that turns too sharply for a cubic between two knots: the point may stick there. */
static void watch_bend(SporeWorld *world, SporeLink *link, const SporePathPlace *place, uint32_t index) {
  if (link->reported_sharp) return;
  double square = spore_vec3_dot(place->slope, place->slope),
         width = spore_spline_width(link->curve.knots, place->first);
  double turn = width * spore_vec3_length(spore_vec3_cross(place->slope, place->bend)) / square;
  link->sharp_steps = turn > SHARP ? link->sharp_steps + 1 : 0;
  const SporeBody *body = &world->bodies[index];
  bool spent = body->refinement.state.points == body->refinement.state.reserve,
       waits = body->refinement.possible && !spent;
  if (link->sharp_steps < (waits ? PATIENCE : 1)) return;
  link->reported_sharp = true;
  if (!body->refinement.possible)
    spore_world_report(
        world,
        _("%s: %s turns by %.2g rad between two control points where it slides, more sharply than they can "
          "follow: it may stick there; set its most_bend to 0.3, or more control_points"),
        link->name, body->name, turn);
  else if (spent)
    spore_world_report(
        world,
        _("%s: %s turns by %.2g rad between two control points where it slides, and may stick there: all %zu are "
          "in use; raise its maximum_control_points"),
        link->name, body->name, turn, body->refinement.state.reserve);
  else
    spore_world_report(world,
                       _("%s: %s turns by %.2g rad between two control points where it slides, and may stick there: "
                         "its most_bend asks "
                         "for no more of them; set that to 0.3"),
                       link->name, body->name, turn);
}

static void follow_curve(SporeWorld *world, SporeLink *link, SporeSpringTerm *term) {
  SporeCurveJoint *joint = &link->curve;
  const double *q = world->state.q + world->bodies[term->b.body].q_offset;
  SporeVec3 at = end_position(world, &term->a);
  if (link->lost) joint->start = spore_path_seek(joint->knots, q, NULL, at).parameter;
  SporePathPlace place = spore_curve_joint_place(joint, q, at);
  joint->start = place.parameter;
  spore_curve_joint_set(term, &place);
  watch_bend(world, link, &place, term->b.body);
  if (joint->stops || spore_curve_joint_overshoot(joint, &place, at) <= SLIPPED * spore_vec3_length(place.slope))
    return;
  spore_link_release(world, link);
  spore_world_report(world, _("%s: slipped off the end of its line"), link->name);
}

void spore_link_follow(SporeWorld *world, SporeLink *link) {
  SporeSpringTerm *term = &world->links.springs[link->term_start];
  if (link->type->line == SPORE_LINE_NONE || link->broken) return;
  term->stretch = link->lost ? 0 : spore_spring_term_stretch(term, world->state.sites, world->state.q);
  if (term->curve) follow_curve(world, link, term);
  else follow_line(world, link, term);
  link->lost = false;
}

void spore_world_lose_lines(SporeWorld *world) {
  for (size_t i = 0; i < world->links.count; i++) world->links.all[i].lost = true;
}

const char *const spore_link_ends[] = {"stop", "slip_off", NULL};
