/* The menu of the outliner's rows. */
#include <glib/gi18n.h>

#include "ui/panels/spore-outliner-private.h"

static GMenu *menu_of(const SporeObject *object) {
  GMenu *menu = g_menu_new();
  g_autoptr(GMenu) order = g_menu_new(), view = g_menu_new(), rest = g_menu_new();
  if (g_str_equal(spore_object_type(object)->element, "body")) {
    g_menu_append(view, _("Hide"), "win.hide");
    g_menu_append(view, _("Show only this"), "win.isolate");
    g_menu_append(view, _("Show all"), "win.show-all");
    g_menu_append(view, _("Lock or unlock"), "win.lock");
    g_menu_append_section(menu, NULL, G_MENU_MODEL(view));
  }
  g_menu_append(order, _("Move up"), "win.move-row(-1)");
  g_menu_append(order, _("Move down"), "win.move-row(1)");
  g_menu_append(rest, _("Rename…"), "win.rename-dialog");
  g_menu_append(rest, _("Delete"), "win.delete");
  g_menu_append_section(menu, NULL, G_MENU_MODEL(order));
  g_menu_append_section(menu, NULL, G_MENU_MODEL(rest));
  return menu;
}

void spore_outliner_popup(SporeOutliner *self, const GdkEvent *event, GtkTreePath *path) {
  const SporeObject *object = spore_outliner_object_at(self, path);
  if (!object || !spore_object_name(object)) return;
  if (!gtk_tree_selection_path_is_selected(self->selection, path))
    gtk_tree_view_set_cursor(GTK_TREE_VIEW(self->tree), path, NULL, FALSE);
  g_autoptr(GMenu) model = menu_of(object);
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
