/* The common pass for every method with every model, far from where they are at home: finite, energy bounded, the same
 * again, and what cannot be done is refused at the start or said, with the body. Each cell prints what came of it. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "tests/conformance/specimen.h"
#include "tests/stability/rig.h"

#define STEPS 25

typedef enum Load { AS_IT_COMES, STIFF, HEAVY, LIGHT, LOAD_COUNT } Load;
static const char *const load_names[] = {"as it comes", "stiffness x 1e6", "a weight of 1e6 times its mass on a spring",
                                         "a weight of 1e-6 times its mass on a spring"};

/* A type, and which kind of body it is to make. */
typedef struct Kind {
  const SporeModelType *type;
  int variant;
} Kind;

static gboolean is_stiffness(const SporeParameter *parameter) {
  static const char *const units[] = {"N/m", "Pa", "N/m^2", "N/m^3"};
  for (unsigned i = 0; i < G_N_ELEMENTS(units); i++)
    if (parameter->type == SPORE_REAL && !strcmp(parameter->unit, units[i])) return TRUE;
  return FALSE;
}

/* A small body with its stiffnesses times `factor`. */
static SporeModel *small_body(Kind of, double factor) {
  const SporeModelType *type = of.type;
  SporeTriangleMesh surface = {0};
  SporeTetrahedralMesh tetrahedra = {0};
  double ends[8] = {0, 0, 0, 0.0005, 0.02, 0, 0.02, 0.0005}; /* a thread: its spans are longer than it is thick */
  SporeCurve curve = {2, ends};
  unsigned cells = of.variant == 0 ? 2 : 1; /* other variants have more nodes an element */
  if (type->geometry == SPORE_GEOMETRY_TETRAHEDRA)
    shape_block(&tetrahedra, cells, 1, cells, spore_vec3(0.02, 0.01, 0.02));
  else if (type == &spore_spline_2d) shape_level_sheet(&surface, 4, 3, 0.01);
  else shape_block_surface(&surface, 3, 1, 1, spore_vec3(0.03, 0.02, 0.02));
  char *fields = spore_allocate(1, type->parameters.size);
  spore_parameters_set_initial(&type->parameters, fields);
  specimen_set_variant(type, of.variant, fields);
  for (size_t p = 0; p < type->parameters.count; p++) {
    const SporeParameter *parameter = &type->parameters.parameters[p];
    char *field = fields + parameter->offset;
    if (is_stiffness(parameter)) *(double *)(void *)field *= factor;
    if (!strcmp(parameter->name, "particles")) *(int64_t *)(void *)field = 40;
    if (!strcmp(parameter->name, "cells")) *(int64_t *)(void *)field = 2;
    if (g_str_has_prefix(parameter->name, "control_points"))
      *(int64_t *)(void *)field = type->geometry == SPORE_GEOMETRY_CURVE ? 8 : 6;
  }
  SporeError error = SPORE_ERROR_INIT;
  SporeModel *model = type->create(&(SporeGeometry){&surface, &tetrahedra, &curve}, fields, &error);
  if (!model) g_error("%s: %s", type->name, error.message);
  spore_free(fields);
  spore_triangle_mesh_clear(&surface);
  spore_tetrahedral_mesh_clear(&tetrahedra);
  return model;
}

/* Ties a cube of that mass below the body's far end, so that the spring is 1 cm long and stretches by 1 mm. */
static void add_weight(Rig *rig, double mass) {
  SporeTriangleMesh cube;
  shape_box(&cube, spore_vec3(0, 0, 0), spore_vec3(0.01, 0.01, 0.01));
  SporeBodyDescription *weight =
      rig_passive(rig, "weight", rig_surface_model(&spore_rigid_body, &cube, "mass", mass, NULL), NULL);
  weight->pose.position = spore_vec3(0.02, -0.02, 0.02);
  SporeLinkDescription link = {.name = "cord",
                               .type = &spore_link_spring,
                               .body_a = 0,
                               .body_b = 1,
                               .point_a = spore_vec3(0.02, 0, 0.02),
                               .point_b = spore_vec3(0.02, -0.015, 0.02),
                               .stiffness = mass * 9.81 / 1e-3,
                               .damping = 0.02 * mass * sqrt(9.81 / 1e-3),
                               .rest_length = -1};
  g_array_append_val(rig->links, link);
}

static Rig *set_up(Kind of, SporeIntegratorKind kind, double h, Load load) {
  Rig *rig = rig_new();
  SporeModel *model = small_body(of, load == STIFF ? 1e6 : 1);
  double mass = spore_model_total_mass(model);
  rig->description.gravity = spore_vec3(0, -9.81, 0);
  rig->description.solver.time_step = h;
  rig->description.solver.integrator = kind; /* the weight's */
  SporeBodyDescription *body = rig_passive(rig, "body", model, NULL);
  body->integrator = kind;
  body->velocity = spore_vec3(0.05, 0, 0.02);
  body->spin = spore_vec3(0, 1, 2);
  if (of.type->jacobian) rig_pin(rig, 0, spore_vec3(0, 0, 0), 1e-4);
  if (load == HEAVY || load == LIGHT) add_weight(rig, mass * (load == HEAVY ? 1e6 : 1e-6));
  return rig;
}

/* A static method goes from balance to balance: how fast says nothing. */
static double energy_of(const SporeWorld *world, SporeIntegratorKind kind) {
  return rig_energy(world) - (kind == SPORE_INTEGRATOR_STATIC ? spore_world_energy(world).kinetic : 0);
}

/* Runs; the greatest energy, and the hash after `marked` steps. */
static double run(SporeWorld *world, SporeIntegratorKind kind, int marked, uint64_t *hash) {
  double most = -HUGE_VAL;
  for (int i = 1; i <= STEPS; i++) {
    spore_world_step(world);
    double energy = energy_of(world, kind);
    most = isnan(energy) ? NAN : fmax(most, energy);
    if (i == marked) *hash = spore_world_hash(world);
  }
  return most;
}

/* What all bodies together can be expected to have: their weight times as far as the scene is wide or they fall. */
static double energy_scale(const SporeWorld *world, double h) {
  double mass = 0, fall = 0.5 * 9.81 * (STEPS * h) * (STEPS * h);
  for (uint32_t b = 0; b < spore_world_body_count(world); b++)
    mass += spore_model_total_mass(spore_world_body_model(world, b));
  return mass * 9.81 * (0.03 + fall) + fabs(rig_energy(world));
}

/* Part of the energy scale that may come from nothing: by methods that damp nothing where they resolve nothing as much
 * as the scene has, and until the monitor steps in as much as that lets pass (energy_watch.c). */
static double allowed_rise(SporeIntegratorKind kind, gboolean made_safer) {
  if (made_safer) return 20;
  if (kind == SPORE_INTEGRATOR_POSITION_BASED) return 0.1; /* strain that the first sweeps leave; more is told */
  return kind == SPORE_INTEGRATOR_IMPLICIT_MIDPOINT ? 1 : 0.05;
}

/* The freeze is said, though other bodies may have had their say since. */
static gboolean said_frozen(const SporeMonitor *monitor) {
  for (uint64_t i = 0; i < MIN(monitor->message_count, SPORE_MONITOR_MESSAGES); i++)
    if (strstr(monitor->messages[i].text, "frozen")) return TRUE;
  return FALSE;
}

/* Whether the program itself says that energy came from nothing. */
static gboolean energy_is_told(const SporeWorld *world) {
  for (size_t i = 0; i < spore_world_unsolved_count(world); i++)
    if (strstr(spore_world_unsolved(world, i).cause, "out of nothing")) return TRUE;
  return spore_world_monitor(world)->energy > 0 && spore_world_unsolved_count(world) > 0;
}

/* again: so many steps must come out the same a second time. */
static const char *check_cell(Rig *rig, SporeIntegratorKind kind, double h, int again, double *rise) {
  SporeWorld *world = rig->world;
  const SporeMonitor *monitor = spore_world_monitor(world);
  uint64_t first = 0;
  double scale = energy_scale(world, h), start = energy_of(world, kind);
  *rise = (run(world, kind, again, &first) - start) / scale;
  gboolean frozen = rig_any_frozen(world), mended = monitor->recoveries > 0, unsolved = monitor->not_converged > 0;
  gboolean safer = spore_world_body_made_safer(world, 0), told = energy_is_told(world);
  if (frozen || mended || unsolved) g_assert_cmpuint(monitor->message_count, >, 0);
  if (frozen) g_assert_true(said_frozen(monitor));
  if (!rig_finite(world) || isnan(*rise)) return "NOT FINITE";
  spore_world_reset(world);
  for (int i = 0; i < again; i++) spore_world_step(world);
  if (again && first != spore_world_hash(world)) return "NOT THE SAME AGAIN";
  if (*rise > allowed_rise(kind, safer)) return told ? "energy, told" : "ENERGY";
  if (safer) return "made safer";
  return frozen ? "frozen" : mended ? "mended" : unsolved ? "unsolved" : "stable";
}

static void check_model(gconstpointer data) {
  const Kind *of = data;
  const SporeModelType *type = of->type;
  static const double steps[] = {1e-5, 1e-3, 1e-2, 1e-1};
  unsigned failed = 0;
  Load loads =
      type->particles && type->particles->puff ? HEAVY : LOAD_COUNT; /* nothing can hang on smoke (test_smoke.c) */
  for (Load load = 0; load < loads; load += of->variant ? HEAVY : 1) /* of a variant, every other load */
    for (SporeIntegratorKind kind = 0; kind < SPORE_INTEGRATOR_COUNT; kind++) {
      GString *line = g_string_new(NULL);
      const int again = load == AS_IT_COMES ? STEPS : tests_sanitized ? 0 : STEPS / 4;
      for (unsigned i = tests_sanitized; i < G_N_ELEMENTS(steps); i += tests_sanitized ? 2 : 1) { /* or every other */
        Rig *rig = set_up(*of, kind, steps[i], load);
        SporeError error = SPORE_ERROR_INIT;
        double rise = 0;
        const char *verdict = "refused";
        if (rig_try_build(rig, &error)) verdict = check_cell(rig, kind, steps[i], again, &rise);
        else {
          g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
          g_assert_true(g_str_has_prefix(error.place, "bodies/"));
        }
        const char *limit = strstr(error.message, "at most ");
        if (limit)
          g_string_append_printf(line, "  %g s: refused above %.3g s", steps[i], g_ascii_strtod(limit + 8, NULL));
        else g_string_append_printf(line, "  %g s: %s %+.0e", steps[i], verdict, rise);
        failed += g_ascii_isupper(verdict[0]);
        rig_free(rig);
      }
      g_test_message("%s %s, %s, %s:%s", type->name, specimen_variant(type, of->variant), load_names[load],
                     spore_integrator_names[kind], line->str);
      g_string_free(line, TRUE);
    }
  g_assert_cmpuint(failed, ==, 0);
}

/* PART PARTS: of all kinds, one in PARTS, so that they can be run side by side. */
int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  if (argc != 3) g_error("expected PART PARTS");
  unsigned part = (unsigned)atoi(argv[1]), parts = (unsigned)atoi(argv[2]), kinds = 0;
  for (SporeModelRegistry type = spore_model_registry; *type; type++)
    for (Kind of = {*type, 0}; specimen_variant(*type, of.variant); of.variant++) {
      if (kinds++ % parts != part) continue;
      const char *variant = specimen_variant(*type, of.variant);
      char *path = g_strdup_printf("/stability/common_pass/%s%s%s", (*type)->name, *variant ? "/" : "", variant);
      g_test_add_data_func_full(path, g_memdup2(&of, sizeof of), check_model, g_free);
      g_free(path);
    }
  return g_test_run();
}
