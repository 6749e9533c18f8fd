/* Links: which kind is made by picking, and which one is tied elsewhere. */
#include "core/author/link_edits.h"
#include "ui/spore-window-private.h"

#include <glib/gi18n.h>

static const SporePickKind link_pick = {
    .count = spore_link_end_count,
    .doc = spore_link_end_doc,
    .add = spore_edit_add_link,
    .tie = spore_edit_tie_link,
    .first = N_("%s, click %u of %u: %s Escape ends"),
    .later = N_("%s, click %u of %u: %s Beside the bodies is the scene; Escape goes back"),
};

static void act_add_link(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeDocument *document = spore_editor_document_get(self->document);
  const char *element = g_variant_get_string(parameter, NULL);
  const SporeObjectType *section = spore_object_type(spore_document_section(document, "links"));
  const SporeObjectType *type = spore_object_type_child(section, element);
  g_autoptr(GError) error = NULL;
  if (type) spore_window_begin_pick(self, (SporePickDraft){.kind = &link_pick, .type = type});
  else if (!spore_edit_add_link(document, element, NULL, 0, &error)) spore_window_failed(self, error);
}

static void act_tie_link(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *link = spore_editor_document_selected(self->document);
  if (!spore_link_is(link)) return;
  spore_window_begin_pick(
      self, (SporePickDraft){.kind = &link_pick, .type = spore_object_type(link), .object = spore_object_id(link)});
}

void spore_window_fill_link_menu(SporeWindow *self) {
  const SporeObjectType *links = spore_object_type_child(spore_schema_root(self->schema), "links");
  for (guint i = 0; i < links->children->len; i++) {
    const SporeObjectType *type = links->children->pdata[i];
    g_autoptr(GMenuItem) item = g_menu_item_new(_(type->label), NULL);
    g_menu_item_set_action_and_target(item, "win.add-link", "s", type->element);
    g_menu_append_item(self->link_kinds, item);
  }
  spore_viewport_set_link_menu(SPORE_VIEWPORT(self->viewport), G_MENU_MODEL(self->link_kinds));
}

void spore_window_add_link_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"add-link", act_add_link, "s"}, {"tie-link", act_tie_link}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
