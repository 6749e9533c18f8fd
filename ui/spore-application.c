/* The program: its schema, its keys, and its windows. */
#include "ui/spore-application.h"

#include <glib/gi18n.h>

#include "core/author/generator.h"
#include "core/io/scene_xml.h"
#include "models/registry.h"
#include "ui/jobs/under-way.h"
#include "ui/dialogs/spore-preferences-dialog.h"
#include "ui/spore-look.h"
#include "ui/spore-preferences.h"
#include "ui/spore-window.h"

struct _SporeApplication {
  GtkApplication parent;
  SporeSchema *schema;
  SporeLook *look;
  char *version, *scenes;
  gboolean recovery_offered;
};

G_DEFINE_FINAL_TYPE(SporeApplication, spore_application, GTK_TYPE_APPLICATION)

static const struct {
  const char *action;
  const char *keys[3];
} accelerators[] = {
    {"win.open-dialog", {"<Control>o"}},
    {"win.save", {"<Control>s"}},
    {"win.save-as-dialog", {"<Control><Shift>s"}},
    {"win.import-dialog", {"<Control>i"}},
    {"win.new", {"<Control>n"}},
    {"win.undo", {"<Control>z"}},
    {"win.duplicate", {"<Control>d"}},
    {"win.redo", {"<Control><Shift>z", "<Control>y"}},
    {"win.play-pause", {"F5"}},
    {"win.present", {"F11"}},
    {"win.step", {"F6"}},
    {"win.reset", {"<Shift>F5"}},
    {"win.step-back", {"<Shift>F6"}},
    {"win.bookmark", {"<Control>b"}},
    {"win.apply-generated", {"<Control>Return"}},
    {"win.pick-places", {"<Control>e"}},
    {"win.filter", {"<Control>f"}},
    {"win.search", {"<Control>k"}},
    {"win.open-menu", {"F10"}},
    {"app.preferences", {"<Control>comma"}},
    {"win.turn-optic(10.0)", {"<Control>bracketright"}},
    {"win.turn-optic(-10.0)", {"<Control>bracketleft"}},
    {"win.wipe-lens", {"<Control>backslash"}},
    {"win.close", {"<Control>w"}},
    {"app.quit", {"<Control>q"}},
};

static void load_style(void) {
  g_autoptr(GtkCssProvider) provider = gtk_css_provider_new();
  gtk_css_provider_load_from_resource(provider, "/org/spore/Editor/style.css");
  gtk_style_context_add_provider_for_screen(gdk_screen_get_default(), GTK_STYLE_PROVIDER(provider),
                                            GTK_STYLE_PROVIDER_PRIORITY_APPLICATION);
}

static void about(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeApplication *self = data;
  GtkWindow *window = gtk_application_get_active_window(GTK_APPLICATION(self));
  g_autofree char *pictures = SPORE_IS_WINDOW(window) ? g_strdup_printf(_("Pictures are made by %s."),
                                                                        spore_window_get_renderer(SPORE_WINDOW(window)))
                                                      : g_strdup("");
  g_autofree char *comments = g_strconcat(
      _("Editor and real-time kernel for surgical simulation.\nFor training and preview only."), "\n", pictures, NULL);
  gtk_show_about_dialog(window, "program-name", "SPORE", "version", self->version, "comments", comments, "license-type",
                        GTK_LICENSE_GPL_3_0, "logo-icon-name", "org.spore.Editor", NULL);
}

static void quit(GSimpleAction *action, GVariant *parameter, gpointer data) {
  /* Each window may ask about unsaved changes; the program ends with the last one. */
  g_autoptr(GList) windows = g_list_copy(gtk_application_get_windows(GTK_APPLICATION(data)));
  for (GList *item = windows; item; item = item->next) gtk_window_close(GTK_WINDOW(item->data));
}

static void preferences(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeApplication *self = data;
  GtkWindow *window = gtk_application_get_active_window(GTK_APPLICATION(self));
  gtk_window_present(GTK_WINDOW(spore_preferences_dialog_new(window, GTK_APPLICATION(self))));
}

static SporeWindow *open_window(SporeApplication *self) {
  return spore_window_new(GTK_APPLICATION(self), self->schema, self->scenes);
}

static void new_window(GSimpleAction *action, GVariant *parameter, gpointer data) {
  gtk_window_present(GTK_WINDOW(open_window(data)));
}

static void spore_application_startup(GApplication *application) {
  static const GActionEntry actions[] = {
      {"about", about}, {"quit", quit}, {"new-window", new_window}, {"preferences", preferences}};
  SporeApplication *self = SPORE_APPLICATION(application);
  G_APPLICATION_CLASS(spore_application_parent_class)->startup(application);
  self->schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  spore_preferences_add(GTK_APPLICATION(self));
  self->look = spore_look_new(application);
  load_style();
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  for (gsize i = 0; i < G_N_ELEMENTS(accelerators); i++)
    gtk_application_set_accels_for_action(GTK_APPLICATION(self), accelerators[i].action, accelerators[i].keys);
}

static SporeWindow *add_window(SporeApplication *self) {
  SporeWindow *window = open_window(self);
  gtk_window_present(GTK_WINDOW(window));
  if (!self->recovery_offered) spore_window_offer_recovery(window);
  self->recovery_offered = TRUE;
  return window;
}

static void spore_application_activate(GApplication *application) {
  GtkWindow *window = gtk_application_get_active_window(GTK_APPLICATION(application));
  if (window) gtk_window_present(window);
  else add_window(SPORE_APPLICATION(application));
}

/* The active window where it shows nothing yet, else a new one. */
static SporeWindow *window_to_fill(SporeApplication *self) {
  GtkWindow *active = gtk_application_get_active_window(GTK_APPLICATION(self));
  return SPORE_IS_WINDOW(active) && spore_window_is_fresh(SPORE_WINDOW(active)) ? SPORE_WINDOW(active)
                                                                                : add_window(self);
}

/* Scenes are opened, each in a window of its own; all other files are imported together. */
static void spore_application_open(GApplication *application, GFile **files, int count, const char *hint) {
  SporeApplication *self = SPORE_APPLICATION(application);
  g_autoptr(GPtrArray) meshes = g_ptr_array_new_with_free_func(g_free);
  for (int i = 0; i < count; i++) {
    g_autofree char *path = g_file_get_path(files[i]);
    g_autofree char *uri = g_file_get_uri(files[i]);
    if (path && !spore_scene_is_name(path)) g_ptr_array_add(meshes, g_steal_pointer(&path));
    else spore_window_open(window_to_fill(self), path ? path : uri);
  }
  if (meshes->len == 0) return;
  GVariant *names = g_variant_new_strv((const char *const *)meshes->pdata, meshes->len);
  g_action_group_activate_action(G_ACTION_GROUP(window_to_fill(self)), "import-dialog-with", names);
}

/* Works that were cancelled end before the program does. */
static void spore_application_shutdown(GApplication *application) {
  g_clear_pointer(&SPORE_APPLICATION(application)->look, spore_look_free);
  G_APPLICATION_CLASS(spore_application_parent_class)->shutdown(application);
  spore_works_wait();
}

static void spore_application_finalize(GObject *object) {
  SporeApplication *self = SPORE_APPLICATION(object);
  if (self->schema) spore_schema_free(self->schema);
  g_free(self->version);
  g_free(self->scenes);
  G_OBJECT_CLASS(spore_application_parent_class)->finalize(object);
}

static void spore_application_class_init(SporeApplicationClass *class) {
  G_OBJECT_CLASS(class)->finalize = spore_application_finalize;
  G_APPLICATION_CLASS(class)->startup = spore_application_startup;
  G_APPLICATION_CLASS(class)->activate = spore_application_activate;
  G_APPLICATION_CLASS(class)->open = spore_application_open;
  G_APPLICATION_CLASS(class)->shutdown = spore_application_shutdown;
}

static void spore_application_init(SporeApplication *self) {}

SporeApplication *spore_application_new(const char *version, const char *scenes) {
  SporeApplication *self = g_object_new(SPORE_TYPE_APPLICATION, "application-id", "org.spore.Editor", "flags",
                                        G_APPLICATION_HANDLES_OPEN, "resource-base-path", "/org/spore/Editor", NULL);
  self->version = g_strdup(version);
  self->scenes = g_strdup(scenes);
  return self;
}
