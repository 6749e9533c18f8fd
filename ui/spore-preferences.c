/* What a user chose for all scenes, as actions of the program. */
#include "ui/spore-preferences.h"

#include "ui/document/preferences.h"

static void chose(GSimpleAction *action, GVariant *value, gpointer data) {
  const SporePreference *preference = spore_preference_find(g_action_get_name(G_ACTION(action)));
  g_autoptr(GError) error = NULL;
  if (spore_preference_choice(preference, g_variant_get_string(value, NULL)) < 0) return;
  g_simple_action_set_state(action, value);
  if (spore_preference_set(preference, g_variant_get_string(value, NULL), &error)) return;
  GtkWindow *window = gtk_application_get_active_window(data);
  if (G_IS_ACTION_GROUP(window))
    g_action_group_activate_action(G_ACTION_GROUP(window), "report", g_variant_new_string(error->message));
}

static void reset(GSimpleAction *action, GVariant *parameter, gpointer data) {
  for (const SporePreference *preference = spore_preferences; preference->name; preference++)
    g_action_group_change_action_state(G_ACTION_GROUP(data), preference->name,
                                       g_variant_new_string(preference->choices[preference->preset].name));
}

void spore_preferences_add(GtkApplication *application) {
  static const GActionEntry entry = {.name = "reset-preferences", .activate = reset};
  for (const SporePreference *preference = spore_preferences; preference->name; preference++) {
    g_autoptr(GSimpleAction) action = g_simple_action_new_stateful(
        preference->name, G_VARIANT_TYPE_STRING, g_variant_new_string(spore_preference_get(preference)));
    g_signal_connect(action, "change-state", G_CALLBACK(chose), application);
    g_action_map_add_action(G_ACTION_MAP(application), G_ACTION(action));
  }
  g_action_map_add_action_entries(G_ACTION_MAP(application), &entry, 1, application);
}

char *spore_preferences_state(GtkApplication *application, const char *name) {
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(application), name);
  return g_variant_dup_string(state, NULL);
}
