/* Rigid body. q = centre of mass (3), quaternion wxyz of the body's frame (4); v = velocity of the centre of mass (3),
 * angular velocity (3), world axes. Mass, centre and inertia come from the closed surface by exact integrals. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/rigid_motion.h"
#include "models/registry.h"

typedef struct RigidBodyFields {
  double density, mass;
} RigidBodyFields;

typedef struct RigidBody {
  SporeModel base;
  double mass;      /* kg */
  SporeVec3 centre; /* of mass, body's frame, m */
  SporeInertia inertia;
} RigidBody;

static const SporeParameter parameters[] = {
    SPORE_REAL_FIELD(RigidBodyFields, density, "kg/m^3", 1e-3, 1e6, 1060, SPORE_CHANGE_REBUILD,
                     N_("Mass per volume; 1060 is soft tissue, 7900 surgical steel. Not used where mass is set.")),
    SPORE_REAL_FIELD(RigidBodyFields, mass, "kg", 0, 1e9, 0, SPORE_CHANGE_REBUILD,
                     N_("Mass of the whole body; 0 takes it from density and volume.")),
};

/* Volume, first and second moments of the solid inside a closed surface, as a sum of signed tetrahedra from `origin`:
 * with corners 0, a, b, c and s = a + b + c, det = a x b . c, the integral of x x^T is det/120 (s s^T + a a^T + b b^T +
 * c c^T) (m: symmetric-simplex quadrature, exact for quadratics). */
typedef struct Moments {
  double volume;    /* m^3 */
  SporeVec3 first;  /* m^4 */
  SporeMat3 second; /* m^5 */
} Moments;

static Moments moments_of(const SporeTriangleMesh *mesh, SporeVec3 origin) {
  Moments sum = {0};
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 corner[4] = {{0, 0, 0}};
    for (int k = 0; k < 3; k++) {
      const double *vertex = mesh->vertices + 3 * (size_t)mesh->triangles[3 * t + k];
      corner[k] = spore_vec3_sub(spore_vec3_load(vertex), origin);
      corner[3] = spore_vec3_add(corner[3], corner[k]);
    }
    double determinant = spore_vec3_dot(spore_vec3_cross(corner[0], corner[1]), corner[2]);
    sum.volume += determinant / 6;
    sum.first = spore_vec3_add_scaled(sum.first, determinant / 24, corner[3]);
    for (int k = 0; k < 4; k++)
      sum.second =
          spore_mat3_add(sum.second, spore_mat3_scale(determinant / 120, spore_mat3_outer(corner[k], corner[k])));
  }
  return sum;
}

static SporeVec3 middle_of(const SporeTriangleMesh *mesh) {
  SporeVec3 sum = {0, 0, 0};
  for (size_t i = 0; i < mesh->vertex_count; i++) sum = spore_vec3_add(sum, spore_vec3_load(mesh->vertices + 3 * i));
  return spore_vec3_scale(1.0 / (double)mesh->vertex_count, sum);
}

/* A surface that is turned inside out holds the same solid: only the signs differ. */
static bool set_inertia(RigidBody *body, const SporeTriangleMesh *mesh, const RigidBodyFields *fields,
                        SporeError *error) {
  assert(mesh->vertex_count > 0 && mesh->triangle_count > 0);
  SporeVec3 origin = middle_of(mesh);
  Moments moments = moments_of(mesh, origin);
  double sign = moments.volume < 0 ? -1 : 1, volume = fabs(moments.volume);
  double density = fields->mass > 0 ? fields->mass / volume : fields->density;
  SporeVec3 arm = spore_vec3_scale(1 / moments.volume, moments.first);
  SporeMat3 second = spore_mat3_scale(sign, moments.second);
  second = spore_mat3_sub(second, spore_mat3_scale(volume, spore_mat3_outer(arm, arm)));
  double trace = spore_mat3_trace(second);
  body->mass = density * volume;
  body->centre = spore_vec3_add(origin, arm);
  SporeMat3 tensor = spore_mat3_scale(density, spore_mat3_sub(spore_mat3_diagonal(trace, trace, trace), second));
  if (!spore_inertia_init(&body->inertia, tensor) || !(body->mass > 0))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("mass %g kg and smallest moment of inertia %g kg m^2 were found; both must be positive; "
                             "check the mesh for parts that overlap or face inward"),
                           body->mass, body->inertia.moment[0]);
  return true;
}

static void destroy(SporeModel *model) {
  RigidBody *body = (RigidBody *)model;
  spore_model_clear(&body->base);
  spore_free(body);
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  SporeMeshReport report;
  if (!spore_triangle_mesh_report_solid(geometry->surface, &report, error)) return NULL;
  RigidBody *body = SPORE_NEW(RigidBody);
  if (!body) {
    spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a rigid body"));
    return NULL;
  }
  if (!spore_model_init(&body->base, &spore_rigid_body, 1, true, error) ||
      !set_inertia(body, geometry->surface, fields, error)) {
    destroy(&body->base);
    return NULL;
  }
  body->base.block_mass[0] = body->mass;
  return &body->base;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_rigid_body);
  assert(q && v);
  const RigidBody *body = (const RigidBody *)model;
  SporeVec3 arm = spore_quat_rotate(pose.orientation, body->centre);
  spore_vec3_store(q, spore_vec3_add(pose.position, arm));
  spore_quat_store(q + 3, pose.orientation);
  spore_vec3_store(v, spore_vec3_add(velocity, spore_vec3_cross(spin, arm)));
  spore_vec3_store(v + 3, spin);
}

static SporeMat3 inertia(const SporeModel *model, const double *q) {
  assert(model->type == &spore_rigid_body);
  return spore_inertia_turned(&((const RigidBody *)model)->inertia, spore_quat_load(q + 3));
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {}
static double potential(const SporeModel *model, const double *q) { return 0; }

static void drift(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1) {
  assert(model->type == &spore_rigid_body);
  assert(isfinite(h));
  SporeQuat orientation = spore_quat_load(q + 3);
  SporeVec3 spin = spore_vec3_load(v + 3);
  spore_inertia_drift(&((const RigidBody *)model)->inertia, h, &orientation, &spin);
  for (int i = 0; i < 3; i++) q1[i] = q[i] + h * v[i], v1[i] = v[i];
  spore_quat_store(q1 + 3, orientation);
  spore_vec3_store(v1 + 3, spin);
}

static double longest_turn(const SporeModel *model, const double *q, const double *v) {
  assert(model->type == &spore_rigid_body);
  return spore_inertia_longest_drift(&((const RigidBody *)model)->inertia, spore_quat_load(q + 3),
                                     spore_vec3_load(v + 3));
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_rigid_body);
  assert(count == 0 || points);
  const RigidBody *body = (const RigidBody *)model;
  double *shifted = SPORE_NEW_ARRAY(double, 3 * count);
  if (!shifted) return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for %zu points"), count);
  for (size_t i = 0; i < count; i++)
    spore_vec3_store(shifted + 3 * i, spore_vec3_sub(spore_vec3_load(points + 3 * i), body->centre));
  bool good = spore_mapping_init_points(mapping, SPORE_MAPPING_RIGID, shifted, count, error);
  spore_free(shifted);
  return good;
}

const SporeModelType spore_rigid_body = {
    .name = "rigid_body",
    .label = N_("Rigid body"),
    .doc =
        N_("A solid that moves and turns without changing shape: instruments, bones, stones. Mass, centre and inertia "
           "are those of the closed surface filled evenly. Free turning keeps angular momentum exactly and energy "
           "without drift, also for very slender bodies."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(RigidBodyFields)},
    .geometry = SPORE_GEOMETRY_SOLID,
    .create = create,
    .destroy = destroy,
    .place = place,
    .inertia = inertia,
    .force = force,
    .potential = potential,
    .map = map,
    .drift = drift,
    .longest_turn = longest_turn,
};
