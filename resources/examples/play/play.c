/* A scene of the editor in a program of your own: loads a runtime file, leads one of its instruments by a device that
 * this program makes up, steps the world 1 kHz on a thread of its own, and reads the drawn vertices from another. Says
 * the steps of the scene's exercise as they are done, and the score.
 *
 *   spore export scene.spore --format runtime -o scene.run --dt 0.001
 *   ./play scene.run probe
 *
 * The library needs libc and libm alone. All numbers are SI. */
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <spore.h>

enum { STEPS = 500, FRAMES = 10 };

/* A device is whatever gives a pose and takes a force. This one goes around in a circle of 5 mm. */
typedef struct Circle {
  SporeDevice device; /* first member */
  double centre[3], orientation[4];
  double greatest; /* force that it was pushed with, N */
} Circle;

static bool exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command, SporeDeviceState *state) {
  Circle *circle = (Circle *)device; /* called once a step: must neither block nor allocate */
  double radius = 0.005, turn = 6.28 * time_s;
  *state = (SporeDeviceState){.velocity = {6.28 * radius * cos(turn), -6.28 * radius * sin(turn), 0}};
  memcpy(state->position, circle->centre, sizeof circle->centre);
  memcpy(state->orientation, circle->orientation, sizeof circle->orientation);
  state->position[0] += radius * sin(turn);
  state->position[1] += radius * (cos(turn) - 1);
  double force = sqrt(command->force[0] * command->force[0] + command->force[1] * command->force[1] +
                      command->force[2] * command->force[2]);
  if (force > circle->greatest) circle->greatest = force;
  return true;
}

static void close_nothing(SporeDevice *device) { (void)device; }

static const SporeDeviceType circle_type = {.name = "circle", .exchange = exchange, .close = close_nothing};

typedef struct Stepper {
  SporeWorld *world;
  SporeExercise *exercise; /* NULL: the scene has none */
  atomic_bool done;
} Stepper;

/* Looks at what the last step did; says what was done by it. */
static void watch(SporeExercise *exercise, const SporeWorld *world) {
  double before = spore_exercise_state(exercise).time_s;
  spore_exercise_watch(exercise, world);
  SporeExerciseState state = spore_exercise_state(exercise);
  for (size_t i = 0; state.time_s > before && i < state.steps; i++) {
    SporeStepState step = spore_exercise_step_state(exercise, i);
    if (step.done_s == state.time_s) printf("%.3f s: %s is done\n", step.done_s, step.name);
  }
}

/* One thread steps. It keeps pace with the clock where the scene's step is 1 ms. */
static void *step_all(void *data) {
  Stepper *stepper = data;
  struct timespec due;
  clock_gettime(CLOCK_MONOTONIC, &due);
  for (int i = 0; i < STEPS; i++) {
    spore_world_step(stepper->world);
    spore_world_tidy(stepper->world); /* between steps: makes room that a step may not make */
    if (stepper->exercise) watch(stepper->exercise, stepper->world);
    due.tv_nsec += 1000000;
    if (due.tv_nsec >= 1000000000) due.tv_nsec -= 1000000000, due.tv_sec++;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &due, NULL);
  }
  atomic_store(&stepper->done, true);
  return NULL;
}

/* Another thread reads: what a renderer would do for each picture. Returns how far a vertex has come at most, m. */
static double read_vertices(SporeRuntime *runtime, double *vertices) {
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(spore_runtime_world(runtime));
  SporeError error = SPORE_ERROR_INIT;
  double farthest = 0;
  for (size_t i = 0; i < spore_runtime_visual_count(runtime); i++) {
    const SporeTriangleMesh *mesh = spore_runtime_visual(runtime, i)->mesh;
    if (!spore_runtime_vertices(runtime, i, snapshot, vertices, &error)) {
      fprintf(stderr, "%s: %s\n", error.place, error.message);
      exit(1);
    }
    /* Hand `vertices` and mesh->triangles to your graphics here. */
    for (size_t k = 0; k < 3 * mesh->vertex_count; k++) farthest = fmax(farthest, fabs(vertices[k]));
  }
  return farthest;
}

static size_t most_vertices(const SporeRuntime *runtime) {
  size_t most = 1;
  for (size_t i = 0; i < spore_runtime_visual_count(runtime); i++) {
    size_t count = spore_runtime_visual(runtime, i)->mesh->vertex_count;
    if (count > most) most = count;
  }
  return most;
}

int main(int argc, char **argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: play FILE.run INSTRUMENT\n");
    return 2;
  }
  SporeError error = SPORE_ERROR_INIT;
  SporeRuntime *runtime = spore_runtime_load(argv[1], spore_model_registry, NULL, NULL, &error);
  if (!runtime) {
    fprintf(stderr, "%s: %s\n", error.place, error.message); /* where, what is wrong, what to do */
    return 2;
  }
  SporeWorld *world = spore_runtime_world(runtime);
  uint32_t body = spore_world_find_body(world, argv[2]);
  if (body == SPORE_NO_BODY || spore_world_body_role(world, body) != SPORE_ACTIVE) {
    fprintf(stderr, "%s: the scene has no instrument of that name\n", argv[2]);
    spore_runtime_free(runtime);
    return 2;
  }
  Circle circle = {.device = {&circle_type, {0}}};
  const double *q = spore_world_q(world, body); /* position, then orientation w x y z */
  memcpy(circle.centre, q, sizeof circle.centre);
  memcpy(circle.orientation, q + 3, sizeof circle.orientation);
  spore_world_set_device(world, body, &circle.device); /* takes the place of the recorded input */

  Stepper stepper = {.world = world, .exercise = spore_runtime_exercise(runtime)};
  pthread_t thread;
  double *vertices = malloc(3 * most_vertices(runtime) * sizeof *vertices), farthest = 0;
  if (!vertices || pthread_create(&thread, NULL, step_all, &stepper) != 0) return 1;
  for (int frame = 0; frame < FRAMES || !atomic_load(&stepper.done); frame++) {
    farthest = read_vertices(runtime, vertices);
    nanosleep(&(struct timespec){.tv_nsec = 16000000}, NULL);
  }
  pthread_join(thread, NULL);
  printf("%.3f s, %zu meshes within %.3f m, pushed by %.3f N at most, state %016llx\n", spore_world_time_s(world),
         spore_runtime_visual_count(runtime), farthest, circle.greatest, (unsigned long long)spore_world_hash(world));
  if (stepper.exercise) printf("score %.17g of 100\n", spore_exercise_state(stepper.exercise).score);
  free(vertices);
  spore_runtime_free(runtime);
  return 0;
}
