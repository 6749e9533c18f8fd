/* The menu of the outliner's rows. */
#include <glib/gi18n.h>

#include "core/author/order_edits.h"
#include "ui/panels/spore-outliner-private.h"

/* The folders that the scene has, a new one, and none. */
static GMenu *menu_of_folders(SporeDocument *document) {
  GMenu *menu = g_menu_new();
  const SporeObject *bodies = spore_document_section(document, "bodies");
  g_autoptr(GHashTable) listed = g_hash_table_new(g_str_hash, g_str_equal);
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const char *folder = spore_folder_of(spore_object_child(bodies, i));
    if (!folder || !g_hash_table_add(listed, (gpointer)folder)) continue;
    g_autoptr(GMenuItem) item = g_menu_item_new(folder, NULL);
    g_menu_item_set_action_and_target(item, "win.put-in-folder", "s", folder);
    g_menu_append_item(menu, item);
  }
  g_menu_append(menu, _("New folder"), "win.new-folder");
  g_menu_append(menu, _("No folder"), "win.put-in-folder::");
  return menu;
}

static void add_body_items(GMenu *menu, SporeDocument *document) {
  g_autoptr(GMenu) view = g_menu_new(), folders = menu_of_folders(document);
  g_menu_append(view, _("Hide"), "win.hide");
  g_menu_append(view, _("Show only this"), "win.isolate");
  g_menu_append(view, _("Show all"), "win.show-all");
  g_menu_append(view, _("Lock or unlock"), "win.lock");
  g_menu_append_submenu(view, _("Put into a folder"), G_MENU_MODEL(folders));
  g_menu_append_section(menu, NULL, G_MENU_MODEL(view));
}

/* object: NULL: a folder. */
static GMenu *menu_of(SporeDocument *document, const SporeObject *object) {
  GMenu *menu = g_menu_new();
  g_autoptr(GMenu) order = g_menu_new(), rest = g_menu_new();
  if (!object || g_str_equal(spore_object_type(object)->element, "body")) add_body_items(menu, document);
  if (object) g_menu_append(order, _("Move up"), "win.move-row(-1)");
  if (object) g_menu_append(order, _("Move down"), "win.move-row(1)");
  g_menu_append(rest, _("Rename…"), "win.rename-row");
  g_menu_append(rest, _("Delete"), "win.delete");
  g_menu_append_section(menu, NULL, G_MENU_MODEL(order));
  g_menu_append_section(menu, NULL, G_MENU_MODEL(rest));
  return menu;
}

void spore_outliner_popup(SporeOutliner *self, const GdkEvent *event, GtkTreePath *path) {
  const SporeObject *object = spore_outliner_object_at(self, path);
  g_autofree char *folder = spore_outliner_folder_at(self, path);
  if (!folder && (!object || !spore_object_name(object))) return;
  if (folder || !gtk_tree_selection_path_is_selected(self->selection, path))
    gtk_tree_view_set_cursor(GTK_TREE_VIEW(self->tree), path, NULL, FALSE);
  g_autoptr(GMenu) model = menu_of(spore_editor_document_get(self->document), object);
  /* It stays until the next one: what presses items for users who do not see them goes on when the item is done. */
  g_clear_pointer(&self->menu, gtk_widget_destroy);
  GtkWidget *menu = self->menu = gtk_menu_new_from_model(G_MENU_MODEL(model));
  gtk_menu_attach_to_widget(GTK_MENU(menu), self->tree, NULL);
  g_signal_connect(menu, "destroy", G_CALLBACK(gtk_widget_destroyed), &self->menu);
  if (event) {
    gtk_menu_popup_at_pointer(GTK_MENU(menu), event);
    return;
  }
  GdkRectangle cell;
  gtk_tree_view_get_cell_area(GTK_TREE_VIEW(self->tree), path, self->column, &cell);
  gtk_tree_view_convert_bin_window_to_widget_coords(GTK_TREE_VIEW(self->tree), cell.x, cell.y, &cell.x, &cell.y);
  gtk_menu_popup_at_rect(GTK_MENU(menu), gtk_widget_get_window(self->tree), &cell, GDK_GRAVITY_SOUTH_WEST,
                         GDK_GRAVITY_NORTH_WEST, NULL);
}
