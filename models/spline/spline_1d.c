/* A thread or a tube: a cubic B-spline with mass, stretch and bending (Qin and Terzopoulos 1996; Lenoir et al. 2002).
 * Its nodes are the control points; the mass of each is the integral of its function. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/nodal.h"
#include "models/registry.h"
#include "models/spline/knots.h"
#include "models/spline/line.h"
#include "models/spline/twist.h"

typedef struct SplineFields {
  int64_t control_points, maximum_control_points;
  double most_bend, young_modulus, density, wall_thickness, bending_scale, twist_modulus, turns, damping;
  bool straight_at_rest;
} SplineFields;

typedef struct Spline1d {
  SporeModel base;
  SporeSplineLine line;
  SporeSplineTwist twist; /* of no spans: the line turns freely about itself */
  SporeSplineChanges changes;
} Spline1d;

/* As it is led now. */
static SporeSplineLine *line_of(Spline1d *body) { return body->changes.made ? &body->changes.now : &body->line; }
static SporeSplineTwist *twist_of(Spline1d *body) { return body->changes.made ? &body->changes.twist : &body->twist; }
static const SporeSplineTwist *twist_now(const SporeModel *model) { return twist_of((Spline1d *)(uintptr_t)model); }
static const SporeSplineLine *line_now(const SporeModel *model) { return line_of((Spline1d *)(uintptr_t)model); }

static const SporeParameter parameters[] = {
    SPORE_INTEGER_FIELD(SplineFields, control_points, 4, 100000, 30, SPORE_CHANGE_REBUILD,
                        N_("How many points the line is led by, evenly along it; more of them bend more sharply.")),
    SPORE_REAL_FIELD(SplineFields, most_bend, "rad", 0, 3, 0, SPORE_CHANGE_REBUILD,
                     N_("Where the line turns by more than this from one knot to the next, control points are added "
                        "between, again and again, until it does not, at the start and while it runs; those of while "
                        "it runs go again where it has been straight for a quarter of a second, if that moves it by "
                        "less than a twentieth of its radius. 0: they are even and stay. One with levels, or moved "
                        "by explicit steps, gets them at the start alone.")),
    SPORE_INTEGER_FIELD(
        SplineFields, maximum_control_points, 4, 100000, 1000, SPORE_CHANGE_REBUILD,
        N_("How many control points there are at most, with those that most_bend adds: memory for them is "
           "kept from the start.")),
    SPORE_REAL_FIELD(SplineFields, young_modulus, "Pa", 1e-3, 1e13, 1e6, SPORE_CHANGE_LIVE,
                     N_("Stiffness of the material: stretch takes it times the area of the section, bending times the "
                        "section's second moment.")),
    SPORE_REAL_FIELD(SplineFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume of the material; 1060 is soft tissue.")),
    SPORE_REAL_FIELD(SplineFields, wall_thickness, "m", 0, 1e3, 0, SPORE_CHANGE_REBUILD,
                     N_("Wall of a tube with the curve's radius outside; 0, or at least that radius: solid.")),
    SPORE_REAL_FIELD(
        SplineFields, bending_scale, "", 0, 1e6, 1, SPORE_CHANGE_LIVE,
        N_("Factor on the stiffness against bending: below 1 for what is woven of fibres, 0 for a chain.")),
    SPORE_REAL_FIELD(SplineFields, twist_modulus, "Pa", 0, 1e13, 0, SPORE_CHANGE_REBUILD,
                     N_("Stiffness of the material against twist, its shear modulus: a third of Young's for what keeps "
                        "its volume. 0: the line turns freely about itself, which costs less.")),
    SPORE_REAL_FIELD(SplineFields, turns, "", -1e4, 1e4, 0, SPORE_CHANGE_REBUILD,
                     N_("Turns by which the line is twisted at the start, from its beginning to its end; above 0: as a "
                        "right-handed screw. It untwists where its ends are not held from turning.")),
    SPORE_REAL_FIELD(SplineFields, damping, "s", 0, 1e6, 0.01, SPORE_CHANGE_LIVE,
                     N_("Time by which stretch and bending lag behind their forces: viscosity over elasticity. A line "
                        "bends freely where it is straight.")),
    {.name = "straight_at_rest",
     .type = SPORE_BOOLEAN,
     .unit = "",
     .offset = offsetof(SplineFields, straight_at_rest),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Whether the line would be straight if nothing bent it; else it is as the curve is.")},
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a spline"));
}

static void destroy(SporeModel *model) {
  Spline1d *body = (Spline1d *)model;
  spore_spline_changes_clear(&body->changes);
  spore_spline_twist_clear(&body->twist);
  spore_spline_line_clear(&body->line);
  spore_model_clear(&body->base);
  spore_free(body);
}

static void tune(Spline1d *body, const SplineFields *fields) {
  SporeSpline *spline = &line_of(body)->spline;
  spline->young = fields->young_modulus;
  spline->bending = fields->bending_scale;
  spline->viscous = twist_of(body)->viscous = fields->damping;
}

static bool make_twist(Spline1d *body, const SporeSplineSection *section, const SplineFields *fields,
                       SporeError *error) {
  if (fields->twist_modulus > 0)
    return spore_spline_twist_init(&body->twist, &body->line, section, fields->twist_modulus, fields->turns, error);
  if (fields->turns == 0) return true;
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the line is to be twisted by %g turns, but nothing in it resists twist; expected a "
                           "twist_modulus above 0; set it, or no turns"),
                         fields->turns);
}

static size_t arm_count(const SporeSplineTwist *twist) { return twist->span_count > 0 ? twist->span_count + 1 : 0; }

/* The control points that there are now are the model's nodes, with the arms behind them. */
static void use_points(Spline1d *body) {
  const SporeSplineLine *line = line_of(body);
  SporeModel *base = &body->base;
  const SporeSplineTwist *twist = twist_of(body);
  size_t count = line->control_count, arms = arm_count(twist);
  base->node_count = base->block_count = count + arms;
  base->q_count = 3 * base->node_count;
  memcpy(base->block_mass, line->mass, count * sizeof(double));
  if (arms > 0) memcpy(base->block_mass + count, twist->mass, arms * sizeof(double));
}

static void settle(SporeModel *model, const SporeBlockMatrix *matrix) {
  Spline1d *body = (Spline1d *)model;
  spore_spline_find_blocks(&line_of(body)->spline, matrix);
  spore_spline_twist_find_blocks(twist_of(body), matrix);
}

static bool weigh_nodes(SporeModel *model, double h, const double *q, const uint8_t *held) {
  assert(((const Spline1d *)model)->changes.made);
  return spore_spline_changes_weigh(&((Spline1d *)model)->changes, h, q, held);
}

static void change_nodes(SporeModel *model, double *q, double *v, uint8_t *held) {
  assert(((const Spline1d *)model)->changes.made);
  Spline1d *body = (Spline1d *)model;
  spore_spline_changes_make(&body->changes, q, v, held);
  use_points(body);
}

static void mend(SporeModel *model) {
  Spline1d *body = (Spline1d *)model;
  if (!body->changes.made) return;
  spore_spline_changes_undo(&body->changes);
  use_points(body);
}

static bool follow(const SporeModel *model, SporeSplineKnots knots, SporeMapping *mapping) {
  const Spline1d *body = (const Spline1d *)model;
  if (mapping->kind == SPORE_MAPPING_FRAMES) {
    spore_line_frames_follow(mapping->frames, knots);
    return true;
  }
  if (!body->changes.made || !mapping->anchors) return true;
  const SporeSplineLine *now = &body->changes.now;
  if (knots.breaks == now->breaks) {
    spore_spline_map_follow(now->knots, now->rest, body->changes.twist.rest, mapping);
    return true;
  }
  size_t count = knots.span_count + 3;
  double *control = SPORE_NEW_ARRAY(double, 7 * count), *arms = control + 3 * count, *breaks = arms + 3 * count;
  bool twisted = body->twist.span_count > 0;
  if (control) {
    spore_spline_line_lead(&body->line, knots, control, breaks);
    if (twisted) spore_spline_twist_lead(&body->twist, &body->line, knots, arms);
    spore_spline_map_follow(knots, control, twisted ? arms : NULL, mapping);
  }
  spore_free(control);
  return control;
}

static bool build(Spline1d *body, const SporeGeometry *geometry, const SplineFields *fields, SporeError *error) {
  SporeSplineDensity density = {.count = (size_t)fields->control_points, .most_bend = fields->most_bend};
  SporeSplineSection section = {.density = fields->density,
                                .wall_thickness = fields->wall_thickness,
                                .straight_at_rest = fields->straight_at_rest};
  size_t most = (size_t)fields->maximum_control_points;
  density.most = density.most_bend > 0 && most > density.count ? most : density.count;
  if (!spore_spline_line_init(&body->line, geometry->curve, &density, &section, error) ||
      spore_cancel_asked(geometry->cancel) || !make_twist(body, &section, fields, error))
    return false;
  size_t count = body->line.control_count, room = density.most;
  bool twisted = body->twist.span_count > 0;
  if (!spore_model_init(&body->base, &spore_spline_1d, twisted ? 2 * room - 2 : room, false, error)) return false;
  body->base.line_room = room;
  body->base.pair_room = (twisted ? 12 : 3) * room; /* a span: 3 of its control points, and 9 of the arm behind it */
  if (room > count && !spore_spline_changes_init(&body->changes, &body->line, &body->twist, &density, &section))
    return no_memory(error);
  use_points(body);
  SporeBlockMatrix matrix;
  if (!spore_model_matrix_create(&body->base, &matrix)) return no_memory(error);
  settle(&body->base, &matrix);
  spore_block_matrix_clear(&matrix);
  tune(body, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  Spline1d *body = SPORE_NEW(Spline1d);
  if (!body) {
    no_memory(error);
    return NULL;
  }
  if (build(body, geometry, fields, error)) return &body->base;
  destroy(&body->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_spline_1d);
  const Spline1d *body = (const Spline1d *)model;
  size_t count = body->line.control_count;
  spore_nodal_place(body->line.rest, count, pose, velocity, spin, q, v);
  spore_nodal_place(body->twist.rest, arm_count(&body->twist), pose, velocity, spin, q + 3 * count, v + 3 * count);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  assert(model->type == &spore_spline_1d);
  assert(f != q && f != v);
  SPORE_KERNEL(spore_spline_force)(&line_now(model)->spline, q, shape, v, f);
  spore_spline_twist_force(twist_now(model), q, shape, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_spline_1d);
  return SPORE_KERNEL(spore_spline_potential)(&line_now(model)->spline, q) +
         spore_spline_twist_potential(twist_now(model), q);
}

static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_spline_1d);
  return spore_spline_strain(&line_now(model)->spline, q);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  return spore_spline_pattern(&line_now(model)->spline, blocks) && spore_spline_twist_pattern(twist_now(model), blocks);
}

static void stiffness(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(model->type == &spore_spline_1d);
  assert(at->stiffness_scale >= 0);
  SPORE_KERNEL(spore_spline_jacobian)(&line_now(model)->spline, at, matrix);
  spore_spline_twist_jacobian(twist_now(model), at, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  stiffness(model, &at, matrix);
}

static const char *notice(const SporeModel *model, const double *q) {
  if (((const Spline1d *)model)->changes.spent)
    return _(
        "it turns by more than most_bend between control points, and all that maximum_control_points allows are in "
        "use; raise that, or most_bend");
  if (spore_spline_twist_worst(twist_now(model), q) < 0.5 * M_PI) return NULL;
  return _("it is twisted by more than a quarter of a turn between control points, and slips where that becomes half a "
           "turn; set more control points");
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_spline_1d);
  const Spline1d *body = (const Spline1d *)model;
  return spore_spline_line_map(&body->line, body->twist.rest, points, count, cancel, model->map_slack,
                               body->changes.made != NULL, mapping, error);
}

static bool map_drawn(const SporeModel *model, const SporeTriangleMesh *mesh, SporeMapping *mapping,
                      SporeError *error) {
  const Spline1d *body = (const Spline1d *)model;
  return spore_spline_line_map_drawn(&body->line, model, body->twist.span_count > 0, mesh, mapping, error);
}

static bool samples(const SporeModel *model, double **points, size_t *count, size_t *seen) {
  const Spline1d *body = (const Spline1d *)model;
  return spore_spline_line_samples(&body->line, body->twist.rest, arm_count(&body->twist), points, count, seen);
}

static bool spheres(const SporeModel *model, SporeSphereSet *set, SporeError *error) {
  return spore_spline_line_spheres(&((const Spline1d *)model)->line, set, error);
}

static SporeSplineKnots path(const SporeModel *model) { return line_now(model)->knots; }

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_spline_1d);
  tune((Spline1d *)model, fields);
  return true;
}

static const char *doubt(const SporeModel *model) {
  if (!((const Spline1d *)model)->line.bends) return NULL;
  return _("its curve still turns by more than most_bend between knots; raise maximum_control_points or most_bend");
}

static const SporeModelAdapt adapting = {.weigh_nodes = weigh_nodes, .change_nodes = change_nodes};
static const SporeModelLine line = {.path = path, .map_drawn = map_drawn, .follow = follow};

const SporeModelType spore_spline_1d = {
    .name = "spline_1d",
    .label = N_("Spline"),
    .doc =
        N_("A smooth line along a curve, with the curve's radius: threads, vessels, tubes. It resists stretch and "
           "bending as a thin rod of its material does; what is curved at rest keeps how sharply it bends. With a "
           "twist_modulus it resists twist too, and coils up where it is twisted and slack: what holds a piece of it "
           "as long as it is from one control point to the next (a weld, or a pin of that radius, at least four radii "
           "of the line) holds it from turning. It touches other bodies with spheres along the line, unless its "
           "collision unit names other spheres: put those on the line too, since spheres off a straight line cannot "
           "follow it unless it resists twist, and spheres off a bent one follow it only while its bends change "
           "little. What is drawn around it goes with frames along the line, which turn about it with its twist; "
           "where it knows none, as little as they can."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(SplineFields)},
    .geometry = SPORE_GEOMETRY_CURVE,
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .potential = potential,
    .strain = strain,
    .map = map,
    .samples = samples,
    .pattern = pattern,
    .jacobian = jacobian,
    .stiffness = stiffness,
    .retune = retune,
    .spheres = spheres,
    .notice = notice,
    .doubt = doubt,
    .settle = settle,
    .mend = mend,
    .adapt = &adapting,
    .line = &line,
};
