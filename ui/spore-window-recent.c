/* Scenes that were opened or saved last, of the list that all programs of the desktop share. */
#include <string.h>

#include "ui/spore-window-private.h"

#define MOST 8 /* that are offered */

static gboolean is_scene(GtkRecentInfo *info) {
  const char *uri = gtk_recent_info_get_uri(info);
  gboolean named = g_str_has_suffix(uri, ".spore") || g_str_has_suffix(uri, ".sporez");
  return named && gtk_recent_info_is_local(info) && gtk_recent_info_exists(info);
}

static int newest_first(gconstpointer a, gconstpointer b) {
  time_t one = gtk_recent_info_get_modified((GtkRecentInfo *)a),
         other = gtk_recent_info_get_modified((GtkRecentInfo *)b);
  return one < other ? 1 : one > other ? -1 : 0;
}

/* Scenes are told apart by their folders, since many are called alike. */
static void add(GMenu *menu, const char *file) {
  g_autofree char *shown = g_filename_display_name(file);
  const char *home = g_get_home_dir();
  gsize length = strlen(home);
  gboolean below = length > 1 && strncmp(shown, home, length) == 0 && shown[length] == G_DIR_SEPARATOR;
  g_autofree char *brief = below ? g_strconcat("~", shown + length, NULL) : g_strdup(shown);
  char **parts = g_strsplit(brief, "_", -1); /* menus take one underscore for the mark of a key */
  g_autofree char *label = g_strjoinv("__", parts);
  g_strfreev(parts);
  g_autoptr(GMenuItem) item = g_menu_item_new(label, NULL);
  g_menu_item_set_action_and_target(item, "win.open", "s", file);
  g_menu_append_item(menu, item);
}

static void fill(SporeWindow *self) {
  GList *all = g_list_sort(gtk_recent_manager_get_items(gtk_recent_manager_get_default()), newest_first);
  int count = 0;
  g_menu_remove_all(self->recent);
  for (GList *at = all; at && count < MOST; at = at->next) {
    g_autofree char *file =
        is_scene(at->data) ? g_filename_from_uri(gtk_recent_info_get_uri(at->data), NULL, NULL) : NULL;
    if (!file) continue;
    add(self->recent, file);
    count++;
  }
  spore_viewport_set_recent(SPORE_VIEWPORT(self->viewport), G_MENU_MODEL(self->recent));
}

void spore_window_remember(const char *file) {
  g_autofree char *path = g_canonicalize_filename(file, NULL);
  g_autofree char *uri = g_filename_to_uri(path, NULL, NULL);
  if (uri) gtk_recent_manager_add_item(gtk_recent_manager_get_default(), uri);
}

void spore_window_follow_recent(SporeWindow *self) {
  g_signal_connect_object(gtk_recent_manager_get_default(), "changed", G_CALLBACK(fill), self, G_CONNECT_SWAPPED);
  fill(self);
}
