/* A thread or a tube: a cubic B-spline with mass, stretch and bending (Qin and Terzopoulos 1996; Lenoir et al. 2002).
 * Its nodes are the control points; the mass of each is the integral of its function. */
#include <math.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/fields.h"
#include "models/nodal.h"
#include "models/registry.h"
#include "models/spline.h"

typedef struct SplineFields {
  int64_t control_points;
  double young_modulus, density, wall_thickness, bending_scale, damping;
  bool straight_at_rest;
} SplineFields;

typedef struct Spline1d {
  SporeModel base;
  double *rest; /* node_count x 3, body's frame */
  SporeSpline spline;
} Spline1d;

static const SporeParameter parameters[] = {
    SPORE_INTEGER_FIELD(SplineFields, control_points, 4, 100000, 30, SPORE_CHANGE_REBUILD,
                        N_("How many points the line is led by, evenly along it; more of them bend more sharply.")),
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
  Spline1d *line = (Spline1d *)model;
  spore_spline_clear(&line->spline);
  spore_free(line->rest);
  spore_model_clear(&line->base);
  spore_free(line);
}

static void tune(Spline1d *line, const SplineFields *fields) {
  line->spline.young = fields->young_modulus;
  line->spline.bending = fields->bending_scale;
  line->spline.viscous = fields->damping;
}

static SporeVec3 combine(const double *control, size_t span, const double weight[4]) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t k = 0; k < 4; k++) sum = spore_vec3_add_scaled(sum, weight[k], spore_vec3_load(control + 3 * (span + k)));
  return sum;
}

/* One Gauss point, with derivatives by the length at rest: d/dS = 1/l d/du, d2/dS2 = 1/l^2 (d2/du2 - l'/l d/du).
 * Returns the length l for which it stands; 0 where the line turns back. */
static double set_point(Spline1d *line, const SporeCurve *curve, const SplineFields *fields, size_t span, int point) {
  SporeSpline *spline = &line->spline;
  double u = (double)span + 0.5 + (point ? 0.5 : -0.5) / sqrt(3);
  SporeSplineBasis basis = spore_spline_basis(spline->span_count, u, &span);
  SporeVec3 slope = combine(line->rest, span, basis.first), bend = combine(line->rest, span, basis.second);
  double speed = spore_vec3_length(slope), inverse = 1 / speed;
  double change = spore_vec3_dot(slope, bend) * inverse * inverse;
  if (!(speed > 0)) return 0;
  SporeSplineGauss *gauss = &spline->gauss[span / SPORE_LANES * SPORE_SPLINE_POINTS + (size_t)point];
  size_t lane = span % SPORE_LANES;
  double outer = spore_spline_radius(curve, spline->span_count, u), length = speed / SPORE_SPLINE_POINTS;
  double inner = fields->wall_thickness > 0 ? fmax(outer - fields->wall_thickness, 0) : 0;
  double second[4], area = M_PI * (outer * outer - inner * inner);
  for (size_t k = 0; k < 4; k++) {
    gauss->first[k][lane] = inverse * basis.first[k];
    gauss->second[k][lane] = second[k] = inverse * inverse * (basis.second[k] - change * basis.first[k]);
    line->base.block_mass[span + k] += fields->density * area * length * basis.value[k];
  }
  SporeVec3 curvature = combine(line->rest, span, second);
  gauss->area[lane] = area * length;
  gauss->inertia[lane] = 0.25 * area * (outer * outer + inner * inner) * length;
  gauss->rest[lane] = fields->straight_at_rest ? 0 : spore_vec3_dot(curvature, curvature);
  return length;
}

static bool set_points(Spline1d *line, const SporeCurve *curve, const SplineFields *fields, SporeError *error) {
  SporeSpline *spline = &line->spline;
  double whole = 0;
  for (size_t span = 0; span < spline->span_count; span++)
    for (int point = 0; point < SPORE_SPLINE_POINTS; point++) {
      double length = set_point(line, curve, fields, span, point);
      whole += length;
      if (length > 1e-6 * spore_curve_length(curve) / (double)spline->span_count) continue;
      char place[64];
      snprintf(place, sizeof place, "control point %zu", span);
      return spore_error_set(error, SPORE_ERROR_INPUT, place,
                             _("the curve turns back on itself here, and the spline has no direction; a smooth curve "
                               "was expected; smooth it or set another number of control points"));
    }
  spline->straight = 1e-2 / (whole * whole);
  for (size_t i = 0; i < SPORE_SPLINE_POINTS * spline->group_count; i++)
    for (size_t lane = 0; lane < SPORE_LANES; lane++)
      if (spline->gauss[i].rest[lane] < 1e-10 * spline->straight) spline->gauss[i].rest[lane] = 0;
  return true;
}

static bool build(Spline1d *line, const SporeCurve *curve, const SplineFields *fields, SporeError *error) {
  size_t count = (size_t)fields->control_points;
  if (!spore_model_init(&line->base, &spore_spline_1d, count, false, error)) return false;
  line->rest = SPORE_NEW_ARRAY(double, 3 * count);
  if (!line->rest || !spore_spline_allocate(&line->spline, count - 3) ||
      !spore_spline_fit(curve, count - 3, line->rest) || !spore_spline_find_blocks(&line->spline))
    return no_memory(error);
  if (!set_points(line, curve, fields, error)) return false;
  tune(line, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  const SporeCurve *curve = geometry->curve;
  if (!curve || curve->count == 0) {
    spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                    _("there is no curve; a spline follows one; give the body a curve as its geometry"));
    return NULL;
  }
  if (!spore_curve_validate(curve, error)) return NULL;
  Spline1d *line = SPORE_NEW(Spline1d);
  if (!line) {
    no_memory(error);
    return NULL;
  }
  if (build(line, curve, fields, error)) return &line->base;
  destroy(&line->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  spore_nodal_place(((const Spline1d *)model)->rest, model->block_count, pose, velocity, spin, q, v);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  SPORE_KERNEL(spore_spline_force)(&((const Spline1d *)model)->spline, q, shape, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  return SPORE_KERNEL(spore_spline_potential)(&((const Spline1d *)model)->spline, q);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  return spore_spline_pattern(&((const Spline1d *)model)->spline, blocks);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  SPORE_KERNEL(spore_spline_jacobian)
  (&((const Spline1d *)model)->spline, q, shape, stiffness_scale, damping_scale, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, SporeMapping *mapping, SporeError *error) {
  const Spline1d *line = (const Spline1d *)model;
  return spore_spline_map(line->spline.span_count, line->rest, points, count, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  tune((Spline1d *)model, fields);
  return true;
}

const SporeModelType spore_spline_1d = {
    .name = "spline_1d",
    .label = N_("Spline"),
    .doc =
        N_("A smooth line along a curve, with the curve's radius: threads, vessels, tubes. It resists stretch and "
           "bending as a thin rod of its material does, and not twist: what is curved at rest keeps how sharply it "
           "bends, but may turn freely about its own line. Put spheres on the line; points off a straight line cannot "
           "follow it, and points off a bent one follow it only while its bends change little."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(SplineFields)},
    .geometry = SPORE_GEOMETRY_CURVE,
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .potential = potential,
    .map = map,
    .pattern = pattern,
    .jacobian = jacobian,
    .retune = retune,
};
