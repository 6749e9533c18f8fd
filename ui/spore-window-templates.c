/* Whole scenes to begin with: those that ship, each as a scene without a file. */
#include <glib/gi18n.h>

#include "ui/spore-window-private.h"

static const struct {
  const char *name, *scene; /* scene: its file, without its suffix */
  const char *label;        /* translatable */
} templates[] = {
    {"organ", "plate4-deformed-ovary", N_("Organ: a soft ovary that a probe pushes")},
    {"thread", "plate5-string", N_("Thread: a string in coils that touches itself")},
    {"fluid", "plate3-blood", N_("Fluid: blood that a probe stirs")},
    {"net", "plate2-tissue", N_("Net: a fold of tissue as a net of springs")},
    {"instrument", "plate8-clamp", N_("Instrument: a clamp that holds a tube and lifts it")},
    {"effect", "plate7-steam", N_("Effect: steam where tissue is coagulated")},
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

void spore_window_fill_template_menu(SporeWindow *self) {
  for (gsize i = 0; i < G_N_ELEMENTS(templates); i++) {
    g_autoptr(GMenuItem) item = g_menu_item_new(_(templates[i].label), NULL);
    g_menu_item_set_action_and_target(item, "win.new-from", "s", templates[i].name);
    g_menu_append_item(self->templates, item);
  }
  spore_viewport_set_template_menu(SPORE_VIEWPORT(self->viewport), G_MENU_MODEL(self->templates));
}

void spore_window_add_template_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"new-from", act_new_from, "s"}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
