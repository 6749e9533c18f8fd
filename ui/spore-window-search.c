/* The search for all that the window and the program can do: what is in menus, and what is behind buttons and keys; and
 * the menu itself. */
#include <glib/gi18n.h>

#include "ui/dialogs/spore-search.h"
#include "ui/spore-window-private.h"

/* Commands that are in no menu of the window: buttons and keys. */
static const struct {
  const char *action; /* detailed */
  const char *label;  /* translatable */
} unlisted[] = {
    {"win.open-dialog", N_("Open a scene…")},
    {"win.save", N_("Save")},
    {"win.close", N_("Close the window")},
    {"app.new-window", N_("New window")},
    {"app.look::system", N_("Windows: as the system has it")},
    {"app.look::light", N_("Light windows")},
    {"app.look::dark", N_("Dark windows")},
    {"app.reset-preferences", N_("Preferences: reset all")},
    {"win.fix", N_("Fix the selected problem")},
    {"win.fix-said", N_("Fix what the message tells of")},
    {"win.close-message", N_("Close the message over the view")},
    {"win.undo", N_("Undo")},
    {"win.redo", N_("Redo")},
    {"win.play-pause", N_("Play or pause")},
    {"win.play", N_("Play")},
    {"win.pause", N_("Pause")},
    {"win.step", N_("One step")},
    {"win.reset", N_("Back to the start")},
    {"win.step-back", N_("One step back")},
    {"win.replay", N_("Play the run again")},
    {"win.stay", N_("Stop on the way to another time of the run")},
    {"win.bookmark", N_("Keep this time of the run")},
    {"win.tool::select", N_("Tool: select")},
    {"win.tool::probe", N_("Tool: lead an instrument")},
    {"win.lead-next", N_("Lead the next instrument")},
    {"win.tool::edit", N_("Tool: edit by hand")},
    {"win.show-surfaces", N_("Show or hide surfaces")},
    {"win.show-spheres", N_("Show or hide collision spheres")},
    {"win.show-tetrahedra", N_("Show or hide tetrahedra")},
    {"win.show-contacts", N_("Show or hide contact forces")},
    {"win.show-links", N_("Show or hide links")},
    {"win.box-select", N_("Select with a box")},
    {"win.view::back", N_("From behind")},
    {"win.view::left", N_("From the left")},
    {"win.view::bottom", N_("From below")},
    {"win.colours::none", N_("Colours: their own")},
    {"win.colours::strain", N_("Colours: strain")},
    {"win.colours::stress", N_("Colours: stress")},
    {"win.colours::velocity", N_("Colours: velocity")},
    {"win.colours::level", N_("Colours: level of detail")},
    {"win.colours::cells", N_("Colours: shape of cells")},
    {"win.keep-scale", N_("Colours: keep this scale, or let it follow the state")},
    {"win.show-reach", N_("Show or hide what instruments reach through their ports")},
    {"win.show-figures", N_("Show or hide what a step costs")},
    {"win.lock", N_("Lock or unlock what is selected")},
    {"win.unlock-all", N_("Unlock all")},
    {"win.clear-measures", N_("Remove all measures")},
    {"win.cut::none", N_("Look inside: nothing is hidden")},
    {"win.cut::view", N_("Look inside: plane before the eye")},
    {"win.cut::x", N_("Look inside: plane across X")},
    {"win.cut::y", N_("Look inside: plane across Y")},
    {"win.cut::z", N_("Look inside: plane across Z")},
    {"win.cut-other-side", N_("Look inside: hide the other side")},
    {"win.open-menu", N_("Open the menu")},
    {"win.patient::supine", N_("Patient: on the back (supine)")},
    {"win.patient::prone", N_("Patient: on the belly (prone)")},
    {"win.patient::left_lateral", N_("Patient: on the left side")},
    {"win.patient::right_lateral", N_("Patient: on the right side")},
    {"win.patient::trendelenburg", N_("Patient: head down (Trendelenburg)")},
    {"win.patient::reverse_trendelenburg", N_("Patient: head up (reverse Trendelenburg)")},
    {"win.patient::upright", N_("Patient: upright")},
    {"win.delete-alone", N_("Delete, and keep its meshes and steps of the exercise")},
    {"win.keep-along", N_("Keep what went along with what was deleted last")},
    {"win.new-folder", N_("Put what is selected into a new folder of the outliner")},
    {"win.put-in-folder::", N_("Take what is selected out of its folder of the outliner")},
    {"win.rename-row", N_("Rename the row of the outliner")},
    {"win.move-row(-1)", N_("Outliner: move up in the list")},
    {"win.move-row(1)", N_("Outliner: move down in the list")},
    {"win.filter", N_("Filter the outliner")},
    {"win.preview-spheres(uint32 0)", N_("Generate spheres")},
    {"win.preview-tetrahedra(uint32 0)", N_("Generate tetrahedra")},
    {"win.preview-curve(uint32 0)", N_("Generate a middle line")},
    {"win.preview-sheet(uint32 0)", N_("Generate a sheet")},
    {"win.preview-surface(uint32 0)", N_("Generate a surface of fewer triangles")},
    {"win.make-labels", N_("Mesh the chosen labels")},
    {"win.pick-places", N_("Pick the ends of a middle line or the corners of a sheet, or no more")},
    {"win.automatic-places", N_("Find the ends of a middle line automatically")},
    {"win.apply-generated", N_("Apply the preview")},
    {"win.cancel-job", N_("Cancel what is being worked on")},
    {"win.pick-back", N_("Picking: one click back")},
    {"win.pick-done", N_("Picking: the rest by itself")},
    {"win.lay-picture-dialog", N_("Lay a picture over the organ…")},
    {"win.measure-mapping", N_("Measure how the surface follows the mesh")},
    {"win.measure-accuracy", N_("Measure the accuracy")},
    {"win.apply-point", N_("Apply the chosen point of the accuracy")},
    {"win.forget-points", N_("Forget the watched points")},
    {"win.save-numbers-dialog", N_("Save the numbers of the plots…")},
    {"win.save-plot-dialog", N_("Save the plot…")},
    {"win.save-plan-dialog", N_("Save the plan…")},
    {"win.save-study-dialog::.html", N_("Save the accuracy as a page…")},
    {"win.save-study-dialog::.csv", N_("Save the accuracy as a table…")},
    {"win.save-study-dialog::.svg", N_("Save the accuracy as a plot…")},
    {"win.aim-step", N_("Exercise: aim the step elsewhere")},
    {"win.skip-to-step", N_("Exercise: run to the step")},
    {"win.move-part(-1)", N_("Exercise: move the step or metric up")},
    {"win.move-part(1)", N_("Exercise: move the step or metric down")},
    {"win.remove-part", N_("Exercise: remove the step or metric")},
    {"win.save-exercise-dialog::.html", N_("Exercise: save the report as a page…")},
    {"win.save-exercise-dialog::.csv", N_("Exercise: save the report as a table…")},
    {"win.save-exercise-dialog::.json", N_("Exercise: save the report as an object…")},
};

/* What the view does by a key alone is found with that key, too. */
static char *keys_of(SporeWindow *self, const char *detailed) {
  g_auto(GStrv) keys = gtk_application_get_accels_for_action(gtk_window_get_application(GTK_WINDOW(self)), detailed);
  guint key = 0;
  GdkModifierType modifiers = 0;
  if (keys[0]) gtk_accelerator_parse(keys[0], &key, &modifiers);
  else key = spore_viewport_key_of(detailed);
  return key ? gtk_accelerator_get_label(key, modifiers) : NULL;
}

/* heading: of the menu that the command is in, translated; NULL: none. */
static void add_command(SporeWindow *self, GPtrArray *commands, const char *detailed, const char *heading,
                        const char *label) {
  g_autofree char *action = NULL;
  g_autoptr(GVariant) target = NULL;
  if (!g_action_parse_detailed_name(detailed, &action, &target, NULL)) return;
  SporeSearchHit *command = g_new0(SporeSearchHit, 1);
  command->action = g_strdup(detailed);
  command->label = heading ? g_strdup_printf(_("%s: %s"), heading, label) : g_strdup(label);
  command->keys = keys_of(self, detailed);
  command->missing = g_str_has_prefix(action, "win.") ? spore_window_missing(self, action + strlen("win.")) : NULL;
  g_ptr_array_add(commands, command);
}

/* Labels of menus mark keys by underscores, and double those that they show. */
static char *plain(const char *label) {
  g_auto(GStrv) parts = g_strsplit(label, "__", -1);
  for (char **part = parts; *part; part++) {
    g_auto(GStrv) pieces = g_strsplit(*part, "_", -1);
    g_free(*part);
    *part = g_strjoinv("", pieces);
  }
  return g_strjoinv("_", parts);
}

static void add_menu(SporeWindow *self, GPtrArray *commands, GMenuModel *menu, const char *heading) {
  for (int i = 0; i < g_menu_model_get_n_items(menu); i++) {
    g_autofree char *marked = NULL, *action = NULL;
    g_autoptr(GMenuModel) section = g_menu_model_get_item_link(menu, i, G_MENU_LINK_SECTION);
    g_autoptr(GMenuModel) submenu = g_menu_model_get_item_link(menu, i, G_MENU_LINK_SUBMENU);
    g_menu_model_get_item_attribute(menu, i, G_MENU_ATTRIBUTE_LABEL, "s", &marked);
    g_menu_model_get_item_attribute(menu, i, G_MENU_ATTRIBUTE_ACTION, "s", &action);
    g_autofree char *label = marked ? plain(marked) : NULL;
    g_autoptr(GVariant) target = g_menu_model_get_item_attribute_value(menu, i, G_MENU_ATTRIBUTE_TARGET, NULL);
    g_autofree char *detailed = action ? g_action_print_detailed_name(action, target) : NULL;
    if (section) add_menu(self, commands, section, heading);
    if (submenu) add_menu(self, commands, submenu, label);
    if (detailed && label) add_command(self, commands, detailed, heading, label);
  }
}

static void command_free(gpointer data) {
  SporeSearchHit *command = data;
  g_free(command->action);
  g_free(command->label);
  g_free(command->keys);
  g_free(command);
}

static gboolean has(const GPtrArray *commands, const char *action) {
  for (guint i = 0; i < commands->len; i++) {
    const SporeSearchHit *hit = commands->pdata[i];
    if (g_str_equal(hit->action, action)) return TRUE;
  }
  return FALSE;
}

/* What has no label yet is found by the name of its action. */
static void add_rest(SporeWindow *self, GPtrArray *commands, GActionGroup *group, const char *prefix) {
  g_auto(GStrv) names = g_action_group_list_actions(group);
  for (char **name = names; *name; name++) {
    g_autofree char *action = g_strconcat(prefix, *name, NULL);
    if (!g_action_group_get_action_parameter_type(group, *name) && !has(commands, action))
      add_command(self, commands, action, NULL, action);
  }
}

static GPtrArray *commands_of(SporeWindow *self) {
  GPtrArray *commands = g_ptr_array_new_with_free_func(command_free);
  for (gsize i = 0; i < G_N_ELEMENTS(unlisted); i++)
    add_command(self, commands, unlisted[i].action, NULL, _(unlisted[i].label));
  add_menu(self, commands, G_MENU_MODEL(self->menu), NULL);
  add_menu(self, commands, G_MENU_MODEL(self->speeds), _("Speed"));
  add_menu(self, commands, G_MENU_MODEL(self->all_tabs), _("Tab"));
  add_menu(self, commands, G_MENU_MODEL(self->hands), _("Lead"));
  add_menu(self, commands, spore_exercise_panel_get_step_menu(SPORE_EXERCISE_PANEL(self->exercise)), _("Add step"));
  add_menu(self, commands, spore_exercise_panel_get_metric_menu(SPORE_EXERCISE_PANEL(self->exercise)), _("Add metric"));
  add_rest(self, commands, G_ACTION_GROUP(self), "win.");
  add_rest(self, commands, G_ACTION_GROUP(gtk_window_get_application(GTK_WINDOW(self))), "app.");
  return commands;
}

static void act_search(GSimpleAction *action, GVariant *parameter, gpointer data) {
  gtk_widget_show_all(spore_search_new(data, commands_of(data)));
}

static void act_open_menu(GSimpleAction *action, GVariant *parameter, gpointer data) {
  gtk_toggle_button_set_active(GTK_TOGGLE_BUTTON(((SporeWindow *)data)->menu_button), TRUE);
}

void spore_window_add_search_action(SporeWindow *self) {
  static const GActionEntry actions[] = {{"search", act_search}, {"open-menu", act_open_menu}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
