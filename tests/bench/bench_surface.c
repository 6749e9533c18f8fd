/* What a ball feels that is led over a body at a steady depth: its spheres one by one, or all as one depth field.
 * Against the body's true surface: the direction of the force, the depth that it stands for, how unsteady it is on the
 * way, and what a step costs beside one that touches nothing, in thread time. Where an organ's true surface touches the
 * ball in two places at once there is no one normal, and nothing is judged. The argument is the folder of the organs.
 */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <time.h>

#include "core/base/memory.h"
#include "core/io/mesh_import.h"
#include "core/io/off.h"
#include "core/mesh/bvh.h"
#include "tests/stability/rig.h"

#define PLACES 2000
#define DEPTH 0.1 /* of the mean radius of the body's spheres */

typedef struct Body Body;
struct Body {
  const char *name;
  SporeSphereSet spheres;
  double mean_radius;
  SporeBvh *surface;
  /* Where a ball of that radius touches the true surface, `depth` deep, at part 0..1 of the way; *normal out of it. */
  SporeVec3 (*place)(const Body *body, double part, double radius, double depth, SporeVec3 *normal);
};

static void finish(Body *body) {
  for (size_t i = 0; i < body->spheres.count; i++)
    body->mean_radius += body->spheres.spheres[4 * i + 3] / (double)body->spheres.count;
}

static void set_sphere(Body *body, size_t i, SporeVec3 centre, double radius) {
  spore_vec3_store(body->spheres.spheres + 4 * i, centre);
  body->spheres.spheres[4 * i + 3] = radius;
}

/* Spheres a radius apart, tops at y = 0, along a way askew to their rows. */
static SporeVec3 place_on_plane(const Body *body, double part, double radius, double depth, SporeVec3 *normal) {
  *normal = spore_vec3(0, 1, 0);
  return spore_vec3(0.15 * (part - 0.5), radius - depth, 0.05 * (part - 0.5));
}

static Body make_plane(void) {
  enum { SIDE = 31 };
  Body body = {.name = "plane", .place = place_on_plane};
  g_assert_true(spore_sphere_set_allocate(&body.spheres, SIDE * SIDE, NULL));
  for (size_t i = 0; i < SIDE * SIDE; i++)
    set_sphere(&body, i,
               spore_vec3(0.01 * ((double)(i % SIDE) - SIDE / 2), -0.01, 0.01 * ((double)(i / SIDE) - SIDE / 2)), 0.01);
  finish(&body);
  return body;
}

/* A ball of 3 cm of spheres of 1 cm that touch its surface from inside, on a spiral from pole to pole. */
static SporeVec3 place_on_ball(const Body *body, double part, double radius, double depth, SporeVec3 *normal) {
  double height = 0.8 * (2 * part - 1), turn = 12 * part, ring = sqrt(1 - height * height);
  *normal = spore_vec3(ring * cos(turn), height, ring * sin(turn));
  return spore_vec3_scale(0.03 + radius - depth, *normal);
}

static Body make_ball(void) {
  enum { COUNT = 60 };
  Body body = {.name = "ball", .place = place_on_ball};
  g_assert_true(spore_sphere_set_allocate(&body.spheres, COUNT, NULL));
  for (size_t i = 0; i < COUNT; i++) {
    double height = 1 - (2 * (double)i + 1) / COUNT, turn = 2.39996322972865 * (double)i,
           ring = sqrt(1 - height * height);
    set_sphere(&body, i, spore_vec3_scale(0.02, spore_vec3(ring * cos(turn), height, ring * sin(turn))), 0.01);
  }
  finish(&body);
  return body;
}

/* Whether the ball is in the true surface elsewhere than about its one nearest place. */
static gboolean touches_twice(const Body *body, SporeVec3 centre, double radius, double depth, SporeVec3 normal) {
  enum { DIRECTIONS = 64 };
  const double cap = 0.8 * (1 - depth / radius); /* on a plane, those nearer to the normal are inside */
  for (int i = 0; body->surface && i < DIRECTIONS; i++) {
    double height = 1 - (2. * i + 1) / DIRECTIONS, turn = 2.39996322972865 * i, ring = sqrt(1 - height * height);
    SporeVec3 out = {ring * cos(turn), height, ring * sin(turn)};
    if (spore_vec3_dot(out, normal) > -cap &&
        spore_bvh_depth(body->surface, spore_vec3_add_scaled(centre, radius, out)) > 0)
      return TRUE;
  }
  return FALSE;
}

/* Round the organ; the ball's centre is brought to the depth along the way to the nearest place of the surface. */
static SporeVec3 place_on_organ(const Body *body, double part, double radius, double depth, SporeVec3 *normal) {
  double height = 0.6 * (2 * part - 1), turn = 12 * part, ring = sqrt(1 - height * height), t = 0;
  SporeVec3 out = {ring * cos(turn), height, ring * sin(turn)}, far = spore_vec3_scale(1, out);
  if (!spore_bvh_ray(body->surface, far, spore_vec3_scale(-1, out), &t, NULL)) g_error("the way misses the organ");
  SporeVec3 centre = spore_vec3_add_scaled(far, -t + radius, out);
  *normal = out;
  for (int i = 0; i < 20; i++) {
    SporeVec3 nearest;
    double distance = spore_bvh_distance(body->surface, centre, &nearest, NULL);
    *normal = spore_vec3_scale(1 / distance, spore_vec3_sub(centre, nearest));
    centre = spore_vec3_add_scaled(nearest, radius - depth, *normal);
  }
  return centre;
}

static void read_file(const char *folder, const char *name, char **text, gsize *size) {
  g_autofree char *path = g_build_filename(folder, name, NULL);
  GError *error = NULL;
  if (!g_file_get_contents(path, text, size, &error)) g_error("%s", error->message);
}

static Body make_organ(const char *folder) {
  Body body = {.name = "uterus", .place = place_on_organ};
  g_autofree char *spheres = NULL, *surface = NULL;
  gsize spheres_size, surface_size;
  SporeTriangleMesh mesh;
  read_file(folder, "uterus.spheres", &spheres, &spheres_size);
  read_file(folder, "uterus.off", &surface, &surface_size);
  GError *error = NULL;
  if (!spore_spheres_parse("uterus.spheres", spheres, spheres_size, &body.spheres, &error))
    g_error("%s", error->message);
  if (!spore_off_parse("uterus.off", surface, surface_size, &mesh, &error)) g_error("%s", error->message);
  body.surface = spore_bvh_create(&mesh, NULL);
  spore_triangle_mesh_clear(&mesh);
  finish(&body);
  return body;
}

/* A device that stands where the bench puts it. */
typedef struct Hand {
  SporeDevice base;
  SporeVec3 at;
} Hand;

static bool exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  *state = (SporeDeviceState){.orientation = {1, 0, 0, 0}};
  spore_vec3_store(state->position, ((const Hand *)device)->at);
  return true;
}

static void close_hand(SporeDevice *device) {}
static const SporeDeviceType hand_type = {.name = "hand", .doc = "", .exchange = exchange, .close = close_hand};

typedef struct Felt {
  double angle, worst_angle; /* degrees between the force and the true normal */
  double depth;              /* root mean square of (force / stiffness - depth) / depth */
  double unsteady;           /* root mean square of a change of the force along 1/50 of a radius, of its mean */
  double us;
} Felt;

static double thread_us(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

static SporeWorld *make_world(Rig *rig, const Body *body, double radius, SporeSurface surface, Hand *hand) {
  SporeBodyDescription *organ = rig_unmovable(rig, body->name, &body->spheres);
  organ->contact.surface = (int)surface;
  organ->contact.friction = organ->contact.damping = 0;
  organ->contact.stiffness = 2000; /* 1000 with the ball's in series */
  SporeBodyDescription *ball = rig_active(rig, "ball", rig_sphere(rig, radius));
  ball->contact.friction = ball->contact.damping = 0;
  ball->contact.stiffness = 2000;
  ball->pose.position = hand->at;
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &hand->base);
  return world;
}

static SporeVec3 force_at(SporeWorld *world, Hand *hand, SporeVec3 at) {
  hand->at = at;
  spore_world_step(world);
  spore_world_step(world); /* arrived: it does not move */
  return spore_vec3_load(spore_world_snapshot_acquire(world)->reaction + 6);
}

/* us a step at places all along the way, less those of steps in the open. */
static double cost(SporeWorld *world, Hand *hand, const SporeVec3 *places) {
  double best[2] = {HUGE_VAL, HUGE_VAL};
  for (int run = 0; run < 8; run++)
    for (int open = 0; open < 2; open++) {
      double start = thread_us();
      for (int i = 0; i < PLACES; i++) {
        hand->at = open ? spore_vec3_add(places[i], spore_vec3(5, 0, 0)) : places[i];
        spore_world_step(world);
      }
      best[open] = fmin(best[open], (thread_us() - start) / PLACES);
    }
  return best[0] - best[1];
}

static Felt feel(const Body *body, double radius, SporeSurface surface) {
  Rig *rig = rig_new();
  SporeVec3 normal, *places = g_new(SporeVec3, PLACES), before = {0, 0, 0}, last = {0, 0, 0};
  const double depth = DEPTH * body->mean_radius;
  Hand hand = {{&hand_type}, body->place(body, 0, radius, depth, &normal)};
  SporeWorld *world = make_world(rig, body, radius, surface, &hand);
  Felt felt = {0};
  double mean = 0, changes = 0, judged = 0;
  for (int i = 0; i < PLACES; i++) {
    places[i] = body->place(body, (double)i / PLACES, radius, depth, &normal);
    SporeVec3 force = force_at(world, &hand, places[i]);
    double size = spore_vec3_length(force), way = i ? spore_vec3_distance(places[i], before) / body->mean_radius : 0;
    if (way > 0 && way < 0.2) felt.unsteady += pow(spore_vec3_distance(force, last) * 0.02 / way, 2), changes++;
    before = places[i];
    last = force;
    mean += size / PLACES;
    if (touches_twice(body, places[i], radius, depth, normal)) continue;
    double angle = size > 0 ? acos(fmin(1, spore_vec3_dot(force, normal) / size)) * 180 / G_PI : 90;
    felt.angle += angle;
    felt.worst_angle = fmax(felt.worst_angle, angle);
    felt.depth += pow((size / 1000 - depth) / depth, 2);
    judged++;
  }
  felt.angle /= judged;
  felt.depth /= judged;
  felt.depth = sqrt(felt.depth);
  felt.unsteady = sqrt(felt.unsteady / changes) / mean;
  felt.us = cost(world, &hand, places);
  rig_free(rig);
  g_free(places);
  return felt;
}

int main(int argc, char **argv) {
  if (argc != 2) g_error("usage: bench_surface FOLDER_OF_ORGANS");
  Body bodies[] = {make_plane(), make_ball(), make_organ(argv[1])};
  static const double sizes[] = {0.25, 0.5, 1, 2};
  for (size_t b = 0; b < G_N_ELEMENTS(bodies); b++) {
    Body *body = &bodies[b];
    for (size_t s = 0; s < G_N_ELEMENTS(sizes); s++) {
      Felt one[2];
      for (int surface = 0; surface < 2; surface++) one[surface] = feel(body, sizes[s] * body->mean_radius, surface);
      static const char *const names[] = {"spheres", "depth_field"};
      for (int surface = 0; surface < 2; surface++)
        printf("%s, ball of %g r, %s: normal %.3f deg, worst %.3f deg, depth %.3f, unsteady %.4f, cost %.3f us\n",
               body->name, sizes[s], names[surface], one[surface].angle, one[surface].worst_angle, one[surface].depth,
               one[surface].unsteady, one[surface].us);
    }
    spore_sphere_set_clear(&body->spheres);
    spore_bvh_free(body->surface);
  }
  return 0;
}
