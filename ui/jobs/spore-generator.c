/* A generator at work: it runs again as options change, and the document changes only when its result is applied. */
#include "ui/jobs/spore-generator.h"

#include <glib/gi18n.h>

#include "core/scene/generated.h"
#include "core/author/edits.h"
#include "core/author/label_choice.h"
#include "ui/jobs/generate-types.h"

#define SETTLE_MS 250 /* options that change faster make one run */

struct _SporeGenerator {
  GObject parent;
  SporeEditorDocument *document;
  gboolean active, apply_when_done;
  guint32 body;
  SporeGenerateOptions options;
  SporeLabelSource *labels; /* held for the options */
  guint timer;
  SporeJob *job;
  SporeGenerateWork *result;
  char *refusal;
};

G_DEFINE_FINAL_TYPE(SporeGenerator, spore_generator, G_TYPE_OBJECT)

enum { CHANGED, FAILED, APPLIED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static void tell(SporeGenerator *self) { g_signal_emit(self, signals[CHANGED], 0); }

static void drop_job(SporeGenerator *self) {
  g_clear_handle_id(&self->timer, g_source_remove);
  if (!self->job) return;
  g_signal_handlers_disconnect_by_data(self->job, self);
  spore_job_cancel(self->job);
  g_clear_object(&self->job);
}

static void drop_result(SporeGenerator *self) {
  drop_job(self);
  g_clear_pointer(&self->result, spore_generate_work_unref);
  g_clear_pointer(&self->refusal, g_free);
}

static void drop(SporeGenerator *self) {
  drop_result(self);
  self->active = self->apply_when_done = FALSE;
}

/* Other places, or another choice of labels, may do better, so that the preview waits for them. */
static void fail(SporeGenerator *self, const GError *error) {
  gboolean cancelled = g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED);
  gboolean goes_on = !cancelled && (spore_generators[self->options.kind]->places || self->options.chosen);
  if (goes_on) drop_result(self);
  else drop(self);
  self->apply_when_done = FALSE;
  if (goes_on) self->refusal = g_strdup(error->message);
  if (!cancelled) g_signal_emit(self, signals[FAILED], 0, error->message);
  tell(self);
}

static void start(SporeGenerator *self);

/* A job that was dropped ends here too. Its result is ignored. */
static void done(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeGenerator *self = owner;
  g_autoptr(GError) refused = NULL;
  if (self->job != job) return;
  g_clear_object(&self->job);
  if (error) {
    fail(self, error);
    return;
  }
  if (!spore_generate_work_holds(data, spore_editor_document_get(self->document))) {
    start(self); /* the mesh or the regions changed meanwhile */
    return;
  }
  self->result = spore_generate_work_ref(data);
  if (self->options.labels && !self->options.chosen) {
    spore_label_propose(&self->options, spore_editor_document_get(self->document));
    self->result->options = self->options;
  }
  if (!self->apply_when_done) tell(self);
  else if (!spore_generator_apply(self, &refused)) fail(self, refused);
}

static void start(SporeGenerator *self) {
  SporeObject *body = spore_generator_get_body(self);
  drop_job(self);
  g_autoptr(GError) error = NULL;
  SporeGenerateWork *work =
      spore_generate_work_new(spore_editor_document_get(self->document), body, &self->options, &error);
  if (!work) {
    fail(self, error);
    return;
  }
  self->job = spore_job_start(_(spore_generators[self->options.kind]->working), spore_generate_work_run, work,
                              spore_generate_work_unref, done, G_OBJECT(self));
  g_signal_connect_object(self->job, "progressed", G_CALLBACK(tell), self, G_CONNECT_SWAPPED);
  tell(self);
}

static gboolean settled(gpointer data) {
  SporeGenerator *self = data;
  self->timer = 0;
  start(self);
  return G_SOURCE_REMOVE;
}

/* TRUE: the result stays what it is. */
static gboolean change_purpose(SporeGenerator *self, const SporeGenerateOptions *options) {
  SporeGenerateOptions same = *options;
  same.purpose = self->options.purpose;
  if (memcmp(&same, &self->options, sizeof same) != 0) return FALSE;
  self->options.purpose = self->result->options.purpose = options->purpose;
  tell(self);
  return TRUE;
}

gboolean spore_generator_preview(SporeGenerator *self, SporeObject *body, const SporeGenerateOptions *options,
                                 GError **error) {
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *asset = body ? spore_generate_target(document, body, options->kind) : NULL;
  guint32 id = body ? spore_object_id(body) : 0;
  if ((body && !spore_generate_source(document, body, options->kind, error)) ||
      (asset && !spore_generated_may_change(asset, error)))
    return FALSE;
  gboolean again = self->active && self->body == id && self->options.kind == options->kind &&
                   self->options.labels == options->labels;
  if (again && self->result && change_purpose(self, options)) return TRUE;
  if (again) drop_result(self);
  else drop(self);
  self->active = TRUE;
  self->body = id;
  self->options = *options;
  if (options->labels && options->labels != self->labels) {
    g_clear_pointer(&self->labels, spore_label_source_unref);
    self->labels = spore_label_source_ref(options->labels);
  }
  if (again) {
    self->timer = g_timeout_add(SETTLE_MS, settled, self);
    tell(self);
  } else {
    start(self);
  }
  return TRUE;
}

void spore_generator_make(SporeGenerator *self) {
  if (!self->active || !self->options.listing) return;
  drop_result(self);
  self->options.listing = FALSE;
  start(self);
}

void spore_generator_apply_when_done(SporeGenerator *self) { self->apply_when_done = TRUE; }

gboolean spore_generator_apply(SporeGenerator *self, GError **error) {
  if (!self->result) return spore_error_raise(error, SPORE_ERROR_INPUT, NULL, _("there is no result yet; wait for it"));
  if (self->options.listing) {
    spore_generator_make(self);
    self->apply_when_done = TRUE;
    return TRUE;
  }
  if (!spore_generate_work_apply(self->result, spore_editor_document_get(self->document), error)) return FALSE;
  g_signal_emit(self, signals[APPLIED], 0);
  drop(self);
  tell(self);
  return TRUE;
}

void spore_generator_cancel(SporeGenerator *self) {
  if (!self->active) return;
  drop(self);
  tell(self);
}

SporeDocument *spore_generator_get_document(SporeGenerator *self) { return spore_editor_document_get(self->document); }

gboolean spore_generator_is_active(SporeGenerator *self) { return self->active; }

gboolean spore_generator_is_working(SporeGenerator *self) { return self->job || self->timer; }

SporeObject *spore_generator_get_body(SporeGenerator *self) {
  return self->active && self->body ? spore_document_by_id(spore_editor_document_get(self->document), self->body)
                                    : NULL;
}

const SporeGenerateOptions *spore_generator_get_options(SporeGenerator *self) { return &self->options; }

const SporeGenerateWork *spore_generator_get_result(SporeGenerator *self) { return self->result; }

const char *spore_generator_get_refusal(SporeGenerator *self) { return self->refusal; }

SporeJob *spore_generator_get_job(SporeGenerator *self) { return self->job; }

/* The body may be gone, or show another mesh, which is then the source. */
static void document_changed(SporeGenerator *self) {
  if (!self->active || !self->body) return;
  SporeObject *body = spore_generator_get_body(self);
  if (!body) {
    spore_generator_cancel(self);
  } else if (self->result && !spore_generate_work_body(self->result, spore_editor_document_get(self->document))) {
    SporeGenerateOptions options = self->options;
    if (!spore_generator_preview(self, body, &options, NULL)) spore_generator_cancel(self);
  }
}

static void spore_generator_dispose(GObject *object) {
  SporeGenerator *self = SPORE_GENERATOR(object);
  drop(self);
  g_clear_pointer(&self->labels, spore_label_source_unref);
  g_clear_object(&self->document);
  G_OBJECT_CLASS(spore_generator_parent_class)->dispose(object);
}

static void spore_generator_class_init(SporeGeneratorClass *class) {
  G_OBJECT_CLASS(class)->dispose = spore_generator_dispose;
  GType type = G_TYPE_FROM_CLASS(class);
  signals[CHANGED] = g_signal_new("changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[FAILED] = g_signal_new("failed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 1, G_TYPE_STRING);
  signals[APPLIED] = g_signal_new("applied", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_generator_init(SporeGenerator *self) {}

SporeGenerator *spore_generator_new(SporeEditorDocument *document) {
  SporeGenerator *self = g_object_new(SPORE_TYPE_GENERATOR, NULL);
  self->document = g_object_ref(document);
  g_signal_connect_object(document, "changed", G_CALLBACK(document_changed), self, G_CONNECT_SWAPPED);
  return self;
}
