/* Collision detection alone: thread time of a detection, mean over steps in which the spheres move, least of several
 * runs. */
#include <glib.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "core/collide/depth_field.h"
#include "core/collide/grid.h"

typedef struct Case {
  SporeSpheres spheres;
  SporeGridBody *bodies;
  size_t body_count;
  double dt_s, side; /* s; m: what leaves the cube of this side at the origin turns round; 0: no cube */
} Case;

static double thread_us(void) {
  struct timespec now;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return (double)now.tv_sec * 1e6 + (double)now.tv_nsec * 1e-3;
}

static void case_init(Case *self, size_t count, size_t static_count, size_t body_count) {
  *self = (Case){.spheres = {count, static_count, g_new0(double, 3 * count), g_new0(double, 3 * count),
                             g_new0(double, count), g_new0(guint32, count)},
                 .bodies = g_new0(SporeGridBody, body_count),
                 .body_count = body_count,
                 .dt_s = 1e-3};
}

static void case_clear(Case *self) {
  g_free(self->spheres.centre);
  g_free(self->spheres.velocity);
  g_free(self->spheres.radius);
  g_free(self->spheres.body);
  g_free(self->bodies);
}

static void set_sphere(Case *self, size_t i, SporeVec3 centre, double radius, size_t body) {
  spore_vec3_store(self->spheres.centre + 3 * i, centre);
  self->spheres.radius[i] = radius;
  self->spheres.body[i] = (guint32)body;
}

static SporeVec3 random_vector(GRand *random, double amplitude) {
  return spore_vec3(g_rand_double_range(random, -amplitude, amplitude),
                    g_rand_double_range(random, -amplitude, amplitude),
                    g_rand_double_range(random, -amplitude, amplitude));
}

static void give_velocities(Case *self, GRand *random, double speed) {
  for (size_t i = self->spheres.static_count; i < self->spheres.count; i++)
    spore_vec3_store(self->spheres.velocity + 3 * i, random_vector(random, speed));
}

static void move(Case *self) {
  double *centre = self->spheres.centre, *velocity = self->spheres.velocity;
  for (size_t i = 3 * self->spheres.static_count; i < 3 * self->spheres.count; i++) {
    if (self->side > 0 && fabs(centre[i]) > 0.5 * self->side) velocity[i] = copysign(velocity[i], -centre[i]);
    centre[i] += self->dt_s * velocity[i];
  }
}

/* centre: where the spheres start, if not at rest. */
static void measure(Case *self, const char *name, const double *centre) {
  enum { RUNS = 5 };
  SporeGrid *grid = spore_grid_create(&self->spheres, self->bodies, self->body_count, 16 * self->spheres.count, NULL);
  if (centre) memcpy(self->spheres.centre, centre, 3 * self->spheres.count * sizeof *centre);
  size_t contacts = 0, missed = 0, steps = 32 + 400000 / (self->spheres.count + 1);
  if (steps > 400) steps = 400;
  double best = HUGE_VAL;
  for (int run = 0; run < RUNS; run++) {
    double spent = 0;
    for (size_t step = 0; step < steps; step++) {
      move(self);
      double start = thread_us();
      contacts = spore_grid_detect(grid, &self->spheres, self->dt_s, &missed);
      spent += thread_us() - start;
    }
    best = MIN(best, spent / (double)steps);
  }
  printf("%s, %zu contacts: %.4g us\n", name, contacts, best);
  spore_grid_free(grid);
  case_clear(self);
}

/* Loose spheres, each a body, of radii spread evenly over their orders of magnitude, filling a tenth of a cube. */
static void gas(GRand *random, size_t count, double ratio, double travel) {
  Case self;
  case_init(&self, count, 0, count);
  double volume = 0;
  for (size_t i = 0; i < count; i++) {
    double radius = 1e-3 * pow(ratio, g_rand_double(random));
    self.bodies[i].passive = true;
    self.spheres.radius[i] = radius;
    volume += 4.19 * radius * radius * radius;
  }
  self.side = cbrt(10 * volume);
  for (size_t i = 0; i < count; i++)
    set_sphere(&self, i, random_vector(random, 0.5 * self.side), self.spheres.radius[i], i);
  for (size_t i = 0; i < count; i++) {
    double speed = travel * self.spheres.radius[i] / self.dt_s;
    spore_vec3_store(self.spheres.velocity + 3 * i, random_vector(random, speed));
  }
  g_autofree char *name = g_strdup_printf("%zu moving, radii 1:%g, %g radii a step", count, ratio, travel);
  measure(&self, name, NULL);
}

/* Loose spheres packed on a floor of 400, at rest but for a tremble. */
static void pile(GRand *random, size_t count) {
  Case self;
  const double radius = 0.05, apart = 2 * radius * 0.995;
  case_init(&self, count + 400, 400, count + 1);
  for (size_t i = 0; i < 400; i++)
    set_sphere(&self, i, spore_vec3((double)(i % 20) * apart, -apart, (double)(i / 20) * apart), radius, 0);
  size_t layer = count > 1000 ? 20 : 12;
  for (size_t i = 0; i < count; i++) {
    double level = (double)(i / (layer * layer)), shift = i / (layer * layer) % 2 ? 0.5 * apart : 0;
    SporeVec3 centre = {shift + (double)(i % layer) * apart, level * apart * sqrt(0.5),
                        shift + (double)(i / layer % layer) * apart};
    set_sphere(&self, 400 + i, centre, radius, i + 1);
    self.bodies[i + 1].passive = true;
  }
  give_velocities(&self, random, 1e-5);
  g_autofree char *name = g_strdup_printf("settled pile of %zu on 400", count);
  measure(&self, name, NULL);
}

/* A sheet folded onto itself, trembling. */
static void sheet(GRand *random, size_t columns, size_t rows) {
  Case self;
  const double spacing = 0.05, radius = 0.02;
  size_t count = columns * rows;
  case_init(&self, count, 0, 1);
  self.bodies[0] = (SporeGridBody){.passive = true, .self = true};
  g_autofree double *folded = g_new(double, 3 * count);
  for (size_t i = 0; i < count; i++) {
    size_t column = i % columns, under = columns - 1 - column;
    double z = (double)(i / columns) * spacing;
    set_sphere(&self, i, spore_vec3((double)column * spacing, 0, z), radius, 0);
    spore_vec3_store(folded + 3 * i, under < column ? spore_vec3((double)under * spacing, 1.95 * radius, z)
                                                    : spore_vec3((double)column * spacing, 0, z));
  }
  give_velocities(&self, random, 0.02);
  g_autofree char *name = g_strdup_printf("folded sheet of %zu", count);
  measure(&self, name, folded);
}

/* A rigid body of 34 spheres sliding over a floor of 400. */
static void body_on_floor(void) {
  Case self;
  case_init(&self, 434, 400, 2);
  self.bodies[1].passive = true;
  for (size_t i = 0; i < 400; i++)
    set_sphere(&self, i, spore_vec3((double)(i % 20) * 0.05 - 0.5, -0.05, (double)(i / 20) * 0.05 - 0.5), 0.05, 0);
  for (size_t i = 0; i < 34; i++) {
    double turn = 2.39996 * (double)i, height = 1 - (2 * (double)i + 1) / 34, ring = sqrt(1 - height * height);
    set_sphere(&self, 400 + i, spore_vec3(0.2 * ring * cos(turn), 0.235 + 0.2 * height, 0.2 * ring * sin(turn)), 0.05,
               1);
    spore_vec3_store(self.spheres.velocity + 3 * (400 + i), spore_vec3(0.1, 0, 0.05));
  }
  measure(&self, "body of 34 on a floor of 400", NULL);
}

/* Depth and normal of a ball on a floor of spheres a radius apart, felt as one. */
static void depth_field(GRand *random) {
  enum { SIDE = 20, COUNT = SIDE * SIDE, CONTACTS = 1000, RUNS = 20 };
  g_autofree double *centre = g_new(double, 3 * COUNT), *radius = g_new(double, COUNT);
  for (size_t i = 0; i < COUNT; i++) {
    spore_vec3_store(centre + 3 * i, spore_vec3((double)(i % SIDE), -1, (double)(i / SIDE)));
    radius[i] = 1;
  }
  SporeDepthField field;
  if (!spore_depth_field_create(&field, centre, radius, NULL, 0, COUNT)) g_error("no memory");
  double best = HUGE_VAL, sum = 0;
  for (int run = 0; run < RUNS; run++) {
    double start = thread_us();
    for (size_t k = 0; k < CONTACTS; k++) {
      SporeVec3 normal, place = {0.3, 0.9, g_rand_double(random) - 0.5};
      place = spore_vec3_add(place, spore_vec3_load(centre + 3 * (SIDE * SIDE / 2 + SIDE / 2)));
      sum += spore_depth_field_ball(&field, SIDE * SIDE / 2 + SIDE / 2, spore_vec3_add(place, spore_vec3(0, 1, 0)), 1,
                                    &normal);
    }
    best = MIN(best, thread_us() - start);
  }
  printf("depth field, %d contacts of mean depth %.2f: %.4g us\n", CONTACTS, sum / (RUNS * CONTACTS), best);
  spore_depth_field_clear(&field);
}

int main(void) {
  GRand *random = g_rand_new_with_seed(5);
  for (size_t count = 1000; count <= 100000; count *= 10) {
    gas(random, count, 1, 0.02);
    gas(random, count, 100, 0.02);
    gas(random, count, 1, 0.5);
  }
  pile(random, 500);
  pile(random, 2000);
  sheet(random, 20, 25);
  sheet(random, 40, 50);
  body_on_floor();
  depth_field(random);
  g_rand_free(random);
  return 0;
}
