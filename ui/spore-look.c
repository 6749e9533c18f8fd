/* Dark and light windows.
 *
 * GTK 3 knows of its own settings alone. Desktops tell what the user likes through the portal's settings
 * (org.freedesktop.appearance color-scheme: 1 dark, 2 light, 0 as it comes); where there is no portal, GTK's
 * settings stay as the system gave them. The view follows the theme that comes of it. */
#include "ui/spore-look.h"

#define PREFERENCE "look"
#define PORTAL "org.freedesktop.portal.Desktop"
#define PORTAL_PATH "/org/freedesktop/portal/desktop"
#define PORTAL_SETTINGS "org.freedesktop.portal.Settings"
#define SCHEME_SPACE "org.freedesktop.appearance"
#define SCHEME "color-scheme"
#define PREFER_DARK "gtk-application-prefer-dark-theme"

typedef enum Scheme { SCHEME_NONE, SCHEME_DARK, SCHEME_LIGHT } Scheme;

struct SporeLook {
  GApplication *application;
  GCancellable *cancel; /* of what is asked of the portal */
  GDBusProxy *portal;   /* NULL: there is none, or none yet */
  Scheme scheme;        /* of the system */
};

static void apply(SporeLook *look) {
  GtkSettings *settings = gtk_settings_get_default();
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(look->application), PREFERENCE);
  const char *name = g_variant_get_string(state, NULL);
  gboolean asked = !g_str_equal(name, "system");
  if (!asked && look->scheme == SCHEME_NONE) gtk_settings_reset_property(settings, PREFER_DARK);
  else g_object_set(settings, PREFER_DARK, asked ? g_str_equal(name, "dark") : look->scheme == SCHEME_DARK, NULL);
}

/* The portal. */

/* The value may be wrapped several times. */
static void take_scheme(SporeLook *look, GVariant *boxed) {
  g_autoptr(GVariant) value = g_variant_ref(boxed);
  while (g_variant_is_of_type(value, G_VARIANT_TYPE_VARIANT)) {
    GVariant *inner = g_variant_get_variant(value);
    g_variant_unref(value);
    value = inner;
  }
  if (!g_variant_is_of_type(value, G_VARIANT_TYPE_UINT32)) return;
  guint32 scheme = g_variant_get_uint32(value);
  look->scheme = scheme <= SCHEME_LIGHT ? (Scheme)scheme : SCHEME_NONE;
  apply(look);
}

static void portal_said(GDBusProxy *portal, const char *sender, const char *signal, GVariant *values, SporeLook *look) {
  const char *space, *key;
  g_autoptr(GVariant) value = NULL;
  if (!g_str_equal(signal, "SettingChanged") || !g_variant_is_of_type(values, G_VARIANT_TYPE("(ssv)"))) return;
  g_variant_get(values, "(&s&sv)", &space, &key, &value);
  if (g_str_equal(space, SCHEME_SPACE) && g_str_equal(key, SCHEME)) take_scheme(look, value);
}

static void scheme_read(GObject *portal, GAsyncResult *result, gpointer data) {
  g_autoptr(GVariant) answer = g_dbus_proxy_call_finish(G_DBUS_PROXY(portal), result, NULL);
  if (!answer || !g_variant_is_of_type(answer, G_VARIANT_TYPE("(v)"))) return; /* it has none, or we are leaving */
  g_autoptr(GVariant) value = g_variant_get_child_value(answer, 0);
  take_scheme(data, value);
}

static void portal_found(GObject *source, GAsyncResult *result, gpointer data) {
  GDBusProxy *portal = g_dbus_proxy_new_finish(result, NULL);
  if (!portal) return;
  SporeLook *look = data;
  look->portal = portal;
  g_signal_connect(portal, "g-signal", G_CALLBACK(portal_said), look);
  g_dbus_proxy_call(portal, "Read", g_variant_new("(ss)", SCHEME_SPACE, SCHEME), G_DBUS_CALL_FLAGS_NONE, -1,
                    look->cancel, scheme_read, look);
}

SporeLook *spore_look_new(GApplication *application) {
  SporeLook *look = g_new0(SporeLook, 1);
  look->application = application;
  look->cancel = g_cancellable_new();
  g_signal_connect_swapped(application, "action-state-changed::" PREFERENCE, G_CALLBACK(apply), look);
  apply(look);
  GDBusConnection *bus = g_application_get_dbus_connection(application);
  if (bus)
    g_dbus_proxy_new(bus, G_DBUS_PROXY_FLAGS_DO_NOT_LOAD_PROPERTIES, NULL, PORTAL, PORTAL_PATH, PORTAL_SETTINGS,
                     look->cancel, portal_found, look);
  return look;
}

void spore_look_free(SporeLook *look) {
  g_cancellable_cancel(look->cancel);
  if (look->portal) g_signal_handlers_disconnect_by_data(look->portal, look);
  g_signal_handlers_disconnect_by_data(look->application, look);
  g_clear_object(&look->portal);
  g_object_unref(look->cancel);
  g_free(look);
}
