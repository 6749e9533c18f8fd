/* The search for a command: it filters as the user types, and Enter runs what is chosen. */
#include "ui/dialogs/spore-search.h"

#include <glib/gi18n.h>

#define COMMAND "spore-command" /* of a row */
#define WIDTH 520
#define HEIGHT 440

typedef struct Search {
  GtkWidget *dialog, *entry, *list, *none;
  GPtrArray *commands;
} Search;

static void search_free(gpointer data) {
  Search *search = data;
  g_ptr_array_unref(search->commands);
  g_free(search);
}

static const SporeSearchHit *command_of(GtkListBoxRow *row) {
  return row ? g_object_get_data(G_OBJECT(row), COMMAND) : NULL;
}

static GtkWidget *label_new(const char *text, gboolean dim) {
  GtkWidget *label = gtk_label_new(text);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  if (dim) gtk_style_context_add_class(gtk_widget_get_style_context(label), "dim-label");
  return label;
}

/* What cannot be done is grey and says why, also to who hears it. */
static GtkWidget *row_new(SporeSearchHit *command) {
  GtkWidget *row = gtk_list_box_row_new(), *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 12);
  GtkWidget *texts = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
  g_autofree char *told = command->missing ? g_strdup_printf("%s: %s", command->label, command->missing) : NULL;
  gtk_box_pack_start(GTK_BOX(texts), label_new(command->label, command->missing != NULL), FALSE, FALSE, 0);
  if (command->missing) gtk_box_pack_start(GTK_BOX(texts), label_new(command->missing, TRUE), FALSE, FALSE, 0);
  gtk_box_pack_start(GTK_BOX(box), texts, TRUE, TRUE, 0);
  if (command->keys) gtk_box_pack_end(GTK_BOX(box), label_new(command->keys, TRUE), FALSE, FALSE, 0);
  gtk_container_set_border_width(GTK_CONTAINER(box), 6);
  gtk_container_add(GTK_CONTAINER(row), box);
  gtk_list_box_row_set_activatable(GTK_LIST_BOX_ROW(row), !command->missing);
  atk_object_set_name(gtk_widget_get_accessible(row), told ? told : command->label);
  g_object_set_data(G_OBJECT(row), COMMAND, command);
  return row;
}

/* Every word that is typed begins a word of the label, or stands in it. */
static gboolean matches(GtkListBoxRow *row, gpointer data) {
  const Search *search = data;
  g_autofree char *label = g_utf8_casefold(command_of(row)->label, -1);
  g_autofree char *typed = g_utf8_casefold(gtk_entry_get_text(GTK_ENTRY(search->entry)), -1);
  g_auto(GStrv) words = g_strsplit(typed, " ", -1);
  if (g_str_match_string(typed, label, TRUE)) return TRUE; /* accents may be left out */
  for (char **word = words; *word; word++)
    if (!strstr(label, *word)) return FALSE;
  return TRUE;
}

/* What can be done stands first. */
static int order(GtkListBoxRow *a, GtkListBoxRow *b, gpointer data) {
  gboolean lacks_a = command_of(a)->missing != NULL, lacks_b = command_of(b)->missing != NULL;
  return lacks_a != lacks_b ? lacks_a - lacks_b : g_utf8_collate(command_of(a)->label, command_of(b)->label);
}

static void choose(Search *search, GtkListBoxRow *row) {
  if (!row) return;
  gtk_list_box_select_row(GTK_LIST_BOX(search->list), row);
  GtkAllocation place;
  gtk_widget_get_allocation(GTK_WIDGET(row), &place);
  GtkAdjustment *adjustment = gtk_list_box_get_adjustment(GTK_LIST_BOX(search->list));
  if (adjustment) gtk_adjustment_clamp_page(adjustment, place.y, place.y + place.height);
}

/* The next row that is shown, downward or upward. */
static GtkListBoxRow *next_row(Search *search, int from, int by) {
  for (int i = from;; i += by) {
    GtkListBoxRow *row = gtk_list_box_get_row_at_index(GTK_LIST_BOX(search->list), i);
    if (!row || gtk_widget_get_child_visible(GTK_WIDGET(row))) return row;
  }
}

static void typed(Search *search) {
  gtk_list_box_invalidate_filter(GTK_LIST_BOX(search->list));
  gtk_list_box_unselect_all(GTK_LIST_BOX(search->list));
  GtkListBoxRow *first = next_row(search, 0, 1);
  gtk_widget_set_visible(search->none, !first);
  choose(search, first);
}

static void run(Search *search, GtkListBoxRow *row) {
  const SporeSearchHit *command = command_of(row);
  g_autofree char *action = NULL;
  g_autoptr(GVariant) target = NULL;
  if (!command || command->missing || !g_action_parse_detailed_name(command->action, &action, &target, NULL)) return;
  GtkWindow *window = gtk_window_get_transient_for(GTK_WINDOW(search->dialog));
  GActionGroup *group =
      g_str_has_prefix(action, "app.") ? G_ACTION_GROUP(gtk_window_get_application(window)) : G_ACTION_GROUP(window);
  g_autofree char *name = g_strdup(strchr(action, '.') + 1);
  g_autoptr(GVariant) taken = target ? g_variant_ref(target) : NULL;
  gtk_widget_destroy(search->dialog); /* which frees the search */
  g_action_group_activate_action(group, name, taken);
}

static void run_chosen(Search *search) { run(search, gtk_list_box_get_selected_row(GTK_LIST_BOX(search->list))); }

static void row_activated(GtkListBox *list, GtkListBoxRow *row, Search *search) { run(search, row); }

/* Arrows choose while the text keeps the keyboard. */
static gboolean key_pressed(GtkWidget *entry, GdkEventKey *event, Search *search) {
  GtkListBoxRow *row = gtk_list_box_get_selected_row(GTK_LIST_BOX(search->list));
  int by = event->keyval == GDK_KEY_Down ? 1 : event->keyval == GDK_KEY_Up ? -1 : 0;
  if (by) choose(search, next_row(search, row ? gtk_list_box_row_get_index(row) + by : 0, by));
  return by ? GDK_EVENT_STOP : GDK_EVENT_PROPAGATE;
}

GtkWidget *spore_search_new(GtkWindow *window, GPtrArray *commands) {
  Search *search = g_new0(Search, 1);
  search->commands = commands;
  search->dialog = gtk_dialog_new_with_buttons(
      _("Search for a command"), window, GTK_DIALOG_MODAL | GTK_DIALOG_DESTROY_WITH_PARENT | GTK_DIALOG_USE_HEADER_BAR,
      NULL, NULL);
  search->entry = gtk_search_entry_new();
  search->list = gtk_list_box_new();
  search->none = label_new(_("No command has these words"), TRUE);
  GtkWidget *scroll = gtk_scrolled_window_new(NULL, NULL);
  GtkWidget *box = gtk_dialog_get_content_area(GTK_DIALOG(search->dialog));
  g_object_set_data_full(G_OBJECT(search->dialog), "spore-search", search, search_free);
  gtk_window_set_default_size(GTK_WINDOW(search->dialog), WIDTH, HEIGHT);
  gtk_entry_set_placeholder_text(GTK_ENTRY(search->entry), _("What to do"));
  atk_object_set_name(gtk_widget_get_accessible(search->entry), _("What to do"));
  atk_object_set_name(gtk_widget_get_accessible(search->list), _("Commands"));
  gtk_widget_set_no_show_all(search->none, TRUE);
  gtk_list_box_set_filter_func(GTK_LIST_BOX(search->list), matches, search, NULL);
  gtk_list_box_set_sort_func(GTK_LIST_BOX(search->list), order, search, NULL);
  for (guint i = 0; i < commands->len; i++) gtk_container_add(GTK_CONTAINER(search->list), row_new(commands->pdata[i]));
  gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scroll), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
  gtk_container_add(GTK_CONTAINER(scroll), search->list);
  gtk_box_pack_start(GTK_BOX(box), search->entry, FALSE, FALSE, 0);
  gtk_box_pack_start(GTK_BOX(box), search->none, FALSE, FALSE, 12);
  gtk_box_pack_start(GTK_BOX(box), scroll, TRUE, TRUE, 0);
  g_signal_connect_swapped(search->entry, "changed", G_CALLBACK(typed), search);
  g_signal_connect_swapped(search->entry, "activate", G_CALLBACK(run_chosen), search);
  g_signal_connect_swapped(search->entry, "stop-search", G_CALLBACK(gtk_window_close), search->dialog);
  g_signal_connect(search->entry, "key-press-event", G_CALLBACK(key_pressed), search);
  g_signal_connect(search->list, "row-activated", G_CALLBACK(row_activated), search);
  typed(search);
  return search->dialog;
}
