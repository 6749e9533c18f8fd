/* Grid and narrow phase, against every pair tried by brute force. */
#include <glib.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/collide/grid.h"
#include "core/collide/narrow.h"

typedef struct {
  SporeSpheres spheres;
  SporeGridBody *bodies;
  size_t body_count;
} Scene;

static GRand *random_source;

static double uniform(double low, double high) { return g_rand_double_range(random_source, low, high); }

static void scene_init(Scene *scene, size_t count, size_t static_count, size_t body_count) {
  scene->spheres = (SporeSpheres){count,
                                  static_count,
                                  g_new0(double, 3 * count),
                                  g_new0(double, 3 * count),
                                  g_new0(double, count),
                                  g_new0(guint32, count)};
  scene->bodies = g_new0(SporeGridBody, body_count);
  scene->body_count = body_count;
}

static void scene_clear(Scene *scene) {
  g_free(scene->spheres.centre);
  g_free(scene->spheres.velocity);
  g_free(scene->spheres.radius);
  g_free(scene->spheres.body);
  g_free(scene->bodies);
}

/* Radii spread evenly over their orders of magnitude; body 0 unmovable, body 1 active, the rest passive. */
static void scene_random(Scene *scene, size_t count, size_t static_count, double side, double smallest, double largest,
                         SporeVec3 offset) {
  enum { BODIES = 6 };
  scene_init(scene, count, static_count, BODIES);
  scene->bodies[1].active = true;
  for (size_t i = 2; i < BODIES; i++) scene->bodies[i] = (SporeGridBody){.passive = true, .soft = i % 2 == 0};
  for (size_t i = 0; i < count; i++) {
    SporeVec3 centre = {uniform(0, side), uniform(0, side), uniform(0, side)};
    spore_vec3_store(scene->spheres.centre + 3 * i, spore_vec3_add(offset, centre));
    scene->spheres.radius[i] = smallest * pow(largest / smallest, uniform(0, 1));
    scene->spheres.body[i] = i < static_count ? 0 : (guint32)g_rand_int_range(random_source, 1, BODIES);
  }
}

static SporeVec3 centre_of(const SporeSpheres *spheres, size_t i) { return spore_vec3_load(spheres->centre + 3 * i); }

static SporeVec3 velocity_of(const SporeSpheres *spheres, size_t i) {
  return spore_vec3_load(spheres->velocity + 3 * i);
}

static SporeGrid *create(const Scene *scene) {
  SporeError error = SPORE_ERROR_INIT;
  SporeGrid *grid = spore_grid_create(&scene->spheres, scene->bodies, scene->body_count, 0, &error);
  if (!grid) g_error("%s", error.message);
  return grid;
}

/* Detects, making room first where it must. */
static size_t detect(SporeGrid *grid, const SporeSpheres *spheres, double dt_s) {
  size_t missed, count = spore_grid_detect(grid, spheres, dt_s, &missed);
  if (missed == 0) return count;
  g_assert_true(spore_grid_reserve(grid, spore_grid_capacity(grid) + missed));
  count = spore_grid_detect(grid, spheres, dt_s, &missed);
  g_assert_cmpuint(missed, ==, 0);
  return count;
}

static gboolean bodies_pair(const Scene *scene, guint32 a, guint32 b) {
  if (a == b) return scene->bodies[a].self && scene->bodies[a].passive;
  return scene->bodies[a].passive || scene->bodies[b].passive || scene->bodies[a].active != scene->bodies[b].active;
}

/* Closest distance of two spheres' centres while they move for dt_s. */
static double closest(const SporeSpheres *spheres, size_t a, size_t b, double dt_s) {
  SporeVec3 p = spore_vec3_sub(centre_of(spheres, a), centre_of(spheres, b));
  SporeVec3 w = spore_vec3_sub(velocity_of(spheres, a), velocity_of(spheres, b));
  double square = spore_vec3_dot(w, w), t = square > 0 ? CLAMP(-spore_vec3_dot(p, w) / square, 0, dt_s) : 0;
  return spore_vec3_length(spore_vec3_add_scaled(p, t, w));
}

/* 1: a contact, 0: none, -1: too near the border to say. */
static int expect_contact(const Scene *scene, size_t a, size_t b, double dt_s) {
  const SporeSpheres *spheres = &scene->spheres;
  if (!bodies_pair(scene, spheres->body[a], spheres->body[b])) return 0;
  double sum = spheres->radius[a] + spheres->radius[b];
  double size = spore_vec3_length(centre_of(spheres, a)), border = 1e-12 * sum + 1e-14 * size;
  double now = spore_vec3_distance(centre_of(spheres, a), centre_of(spheres, b));
  if (fabs(now - sum) < border) return -1;
  if (now < sum) return 1;
  const SporeGridBody *one = &scene->bodies[spheres->body[a]], *other = &scene->bodies[spheres->body[b]];
  gboolean soft = one->soft || other->soft || !(one->passive || other->passive);
  double travel = spore_vec3_distance(velocity_of(spheres, a), velocity_of(spheres, b)) * dt_s;
  double least = soft ? SPORE_SPHERES_FAST * fmin(spheres->radius[a], spheres->radius[b]) : 0;
  double nearest = closest(spheres, a, b, soft ? dt_s : SPORE_SPHERES_AHEAD * dt_s);
  if (fabs(travel - least) < border || fabs(nearest - sum) < border) return -1;
  return travel > least && nearest < sum;
}

/* Contact for contact the same as brute force, in order, each once, with sound values. Returns their number. */
static size_t check_against_brute_force(const Scene *scene, SporeGrid *grid, double dt_s) {
  const SporeSpheres *spheres = &scene->spheres;
  size_t count = detect(grid, spheres, dt_s), next = 0;
  const SporeContact *contacts = spore_grid_contacts(grid);
  for (size_t a = 0; a < spheres->count; a++)
    for (size_t b = MAX(a + 1, spheres->static_count); b < spheres->count; b++) {
      int expected = expect_contact(scene, a, b, dt_s);
      gboolean found = next < count && contacts[next].a == a && contacts[next].b == b;
      if (expected >= 0 && found != expected) g_error("pair %zu %zu: found %d, expected %d", a, b, found, expected);
      if (found) next++;
    }
  g_assert_cmpuint(next, ==, count);
  for (size_t i = 0; i < count; i++) {
    const SporeContact *contact = &contacts[i];
    g_assert_cmpfloat(fabs(spore_vec3_length(contact->normal) - 1), <, 1e-14);
    SporeVec3 w = spore_vec3_sub(velocity_of(spheres, contact->a), velocity_of(spheres, contact->b));
    g_assert_cmpfloat(contact->gap_speed, ==, spore_vec3_dot(contact->normal, w));
    double sum = spheres->radius[contact->a] + spheres->radius[contact->b];
    double now = spore_vec3_distance(centre_of(spheres, contact->a), centre_of(spheres, contact->b));
    if (contact->depth > 0) g_assert_cmpfloat(fabs(contact->depth - (sum - now)), <=, 1e-15 * sum);
    else g_assert_cmpfloat(-contact->depth, <=, -contact->gap_speed * SPORE_SPHERES_AHEAD * dt_s * (1 + 1e-12));
  }
  return count;
}

static void check_random(size_t count, size_t static_count, double side, double smallest, double largest,
                         SporeVec3 offset) {
  Scene scene;
  scene_random(&scene, count, static_count, side, smallest, largest, offset);
  SporeGrid *grid = create(&scene);
  g_assert_cmpuint(check_against_brute_force(&scene, grid, 0), >, 0);
  for (int step = 0; step < 3; step++) { /* the same grid, the spheres elsewhere */
    for (size_t i = 3 * static_count; i < 3 * count; i++) scene.spheres.centre[i] += uniform(-0.3, 0.3) * side;
    check_against_brute_force(&scene, grid, 0);
  }
  spore_grid_free(grid);
  scene_clear(&scene);
}

static void test_random(void) {
  SporeVec3 here = {0, 0, 0}, far_away = {1e6, -1e6, 1e6};
  check_random(300, 0, 1, 0.05, 0.05, here);
  check_random(600, 200, 1, 0.04, 0.08, here);
  check_random(600, 100, 1, 0.01, 0.2, here);
  check_random(800, 400, 1, 2e-4, 0.2, here);
  check_random(800, 0, 1, 2e-4, 0.2, here);
  check_random(600, 599, 1, 0.01, 0.2, here);
  check_random(600, 200, 1e-6, 4e-8, 8e-8, here);
  check_random(600, 200, 1, 0.01, 0.2, far_away);
  check_random(400, 100, 1e-3, 4e-5, 8e-5, far_away);
  check_random(400, 100, 1e5, 1e-3, 1e4, here);
}

/* Bodies side by side: most spheres are out of reach of any other body and take no part. */
static void test_apart(void) {
  for (int round = 0; round < 4; round++) {
    Scene scene;
    scene_random(&scene, 900, 200, 1, 0.01, 0.1, (SporeVec3){0, 0, 0});
    scene.bodies[3].self = round % 2;
    for (size_t i = 0; i < 900; i++) {
      scene.spheres.centre[3 * i + (size_t)round % 3] += 0.9 * scene.spheres.body[i];
      scene.spheres.velocity[3 * i] = i < 200 ? 0 : uniform(-4, 4);
    }
    SporeGrid *grid = create(&scene);
    scene.bodies[3].self = false; /* all that touch at rest are excluded, so brute force need not know them */
    g_assert_cmpuint(check_against_brute_force(&scene, grid, 1e-3), >, 0);
    spore_grid_free(grid);
    scene_clear(&scene);
  }
}

/* Step after step, the grid that remembers finds bit for bit what one finds that was made just now: at every speed,
 * when spheres stop, jump, come to be not finite and come back. */
static void test_remembers(void) {
  for (int round = 0; round < 6; round++) {
    Scene scene;
    scene_random(&scene, 500, 150, 1, 0.02, 0.08, (SporeVec3){0, 0, 0});
    SporeSpheres *spheres = &scene.spheres;
    SporeGrid *grid = create(&scene);
    double fastest = 1e-3 * pow(10, 0.5 * round), dt_s = 1e-2;
    for (size_t i = 3 * 150; i < 3 * 500; i++) spheres->velocity[i] = uniform(-fastest, fastest);
    for (int step = 0; step < 60; step++) {
      double old = spheres->centre[3 * 200];
      if (step == 20) memset(spheres->velocity, 0, 3 * 500 * sizeof(double));
      if (step == 30) spheres->centre[3 * 300] += 0.5;
      if (step > 40 && step < 50) spheres->centre[3 * 200] = NAN;
      SporeGrid *fresh = create(&scene);
      size_t count = check_against_brute_force(&scene, grid, dt_s);
      g_assert_cmpuint(detect(fresh, spheres, dt_s), ==, count);
      g_assert_cmpmem(spore_grid_contacts(grid), count * sizeof(SporeContact), spore_grid_contacts(fresh),
                      count * sizeof(SporeContact));
      spore_grid_free(fresh);
      spheres->centre[3 * 200] = old;
      for (size_t i = 3 * 150; i < 3 * 500; i++) spheres->centre[i] += dt_s * spheres->velocity[i];
    }
    spore_grid_free(grid);
    scene_clear(&scene);
  }
}

/* Small unmovable spheres under one that is a thousand times larger, and the other way round. */
static void test_extreme_ratio(void) {
  for (int large_is_static = 0; large_is_static < 2; large_is_static++) {
    Scene scene;
    scene_random(&scene, 501, large_is_static ? 1 : 500, 1, 1e-3, 1e-3, (SporeVec3){0, 0, 0});
    size_t large = large_is_static ? 0 : 500;
    scene.spheres.radius[large] = 1;
    scene.spheres.body[large] = large_is_static ? 0 : 2;
    SporeGrid *grid = create(&scene);
    g_assert_cmpuint(check_against_brute_force(&scene, grid, 0), >, 100);
    spore_grid_free(grid);
    scene_clear(&scene);
  }
}

static void test_moving(void) {
  for (int round = 0; round < 4; round++) {
    Scene scene;
    scene_random(&scene, 500, 150, 1, 0.005, 0.05, (SporeVec3){0, 0, 0});
    SporeGrid *grid = create(&scene);
    double fastest = pow(10, round - 1);
    for (size_t i = 3 * 150; i < 3 * 500; i++) scene.spheres.velocity[i] = uniform(-fastest, fastest);
    g_assert_cmpuint(check_against_brute_force(&scene, grid, 1e-2), >, 0);
    spore_grid_free(grid);
    scene_clear(&scene);
  }
}

/* Pairs that passed each other in the step before, against all pairs: found where spheres stand, and where they rush on
 * or turn back; of what was put where it is, none. */
static void test_passed(void) {
  static const double onward[] = {0, 1, -1};
  for (int run = 0; run < 6; run++) {
    Scene scene;
    scene_random(&scene, 400, 40, 0.05, 5e-4, 3e-3, (SporeVec3){0, 0, 0});
    SporeSpheres *spheres = &scene.spheres;
    double *before = spheres->before = g_memdup2(spheres->centre, 3 * spheres->count * sizeof *before), dt_s = 1e-3;
    for (size_t i = 3 * spheres->static_count; i < 3 * spheres->count; i++) {
      before[i] = run < 3 ? spheres->centre[i] + uniform(-0.02, 0.02) : NAN;
      if (run < 3) spheres->velocity[i] = (spheres->centre[i] - before[i]) / dt_s;
    }
    SporeGrid *grid = create(&scene);
    detect(grid, spheres, dt_s); /* the grid looks for what was fast in a step or is fast after it */
    for (size_t i = 0; run < 3 && i < 3 * spheres->count; i++) spheres->velocity[i] *= onward[run];
    detect(grid, spheres, dt_s);
    const SporeContact *passed;
    SporeContact expected;
    size_t count = spore_grid_passed(grid, &passed), next = 0;
    for (guint32 a = 0; a < spheres->count; a++)
      for (guint32 b = MAX(a + 1, (guint32)spheres->static_count); b < spheres->count; b++)
        if (bodies_pair(&scene, spheres->body[a], spheres->body[b]) &&
            spore_narrow_passed(spheres, a, b, dt_s, &expected)) {
          g_assert_cmpuint(next, <, count);
          g_assert_cmpmem(&passed[next], sizeof expected, &expected, sizeof expected);
          next++;
        }
    g_assert_cmpuint(next, ==, count);
    if (run < 3) g_assert_cmpuint(count, >, 20);
    else g_assert_cmpuint(count, ==, 0);
    spore_grid_free(grid);
    g_free(before);
    scene_clear(&scene);
  }
}

/* A body that is set apart has no contacts, and all that it touches is told; when it is back, all is as before. */
static void test_set_apart(void) {
  Scene scene;
  const SporePair *pairs;
  scene_random(&scene, 500, 150, 1, 0.005, 0.05, (SporeVec3){0, 0, 0});
  SporeGrid *grid = create(&scene);
  size_t count = detect(grid, &scene.spheres, 1e-2), left = 0, told = 0;
  g_assert_cmpuint(spore_grid_apart(grid, &pairs), ==, 0);
  g_autofree SporeContact *whole = g_memdup2(spore_grid_contacts(grid), count * sizeof *whole);
  uint32_t apart = scene.spheres.body[whole[count / 2].b];
  spore_grid_set_apart(grid, apart, true);
  size_t now = detect(grid, &scene.spheres, 1e-2), pair_count = spore_grid_apart(grid, &pairs);
  for (size_t i = 0; i < count; i++) {
    bool is_apart = scene.spheres.body[whole[i].a] == apart || scene.spheres.body[whole[i].b] == apart;
    for (size_t k = 0; is_apart && k < pair_count; k++) told += pairs[k].a == whole[i].a && pairs[k].b == whole[i].b;
    if (is_apart) continue;
    g_assert_cmpuint(left, <, now);
    g_assert_cmpmem(&whole[i], sizeof *whole, &spore_grid_contacts(grid)[left++], sizeof *whole);
  }
  g_assert_cmpuint(left, ==, now);
  g_assert_cmpuint(told, ==, count - now);
  g_assert_cmpuint(told, >, 0);
  spore_grid_set_apart(grid, apart, false);
  g_assert_cmpuint(detect(grid, &scene.spheres, 1e-2), ==, count);
  g_assert_cmpmem(spore_grid_contacts(grid), count * sizeof *whole, whole, count * sizeof *whole);
  spore_grid_free(grid);
  scene_clear(&scene);
}

/* Two spheres of 1 mm: one passed the other 0.5 mm off its middle; 1.5 mm off it only grazed it; and it came no nearer
 * than where it stands. */
static void test_passed_by(void) {
  static const struct {
    double from, to, beside;
    gboolean passed;
  } ways[] = {{-6e-3, 4e-3, 5e-4, TRUE}, {-6e-3, 4e-3, 1.5e-3, FALSE}, {-6e-3, -1e-3, 5e-4, FALSE}};
  for (unsigned i = 0; i < G_N_ELEMENTS(ways); i++) {
    double centre[6] = {0, 0, 0, ways[i].to, ways[i].beside, 0}, before[6] = {0, 0, 0, ways[i].from, ways[i].beside, 0};
    double velocity[6] = {0}, radius[2] = {1e-3, 1e-3};
    guint32 body[2] = {0, 1};
    SporeSpheres spheres = {2, 0, centre, velocity, radius, body, before};
    SporeContact contact;
    g_assert_true(spore_narrow_passed(&spheres, 0, 1, 1e-3, &contact) == ways[i].passed);
    if (!ways[i].passed) continue;
    g_assert_cmpfloat(fabs(contact.depth - 1.5e-3), <, 1e-12);
    g_assert_cmpfloat(fabs(contact.gap_speed + 10), <, 1e-9);
    g_assert_cmpfloat(fabs(contact.normal.x - 1), <, 1e-12); /* the way of the first past the second is along -x */
  }
}

/* A tool of 1 mm at 10 m/s before tissue 2 mm thick: in one step of 1 ms it would be behind. */
static void test_fast_tool(void) {
  Scene scene;
  scene_init(&scene, 2, 0, 2);
  scene.bodies[0].passive = scene.bodies[0].soft = true;
  scene.spheres.radius[0] = scene.spheres.radius[1] = 1e-3;
  scene.spheres.body[1] = 1;
  scene.spheres.centre[3] = -6e-3;
  scene.spheres.velocity[3] = 10;
  SporeGrid *grid = create(&scene);
  size_t missed;
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 0, &missed), ==, 0);
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 1e-3, &missed), ==, 1);
  const SporeContact *contact = spore_grid_contacts(grid);
  g_assert_cmpfloat(fabs(contact->normal.x - 1), <, 1e-12); /* from the tool, b, to the tissue, a */
  g_assert_cmpfloat(contact->gap_speed, <, 0);
  g_assert_cmpfloat(fabs(contact->depth + 4e-3), <, 1e-12); /* 4 mm are left */
  scene.spheres.velocity[3] = -10;
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 1e-3, &missed), ==, 0);
  scene.spheres.velocity[3] = 3; /* does not get there in this step */
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 1e-3, &missed), ==, 0);
  spore_grid_free(grid);
  scene.bodies[0].soft = false; /* but in the first half of the next */
  grid = create(&scene);
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 1e-3, &missed), ==, 1);
  scene.spheres.slowest = 3.1;
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 1e-3, &missed), ==, 0);
  spore_grid_free(grid);
  scene_clear(&scene);
}

static void test_coincident(void) {
  Scene scene;
  scene_init(&scene, 3, 0, 3);
  for (size_t i = 0; i < 3; i++) {
    scene.bodies[i].passive = true;
    scene.spheres.radius[i] = 0.01;
    scene.spheres.body[i] = (guint32)i;
    scene.spheres.centre[3 * i] = 0.3;
  }
  SporeGrid *grid = create(&scene);
  g_assert_cmpuint(detect(grid, &scene.spheres, 1e-3), ==, 3);
  for (size_t i = 0; i < 3; i++) {
    const SporeContact *contact = &spore_grid_contacts(grid)[i];
    g_assert_cmpfloat(contact->normal.y, ==, 1);
    g_assert_cmpfloat(contact->depth, ==, 0.02);
  }
  scene.spheres.velocity[0] = 0.5; /* sphere 0 runs into the others along x: it is pushed back */
  g_assert_cmpuint(detect(grid, &scene.spheres, 1e-3), ==, 3);
  g_assert_cmpfloat(spore_grid_contacts(grid)[0].normal.x, ==, -1);
  spore_grid_free(grid);
  scene_clear(&scene);
}

static void test_pair_filter(void) {
  Scene scene;
  scene_init(&scene, 6, 2, 5);
  scene.bodies[1].active = scene.bodies[2].active = true;
  scene.bodies[3] = scene.bodies[4] = (SporeGridBody){.passive = true};
  static const guint32 bodies[] = {0, 0, 1, 2, 3, 4}; /* unmovable twice, active 1 and 2, passive 3 and 4 */
  for (size_t i = 0; i < 6; i++) {
    scene.spheres.radius[i] = 0.01;
    scene.spheres.body[i] = bodies[i];
    scene.spheres.centre[3 * i] = 1e-3 * (double)i;
  }
  SporeGrid *grid = create(&scene);
  /* each passive one with the five others, less their common pair, and each active one with the unmovable two */
  g_assert_cmpuint(check_against_brute_force(&scene, grid, 0), ==, 9 + 4);
  g_assert_cmpuint(spore_grid_body_pairs(scene.bodies, 5), ==, 7 + 2);
  g_assert_cmpuint(spore_grid_body_pairs(scene.bodies, 3), ==, 2); /* nothing passive */
  g_assert_cmpuint(spore_grid_body_pairs(scene.bodies + 1, 2), ==, 0);
  scene.bodies[3].self = true;
  g_assert_cmpuint(spore_grid_body_pairs(scene.bodies, 5), ==, 8 + 2);
  g_assert_cmpuint(spore_grid_body_pairs(NULL, 0), ==, 0);
  /* 0 with 2, 3 and 4, 2 with 3 and 4, and 3 with 4, no more */
  scene.bodies[0].group = scene.bodies[2].group = scene.bodies[3].group = scene.bodies[4].group = 7;
  scene.bodies[1].group = 8;
  g_assert_cmpuint(spore_grid_body_pairs(scene.bodies, 5), ==, 4);
  scene.bodies[3].self = false;
  SporeGrid *grouped = create(&scene);
  size_t missed;
  g_assert_cmpuint(spore_grid_detect(grouped, &scene.spheres, 0, &missed), ==, 4);
  for (size_t i = 0; i < 4; i++) { /* 1 with both spheres of 0, with 3 and with 4 */
    const SporeContact *contact = &spore_grid_contacts(grouped)[i];
    g_assert_true((scene.spheres.body[contact->a] == 1) != (scene.spheres.body[contact->b] == 1));
  }
  spore_grid_free(grouped);
  spore_grid_free(grid);
  scene_clear(&scene);
}

/* A chain that touches its neighbours at rest, then folds onto itself. */
static void test_self(void) {
  enum { COUNT = 40 };
  Scene scene;
  scene_init(&scene, COUNT, 0, 1);
  scene.bodies[0] = (SporeGridBody){.passive = true, .self = true};
  for (size_t i = 0; i < COUNT; i++) {
    scene.spheres.radius[i] = 0.01;
    scene.spheres.centre[3 * i] = 0.0185 * (double)i;
  }
  SporeGrid *grid = create(&scene);
  g_assert_cmpuint(detect(grid, &scene.spheres, 0), ==, 0);
  for (size_t i = 0; i < COUNT; i++) { /* squeezed: those that touched at rest still do not count, the next do */
    scene.spheres.centre[3 * i] = 0.0095 * (double)i;
  }
  size_t count = detect(grid, &scene.spheres, 0);
  g_assert_cmpuint(count, ==, COUNT - 2);
  for (size_t i = 0; i < count; i++)
    g_assert_cmpuint(spore_grid_contacts(grid)[i].b - spore_grid_contacts(grid)[i].a, ==, 2);
  for (size_t i = COUNT / 2; i < COUNT; i++) { /* the second half lies on the first */
    scene.spheres.centre[3 * i] = 0.0185 * (double)(COUNT - 1 - i);
    scene.spheres.centre[3 * i + 1] = 0.015;
  }
  for (size_t i = 0; i < COUNT / 2; i++) scene.spheres.centre[3 * i] = 0.0185 * (double)i;
  g_assert_cmpuint(detect(grid, &scene.spheres, 0), ==, COUNT / 2 - 1); /* but the fold itself */
  scene.bodies[0].passive = false;                                      /* prescribed: it cannot give way */
  SporeGrid *prescribed = create(&scene);
  g_assert_cmpuint(detect(prescribed, &scene.spheres, 0), ==, 0);
  spore_grid_free(prescribed);
  spore_grid_free(grid);
  scene_clear(&scene);
}

static void test_not_finite(void) {
  Scene scene;
  scene_random(&scene, 400, 100, 1, 0.01, 0.1, (SporeVec3){0, 0, 0});
  SporeGrid *grid = create(&scene);
  detect(grid, &scene.spheres, 1e-3);
  static const double odd[] = {NAN, INFINITY, -INFINITY, 1e300, -1e300, 1e30, 1e18};
  for (size_t i = 100; i < 400; i += 5) {
    scene.spheres.centre[3 * i + i % 3] = odd[i / 5 % G_N_ELEMENTS(odd)];
    scene.spheres.velocity[3 * (i + 1) + i % 3] = odd[i / 5 % G_N_ELEMENTS(odd)];
  }
  for (int with_time = 0; with_time < 2; with_time++) {
    size_t count = detect(grid, &scene.spheres, with_time ? 1e-3 : 0);
    for (size_t k = 0; k < count; k++) {
      const SporeContact *contact = &spore_grid_contacts(grid)[k];
      g_assert_true(contact->a % 5 || contact->a < 100);
      g_assert_cmpuint(contact->b % 5, !=, 0);
      g_assert_true(isfinite(contact->depth));
      g_assert_cmpfloat(fabs(spore_vec3_length(contact->normal) - 1), <, 1e-9);
    }
  }
  spore_grid_free(grid);
  scene_clear(&scene);
}

/* 10,000 contacts and more: all found, none twice, no memory taken, the same again. */
static void test_many(void) {
  Scene scene;
  scene_init(&scene, 4000, 0, 4000);
  for (size_t i = 0; i < 4000; i++) {
    scene.bodies[i].passive = true;
    scene.spheres.body[i] = (guint32)i;
    scene.spheres.radius[i] = 0.007;
    for (size_t k = 0; k < 3; k++) scene.spheres.centre[3 * i + k] = uniform(0, 0.2);
  }
  SporeGrid *grid = create(&scene);
  g_assert_cmpuint(check_against_brute_force(&scene, grid, 0), >, 10000);
  guint64 allocations = spore_allocation_count();
  size_t missed, count = spore_grid_detect(grid, &scene.spheres, 0, &missed);
  SporeContact *first = g_memdup2(spore_grid_contacts(grid), count * sizeof *first);
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 0, &missed), ==, count);
  g_assert_cmpmem(first, count * sizeof *first, spore_grid_contacts(grid), count * sizeof *first);
  g_assert_cmpuint(spore_allocation_count(), ==, allocations);
  g_free(first);
  spore_grid_free(grid);
  scene_clear(&scene);
}

static void test_overflow(void) {
  Scene scene;
  scene_random(&scene, 300, 50, 1, 0.1, 0.1, (SporeVec3){0, 0, 0});
  SporeGrid *grid = spore_grid_create(&scene.spheres, scene.bodies, scene.body_count, 10, NULL);
  size_t missed, count = spore_grid_detect(grid, &scene.spheres, 0, &missed);
  g_assert_cmpuint(count, ==, 10);
  g_assert_cmpuint(missed, >, 0);
  g_assert_cmpuint(spore_grid_capacity(grid), ==, 10);
  for (guint64 n = 1; n <= 3; n++) {
    spore_allocation_fail_at(n);
    g_assert_false(spore_grid_reserve(grid, 10 + missed));
  }
  g_assert_cmpuint(spore_grid_detect(grid, &scene.spheres, 0, &missed), ==, 10);
  g_assert_true(spore_grid_reserve(grid, 10 + missed));
  g_assert_cmpuint(check_against_brute_force(&scene, grid, 0), ==, spore_grid_capacity(grid));
  spore_grid_free(grid);
  scene_clear(&scene);
}

static void check_refused(const Scene *scene, const char *part) {
  SporeError error = SPORE_ERROR_INIT;
  g_assert_null(spore_grid_create(&scene->spheres, scene->bodies, scene->body_count, 0, &error));
  if (!strstr(error.message, part)) g_error("\"%s\" lacks \"%s\"", error.message, part);
}

static void test_refused(void) {
  Scene scene;
  scene_random(&scene, 10, 2, 1, 0.1, 0.1, (SporeVec3){0, 0, 0});
  static const double radii[] = {0, -1, NAN, INFINITY, 1e-10, 1e10};
  for (size_t i = 0; i < G_N_ELEMENTS(radii); i++) {
    scene.spheres.radius[4] = radii[i];
    check_refused(&scene, "sphere 4 has radius");
  }
  scene.spheres.radius[4] = 0.1;
  scene.spheres.centre[4] = NAN;
  check_refused(&scene, "unmovable sphere 1");
  scene.spheres.centre[4] = 0;
  scene.spheres.body[7] = 6;
  check_refused(&scene, "names body 6");
  scene_clear(&scene);
}

static void test_empty(void) {
  Scene scene;
  scene_init(&scene, 0, 0, 0);
  SporeGrid *grid = create(&scene);
  g_assert_cmpuint(detect(grid, &scene.spheres, 1e-3), ==, 0);
  spore_grid_free(grid);
  spore_grid_free(NULL);
  scene_clear(&scene);
}

static void test_without_memory(void) {
  Scene scene;
  scene_random(&scene, 50, 10, 1, 0.1, 0.1, (SporeVec3){0, 0, 0});
  scene.bodies[2].self = true;
  for (guint64 n = 1;; n++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(n);
    SporeGrid *grid = spore_grid_create(&scene.spheres, scene.bodies, scene.body_count, 0, &error);
    if (grid) {
      g_assert_cmpuint(n, >, 20);
      spore_grid_free(grid);
      break;
    }
    g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  }
  spore_allocation_fail_at(0);
  scene_clear(&scene);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  random_source = g_rand_new_with_seed(11);
  g_test_add_func("/collide/random", test_random);
  g_test_add_func("/collide/apart", test_apart);
  g_test_add_func("/collide/remembers", test_remembers);
  g_test_add_func("/collide/extreme-ratio", test_extreme_ratio);
  g_test_add_func("/collide/moving", test_moving);
  g_test_add_func("/collide/fast-tool", test_fast_tool);
  g_test_add_func("/collide/coincident", test_coincident);
  g_test_add_func("/collide/pair-filter", test_pair_filter);
  g_test_add_func("/collide/self", test_self);
  g_test_add_func("/collide/not-finite", test_not_finite);
  g_test_add_func("/collide/many", test_many);
  g_test_add_func("/collide/overflow", test_overflow);
  g_test_add_func("/collide/refused", test_refused);
  g_test_add_func("/collide/empty", test_empty);
  g_test_add_func("/collide/without-memory", test_without_memory);
  g_test_add_func("/collide/passed", test_passed);
  g_test_add_func("/collide/set-apart", test_set_apart);
  g_test_add_func("/collide/passed-by", test_passed_by);
  int status = g_test_run();
  g_rand_free(random_source);
  return status;
}
