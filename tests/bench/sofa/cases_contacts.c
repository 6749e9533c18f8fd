/* c, r, d, f: spheres that touch.
 *
 * SOFA's contacts are springs without friction between spheres, made by whichever broad phase is named; its planes are
 * force fields. Ours are springs with damping, friction 0 here for the same physics; a plane is a sphere of 1 km, flat
 * to 0.1 mm over these scenes. Where SOFA's stiffness is not known, ours makes a body at rest sink in by about 1% of a
 * radius. SOFA's loose spheres are points of three degrees of freedom; ours are both those and rigid bodies of six, in
 * a box wide enough for as many contacts between spheres as SOFA reports, about 1900 among 2000; planes come on top. */
#include <math.h>

#include "tests/bench/sofa/cases.h"
#include "tests/bench/sofa/lattice_net.h"

#define PLANE_RADIUS 1000.

static void set_contact(SporeContactFields *contact, double stiffness, double damping, bool self) {
  *contact = (SporeContactFields){.stiffness = stiffness, .damping = damping, .friction = 0, .self = self};
}

/* The half space behind `point`, which it meets with the inward unit `normal`. */
static void add_plane(Rig *rig, SporeVec3 point, SporeVec3 normal, double stiffness, double damping) {
  double centre[3];
  spore_vec3_store(centre, spore_vec3_add_scaled(point, -PLANE_RADIUS, normal));
  char *name = g_strdup_printf("plane%u", rig->bodies->len);
  set_contact(&rig_unmovable(rig, g_intern_string(name), rig_spheres(rig, centre, 1, PLANE_RADIUS))->contact, stiffness,
              damping, false);
  g_free(name);
}

/* c, r: 34 spheres on 400 of a floor. */

enum { ORGAN_SPHERES = 34 };
static const double organ_radius = 0.6, organ_height = 1.7; /* m */

/* Every fifth node or so, lowest layer first: spread over the organ's inside and underside. */
static const SporeSphereSet *organ_spheres(Rig *rig) {
  SporeTetrahedralMesh mesh;
  organ_mesh(&mesh);
  double points[3 * ORGAN_SPHERES];
  for (int i = 0; i < ORGAN_SPHERES; i++) {
    const double *vertex = mesh.vertices + 3 * (size_t)(2 + 5 * i);
    spore_vec3_store(points + 3 * i, spore_vec3_load(vertex));
  }
  spore_tetrahedral_mesh_clear(&mesh);
  return rig_spheres(rig, points, ORGAN_SPHERES, organ_radius);
}

static void add_floor(Rig *rig) {
  set_contact(&rig_unmovable(rig, "floor", rig_floor(rig, 20, 20, 0.6, 0.5))->contact, 2e4, 200, false);
}

/* The organ lies on its broad side. */
static SporeQuat lying(void) { return spore_quat_from_rotation_vector(spore_vec3(0.5 * G_PI, 0, 0)); }

static void build_free_organ(Rig *rig, const Case *self) {
  rig->description.solver.time_step = 0.02;
  bool collides = self->size[0] > 0;
  if (collides) add_floor(rig);
  SporeBodyDescription *body = rig_passive(rig, "organ", organ_model(), collides ? organ_spheres(rig) : NULL);
  body->pose = (SporePose){{0, organ_height, 0}, lying()};
  set_contact(&body->contact, 2e4, 200, false);
}

static void build_rigid_organ(Rig *rig, const Case *self) {
  rig->description.solver.time_step = 0.02;
  add_floor(rig);
  SporeTriangleMesh box;
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(5, 4, 2.4));
  SporeModel *model = rig_surface_model(&spore_rigid_body, &box, "density", 1., NULL);
  SporeBodyDescription *body = rig_passive(rig, "organ", model, organ_spheres(rig));
  body->pose = (SporePose){{0, organ_height, 0}, lying()};
  set_contact(&body->contact, 2e4, 200, false);
}

/* d: a sheet folded in half, falling on itself and on the floor. */

static void fold(const LatticeNet *net, unsigned column, unsigned row, double *x) {
  double middle = 0.5 * (net->rows - 1), along = (row - middle) * net->spacing, gap = 0.9 * net->spacing;
  double arc = 0.5 * gap * G_PI, y, z;
  if (fabs(along) < 0.5 * arc) {
    double turn = 2 * along / gap;
    z = 0.5 * gap * cos(turn);
    y = 0.5 * gap * sin(turn);
  } else {
    z = 0.5 * arc - fabs(along);
    y = along > 0 ? 0.5 * gap : -0.5 * gap;
  }
  spore_vec3_store(x, spore_vec3((column - 0.5 * (net->columns - 1)) * net->spacing, y, z));
}

static void build_sheet(Rig *rig, const Case *self) {
  double spacing = 1.0 / (self->size[0] - 1), radius = 0.4 * spacing;
  LatticeNet net = {.columns = self->size[0],
                    .rows = self->size[1],
                    .spacing = spacing,
                    .mass = 0.1,
                    .tension = 10,
                    .mass_damping = 0.01,
                    .stiffness_damping = 0.1,
                    .start = fold};
  size_t count = (size_t)net.columns * net.rows;
  double *points = g_new(double, 3 * count), stiffness = 200 * 0.1 * 9.81 / (double)count / (0.01 * radius);
  lattice_net_points(&net, points);
  rig->description.solver.time_step = 0.005;
  add_plane(rig, spore_vec3(0, -0.46 * spacing - radius, 0), spore_vec3(0, 1, 0), stiffness, 0.01 * stiffness);
  SporeBodyDescription *sheet =
      rig_passive(rig, "sheet", lattice_net_new(&net), rig_spheres(rig, points, count, radius));
  set_contact(&sheet->contact, stiffness, 0.01 * stiffness, true);
  g_free(points);
}

/* f: loose spheres of 0.1 m and 0.1 kg in a box of five planes. */

/* Loose points are one body: they must start so far apart that no pair counts as touching at rest. */
static const double ball_radius = 0.1, ball_spacing = 0.26, ball_mass = 0.1, ball_stiffness = 2000, ball_damping = 10;

static void add_box(Rig *rig, double half) {
  add_plane(rig, spore_vec3(0, 0, 0), spore_vec3(0, 1, 0), ball_stiffness, ball_damping);
  for (int side = 0; side < 4; side++) {
    double x = side == 0 ? 1 : side == 1 ? -1 : 0, z = side == 2 ? 1 : side == 3 ? -1 : 0;
    add_plane(rig, spore_vec3(-half * x, 0, -half * z), spore_vec3(x, 0, z), ball_stiffness, ball_damping);
  }
}

/* Layers of n x n, each next one shifted, all a little off their lattice. */
static double *ball_points(unsigned n, unsigned count) {
  GRand *random = g_rand_new_with_seed(7);
  double *points = g_new(double, 3 * (size_t)count), spacing = ball_spacing;
  for (unsigned i = 0; i < count; i++) {
    unsigned layer = i / (n * n), column = i % n, row = i / n % n;
    SporeVec3 place = {(column - 0.5 * n + 0.25 + 0.5 * (layer % 2)) * spacing, ball_radius + layer * spacing,
                       (row - 0.5 * n + 0.25 + 0.5 * (layer % 2)) * spacing};
    spore_vec3_store(points + 3 * (size_t)i, spore_vec3_add(place, shape_random_vector(random, 0.02 * spacing)));
  }
  g_rand_free(random);
  return points;
}

/* A cube with a solid ball's moment of inertia. */
static SporeModel *ball_model(void) {
  SporeTriangleMesh box;
  double side = ball_radius * sqrt(2.4);
  shape_box(&box, spore_vec3(0, 0, 0), spore_vec3(side, side, side));
  return rig_surface_model(&spore_rigid_body, &box, "mass", ball_mass, NULL);
}

static void build_rigid_pile(Rig *rig, const Case *self) {
  unsigned n = self->size[0], count = self->size[1];
  rig->description.solver.time_step = 0.01;
  add_box(rig, (0.5 * n + 0.5) * ball_spacing);
  const SporeSphereSet *set = rig_sphere(rig, ball_radius);
  double *points = ball_points(n, count);
  for (unsigned i = 0; i < count; i++) {
    char *name = g_strdup_printf("ball%u", i);
    SporeBodyDescription *body = rig_passive(rig, g_intern_string(name), ball_model(), set);
    body->pose.position = spore_vec3_load(points + 3 * (size_t)i);
    set_contact(&body->contact, ball_stiffness, ball_damping, false);
    g_free(name);
  }
  g_free(points);
}

/* The loose points are a net without springs. */
static double *loose_points;
static void place_loose(const LatticeNet *net, unsigned column, unsigned row, double *x) {
  spore_vec3_store(x, spore_vec3_load(loose_points + 3 * (size_t)row));
}

static void build_point_pile(Rig *rig, const Case *self) {
  unsigned n = self->size[0], count = self->size[1];
  rig->description.solver.time_step = 0.01;
  add_box(rig, (0.5 * n + 0.5) * ball_spacing);
  loose_points = ball_points(n, count);
  LatticeNet net = {
      .columns = 1, .rows = count, .spacing = 1, .mass = ball_mass * count, .tension = 0, .start = place_loose};
  SporeModel *model = lattice_net_new(&net);
  SporeBodyDescription *body = rig_passive(rig, "balls", model, rig_spheres(rig, loose_points, count, ball_radius));
  set_contact(&body->contact, ball_stiffness, ball_damping, true);
  g_free(loose_points);
}

const Case contact_cases[] = {{.name = "c0 free organ, 180 nodes",
                               .build = build_free_organ,
                               .size = {0},
                               .elements = 600,
                               TETRAHEDRON_FLOPS,
                               .sofa = "CG 25",
                               .sofa_ms = 0.661,
                               .steps = 100},
                              {.name = "c1 organ with 34 spheres on 400",
                               .build = build_free_organ,
                               .size = {1},
                               .elements = 600,
                               TETRAHEDRON_FLOPS,
                               .sofa = "CG 25, incremental broad phase",
                               .sofa_ms = 0.717,
                               .before = 100,
                               .steps = 100},
                              {.name = "r1 rigid with 34 spheres on 400",
                               .build = build_rigid_organ,
                               .sofa = "CG 25",
                               .sofa_ms = 0.066,
                               .before = 100,
                               .steps = 100},
                              {.name = "d sheet of 500 on itself",
                               .build = build_sheet,
                               .size = {20, 25},
                               .elements = 1867,
                               SPRING_FLOPS,
                               .sofa = "CG 25, sweep and prune",
                               .sofa_ms = 0.63,
                               .before = 100,
                               .steps = 100},
                              {.name = "d sheet of 2000 on itself",
                               .build = build_sheet,
                               .size = {40, 50},
                               .elements = 7732,
                               SPRING_FLOPS,
                               .sofa = "CG 25, sweep and prune",
                               .sofa_ms = 2.88,
                               .required_ms = 0.3,
                               .before = 100,
                               .steps = 100},
                              {.name = "f pile of 512 loose points",
                               .build = build_point_pile,
                               .size = {16, 512},
                               .sofa = "CG 25, incremental broad phase",
                               .sofa_ms = 0.531,
                               .before = 100,
                               .steps = 100,
                               .compared = 30,
                               .substeps = 8},
                              {.name = "f pile of 2000 loose points",
                               .build = build_point_pile,
                               .size = {32, 2000},
                               .sofa = "CG 25, sweep and prune",
                               .sofa_ms = 5.99,
                               .required_ms = 0.6,
                               .before = 100,
                               .steps = 100,
                               .compared = 30,
                               .substeps = 8},
                              {.name = "f pile of 512 rigid balls",
                               .build = build_rigid_pile,
                               .size = {16, 512},
                               .sofa = "points, CG 25, incremental broad phase",
                               .sofa_ms = 0.531,
                               .before = 100,
                               .steps = 100,
                               .compared = 30,
                               .substeps = 8},
                              {.name = "f pile of 2000 rigid balls",
                               .build = build_rigid_pile,
                               .size = {32, 2000},
                               .sofa = "points, CG 25, sweep and prune",
                               .sofa_ms = 5.99,
                               .required_ms = 0.6,
                               .before = 100,
                               .steps = 100,
                               .compared = 30,
                               .substeps = 8},
                              {0}};
