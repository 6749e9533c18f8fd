/* Undo and redo: a step is a list of edits, each of which swaps a property's value or an object's place. */
#include <glib/gi18n.h>

#include "core/scene/document_private.h"

static void clear_slot(SporeSlot *slot) {
  spore_value_clear(&slot->value);
  g_free(slot->source);
}

static void free_step(SporeUndoStep *step) {
  for (guint i = 0; i < step->edits->len; i++) clear_slot(&g_array_index(step->edits, SporeEdit, i).slot);
  g_array_unref(step->edits);
  g_free(step->label);
  g_free(step);
}

/* Frees the objects that these edits created: the edits are undone and can never be redone. */
static void forget_created(SporeDocument *document, const GArray *edits, guint from) {
  for (guint i = from; i < edits->len; i++) {
    const SporeEdit *edit = &g_array_index(edits, SporeEdit, i);
    if (edit->created) g_hash_table_remove(document->objects, GUINT_TO_POINTER(edit->object->id));
  }
}

static void drop_redo(SporeDocument *document) {
  for (guint i = 0; i < document->redo->len; i++) {
    SporeUndoStep *step = g_ptr_array_index(document->redo, i);
    forget_created(document, step->edits, 0);
    free_step(step);
  }
  g_ptr_array_set_size(document->redo, 0);
}

void spore_history_free(SporeDocument *document) {
  g_ptr_array_set_free_func(document->undo, (GDestroyNotify)free_step);
  g_ptr_array_set_free_func(document->redo, (GDestroyNotify)free_step);
  g_ptr_array_unref(document->undo);
  g_ptr_array_unref(document->redo);
  for (guint i = 0; i < document->open->len; i++) clear_slot(&g_array_index(document->open, SporeEdit, i).slot);
  g_array_unref(document->open);
  g_array_unref(document->marks);
  g_free(document->open_label);
}

/* Applying. */

static guint position_of(const SporeObject *object, guint property) {
  guint position = 0;
  while (g_array_index(object->order, guint, position) != property) position++;
  return position;
}

static void swap_slot(SporeEdit *edit) {
  SporeObject *object = edit->object;
  if (object->type->table->parameters[edit->property].type == SPORE_NAME) spore_document_forget_names(object->document);
  SporeSlot *slot = &object->slots[edit->property];
  if (slot->set) {
    slot->position = position_of(object, edit->property);
    g_array_remove_index(object->order, slot->position);
  }
  SporeSlot other = *slot;
  *slot = edit->slot;
  edit->slot = other;
  if (slot->set) g_array_insert_val(object->order, MIN(slot->position, object->order->len), edit->property);
  spore_document_notify(object->document, SPORE_DOCUMENT_SET, object, edit->property);
}

static void swap_place(SporeEdit *edit) {
  SporeObject *object = edit->object, *parent = NULL;
  guint index = 0;
  spore_document_forget_names(object->document);
  if (!object->detached) {
    parent = object->parent;
    g_ptr_array_find(parent->children, object, &index);
    g_ptr_array_remove_index(parent->children, index);
    object->detached = TRUE;
  }
  if (edit->parent) {
    object->parent = edit->parent;
    object->detached = FALSE;
    g_ptr_array_insert(edit->parent->children, (gint)edit->index, object);
  }
  SporeChangeKind kind = !parent         ? SPORE_DOCUMENT_INSERTED
                         : !edit->parent ? SPORE_DOCUMENT_REMOVED
                                         : SPORE_DOCUMENT_MOVED;
  edit->parent = parent, edit->index = index;
  spore_document_notify(object->document, kind, object, 0);
}

static void apply(SporeEdit *edit) {
  if (edit->kind == SPORE_EDIT_SET) swap_slot(edit);
  else swap_place(edit);
}

/* Whether the edit merges with an earlier edit of the same property in the same group. Only replaced values merge:
 * setting and unsetting change the order of the properties. */
static gboolean merges(const SporeDocument *document, const SporeEdit *edit) {
  const SporeSlot *slot = &edit->object->slots[edit->property];
  if (edit->kind != SPORE_EDIT_SET || !edit->slot.set || !slot->set) return FALSE;
  guint from = g_array_index(document->marks, guint, document->marks->len - 1);
  for (guint i = document->open->len; i > from; i--) {
    const SporeEdit *earlier = &g_array_index(document->open, SporeEdit, i - 1);
    if (earlier->kind == SPORE_EDIT_SET && earlier->object == edit->object && earlier->property == edit->property)
      return TRUE;
  }
  return FALSE;
}

void spore_document_edit(SporeDocument *document, SporeEdit *edit) {
  g_assert(document->marks->len > 0);
  gboolean merge = merges(document, edit);
  apply(edit);
  if (merge) clear_slot(&edit->slot);
  else g_array_append_val(document->open, *edit);
}

/* Groups. */

void spore_document_begin(SporeDocument *document, const char *label) {
  if (document->marks->len == 0) document->open_label = g_strdup(label);
  g_array_append_val(document->marks, document->open->len);
}

static void close_outermost(SporeDocument *document) {
  if (document->marks->len > 0) return;
  if (document->open->len > 0) {
    SporeUndoStep *step = g_new0(SporeUndoStep, 1);
    step->label = g_steal_pointer(&document->open_label);
    step->serial = ++document->last_serial;
    step->edits = document->open;
    document->open = g_array_new(FALSE, FALSE, sizeof(SporeEdit));
    drop_redo(document);
    g_ptr_array_add(document->undo, step);
    spore_document_notify(document, SPORE_DOCUMENT_HISTORY, NULL, 0);
  }
  g_clear_pointer(&document->open_label, g_free);
}

void spore_document_end(SporeDocument *document) {
  g_return_if_fail(document->marks->len > 0);
  g_array_set_size(document->marks, document->marks->len - 1);
  close_outermost(document);
}

void spore_document_abort(SporeDocument *document) {
  g_return_if_fail(document->marks->len > 0);
  guint from = g_array_index(document->marks, guint, document->marks->len - 1);
  for (guint i = document->open->len; i > from; i--) apply(&g_array_index(document->open, SporeEdit, i - 1));
  forget_created(document, document->open, from);
  for (guint i = from; i < document->open->len; i++) clear_slot(&g_array_index(document->open, SporeEdit, i).slot);
  g_array_set_size(document->open, from);
  g_array_set_size(document->marks, document->marks->len - 1);
  close_outermost(document);
}

/* Walking through history. */

gboolean spore_document_can_undo(const SporeDocument *document) {
  return document->undo->len > 0 && document->marks->len == 0;
}

gboolean spore_document_can_redo(const SporeDocument *document) {
  return document->redo->len > 0 && document->marks->len == 0;
}

static SporeUndoStep *last_step(const GPtrArray *steps) {
  return steps->len > 0 ? g_ptr_array_index(steps, steps->len - 1) : NULL;
}

const char *spore_document_undo_label(const SporeDocument *document) {
  return spore_document_can_undo(document) ? last_step(document->undo)->label : NULL;
}

const char *spore_document_redo_label(const SporeDocument *document) {
  return spore_document_can_redo(document) ? last_step(document->redo)->label : NULL;
}

void spore_document_undo(SporeDocument *document) {
  if (!spore_document_can_undo(document)) return;
  SporeUndoStep *step = g_ptr_array_steal_index(document->undo, document->undo->len - 1);
  for (guint i = step->edits->len; i > 0; i--) apply(&g_array_index(step->edits, SporeEdit, i - 1));
  g_ptr_array_add(document->redo, step);
  spore_document_notify(document, SPORE_DOCUMENT_HISTORY, NULL, 0);
}

void spore_document_redo(SporeDocument *document) {
  if (!spore_document_can_redo(document)) return;
  SporeUndoStep *step = g_ptr_array_steal_index(document->redo, document->redo->len - 1);
  for (guint i = 0; i < step->edits->len; i++) apply(&g_array_index(step->edits, SporeEdit, i));
  g_ptr_array_add(document->undo, step);
  spore_document_notify(document, SPORE_DOCUMENT_HISTORY, NULL, 0);
}

static guint64 current_serial(const SporeDocument *document) {
  const SporeUndoStep *step = last_step(document->undo);
  return step ? step->serial : 0;
}

gboolean spore_document_is_modified(const SporeDocument *document) {
  return document->open->len > 0 || current_serial(document) != document->saved_serial;
}

void spore_document_mark_saved(SporeDocument *document) {
  document->saved_serial = current_serial(document);
  spore_document_notify(document, SPORE_DOCUMENT_HISTORY, NULL, 0);
}
