/* The document as a GObject: history, selection and changes as signals, so that widgets can follow it.
 *
 * Signals
 *   changed (SporeChangeKind kind, guint id, guint property)   after each change, undo and redo included
 *   history-changed ()                                         undo, redo or modified state may differ
 *   studied ()                                                 another accuracy study is there
 *   selection-changed ()                                                                                          */
#ifndef SPORE_UI_DOCUMENT_SPORE_EDITOR_DOCUMENT_H
#define SPORE_UI_DOCUMENT_SPORE_EDITOR_DOCUMENT_H

#include <glib-object.h>

#include "core/author/accuracy_study.h"
#include "core/scene/document.h"

G_BEGIN_DECLS

#define SPORE_TYPE_EDITOR_DOCUMENT spore_editor_document_get_type()
G_DECLARE_FINAL_TYPE(SporeEditorDocument, spore_editor_document, SPORE, EDITOR_DOCUMENT, GObject)

/* Takes the document. */
SporeEditorDocument *spore_editor_document_new(SporeDocument *document);
SporeDocument *spore_editor_document_get(SporeEditorDocument *self);

/* Id of the selected object, 0: none; of several, the first one. An object that goes is selected no more. */
guint32 spore_editor_document_get_selection(SporeEditorDocument *self);
void spore_editor_document_select(SporeEditorDocument *self, guint32 id); /* that object alone; 0: none */
SporeObject *spore_editor_document_selected(SporeEditorDocument *self);   /* NULL: none */
/* The body that is selected, or to which the selection belongs; NULL: none. */
SporeObject *spore_editor_document_selected_body(SporeEditorDocument *self);

/* Several selected objects: ids that differ, not 0; the first is the one that what works on one object takes. */
const guint32 *spore_editor_document_get_selected(SporeEditorDocument *self, gsize *count); /* until the next change */
void spore_editor_document_select_several(SporeEditorDocument *self, const guint32 *ids, gsize count);
/* Adds an object to the selection, or takes it out. */
void spore_editor_document_toggle(SporeEditorDocument *self, guint32 id);
gboolean spore_editor_document_is_selected(SporeEditorDocument *self, guint32 id);
/* The bodies that are selected, or to which what is selected belongs: of SporeObject *, each once. g_ptr_array_unref.
 */
GPtrArray *spore_editor_document_selected_bodies(SporeEditorDocument *self);

/* The last accuracy study of the scene; NULL: none since the scene was opened. */
const SporeAccuracyStudy *spore_editor_document_get_study(SporeEditorDocument *self);
/* Takes the study. */
void spore_editor_document_take_study(SporeEditorDocument *self, SporeAccuracyStudy *study);
/* Whether the points of the study are of the scene as it is. */
gboolean spore_editor_document_study_holds(SporeEditorDocument *self);
/* The point of the study whose settings the scene has, or had last; -1: none was measured. */
gssize spore_editor_document_get_point(SporeEditorDocument *self);
/* What the scene itself remembers of a study. */
SporeMeasured spore_editor_document_get_measured(SporeEditorDocument *self);

/* Where Save writes: the document's file, or the original of one that was recovered. NULL: ask, of what came from a
 * bundle, too. */
const char *spore_editor_document_get_save_file(SporeEditorDocument *self);
void spore_editor_document_set_recovered(SporeEditorDocument *self, const char *original);
/* Its file is a template, and never written: it has none until it is saved. */
void spore_editor_document_set_untitled(SporeEditorDocument *self);
gboolean spore_editor_document_is_modified(SporeEditorDocument *self);
/* "liver.spore", "liver.sporez" of a bundle, or "Untitled". g_free. */
char *spore_editor_document_get_title(SporeEditorDocument *self);
/* Saves under `file`; NULL: the save file, which must exist. */
gboolean spore_editor_document_save(SporeEditorDocument *self, const char *file, GError **error);

G_END_DECLS
#endif
