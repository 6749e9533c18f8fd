/* Deformable surface body (Meseure and Chaillou 2000, "A deformable body model for surgical simulation"): a surface of
 * mass points and springs, and a virtual rigid core that gives it back its shape. Each node is tied to its place in the
 * core's frame by a spring of no length; what the spring pulls with acts on the core too, as force and torque, so that
 * both momenta are kept. The core touches nothing itself: the environment meets the surface, and points that lie off
 * it, which a triangle and the core's centre carry together.
 *
 * Nodes: the surface's vertices, then the core's centre; the frame is the core's. With x a node, c the centre and
 * s = R r its place in the core's frame, d = x - c - s:
 *   on the node  -k d - b (v - V - w x (x - c)),   on the core the opposite at x. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/fields.h"
#include "models/nodal.h"
#include "models/registry.h"
#include "models/rigid_motion.h"
#include "models/spring_pairs.h"
#include "models/springs.h"
#include "models/surface_map.h"

typedef struct SurfaceFields {
  double density, mass, core_share, structural_stiffness, shear_stiffness, damping, shape_stiffness, shape_damping;
} SurfaceFields;

enum { STRUCTURAL, SHEAR, KINDS };

/* Where a node's blocks lie in the model's matrix: with itself, with the centre and the turning of the core, and back.
 */
typedef struct CoreBlocks {
  uint32_t node, centre, turning, from_centre, from_turning;
} CoreBlocks;

typedef struct Surface {
  SporeModel base;
  SporeTriangleMesh mesh; /* at rest, body's frame */
  size_t count;           /* of vertices; the core's centre is the node behind them */
  SporeSprings springs[KINDS];
  double *area;     /* of each vertex: a third of its triangles', m^2 */
  double *place;    /* of each vertex in the core's frame, 3 each, m */
  SporeVec3 centre; /* of the core at rest, body's frame */
  double core_mass; /* kg */
  SporeInertia inertia;
  double stiffness, damping; /* of the ties to the core, N/m and N s/m, for each m^2 */
  CoreBlocks *blocks;
  uint32_t centre_block, turning_block, across, back; /* of the core: diagonal ones, (centre, turning), and back */
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
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a deformable surface body"));
}

static void destroy(SporeModel *model) {
  Surface *body = (Surface *)model;
  spore_triangle_mesh_clear(&body->mesh);
  for (int kind = 0; kind < KINDS; kind++) spore_springs_clear(&body->springs[kind]);
  spore_free(body->area);
  spore_free(body->place);
  spore_free(body->blocks);
  spore_model_clear(&body->base);
  spore_free(body);
}

/* Making. */

/* The core's mass is spread as the surface's is: same centre, same shape of inertia. */
static bool set_core(Surface *body, double surface_mass, SporeError *error) {
  SporeVec3 first = {0, 0, 0};
  const double *mass = body->base.block_mass;
  for (size_t i = 0; i < body->count; i++)
    first = spore_vec3_add_scaled(first, mass[i], spore_vec3_load(body->mesh.vertices + 3 * i));
  body->centre = spore_vec3_scale(1 / surface_mass, first);
  SporeMat3 tensor = spore_mat3_diagonal(0, 0, 0);
  for (size_t i = 0; i < body->count; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(body->mesh.vertices + 3 * i), body->centre);
    double square = spore_vec3_dot(arm, arm), part = mass[i] * body->core_mass / surface_mass;
    spore_vec3_store(body->place + 3 * i, arm);
    SporeMat3 turning = spore_mat3_sub(spore_mat3_diagonal(square, square, square), spore_mat3_outer(arm, arm));
    tensor = spore_mat3_add(tensor, spore_mat3_scale(part, turning));
  }
  body->base.block_mass[body->count] = body->core_mass;
  if (spore_inertia_init(&body->inertia, tensor)) return true;
  return spore_error_set(
      error, SPORE_ERROR_INPUT, NULL,
      _("the core's smallest moment of inertia is %g kg m^2; a positive one was expected; check unit "
        "and mesh"),
      body->inertia.moment[0]);
}

static bool set_masses(Surface *body, const SurfaceFields *fields, double volume, SporeError *error) {
  double total = fields->mass > 0 ? fields->mass : fields->density * fabs(volume),
         area = spore_triangle_mesh_share_area(&body->mesh, body->area);
  body->core_mass = fields->core_share * total;
  double surface_mass = total - body->core_mass;
  for (size_t i = 0; i < body->count; i++) body->base.block_mass[i] = surface_mass * body->area[i] / area;
  body->base.block_mass[body->count] = body->core_mass;
  body->base.block_mass[body->count + 1] = 1; /* while it is checked that each node has mass */
  bool good = spore_nodal_check_mass(&body->base, "triangle", error) && set_core(body, surface_mass, error);
  body->base.block_mass[body->count + 1] = 0;
  return good;
}

static void tune(Surface *body, const SurfaceFields *fields) {
  body->springs[STRUCTURAL].stiffness = fields->structural_stiffness;
  body->springs[SHEAR].stiffness = fields->shear_stiffness;
  for (int kind = 0; kind < KINDS; kind++) body->springs[kind].damping = fields->damping;
  body->stiffness = fields->shape_stiffness;
  body->damping = fields->shape_stiffness * fields->shape_damping;
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
  uint32_t centre = (uint32_t)body->count, turning = centre + 1;
  for (int kind = 0; kind < KINDS; kind++)
    if (!spore_springs_pattern(&body->springs[kind], blocks)) return false;
  for (uint32_t i = 0; i < centre; i++)
    if (!spore_block_pattern_add(blocks, i, centre) || !spore_block_pattern_add(blocks, i, turning)) return false;
  return spore_block_pattern_add(blocks, centre, turning);
}

static void find_core_blocks(Surface *body, const SporeBlockMatrix *matrix) {
  uint32_t centre = (uint32_t)body->count, turning = centre + 1;
  for (uint32_t i = 0; i < centre; i++)
    body->blocks[i] = (CoreBlocks){.node = matrix->diagonal[i],
                                   .centre = (uint32_t)spore_block_matrix_find(matrix, i, centre),
                                   .turning = (uint32_t)spore_block_matrix_find(matrix, i, turning),
                                   .from_centre = (uint32_t)spore_block_matrix_find(matrix, centre, i),
                                   .from_turning = (uint32_t)spore_block_matrix_find(matrix, turning, i)};
  body->centre_block = matrix->diagonal[centre];
  body->turning_block = matrix->diagonal[turning];
  body->across = (uint32_t)spore_block_matrix_find(matrix, centre, turning);
  body->back = (uint32_t)spore_block_matrix_find(matrix, turning, centre);
}

/* Looks up blocks once, in a matrix of the pattern that the world will make too. */
static bool find_blocks(Surface *body) {
  SporeBlockPattern blocks;
  SporeBlockMatrix matrix;
  spore_block_pattern_init(&blocks, body->base.block_count);
  bool made = pattern(&body->base, &blocks) && spore_block_matrix_create(&matrix, &blocks);
  spore_block_pattern_clear(&blocks);
  if (!made) return false;
  for (int kind = 0; kind < KINDS; kind++) spore_springs_find_blocks(&body->springs[kind], &matrix);
  find_core_blocks(body, &matrix);
  spore_block_matrix_clear(&matrix);
  return true;
}

static bool build(Surface *body, const SporeTriangleMesh *mesh, const SurfaceFields *fields, double volume,
                  SporeError *error) {
  body->count = mesh->vertex_count;
  if (!spore_model_init(&body->base, &spore_deformable_surface, body->count + 1, true, error) ||
      !spore_triangle_mesh_copy(&body->mesh, mesh, error))
    return false;
  body->area = SPORE_NEW_ARRAY(double, body->count);
  body->place = SPORE_NEW_ARRAY(double, 3 * body->count);
  body->blocks = SPORE_NEW_ARRAY(CoreBlocks, body->count);
  if (!body->area || !body->place || !body->blocks) return no_memory(error);
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

/* State. */

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  const Surface *body = (const Surface *)model;
  double centre[3];
  spore_nodal_place(body->mesh.vertices, body->count, pose, velocity, spin, q, v);
  q += 3 * body->count, v += 3 * body->count;
  spore_vec3_store(centre, body->centre);
  spore_nodal_place(centre, 1, pose, velocity, spin, q, v);
  spore_quat_store(q + 3, pose.orientation);
  spore_vec3_store(v + 3, spin);
}

static SporeMat3 inertia(const SporeModel *model, const double *q) {
  const Surface *body = (const Surface *)model;
  return spore_inertia_turned(&body->inertia, spore_quat_load(q + 3 * body->base.node_count));
}

static void drift(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1) {
  const Surface *body = (const Surface *)model;
  size_t n = 3 * body->base.node_count;
  SporeQuat orientation = spore_quat_load(q + n);
  SporeVec3 spin = spore_vec3_load(v + n);
  spore_inertia_drift(&body->inertia, h, &orientation, &spin);
  for (size_t k = 0; k < n; k++) q1[k] = q[k] + h * v[k];
  for (size_t k = 0; k < n; k++) v1[k] = v[k];
  spore_quat_store(q1 + n, orientation);
  spore_vec3_store(v1 + n, spin);
}

/* Forces. */

/* The core in a state. */
typedef struct Core {
  SporeVec3 centre;
  SporeMat3 rotation;
} Core;

static Core core_at(const Surface *body, const double *q) {
  q += 3 * body->count;
  return (Core){spore_vec3_load(q), spore_quat_to_mat3(spore_quat_load(q + 3))};
}

/* s and d of node i. */
static SporeVec3 place_of(const Surface *body, const Core *core, size_t i) {
  return spore_mat3_apply(core->rotation, spore_vec3_load(body->place + 3 * i));
}
static SporeVec3 away(const Core *core, const double *q, size_t i, SporeVec3 s) {
  return spore_vec3_sub(spore_vec3_sub(spore_vec3_load(q + 3 * i), core->centre), s);
}

static void shape_forces(const Surface *body, const double *q, double *f) {
  Core core = core_at(body, q);
  SporeVec3 force = {0, 0, 0}, torque = {0, 0, 0};
  for (size_t i = 0; i < body->count; i++) {
    SporeVec3 s = place_of(body, &core, i);
    SporeVec3 pull = spore_vec3_scale(body->stiffness * body->area[i], away(&core, q, i, s));
    spore_vec3_accumulate(f + 3 * i, spore_vec3_scale(-1, pull));
    force = spore_vec3_add(force, pull);
    torque = spore_vec3_add(torque, spore_vec3_cross(s, pull));
  }
  spore_vec3_accumulate(f + 3 * body->count, force);
  spore_vec3_accumulate(f + 3 * body->count + 3, torque);
}

static void damping_forces(const Surface *body, const double *q, const double *v, double *f) {
  SporeVec3 centre = spore_vec3_load(q + 3 * body->count);
  SporeVec3 velocity = spore_vec3_load(v + 3 * body->count), spin = spore_vec3_load(v + 3 * body->count + 3);
  SporeVec3 force = {0, 0, 0}, torque = {0, 0, 0};
  for (size_t i = 0; i < body->count; i++) {
    SporeVec3 arm = spore_vec3_sub(spore_vec3_load(q + 3 * i), centre);
    SporeVec3 carried = spore_vec3_add(velocity, spore_vec3_cross(spin, arm));
    SporeVec3 drag =
        spore_vec3_scale(body->damping * body->area[i], spore_vec3_sub(spore_vec3_load(v + 3 * i), carried));
    spore_vec3_accumulate(f + 3 * i, spore_vec3_scale(-1, drag));
    force = spore_vec3_add(force, drag);
    torque = spore_vec3_add(torque, spore_vec3_cross(arm, drag));
  }
  spore_vec3_accumulate(f + 3 * body->count, force);
  spore_vec3_accumulate(f + 3 * body->count + 3, torque);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  const Surface *body = (const Surface *)model;
  spore_springs_force(body->springs, KINDS, model->pool, q, shape, v, f);
  shape_forces(body, q, f);
  if (body->damping > 0) damping_forces(body, shape, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  const Surface *body = (const Surface *)model;
  Core core = core_at(body, q);
  double sum = 0;
  for (int kind = 0; kind < KINDS; kind++) sum += spore_springs_potential(&body->springs[kind], q);
  for (size_t i = 0; i < body->count; i++) {
    SporeVec3 d = away(&core, q, i, place_of(body, &core, i));
    sum += 0.5 * body->stiffness * body->area[i] * spore_vec3_dot(d, d);
  }
  return sum;
}

/* Jacobian. With J = (1, -1, [a]x) for (node, centre, turning), a tie of weight k adds k J^T J. */

static void add(SporeBlockMatrix *matrix, uint32_t at, double scale, const SporeMat3 *block) {
  double *values = matrix->values + 9 * (size_t)at;
  for (int k = 0; k < 9; k++) values[k] += scale * block->m[k];
}

/* What all ties together add to the core's own blocks. */
typedef struct CoreSum {
  double weight;     /* sum of k */
  SporeMat3 arm;     /* of k [a]x */
  SporeMat3 turning; /* of k [a]x^T [a]x */
} CoreSum;

static void add_tie(const Surface *body, size_t i, double k, SporeVec3 a, SporeBlockMatrix *matrix, CoreSum *sum) {
  const CoreBlocks *blocks = &body->blocks[i];
  const SporeMat3 one = spore_mat3_identity();
  SporeMat3 skew = spore_mat3_skew(a);
  add(matrix, blocks->node, k, &one);
  add(matrix, blocks->centre, -k, &one);
  add(matrix, blocks->from_centre, -k, &one);
  add(matrix, blocks->turning, k, &skew);
  add(matrix, blocks->from_turning, -k, &skew);
  sum->weight += k;
  sum->arm = spore_mat3_add(sum->arm, spore_mat3_scale(k, skew));
  sum->turning = spore_mat3_sub(sum->turning, spore_mat3_scale(k, spore_mat3_multiply(skew, skew)));
}

static void add_core(const Surface *body, const CoreSum *sum, SporeBlockMatrix *matrix) {
  const SporeMat3 one = spore_mat3_identity();
  add(matrix, body->centre_block, sum->weight, &one);
  add(matrix, body->turning_block, 1, &sum->turning);
  add(matrix, body->across, -1, &sum->arm);
  add(matrix, body->back, 1, &sum->arm);
}

/* The positive part of a symmetric matrix. */
static SporeMat3 positive_part(SporeMat3 a) {
  double values[3];
  SporeMat3 axes, part = spore_mat3_diagonal(0, 0, 0);
  spore_mat3_eigen_symmetric(a, values, &axes);
  for (int i = 0; i < 3; i++) {
    SporeVec3 axis = spore_mat3_column(axes, i);
    if (values[i] > 0) part = spore_mat3_add(part, spore_mat3_scale(values[i], spore_mat3_outer(axis, axis)));
  }
  return part;
}

/* Elastic ties; turning the core also turns the places, which adds the symmetric part of k ((d.s) 1 - s d^T). */
static void shape_jacobian(const Surface *body, const double *q, double scale, bool whole, SporeBlockMatrix *matrix) {
  Core core = core_at(body, q);
  CoreSum sum = {0};
  SporeMat3 bent = spore_mat3_diagonal(0, 0, 0);
  for (size_t i = 0; i < body->count; i++) {
    double k = scale * body->stiffness * body->area[i];
    SporeVec3 s = place_of(body, &core, i), d = away(&core, q, i, s);
    double dot = spore_vec3_dot(d, s);
    add_tie(body, i, k, s, matrix, &sum);
    SporeMat3 both = spore_mat3_add(spore_mat3_outer(s, d), spore_mat3_outer(d, s));
    bent = spore_mat3_add(bent, spore_mat3_scale(k, spore_mat3_diagonal(dot, dot, dot)));
    bent = spore_mat3_sub(bent, spore_mat3_scale(0.5 * k, both));
  }
  sum.turning = spore_mat3_add(sum.turning, whole ? bent : positive_part(bent));
  add_core(body, &sum, matrix);
}

static void damping_jacobian(const Surface *body, const double *q, double scale, SporeBlockMatrix *matrix) {
  SporeVec3 centre = spore_vec3_load(q + 3 * body->count);
  CoreSum sum = {0};
  for (size_t i = 0; i < body->count; i++)
    add_tie(body, i, scale * body->damping * body->area[i], spore_vec3_sub(spore_vec3_load(q + 3 * i), centre), matrix,
            &sum);
  add_core(body, &sum, matrix);
}

static void tangent(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  const Surface *body = (const Surface *)model;
  spore_springs_jacobian(body->springs, KINDS, model->pool, at, matrix);
  if (at->stiffness_scale != 0) shape_jacobian(body, at->q, at->stiffness_scale, at->whole, matrix);
  if (at->damping_scale != 0 && body->damping > 0) damping_jacobian(body, at->shape, at->damping_scale, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  tangent(model, &at, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, SporeMapping *mapping, SporeError *error) {
  const Surface *body = (const Surface *)model;
  return spore_surface_map(&body->mesh, &body->centre, points, count, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  tune((Surface *)model, fields);
  return true;
}

const SporeModelType spore_deformable_surface = {
    .name = "deformable_surface",
    .label = N_("Deformable surface body"),
    .doc =
        N_("A closed surface of springs around a virtual rigid core that gives it back its shape: ovaries, cysts and "
           "other plump organs, at the cost of their surface alone. Both momenta are kept. It knows no volume: how "
           "it gives way is tuned by its stiffness of shape, not by a material."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(SurfaceFields)},
    .geometry = SPORE_GEOMETRY_SOLID,
    .create = create,
    .destroy = destroy,
    .place = place,
    .inertia = inertia,
    .force = force,
    .potential = potential,
    .map = map,
    .pattern = pattern,
    .jacobian = jacobian,
    .tangent = tangent,
    .drift = drift,
    .retune = retune,
};
