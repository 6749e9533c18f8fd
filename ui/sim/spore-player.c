/* The player: runs a compiled copy of the document, and keeps it in step with edits. */
#include "ui/sim/spore-player.h"

#include <glib/gi18n.h>
#include <string.h>

#include "ui/sim/session-work.h"

struct _SporePlayer {
  GObject parent;
  SporeEditorDocument *document;
  SporeSession *session;
  double speed;
  SporeJob *making;    /* of the session that will take the place of `session`; NULL: none */
  SporeSession *next;  /* that one, made, until a step of `session` has ended */
  gboolean given_up;   /* `session` makes no more steps */
  gboolean plays;      /* what is done with the next session */
  guint steps;         /* likewise, where it does not play */
  char *repeated;      /* file with the input that is repeated; NULL: none is */
  gboolean from_start; /* the next session starts at time 0 and copies no state */
  guint remake;        /* idle source: makes a session anew */
  guint take;          /* timeout source, while `next` waits */
  guint watch;         /* timeout source, while a step outlasts the wait for it */
};

G_DEFINE_FINAL_TYPE(SporePlayer, spore_player, G_TYPE_OBJECT)

enum { STATE_CHANGED, PROGRESSED, REPLACED, FAILED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

/* Between two looks at a long step, ms. */
#define LOOK_MS 50

static gboolean look(gpointer data) {
  SporePlayer *self = data;
  if (!spore_session_stands(self->session) && !spore_session_is_playing(self->session)) return G_SOURCE_CONTINUE;
  self->watch = 0;
  g_signal_emit(self, signals[STATE_CHANGED], 0);
  return G_SOURCE_REMOVE;
}

/* Tells that the state changed, and again when a step that is still under way has ended. */
static void tell(SporePlayer *self, gboolean stands) {
  if (!stands && !self->watch) self->watch = g_timeout_add(LOOK_MS, look, self);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
}

/* Making. */

/* Lets go of what is being made. What is to be done with the next session stays. */
static void stop_making(SporePlayer *self) {
  g_autoptr(SporeJob) job = g_steal_pointer(&self->making);
  if (job) spore_job_cancel(job);
  if (self->next) spore_session_retire(g_steal_pointer(&self->next));
  g_clear_handle_id(&self->remake, g_source_remove);
  g_clear_handle_id(&self->take, g_source_remove);
}

static void wish_nothing(SporePlayer *self) {
  self->plays = self->from_start = FALSE;
  self->steps = 0;
}

static void replace_session(SporePlayer *self, SporeSession *session) {
  g_clear_handle_id(&self->watch, g_source_remove);
  SporeSession *old = self->session;
  self->session = session;
  self->given_up = FALSE;
  g_signal_emit(self, signals[REPLACED], 0);
  if (old) spore_session_retire(old);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
}

/* The new session takes the place of the one before, as soon as that one stands. */
static gboolean take_next(gpointer data) {
  SporePlayer *self = data;
  if (self->session && !spore_session_try_give_up(self->session)) return G_SOURCE_CONTINUE;
  SporeSession *session = g_steal_pointer(&self->next);
  gboolean plays = self->plays;
  guint steps = self->steps;
  if (self->session && !self->from_start) spore_session_carry_over(session, self->session);
  spore_session_set_speed(session, self->speed);
  self->take = 0;
  wish_nothing(self);
  if (plays) spore_session_play(session);
  replace_session(self, session);
  if (!plays && steps > 0) tell(self, spore_session_try_step(session, steps));
  return G_SOURCE_REMOVE;
}

static void made(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporePlayer *self = owner;
  if (job != self->making) return; /* another one is being made, or none */
  g_clear_object(&self->making);
  if (error) {
    wish_nothing(self);
    g_clear_pointer(&self->repeated, g_free);
    replace_session(self, NULL);
    g_signal_emit(self, signals[FAILED], 0, error->message);
    return;
  }
  self->next = g_steal_pointer(&((SporeSessionWork *)data)->session);
  self->plays = spore_player_is_playing(self);
  self->given_up = TRUE;
  if (take_next(self) == G_SOURCE_CONTINUE) self->take = g_timeout_add(LOOK_MS, take_next, self);
}

static void progressed(SporePlayer *self) { g_signal_emit(self, signals[PROGRESSED], 0); }

static gboolean make(gpointer data) {
  SporePlayer *self = data;
  self->remake = 0;
  stop_making(self);
  self->making = spore_job_start(_("Preparing the simulation"), spore_session_work_run,
                                 spore_session_work_new(spore_editor_document_get(self->document), self->repeated),
                                 spore_session_work_free, made, G_OBJECT(self));
  g_signal_connect_object(self->making, "progressed", G_CALLBACK(progressed), self, G_CONNECT_SWAPPED);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
  return G_SOURCE_REMOVE;
}

gboolean spore_player_is_going(SporePlayer *self, double *fraction) {
  double unused;
  return self->session && spore_session_is_going(self->session, fraction ? fraction : &unused);
}

gboolean spore_player_is_making(SporePlayer *self) { return self->making || self->remake || self->next; }

/* Following the document. */

static gboolean is_at_rest(SporePlayer *self) {
  return !spore_session_is_playing(self->session) && spore_session_snapshot(self->session)->step == 0;
}

/* Whether the running world takes the change. */
static gboolean apply(SporePlayer *self, SporeObject *object, guint property) {
  const SporeParameter *parameter = &spore_object_type(object)->table->parameters[property];
  SporeSimulation *simulation = (SporeSimulation *)spore_session_simulation(self->session);
  if (!spore_player_is_making(self) && !spore_player_is_going(self, NULL) &&
      spore_simulation_apply(simulation, spore_editor_document_get(self->document), object, property)) {
    spore_session_change(self->session);
    return TRUE;
  }
  if (parameter->change == SPORE_CHANGE_RESTART) self->from_start = TRUE;
  return FALSE;
}

/* Whether the scene says the same with and without an object: a fidelity in which nothing is set. It comes so before
 * its first choice, which follows, and goes so when that choice is undone. */
static gboolean says_nothing(const SporeObject *object) {
  const SporeObjectType *type = spore_object_type(object);
  if (strcmp(type->element, "fidelity") != 0 || spore_object_child_count(object) > 0) return FALSE;
  for (guint p = 0; p < type->table->count; p++)
    if (spore_object_is_set(object, p)) return FALSE;
  return TRUE;
}

static void document_changed(SporePlayer *self, int kind, guint id, guint property) {
  if (!self->session && !spore_player_is_making(self)) return;
  if (!spore_player_is_making(self) && is_at_rest(self)) {
    replace_session(self, NULL);
    return;
  }
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *object = self->session && kind == SPORE_DOCUMENT_SET ? spore_document_by_id(document, id) : NULL;
  const SporeObject *other = kind == SPORE_DOCUMENT_INSERTED  ? spore_document_by_id(document, id)
                             : kind == SPORE_DOCUMENT_REMOVED ? spore_document_removed(document, id)
                                                              : NULL;
  if (other && says_nothing(other)) return;
  if (object && apply(self, object, property)) return;
  if (!self->remake) self->remake = g_idle_add_full(G_PRIORITY_HIGH_IDLE, make, self, NULL);
}

/* Life. */

void spore_player_close(SporePlayer *self) {
  stop_making(self);
  g_clear_handle_id(&self->watch, g_source_remove);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  if (self->session) spore_session_retire(g_steal_pointer(&self->session));
}

static void spore_player_dispose(GObject *object) {
  SporePlayer *self = SPORE_PLAYER(object);
  spore_player_close(self);
  g_clear_object(&self->document);
  g_clear_pointer(&self->repeated, g_free);
  G_OBJECT_CLASS(spore_player_parent_class)->dispose(object);
}

static void spore_player_class_init(SporePlayerClass *class) {
  GType type = G_TYPE_FROM_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_player_dispose;
  signals[STATE_CHANGED] = g_signal_new("state-changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[PROGRESSED] = g_signal_new("progressed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[REPLACED] = g_signal_new("replaced", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[FAILED] = g_signal_new("failed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 1, G_TYPE_STRING);
}

static void spore_player_init(SporePlayer *self) { self->speed = 1; }

SporePlayer *spore_player_new(SporeEditorDocument *document) {
  SporePlayer *self = g_object_new(SPORE_TYPE_PLAYER, NULL);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  return self;
}

/* What the user asks for. */

SporeSession *spore_player_get_session(SporePlayer *self) { return self->session; }

SporeJob *spore_player_get_job(SporePlayer *self) { return self->making; }

/* Whether there is a session that does as it is asked to. */
static gboolean has_session(const SporePlayer *self) { return self->session && !self->given_up; }

gboolean spore_player_is_playing(SporePlayer *self) {
  return has_session(self) ? spore_session_is_playing(self->session) : self->plays;
}

void spore_player_cancel(SporePlayer *self) {
  if (!spore_player_is_making(self)) return;
  stop_making(self);
  wish_nothing(self);
  g_clear_pointer(&self->repeated, g_free);
  replace_session(self, NULL);
}

void spore_player_prepare(SporePlayer *self) {
  if (!self->session && !spore_player_is_making(self)) make(self);
}

void spore_player_play(SporePlayer *self) {
  self->plays = TRUE;
  self->steps = 0;
  spore_player_prepare(self);
  if (has_session(self)) spore_session_play(self->session);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
}

void spore_player_pause(SporePlayer *self) {
  self->plays = FALSE;
  self->steps = 0;
  tell(self, !has_session(self) || spore_session_try_pause(self->session));
}

/* While the next session is made, the steps are for that one. */
void spore_player_step(SporePlayer *self) {
  spore_player_prepare(self);
  gboolean stands = !has_session(self) || !spore_session_is_playing(self->session) || //
                    spore_session_try_pause(self->session);
  self->plays = FALSE;
  if (spore_player_is_making(self)) self->steps++;
  else stands = stands && spore_session_try_step(self->session, 1);
  tell(self, stands);
}

gboolean spore_player_knows_past(SporePlayer *self) {
  return has_session(self) && !spore_player_is_making(self) && spore_session_knows_past(self->session);
}

void spore_player_go_to(SporePlayer *self, guint64 step) {
  if (spore_player_knows_past(self)) tell(self, spore_session_try_go_to(self->session, step));
}

void spore_player_replay(SporePlayer *self) {
  if (spore_player_knows_past(self)) tell(self, spore_session_try_replay(self->session));
}

void spore_player_stay(SporePlayer *self) {
  if (has_session(self)) spore_session_stay(self->session);
}

void spore_player_repeat(SporePlayer *self, const char *file) {
  g_free(self->repeated);
  self->repeated = g_strdup(file);
  self->plays = self->from_start = TRUE;
  self->steps = 0;
  if (has_session(self)) spore_session_try_pause(self->session);
  self->given_up = TRUE; /* what is asked for now is for the session that is made */
  make(self);
}

gboolean spore_player_is_repeating(SporePlayer *self) { return self->repeated != NULL; }

/* Another session, with the scene's own input again. */
static void end_repetition(SporePlayer *self) {
  g_clear_pointer(&self->repeated, g_free);
  self->plays = spore_player_is_playing(self);
  self->from_start = TRUE;
  self->steps = 0;
  make(self);
}

void spore_player_reset(SporePlayer *self) {
  if (self->repeated) {
    end_repetition(self);
    return;
  }
  gboolean done = !has_session(self) || spore_session_try_reset(self->session);
  if (spore_player_is_making(self)) self->from_start = TRUE;
  tell(self, done);
}

void spore_player_set_speed(SporePlayer *self, double speed) {
  self->speed = speed;
  if (self->session) spore_session_set_speed(self->session, speed);
}
