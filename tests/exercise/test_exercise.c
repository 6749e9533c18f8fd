/* Exercises: what a watch takes, what a pause and a new beginning do, and in which orders steps are done. What events
 * and metrics say is held by e2e/exercise. */
#include <math.h>

#include "core/base/memory.h"
#include "core/exercise/exercise.h"
#include "tests/stability/rig.h"

#define H 0.01
#define PLACES 6

/* A ball that goes along x at 1 m/s from the origin, and a step at each of PLACES places, 0.1 m apart. */
typedef struct Course {
  Rig *rig;
  RigMover mover;
  SporeWorld *world;
  SporeInstrument instrument;
  SporeExerciseStep steps[PLACES];
  SporeExerciseMetric metrics[2];
  SporeExerciseDescription description;
} Course;

static void set_up(Course *course) {
  static const char *const names[PLACES] = {"a", "b", "c", "d", "e", "f"};
  *course = (Course){.rig = rig_new(), .mover = {{&rig_mover_type}, {0, 0, 0}, {1, 0, 0}}};
  course->rig->description.solver.time_step = H;
  rig_active(course->rig, "tip", rig_sphere(course->rig, 0.01));
  course->world = rig_build(course->rig);
  spore_world_set_device(course->world, 0, &course->mover.base);
  course->instrument = (SporeInstrument){"one", {0, SPORE_NO_BODY, SPORE_NO_BODY}, SPORE_NO_PART};
  for (uint32_t i = 0; i < PLACES; i++)
    course->steps[i] = (SporeExerciseStep){
        .kind = spore_event_kind_find("reached"),
        .fields = {.name = names[i], .hint = "go on", .point = {0.1 * (i + 1), 0, 0}, .radius = 0.02},
        .body = SPORE_NO_BODY,
        .container = SPORE_NO_BODY,
        .after = SPORE_NO_PART};
  course->metrics[0] = (SporeExerciseMetric){.kind = spore_metric_kind_find("path_length"),
                                             .fields = {.name = "path", .good = "50 cm", .source = "test", .weight = 1},
                                             .instrument = SPORE_NO_PART};
  course->metrics[1] = (SporeExerciseMetric){.kind = spore_metric_kind_find("time_taken"), .fields = {.name = "time"}};
  course->description = (SporeExerciseDescription){.fields = {.task = "go"},
                                                   .instrument_count = 1,
                                                   .instruments = &course->instrument,
                                                   .step_count = PLACES,
                                                   .steps = course->steps,
                                                   .metric_count = 2,
                                                   .metrics = course->metrics};
}

static SporeExercise *create(const Course *course) {
  SporeError error = SPORE_ERROR_INIT;
  SporeExercise *exercise = spore_exercise_create(&course->description, course->world, &error);
  g_assert_nonnull(exercise);
  return exercise;
}

static void run(const Course *course, SporeExercise *exercise, unsigned steps) {
  for (unsigned i = 0; i < steps; i++) {
    spore_world_step(course->world);
    spore_exercise_watch(exercise, course->world);
  }
}

static void test_watching(void) {
  Course course;
  set_up(&course);
  SporeExercise *exercise = create(&course);
  run(&course, exercise, 1);
  uint64_t before = spore_allocation_count();
  run(&course, exercise, 99);
  g_assert_cmpuint(spore_allocation_count(), ==, before);
  SporeExerciseState state = spore_exercise_state(exercise);
  g_assert_cmpint(state.phase, ==, SPORE_EXERCISE_DONE);
  g_assert_cmpuint(state.steps_done, ==, PLACES);
  g_assert_cmpstr(spore_exercise_step_state(exercise, 2).name, ==, "c");
  g_assert_cmpstr(spore_exercise_step_state(exercise, 2).hint, ==, "go on");
  g_assert_cmpint(spore_exercise_metric_state(exercise, 0).verdict, ==, SPORE_METRIC_FAIL); /* it went 0.58 m */
  g_assert_cmpfloat(state.score, ==, 0);
  g_assert_false(state.passed);
  spore_exercise_free(exercise);
  rig_free(course.rig);
}

/* What happens while it is paused does not count, and the clock stands still; a new beginning forgets all. */
static void test_pause_and_restart(void) {
  Course course;
  set_up(&course);
  SporeExercise *exercise = create(&course);
  run(&course, exercise, 15);
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, 1);
  spore_exercise_pause(exercise, true);
  run(&course, exercise, 20);
  g_assert_true(spore_exercise_state(exercise).paused);
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, 1);
  spore_exercise_pause(exercise, false);
  run(&course, exercise, 10);
  g_assert_cmpfloat_with_epsilon(spore_exercise_state(exercise).time_s, 25 * H, 1e-12);
  g_assert_cmpint(spore_exercise_step_state(exercise, 1).phase, ==, SPORE_STEP_OPEN);
  g_assert_cmpint(spore_exercise_step_state(exercise, 3).phase, ==, SPORE_STEP_DONE);
  spore_world_reset(course.world);
  spore_exercise_restart(exercise, course.world);
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, 0);
  g_assert_cmpfloat(spore_exercise_metric_state(exercise, 0).value, ==, 0);
  run(&course, exercise, 100);
  g_assert_cmpint(spore_exercise_state(exercise).phase, ==, SPORE_EXERCISE_DONE);
  g_assert_true(isfinite(spore_exercise_step_state(exercise, 1).done_s));
  spore_exercise_free(exercise);
  rig_free(course.rig);
}

/* What a step waits for counts as done where the try-out goes on from that step; what comes after is done as ever. */
static void test_skip(void) {
  Course course;
  set_up(&course);
  course.description.fields.order = SPORE_ORDER_GIVEN;
  SporeExercise *exercise = create(&course);
  run(&course, exercise, 25); /* past the second place: two steps are done */
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, 2);
  spore_exercise_skip_to(exercise, 2); /* open already */
  g_assert_false(spore_exercise_state(exercise).tried);
  spore_exercise_skip_to(exercise, 4);
  g_assert_true(spore_exercise_state(exercise).tried);
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, 4);
  g_assert_cmpfloat_with_epsilon(spore_exercise_step_state(exercise, 3).done_s, 25 * H, 1e-12);
  g_assert_cmpfloat(spore_exercise_step_state(exercise, 1).done_s, <, 24 * H);
  g_assert_cmpint(spore_exercise_step_state(exercise, 4).phase, ==, SPORE_STEP_OPEN);
  g_assert_cmpint(spore_exercise_step_state(exercise, 5).phase, ==, SPORE_STEP_WAITING);
  run(&course, exercise, 55);
  g_assert_cmpint(spore_exercise_state(exercise).phase, ==, SPORE_EXERCISE_DONE);
  spore_exercise_skip_to(exercise, 5);
  spore_world_reset(course.world);
  spore_exercise_restart(exercise, course.world);
  g_assert_false(spore_exercise_state(exercise).tried);
  g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, 0);
  spore_exercise_free(exercise);
  rig_free(course.rig);
}

/* What has to last and ends is an error, while a step waits for it; what waits, waits anew. */
static void test_stays(void) {
  for (int waited = 0; waited < 2; waited++) {
    Course course;
    set_up(&course);
    course.steps[0].fields.stays = true;
    if (waited) course.steps[1].after = 0, course.steps[5].after = 1;
    SporeExercise *exercise = create(&course);
    run(&course, exercise, 11); /* at the first place */
    g_assert_cmpint(spore_exercise_step_state(exercise, 0).phase, ==, SPORE_STEP_DONE);
    run(&course, exercise, 70); /* past the last */
    SporeStepState first = spore_exercise_step_state(exercise, 0), second = spore_exercise_step_state(exercise, 1);
    g_assert_cmpint(first.phase, ==, waited ? SPORE_STEP_OPEN : SPORE_STEP_DONE);
    g_assert_cmpuint(first.lost, ==, waited ? 1 : 0);
    g_assert_cmpuint(spore_exercise_state(exercise).errors, ==, waited ? 1 : 0);
    g_assert_true(isnan(first.done_s) == (waited == 1));
    g_assert_cmpint(second.phase, ==, waited ? SPORE_STEP_WAITING : SPORE_STEP_DONE);
    g_assert_cmpuint(spore_exercise_state(exercise).steps_done, ==, waited ? PLACES - 3 : PLACES);
    spore_exercise_free(exercise);
    rig_free(course.rig);
  }
}

/* A step that a try-out skips need not last. */
static void test_skipped_need_not_last(void) {
  Course course;
  set_up(&course);
  course.steps[0].fields.stays = true;
  course.steps[1].after = 0;
  SporeExercise *exercise = create(&course);
  spore_exercise_skip_to(exercise, 1);
  run(&course, exercise, 25); /* past the second place */
  g_assert_cmpint(spore_exercise_step_state(exercise, 1).phase, ==, SPORE_STEP_DONE);
  g_assert_cmpuint(spore_exercise_step_state(exercise, 0).lost, ==, 0);
  spore_exercise_free(exercise);
  rig_free(course.rig);
}

/* Steps in a random order: the ball passes the places in turn, so that a step is done just where the one that it waits
 * for was done before, and lies before it on the way. */
static void test_random_orders(void) {
  g_autoptr(GRand) random = g_rand_new_with_seed(7);
  for (unsigned trial = 0; trial < 40; trial++) {
    Course course;
    set_up(&course);
    uint32_t order[PLACES];
    for (uint32_t i = 0; i < PLACES; i++) order[i] = i;
    for (uint32_t i = PLACES - 1; i > 0; i--) {
      uint32_t k = (uint32_t)g_rand_int_range(random, 0, (gint32)i + 1), swap = order[i];
      order[i] = order[k], order[k] = swap;
    }
    for (uint32_t i = 1; i < PLACES; i++)
      if (g_rand_boolean(random)) course.steps[order[i]].after = order[i - 1];
    SporeExercise *exercise = create(&course);
    run(&course, exercise, 80);
    for (uint32_t i = 0; i < PLACES; i++) {
      bool can = true;
      for (uint32_t k = i; can && course.steps[k].after != SPORE_NO_PART; k = course.steps[k].after)
        can = course.steps[k].after < k;
      g_assert_cmpint(spore_exercise_step_state(exercise, i).phase == SPORE_STEP_DONE, ==, can);
    }
    spore_exercise_free(exercise);
    rig_free(course.rig);
  }
}

static void test_refused(void) {
  Course course;
  set_up(&course);
  SporeError error = SPORE_ERROR_INIT;
  course.steps[0].after = 2, course.steps[2].after = 1, course.steps[1].after = 0;
  g_assert_null(spore_exercise_create(&course.description, course.world, &error));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_cmpstr(error.place, ==, "exercise/a");
  course.steps[0].after = SPORE_NO_PART;
  course.metrics[0].fields.good = "50";
  g_assert_null(spore_exercise_create(&course.description, course.world, &error));
  g_assert_cmpstr(error.place, ==, "exercise/path");
  course.metrics[0].fields.good = NULL;
  course.description.instrument_count = SPORE_INSTRUMENTS_MOST + 1;
  g_assert_null(spore_exercise_create(&course.description, course.world, &error));
  g_assert_cmpstr(error.place, ==, "exercise");
  rig_free(course.rig);
}

/* Every want of memory is said, and nothing is left over. */
static void test_memory(void) {
  Course course;
  set_up(&course);
  SporeExercise *exercise = NULL;
  unsigned tries = 0;
  for (; !exercise; tries++) {
    SporeError error = SPORE_ERROR_INIT;
    spore_allocation_fail_at(tries + 1);
    exercise = spore_exercise_create(&course.description, course.world, &error);
    spore_allocation_fail_at(0);
    if (!exercise) g_assert_cmpint(error.code, ==, SPORE_ERROR_MEMORY);
  }
  g_assert_cmpuint(tries, >, 8 + 2 * PLACES);
  spore_exercise_free(exercise);
  rig_free(course.rig);
}

/* Where less is better nothing is good before all steps are done, and the mark is 0; what is worse than pass has
 * failed. Of an exercise without steps all is judged at once. */
static void test_unfinished(void) {
  Course course;
  set_up(&course);
  course.metrics[0].fields.pass = "60 cm";
  course.metrics[1].fields.good = course.metrics[1].fields.pass = "1 min";
  course.metrics[1].fields.weight = 1;
  SporeExercise *exercise = create(&course);
  run(&course, exercise, 50);
  for (size_t i = 0; i < 2; i++) {
    g_assert_cmpint(spore_exercise_metric_state(exercise, i).verdict, ==, SPORE_METRIC_UNFINISHED);
    g_assert_cmpfloat(spore_exercise_metric_state(exercise, i).mark, ==, 0);
  }
  g_assert_cmpfloat(spore_exercise_state(exercise).score, ==, 0);
  run(&course, exercise, 20);
  g_assert_cmpint(spore_exercise_metric_state(exercise, 0).verdict, ==, SPORE_METRIC_PASS);
  g_assert_cmpint(spore_exercise_metric_state(exercise, 1).verdict, ==, SPORE_METRIC_GOOD);
  g_assert_true(spore_exercise_state(exercise).passed);
  g_assert_cmpfloat(spore_exercise_state(exercise).score, >, 70);
  spore_exercise_free(exercise);
  course.description.step_count = 0;
  exercise = create(&course);
  g_assert_cmpint(spore_exercise_metric_state(exercise, 1).verdict, ==, SPORE_METRIC_GOOD);
  spore_exercise_free(exercise);
  course.steps[0].fields.point[0] = 50; /* out of reach */
  course.description.step_count = 1;
  exercise = create(&course);
  run(&course, exercise, 70);
  g_assert_cmpint(spore_exercise_metric_state(exercise, 0).verdict, ==, SPORE_METRIC_FAIL);
  g_assert_cmpfloat(spore_exercise_metric_state(exercise, 0).mark, ==, 0);
  spore_exercise_free(exercise);
  rig_free(course.rig);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/exercise/watching", test_watching);
  g_test_add_func("/exercise/pause_and_restart", test_pause_and_restart);
  g_test_add_func("/exercise/skip", test_skip);
  g_test_add_func("/exercise/stays", test_stays);
  g_test_add_func("/exercise/skipped-need-not-last", test_skipped_need_not_last);
  g_test_add_func("/exercise/random_orders", test_random_orders);
  g_test_add_func("/exercise/unfinished", test_unfinished);
  g_test_add_func("/exercise/refused", test_refused);
  g_test_add_func("/exercise/memory", test_memory);
  return g_test_run();
}
