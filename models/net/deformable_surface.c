/* Deformable surface body (Meseure and Chaillou 2000, "A deformable body model for surgical simulation"): a surface of
 * mass points and springs, and a virtual rigid core that gives the surface back its shape
 * (models/common/virtual_core.h). The core touches nothing. The environment touches the surface, and points off the
 * surface, which follow a triangle and the core's centre. Nodes: the vertices of the surface, then the core's centre;
 * the frame is the frame of the core. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/nodal.h"
#include "models/common/skin.h"
#include "models/common/surface_map.h"
#include "models/common/virtual_core.h"
#include "models/net/spring_pairs.h"
#include "models/net/springs.h"
#include "models/net/volume.h"
#include "models/registry.h"

typedef struct SurfaceFields {
  double density, mass, core_share, structural_stiffness, shear_stiffness, damping, shape_stiffness, shape_damping,
      volume_stiffness;
} SurfaceFields;

enum { STRUCTURAL, SHEAR, KINDS };

typedef struct Surface {
  SporeModel base;
  SporeTriangleMesh mesh; /* at rest, body's frame */
  size_t count;           /* of vertices; the core's centre is the node behind them */
  SporeSprings springs[KINDS];
  SporeVolume volume;
  SporeVirtualCore core; /* ties weighted by area: a third of the triangles of each vertex, m^2 */
} Surface;

static const SporeParameter parameters[] = {
    SPORE_REAL_FIELD(SurfaceFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume; 1060 is soft tissue. Not used where mass is set.")),
    SPORE_REAL_FIELD(SurfaceFields, mass, "kg", 0, 1e9, 0, SPORE_CHANGE_REBUILD,
                     N_("Mass of the whole body; 0 takes it from density and volume.")),
    SPORE_REAL_FIELD(SurfaceFields, core_share, "", 0.01, 0.99, 0.5, SPORE_CHANGE_REBUILD,
                     N_("Part of the mass that the core has; the rest is spread over the surface.")),
    SPORE_REAL_FIELD(SurfaceFields, structural_stiffness, "N/m", 0, 1e15, 50, SPORE_CHANGE_LIVE,
                     N_("Stiffness of each spring along an edge.")),
    SPORE_REAL_FIELD(SurfaceFields, shear_stiffness, "N/m", 0, 1e15, 25, SPORE_CHANGE_LIVE,
                     N_("Stiffness of each spring across the common edge of two triangles.")),
    SPORE_REAL_FIELD(SurfaceFields, damping, "N s/m", 0, 1e12, 0.01, SPORE_CHANGE_LIVE,
                     N_("Damping of each spring along its direction.")),
    SPORE_REAL_FIELD(SurfaceFields, shape_stiffness, "N/m^3", 0, 1e15, 2e5, SPORE_CHANGE_LIVE,
                     N_("How strongly the surface is drawn to its shape at rest: force per area and distance.")),
    SPORE_REAL_FIELD(SurfaceFields, shape_damping, "s", 0, 1e3, 0.02, SPORE_CHANGE_LIVE,
                     N_("Damping of motion against the shape at rest: this time, times the stiffness of the shape.")),
    SPORE_REAL_FIELD(SurfaceFields, volume_stiffness, "Pa", 0, 1e12, 0, SPORE_CHANGE_LIVE,
                     N_("Bulk modulus: the volume inside is kept by a pressure of this times the part of it that is "
                        "missing. A ball squeezed by a quarter of its height, which loses 13 % without, loses 0.1 % "
                        "with 1e6. 0: not at all.")),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a deformable surface body"));
}

static void destroy(SporeModel *model) {
  Surface *body = (Surface *)model;
  spore_triangle_mesh_clear(&body->mesh);
  for (int kind = 0; kind < KINDS; kind++) spore_springs_clear(&body->springs[kind]);
  spore_virtual_core_clear(&body->core);
  spore_volume_clear(&body->volume);
  spore_model_clear(&body->base);
  spore_free(body);
}

/* Making. */

static bool set_masses(Surface *body, const SurfaceFields *fields, double volume, SporeError *error) {
  double total = fields->mass > 0 ? fields->mass : fields->density * fabs(volume),
         area = spore_triangle_mesh_share_area(&body->mesh, body->core.weight);
  double core_mass = fields->core_share * total, surface_mass = total - core_mass;
  for (size_t i = 0; i < body->count; i++) body->base.block_mass[i] = surface_mass * body->core.weight[i] / area;
  body->base.block_mass[body->count] = core_mass;
  body->base.block_mass[body->count + 1] = 1; /* while it is checked that each node has mass */
  bool good = spore_nodal_check_mass(&body->base, "triangle", error) &&
              spore_virtual_core_spread(&body->core, body->mesh.vertices, body->base.block_mass, core_mass, 0, error);
  body->base.block_mass[body->count + 1] = 0;
  return good;
}

static void tune(Surface *body, const SurfaceFields *fields) {
  body->springs[STRUCTURAL].stiffness = fields->structural_stiffness;
  body->springs[SHEAR].stiffness = fields->shear_stiffness;
  for (int kind = 0; kind < KINDS; kind++) body->springs[kind].damping = fields->damping;
  body->core.stiffness = fields->shape_stiffness;
  body->volume.stiffness = fields->volume_stiffness;
  body->core.damping = fields->shape_stiffness * fields->shape_damping;
}

static bool make_springs(Surface *body) {
  SporePairs pairs[KINDS] = {0};
  bool made = spore_pairs_structural(&pairs[STRUCTURAL], &body->mesh) &&
              spore_pairs_shear(&pairs[SHEAR], &body->mesh, &pairs[STRUCTURAL]);
  for (int kind = 0; kind < KINDS; kind++) {
    made = made && spore_springs_create(&body->springs[kind], pairs[kind].keys, pairs[kind].count, body->mesh.vertices,
                                        body->count);
    spore_pairs_clear(&pairs[kind]);
  }
  return made;
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  const Surface *body = (const Surface *)model;
  for (int kind = 0; kind < KINDS; kind++)
    if (!spore_springs_pattern(&body->springs[kind], blocks)) return false;
  return spore_volume_pattern(&body->volume, blocks) && spore_virtual_core_pattern(&body->core, blocks);
}

/* Looks up blocks once, in a matrix of the pattern that the world will make too. */
static bool find_blocks(Surface *body) {
  SporeBlockMatrix matrix;
  if (!spore_model_matrix_create(&body->base, &matrix)) return false;
  for (int kind = 0; kind < KINDS; kind++) spore_springs_find_blocks(&body->springs[kind], &matrix);
  spore_virtual_core_find_blocks(&body->core, &matrix);
  spore_volume_find_blocks(&body->volume, &matrix);
  spore_block_matrix_clear(&matrix);
  return true;
}

static bool build(Surface *body, const SporeTriangleMesh *mesh, const SurfaceFields *fields, double volume,
                  SporeError *error) {
  body->count = mesh->vertex_count;
  if (!spore_model_init(&body->base, &spore_deformable_surface, body->count + 1, true, error) ||
      !spore_triangle_mesh_copy(&body->mesh, mesh, error))
    return false;
  if (!spore_virtual_core_allocate(&body->core, body->count) || !spore_volume_create(&body->volume, &body->mesh))
    return no_memory(error);
  if (!set_masses(body, fields, volume, error)) return false;
  if (!make_springs(body) || !find_blocks(body)) return no_memory(error);
  tune(body, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  SporeMeshReport report;
  if (!spore_triangle_mesh_report_solid(geometry->surface, &report, error)) return NULL;
  Surface *body = SPORE_NEW(Surface);
  if (!body) {
    no_memory(error);
    return NULL;
  }
  if (build(body, geometry->surface, fields, report.volume, error)) return &body->base;
  destroy(&body->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_deformable_surface);
  const Surface *body = (const Surface *)model;
  spore_virtual_core_place(&body->core, body->mesh.vertices, pose, velocity, spin, q, v);
}

static SporeMat3 inertia(const SporeModel *model, const double *q) {
  return spore_virtual_core_inertia(&((const Surface *)model)->core, q);
}

static void drift(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1) {
  assert(model->type == &spore_deformable_surface);
  spore_virtual_core_drift(&((const Surface *)model)->core, q, v, h, q1, v1);
}

static double longest_turn(const SporeModel *model, const double *q, const double *v) {
  assert(model->type == &spore_deformable_surface);
  return spore_virtual_core_longest_turn(&((const Surface *)model)->core, q, v);
}

static void force_along(const SporeModel *model, const double *q, const double *shape, const double *v, double h,
                        double *f) {
  assert(model->type == &spore_deformable_surface);
  assert(h >= 0);
  const Surface *body = (const Surface *)model;
  spore_springs_force(body->springs, KINDS, model->pool, q, shape, v, h, f);
  spore_virtual_core_force(&body->core, q, shape, v, f);
  spore_volume_force(&body->volume, q, f);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  force_along(model, q, shape, v, 0, f);
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_deformable_surface);
  const Surface *body = (const Surface *)model;
  double sum = spore_virtual_core_potential(&body->core, q) + spore_volume_potential(&body->volume, q);
  for (int kind = 0; kind < KINDS; kind++) sum += spore_springs_potential(&body->springs[kind], q);
  return sum;
}

static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_deformable_surface);
  return spore_springs_strain(((const Surface *)model)->springs, KINDS, q);
}

static void tangent(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(model->type == &spore_deformable_surface);
  const Surface *body = (const Surface *)model;
  spore_springs_jacobian(body->springs, KINDS, model->pool, at, matrix);
  spore_virtual_core_jacobian(&body->core, at, matrix);
  spore_volume_jacobian(&body->volume, at, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  tangent(model, &at, matrix);
}

static bool skin(const SporeModel *model, uint32_t **triangles, size_t *count) {
  return spore_surface_skin(&((const Surface *)model)->mesh, triangles, count);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_deformable_surface);
  const Surface *body = (const Surface *)model;
  return spore_surface_map(&body->mesh, &body->core.centre, points, count, cancel, model->map_slack, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_deformable_surface);
  tune((Surface *)model, fields);
  return true;
}

const SporeModelType spore_deformable_surface = {
    .name = "deformable_surface",
    .label = N_("Deformable surface body"),
    .doc =
        N_("A closed surface of springs around a virtual rigid core that gives it back its shape: ovaries, cysts and "
           "other plump organs, at the cost of their surface alone. Both momenta are kept. How it gives "
           "way is tuned by its stiffness of shape, not by a material; its volume is kept where volume_stiffness "
           "says so."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(SurfaceFields)},
    .geometry = SPORE_GEOMETRY_SOLID,
    .create = create,
    .destroy = destroy,
    .place = place,
    .inertia = inertia,
    .force = force,
    .force_along = force_along,
    .potential = potential,
    .strain = strain,
    .map = map,
    .skin = skin,
    .pattern = pattern,
    .jacobian = jacobian,
    .tangent = tangent,
    .stiffness = tangent,
    .drift = drift,
    .longest_turn = longest_turn,
    .retune = retune,
};
