/* Nets that tear: at the force that theory says, along a line, and without a step that adds energy. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/integrate/integrator.h"
#include "tests/stability/rig.h"

#define SPACING 0.01
#define STRAIN 0.3

/* Goes to the right at `speed` for `pull_s`, and stays there. */
typedef struct Hand {
  SporeDevice base;
  double speed, pull_s;
} Hand;

static bool hand_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                          SporeDeviceState *state) {
  const Hand *hand = (const Hand *)device;
  *state =
      (SporeDeviceState){.position = {hand->speed * fmin(time_s, hand->pull_s), 0, 0}, .orientation = {1, 0, 0, 0}};
  return true;
}
static void hand_close(SporeDevice *device) {}
static const SporeDeviceType hand_type = {.name = "hand", .doc = "", .exchange = hand_exchange, .close = hand_close};

#define NOTCH 5

/* A sheet; a long one with a notch in the middle of its lower edge: quads are missing in as many rows. */
static void notched_sheet(SporeTriangleMesh *sheet, unsigned columns, unsigned rows) {
  shape_sheet(sheet, columns, rows, SPACING, FALSE);
  size_t kept = 0;
  for (size_t t = 0; t < sheet->triangle_count; t++) {
    size_t quad = t / 2;
    if (columns > 2 && quad / (columns - 1) < NOTCH && quad % (columns - 1) == columns / 2 - 1) continue;
    memmove(sheet->triangles + 3 * kept++, sheet->triangles + 3 * t, 3 * sizeof *sheet->triangles);
  }
  sheet->triangle_count = kept;
}

/* A strip along x, held at its left edge; each node of its right edge is tied to a hand. */
static Rig *strip(unsigned columns, unsigned rows, double stiffness, double shear, double strain, double damping,
                  const double *points, size_t point_count) {
  Rig *rig = rig_new();
  rig->description.gravity = spore_vec3(0, 0, -9.81);
  SporeTriangleMesh sheet;
  notched_sheet(&sheet, columns, rows);
  SporeModel *model =
      rig_surface_model(&spore_mass_spring_net, &sheet, "structural_stiffness", stiffness, "shear_stiffness", shear,
                        "bending_stiffness", 0.1 * stiffness, "damping", damping, "tear_strain", strain, NULL);
  rig_passive(rig, "strip", model, point_count ? rig_spheres(rig, points, point_count, 0.002) : NULL);
  rig_active(rig, "hand", NULL);
  for (unsigned row = 0; row < rows; row++) {
    rig_pin(rig, 0, spore_vec3(0, SPACING * row, 0), 1e-4);
    SporeVec3 end = spore_vec3(SPACING * (columns - 1), SPACING * row, 0);
    SporeLinkDescription tie = {.name = "tie",
                                .type = &spore_link_spring,
                                .body_a = 0,
                                .body_b = 1,
                                .point_a = end,
                                .point_b = end,
                                .stiffness = (columns == 2 ? 1e4 : 100) * stiffness,
                                .damping = -1};
    g_array_append_val(rig->links, tie);
  }
  return rig;
}

static double pull_of(const SporeWorld *world) {
  double sum = 0;
  for (size_t i = 0; i < spore_world_link_count(world); i++) sum += spore_world_link_state(world, i).force.x;
  return sum;
}

/* Two columns: what is not held hangs on the hand alone, so that each edge's length is known. */
static double strip_force(unsigned rows, double stiffness, double shear, double stretch) {
  double length = SPACING + stretch, diagonal = hypot(length, SPACING), over_two = hypot(length, 2 * SPACING);
  return rows * stiffness * stretch + (rows - 1) * (stiffness + shear) * (1 - SPACING * sqrt(2) / diagonal) * length +
         (rows - 2) * shear * (1 - SPACING * sqrt(5) / over_two) * length;
}

static const SporeIntegratorKind methods[] = {SPORE_INTEGRATOR_IMPLICIT_EULER, SPORE_INTEGRATOR_BDF2,
                                              SPORE_INTEGRATOR_VERLET, SPORE_INTEGRATOR_SYMPLECTIC_EULER,
                                              SPORE_INTEGRATOR_STATIC};

/* Parts at the force that the strain means, and not below. */
static void test_force(void) {
  const unsigned rows = 5;
  const double stiffness = 100, shear = 50, dt = 0.001, speed = 0.01;
  for (size_t m = 0; m < G_N_ELEMENTS(methods); m++) {
    bool explicit = !spore_integrator(methods[m])->implicit;
    Rig *rig = strip(2, rows, stiffness, shear, STRAIN, 0.05, NULL, 0);
    rig->description.solver.time_step = dt;
    rig->description.solver.integrator = methods[m];
    rig->description.solver.substeps = explicit ? 20 : 1;
    Hand hand = {.base = {&hand_type}, .speed = speed, .pull_s = 1};
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &hand.base);
    double most = 0, before = 0;
    for (int step = 0; step < 400; step++) {
      spore_world_step(world);
      if (spore_world_time_s(world) < 0.98 * STRAIN * SPACING / speed)
        g_assert_cmpuint(spore_world_monitor(world)->torn_springs, ==, 0);
      if (spore_world_monitor(world)->torn_springs == 0) before = pull_of(world);
      most = fmax(most, pull_of(world));
    }
    double expected = strip_force(rows, stiffness, shear, STRAIN * SPACING);
    g_test_message("%s: parts at %.5f N (theory %.5f), then %.2e N; %llu springs; %s",
                   spore_integrator(methods[m])->name, before, expected, pull_of(world),
                   (unsigned long long)spore_world_monitor(world)->torn_springs, rig_last_message(world));
    g_assert_cmpfloat(fabs(before / expected - 1), <, 0.01); /* a step pulls by a third of a hundredth */
    g_assert_cmpfloat(fabs(most / expected - 1), <, 0.02);
    g_assert_cmpfloat(fabs(pull_of(world)), <, 1e-3 * expected);
    /* Rows, diagonals and shear springs across them. */
    g_assert_cmpuint(spore_world_monitor(world)->torn_springs, >=, rows + 2 * (rows - 1));
    g_assert_true(rig_said(world, "strip: begins to tear"));
    rig_free(rig);
  }
}

/* Pulled to just below and held there it bears. */
static void test_bears(void) {
  Hand hand = {.base = {&hand_type}, .speed = 0.01, .pull_s = 0.98 * STRAIN * SPACING / 0.01};
  Rig *rig = strip(2, 5, 100, 50, STRAIN, 0.05, NULL, 0);
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &hand.base);
  rig_run(world, 400);
  g_assert_cmpuint(spore_world_monitor(world)->torn_springs, ==, 0);
  double expected = strip_force(5, 100, 50, 0.98 * STRAIN * SPACING);
  g_assert_cmpfloat_with_epsilon(pull_of(world), expected, 0.01 * expected);
  rig_free(rig);
}

#define COLUMNS 24
#define ROWS 9

typedef struct Pieces {
  unsigned piece[COLUMNS * ROWS]; /* by triangles that are whole; 0: on none */
  unsigned count, loose, narrowest, widest;
} Pieces;

static bool is_cut(const SporeCuts *cuts, uint32_t a, uint32_t b) {
  for (size_t i = 0; i < cuts->count; i++)
    if (cuts->edges[i].a == MIN(a, b) && cuts->edges[i].b == MAX(a, b)) return true;
  return false;
}

static Pieces find_pieces(SporeWorld *world) {
  Pieces found = {0};
  const SporeCuts *cuts = &spore_world_snapshot_acquire(world)->cuts;
  SporeTriangleMesh sheet;
  notched_sheet(&sheet, COLUMNS, ROWS);
  for (unsigned i = 0; i < COLUMNS * ROWS; i++) found.piece[i] = i + 1;
  bool seen[COLUMNS * ROWS] = {0};
  for (bool changed = true; changed;) {
    changed = false;
    for (size_t t = 0; t < sheet.triangle_count; t++) {
      const uint32_t *n = sheet.triangles + 3 * t;
      if (is_cut(cuts, n[0], n[1]) || is_cut(cuts, n[1], n[2]) || is_cut(cuts, n[2], n[0])) continue;
      for (int k = 0; k < 3; k++) {
        unsigned *a = &found.piece[n[k]], *b = &found.piece[n[(k + 1) % 3]];
        seen[n[k]] = true;
        if (*a != *b) *a = *b = MIN(*a, *b), changed = true;
      }
    }
  }
  found.narrowest = COLUMNS;
  for (unsigned row = NOTCH; row < ROWS; row++) {
    unsigned gaps = 0;
    for (unsigned column = 0; column + 1 < COLUMNS; column++)
      gaps += is_cut(cuts, row * COLUMNS + column, row * COLUMNS + column + 1);
    found.narrowest = MIN(found.narrowest, gaps), found.widest = MAX(found.widest, gaps);
  }
  for (unsigned i = 0; i < COLUMNS * ROWS; i++) {
    found.loose += !seen[i];
    found.count += seen[i] && found.piece[i] == i + 1;
  }
  spore_triangle_mesh_clear(&sheet);
  return found;
}

/* One line through all rows, that begins in one place: two pieces, and nothing that holds between them. */
static void test_line(void) {
  for (size_t m = 0; m + 1 < G_N_ELEMENTS(methods); m++) { /* static: loose pieces have no place */
    Rig *rig = strip(COLUMNS, ROWS, 100, 50, STRAIN, 0.05, NULL, 0);
    rig->description.solver.integrator = methods[m];
    rig->description.solver.time_step = 0.004;
    rig->description.solver.substeps = spore_integrator(methods[m])->implicit ? 1 : 60;
    Hand hand = {.base = {&hand_type}, .speed = 0.05, .pull_s = 1.6};
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &hand.base);
    uint64_t allocations = spore_allocation_count();
    double most = 0;
    for (int step = 0; step < 300; step++) {
      spore_world_step(world);
      most = fmax(most, pull_of(world));
    }
    g_assert_cmpuint(spore_allocation_count(), ==, allocations);
    g_assert_true(rig_finite(world));
    Pieces found = find_pieces(world);
    g_test_message(
        "%s: %u pieces, %u nodes loose, %u to %u gaps a row, %llu springs, pulls by %.2f N at most, %.1e N at the "
        "end; %s",
        spore_integrator(methods[m])->name, found.count, found.loose, found.narrowest, found.widest,
        (unsigned long long)spore_world_monitor(world)->torn_springs, most, pull_of(world), rig_last_message(world));
    g_assert_cmpuint(found.count, ==, 2);
    g_assert_cmpuint(found.narrowest, ==, 1);
    g_assert_cmpuint(found.widest, <=, 2);
    g_assert_cmpuint(found.loose, <=, 2);
    g_assert_cmpuint(found.piece[0], !=, found.piece[COLUMNS - 1]);
    g_assert_cmpfloat(fabs(pull_of(world)), <, 0.1);
    g_assert_false(rig_any_frozen(world));
    rig_free(rig);
  }
}

/* A net as stiff as a tendon, torn in steps a thousand times longer than its waves take over an edge: no step adds
 * energy once the hand stands, and nothing flies off faster than what was stored can throw it. */
static void test_stiff(void) {
  for (double stiffness = 1e4; stiffness < 2e8; stiffness *= 100) {
    Rig *rig = strip(COLUMNS, ROWS, stiffness, 0.5 * stiffness, 0.05, 0, NULL, 0);
    rig->description.solver.time_step = 0.02;
    Hand hand = {.base = {&hand_type}, .speed = 0.5, .pull_s = 0.08};
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &hand.base);
    double most = 0, last = HUGE_VAL, gained = 0;
    for (int step = 0; step < 60; step++) {
      spore_world_step(world);
      double energy = rig_energy(world);
      most = fmax(most, energy);
      if (step > 4) gained = fmax(gained, energy - last);
      last = energy;
    }
    const SporeMonitor *monitor = spore_world_monitor(world);
    Pieces found = find_pieces(world);
    g_test_message("%g N/m: %llu springs, %u pieces, %.3g J at most, %.2g J gained at most in a step, %.2g J at the "
                   "end; %llu steps unsolved; %s",
                   stiffness, (unsigned long long)monitor->torn_springs, found.count, most, gained, last,
                   (unsigned long long)monitor->not_converged, rig_last_message(world));
    g_assert_true(rig_finite(world));
    g_assert_false(rig_any_frozen(world));
    g_assert_cmpuint(found.count, >=, 2);
    g_assert_cmpuint(found.piece[0], !=, found.piece[COLUMNS - 1]);
    g_assert_cmpfloat(gained, <, 1e-3 * most);
    rig_free(rig);
  }
}

/* Thrown apart, both halves of a free net keep what momentum they had together. */
static void test_momentum(void) {
  Rig *rig = rig_new();
  SporeTriangleMesh sheet;
  notched_sheet(&sheet, COLUMNS, ROWS);
  rig_passive(rig, "net", rig_surface_model(&spore_mass_spring_net, &sheet, "tear_strain", STRAIN, NULL), NULL);
  rig->description.solver.integrator = SPORE_INTEGRATOR_VERLET;
  rig->description.solver.substeps = 60;
  rig->description.solver.time_step = 0.004;
  SporeWorld *world = rig_build(rig);
  const SporeModel *model = spore_world_body_model(world, 0);
  double q[3 * COLUMNS * ROWS], v[3 * COLUMNS * ROWS] = {0};
  memcpy(q, spore_world_q(world, 0), sizeof q);
  for (int i = 0; i < COLUMNS * ROWS; i++)
    v[3 * i] = i % COLUMNS < COLUMNS / 2 ? -6 : 6, v[3 * i + 1] = 0.5, v[3 * i + 2] = q[3 * i];
  spore_world_set_state(world, 0, q, v);
  SporeVec3 start[2], end[2];
  double scale = 0;
  for (int when = 0; when < 2; when++) {
    SporeVec3 *sum = when ? end : start;
    sum[0] = sum[1] = spore_vec3(0, 0, 0);
    for (int i = 0; i < COLUMNS * ROWS; i++) {
      SporeVec3 p = spore_vec3_scale(model->block_mass[i], spore_vec3_load(spore_world_v(world, 0) + 3 * i));
      SporeVec3 spin = spore_vec3_cross(spore_vec3_load(spore_world_q(world, 0) + 3 * i), p);
      sum[0] = spore_vec3_add(sum[0], p), sum[1] = spore_vec3_add(sum[1], spin);
      scale += spore_vec3_length(p);
    }
    if (!when) rig_run(world, 60);
  }
  g_test_message("%llu springs torn; momentum off by %.1e, angular by %.1e of %.3g kg m/s",
                 (unsigned long long)spore_world_monitor(world)->torn_springs, spore_vec3_distance(start[0], end[0]),
                 spore_vec3_distance(start[1], end[1]), scale);
  g_assert_cmpuint(find_pieces(world).count, >=, 2);
  g_assert_cmpfloat(spore_vec3_distance(start[0], end[0]), <, 1e-12 * scale);
  g_assert_cmpfloat(spore_vec3_distance(start[1], end[1]), <, 1e-12 * scale);
  rig_free(rig);
}

/* Spheres between nodes go with one side of the tear; and a run is repeated, by any number of threads and after a
 * reset. */
static void test_repeats(void) {
  double points[3 * 2 * (COLUMNS - 1)];
  for (int i = 0; i < 2 * (COLUMNS - 1); i++)
    spore_vec3_store(points + 3 * i,
                     spore_vec3(SPACING * (i % (COLUMNS - 1)) + 0.006, i < COLUMNS - 1 ? 0.042 : 0.013, 0));
  uint64_t hashes[3];
  for (int run = 0; run < 2; run++) {
    Rig *rig = strip(COLUMNS, ROWS, 100, 50, STRAIN, 0.05, points, 2 * (COLUMNS - 1));
    rig_unmovable(rig, "far", rig_sphere(rig, 0.01))->pose.position = spore_vec3(3, 3, 3);
    rig->description.solver.time_step = 0.004;
    Hand hand = {.base = {&hand_type}, .speed = 0.05, .pull_s = 1.6};
    SporePool *pool = run ? spore_pool_create(2) : NULL;
    SporeWorld *world = rig_build_on(rig, pool);
    spore_world_set_device(world, 1, &hand.base);
    rig_run(world, 500);
    hashes[run] = spore_world_hash(world);
    if (run) {
      spore_world_reset(world);
      g_assert_cmpuint(spore_world_monitor(world)->torn_springs, ==, 0);
      g_assert_cmpuint(spore_world_snapshot_acquire(world)->cuts.count, ==, 0);
      rig_run(world, 500);
      hashes[2] = spore_world_hash(world);
    }
    Pieces found = find_pieces(world);
    const double *q = spore_world_q(world, 0);
    const SporeSpheres *spheres = spore_world_spheres(world);
    double furthest = 0;
    for (size_t s = 0; s < spheres->count; s++) {
      SporeVec3 centre = spore_vec3_load(spheres->centre + 3 * s);
      double nearest = HUGE_VAL;
      for (int i = 0; i < COLUMNS * ROWS; i++)
        nearest = fmin(nearest, spore_vec3_distance(centre, spore_vec3_load(q + 3 * i)));
      if (spheres->body[s] == 0) furthest = fmax(furthest, nearest);
    }
    g_test_message("the sphere furthest from all nodes is %.1f mm from one; %u pieces", 1e3 * furthest, found.count);
    g_assert_cmpuint(found.count, ==, 2);
    g_assert_cmpfloat(furthest, <, 0.012); /* the pieces are many times further apart */
    rig_free(rig);
    if (pool) spore_pool_free(pool);
  }
  g_assert_cmpuint(hashes[0], ==, hashes[1]);
  g_assert_cmpuint(hashes[0], ==, hashes[2]);
}

/* Without a strain nothing tears, and the plan has no such stage. */
static void test_never(void) {
  for (int tears = 0; tears < 2; tears++) {
    Rig *rig = strip(2, 3, 100, 50, tears ? STRAIN : 0, 0.05, NULL, 0);
    Hand hand = {.base = {&hand_type}, .speed = 0.1, .pull_s = 1};
    SporeWorld *world = rig_build(rig);
    spore_world_set_device(world, 1, &hand.base);
    rig_run(world, 200);
    const SporePlan *plan = spore_world_plan(world);
    for (size_t i = 0; i < plan->stage_count; i++)
      if (!strcmp(plan->stages[i].name, "tear")) g_assert_cmpint(plan->stages[i].included, ==, tears);
    g_assert_cmpint(spore_world_monitor(world)->torn_springs > 0, ==, tears);
    rig_free(rig);
  }
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/tearing/force", test_force);
  g_test_add_func("/tearing/bears", test_bears);
  g_test_add_func("/tearing/line", test_line);
  g_test_add_func("/tearing/stiff", test_stiff);
  g_test_add_func("/tearing/momentum", test_momentum);
  g_test_add_func("/tearing/repeats", test_repeats);
  g_test_add_func("/tearing/never", test_never);
  return g_test_run();
}
