/* Sections under titles that the user can close; sections that did not change are kept. */
#include "ui/panels/spore-section-list.h"

#include "ui/panels/spore-property-row.h"

struct _SporeSectionList {
  GtkBox parent;
  GHashTable *collapsed; /* set of titles that the user closed */
  int placed;            /* sections since it began */
};

G_DEFINE_FINAL_TYPE(SporeSectionList, spore_section_list, GTK_TYPE_BOX)

static void toggled(GtkExpander *expander, GParamSpec *spec, SporeSectionList *self) {
  const char *title = gtk_widget_get_name(GTK_WIDGET(expander));
  if (gtk_expander_get_expanded(expander)) g_hash_table_remove(self->collapsed, title);
  else g_hash_table_add(self->collapsed, g_strdup(title));
}

/* What tells one section from another: title, path of what it shows, and what holds the regions that it lists with
 * their names. */
static char *key_of(const char *title, const char *path, const SporeObject *holder) {
  GString *key = g_string_new(title);
  g_string_append_printf(key, "|%s", path);
  if (!holder) return g_string_free(key, FALSE);
  g_autofree char *held = spore_object_path(holder);
  gboolean generated = spore_parameter_find(spore_object_type(holder)->table, "source") >= 0;
  const char *source = generated ? spore_object_text(holder, "source") : NULL;
  g_string_append_printf(key, "|%s|%s", held, source ? source : "");
  for (guint i = 0; i < spore_object_child_count(holder); i++)
    g_string_append_printf(key, "|%s", spore_object_name(spore_object_child(holder, i)));
  return g_string_free(key, FALSE);
}

static GtkWidget *find(SporeSectionList *self, const char *key) {
  g_autoptr(GList) sections = gtk_container_get_children(GTK_CONTAINER(self));
  for (GList *section = sections; section; section = section->next)
    if (g_str_equal(g_object_get_data(section->data, "key"), key)) return section->data;
  return NULL;
}

static GtkWidget *new_section(SporeSectionList *self, const char *title, const char *key) {
  GtkWidget *expander = gtk_expander_new(title);
  gtk_widget_set_name(expander, title);
  gtk_expander_set_expanded(GTK_EXPANDER(expander), !g_hash_table_contains(self->collapsed, title));
  g_signal_connect(expander, "notify::expanded", G_CALLBACK(toggled), self);
  gtk_style_context_add_class(gtk_widget_get_style_context(expander), "section");
  g_object_set_data_full(G_OBJECT(expander), "key", g_strdup(key), g_free);
  g_object_set_data_full(G_OBJECT(expander), "rows", g_ptr_array_new(), (GDestroyNotify)g_ptr_array_unref);
  gtk_container_add(GTK_CONTAINER(self), expander);
  return expander;
}

GPtrArray *spore_section_rows(GtkBox *box) {
  return g_object_get_data(G_OBJECT(gtk_widget_get_parent(GTK_WIDGET(box))), "rows");
}

void spore_section_list_begin(SporeSectionList *self) { self->placed = 0; }

GtkBox *spore_section_list_add(SporeSectionList *self, const char *title, const char *path, const SporeObject *holder) {
  g_autofree char *key = key_of(title, path, holder);
  GtkWidget *old = find(self, key), *section = old ? old : new_section(self, title, key);
  gtk_box_reorder_child(GTK_BOX(self), section, self->placed++);
  if (old) return NULL;
  GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 2);
  gtk_style_context_add_class(gtk_widget_get_style_context(box), "section-body");
  gtk_container_add(GTK_CONTAINER(section), box);
  return GTK_BOX(box);
}

/* Sections that were not asked for again are removed. */
void spore_section_list_end(SporeSectionList *self) {
  g_autoptr(GList) sections = gtk_container_get_children(GTK_CONTAINER(self));
  for (GList *old = g_list_nth(sections, (guint)self->placed); old; old = old->next) gtk_widget_destroy(old->data);
  gtk_widget_show_all(GTK_WIDGET(self));
}

GtkWidget *spore_section_fact_new(GtkBox *box) {
  GtkWidget *label = gtk_label_new(NULL);
  gtk_label_set_xalign(GTK_LABEL(label), 0);
  gtk_label_set_line_wrap(GTK_LABEL(label), TRUE);
  gtk_label_set_max_width_chars(GTK_LABEL(label), 40);
  gtk_style_context_add_class(gtk_widget_get_style_context(label), "dim-label");
  gtk_style_context_add_class(gtk_widget_get_style_context(label), "result");
  gtk_container_add(GTK_CONTAINER(box), label);
  return label;
}

void spore_section_list_refresh(SporeSectionList *self) {
  g_autoptr(GList) sections = gtk_container_get_children(GTK_CONTAINER(self));
  for (GList *section = sections; section; section = section->next) {
    GPtrArray *rows = g_object_get_data(section->data, "rows");
    for (guint i = 0; i < rows->len; i++) spore_property_row_refresh(rows->pdata[i]);
  }
}

static void spore_section_list_finalize(GObject *object) {
  g_hash_table_unref(SPORE_SECTION_LIST(object)->collapsed);
  G_OBJECT_CLASS(spore_section_list_parent_class)->finalize(object);
}

static void spore_section_list_class_init(SporeSectionListClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_section_list_finalize;
}

static void spore_section_list_init(SporeSectionList *self) {
  self->collapsed = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
}
