/* Bodies that are hidden from the view or locked in it, and the menu of the right button. Both are of the view alone:
 * the scene and its simulation do not know of it. */
#include "ui/viewport/spore-viewport-private.h"

#include <glib/gi18n.h>

static void hidden_changed(SporeViewport *self) {
  if (self->stage) spore_stage_set_hidden(self->stage, self->hidden);
  spore_viewport_redraw(self);
}

guint spore_viewport_hidden_count(SporeViewport *self) {
  guint count = 0;
  if (!self->document) return 0;
  const SporeObject *bodies = spore_document_section(spore_editor_document_get(self->document), "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    count +=
        g_hash_table_contains(self->hidden, GUINT_TO_POINTER(spore_object_id(spore_object_child(bodies, i)))) != FALSE;
  return count;
}

GHashTable *spore_viewport_get_hidden(SporeViewport *self) { return self->hidden; }

void spore_viewport_hide_or_show(SporeViewport *self, const SporeObject *body) {
  gpointer id = GUINT_TO_POINTER(spore_object_id(body));
  if (!g_hash_table_remove(self->hidden, id)) g_hash_table_add(self->hidden, id);
  hidden_changed(self);
}

void spore_viewport_hide(SporeViewport *self, const GPtrArray *bodies) {
  for (guint i = 0; i < bodies->len; i++)
    g_hash_table_add(self->hidden, GUINT_TO_POINTER(spore_object_id(bodies->pdata[i])));
  hidden_changed(self);
}

void spore_viewport_isolate(SporeViewport *self, const GPtrArray *bodies) {
  const SporeObject *all = spore_document_section(spore_editor_document_get(self->document), "bodies");
  g_hash_table_remove_all(self->hidden);
  for (guint i = 0; i < spore_object_child_count(all); i++)
    g_hash_table_add(self->hidden, GUINT_TO_POINTER(spore_object_id(spore_object_child(all, i))));
  for (guint i = 0; i < bodies->len; i++)
    g_hash_table_remove(self->hidden, GUINT_TO_POINTER(spore_object_id(bodies->pdata[i])));
  hidden_changed(self);
}

void spore_viewport_show_all(SporeViewport *self) {
  g_hash_table_remove_all(self->hidden);
  hidden_changed(self);
}

/* Locks. */

GHashTable *spore_viewport_get_locked(SporeViewport *self) { return self->locked; }

static gboolean are_all_locked(SporeViewport *self, const GPtrArray *bodies) {
  for (guint i = 0; i < bodies->len; i++)
    if (!g_hash_table_contains(self->locked, GUINT_TO_POINTER(spore_object_id(bodies->pdata[i])))) return FALSE;
  return TRUE;
}

/* What the Edit tool works on is looked for again. */
static void locks_changed(SporeViewport *self) {
  spore_viewport_edit_refresh(self);
  spore_viewport_redraw(self);
}

void spore_viewport_lock_or_unlock(SporeViewport *self, const GPtrArray *bodies) {
  gboolean frees = are_all_locked(self, bodies);
  for (guint i = 0; i < bodies->len; i++) {
    gpointer id = GUINT_TO_POINTER(spore_object_id(bodies->pdata[i]));
    if (frees) g_hash_table_remove(self->locked, id);
    else g_hash_table_add(self->locked, id);
  }
  locks_changed(self);
}

void spore_viewport_unlock_all(SporeViewport *self) {
  g_hash_table_remove_all(self->locked);
  locks_changed(self);
}

/* The menu. */

static GMenu *menu_of_levels(void) {
  GMenu *menu = g_menu_new();
  g_menu_append(menu, _("Coarse: a quarter"), "win.add-level::coarse");
  g_menu_append(menu, _("Medium: half"), "win.add-level::medium");
  return menu;
}

static GMenu *menu_of_body(SporeViewport *self) {
  GMenu *menu = g_menu_new();
  g_autoptr(GMenu) levels = menu_of_levels();
  g_menu_append(menu, _("Make soft"), "win.make-soft");
  g_menu_append(menu, _("Hold"), "win.add-pin");
  g_menu_append_submenu(menu, _("Add link"), self->link_kinds);
  g_menu_append_submenu(menu, _("Add fluid"), self->fluid_kinds);
  g_menu_append_submenu(menu, _("Add level of detail"), G_MENU_MODEL(levels));
  g_menu_append(menu, _("Hide"), "win.hide");
  g_menu_append(menu, _("Show only this"), "win.isolate");
  g_menu_append(menu, _("Show all"), "win.show-all");
  g_menu_append(menu, _("Lock or unlock"), "win.lock");
  g_menu_append(menu, _("Copy beside it"), "win.duplicate");
  g_menu_append(menu, _("Rename…"), "win.rename-dialog");
  g_menu_append(menu, _("Delete"), "win.delete");
  return menu;
}

static GMenu *menu_of_nothing(SporeViewport *self) {
  GMenu *menu = g_menu_new();
  g_menu_append(menu, _("Frame"), "win.frame");
  g_menu_append(menu, _("Show all"), "win.show-all");
  g_menu_append(menu, _("Unlock all"), "win.unlock-all");
  g_menu_append_submenu(menu, _("Add instrument"), self->instrument_kinds);
  g_menu_append(menu, _("Import…"), "win.import-dialog");
  return menu;
}

void spore_viewport_popup(SporeViewport *self, const GdkEvent *event, gboolean of_body) {
  g_autoptr(GMenu) model = of_body ? menu_of_body(self) : menu_of_nothing(self);
  GtkWidget *menu = gtk_menu_new_from_model(G_MENU_MODEL(model));
  gtk_menu_attach_to_widget(GTK_MENU(menu), self->area, NULL);
  g_signal_connect(menu, "selection-done", G_CALLBACK(gtk_widget_destroy), NULL);
  gtk_menu_popup_at_pointer(GTK_MENU(menu), event);
}
