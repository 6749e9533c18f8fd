/* Instruments: those of the library, placed by two clicks in the view; and which one is led. */
#include "core/author/instrument_edits.h"
#include "ui/document/hands.h"
#include "ui/spore-window-private.h"

#include <glib/gi18n.h>

/* A click says where it enters, the next one what it points at; what is not clicked on is chosen by the library. */
static SporeInstrumentPlaces places_of(const SporeVec3 *places, guint count) {
  return (SporeInstrumentPlaces){count > 0 ? &places[0] : NULL, count > 1 ? &places[1] : NULL};
}

static guint count(const SporeObjectType *type) { return 2; }

static const char *doc(const SporeObjectType *type, guint end) {
  return end ? _("what it points at.") : _("where it enters, on the body or beside it.");
}

static SporeObject *add(SporeDocument *document, const char *name, const SporeLinkEnd *ends, guint clicks,
                        GError **error) {
  SporeVec3 places[SPORE_LINK_MOST_ENDS];
  for (guint i = 0; i < clicks; i++) places[i] = ends[i].place;
  return spore_edit_add_instrument(document, spore_instrument_find(name), NULL, places_of(places, clicks), error);
}

static guint outline(SporeDocument *document, const char *name, const SporeVec3 *places, guint clicks,
                     SporeVec3 *points) {
  return spore_instrument_outline(document, spore_instrument_find(name), places_of(places, clicks), points);
}

/* It is led at once. Where nobody pointed into the view, the view goes to where it stands. */
static void added(SporeWindow *self, guint clicks) {
  g_action_group_activate_action(G_ACTION_GROUP(self), "tool", g_variant_new_string("probe"));
  if (!clicks) spore_viewport_frame_soon(SPORE_VIEWPORT(self->viewport));
}

static const SporePickKind instrument_pick = {
    .count = count,
    .doc = doc,
    .add = add,
    .outline = outline,
    .added = added,
    .first = N_("%s, click %u of %u: %s Enter finds its place; Escape ends"),
    .later = N_("%s, click %u of %u: %s Enter points it at the nearest organ; Escape goes back"),
    .anywhere = TRUE,
};

static void act_add_instrument(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeInstrumentKind *kind = spore_instrument_find(g_variant_get_string(parameter, NULL));
  const SporeObjectType *tools = spore_object_type_child(spore_schema_root(self->schema), "tools");
  if (!kind) return;
  spore_window_begin_pick(self, (SporePickDraft){.kind = &instrument_pick,
                                                 .type = spore_object_type_child(tools, kind->tool),
                                                 .name = kind->name,
                                                 .label = kind->label});
}

void spore_window_fill_instrument_menu(SporeWindow *self) {
  for (const SporeInstrumentKind *kind = spore_instruments; kind->name; kind++) {
    /* Translators: an instrument and what it does: "Suction: draws fluid away" */
    g_autofree char *label = g_strdup_printf(_("%s: %s"), _(kind->label), _(kind->purpose));
    g_autoptr(GMenuItem) item = g_menu_item_new(label, NULL);
    g_menu_item_set_action_and_target(item, "win.add-instrument", "s", kind->name);
    g_menu_append_item(self->instrument_kinds, item);
  }
  spore_viewport_set_instrument_menu(SPORE_VIEWPORT(self->viewport), G_MENU_MODEL(self->instrument_kinds),
                                     G_MENU_MODEL(self->hands));
}

/* Leading. */

/* To lead an instrument is to select it. */
static void change_led(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body =
      spore_document_find(spore_editor_document_get(self->document), "body", g_variant_get_string(state, NULL));
  if (body) spore_editor_document_select(self->document, spore_object_id(body));
}

/* Whoever leads none yet begins with the one that is proposed. */
static void act_lead_next(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GVariant) tool = g_action_group_get_action_state(G_ACTION_GROUP(self), "tool");
  if (g_str_equal(g_variant_get_string(tool, NULL), "probe")) spore_viewport_lead_next(SPORE_VIEWPORT(self->viewport));
  else g_action_group_change_action_state(G_ACTION_GROUP(self), "tool", g_variant_new_string("probe"));
}

void spore_window_show_hands(SporeWindow *self) {
  g_autoptr(GPtrArray) hands = spore_hands(spore_editor_document_get(self->document));
  const SporeObject *led = spore_viewport_get_led(SPORE_VIEWPORT(self->viewport));
  GAction *action = g_action_map_lookup_action(G_ACTION_MAP(self), "lead");
  g_menu_remove_all(self->hands);
  for (guint i = 0; i < hands->len; i++) {
    const char *name = spore_object_name(hands->pdata[i]);
    g_auto(GStrv) parts = g_strsplit(name, "_", -1);
    g_autofree char *label = g_strjoinv("__", parts); /* one would mark a key */
    g_autoptr(GMenuItem) item = g_menu_item_new(label, NULL);
    g_menu_item_set_action_and_target(item, "win.lead", "s", name);
    g_menu_append_item(self->hands, item);
  }
  g_simple_action_set_state(G_SIMPLE_ACTION(action), g_variant_new_string(led ? spore_object_name(led) : ""));
  spore_window_show_hint(self);
}

void spore_window_add_instrument_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"add-instrument", act_add_instrument, "s"}, {"lead", NULL, "s", "''", change_led}, {"lead-next", act_lead_next}};
  self->hands = g_menu_new();
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
