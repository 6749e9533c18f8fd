/* A membrane: a tensor product of cubic B-splines with mass, stretch and bending (Qin and Terzopoulos 1996). Its nodes
 * are the control points; the mass of each is the integral of its function: the row sums of M = Mu x Mv. The world
 * takes a mass a node, by which gravity pulls and contacts weigh; the matrix itself, of which two banded solutions
 * would be the inverse, has no place there. What that costs is second order in the spacing: see /spline_2d/first-mode
 * in tests/stability/test_spline_2d.c. */
#include <assert.h>
#include <stdio.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/mesh/sheet_fit.h"
#include "core/mesh/sheet_parameters.h"
#include "models/common/fields.h"
#include "models/common/nodal.h"
#include "models/registry.h"
#include "models/spline/patch.h"

typedef struct SheetFields {
  int64_t control_points_u, control_points_v;
  double young_modulus, poisson_ratio, thickness, density, damping, smoothing;
} SheetFields;

typedef struct Spline2d {
  SporeModel base;
  double *rest; /* node_count x 3, body's frame */
  SporePatch patch;
} Spline2d;

static const SporeParameter parameters[] = {
    SPORE_INTEGER_FIELD(
        SheetFields, control_points_u, SPORE_PATCH_SPANS + 3, 200, 12, SPORE_CHANGE_REBUILD,
        N_("How many points the sheet is led by along its longer side; more of them bend more sharply.")),
    SPORE_INTEGER_FIELD(SheetFields, control_points_v, SPORE_PATCH_SPANS + 3, 200, 12, SPORE_CHANGE_REBUILD,
                        N_("How many points the sheet is led by along its shorter side.")),
    SPORE_REAL_FIELD(
        SheetFields, young_modulus, "Pa", 1e-3, 1e13, 5e4, SPORE_CHANGE_LIVE,
        N_("Stiffness of the material: stretch takes it times the thickness, bending times the cube of the "
           "thickness over 12.")),
    SPORE_REAL_FIELD(SheetFields, poisson_ratio, "", -0.9, 0.5, 0.45, SPORE_CHANGE_REBUILD,
                     N_("How much the sheet narrows when it is stretched; 0.5 keeps its volume by growing thinner.")),
    SPORE_REAL_FIELD(SheetFields, thickness, "m", 1e-7, 1e3, 1e-3, SPORE_CHANGE_REBUILD,
                     N_("Thickness of the sheet, for its mass and its stiffness.")),
    SPORE_REAL_FIELD(SheetFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume of the material; 1060 is soft tissue.")),
    SPORE_REAL_FIELD(SheetFields, damping, "s", 0, 1e6, 0.01, SPORE_CHANGE_LIVE,
                     N_("Time by which stretch and bending lag behind their forces: viscosity over elasticity.")),
    SPORE_REAL_FIELD(SheetFields, smoothing, "m", 0, 1e3, 0, SPORE_CHANGE_REBUILD,
                     N_("Length of waves of the surface that the sheet follows to half their height, and shorter waves "
                        "to less; 0: as near to the surface as its control points allow.")),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a spline"));
}

static void destroy(SporeModel *model) {
  Spline2d *sheet = (Spline2d *)model;
  spore_patch_clear(&sheet->patch);
  spore_free(sheet->rest);
  spore_model_clear(&sheet->base);
  spore_free(sheet);
}

static void tune(Spline2d *sheet, const SheetFields *fields) {
  sheet->patch.young = fields->young_modulus;
  sheet->patch.viscous = fields->damping;
}

static bool fit(Spline2d *sheet, const SporeGeometry *geometry, double smoothing, SporeError *error) {
  const SporeTriangleMesh *mesh = geometry->surface;
  const size_t span[2] = {sheet->patch.span_u, sheet->patch.span_v};
  double *at = SPORE_NEW_ARRAY(double, 2 * mesh->vertex_count);
  if (!at) return no_memory(error);
  bool good = spore_sheet_parameters(mesh, geometry->corners, at, geometry->cancel, error);
  if (good && !spore_sheet_fit(mesh, at, span, smoothing, sheet->rest)) good = no_memory(error);
  spore_free(at);
  return good;
}

static bool set_points(Spline2d *sheet, const SheetFields *fields, SporeError *error) {
  double *mass = sheet->base.block_mass;
  size_t cell = spore_patch_set_rest(&sheet->patch, sheet->rest, mass);
  if (cell != SIZE_MAX) {
    char place[64];
    snprintf(place, sizeof place, "control point %zu",
             cell / sheet->patch.span_u * (sheet->patch.span_u + 3) + cell % sheet->patch.span_u);
    return spore_error_set(error, SPORE_ERROR_INPUT, place,
                           _("the sheet turns back on itself here, and the spline has no area; a smooth sheet was "
                             "expected; smooth it or set another number of control points"));
  }
  for (size_t i = 0; i < sheet->base.block_count; i++) mass[i] *= fields->density * fields->thickness;
  return spore_nodal_check_mass(&sheet->base, "triangle", error);
}

static bool build(Spline2d *sheet, const SporeGeometry *geometry, const SheetFields *fields, SporeError *error) {
  size_t nodes_u = (size_t)fields->control_points_u, nodes_v = (size_t)fields->control_points_v;
  sheet->patch.thickness = fields->thickness, sheet->patch.poisson = fields->poisson_ratio;
  if (!spore_model_init(&sheet->base, &spore_spline_2d, nodes_u * nodes_v, false, error)) return false;
  sheet->rest = SPORE_NEW_ARRAY(double, 3 * nodes_u * nodes_v);
  if (!sheet->rest || !spore_patch_allocate(&sheet->patch, nodes_u - 3, nodes_v - 3)) return no_memory(error);
  if (!fit(sheet, geometry, fields->smoothing, error) || !set_points(sheet, fields, error)) return false;
  tune(sheet, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  if (!spore_nodal_check_surface(geometry->surface, error)) return NULL;
  Spline2d *sheet = SPORE_NEW(Spline2d);
  if (!sheet) {
    no_memory(error);
    return NULL;
  }
  if (build(sheet, geometry, fields, error)) return &sheet->base;
  destroy(&sheet->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_spline_2d);
  spore_nodal_place(((const Spline2d *)model)->rest, model->block_count, pose, velocity, spin, q, v);
}

static void force_along(const SporeModel *model, const double *q, const double *shape, const double *v, double h,
                        double *f) {
  assert(model->type == &spore_spline_2d);
  assert(h >= 0);
  SPORE_KERNEL(spore_patch_force)(&((const Spline2d *)model)->patch, q, shape, v, h, f);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  force_along(model, q, shape, v, 0, f);
}

static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_spline_2d);
  return spore_patch_strain(&((const Spline2d *)model)->patch, q);
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_spline_2d);
  return SPORE_KERNEL(spore_patch_potential)(&((const Spline2d *)model)->patch, q);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  return spore_patch_pattern(&((const Spline2d *)model)->patch, blocks);
}

static void stiffness(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(model->type == &spore_spline_2d);
  SPORE_KERNEL(spore_patch_jacobian)(&((const Spline2d *)model)->patch, at, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  stiffness(model, &at, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_spline_2d);
  const Spline2d *sheet = (const Spline2d *)model;
  return spore_patch_map(sheet->patch.span_u, sheet->patch.span_v, sheet->rest, points, count, cancel, model->map_slack,
                         mapping, error);
}

static bool samples(const SporeModel *model, double **points, size_t *count, size_t *seen) {
  const Spline2d *sheet = (const Spline2d *)model;
  bool taken = spore_patch_sample(sheet->patch.span_u, sheet->patch.span_v, sheet->rest, points, count);
  *seen = *count;
  return taken;
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_spline_2d);
  tune((Spline2d *)model, fields);
  return true;
}

const SporeModelType spore_spline_2d = {
    .name = "spline_2d",
    .label = N_("Spline sheet"),
    .doc = N_("A smooth sheet along an open surface with four corners: membranes, folds of peritoneum, ligaments. It "
              "resists stretch and bending as a thin plate of its material does, whatever the mesh, and keeps the "
              "curvature that the surface has at rest. The surface may be curved, not closed, pierced or branched. "
              "Points beside a flat sheet cannot follow it: put spheres on it, not above it."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(SheetFields)},
    .geometry = SPORE_GEOMETRY_SURFACE,
    .create = create,
    .destroy = destroy,
    .place = place,
    .force = force,
    .force_along = force_along,
    .potential = potential,
    .strain = strain,
    .map = map,
    .samples = samples,
    .pattern = pattern,
    .jacobian = jacobian,
    .stiffness = stiffness,
    .retune = retune,
};
