/* Would spheres that follow where a net bends pay? A net of 20 x 20 nodes, 90 mm wide, is folded by 180 degrees about
 * its middle, and holds still; about 500 spheres of 2 mm lie on its facets, spread evenly, or a part of them moved into
 * the fold, or as many more put there from a reserve, or as many more spread evenly. A ball is pressed on it along the
 * facets' normals, until it feels 0.05 N: how far it is below where it touches the true surface, which is what spheres
 * apart from each other leave open, in the fold and where the net is flat; and what a step costs there, in thread time.
 */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "tests/stability/rig.h"

#define WIDTH 0.09
#define NODES 20
#define SPHERES 500
#define RADIUS 0.002
#define FORCE 0.05
#define PLACES 400

/* Along the net at u, 0..WIDTH: the folded sheet, of which the net has the nodes. */
static SporeVec3 sheet_at(double u, double fold) {
  double first = 0.5 * (WIDTH - G_PI * fold), turn = (u - first) / fold;
  if (turn <= 0) return spore_vec3(u - first, 0, fold);
  if (turn >= G_PI) return spore_vec3(-(u - first - G_PI * fold), 0, -fold);
  return spore_vec3(fold * sin(turn), 0, fold * cos(turn));
}

/* On the facets, at v across, and the normal out of the fold. */
static SporeVec3 net_at(double u, double v, double fold, SporeVec3 *normal) {
  double edge = WIDTH / (NODES - 1), facet = fmin(floor(u / edge), NODES - 2), part = u / edge - facet;
  SporeVec3 a = sheet_at(facet * edge, fold), b = sheet_at((facet + 1) * edge, fold);
  *normal = spore_vec3_normalise(spore_vec3_cross(spore_vec3_sub(b, a), spore_vec3(0, 1, 0)), spore_vec3(0, 0, 1));
  SporeVec3 at = spore_vec3_add_scaled(a, part, spore_vec3_sub(b, a));
  at.y = v;
  return at;
}

/* Rows of points at the corners of even triangles of side s, from u = from to u = to; into points where that is not
 * NULL. How many. */
static size_t spread(double s, double from, double to, double fold, double *points) {
  size_t count = 0;
  for (int row = 0; from + row * s * sqrt(0.75) <= to; row++)
    for (double v = row % 2 ? 0.5 * s : 0; v <= WIDTH; v += s, count++) {
      SporeVec3 normal;
      if (points) spore_vec3_store(points + 3 * count, net_at(from + row * s * sqrt(0.75), v, fold, &normal));
    }
  return count;
}

/* As many as that is, and no more. */
static size_t spread_count(size_t most, double from, double to, double fold, double *points) {
  double s = 0.5 * sqrt((to - from) * WIDTH / (double)most);
  while (spread(s, from, to, fold, NULL) > most) s *= 1.001;
  return spread(s, from, to, fold, points);
}

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

static double force_at(SporeWorld *world, Hand *hand, SporeVec3 at, SporeVec3 normal) {
  hand->at = at;
  spore_world_step(world);
  spore_world_step(world); /* arrived: it does not move */
  return spore_vec3_dot(normal, spore_vec3_load(spore_world_snapshot_acquire(world)->reaction + 6));
}

static double gap_at(SporeWorld *world, Hand *hand, double u, double v, double fold, double ball) {
  SporeVec3 normal, place = net_at(u, v, fold, &normal);
  double low = ball + RADIUS, high = low; /* from outside: behind a sphere's middle it pushes the other way */
  while (low > 0 && force_at(world, hand, spore_vec3_add_scaled(place, low, normal), normal) <= FORCE) {
    high = low;
    low -= 1e-4;
  }
  for (int i = 0; i < 8; i++) {
    double middle = 0.5 * (low + high);
    bool presses = force_at(world, hand, spore_vec3_add_scaled(place, middle, normal), normal) > FORCE;
    *(presses ? &low : &high) = middle;
  }
  return ball + RADIUS - low;
}

static int by_size(const void *a, const void *b) {
  double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static void measure(SporeWorld *world, Hand *hand, double from, double to, double fold, double ball) {
  double gaps[PLACES], sum = 0;
  for (int i = 0; i < PLACES; i++) {
    double along = fmod(0.6180339887 * i, 1), across = fmod(0.7548776662 * i, 1);
    gaps[i] = gap_at(world, hand, from + along * (to - from), WIDTH * (0.25 + 0.5 * across), fold, ball);
    sum += gaps[i] / PLACES;
  }
  qsort(gaps, PLACES, sizeof *gaps, by_size);
  printf("  %.2f %.2f %.2f", 1e3 * sum, 1e3 * gaps[PLACES * 95 / 100], 1e3 * gaps[PLACES - 1]);
}

static double thread_us(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

/* us a step where the ball goes to and fro on the fold. */
static double cost(SporeWorld *world, Hand *hand, double fold, double ball) {
  double best = HUGE_VAL;
  for (int run = 0; run < 5; run++) {
    double start = thread_us();
    for (int i = 0; i < 1000; i++) {
      SporeVec3 normal, place = net_at(0.5 * WIDTH, WIDTH * (0.5 + 0.2 * sin(0.01 * i)), fold, &normal);
      hand->at = spore_vec3_add_scaled(place, ball, normal);
      spore_world_step(world);
    }
    best = fmin(best, (thread_us() - start) / 1000);
  }
  return best;
}

/* Where spheres in the fold come from. */
typedef enum Source { MOVED, RESERVE, MORE, SOURCES } Source;
static const char *const sources[] = {"moved", "reserve", "more"};

/* share: of SPHERES, that are moved, in reserve, or more everywhere. */
static void compare(double fold, double ball, double share, Source source) {
  double points[3 * (2 * SPHERES + 1)], bend = 0.5 * G_PI * fold;
  double from = 0.5 * WIDTH - bend, to = 0.5 * WIDTH + bend;
  const double evenly[SOURCES] = {1 - share, 1, 1 + share};
  size_t even = spread_count((size_t)(evenly[source] * SPHERES), 0, WIDTH, fold, points), count = even;
  if (share > 0 && source != MORE) count += spread_count((size_t)(share * SPHERES), from, to, fold, points + 3 * even);
  Rig *rig = rig_new();
  Hand hand = {{&hand_type}, spore_vec3(0, 0, 1)};
  SporeBodyDescription *net = rig_unmovable(rig, "net", rig_spheres(rig, points, count, RADIUS));
  net->contact.friction = net->contact.damping = 0;
  net->contact.stiffness = 2000;
  SporeBodyDescription *tool = rig_active(rig, "tool", rig_sphere(rig, ball));
  tool->contact = net->contact;
  tool->pose.position = hand.at;
  SporeWorld *world = rig_build(rig);
  spore_world_set_device(world, 1, &hand.base);
  printf("%3.0f mm %4.1f mm %3.0f %% %s %4zu", 1e3 * fold, 1e3 * ball, 100 * share, sources[source], count);
  measure(world, &hand, from, to, fold, ball);
  measure(world, &hand, 0.05 * WIDTH, 0.25 * WIDTH, fold, ball);
  printf("  %.2f\n", cost(world, &hand, fold, ball));
  rig_free(rig);
}

int main(void) {
  printf("radius of the fold, of the ball; spheres moved, in reserve or more, all; gap in the fold: mean, 95th "
         "percentile, most, mm; gap "
         "where it is flat: the same; us a step\n");
  const double folds[] = {0.003, 0.006, 0.012}, parts[] = {0, 0.1, 0.2, 0.4};
  for (size_t f = 0; f < G_N_ELEMENTS(folds); f++)
    for (size_t p = 0; p < G_N_ELEMENTS(parts); p++)
      for (Source source = MOVED; source < (p > 0 ? SOURCES : RESERVE); source++)
        compare(folds[f], 0.0025, parts[p], source);
  return 0;
}
