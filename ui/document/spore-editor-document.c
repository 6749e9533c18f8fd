/* The document as a GObject: history, selection, changes and saving. */
#include "ui/document/spore-editor-document.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/io/scene_xml.h"
#include "core/scene/run_hash.h"

struct _SporeEditorDocument {
  GObject parent;
  SporeDocument *document;
  guint listener;
  GArray *selection; /* of guint32: ids */
  gboolean recovered, untitled;
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

/* What lies within an object that goes is selected no more. */
static void forget_within(SporeEditorDocument *self, guint32 ancestor) {
  g_autoptr(GArray) left = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (guint i = 0; i < self->selection->len; i++) {
    const guint32 id = g_array_index(self->selection, guint32, i);
    SporeObject *object = spore_document_by_id(self->document, id);
    if (object && !is_within(object, ancestor)) g_array_append_val(left, id);
  }
  spore_editor_document_select_several(self, (const guint32 *)(gpointer)left->data, left->len);
}

static void document_changed(SporeDocument *document, SporeChangeKind kind, SporeObject *object, guint property,
                             gpointer data) {
  SporeEditorDocument *self = data;
  if (kind == SPORE_DOCUMENT_HISTORY) {
    g_signal_emit(self, signals[HISTORY_CHANGED], 0);
    return;
  }
  guint32 id = spore_object_id(object);
  if (kind == SPORE_DOCUMENT_REMOVED) forget_within(self, id);
  g_signal_emit(self, signals[CHANGED], 0, (int)kind, id, property);
}

static void spore_editor_document_finalize(GObject *object) {
  SporeEditorDocument *self = SPORE_EDITOR_DOCUMENT(object);
  spore_document_unlisten(self->document, self->listener);
  spore_document_free(self->document);
  spore_accuracy_study_free(self->study);
  g_array_unref(self->selection);
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

static void spore_editor_document_init(SporeEditorDocument *self) {
  self->accuracy.point = -1;
  self->selection = g_array_new(FALSE, FALSE, sizeof(guint32));
}

SporeEditorDocument *spore_editor_document_new(SporeDocument *document) {
  SporeEditorDocument *self = g_object_new(SPORE_TYPE_EDITOR_DOCUMENT, NULL);
  self->document = document;
  self->listener = spore_document_listen(document, document_changed, self);
  return self;
}

SporeDocument *spore_editor_document_get(SporeEditorDocument *self) { return self->document; }

/* Selection. */

const guint32 *spore_editor_document_get_selected(SporeEditorDocument *self, gsize *count) {
  *count = self->selection->len;
  return (const guint32 *)(gpointer)self->selection->data;
}

guint32 spore_editor_document_get_selection(SporeEditorDocument *self) {
  return self->selection->len ? g_array_index(self->selection, guint32, 0) : 0;
}

void spore_editor_document_select_several(SporeEditorDocument *self, const guint32 *ids, gsize count) {
  const gboolean same =
      count == self->selection->len && (count == 0 || memcmp(ids, self->selection->data, count * sizeof *ids) == 0);
  if (same) return;
  g_array_set_size(self->selection, 0);
  if (count) g_array_append_vals(self->selection, ids, (guint)count);
  g_signal_emit(self, signals[SELECTION_CHANGED], 0);
}

void spore_editor_document_select(SporeEditorDocument *self, guint32 id) {
  spore_editor_document_select_several(self, &id, id != 0);
}

gboolean spore_editor_document_is_selected(SporeEditorDocument *self, guint32 id) {
  for (guint i = 0; i < self->selection->len; i++)
    if (g_array_index(self->selection, guint32, i) == id) return TRUE;
  return FALSE;
}

void spore_editor_document_toggle(SporeEditorDocument *self, guint32 id) {
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (guint i = 0; i < self->selection->len; i++) {
    const guint32 one = g_array_index(self->selection, guint32, i);
    if (one != id) g_array_append_val(ids, one);
  }
  if (ids->len == self->selection->len) g_array_append_val(ids, id);
  spore_editor_document_select_several(self, (const guint32 *)(gpointer)ids->data, ids->len);
}

SporeObject *spore_editor_document_selected(SporeEditorDocument *self) {
  const guint32 id = spore_editor_document_get_selection(self);
  return id ? spore_document_by_id(self->document, id) : NULL;
}

static SporeObject *body_of(SporeObject *object) {
  while (object && !g_str_equal(spore_object_type(object)->element, "body")) object = spore_object_parent(object);
  return object;
}

SporeObject *spore_editor_document_selected_body(SporeEditorDocument *self) {
  return body_of(spore_editor_document_selected(self));
}

GPtrArray *spore_editor_document_selected_bodies(SporeEditorDocument *self) {
  GPtrArray *bodies = g_ptr_array_new();
  for (guint i = 0; i < self->selection->len; i++) {
    SporeObject *body = body_of(spore_document_by_id(self->document, g_array_index(self->selection, guint32, i)));
    if (body && !g_ptr_array_find(bodies, body, NULL)) g_ptr_array_add(bodies, body);
  }
  return bodies;
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
  if (self->untitled) return NULL;
  return self->recovered ? self->original : spore_document_file(self->document);
}

void spore_editor_document_set_recovered(SporeEditorDocument *self, const char *original) {
  self->recovered = TRUE;
  self->original = g_strdup(original);
}

void spore_editor_document_set_untitled(SporeEditorDocument *self) { self->untitled = TRUE; }

gboolean spore_editor_document_is_modified(SporeEditorDocument *self) {
  return self->recovered || spore_document_is_modified(self->document);
}

char *spore_editor_document_get_title(SporeEditorDocument *self) {
  const char *file = spore_editor_document_get_save_file(self);
  if (!file) file = spore_document_bundle(self->document);
  return file ? g_path_get_basename(file) : g_strdup(_("Untitled"));
}

gboolean spore_editor_document_save(SporeEditorDocument *self, const char *file, GError **error) {
  if (!file) file = spore_editor_document_get_save_file(self);
  g_return_val_if_fail(file, FALSE);
  g_autofree char *kept = g_strdup(file); /* may be the document's own, which saving replaces */
  if (!spore_scene_save(self->document, kept, error)) return FALSE;
  self->recovered = self->untitled = FALSE;
  g_clear_pointer(&self->original, g_free);
  g_signal_emit(self, signals[HISTORY_CHANGED], 0);
  return TRUE;
}
