/* Solids of tetrahedra that deform as much as they like: the mesh's vertices are nodes, and where the author chooses
 * quadratic elements the middles of its edges too. What an element does is in models/tetrahedra/tetrahedra.h; here are
 * the models' making, assembly and parameters. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "models/common/nodal.h"
#include "models/common/tissues.h"
#include "models/registry.h"
#include "models/tetrahedra/cut.h"
#include "models/tetrahedra/elements.h"
#include "models/tetrahedra/heat.h"
#include "models/tetrahedra/prefactored.h"
#include "models/tetrahedra/sweep.h"
#include "models/tetrahedra/map.h"

#define LOCKS 0.45 /* Poisson's ratio above which elements of four nodes are said to be too stiff */

typedef struct TetrahedraFields {
  double young_modulus, poisson_ratio, density, mass_damping, stiffness_damping;
  double cut_reserve;
  int element;
} TetrahedraFields;

typedef enum Element { LINEAR, QUADRATIC } Element;
static const char *const elements[] = {"linear", "quadratic", NULL};

/* Kernels by level of the processor. */
typedef struct Material {
  void (*const *force)(const SporeTetrahedra *tetrahedra, size_t slab, SporeElasticity elasticity, const double *q,
                       const double *shape, const double *v, double *f);
  double (*const *potential)(const SporeTetrahedra *tetrahedra, SporeElasticity elasticity, const double *q);
  void (*const *tangent)(const SporeTetrahedra *tetrahedra, size_t slab, SporeElasticity elasticity,
                         const SporeTangent *at, SporeBlockMatrix *matrix);
} Material;

typedef struct Body {
  SporeModel base;
  const Material *material;
  SporeTetrahedronNodes nodes; /* at rest, body's frame */
  SporeTetrahedra tetrahedra;
  SporeElasticity elasticity;
  double mass_damping; /* 1/s */
  bool locks;
  SporeTetrahedraHeat heated;
  SporeTetrahedraCut cut;
  SporeTetrahedraSweep sweep; /* empty where none was asked for, as is: */
  SporePrefactored prefactored;
  double density, cut_reserve, spare_mass;
} Body;

static const SporeParameter parameters[] = {
    SPORE_TISSUE_YOUNG_MODULUS(TetrahedraFields),
    SPORE_REAL_FIELD(TetrahedraFields, poisson_ratio, "", 0, 0.49999, 0.4, SPORE_CHANGE_LIVE,
                     N_("Poisson's ratio; near 0.5 volume is kept, and linear elements become too stiff in bending.")),
    SPORE_TISSUE_DENSITY_AND_DAMPING(TetrahedraFields),
    SPORE_REAL_FIELD(TetrahedraFields, cut_reserve, "", 0, 8, 0.5, SPORE_CHANGE_REBUILD,
                     N_("Nodes that scissors can make where they part it, against those of the mesh; 0: they pass "
                        "through it. Only where the scene has scissors is room made for them.")),
    {.name = "element",
     .type = SPORE_CHOICE,
     .unit = "",
     .minimum = -HUGE_VAL,
     .maximum = HUGE_VAL,
     .choices = elements,
     .offset = offsetof(TetrahedraFields, element),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_(
         "Linear: a node at each corner; quick, and too stiff in bending where few cells lie across. Quadratic: "
         "one more on each edge, and the change of volume averaged over the element; right to a few percent with "
         "two cells across up to a Poisson's ratio of 0.49999, at ten to fifteen times the cost for the same mesh.")},
};

static bool no_memory(SporeError *error) {
  return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, _("not enough memory for a tetrahedral model"));
}

static void destroy(SporeModel *model) {
  Body *body = (Body *)model;
  spore_tetrahedron_nodes_clear(&body->nodes);
  spore_tetrahedra_clear(&body->tetrahedra);
  spore_tetrahedra_heat_clear(&body->heated);
  spore_tetrahedra_cut_clear(&body->cut);
  spore_tetrahedra_sweep_clear(&body->sweep);
  spore_prefactored_clear(&body->prefactored);
  spore_model_clear(&body->base);
  spore_free(body);
}

static bool pattern(const SporeModel *model, SporeBlockPattern *blocks) {
  const Body *body = (const Body *)model;
  if (body->cut.count) return spore_tetrahedra_cut_pattern(&body->cut, blocks);
  return spore_tetrahedron_nodes_pattern(&body->nodes, blocks);
}

static void settle(SporeModel *model, const SporeBlockMatrix *matrix) {
  Body *body = (Body *)model;
  spore_tetrahedra_find_blocks(&body->tetrahedra, matrix);
}

/* In a matrix of the pattern that the world will make too. */
static bool find_blocks(Body *body) {
  SporeBlockMatrix matrix;
  if (!spore_model_matrix_create(&body->base, &matrix)) return false;
  settle(&body->base, &matrix);
  spore_block_matrix_clear(&matrix);
  return true;
}

static void tune(Body *body, const TetrahedraFields *fields) {
  body->elasticity = spore_elasticity(fields->young_modulus, fields->poisson_ratio, fields->stiffness_damping);
  body->mass_damping = fields->mass_damping;
  body->locks = fields->poisson_ratio > LOCKS && fields->element == LINEAR;
}

static bool build(Body *body, const SporeModelType *type, const SporeGeometry *geometry, const TetrahedraFields *fields,
                  SporeError *error) {
  if (!spore_tetrahedron_nodes_create(&body->nodes, geometry->tetrahedra, fields->element == QUADRATIC,
                                      geometry->regions))
    return no_memory(error);
  if (!spore_model_init(&body->base, type, body->nodes.count, false, error)) return false;
  spore_tetrahedron_nodes_add_mass(&body->nodes, fields->density, body->base.block_mass);
  if (!spore_nodal_check_mass(&body->base, "tetrahedron", error)) return false;
  if (spore_cancel_asked(geometry->cancel)) return false;
  if (!spore_tetrahedra_create(&body->tetrahedra, &body->nodes) || !find_blocks(body)) return no_memory(error);
  body->density = fields->density;
  body->cut_reserve = fields->cut_reserve;
  tune(body, fields);
  return true;
}

static SporeModel *create(const SporeModelType *type, const Material *material, const SporeGeometry *geometry,
                          const void *fields, SporeError *error) {
  if (!spore_tetrahedra_check_mesh(geometry->tetrahedra, error)) return NULL;
  Body *body = SPORE_NEW(Body);
  if (!body) {
    no_memory(error);
    return NULL;
  }
  body->material = material;
  if (build(body, type, geometry, fields, error)) return &body->base;
  destroy(&body->base);
  return NULL;
}

static void place(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v) {
  assert(((const Body *)model)->material);
  const Body *body = (const Body *)model;
  spore_nodal_place(body->nodes.rest, body->base.block_count, pose, velocity, spin, q, v);
}

typedef struct Loop {
  const Body *body;
  const double *q, *shape, *v;
  double *f;
  const SporeTangent *at;
  SporeBlockMatrix *matrix;
  size_t odd; /* whether it goes through the odd slabs */
} Loop;

/* Through the even slabs, then through the odd ones. work: of a batch, in units of roughly 10 ns. */
static void run(Loop *loop, size_t work, void (*compute)(void *data, size_t index)) {
  const SporeTetrahedra *tetrahedra = &loop->body->tetrahedra;
  SporePool *pool = spore_pool_for(loop->body->base.pool, work * tetrahedra->batch_count / 2);
  for (loop->odd = 0; loop->odd < 2; loop->odd++)
    spore_pool_run(pool, (tetrahedra->slab_count + 1 - loop->odd) / 2, compute, loop);
}

static void add_slab_forces(void *data, size_t index) {
  const Loop *loop = data;
  const Body *body = loop->body;
  body->material->force[spore_cpu_level()](&body->tetrahedra, 2 * index + loop->odd, body->elasticity, loop->q,
                                           loop->shape, loop->v, loop->f);
}

static void force(const SporeModel *model, const double *q, const double *shape, const double *v, double *f) {
  assert(((const Body *)model)->material);
  assert(f != q && f != v);
  const Body *body = (const Body *)model;
  Loop loop = {.body = body, .q = q, .shape = shape, .v = v, .f = f};
  run(&loop, 10, add_slab_forces);
  spore_nodal_damp(model, body->mass_damping, v, f);
}

static double potential(const SporeModel *model, const double *q) {
  assert(((const Body *)model)->material);
  const Body *body = (const Body *)model;
  return body->material->potential[spore_cpu_level()](&body->tetrahedra, body->elasticity, q);
}

static double strain(const SporeModel *model, const double *q) {
  return spore_tetrahedra_strain(&((const Body *)model)->tetrahedra, q);
}

static void add_slab_tangent(void *data, size_t index) {
  const Loop *loop = data;
  const Body *body = loop->body;
  body->material->tangent[spore_cpu_level()](&body->tetrahedra, 2 * index + loop->odd, body->elasticity, loop->at,
                                             loop->matrix);
}

static void tangent(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix) {
  assert(((const Body *)model)->material);
  assert(at->stiffness_scale >= 0);
  const Body *body = (const Body *)model;
  Loop loop = {.body = body, .at = at, .matrix = matrix};
  run(&loop, 70, add_slab_tangent);
  spore_nodal_damp_jacobian(model, at->damping_scale * body->mass_damping, matrix);
}

static void jacobian(const SporeModel *model, const double *q, const double *shape, const double *v,
                     double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix) {
  SporeTangent at = {
      .q = q, .shape = shape, .v = v, .stiffness_scale = stiffness_scale, .damping_scale = damping_scale};
  tangent(model, &at, matrix);
}

static bool skin(const SporeModel *model, uint32_t **triangles, size_t *count) {
  return spore_tetrahedral_mesh_boundary(&((const Body *)model)->nodes.mesh, triangles, count);
}

static bool map(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
                SporeMapping *mapping, SporeError *error) {
  return spore_tetrahedra_map(&((const Body *)model)->nodes, points, count, cancel, mapping, error);
}

static bool retune(SporeModel *model, const void *fields, SporeError *error) {
  tune((Body *)model, fields);
  return true;
}

/* The figures are those of the reference bar, 2 cells thick (tests/stability/test_reference.c). */
static const char *doubt(const SporeModel *model) {
  if (!((const Body *)model)->locks) return NULL;
  return _("linear elements with a Poisson's ratio above 0.45 are much too stiff: a bar 2 cells thick bends by a third "
           "of what it should at 0.45, and by a twentieth at 0.499; choose element=\"quadratic\", or a Poisson's ratio "
           "of 0.45 or less");
}

static bool prepare_heat(SporeModel *model) {
  Body *body = (Body *)model;
  return body->heated.whole || spore_tetrahedra_heat_create(&body->heated, &body->tetrahedra);
}

/* What is kept of the elements for sweeps is no longer right. */
static void change(Body *body) {
  body->sweep.stale = true;
  spore_prefactored_forget(&body->prefactored);
}

static size_t coagulate(SporeModel *model, const double *q, const SporeHeat *heat) {
  assert(((const Body *)model)->heated.whole);
  Body *body = (Body *)model;
  change(body);
  return spore_tetrahedra_coagulate(&body->tetrahedra, &body->heated, q, heat);
}

/* The mass of a spare node, as a part of the mass of the body: so small that rounding hides it. */
#define SPARE_MASS 1e-18

static bool add_spares(Body *body, size_t count) {
  assert(body->base.spare_count == 0);
  SporeModel *base = &body->base;
  size_t n = body->nodes.count;
  double *masses = spore_reallocate(base->block_mass, n, n + count, sizeof *masses);
  if (masses) base->block_mass = masses;
  double *rest = spore_reallocate(body->nodes.rest, 3 * n, 3 * (n + count), sizeof *rest);
  if (rest) body->nodes.rest = rest;
  if (!masses || !rest) return false;
  body->spare_mass = SPARE_MASS * spore_model_total_mass(base);
  for (size_t i = n; i < n + count; i++) {
    masses[i] = body->spare_mass;
    memcpy(rest + 3 * i, rest, 3 * sizeof *rest);
  }
  base->node_count = base->block_count = base->block_room = n + count;
  base->q_count = base->q_room = 3 * (n + count);
  base->spare_count = count;
  return true;
}

static bool reserve(SporeModel *model, SporeError *error) {
  Body *body = (Body *)model;
  if (body->cut.count || body->cut_reserve == 0) return true;
  if (body->nodes.per_element > 4)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("scissors cannot cut quadratic elements; choose element=\"linear\", or cut_reserve=\"0\" "
                             "where they are not to cut it"));
  size_t spares = (size_t)ceil(body->cut_reserve * (double)body->nodes.count);
  bool made = spore_tetrahedra_cut_create(&body->cut, &body->nodes, &body->tetrahedra, body->density, spares) &&
              add_spares(body, spares) && find_blocks(body);
  return made || no_memory(error);
}

static size_t cut(SporeModel *model, const double *q, const double *triangle, uint32_t index, SporeCuts *cuts) {
  assert(((const Body *)model)->cut.count > 0);
  return spore_tetrahedra_cut_open(&((Body *)model)->cut, q, triangle);
}

static size_t split(SporeModel *model, double *q, double *v, const uint32_t **from) {
  assert(((const Body *)model)->cut.count > 0);
  Body *body = (Body *)model;
  size_t made = spore_tetrahedra_cut_part(&body->cut, &body->tetrahedra, model->block_mass, q, v);
  model->spare_count -= made;
  change(body);
  *from = body->cut.from + (body->cut.made - made);
  return made;
}

static const uint32_t *corners(const SporeModel *model, size_t *count) {
  const SporeTetrahedraCut *cut = &((const Body *)model)->cut;
  *count = cut->count;
  return cut->count ? cut->corner : NULL;
}

/* Spares have next to no mass again. */
static void mend(SporeModel *model) {
  Body *body = (Body *)model;
  change(body);
  spore_tetrahedra_cool(&body->tetrahedra, &body->heated);
  for (size_t i = 0; i < body->cut.made; i++) model->block_mass[body->nodes.count + i] = body->spare_mass;
  model->spare_count += body->cut.made;
  spore_tetrahedra_cut_mend(&body->cut, &body->tetrahedra, model->block_mass);
}

static SporeModel *apart(const SporeModel *model, const void *fields, uint32_t **nodes, size_t *count,
                         SporeError *error) {
  const Body *whole = (const Body *)model;
  size_t total = whole->nodes.per_element * whole->nodes.mesh.tetrahedron_count;
  Body *body = SPORE_NEW(Body);
  uint32_t *from = SPORE_NEW_ARRAY(uint32_t, total);
  if (body && from && spore_model_init(&body->base, model->type, total, false, error) &&
      spore_tetrahedron_nodes_part(&body->nodes, &whole->nodes) &&
      spore_tetrahedra_create(&body->tetrahedra, &body->nodes)) {
    body->material = whole->material;
    tune(body, fields);
    memcpy(from, whole->nodes.nodes, total * sizeof *from);
    *nodes = from;
    *count = whole->nodes.mesh.tetrahedron_count;
    return &body->base;
  }
  if (body) destroy(&body->base);
  spore_free(from);
  no_memory(error);
  return NULL;
}

static const char *notice(const SporeModel *model, const double *q) {
  if (!((const Body *)model)->cut.full) return NULL;
  return _("scissors opened more of it than it has nodes in reserve for, so that some of the cut still holds; raise "
           "cut_reserve");
}

/* A quadratic element has too many nodes. */
static bool can_sweep(const SporeModel *model) { return !((const Body *)model)->tetrahedra.middles; }

static bool prepare_sweep(SporeModel *model, const SporeCancel *cancel) {
  Body *body = (Body *)model;
  return body->tetrahedra.middles || spore_tetrahedra_sweep_create(&body->sweep, &body->tetrahedra, model->node_count);
}

/* Damping by mass takes part in the way that is left, implicitly. */
static void damp_sweep(const SporeSweep *at, size_t nodes, double coefficient) {
  double left = 1 / (1 + at->h * coefficient);
  for (size_t i = 0; coefficient > 0 && i < nodes; i++)
    for (size_t k = 0; k < 3; k++)
      at->now[4 * i + k] = at->before[3 * i + k] + left * (at->now[4 * i + k] - at->before[3 * i + k]);
}

static void sweep(SporeModel *model, const SporeSweep *at) {
  assert(model->type == &spore_neo_hookean_tetrahedra);
  Body *body = (Body *)model;
  damp_sweep(at, model->node_count, body->mass_damping);
  spore_tetrahedra_sweep(&body->sweep, &body->tetrahedra, body->elasticity, at);
}

static double sweep_part(const SporeModel *model) { return SPORE_TETRAHEDRA_SWEEP_PART; }

static bool prepare_prefactored(SporeModel *model, const SporeCancel *cancel) {
  Body *body = (Body *)model;
  SporeBlockMatrix matrix;
  if (body->tetrahedra.middles || body->prefactored.pattern.count > 0) return true;
  return spore_model_matrix_create(model, &matrix) && spore_prefactored_create(&body->prefactored, &matrix, cancel);
}

/* The matrix that stays says nothing of how far viscosity is from it in turned elements: in steps much longer than
 * stiffness_damping such a body would be thrown about. */
static bool can_move_prefactored(const SporeModel *model) {
  return can_sweep(model) && ((const Body *)model)->elasticity.viscosity == 0;
}

static double prefactored_part(const SporeModel *model) { return SPORE_PREFACTORED_PART; }

static void move_prefactored(SporeModel *model, const SporeSweep *at) {
  assert(model->type == &spore_corotational_tetrahedra);
  Body *body = (Body *)model;
  SporePrefactored *prefactored = &body->prefactored;
  const SporePrefactor *factor = spore_prefactored_find(prefactored, &body->tetrahedra, body->elasticity, at);
  damp_sweep(at, model->node_count, body->mass_damping);
  if (!factor) return; /* that is said where the step is verified */
  spore_prefactored_load(prefactored, at);
  Loop loop = {.body = body, .q = prefactored->q, .shape = prefactored->q, .v = prefactored->v, .f = prefactored->f};
  run(&loop, 10, add_slab_forces);
  spore_prefactored_move(prefactored, factor, at);
}

static const SporeModelSweep prefactored_moving = {
    .can = can_move_prefactored, .prepare = prepare_prefactored, .part = prefactored_part, .sweep = move_prefactored};
static const SporeModelSweep sweeping = {
    .can = can_sweep, .prepare = prepare_sweep, .part = sweep_part, .sweep = sweep};
static const SporeModelCut cutting = {.reserve = reserve, .cut = cut, .split = split, .corners = corners};
static const SporeModelHeat heating = {.prepare = prepare_heat, .coagulate = coagulate};

/* What the types have in common. */
#define SLOTS                                                                                                          \
  .parameters = {parameters, sizeof parameters / sizeof *parameters, sizeof(TetrahedraFields)},                        \
  .geometry = SPORE_GEOMETRY_TETRAHEDRA, .regions = true, .presets = spore_tissue_presets, .destroy = destroy,         \
  .place = place, .force = force, .potential = potential, .strain = strain, .map = map, .skin = skin, .apart = apart,  \
  .pattern = pattern, .jacobian = jacobian, .tangent = tangent, .retune = retune, .doubt = doubt, .mend = mend,        \
  .settle = settle, .cut = &cutting, .heat = &heating, .notice = notice

static SporeModel *create_corotational(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  static const Material material = {spore_corotation_force_by_level, spore_corotation_potential_by_level,
                                    spore_corotation_tangent_by_level};
  return create(&spore_corotational_tetrahedra, &material, geometry, fields, error);
}

static SporeModel *create_neo_hookean(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  static const Material material = {spore_neo_hookean_force_by_level, spore_neo_hookean_potential_by_level,
                                    spore_neo_hookean_tangent_by_level};
  return create(&spore_neo_hookean_tetrahedra, &material, geometry, fields, error);
}

static SporeModel *create_saint_venant_kirchhoff(const SporeGeometry *geometry, const void *fields, SporeError *error) {
  static const Material material = {spore_saint_venant_kirchhoff_force_by_level,
                                    spore_saint_venant_kirchhoff_potential_by_level,
                                    spore_saint_venant_kirchhoff_tangent_by_level};
  return create(&spore_saint_venant_kirchhoff_tetrahedra, &material, geometry, fields, error);
}

const SporeModelType spore_corotational_tetrahedra = {
    .name = "corotational_tetrahedra",
    .label = N_("Corotational tetrahedra"),
    .doc = N_("A solid of linear elastic tetrahedra, each in its own turned frame, so that large rotations cost "
              "nothing: the quickest for moderate strains. It comes back when it was crushed flat or a corner was "
              "pushed through; a heap of elements inside out can stay caught. With few linear elements across or a "
              "Poisson's ratio near 0.5 it bends less than it should: a bar 2 cells thick by half, 4 by a fifth."),
    .create = create_corotational,
    .sweep = &prefactored_moving,
    SLOTS,
};

const SporeModelType spore_neo_hookean_tetrahedra = {
    .name = "neo_hookean_tetrahedra",
    .label = N_("Neo-Hookean tetrahedra"),
    .doc = N_(
        "A solid of tetrahedra that stiffen as rubber and tissue do when they are squeezed, and that turn the "
        "right way out again from nearly any heap: the usual choice for organs. The same as the corotational ones for "
        "small strains; an implicit step costs somewhat more. With few linear elements across or a Poisson's "
        "ratio near 0.5 it bends less than it should: a bar 2 cells thick by half, 4 by a fifth."),
    .create = create_neo_hookean,
    .sweep = &sweeping,
    SLOTS,
};

const SporeModelType spore_saint_venant_kirchhoff_tetrahedra = {
    .name = "saint_venant_kirchhoff_tetrahedra",
    .label = N_("St Venant-Kirchhoff tetrahedra"),
    .doc = N_("A solid of tetrahedra whose stress is linear in Green's strain, as many published results have it. Good "
              "for large rotations at moderate strain; it gives way where it is squeezed to less than about half its "
              "length, and elements turned inside out can stay so: for such loads choose neo-Hookean. With few linear "
              "elements across or a Poisson's ratio near 0.5 it bends less than it should."),
    .create = create_saint_venant_kirchhoff,
    SLOTS,
};
