/* Fluids of the library, put where a click says. */
#include "core/author/fluid_edits.h"
#include "ui/spore-window-private.h"

#include <glib/gi18n.h>

static guint count(const SporeObjectType *type) { return 1; }

static const char *doc_of_organ(const SporeObjectType *type, guint end) { return _("a place on the organ."); }

static const char *doc_of_heater(const SporeObjectType *type, guint end) {
  return _("the bipolar instrument, or beside it.");
}

static const char *doc_of_tube(const SporeObjectType *type, guint end) { return _("the suction tube, or beside it."); }

static SporeObject *add_to_organ(SporeDocument *document, const char *name, const SporeLinkEnd *ends, guint clicks,
                                 GError **error) {
  const SporeFluidKind *kind = spore_fluid_find(name);
  if (clicks && ends[0].body) return spore_edit_add_fluid(document, kind, NULL, ends[0].body, ends[0].place, error);
  spore_error_raise(error, SPORE_ERROR_INPUT, _(kind->label), "%s", _("there is no organ here; click on one"));
  return NULL;
}

static SporeObject *add_to_tool(SporeDocument *document, const char *name, const SporeLinkEnd *ends, guint clicks,
                                GError **error) {
  SporeVec3 place = clicks ? ends[0].place : (SporeVec3){0, 0, 0};
  return spore_edit_add_fluid(document, spore_fluid_find(name), NULL, NULL, place, error);
}

static const SporePickKind organ_pick = {
    .count = count,
    .doc = doc_of_organ,
    .add = add_to_organ,
    .first = N_("%s, click %u of %u: %s Escape ends"),
};

static const SporePickKind heater_pick = {
    .count = count,
    .doc = doc_of_heater,
    .add = add_to_tool,
    .first = N_("%s, click %u of %u: %s Enter takes the first; Escape ends"),
    .anywhere = TRUE,
};

static const SporePickKind tube_pick = {
    .count = count,
    .doc = doc_of_tube,
    .add = add_to_tool,
    .first = N_("%s, click %u of %u: %s Enter takes the first; Escape ends"),
    .anywhere = TRUE,
};

static const SporePickKind *pick_of(SporeFluidMouth mouth) {
  if (mouth == SPORE_MOUTH_TUBE) return &tube_pick;
  return mouth == SPORE_MOUTH_HEATER ? &heater_pick : &organ_pick;
}

static void act_add_fluid(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeFluidKind *kind = spore_fluid_find(g_variant_get_string(parameter, NULL));
  const SporeObjectType *effects = spore_object_type_child(spore_schema_root(self->schema), "effects");
  if (!kind) return;
  spore_window_begin_pick(self, (SporePickDraft){.kind = pick_of(kind->mouth),
                                                 .type = spore_object_type_child(effects, "emitter"),
                                                 .name = kind->name,
                                                 .label = kind->label});
}

void spore_window_fill_fluid_menu(SporeWindow *self) {
  for (const SporeFluidKind *kind = spore_fluids; kind->name; kind++) {
    g_autofree char *label = g_strdup_printf(_("%s: %s"), _(kind->label), _(kind->purpose));
    g_autoptr(GMenuItem) item = g_menu_item_new(label, NULL);
    g_menu_item_set_action_and_target(item, "win.add-fluid", "s", kind->name);
    g_menu_append_item(self->fluid_kinds, item);
  }
  spore_viewport_set_fluid_menu(SPORE_VIEWPORT(self->viewport), G_MENU_MODEL(self->fluid_kinds));
}

void spore_window_add_fluid_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"add-fluid", act_add_fluid, "s"}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
