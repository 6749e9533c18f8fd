/* Mass-spring net: mass points at the vertices of a surface, springs between them. What a spring does is in
 * models/net/springs.c; here are the net's making and its parameters. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/fields.h"
#include "models/common/nodal.h"
#include "models/common/skin.h"
#include "models/common/surface_map.h"
#include "models/net/spring_pairs.h"
#include "models/net/ties.h"
#include "models/registry.h"

typedef struct NetFields {
  double surface_density, mass, structural_stiffness, shear_stiffness, bending_stiffness, damping, tear_strain;
} NetFields;

enum { STRUCTURAL = SPORE_NET_EDGES, SHEAR = SPORE_NET_SHEAR, BENDING = SPORE_NET_BENDING, KINDS = SPORE_NET_KINDS };

typedef struct Net {
  SporeModel base;
  double *rest; /* node_count x 3, body's frame */
  SporeTriangleMesh mesh;
  SporeSprings springs[KINDS];
  SporeNetTies ties; /* empty where nothing cuts it and it does not tear */
  double tear_strain;
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
    SPORE_REAL_FIELD(NetFields, tear_strain, "", 0, 1e6, 0, SPORE_CHANGE_REBUILD,
                     N_("Tears where an edge is longer by more than this part of its length at rest, and so does what "
                        "shears as much; a tear grows by one edge a step. 0: never.")),
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a mass-spring net"));
}

static void destroy(SporeModel *model) {
  Net *net = (Net *)model;
  spore_triangle_mesh_clear(&net->mesh);
  for (int kind = 0; kind < KINDS; kind++) spore_springs_clear(&net->springs[kind]);
  spore_net_ties_clear(&net->ties);
  spore_model_clear(&net->base);
  spore_free(net);
}

/* A third of each triangle's mass goes to each of its corners. */
static bool set_masses(Net *net, const NetFields *fields, SporeError *error) {
  double *share = net->base.block_mass, total = spore_triangle_mesh_share_area(&net->mesh, share);
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
  net->springs[STRUCTURAL].stiffness = fields->structural_stiffness;
  net->springs[SHEAR].stiffness = fields->shear_stiffness;
  net->springs[BENDING].stiffness = fields->bending_stiffness;
  for (int kind = 0; kind < KINDS; kind++) net->springs[kind].damping = fields->damping;
}

static bool make_pairs(SporePairs pairs[KINDS], const SporeTriangleMesh *mesh) {
  return spore_pairs_structural(&pairs[STRUCTURAL], mesh) &&
         spore_pairs_shear(&pairs[SHEAR], mesh, &pairs[STRUCTURAL]) &&
         spore_pairs_bending(&pairs[BENDING], mesh, &pairs[STRUCTURAL], &pairs[SHEAR]);
}

/* False: no memory, or cancelled. */
static bool make_springs(Net *net, const SporeCancel *cancel) {
  SporePairs pairs[KINDS] = {0};
  bool made = make_pairs(pairs, &net->mesh);
  for (int kind = 0; kind < KINDS; kind++) {
    made = made && !spore_cancel_asked(cancel) &&
           spore_springs_create(&net->springs[kind], pairs[kind].keys, pairs[kind].count, net->rest,
                                net->base.block_count);
    spore_pairs_clear(&pairs[kind]);
  }
  return made;
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  const Net *net = (const Net *)model;
  for (int kind = 0; kind < KINDS; kind++)
    if (!spore_springs_pattern(&net->springs[kind], blocks)) return false;
  return true;
}

/* Looks up each spring's blocks once, in a matrix of the pattern that the world will make too. */
static bool find_blocks(Net *net) {
  SporeBlockMatrix matrix;
  if (!spore_model_matrix_create(&net->base, &matrix)) return false;
  for (int kind = 0; kind < KINDS; kind++) spore_springs_find_blocks(&net->springs[kind], &matrix);
  spore_block_matrix_clear(&matrix);
  return true;
}

static bool build(Net *net, const SporeGeometry *geometry, const NetFields *fields, SporeError *error) {
  const SporeTriangleMesh *mesh = geometry->surface;
  if (!spore_model_init(&net->base, &spore_mass_spring_net, mesh->vertex_count, false, error) ||
      !spore_triangle_mesh_copy(&net->mesh, mesh, error))
    return false;
  net->rest = net->mesh.vertices;
  if (!set_masses(net, fields, error)) return false;
  if (!make_springs(net, geometry->cancel) || !find_blocks(net)) return no_memory(error);
  tune(net, fields);
  net->tear_strain = fields->tear_strain;
  net->base.tears = fields->tear_strain > 0;
  return true;
}

static SporeModel *create(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  if (!spore_nodal_check_surface(geometry->surface, error)) return NULL;
  Net *net = SPORE_NEW(Net);
  if (!net) {
    no_memory(error);
    return NULL;
  }
  if (build(net, geometry, fields, error)) return &net->base;
  destroy(&net->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(model->type == &spore_mass_spring_net);
  const Net *net = (const Net *)model;
  spore_nodal_place(net->rest, net->base.block_count, pose, velocity, spin, q, v);
}

static void force_along(const SporeModel *model, const double *q, const double *shape, const double *v, double h,
                        double *f) {
  assert(model->type == &spore_mass_spring_net);
  assert(h >= 0);
  spore_springs_force(((const Net *)model)->springs, KINDS, model->pool, q, shape, v, h, f);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  force_along(model, q, shape, v, 0, f);
}

static double potential(const SporeModel *model, const double *q) {
  assert(model->type == &spore_mass_spring_net);
  const Net *net = (const Net *)model;
  double sum = 0;
  for (int kind = 0; kind < KINDS; kind++) sum += spore_springs_potential(&net->springs[kind], q);
  return sum;
}

/* Bending springs span two edges, and say nothing that edges do not. */
static double strain(const SporeModel *model, const double *q) {
  assert(model->type == &spore_mass_spring_net);
  return spore_springs_strain(((const Net *)model)->springs, BENDING, q);
}

static void tangent(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(model->type == &spore_mass_spring_net);
  const Net *net = (const Net *)model;
  spore_springs_jacobian(net->springs, KINDS, model->pool, at, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  const SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  tangent(model, &at, matrix);
}

static bool skin(const SporeModel *model, uint32_t **triangles, size_t *count) {
  return spore_surface_skin(&((const Net *)model)->mesh, triangles, count);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  assert(model->type == &spore_mass_spring_net);
  return spore_surface_map(&((const Net *)model)->mesh, NULL, points, count, cancel, model->map_slack, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  assert(model->type == &spore_mass_spring_net);
  tune((Net *)model, fields);
  return true;
}

static bool keep_ties(Net *net) {
  return net->ties.gone || spore_net_ties_create(&net->ties, net->springs, &net->mesh);
}

static bool prepare_cut(SporeModel *model, size_t *edges) {
  Net *net = (Net *)model;
  *edges += 3 * net->mesh.triangle_count;
  return keep_ties(net);
}

static size_t cut(SporeModel *model, const double *q, const double *triangle, uint32_t body, SporeCuts *cuts) {
  assert(model->type == &spore_mass_spring_net);
  assert(((const Net *)model)->ties.gone);
  const SporeVec3 corners[3] = {spore_vec3_load(triangle), spore_vec3_load(triangle + 3),
                                spore_vec3_load(triangle + 6)};
  return spore_net_ties_cut(&((Net *)model)->ties, q, corners, body, cuts);
}

static size_t tear(SporeModel *model, const double *q, uint32_t body, SporeCuts *cuts) {
  assert(model->type == &spore_mass_spring_net);
  assert(((const Net *)model)->ties.gone);
  Net *net = (Net *)model;
  return spore_net_ties_tear(&net->ties, q, net->tear_strain, body, cuts);
}

static SporeTie tie(const SporeModel *model, uint32_t a, uint32_t b) {
  assert(a < model->block_count && b < model->block_count);
  assert(((const Net *)model)->ties.gone);
  return spore_net_ties_between(&((const Net *)model)->ties, a, b);
}

static bool prepare_heat(SporeModel *model) {
  Net *net = (Net *)model;
  bool shared = keep_ties(net);
  for (int kind = 0; kind < KINDS && shared; kind++) shared = spore_springs_share(&net->springs[kind]);
  return shared;
}

static size_t coagulate(SporeModel *model, const double *q, const SporeHeat *heat) {
  assert(((const Net *)model)->ties.gone);
  assert(heat->radius >= 0);
  Net *net = (Net *)model;
  size_t count = 0;
  for (int kind = 0; kind < KINDS; kind++)
    count += spore_springs_coagulate(&net->springs[kind], &net->ties.whole[kind], q, heat);
  return count;
}

static bool prepare_sweep(SporeModel *model, const SporeCancel *cancel) {
  Net *net = (Net *)model;
  bool ordered = true;
  for (int kind = 0; kind < KINDS && ordered; kind++)
    ordered = spore_springs_order(&net->springs[kind], model->block_count);
  return ordered;
}

static double sweep_part(const SporeModel *model) {
  return spore_springs_sweep_part(((const Net *)model)->springs, KINDS);
}

static void sweep(SporeModel *model, const SporeSweep *at) {
  assert(model->type == &spore_mass_spring_net);
  spore_springs_sweep(((Net *)model)->springs, KINDS, at);
}

static void mend(SporeModel *model) {
  Net *net = (Net *)model;
  if (net->ties.gone) spore_net_ties_mend(&net->ties);
}

static const SporeModelCut cutting = {.prepare = prepare_cut, .cut = cut, .tear = tear, .tie = tie};
static const SporeModelSweep sweeping = {.prepare = prepare_sweep, .part = sweep_part, .sweep = sweep};
static const SporeModelHeat heating = {.prepare = prepare_heat, .coagulate = coagulate};

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
    .retune = retune,
    .mend = mend,
    .cut = &cutting,
    .heat = &heating,
    .sweep = &sweeping,
};
