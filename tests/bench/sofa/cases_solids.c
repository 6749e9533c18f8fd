/* a: tetrahedra.
 *
 * SOFA's force is the corotational one ("large"), its damping matrix alpha M + beta K of the whole body, K the turned
 * linear stiffness. Ours: mass_damping = alpha; stiffness_damping = beta puts beta times the stress of the strain rate
 * into each element, which is beta K v for the same turned K. Mass: SOFA's uniform or lumped mass is our lumped one. */
#include <math.h>

#include "tests/bench/sofa/cases.h"

static const double organ_size[3] = {6, 5, 3};
static const unsigned organ_cells[3] = {5, 5, 4};

/* Takes the lattice's cube to something round: halfway to a ball, with two dents. */
static void bulge(double *x) {
  double p[3], square = 0, most = 0;
  for (int k = 0; k < 3; k++) {
    p[k] = 2 * x[k] / organ_size[k] - 1;
    square += p[k] * p[k];
    most = fmax(most, fabs(p[k]));
  }
  double shrink = square > 0 ? 0.35 + 0.65 * most / sqrt(square) : 1;
  shrink *= 1 + 0.08 * sin(3 * p[0]) * cos(2 * p[1]);
  for (int k = 0; k < 3; k++) x[k] = 0.5 * organ_size[k] * shrink * p[k];
}

void organ_mesh(SporeTetrahedralMesh *mesh) {
  shape_block(mesh, organ_cells[0], organ_cells[1], organ_cells[2],
              spore_vec3(organ_size[0], organ_size[1], organ_size[2]));
  for (size_t i = 0; i < mesh->vertex_count; i++) bulge(mesh->vertices + 3 * i);
}

SporeModel *organ_model(void) {
  SporeTetrahedralMesh mesh;
  organ_mesh(&mesh);
  return rig_tetrahedra_model(&mesh, "density", 1., "young_modulus", 3000., "poisson_ratio", 0.3, "mass_damping", 0.1,
                              "stiffness_damping", 0.1, NULL);
}

/* Three nodes are held, near each other as SOFA's 3, 39 and 64 are. */
static void build_organ(Rig *rig, const Case *self) {
  SporeTetrahedralMesh mesh;
  organ_mesh(&mesh);
  const unsigned held[3] = {2, 7, 27}; /* (0,0,2), (0,1,2), (1,0,2) of the lattice */
  rig->description.solver.time_step = 0.02;
  rig_passive(rig, "organ", organ_model(), NULL);
  for (int i = 0; i < 3; i++) rig_pin(rig, 0, spore_vec3_load(mesh.vertices + 3 * held[i]), 1e-3);
  spore_tetrahedral_mesh_clear(&mesh);
}

/* .2 x .2 x 1 m; density 1000 makes 40 kg. The plane z = 0 is held: by a ball so large that it cuts off no more. */
static void build_bar(Rig *rig, const Case *self) {
  SporeTetrahedralMesh mesh;
  shape_block(&mesh, self->size[0], self->size[1], self->size[2], spore_vec3(0.2, 0.2, 1));
  SporeModel *model = rig_tetrahedra_model(&mesh, "density", 1000., "young_modulus", 1e5, "poisson_ratio", 0.45,
                                           "mass_damping", 0.01, "stiffness_damping", 0.01, NULL);
  rig->description.solver.time_step = 0.01;
  rig_passive(rig, "bar", model, NULL);
  rig_pin(rig, 0, spore_vec3(0.1, 0.1, -10), 10.005);
}

const Case solid_cases[] = {{.name = "a1 organ, 180 nodes, 600 tetrahedra",
                             .elements = 600,
                             TETRAHEDRON_FLOPS,
                             .build = build_organ,
                             .sofa = "181 nodes, 596 tetrahedra, CG 25",
                             .sofa_ms = 0.653,
                             .required_ms = 0.05,
                             .steps = 100,
                             .truncated = true},
                            {.name = "a8 bar, 936 nodes, 3750 tetrahedra",
                             .elements = 3750,
                             TETRAHEDRON_FLOPS,
                             .build = build_bar,
                             .size = {5, 5, 25},
                             .sofa = "CG 25",
                             .sofa_ms = 3.94,
                             .steps = 100,
                             .truncated = true},
                            {.name = "a8 bar, 3321 nodes, 15360 tetrahedra",
                             .elements = 15360,
                             TETRAHEDRON_FLOPS,
                             .build = build_bar,
                             .size = {8, 8, 40},
                             .sofa = "CG 25",
                             .sofa_ms = 17.2,
                             .required_ms = 4,
                             .steps = 40,
                             .truncated = true},
                            {0}};
