/* The row of tabs below the view: where the window has no room for all of them, it scrolls, and a menu has them all. */
#include "ui/spore-window-private.h"

#define NOTCH_PIXELS 60 /* that a notch of the wheel scrolls */

/* The row shows the tab that is chosen. */
static void show_chosen(SporeWindow *self) {
  GtkAdjustment *place = gtk_scrolled_window_get_hadjustment(GTK_SCROLLED_WINDOW(self->tab_row));
  g_autoptr(GList) buttons = gtk_container_get_children(GTK_CONTAINER(self->tab_switcher));
  for (GList *button = buttons; button; button = button->next) {
    int x;
    if (!gtk_toggle_button_get_active(button->data) ||
        !gtk_widget_translate_coordinates(button->data, self->tab_switcher, 0, 0, &x, NULL))
      continue;
    gtk_adjustment_clamp_page(place, x, x + gtk_widget_get_allocated_width(button->data));
  }
}

/* A wheel has one direction, and so has the row. */
static gboolean scrolled(GtkWidget *row, GdkEventScroll *event, SporeWindow *self) {
  GtkAdjustment *place = gtk_scrolled_window_get_hadjustment(GTK_SCROLLED_WINDOW(row));
  double notches_x = 0, notches_y = 0;
  if (!gdk_event_get_scroll_deltas((GdkEvent *)event, &notches_x, &notches_y))
    notches_y = event->direction == GDK_SCROLL_DOWN || event->direction == GDK_SCROLL_RIGHT ? 1 : -1;
  gtk_adjustment_set_value(place, gtk_adjustment_get_value(place) + NOTCH_PIXELS * (notches_x + notches_y));
  return GDK_EVENT_STOP;
}

static void act_show_tab(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  GtkWidget *page = gtk_stack_get_child_by_name(GTK_STACK(self->tabs), g_variant_get_string(parameter, NULL));
  if (page) spore_window_show_tab(self, page);
}

void spore_window_add_tab_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"show-tab", act_show_tab, "s"}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  g_signal_connect_object(self->tabs, "notify::visible-child", G_CALLBACK(show_chosen), self,
                          G_CONNECT_SWAPPED | G_CONNECT_AFTER);
  g_signal_connect_object(self->tab_row, "size-allocate", G_CALLBACK(show_chosen), self,
                          G_CONNECT_SWAPPED | G_CONNECT_AFTER);
  g_signal_connect_object(self->tab_row, "scroll-event", G_CALLBACK(scrolled), self, 0);
}
