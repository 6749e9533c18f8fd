/* Links made by picking: which kind, then a click for each of its ends; and tying a link elsewhere in the same way. */
#include <glib/gi18n.h>

#include "core/author/link_edits.h"
#include "ui/spore-window-private.h"

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

static void show_draft(SporeWindow *self) {
  SporeVec3 places[SPORE_LINK_MOST_ENDS];
  SporeLinkDraft *draft = &self->draft;
  for (guint i = 0; i < draft->count; i++) places[i] = draft->places[i];
  spore_viewport_set_anchors(SPORE_VIEWPORT(self->viewport), places, draft->count);
  spore_window_show_hint(self);
}

void spore_window_end_link(SporeWindow *self) {
  if (!self->draft.type) return;
  self->draft = (SporeLinkDraft){0};
  spore_viewport_set_picking(SPORE_VIEWPORT(self->viewport), FALSE);
  show_draft(self);
}

/* link: the one that is tied elsewhere, or 0. */
static void begin(SporeWindow *self, const SporeObjectType *type, guint32 link) {
  if (!spore_window_may_edit(self)) return;
  g_action_group_change_action_state(G_ACTION_GROUP(self), "pick-places", g_variant_new_boolean(FALSE));
  self->draft = (SporeLinkDraft){.type = type, .link = link};
  spore_viewport_set_picking(SPORE_VIEWPORT(self->viewport), TRUE);
  show_draft(self);
}

static void act_add_link(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *element = g_variant_get_string(parameter, NULL);
  const SporeObjectType *links = spore_object_type(spore_document_section(document_of(self), "links"));
  const SporeObjectType *type = spore_object_type_child(links, element);
  g_autoptr(GError) error = NULL;
  if (type) begin(self, type, 0);
  else if (!spore_edit_add_link(document_of(self), element, NULL, 0, &error)) spore_window_failed(self, error);
}

static void act_tie_link(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *link = spore_editor_document_selected(self->document);
  if (spore_link_is(link)) begin(self, spore_object_type(link), spore_object_id(link));
}

/* Bodies may have gone since they were clicked on. FALSE: one has. */
static gboolean find_bodies(SporeWindow *self, SporeLinkEnd *ends) {
  const SporeLinkDraft *draft = &self->draft;
  for (guint i = 0; i < draft->count; i++) {
    ends[i] = (SporeLinkEnd){spore_document_by_id(document_of(self), draft->bodies[i]), draft->places[i]};
    if (draft->bodies[i] && !ends[i].body) return FALSE;
  }
  return TRUE;
}

/* Makes the link of what is picked; what is not is the scene. */
static void finish(SporeWindow *self) {
  SporeLinkEnd ends[SPORE_LINK_MOST_ENDS];
  SporeLinkDraft draft = self->draft;
  SporeObject *link = draft.link ? spore_document_by_id(document_of(self), draft.link) : NULL;
  g_autoptr(GError) error = NULL;
  if (!find_bodies(self, ends) || (draft.link && !link)) {
    spore_window_complain(self, _("What was to be linked is gone meanwhile; begin again"));
    spore_window_end_link(self);
    return;
  }
  if (!link) link = spore_edit_add_link(document_of(self), draft.type->element, ends, draft.count, &error);
  else if (!spore_edit_tie_link(document_of(self), link, ends, draft.count, &error)) link = NULL;
  if (spore_window_failed(self, error)) {
    if (self->draft.count) self->draft.count--; /* another click may mend it */
    show_draft(self);
    return;
  }
  spore_window_end_link(self);
  spore_editor_document_select(self->document, spore_object_id(link));
}

static void picked(SporeWindow *self, guint body, const SporeVec3 *place) {
  SporeLinkDraft *draft = &self->draft;
  if (!draft->type || !spore_window_may_edit(self)) return;
  draft->bodies[draft->count] = body;
  draft->places[draft->count++] = *place;
  if (!body && draft->count == 1) finish(self); /* which says what is wrong with it */
  else if (draft->count == spore_link_end_count(draft->type)) finish(self);
  else show_draft(self);
}

static void act_pick_done(GSimpleAction *action, GVariant *parameter, gpointer data) {
  if (((SporeWindow *)data)->draft.type) finish(data);
}

/* One click back, or no more picking. */
static void act_pick_back(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (!self->draft.type) {
    g_action_group_change_action_state(G_ACTION_GROUP(self), "pick-places", g_variant_new_boolean(FALSE));
  } else if (self->draft.count) {
    self->draft.count--;
    show_draft(self);
  } else {
    spore_window_end_link(self);
  }
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
  static const GActionEntry actions[] = {
      {"add-link", act_add_link, "s"},
      {"tie-link", act_tie_link},
      {"pick-back", act_pick_back},
      {"pick-done", act_pick_done},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  g_signal_connect_object(self->viewport, "picked", G_CALLBACK(picked), self, G_CONNECT_SWAPPED);
}
