/* A simulation on a thread of its own, paced to real time or as fast as it goes. */
#include "ui/sim/session.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/haptic/pointer.h"
#include "core/measure/pace.h"
#include "ui/sim/session-past.h"

/* A step reads a device once, or a few times when the monitor repeats the step. The queue is emptied after each step.
 * */
#define SAMPLES_A_STEP 64
/* The clock is read at least this often while waiting for the next step. */
#define FACTOR_WINDOW_US (G_USEC_PER_SEC)

/* Numbers over time: how often a simulated second, at first, and how many rows before every second one is dropped. */
#define ROWS_A_SECOND 30
#define MOST_ROWS 4096
/* Steps between two looks at what was not solved. */
#define STEPS_A_LOOK 16
/* How long the recording holds the button that wipes a lens: longer than from one look at lenses to the next. */
#define WIPE_S 0.1
/* How long the window waits for a step that may take minutes. */
#define PATIENCE_US (G_USEC_PER_SEC / 20)

/* Stands between the world and the devices of a body, and records their states. The pointer has priority over the track
 * that the scene gives the body: a body that the mouse took stays with the mouse until a reset. While no device has a
 * state, the recording holds the body's pose, so that the recording begins at time 0. */
typedef struct {
  SporeDevice device;
  SporeDevice *pointer;
  SporeDevice *script; /* plays the body's track; NULL: it has none */
  const SporeWorld *world;
  const SporePast *repeats; /* what the device said before is said again; NULL: the devices are asked */
  guint32 body;
  guint number; /* among the recorders */
  guint count;
  SporePastInput samples[SAMPLES_A_STEP];
  /* In the last step. */
  gboolean led, driven; /* by the pointer; by any device */

  SporeDeviceState input; /* last state; guarded by the session's mutex */
  double wiping_s;        /* until then, simulated, a command wipes the lens that the body carries; the same */
  gboolean wiped;         /* it has been since time 0; the same */
} Recorder;

/* Opening of the jaws for a hand that nobody has moved yet; wider than any jaws. */
#define OPEN_HAND ((SporeDeviceState){.orientation = {1}, .grip_rad = G_PI})

struct SporeSession {
  SporeSimulation *simulation;
  SporePool *pool;
  Recorder *recorders;
  guint recorder_count;
  GThread *thread;
  SporeCancel cancel;
  gint ending;               /* the step under way is to end; read by the world meanwhile; atomic */
  const SporeCancel *making; /* ends the making; NULL once the session is made */

  /* Guarded by the mutex, which no thread holds during a step. */
  GMutex mutex;
  GCond wake, stood;
  gboolean quit, playing, reset, standing;
  guint steps;
  SporePast *past;
  gboolean lost;  /* the past does not hold all that went into the run */
  gboolean going; /* to the state after `target` steps, by the past */
  gboolean anew;  /* the way begins at time 0 */
  gboolean paced; /* the way takes as long as the run is to take */
  gboolean stays; /* on the way: no further */
  guint64 target;
  guint64 reached; /* steps that the past holds */
  double speed;
  double factor;
  SporePace pace;
  SporeTrack recording;
  SporeSessionFigures figures;
  SporeNumbers numbers;
  guint64 stride;       /* steps a row */
  SporeTrack *repeated; /* input of an attempt; NULL: none is repeated */
  gboolean has_attempt;
  SporeExerciseState attempt; /* the last that ended and was not taken */

  /* The thread's own; another thread only where the first one stands. */
  SporeMeasurement *measurement;
  double *row; /* one value a column */
  SporeLocalError local_error;
  gint64 factor_clock; /* us */
  double factor_time;  /* s, simulated */
};

/* What is said now, of the pointer or the track. */
static SporePastInput ask(Recorder *recorder, double time_s, const SporeDeviceCommand *command,
                          const SporeDeviceState *last) {
  SporeDevice *script = recorder->script;
  SporePastInput input = {.time_s = time_s, .state = *last};
  input.led = recorder->pointer->type->exchange(recorder->pointer, time_s, command, &input.state);
  input.driven = input.led || (script && script->type->exchange(script, time_s, command, &input.state));
  if (input.driven) return input;
  const double *q = spore_world_q(recorder->world, recorder->body);
  input.state = (SporeDeviceState){0};
  memcpy(input.state.position, q, sizeof input.state.position);
  memcpy(input.state.orientation, q + 3, sizeof input.state.orientation);
  return input;
}

/* A step that is repeated asks again for the same time, and is told the same. */
static bool recorder_exchange(SporeDevice *device, double time_s, const SporeDeviceCommand *command,
                              SporeDeviceState *state) {
  Recorder *recorder = (Recorder *)device;
  const SporePastInput *before =
      recorder->repeats ? spore_past_find(recorder->repeats, recorder->number, time_s) : NULL;
  if (!before && recorder->count > 0 && recorder->samples[recorder->count - 1].time_s == time_s)
    before = &recorder->samples[recorder->count - 1];
  SporePastInput input = before ? *before : ask(recorder, time_s, command, state);
  input.time_s = time_s;
  recorder->led = input.led;
  recorder->driven = input.driven;
  if (recorder->count < SAMPLES_A_STEP) recorder->samples[recorder->count++] = input;
  if (input.driven) *state = input.state;
  return input.driven;
}

/* The recorders are the session's and end with it. */
static void recorder_close(SporeDevice *device) {}

static const SporeDeviceType recorder_type = {"recorder", "", recorder_exchange, recorder_close};

/* The device that plays the body's track. */
static SporeDevice *script_of(const SporeSimulation *simulation, const char *body) {
  for (gsize i = 0; simulation->track && i < simulation->track->channel_count; i++)
    if (g_str_equal(simulation->track->channels[i].name, body)) return simulation->devices->pdata[i];
  return NULL;
}

static gboolean make_recorders(SporeSession *session, GError **error) {
  SporeWorld *world = session->simulation->world;
  gsize bodies = spore_world_body_count(world);
  session->recorders = g_new0(Recorder, bodies);
  for (guint32 body = 0; body < bodies; body++) {
    const char *name = spore_world_body_name(world, body);
    if (spore_world_hand(world, body) != body) continue;
    Recorder *recorder = &session->recorders[session->recorder_count];
    *recorder = (Recorder){.device.type = &recorder_type,
                           .world = world,
                           .body = body,
                           .number = session->recorder_count,
                           .input = OPEN_HAND};
    recorder->script = script_of(session->simulation, name);
    recorder->pointer = spore_pointer_device_create();
    if (!recorder->pointer)
      return spore_error_raise(error, SPORE_ERROR_MEMORY, name, "not enough memory for a pointer");
    session->recorder_count++;
    spore_world_set_device(world, body, &recorder->device);
  }
  session->past = spore_past_new(session->recorder_count);
  return TRUE;
}

static gboolean same_pose(const SporeDeviceState *a, const SporeDeviceState *b) {
  return memcmp(a->position, b->position, sizeof a->position) == 0 &&
         memcmp(a->orientation, b->orientation, sizeof a->orientation) == 0 && a->grip_rad == b->grip_rad &&
         a->buttons == b->buttons;
}

/* While a pose does not change, its first and last sample are enough. */
static void keep_sample(SporeTrackChannel *channel, const SporePastInput *sample) {
  size_t n = channel->count;
  if (n > 0 && sample->time_s <= channel->time_s[n - 1]) return;
  if (n > 1 && same_pose(&sample->state, &channel->states[n - 1]) && same_pose(&sample->state, &channel->states[n - 2]))
    channel->time_s[n - 1] = sample->time_s;
  else spore_track_append(channel, sample->time_s, &sample->state);
}

/* A track has no commands: a lens that a command wiped is wiped there by the button that does the same. */
static SporePastInput as_recorded(const Recorder *recorder, const SporePastInput *sample) {
  SporePastInput recorded = *sample;
  if (sample->time_s < recorder->wiping_s) recorded.state.buttons |= SPORE_FIRST_BUTTON;
  return recorded;
}

/* Called between steps with the mutex held. */
static void drain_recorders(SporeSession *session) {
  for (guint i = 0; i < session->recorder_count; i++) {
    Recorder *recorder = &session->recorders[i];
    if (recorder->count == 0) continue;
    const char *name = spore_world_body_name(session->simulation->world, recorder->body);
    SporeTrackChannel *channel = spore_track_channel(&session->recording, name);
    if (!channel) channel = spore_track_add_channel(&session->recording, name);
    for (guint s = 0; s < recorder->count; s++) {
      SporePastInput recorded = as_recorded(recorder, &recorder->samples[s]);
      if (channel) keep_sample(channel, &recorded);
      if (!session->going) spore_past_add(session->past, i, &recorder->samples[s]);
    }
    if (recorder->driven) recorder->input = recorder->samples[recorder->count - 1].state;
    recorder->count = 0;
  }
}

static void restart_pace(SporeSession *session) {
  session->factor_clock = g_get_monotonic_time();
  session->factor_time = spore_world_time_s(session->simulation->world);
  session->factor = 0;
  spore_pace_start(&session->pace, session->factor_time, session->speed);
}

/* How long until the next step is due, us. */
static gint64 time_left_us(const SporeSession *session) {
  guint64 due = spore_pace_due_ns(&session->pace, spore_world_time_s(session->simulation->world));
  guint64 now = spore_clock_ns();
  return due > now ? (gint64)((due - now) / 1000) : 0;
}

static void update_factor(SporeSession *session) {
  gint64 now = g_get_monotonic_time(), passed = now - session->factor_clock;
  /* The first figure is computed early, so that the user does not wait a second for it. */
  if (passed < (session->factor > 0 ? FACTOR_WINDOW_US : FACTOR_WINDOW_US / 5)) return;
  double time_s = spore_world_time_s(session->simulation->world);
  session->factor = (time_s - session->factor_time) * G_USEC_PER_SEC / (double)passed;
  session->factor_clock = now;
  session->factor_time = time_s;
}

/* Measuring. */

static double total_energy(const SporeWorld *world) {
  SporeEnergy energy = spore_world_energy(world);
  return energy.kinetic + energy.internal + energy.gravity + energy.contact;
}

/* What was not solved in most steps. */
static void look_at_unsolved(const SporeWorld *world, SporeSessionFigures *figures) {
  figures->unsolved_count = spore_world_unsolved_count(world);
  figures->unsolved.steps = 0;
  for (gsize i = 0; i < figures->unsolved_count; i++) {
    SporeUnsolved entry = spore_world_unsolved(world, i);
    if (entry.steps > figures->unsolved.steps) figures->unsolved = entry;
  }
}

/* Begins to measure, at time 0, while no step is under way. */
static void start_measuring(SporeSession *session) {
  const SporeWorld *world = session->simulation->world;
  session->figures =
      (SporeSessionFigures){.local_error = NAN, .error_body = SPORE_NO_BODY, .energy_start = total_energy(world)};
  spore_local_error_reset(&session->local_error);
  spore_numbers_clear(&session->numbers);
  session->numbers.measurement = session->measurement;
  session->stride = (guint64)fmax(1, round(1 / (ROWS_A_SECOND * session->local_error.dt_s)));
  spore_numbers_add(&session->numbers);
}

/* Room for a measurement's row. Takes the measurement in place of the one before. */
static gboolean take_measurement(SporeSession *session, SporeMeasurement *measurement, GError **error) {
  gsize columns = 0;
  if (measurement) spore_measurement_columns(measurement, &columns);
  double *row = measurement ? SPORE_NEW_ARRAY(double, columns) : NULL;
  if (!row) {
    spore_measurement_free(measurement);
    return spore_error_raise(error, SPORE_ERROR_MEMORY, "", "not enough memory to measure the run");
  }
  spore_free(session->row);
  spore_measurement_free(session->measurement);
  session->measurement = measurement;
  session->row = row;
  start_measuring(session);
  return TRUE;
}

static SporeMeasurement *new_measurement(const SporeSession *session, const SporeWatchRequest *points, gsize count,
                                         SporeError *fault) {
  bool all[SPORE_QUANTITY_COUNT];
  for (gsize i = 0; i < SPORE_QUANTITY_COUNT; i++) all[i] = true;
  return spore_measurement_create(session->simulation->world, all, points, count, fault);
}

/* What is read of the world after a step, without the mutex. */
typedef struct {
  gboolean error, unsolved, row; /* what there is */
  SporeSessionFigures figures;
} Measured;

static Measured measure(SporeSession *session, guint64 stride, gboolean standing) {
  const SporeWorld *world = session->simulation->world;
  guint64 step = spore_world_step_count(world);
  Measured measured = {.error = spore_local_error_step(&session->local_error, world),
                       .unsolved = standing || step % STEPS_A_LOOK == 0,
                       .row = standing || step % stride == 0};
  if (measured.unsolved) look_at_unsolved(world, &measured.figures);
  if (measured.row) spore_measurement_take(session->measurement, session->row);
  return measured;
}

/* With the mutex held. */
static void keep_measured(SporeSession *session, const Measured *measured) {
  if (measured->error) {
    session->figures.local_error = session->local_error.last;
    session->figures.error_body = session->local_error.last_body;
  }
  if (measured->unsolved) {
    session->figures.unsolved_count = measured->figures.unsolved_count;
    session->figures.unsolved = measured->figures.unsolved;
  }
  if (measured->row) spore_numbers_add_row(&session->numbers, session->row);
  if (session->numbers.row_count < MOST_ROWS) return;
  spore_numbers_thin(&session->numbers);
  session->stride *= 2;
}

/* With the mutex held, like all that is done to the exercise. An ended step leaves the state before it. */
static void watch_exercise(SporeSession *session) {
  const SporeSimulation *simulation = session->simulation;
  SporeExercise *exercise = simulation->exercise;
  if (!exercise || spore_world_cancelled(simulation->world)) return;
  gboolean running = spore_exercise_phase(exercise) == SPORE_EXERCISE_RUNNING;
  spore_exercise_watch(exercise, simulation->world);
  if (!running || spore_exercise_phase(exercise) == SPORE_EXERCISE_RUNNING) return;
  SporeExerciseState state = spore_exercise_state(exercise);
  gboolean counts = !state.tried && !session->repeated;
  session->has_attempt |= counts;
  if (counts) session->attempt = state;
}

static void restart_exercise(SporeSession *session) {
  const SporeSimulation *simulation = session->simulation;
  if (simulation->exercise) spore_exercise_restart(simulation->exercise, simulation->world);
}

/* What was to come after the state that the session went back to will not come. */
static void go_on_anew(SporeSession *session) {
  const SporeWorld *world = session->simulation->world;
  guint64 step = spore_world_step_count(world);
  if (step < session->reached) spore_past_cut(session->past, step, spore_world_time_s(world));
}

/* With the mutex held on both sides of the step. */
static void take_step(SporeSession *session) {
  guint64 stride = session->stride;
  gboolean single = session->steps > 0;
  if (!session->going) go_on_anew(session);
  g_mutex_unlock(&session->mutex);
  spore_world_step(session->simulation->world);
  spore_world_tidy(session->simulation->world);
  Measured measured = measure(session, stride, single);
  g_mutex_lock(&session->mutex);
  keep_measured(session, &measured);
  drain_recorders(session);
  watch_exercise(session);
  if (session->going) return;
  session->reached = spore_world_step_count(session->simulation->world);
  spore_past_applied(session->past, spore_world_commands_applied(session->simulation->world), session->reached - 1);
}

static void take_paced_step(SporeSession *session) {
  const SporeWorld *world = session->simulation->world;
  spore_pace_begin(&session->pace, spore_pace_due_ns(&session->pace, spore_world_time_s(world)));
  take_step(session);
  spore_pace_end(&session->pace, spore_world_time_s(world));
}

/* Time 0, with nothing forgotten of what went into the run. */
static void restart(SporeSession *session) {
  g_atomic_int_set(&session->ending, 0);
  spore_world_reset(session->simulation->world);
  restart_exercise(session);
  for (guint i = 0; i < session->recorder_count; i++) {
    Recorder *recorder = &session->recorders[i];
    spore_pointer_device_release(recorder->pointer);
    recorder->repeats = NULL;
    recorder->count = 0;
    recorder->led = recorder->wiped = FALSE;
    recorder->wiping_s = 0;
    recorder->input = OPEN_HAND;
  }
  spore_track_clear(&session->recording);
  start_measuring(session);
}

static void take_reset(SporeSession *session) {
  const SporeWorld *world = session->simulation->world;
  session->steps = 0;
  session->going = session->stays = FALSE;
  restart(session);
  spore_past_clear(session->past);
  session->reached = 0;
  session->lost = spore_world_commands_applied(world) < spore_world_commands_posted(world);
  session->reset = FALSE;
  restart_pace(session);
  g_cond_broadcast(&session->stood);
}

/* Going to another state of the run. */

static void begin_way(SporeSession *session) {
  if (session->anew || spore_world_step_count(session->simulation->world) > session->target) restart(session);
  if (session->anew) restart_pace(session);
  session->anew = FALSE;
  for (guint i = 0; i < session->recorder_count; i++) session->recorders[i].repeats = session->past;
  if (session->simulation->exercise) spore_exercise_try_out(session->simulation->exercise);
}

/* The mouse holds again what it held there. */
static void end_way(SporeSession *session) {
  session->going = session->stays = FALSE;
  for (guint i = 0; i < session->recorder_count; i++) {
    Recorder *recorder = &session->recorders[i];
    recorder->repeats = NULL;
    if (recorder->led) spore_pointer_device_set(recorder->pointer, &recorder->input);
  }
  restart_pace(session);
}

static Recorder *recorder_of(const SporeSession *session, guint32 body) {
  for (guint i = 0; i < session->recorder_count; i++)
    if (session->recorders[i].body == body) return &session->recorders[i];
  return NULL;
}

/* With the mutex held: the next step applies the command. */
static void note_wipe(SporeSession *session, const SporeCommand *command) {
  const SporeWorld *world = session->simulation->world;
  if (command->kind != SPORE_COMMAND_WIPE || !(command->number < (double)spore_world_lens_count(world))) return;
  Recorder *recorder = recorder_of(session, spore_world_lens_body(world, (gsize)fmax(command->number, 0)));
  if (!recorder) return;
  recorder->wiping_s = spore_world_time_s(world) + WIPE_S;
  recorder->wiped = TRUE;
}

/* One step of the way, or its end. */
static void take_way(SporeSession *session) {
  SporeWorld *world = session->simulation->world;
  if (!session->stays) begin_way(session);
  guint64 step = spore_world_step_count(world);
  gboolean there = session->stays || step >= session->target;
  const SporeCommand *command;
  for (guint i = 0; !there && (command = spore_past_command(session->past, step, i)); i++) {
    note_wipe(session, command);
    spore_world_post(world, command);
  }
  if (!there) take_step(session);
  if (there || spore_world_cancelled(world)) end_way(session);
}

static gpointer run(gpointer data) {
  SporeSession *session = data;
  g_mutex_lock(&session->mutex);
  while (!session->quit) {
    if (session->reset) {
      take_reset(session);
    } else if (session->going) {
      gint64 left = session->paced && !session->anew && !session->stays ? time_left_us(session) : 0;
      if (left > 0) g_cond_wait_until(&session->wake, &session->mutex, g_get_monotonic_time() + left);
      else take_way(session);
    } else if (session->steps > 0) {
      take_step(session);
      session->steps--;
    } else if (session->playing) {
      gint64 left = time_left_us(session);
      if (left > 0) g_cond_wait_until(&session->wake, &session->mutex, g_get_monotonic_time() + left);
      else take_paced_step(session);
      update_factor(session);
    } else {
      session->standing = TRUE;
      g_cond_broadcast(&session->stood);
      g_cond_wait(&session->wake, &session->mutex);
      session->standing = FALSE;
    }
  }
  g_mutex_unlock(&session->mutex);
  return NULL;
}

static void wait_standing(SporeSession *session) {
  session->standing = FALSE;
  g_cond_signal(&session->wake);
  while (!session->standing) g_cond_wait(&session->stood, &session->mutex);
}

static gboolean wait_patiently(SporeSession *session) {
  gint64 end = g_get_monotonic_time() + PATIENCE_US;
  session->standing = FALSE;
  g_cond_signal(&session->wake);
  while (!session->standing && g_cond_wait_until(&session->stood, &session->mutex, end)) continue;
  return session->standing;
}

/* A step under way ends with the state before it, and only a reset makes the world go on. */
static void end_step(SporeSession *session) { g_atomic_int_set(&session->ending, 1); }

static bool is_ending(void *data) {
  SporeSession *session = data;
  return g_atomic_int_get(&session->ending) != 0 || spore_cancel_asked(session->making);
}

static gboolean make_measurement(SporeSession *session, SporeDocument *document, GError **error) {
  const SporeObject *solver = spore_document_section(document, "solver");
  double dt_s = spore_object_number(solver, "time_step");
  if (!spore_local_error_init(&session->local_error, session->simulation->world, dt_s))
    return spore_error_raise(error, SPORE_ERROR_MEMORY, "", "not enough memory to measure the run");
  return take_measurement(session, new_measurement(session, NULL, 0, NULL), error);
}

SporeSession *spore_session_new(SporeDocument *document, int threads, const SporeTrack *input,
                                const SporeCancel *cancel, GError **error) {
  SporeSession *session = g_new0(SporeSession, 1);
  g_mutex_init(&session->mutex);
  g_cond_init(&session->wake);
  g_cond_init(&session->stood);
  session->speed = 1;
  session->cancel = (SporeCancel){is_ending, session};
  session->making = cancel;
  session->pool = spore_pool_create(MAX(threads, 1));
  if (!session->pool) {
    spore_error_raise(error, SPORE_ERROR_MEMORY, "", "no threads to be had; close other programs");
    spore_session_free(session);
    return NULL;
  }
  session->simulation = spore_simulation_new(document, session->pool, input, &session->cancel, error);
  if (!session->simulation || !make_recorders(session, error) || !make_measurement(session, document, error)) {
    spore_session_free(session);
    return NULL;
  }
  session->making = NULL;
  session->thread = g_thread_new("simulation", run, session);
  return session;
}

void spore_session_free(SporeSession *session) {
  if (!session) return;
  end_step(session);
  if (session->thread) {
    g_mutex_lock(&session->mutex);
    session->quit = TRUE;
    g_cond_signal(&session->wake);
    g_mutex_unlock(&session->mutex);
    g_thread_join(session->thread);
  }
  spore_numbers_clear(&session->numbers);
  spore_measurement_free(session->measurement);
  spore_free(session->row);
  spore_local_error_clear(&session->local_error);
  if (session->simulation) spore_simulation_free(session->simulation);
  for (guint i = 0; i < session->recorder_count; i++)
    session->recorders[i].pointer->type->close(session->recorders[i].pointer);
  g_free(session->recorders);
  if (session->pool) spore_pool_free(session->pool);
  spore_input_free(session->repeated);
  spore_past_free(session->past);
  spore_track_clear(&session->recording);
  g_cond_clear(&session->stood);
  g_cond_clear(&session->wake);
  g_mutex_clear(&session->mutex);
  g_free(session);
}

const SporeSimulation *spore_session_simulation(const SporeSession *session) { return session->simulation; }

void spore_session_play(SporeSession *session) {
  g_mutex_lock(&session->mutex);
  if (!session->playing) {
    restart_pace(session);
    session->playing = TRUE;
    g_cond_signal(&session->wake);
  }
  g_mutex_unlock(&session->mutex);
}

void spore_session_pause(SporeSession *session) {
  g_mutex_lock(&session->mutex);
  session->playing = FALSE;
  wait_standing(session);
  g_mutex_unlock(&session->mutex);
}

gboolean spore_session_try_pause(SporeSession *session) {
  g_mutex_lock(&session->mutex);
  session->playing = FALSE;
  gboolean stands = wait_patiently(session);
  g_mutex_unlock(&session->mutex);
  return stands;
}

gboolean spore_session_try_give_up(SporeSession *session) {
  end_step(session);
  return spore_session_try_pause(session);
}

gboolean spore_session_stands(const SporeSession *session) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  gboolean stands = session->standing;
  g_mutex_unlock(&locked->mutex);
  return stands;
}

gboolean spore_session_is_playing(const SporeSession *session) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  gboolean playing = session->playing;
  g_mutex_unlock(&locked->mutex);
  return playing;
}

void spore_session_step(SporeSession *session, guint steps) {
  g_mutex_lock(&session->mutex);
  if (!session->playing) {
    session->steps = steps;
    wait_standing(session);
  }
  g_mutex_unlock(&session->mutex);
}

gboolean spore_session_try_step(SporeSession *session, guint steps) {
  g_mutex_lock(&session->mutex);
  gboolean stands = FALSE;
  if (!session->playing) {
    session->steps = steps;
    stands = wait_patiently(session);
  }
  g_mutex_unlock(&session->mutex);
  return stands;
}

/* With the mutex held, here and below. Nobody else gets the mutex between the reset and a thread that stands. */
static void begin_reset(SporeSession *session) {
  session->reset = TRUE;
  session->standing = FALSE;
  g_cond_signal(&session->wake);
}

void spore_session_reset(SporeSession *session) {
  end_step(session);
  g_mutex_lock(&session->mutex);
  begin_reset(session);
  while (session->reset) g_cond_wait(&session->stood, &session->mutex);
  g_mutex_unlock(&session->mutex);
}

gboolean spore_session_try_reset(SporeSession *session) {
  gint64 end = g_get_monotonic_time() + PATIENCE_US;
  end_step(session);
  g_mutex_lock(&session->mutex);
  begin_reset(session);
  while (session->reset && g_cond_wait_until(&session->stood, &session->mutex, end)) continue;
  gboolean done = !session->reset;
  g_mutex_unlock(&session->mutex);
  return done;
}

void spore_session_carry_over(SporeSession *to, const SporeSession *from) {
  spore_simulation_carry_over(to->simulation, from->simulation);
  restart_exercise(to); /* of the state that it begins with */
  spore_session_change(to);
  start_measuring(to);
}

gboolean spore_session_knows_past(const SporeSession *session) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  gboolean knows = !session->lost;
  g_mutex_unlock(&locked->mutex);
  return knows;
}

double spore_session_step_s(const SporeSession *session) { return session->local_error.dt_s; }

guint64 spore_session_reached(const SporeSession *session) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  guint64 reached = session->reached;
  g_mutex_unlock(&locked->mutex);
  return reached;
}

/* With the mutex held. FALSE: it is on its way. */
static gboolean go_to(SporeSession *session, guint64 step, gboolean anew) {
  if (session->lost) return TRUE;
  session->playing = FALSE;
  session->steps = 0;
  session->target = MIN(step, session->reached);
  session->going = TRUE;
  session->anew = session->paced = anew;
  session->stays = FALSE;
  return wait_patiently(session);
}

gboolean spore_session_try_go_to(SporeSession *session, guint64 step) {
  g_mutex_lock(&session->mutex);
  gboolean stands = go_to(session, step, FALSE);
  g_mutex_unlock(&session->mutex);
  return stands;
}

gboolean spore_session_try_replay(SporeSession *session) {
  g_mutex_lock(&session->mutex);
  gboolean stands = go_to(session, session->reached, TRUE);
  g_mutex_unlock(&session->mutex);
  return stands;
}

gboolean spore_session_is_going(SporeSession *session, double *fraction) {
  g_mutex_lock(&session->mutex);
  gboolean going = session->going;
  guint64 target = session->target;
  g_mutex_unlock(&session->mutex);
  *fraction = going && target > 0 ? fmin((double)spore_session_snapshot(session)->step / (double)target, 1) : 0;
  return going;
}

void spore_session_stay(SporeSession *session) {
  g_mutex_lock(&session->mutex);
  session->stays = session->going;
  g_cond_signal(&session->wake);
  g_mutex_unlock(&session->mutex);
}

void spore_session_set_speed(SporeSession *session, double speed) {
  g_mutex_lock(&session->mutex);
  session->speed = speed;
  /* The thread may be waiting for its next step now. It reads these values only with the mutex held. */
  spore_pace_set_speed(&session->pace, spore_session_snapshot(session)->time_s, speed);
  g_cond_signal(&session->wake);
  g_mutex_unlock(&session->mutex);
}

const SporeSnapshot *spore_session_snapshot(SporeSession *session) {
  return spore_world_snapshot_acquire(session->simulation->world);
}

gboolean spore_session_post(SporeSession *session, const SporeCommand *command) {
  SporeWorld *world = session->simulation->world;
  spore_session_try_out(session);
  g_mutex_lock(&session->mutex);
  gboolean posted = !session->going && spore_world_post(world, command);
  if (posted) {
    note_wipe(session, command);
    spore_past_post(session->past, spore_world_commands_posted(world), command);
  }
  g_mutex_unlock(&session->mutex);
  return posted;
}

void spore_session_set_pointer(SporeSession *session, guint32 body, const SporeDeviceState *state) {
  Recorder *recorder = recorder_of(session, body);
  if (recorder) spore_pointer_device_set(recorder->pointer, state);
}

SporeDeviceState spore_session_input(SporeSession *session, guint32 body) {
  const Recorder *recorder = recorder_of(session, body);
  g_mutex_lock(&session->mutex);
  SporeDeviceState input = recorder ? recorder->input : OPEN_HAND;
  g_mutex_unlock(&session->mutex);
  return input;
}

double spore_session_get_speed(const SporeSession *session) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  double speed = session->speed;
  g_mutex_unlock(&locked->mutex);
  return speed;
}

double spore_session_real_time_factor(const SporeSession *session) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  double factor = session->playing ? session->factor : 0;
  g_mutex_unlock(&locked->mutex);
  return factor;
}

void spore_session_late_steps(const SporeSession *session, guint64 *late, guint64 *steps) {
  SporeSession *locked = (SporeSession *)session;
  g_mutex_lock(&locked->mutex);
  gboolean due = session->playing && session->speed > 0;
  *late = due ? session->pace.misses : 0;
  *steps = due ? session->pace.steps : 0;
  g_mutex_unlock(&locked->mutex);
}

SporeSessionFigures spore_session_figures(SporeSession *session) {
  g_mutex_lock(&session->mutex);
  SporeSessionFigures figures = session->figures;
  g_mutex_unlock(&session->mutex);
  return figures;
}

const SporeColumn *spore_session_columns(const SporeSession *session, gsize *count) {
  return spore_measurement_columns(session->measurement, count);
}

double *spore_session_numbers(SporeSession *session, gsize first, gsize count, gsize *row_count) {
  gsize columns;
  spore_session_columns(session, &columns);
  g_mutex_lock(&session->mutex);
  const SporeNumbers *numbers = &session->numbers;
  double *copy = g_new(double, numbers->row_count *count + 1);
  for (gsize i = 0; i < numbers->row_count; i++)
    memcpy(copy + i * count, numbers->values + i * columns + first, count * sizeof *copy);
  *row_count = numbers->row_count;
  g_mutex_unlock(&session->mutex);
  return copy;
}

char *spore_session_csv(SporeSession *session, size_t *size) {
  gsize columns, rows;
  spore_session_columns(session, &columns);
  g_autofree double *values = spore_session_numbers(session, 0, columns, &rows);
  const SporeNumbers numbers = {.measurement = session->measurement, .row_count = rows, .values = values};
  return spore_numbers_csv(&numbers, size);
}

gboolean spore_session_watch(SporeSession *session, const SporeWatchRequest *points, gsize count, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  g_mutex_lock(&session->mutex);
  gboolean playing = session->playing;
  session->playing = FALSE;
  session->reset = !session->standing || spore_session_snapshot(session)->step > 0;
  if (session->reset) end_step(session);
  wait_standing(session);
  SporeMeasurement *measurement = new_measurement(session, points, count, &fault);
  gboolean taken = measurement ? take_measurement(session, measurement, error) : spore_error_propagate(&fault, error);
  session->playing = playing;
  g_cond_signal(&session->wake);
  g_mutex_unlock(&session->mutex);
  return taken;
}

gboolean spore_session_read_exercise(SporeSession *session, SporeExerciseReader read, gpointer data) {
  const SporeExercise *exercise = session->simulation->exercise;
  if (!exercise) return FALSE;
  g_mutex_lock(&session->mutex);
  read(exercise, data);
  g_mutex_unlock(&session->mutex);
  return TRUE;
}

gboolean spore_session_take_attempt(SporeSession *session, SporeExerciseState *state) {
  g_mutex_lock(&session->mutex);
  gboolean has = session->has_attempt;
  *state = session->attempt;
  session->has_attempt = FALSE;
  g_mutex_unlock(&session->mutex);
  return has;
}

void spore_session_repeat(SporeSession *session, SporeTrack *input) {
  g_mutex_lock(&session->mutex);
  session->repeated = input;
  g_mutex_unlock(&session->mutex);
}

void spore_session_try_out(SporeSession *session) {
  SporeExercise *exercise = session->simulation->exercise;
  g_mutex_lock(&session->mutex);
  if (exercise) spore_exercise_try_out(exercise);
  g_mutex_unlock(&session->mutex);
}

void spore_session_change(SporeSession *session) {
  spore_session_try_out(session);
  g_mutex_lock(&session->mutex);
  session->lost = TRUE;
  g_mutex_unlock(&session->mutex);
}

gboolean spore_session_skip_to(SporeSession *session, gsize step) {
  SporeExercise *exercise = session->simulation->exercise;
  if (!exercise) return FALSE;
  g_mutex_lock(&session->mutex);
  gboolean has = step < spore_exercise_state(exercise).steps;
  if (has) spore_exercise_skip_to(exercise, step);
  g_mutex_unlock(&session->mutex);
  return has;
}

static void copy_channel(SporeTrack *to, const SporeTrackChannel *source) {
  SporeTrackChannel *channel = spore_track_add_channel(to, source->name);
  for (size_t i = 0; channel && i < source->count; i++)
    if (!spore_track_append(channel, source->time_s[i], &source->states[i])) return;
}

SporeTrack *spore_session_recording(SporeSession *session) {
  SporeTrack *copy = g_new0(SporeTrack, 1);
  const SporeWorld *world = session->simulation->world;
  g_mutex_lock(&session->mutex);
  for (guint i = 0; i < session->recorder_count; i++) {
    const Recorder *recorder = &session->recorders[i];
    const char *name = spore_world_body_name(world, recorder->body);
    /* Tracks of bodies that the mouse did not take stay as the scene has them, but where their lens was wiped. */
    gboolean stays = recorder->script && !recorder->led && !recorder->wiped;
    const SporeTrack *from = stays ? session->simulation->track : &session->recording;
    const SporeTrackChannel *channel = spore_track_channel(from, name);
    if (channel) copy_channel(copy, channel);
  }
  g_mutex_unlock(&session->mutex);
  return copy;
}
