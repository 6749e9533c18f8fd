/* b: nets.
 *
 * Side 1 m, mass .1 kg, springs along edges and both diagonals with k = 10 / L0. SOFA's Rayleigh damping is
 * .01 M + .1 K with the whole stiffness K of the springs; ours is .01 M and, in each spring, .1 k along its direction.
 * They differ by what K has across a spring, k (1 - L0 / l), which is small where a net hangs by tension and has the
 * wrong sign, negative damping, where it is pressed. */
#include "tests/bench/sofa/cases.h"
#include "tests/bench/sofa/lattice_net.h"

static LatticeNet square(unsigned n) {
  return (LatticeNet){.columns = n,
                      .rows = n,
                      .spacing = 1.0 / (n - 1),
                      .mass = 0.1,
                      .tension = 10,
                      .mass_damping = 0.01,
                      .stiffness_damping = 0.1};
}

/* Corners 0 and n - 1 are held. */
static void build_net(Rig *rig, const Case *self) {
  LatticeNet net = square(self->size[0]);
  rig->description.solver.time_step = 0.01;
  rig_passive(rig, "net", lattice_net_new(&net), NULL);
  rig_pin(rig, 0, spore_vec3(-0.5, 0, -0.5), 1e-3);
  rig_pin(rig, 0, spore_vec3(0.5, 0, -0.5), 1e-3);
}

const Case net_cases[] = {{.name = "b1 net 20x20",
                           .build = build_net,
                           .size = {20},
                           .elements = 1482,
                           SPRING_FLOPS,
                           .sofa = "CG 25",
                           .sofa_ms = 0.341,
                           .required_ms = 0.05,
                           .steps = 200,
                           .truncated = true},
                          {.name = "b2 net 40x40",
                           .build = build_net,
                           .size = {40},
                           .elements = 6162,
                           SPRING_FLOPS,
                           .sofa = "CG 25",
                           .sofa_ms = 1.18,
                           .required_ms = 0.25,
                           .steps = 200,
                           .truncated = true},
                          {0}};
