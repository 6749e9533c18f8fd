/* Whole scenes to begin with: those that ship, each as a scene without a file. Their pictures are made by
 * resources/pictures/make_templates.sh. */
#include <glib/gi18n.h>

#include "ui/spore-window-private.h"

#define PICTURE_DENSITY 2 /* pixels of a picture to one of the screen, which may have as many */
#define COLUMNS 3

static const struct {
  const char *name, *scene; /* scene: its file, without its suffix */
  const char *label, *word; /* translatable; word: under its picture */
} templates[] = {
    {"organ", "plate4-deformed-ovary", N_("Organ: a soft ovary that a probe pushes"), N_("Organ")},
    {"thread", "plate5-string", N_("Thread: a string in coils that touches itself"), N_("Thread")},
    {"fluid", "plate3-blood", N_("Fluid: blood that a probe stirs"), N_("Fluid")},
    {"net", "plate2-tissue", N_("Net: a fold of tissue as a net of springs"), N_("Net")},
    {"instrument", "plate8-clamp", N_("Instrument: a clamp that holds a tube and lifts it"), N_("Instrument")},
    {"effect", "plate7-steam", N_("Effect: steam where tissue is coagulated"), N_("Effect")},
};

static void act_new_from(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *name = g_variant_get_string(parameter, NULL);
  for (gsize i = 0; i < G_N_ELEMENTS(templates); i++) {
    if (!g_str_equal(templates[i].name, name)) continue;
    g_autofree char *base = g_strconcat(templates[i].scene, ".spore", NULL);
    g_autofree char *file = g_build_filename(self->scenes, base, NULL);
    spore_window_open_copy(self, file);
    return;
  }
}

static GtkWidget *new_image(const char *name) {
  g_autofree char *path = g_strdup_printf("/org/spore/Editor/templates/%s.png", name);
  g_autoptr(GdkPixbuf) pixels = gdk_pixbuf_new_from_resource(path, NULL);
  if (!pixels) return gtk_image_new();
  cairo_surface_t *surface = gdk_cairo_surface_create_from_pixbuf(pixels, PICTURE_DENSITY, NULL);
  GtkWidget *image = gtk_image_new_from_surface(surface);
  cairo_surface_destroy(surface);
  return image;
}

static GtkWidget *new_button(const char *name, const char *label, const char *word) {
  GtkWidget *button = gtk_button_new(), *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4);
  gtk_container_add(GTK_CONTAINER(box), new_image(name));
  gtk_container_add(GTK_CONTAINER(box), gtk_label_new(word));
  gtk_container_add(GTK_CONTAINER(button), box);
  gtk_widget_set_tooltip_text(button, label);
  atk_object_set_name(gtk_widget_get_accessible(button), label);
  gtk_actionable_set_action_name(GTK_ACTIONABLE(button), "win.new-from");
  gtk_actionable_set_action_target(GTK_ACTIONABLE(button), "s", name);
  return button;
}

static GtkWidget *new_pictures(void) {
  GtkWidget *grid = gtk_grid_new();
  gtk_grid_set_row_spacing(GTK_GRID(grid), 8);
  gtk_grid_set_column_spacing(GTK_GRID(grid), 8);
  for (int i = 0; i < (int)G_N_ELEMENTS(templates); i++)
    gtk_grid_attach(GTK_GRID(grid), new_button(templates[i].name, _(templates[i].label), _(templates[i].word)),
                    i % COLUMNS, i / COLUMNS, 1, 1);
  gtk_widget_show_all(grid);
  return grid;
}

void spore_window_fill_template_menu(SporeWindow *self) {
  for (gsize i = 0; i < G_N_ELEMENTS(templates); i++) {
    g_autoptr(GMenuItem) item = g_menu_item_new(_(templates[i].label), NULL);
    g_menu_item_set_action_and_target(item, "win.new-from", "s", templates[i].name);
    g_menu_append_item(self->templates, item);
  }
  spore_viewport_set_templates(SPORE_VIEWPORT(self->viewport), G_MENU_MODEL(self->templates), new_pictures());
}

void spore_window_add_template_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"new-from", act_new_from, "s"}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
