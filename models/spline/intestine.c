/* An intestine (France, Lenoir, Angelidis, Meseure, Cani, Faure and Chaillou 2005, "A layered model of a virtual human
 * intestine for surgery simulation"): an axis that moves, spheres along it that touch the world and each other, a skin
 * drawn around it. The axis is a hollow spline (models/spline/spline.h). The mesentery ties each of its control points
 * to its place at rest in the frame of a core (models/common/virtual_core.h), with the part of the line that the
 * control point stands for; or, where it has a root, to a place of that root (core/mesh/mesentery.h): then it is a
 * sheet that holds the bowel, and folds where the bowel is nearer than at rest. A pin at the core holds it in the
 * belly. */
#include <assert.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/virtual_core.h"
#include "models/registry.h"
#include "models/spline/line.h"
#include "core/mesh/mesentery.h"

typedef struct IntestineFields {
  int64_t control_points;
  double young_modulus, bending_scale, wall_thickness, density, content_density, damping;
  double mesentery_stiffness, mesentery_damping, mesentery_mass;
} IntestineFields;

typedef struct Intestine {
  SporeModel base;
  SporeSplineLine line;
  SporeVirtualCore root;
} Intestine;

static const SporeParameter parameters[] = {
    {.name = "control_points",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 4,
     .maximum = 100000,
     .initial = {30},
     .offset = offsetof(IntestineFields, control_points),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How many points the axis is led by, evenly along it; more of them bend more sharply.")},
    SPORE_REAL_FIELD(IntestineFields, young_modulus, "Pa", 1e-3, 1e13, 3e5, SPORE_CHANGE_LIVE,
                     N_("Stiffness of the wall along the bowel; 3e5 was measured on pigs (Terry et al. 2014: 307 kPa "
                        "along it where strains are small).")),
    SPORE_REAL_FIELD(IntestineFields, bending_scale, "", 0, 1e6, 0.1, SPORE_CHANGE_LIVE,
                     N_("Factor on the stiffness of the tube against bending: below 1 because a soft tube flattens "
                        "and folds where it bends.")),
    SPORE_REAL_FIELD(IntestineFields, wall_thickness, "m", 0, 1e3, 0.002, SPORE_CHANGE_REBUILD,
                     N_("Thickness of the wall, inward from the curve's radius; 0, or at least that radius: solid.")),
    SPORE_REAL_FIELD(IntestineFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume of the wall; 1060 is soft tissue.")),
    SPORE_REAL_FIELD(IntestineFields, content_density, "kg/m^3", 0, 1e6, 300, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume of what is inside: 1 is gas, 1000 fluid.")),
    SPORE_REAL_FIELD(
        IntestineFields, damping, "s", 0, 1e6, 0.02, SPORE_CHANGE_LIVE,
        N_("Time by which stretch and bending of the wall lag behind their forces: viscosity over elasticity.")),
    SPORE_REAL_FIELD(
        IntestineFields, mesentery_stiffness, "N/m^2", 0, 1e15, 300, SPORE_CHANGE_LIVE,
        N_("How strongly the mesentery draws the axis to its place at rest, or holds it by its root: force "
           "per length of the axis and distance. The intestine sags by its weight per length over this.")),
    SPORE_REAL_FIELD(IntestineFields, mesentery_damping, "s", 0, 1e3, 0.05, SPORE_CHANGE_LIVE,
                     N_("Damping of motion against the mesentery's root: this time, times the stiffness.")),
    SPORE_REAL_FIELD(IntestineFields, mesentery_mass, "kg/m", 1e-6, 1e6, 0.05, SPORE_CHANGE_REBUILD,
                     N_("Mass of the mesentery for each length of the axis; its root has it.")),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for an intestine"));
}

static void destroy(SporeModel *model) {
  Intestine *body = (Intestine *)model;
  spore_spline_line_clear(&body->line);
  spore_virtual_core_clear(&body->root);
  spore_model_clear(&body->base);
  spore_free(body);
}

static void tune(Intestine *body, const IntestineFields *fields) {
  body->line.spline.young = fields->young_modulus;
  body->line.spline.bending = fields->bending_scale;
  body->line.spline.viscous = fields->damping;
  body->root.stiffness = fields->mesentery_stiffness;
  body->root.damping = fields->mesentery_stiffness * fields->mesentery_damping;
}

static bool make_root(Intestine *body, const SporeCurve *curve, double mass_per_length, SporeError *error) {
  const SporeSplineLine *line = &body->line;
  double length = 0, radius = 0;
  if (!spore_virtual_core_allocate(&body->root, line->control_count)) return no_memory(error);
  memcpy(body->base.block_mass, line->mass, line->control_count * sizeof(double));
  memcpy(body->root.weight, line->length, line->control_count * sizeof(double));
  for (size_t i = 0; i < line->control_count; i++) length += line->length[i];
  for (size_t i = 0; i < curve->count; i++) radius += curve->points[4 * i + 3] / (double)curve->count;
  body->base.block_mass[line->control_count] = mass_per_length * length;
  return spore_virtual_core_spread(&body->root, line->rest, line->mass, mass_per_length * length, radius, error);
}

/* Ties the line to the places of the root that the mesentery reaches it from. */
static bool tie_to_root(Intestine *body, const SporeCurve *root, SporeError *error) {
  const SporeSplineLine *line = &body->line;
  if (!spore_curve_validate(root, error)) {
    spore_error_at(error, "root");
    return false;
  }
  double *feet = SPORE_NEW_ARRAY(double, 3 * line->control_count);
  bool tied = feet && spore_mesentery_spread(root, line->rest, line->length, line->control_count, feet) &&
              spore_virtual_core_slacken(&body->root, feet, line->rest);
  spore_free(feet);
  return tied || no_memory(error);
}

static bool build(Intestine *body, const SporeGeometry *geometry, const IntestineFields *fields, SporeError *error) {
  const SporeCurve *curve = geometry->curve;
  size_t count = (size_t)fields->control_points;
  SporeSplineSection section = {
      .density = fields->density, .content_density = fields->content_density, .wall_thickness = fields->wall_thickness};
  SporeSplineDensity density = {.count = count, .most = count};
  SporeBlockMatrix matrix;
  if (!spore_model_init(&body->base, &spore_intestine, count + 1, true, error) ||
      !spore_spline_line_init(&body->line, curve, &density, &section, error) ||
      !make_root(body, curve, fields->mesentery_mass, error) ||
      (geometry->root && !tie_to_root(body, geometry->root, error)))
    return false;
  if (!spore_model_matrix_create(&body->base, &matrix)) return no_memory(error);
  spore_spline_find_blocks(&body->line.spline, &matrix);
  spore_virtual_core_find_blocks(&body->root, &matrix);
  spore_block_matrix_clear(&matrix);
  tune(body, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  Intestine *body = SPORE_NEW(Intestine);
  if (!body) {
    no_memory(error);
    return NULL;
  }
  if (build(body, geometry, fields, error)) return &body->base;
  destroy(&body->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_intestine);
  const Intestine *body = (const Intestine *)model;
  spore_virtual_core_place(&body->root, body->line.rest, pose, velocity, spin, q, v);
}

static SporeMat3 inertia(const SporeModel *model, const double *q) {
  return spore_virtual_core_inertia(&((const Intestine *)model)->root, q);
}

static void drift(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1) {
  assert(model->type == &spore_intestine);
  spore_virtual_core_drift(&((const Intestine *)model)->root, q, v, h, q1, v1);
}

static double longest_turn(const SporeModel *model, const double *q, const double *v) {
  assert(model->type == &spore_intestine);
  return spore_virtual_core_longest_turn(&((const Intestine *)model)->root, q, v);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  assert(model->type == &spore_intestine);
  const Intestine *body = (const Intestine *)model;
  SPORE_KERNEL(spore_spline_force)(&body->line.spline, q, shape, v, f);
  spore_virtual_core_force(&body->root, q, shape, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_intestine);
  const Intestine *body = (const Intestine *)model;
  return SPORE_KERNEL(spore_spline_potential)(&body->line.spline, q) + spore_virtual_core_potential(&body->root, q);
}

static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_intestine);
  return spore_spline_strain(&((const Intestine *)model)->line.spline, q);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  const Intestine *body = (const Intestine *)model;
  return spore_spline_pattern(&body->line.spline, blocks) && spore_virtual_core_pattern(&body->root, blocks);
}

static void stiffness(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(model->type == &spore_intestine);
  const Intestine *body = (const Intestine *)model;
  SPORE_KERNEL(spore_spline_jacobian)(&body->line.spline, at, matrix);
  spore_virtual_core_jacobian(&body->root, at, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  stiffness(model, &at, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_intestine);
  return spore_spline_line_map(&((const Intestine *)model)->line, NULL, points, count, cancel, model->map_slack, false,
                               mapping, error);
}

static bool map_drawn(const SporeModel *model, const SporeTriangleMesh *mesh, SporeMapping *mapping,
                      SporeError *error) {
  return spore_spline_line_map_drawn(&((const Intestine *)model)->line, model, false, mesh, mapping, error);
}

static bool samples(const SporeModel *model, double **points, size_t *count, size_t *seen) {
  return spore_spline_line_samples(&((const Intestine *)model)->line, NULL, 0, points, count, seen);
}

static bool spheres(const SporeModel *model, SporeSphereSet *set, SporeError *error) {
  return spore_spline_line_spheres(&((const Intestine *)model)->line, set, error);
}

static SporeSplineKnots path(const SporeModel *model) { return ((const Intestine *)model)->line.knots; }

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_intestine);
  tune((Intestine *)model, fields);
  return true;
}

static const SporeModelLine line = {.path = path, .map_drawn = map_drawn};

const SporeModelType spore_intestine = {
    .name = "intestine",
    .label = N_("Intestine"),
    .doc =
        N_("A bowel along a curve, with the curve's radius: a hollow axis that stretches and bends, spheres along it "
           "that touch other bodies and, where the collision unit says self, each other, and a mesentery that draws "
           "it back to how it lies or, where the mechanical unit names a root, holds it at a distance from that. Pin "
           "the mesentery's frame, which is where the centre of mass is at rest, or the intestine falls with it. The "
           "wall keeps how sharply it bends and knows no twist; what is "
           "drawn of it goes with frames along the axis that turn with the mesentery."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(IntestineFields)},
    .geometry = SPORE_GEOMETRY_CURVE,
    .root = true,
    .create = create,
    .destroy = destroy,
    .place = place,
    .inertia = inertia,
    .force = force,
    .potential = potential,
    .strain = strain,
    .map = map,
    .samples = samples,
    .pattern = pattern,
    .jacobian = jacobian,
    .stiffness = stiffness,
    .drift = drift,
    .longest_turn = longest_turn,
    .retune = retune,
    .spheres = spheres,
    .line = &line,
};
