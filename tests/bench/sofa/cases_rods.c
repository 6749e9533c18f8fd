/* e: rods.
 *
 * Length 1 m, radius .01 m, density 1000 kg/m^3, E 1e7 Pa, step .01 s, clamped at one end and level at first, no
 * damping. SOFA's are Timoshenko beams between nodes that also turn; ours is a spline with as many control points,
 * which has half as many degrees of freedom and no twist (Poisson's ratio, .3 with SOFA, matters to shear and twist
 * alone).
 *
 * SOFA's lowest y after 2 s is quoted as -0.570 m, of its direct solver. Ours differs: the rod swings, and its lowest
 * is -0.91 m with these steps, -0.85 m with implicit Euler or TR-BDF2 in steps of a sixteenth. Why is not known. */
#include <string.h>

#include "tests/bench/sofa/cases.h"

static SporeModel *rod_new(unsigned nodes) {
  double points[8] = {0, 0, 0, 0.01, 1, 0, 0, 0.01};
  SporeCurve curve = {2, points};
  SporeModel *model;
  const SporeParameterTable *table = &spore_spline_1d.parameters;
  const struct {
    const char *name;
    SporeValue value;
  } set[] = {{"control_points", {.type = SPORE_INTEGER, .number = {nodes}}},
             {"young_modulus", {.type = SPORE_REAL, .number = {1e7}}},
             {"density", {.type = SPORE_REAL, .number = {1000}}},
             {"damping", {.type = SPORE_REAL, .number = {0}}}};
  char *fields = g_malloc0(table->size);
  spore_parameters_set_initial(table, fields);
  for (size_t i = 0; i < G_N_ELEMENTS(set); i++)
    spore_parameter_store(table->parameters + spore_parameter_find(table, set[i].name), &set[i].value, fields);
  model = spore_spline_1d.create(&(SporeGeometry){.curve = &curve}, fields, NULL);
  g_assert_nonnull(model);
  g_free(fields);
  return model;
}

/* The first two control points are held: the place and the direction of the end. */
static void build_rod(Rig *rig, const Case *self) {
  unsigned nodes = self->size[0];
  rig->description.solver.time_step = 0.01;
  rig_passive(rig, "rod", rod_new(nodes), NULL);
  rig_pin(rig, 0, spore_vec3(0, 0, 0), 0.4 / (nodes - 3));
}

#define ROD(nodes, ms, required)                                                                                       \
  {                                                                                                                    \
    .name = "e rod " #nodes, .build = build_rod, .size = {nodes}, .elements = nodes - 3, SPAN_FLOPS,                   \
    .sofa = "block-tridiagonal", .sofa_ms = ms, .required_ms = required, .steps = 200, .lowest = -0.570                \
  }

const Case rod_cases[] = {ROD(21, 0.055, 0), ROD(51, 0.109, 0), ROD(101, 0.212, 0.02), {0}};
