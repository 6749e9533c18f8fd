/* Mass-spring net: mass points at the vertices of a surface, springs between them. What a spring does is in
 * models/springs.c; here are the net's making and its parameters. */
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/fields.h"
#include "models/nodal.h"
#include "models/registry.h"
#include "models/springs.h"
#include "models/surface_map.h"

typedef struct NetFields {
  double surface_density, mass, structural_stiffness, shear_stiffness, bending_stiffness, damping;
} NetFields;

typedef struct Net {
  SporeModel base;
  double *rest; /* node_count x 3, body's frame */
  SporeTriangleMesh mesh;
  SporeSprings springs;
  size_t structural_end, shear_end; /* springs by kind: structural, shear, bending */
} Net;

static const SporeParameter parameters[] = {
    SPORE_REAL_FIELD(NetFields, surface_density, "kg/m^2", 1e-6, 1e6, 1.06, SPORE_CHANGE_REBUILD,
                     N_("Mass per area: density times thickness; 1.06 is 1 mm of soft tissue (1060 kg/m^3). Not used "
                        "where mass is set.")),
    SPORE_REAL_FIELD(NetFields, mass, "kg", 0, 1e9, 0, SPORE_CHANGE_REBUILD,
                     N_("Mass of the whole net; 0 takes it from surface density and area.")),
    SPORE_REAL_FIELD(NetFields, structural_stiffness, "N/m", 0, 1e15, 100, SPORE_CHANGE_LIVE,
                     N_("Stiffness of each spring along an edge.")),
    SPORE_REAL_FIELD(NetFields, shear_stiffness, "N/m", 0, 1e15, 50, SPORE_CHANGE_LIVE,
                     N_("Stiffness of each spring across the common edge of two triangles.")),
    SPORE_REAL_FIELD(NetFields, bending_stiffness, "N/m", 0, 1e15, 10, SPORE_CHANGE_LIVE,
                     N_("Stiffness of each spring that skips a vertex: resists folding.")),
    SPORE_REAL_FIELD(NetFields, damping, "N s/m", 0, 1e12, 0.01, SPORE_CHANGE_LIVE,
                     N_("Damping of each spring along its direction.")),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a mass-spring net"));
}

static void destroy(SporeModel *model) {
  Net *net = (Net *)model;
  spore_triangle_mesh_clear(&net->mesh);
  spore_springs_clear(&net->springs);
  spore_model_clear(&net->base);
  spore_free(net);
}

/* A third of each triangle's mass goes to each of its corners. */
static bool set_masses(Net *net, const NetFields *fields, SporeError *error) {
  const SporeTriangleMesh *mesh = &net->mesh;
  double total = 0, *share = net->base.block_mass;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const uint32_t *n = mesh->triangles + 3 * t;
    SporeVec3 a = spore_vec3_load(net->rest + 3 * (size_t)n[0]);
    SporeVec3 b = spore_vec3_sub(spore_vec3_load(net->rest + 3 * (size_t)n[1]), a);
    SporeVec3 c = spore_vec3_sub(spore_vec3_load(net->rest + 3 * (size_t)n[2]), a);
    double area = 0.5 * spore_vec3_length(spore_vec3_cross(b, c));
    for (int k = 0; k < 3; k++) share[n[k]] += area / 3;
    total += area;
  }
  if (!(total > 0) || !isfinite(total))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the surface has an area of %g m^2; a net needs a positive one to have mass; check unit "
                             "and mesh"),
                           total);
  double density = fields->mass > 0 ? fields->mass / total : fields->surface_density;
  for (size_t i = 0; i < net->base.block_count; i++) share[i] *= density;
  return spore_nodal_check_mass(&net->base, "triangle", error);
}

static void tune(Net *net, const NetFields *fields) {
  const double by_kind[3] = {fields->structural_stiffness, fields->shear_stiffness, fields->bending_stiffness};
  for (size_t s = 0; s < net->springs.count; s++) {
    int kind = s < net->structural_end ? 0 : s < net->shear_end ? 1 : 2;
    net->springs.stiffness[s] = by_kind[kind];
  }
  net->springs.damping = fields->damping;
}

static bool build(Net *net, const SporeTriangleMesh *mesh, const NetFields *fields, SporeError *error) {
  if (!spore_model_init(&net->base, &spore_mass_spring_net, 3 * mesh->vertex_count, mesh->vertex_count, error) ||
      !spore_triangle_mesh_copy(&net->mesh, mesh, error))
    return false;
  net->rest = net->mesh.vertices;
  if (!set_masses(net, fields, error)) return false;
  if (!spore_springs_of_triangles(&net->springs, &net->mesh, &net->structural_end, &net->shear_end))
    return no_memory(error);
  tune(net, fields);
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  const SporeTriangleMesh *mesh = geometry->surface;
  if (!mesh || mesh->triangle_count == 0) {
    spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                    _("there is no surface; a mass-spring net needs one with edges; give the body a mesh"));
    return NULL;
  }
  if (!spore_triangle_mesh_validate(mesh, error)) return NULL;
  Net *net = SPORE_NEW(Net);
  if (!net) {
    no_memory(error);
    return NULL;
  }
  if (build(net, mesh, fields, error)) return &net->base;
  destroy(&net->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  const Net *net = (const Net *)model;
  spore_nodal_place(net->rest, net->base.block_count, pose, velocity, spin, q, v);
}

static void force(const SporeModel *model, const double *q, const double *v, double *f) {
  spore_springs_force(&((const Net *)model)->springs, q, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  return spore_springs_potential(&((const Net *)model)->springs, q);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  return spore_springs_pattern(&((const Net *)model)->springs, blocks);
}

static void jacobian(const SporeModel *model, const double *q, const double *v, double stiffness_scale,
                     double damping_scale, SporeBlockMatrix *matrix) {
  spore_springs_jacobian(&((const Net *)model)->springs, q, stiffness_scale, damping_scale, matrix);
}

static bool map(const SporeModel *model, const double *points, size_t count, SporeMapping *mapping, SporeError *error) {
  return spore_surface_map(&((const Net *)model)->mesh, points, count, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  tune((Net *)model, fields);
  return true;
}

const SporeModelType spore_mass_spring_net = {
    .name = "mass_spring_net",
    .label = N_("Mass-spring net"),
    .doc =
        N_("Mass points at the vertices of a surface, tied by springs along the edges, across pairs of triangles and "
           "over every second vertex: membranes, ligaments, skins. Quick and robust; what it does depends on the mesh "
           "more than on a material. Points off a flat net cannot follow it: put spheres on it, not above it."),
    .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(NetFields)},
    .geometry = SPORE_GEOMETRY_SURFACE,
    .create = create,
    .destroy = destroy,
    .place = place,
    .mass = spore_nodal_mass,
    .force = force,
    .potential = potential,
    .map = map,
    .pattern = pattern,
    .jacobian = jacobian,
    .retune = retune,
};
