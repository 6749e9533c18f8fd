/* The document as a GObject: history, selection, changes and saving. */
#include "ui/document/spore-editor-document.h"

#include <glib/gi18n.h>

#include "core/io/scene_xml.h"
#include "core/scene/run_hash.h"

struct _SporeEditorDocument {
  GObject parent;
  SporeDocument *document;
  guint listener;
  guint32 selection;
  gboolean recovered;
  SporeAccuracyStudy *study;
  struct {
    guint64 revision; /* of the document that the rest is of */
    gboolean known, holds;
    gssize point;
    SporeMeasured measured;
  } accuracy;
  char *original; /* of a recovered document; NULL: it was never saved */
};

G_DEFINE_FINAL_TYPE(SporeEditorDocument, spore_editor_document, G_TYPE_OBJECT)

enum { CHANGED, HISTORY_CHANGED, SELECTION_CHANGED, STUDIED, SIGNAL_COUNT };
static guint signals[SIGNAL_COUNT];

static gboolean is_within(SporeObject *object, guint32 ancestor) {
  for (; object; object = spore_object_parent(object))
    if (spore_object_id(object) == ancestor) return TRUE;
  return FALSE;
}

static void document_changed(SporeDocument *document, SporeChangeKind kind, SporeObject *object, guint property,
                             gpointer data) {
  SporeEditorDocument *self = data;
  if (kind == SPORE_DOCUMENT_HISTORY) {
    g_signal_emit(self, signals[HISTORY_CHANGED], 0);
    return;
  }
  guint32 id = spore_object_id(object);
  SporeObject *selected = spore_document_by_id(document, self->selection);
  if (kind == SPORE_DOCUMENT_REMOVED && self->selection && (!selected || is_within(selected, id)))
    spore_editor_document_select(self, 0);
  g_signal_emit(self, signals[CHANGED], 0, (int)kind, id, property);
}

static void spore_editor_document_finalize(GObject *object) {
  SporeEditorDocument *self = SPORE_EDITOR_DOCUMENT(object);
  spore_document_unlisten(self->document, self->listener);
  spore_document_free(self->document);
  spore_accuracy_study_free(self->study);
  g_free(self->original);
  G_OBJECT_CLASS(spore_editor_document_parent_class)->finalize(object);
}

static void spore_editor_document_class_init(SporeEditorDocumentClass *class) {
  GType type = G_TYPE_FROM_CLASS(class);
  G_OBJECT_CLASS(class)->finalize = spore_editor_document_finalize;
  signals[CHANGED] = g_signal_new("changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 3, G_TYPE_INT,
                                  G_TYPE_UINT, G_TYPE_UINT);
  signals[HISTORY_CHANGED] =
      g_signal_new("history-changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[STUDIED] = g_signal_new("studied", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
  signals[SELECTION_CHANGED] =
      g_signal_new("selection-changed", type, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
}

static void spore_editor_document_init(SporeEditorDocument *self) { self->accuracy.point = -1; }

SporeEditorDocument *spore_editor_document_new(SporeDocument *document) {
  SporeEditorDocument *self = g_object_new(SPORE_TYPE_EDITOR_DOCUMENT, NULL);
  self->document = document;
  self->listener = spore_document_listen(document, document_changed, self);
  return self;
}

SporeDocument *spore_editor_document_get(SporeEditorDocument *self) { return self->document; }

guint32 spore_editor_document_get_selection(SporeEditorDocument *self) { return self->selection; }

void spore_editor_document_select(SporeEditorDocument *self, guint32 id) {
  if (id == self->selection) return;
  self->selection = id;
  g_signal_emit(self, signals[SELECTION_CHANGED], 0);
}

SporeObject *spore_editor_document_selected(SporeEditorDocument *self) {
  return self->selection ? spore_document_by_id(self->document, self->selection) : NULL;
}

SporeObject *spore_editor_document_selected_body(SporeEditorDocument *self) {
  SporeObject *object = spore_editor_document_selected(self);
  while (object && !g_str_equal(spore_object_type(object)->element, "body")) object = spore_object_parent(object);
  return object;
}

/* The accuracy study. */

/* Compares scene and study, once for each revision: a study of many points takes a while to compare. */
static void compare_study(SporeEditorDocument *self) {
  guint64 revision = spore_document_revision(self->document);
  if (self->accuracy.known && self->accuracy.revision == revision) return;
  self->accuracy.known = TRUE;
  self->accuracy.revision = revision;
  gboolean remembers = spore_object_child_of(spore_document_section(self->document, "meta"), "measured") != NULL;
  guint64 hash = self->study || remembers ? spore_document_run_hash(self->document) : 0;
  self->accuracy.measured = remembers ? spore_measured_state(self->document, hash) : SPORE_MEASURED_NOT;
  self->accuracy.holds = self->study && spore_accuracy_study_holds(self->study, self->document);
  if (self->accuracy.holds) self->accuracy.point = spore_accuracy_study_find(self->study, hash);
}

const SporeAccuracyStudy *spore_editor_document_get_study(SporeEditorDocument *self) { return self->study; }

void spore_editor_document_take_study(SporeEditorDocument *self, SporeAccuracyStudy *study) {
  spore_accuracy_study_free(self->study);
  self->study = study;
  self->accuracy.known = FALSE;
  self->accuracy.point = -1;
  g_signal_emit(self, signals[STUDIED], 0);
}

gboolean spore_editor_document_study_holds(SporeEditorDocument *self) {
  compare_study(self);
  return self->accuracy.holds;
}

gssize spore_editor_document_get_point(SporeEditorDocument *self) {
  compare_study(self);
  return self->accuracy.point;
}

SporeMeasured spore_editor_document_get_measured(SporeEditorDocument *self) {
  compare_study(self);
  return self->accuracy.measured;
}

/* Files. */

const char *spore_editor_document_get_save_file(SporeEditorDocument *self) {
  return self->recovered ? self->original : spore_document_file(self->document);
}

void spore_editor_document_set_recovered(SporeEditorDocument *self, const char *original) {
  self->recovered = TRUE;
  self->original = g_strdup(original);
}

gboolean spore_editor_document_is_modified(SporeEditorDocument *self) {
  return self->recovered || spore_document_is_modified(self->document);
}

char *spore_editor_document_get_title(SporeEditorDocument *self) {
  const char *file = spore_editor_document_get_save_file(self);
  return file ? g_path_get_basename(file) : g_strdup(_("Untitled"));
}

gboolean spore_editor_document_save(SporeEditorDocument *self, const char *file, GError **error) {
  if (!file) file = spore_editor_document_get_save_file(self);
  g_return_val_if_fail(file, FALSE);
  g_autofree char *kept = g_strdup(file); /* may be the document's own, which saving replaces */
  if (!spore_scene_save(self->document, kept, error)) return FALSE;
  self->recovered = FALSE;
  g_clear_pointer(&self->original, g_free);
  g_signal_emit(self, signals[HISTORY_CHANGED], 0);
  return TRUE;
}
