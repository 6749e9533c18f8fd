/* What is done to all that is selected: made soft, held, hidden, shown alone, locked, deleted. */
#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/level_edits.h"
#include "core/author/order_edits.h"
#include "core/author/removal.h"
#include "core/author/soft_edits.h"
#include "ui/document/kept-bodies.h"
#include "ui/spore-window-private.h"

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

/* Selecting. */

void spore_window_select(SporeWindow *self, const GPtrArray *bodies) {
  g_autofree guint32 *ids = g_new(guint32, bodies->len);
  for (guint i = 0; i < bodies->len; i++) ids[i] = spore_object_id(bodies->pdata[i]);
  spore_editor_document_select_several(self->document, ids, bodies->len);
}

/* All bodies but those that a hand leads. */
static void act_select_organs(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeObject *bodies = spore_document_section(document_of(self), "bodies");
  g_autoptr(GPtrArray) organs = g_ptr_array_new();
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if ((SporeRole)spore_object_number(body, "role") != SPORE_ACTIVE) g_ptr_array_add(organs, body);
  }
  spore_window_select(self, organs);
}

/* Making soft. */

/* Says what became of each organ; those that were left out are a matter for the message bar. */
static void tell_soft(SporeWindow *self, const SporeSoftWork *work) {
  g_autoptr(GString) left_out = g_string_new(NULL);
  for (guint i = 0; i < work->organs->len; i++) {
    const SporeSoftOrgan *organ = work->organs->pdata[i];
    g_autofree char *text = spore_soft_organ_text(organ);
    if (!organ->refused) spore_window_log(self, "%s", text);
    else g_string_append_printf(left_out, "%s%s", left_out->len ? "\n" : "", text);
  }
  if (left_out->len) spore_window_complain(self, left_out->str);
}

static void made_soft(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  g_autoptr(GError) failure = NULL;
  if (spore_window_failed(self, error) || !self->document) return;
  if (spore_soft_work_apply(data, document_of(self), &failure)) tell_soft(self, data);
  else spore_window_failed(self, failure);
}

/* Selected bodies that cannot be made soft stay as they are. */
static void act_make_soft(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GError) error = NULL;
  for (guint i = bodies->len; i > 0; i--)
    if (!spore_soft_may(document_of(self), bodies->pdata[i - 1], NULL)) g_ptr_array_remove_index(bodies, i - 1);
  SporeSoftWork *work = bodies->len ? spore_soft_work_new(document_of(self), bodies, &error) : NULL;
  if (work) spore_window_start_job(self, _("Making soft"), spore_soft_work_run, work, spore_soft_work_free, made_soft);
  else spore_window_failed(self, error);
}

/* Levels of detail. */

static void made_level(SporeJob *job, gpointer data, const GError *error, gpointer owner) {
  SporeWindow *self = owner;
  g_autoptr(GError) failure = NULL;
  if (spore_window_failed(self, error) || !self->document) return;
  SporeObject *level = spore_level_work_apply(data, document_of(self), &failure);
  if (!level) spore_window_failed(self, failure);
}

static void act_add_level(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_window_body_to_work_on(self);
  const char *element = g_variant_get_string(parameter, NULL);
  g_autoptr(GError) error = NULL;
  if (!body || (!g_str_equal(element, "coarse") && !g_str_equal(element, "medium"))) return;
  SporeLevelWork *work = spore_level_work_new(document_of(self), body, element, &error);
  if (work)
    spore_window_start_job(self, _("Making a level"), spore_level_work_run, work, spore_level_work_free, made_level);
  else spore_window_failed(self, error);
}

static void act_remove_level(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_edit_remove_level(document_of(self), g_variant_get_string(parameter, NULL), &error))
    spore_window_failed(self, error);
}

/* Holding. */

/* Of several bodies, those that fall. */
static gboolean hold_all(SporeDocument *document, const GPtrArray *bodies, GError **error) {
  for (guint i = 0; i < bodies->len; i++) {
    SporeObject *body = bodies->pdata[i];
    if (bodies->len > 1 && (SporeRole)spore_object_number(body, "role") != SPORE_PASSIVE) continue;
    if (!spore_edit_add_pin(document, body, error)) return FALSE;
  }
  return TRUE;
}

static void act_add_pin(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GError) error = NULL;
  SporeObject *only = bodies->len ? NULL : spore_window_body_to_work_on(self);
  if (only) g_ptr_array_add(bodies, only);
  spore_document_begin(document_of(self), _("Hold"));
  if (!spore_edit_finish(document_of(self), hold_all(document_of(self), bodies, &error)))
    spore_window_failed(self, error);
}

/* Locks, and what is hidden, are kept with the scene's file. */

static void keep(SporeWindow *self, const char *mark, GHashTable *marked) {
  const char *scene = spore_editor_document_get_save_file(self->document);
  g_autoptr(GError) error = NULL;
  if (scene && !spore_kept_bodies_write(scene, mark, document_of(self), marked, &error) && error)
    spore_window_log(self, "%s", error->message);
}

/* Hiding. */

static void show_hidden(SporeWindow *self) {
  spore_outliner_set_hidden(SPORE_OUTLINER(self->outliner), spore_viewport_get_hidden(SPORE_VIEWPORT(self->viewport)));
  spore_window_update_actions(self);
  spore_window_show_hint(self);
}

static void shown_changed(SporeWindow *self) {
  show_hidden(self);
  keep(self, SPORE_KEPT_HIDDEN, spore_viewport_get_hidden(SPORE_VIEWPORT(self->viewport)));
}

/* The selected bodies are hidden, or shown alone. */
static void act_hide(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  gboolean alone = g_str_equal(g_action_get_name(G_ACTION(action)), "isolate");
  if (!bodies->len) return;
  (alone ? spore_viewport_isolate : spore_viewport_hide)(SPORE_VIEWPORT(self->viewport), bodies);
  shown_changed(self);
}

static void act_hide_or_show(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_document_by_path(document_of(self), g_variant_get_string(parameter, NULL));
  if (!body || !g_str_equal(spore_object_type(body)->element, "body")) return;
  spore_viewport_hide_or_show(SPORE_VIEWPORT(self->viewport), body);
  shown_changed(self);
}

static void act_show_all(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  spore_viewport_show_all(SPORE_VIEWPORT(self->viewport));
  shown_changed(self);
}

/* Locking. */

static void show_locks(SporeWindow *self) {
  spore_outliner_set_locked(SPORE_OUTLINER(self->outliner), spore_viewport_get_locked(SPORE_VIEWPORT(self->viewport)));
  spore_window_update_actions(self);
  spore_window_show_hint(self);
}

void spore_window_keep_marks(SporeWindow *self) {
  keep(self, SPORE_KEPT_LOCKED, spore_viewport_get_locked(SPORE_VIEWPORT(self->viewport)));
  keep(self, SPORE_KEPT_HIDDEN, spore_viewport_get_hidden(SPORE_VIEWPORT(self->viewport)));
}

static GPtrArray *kept(SporeWindow *self, const char *mark) {
  const char *scene = spore_editor_document_get_save_file(self->document);
  return scene ? spore_kept_bodies_read(scene, mark, document_of(self)) : g_ptr_array_new();
}

void spore_window_restore_marks(SporeWindow *self) {
  g_autoptr(GPtrArray) locked = kept(self, SPORE_KEPT_LOCKED), hidden = kept(self, SPORE_KEPT_HIDDEN);
  if (locked->len > 0) spore_viewport_lock_or_unlock(SPORE_VIEWPORT(self->viewport), locked);
  if (hidden->len > 0) spore_viewport_hide(SPORE_VIEWPORT(self->viewport), hidden);
  if (locked->len > 0) show_locks(self);
  if (hidden->len > 0) show_hidden(self);
}

static void locks_changed(SporeWindow *self) {
  show_locks(self);
  keep(self, SPORE_KEPT_LOCKED, spore_viewport_get_locked(SPORE_VIEWPORT(self->viewport)));
}

static void act_lock(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  spore_viewport_lock_or_unlock(SPORE_VIEWPORT(self->viewport), bodies);
  locks_changed(self);
}

static void act_lock_or_unlock(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_document_by_path(document_of(self), g_variant_get_string(parameter, NULL));
  g_autoptr(GPtrArray) bodies = g_ptr_array_new();
  if (!body || !g_str_equal(spore_object_type(body)->element, "body")) return;
  g_ptr_array_add(bodies, body);
  spore_viewport_lock_or_unlock(SPORE_VIEWPORT(self->viewport), bodies);
  locks_changed(self);
}

static void act_unlock_all(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  spore_viewport_unlock_all(SPORE_VIEWPORT(self->viewport));
  locks_changed(self);
}

/* Folders. */

static void put_in_folder(SporeWindow *self, const char *folder) {
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof(guint32));
  g_autoptr(GError) error = NULL;
  for (guint i = 0; i < bodies->len; i++) {
    guint32 id = spore_object_id(bodies->pdata[i]);
    g_array_append_val(ids, id);
  }
  if (!spore_edit_put_in_folder(document_of(self), ids, *folder ? folder : NULL, &error))
    spore_window_failed(self, error);
}

static void act_put_in_folder(GSimpleAction *action, GVariant *parameter, gpointer data) {
  put_in_folder(data, g_variant_get_string(parameter, NULL));
}

static void act_new_folder(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autofree char *name = spore_folder_new_name(document_of(self));
  put_in_folder(self, name);
}

/* Deleting. */

/* What went along, and how to have it back. */
static void tell_along(SporeWindow *self, const GPtrArray *along) {
  g_autoptr(GString) list = g_string_new(NULL);
  for (guint i = 0; i < along->len; i++)
    g_string_append_printf(list, i ? ", %s" : "%s", ((const SporeAlong *)along->pdata[i])->text);
  g_autofree char *text =
      g_strdup_printf(ngettext("%u thing went along, since nothing else uses it: %s",
                               "%u things went along, since nothing else uses them: %s", along->len),
                      along->len, list->str);
  self->deleted_revision = spore_document_revision(document_of(self));
  spore_window_complain_while(self, SPORE_CAUSE_EDIT, text, _("Keep them"), "win.keep-along");
}

static void delete_selected(SporeWindow *self, gboolean alone) {
  g_autoptr(GError) error = NULL;
  g_autoptr(GPtrArray) along = spore_along_new();
  if (!spore_edit_delete(document_of(self), self->deleted, alone, along, &error)) spore_window_failed(self, error);
  else if (along->len) tell_along(self, along);
}

static void act_delete(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  gsize count;
  const guint32 *selected = spore_editor_document_get_selected(self->document, &count);
  g_array_set_size(self->deleted, 0); /* the selection changes meanwhile */
  g_array_append_vals(self->deleted, selected, (guint)count);
  delete_selected(self, g_str_equal(g_action_get_name(G_ACTION(action)), "delete-alone"));
}

/* The last deletion once more, without what went along. */
static void act_keep_along(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (self->deleted_revision != spore_document_revision(document_of(self))) return;
  spore_document_undo(document_of(self));
  delete_selected(self, TRUE);
}

void spore_window_add_body_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"select-organs", act_select_organs},
      {"make-soft", act_make_soft},
      {"add-level", act_add_level, "s"},
      {"remove-level", act_remove_level, "s"},
      {"add-pin", act_add_pin},
      {"hide", act_hide},
      {"isolate", act_hide},
      {"hide-or-show", act_hide_or_show, "s"},
      {"show-all", act_show_all},
      {"lock", act_lock},
      {"lock-or-unlock", act_lock_or_unlock, "s"},
      {"unlock-all", act_unlock_all},
      {"put-in-folder", act_put_in_folder, "s"},
      {"new-folder", act_new_folder},
      {"delete", act_delete},
      {"delete-alone", act_delete},
      {"keep-along", act_keep_along},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
