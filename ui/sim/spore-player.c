/* The player: runs a compiled copy of the document, and keeps it in step with edits. */
#include "ui/sim/spore-player.h"

#include <string.h>

struct _SporePlayer {
  GObject parent;
  SporeEditorDocument *document;
  SporeSession *session;
  double speed;
  guint rebuild;       /* idle source */
  guint watch;         /* timeout source, while a step outlasts the wait for it */
  gboolean from_start; /* the rebuild starts at time 0 and copies no state */
};

G_DEFINE_FINAL_TYPE(SporePlayer, spore_player, G_TYPE_OBJECT)

enum { STATE_CHANGED, REPLACED, FAILED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static int threads(void) { return (int)CLAMP(g_get_num_processors() / 2, 1, 8); }

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

static void replace_session(SporePlayer *self, SporeSession *session) {
  g_clear_handle_id(&self->rebuild, g_source_remove);
  g_clear_handle_id(&self->watch, g_source_remove);
  SporeSession *old = self->session;
  self->session = session;
  g_signal_emit(self, signals[REPLACED], 0);
  spore_session_free(old);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
}

static SporeSession *compile(SporePlayer *self) {
  g_autoptr(GError) error = NULL;
  SporeSession *session = spore_session_new(spore_editor_document_get(self->document), threads(), NULL, &error);
  if (session) spore_session_set_speed(session, self->speed);
  else g_signal_emit(self, signals[FAILED], 0, error->message);
  return session;
}

static gboolean ensure_session(SporePlayer *self) {
  if (self->rebuild) {
    g_clear_handle_id(&self->rebuild, g_source_remove);
    replace_session(self, NULL);
  }
  if (self->session) return TRUE;
  SporeSession *session = compile(self);
  if (session) replace_session(self, session);
  return session != NULL;
}

/* The scene changed in a way that needs another world. */
static gboolean rebuild(gpointer data) {
  SporePlayer *self = data;
  self->rebuild = 0;
  gboolean playing = spore_session_is_playing(self->session);
  spore_session_give_up(self->session);
  SporeSession *session = compile(self);
  if (session && !self->from_start) spore_session_carry_over(session, self->session);
  self->from_start = FALSE;
  replace_session(self, session);
  if (session && playing) spore_player_play(self);
  return G_SOURCE_REMOVE;
}

static gboolean is_at_rest(SporePlayer *self) {
  return !spore_session_is_playing(self->session) && spore_session_snapshot(self->session)->step == 0;
}

/* Whether a new object says nothing that the scene did not say without it: what is set in it follows. */
static gboolean says_nothing(const SporeObject *object) {
  return strcmp(spore_object_type(object)->element, "fidelity") == 0 && spore_object_child_count(object) == 0;
}

static void document_changed(SporePlayer *self, int kind, guint id, guint property) {
  if (!self->session) return;
  if (is_at_rest(self)) {
    replace_session(self, NULL);
    return;
  }
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *object = kind == SPORE_DOCUMENT_SET ? spore_document_by_id(document, id) : NULL;
  const SporeObject *added = kind == SPORE_DOCUMENT_INSERTED ? spore_document_by_id(document, id) : NULL;
  if (added && says_nothing(added)) return;
  if (object) {
    const SporeParameter *parameter = &spore_object_type(object)->table->parameters[property];
    if (spore_simulation_apply((SporeSimulation *)spore_session_simulation(self->session), document, object, property))
      return;
    if (parameter->change == SPORE_CHANGE_RESTART) self->from_start = TRUE;
  }
  if (!self->rebuild) self->rebuild = g_idle_add_full(G_PRIORITY_HIGH_IDLE, rebuild, self, NULL);
}

static void spore_player_dispose(GObject *object) {
  SporePlayer *self = SPORE_PLAYER(object);
  g_clear_handle_id(&self->rebuild, g_source_remove);
  g_clear_handle_id(&self->watch, g_source_remove);
  g_clear_pointer(&self->session, spore_session_free);
  g_clear_object(&self->document);
  G_OBJECT_CLASS(spore_player_parent_class)->dispose(object);
}

static void spore_player_class_init(SporePlayerClass *class) {
  GType type = G_TYPE_FROM_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_player_dispose;
  signals[STATE_CHANGED] = g_signal_new("state-changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
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

SporeSession *spore_player_get_session(SporePlayer *self) { return self->session; }

gboolean spore_player_is_playing(SporePlayer *self) { return self->session && spore_session_is_playing(self->session); }

gboolean spore_player_prepare(SporePlayer *self) { return ensure_session(self); }

void spore_player_play(SporePlayer *self) {
  if (!ensure_session(self)) return;
  spore_session_play(self->session);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
}

void spore_player_pause(SporePlayer *self) { tell(self, !self->session || spore_session_try_pause(self->session)); }

void spore_player_step(SporePlayer *self) {
  if (!ensure_session(self)) return;
  tell(self, (!spore_session_is_playing(self->session) || spore_session_try_pause(self->session)) &&
                 spore_session_try_step(self->session));
}

void spore_player_reset(SporePlayer *self) {
  if (self->session) spore_session_reset(self->session);
  g_signal_emit(self, signals[STATE_CHANGED], 0);
}

void spore_player_set_speed(SporePlayer *self, double speed) {
  self->speed = speed;
  if (self->session) spore_session_set_speed(self->session, speed);
}
