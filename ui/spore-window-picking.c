/* What is made by picking: a click for each of its ends; and giving it other ends in the same way. */
#include <glib/gi18n.h>

#include "ui/spore-window-private.h"

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

static void show_draft(SporeWindow *self) {
  SporeVec3 places[SPORE_LINK_MOST_ENDS];
  SporePickDraft *draft = &self->draft;
  for (guint i = 0; i < draft->count; i++) places[i] = draft->places[i];
  spore_viewport_set_anchors(SPORE_VIEWPORT(self->viewport), places, draft->count);
  spore_window_update_actions(self);
  spore_window_show_hint(self);
}

void spore_window_end_pick(SporeWindow *self) {
  if (!self->draft.type) return;
  spore_window_mend(self, SPORE_CAUSE_PICK);
  self->draft = (SporePickDraft){0};
  spore_viewport_set_picking(SPORE_VIEWPORT(self->viewport), FALSE);
  show_draft(self);
}

void spore_window_stop_picking(SporeWindow *self) {
  spore_window_end_pick(self);
  if (spore_window_is_picking(self))
    g_action_group_change_action_state(G_ACTION_GROUP(self), "pick-places", g_variant_new_boolean(FALSE));
}

void spore_window_begin_pick(SporeWindow *self, SporePickDraft draft) {
  if (!spore_window_may_edit(self)) return;
  spore_window_stop_picking(self);
  self->draft = draft;
  if (!draft.name) self->draft.name = draft.type->element;
  if (!draft.label) self->draft.label = draft.type->label;
  spore_viewport_set_picking(SPORE_VIEWPORT(self->viewport), TRUE);
  show_draft(self);
}

/* Bodies may have gone since they were clicked on. FALSE: one has. */
static gboolean find_bodies(SporeWindow *self, SporeLinkEnd *ends) {
  const SporePickDraft *draft = &self->draft;
  for (guint i = 0; i < draft->count; i++) {
    ends[i] = (SporeLinkEnd){spore_document_by_id(document_of(self), draft->bodies[i]), draft->places[i]};
    if (draft->bodies[i] && !ends[i].body) return FALSE;
  }
  return TRUE;
}

/* Makes the object of what is picked. */
static void finish(SporeWindow *self) {
  SporeLinkEnd ends[SPORE_LINK_MOST_ENDS];
  SporePickDraft draft = self->draft;
  SporeObject *object = draft.object ? spore_document_by_id(document_of(self), draft.object) : NULL;
  g_autoptr(GError) error = NULL;
  if (!find_bodies(self, ends) || (draft.object && !object)) {
    spore_window_complain(self, _("What was picked is gone meanwhile; begin again"));
    spore_window_end_pick(self);
    return;
  }
  if (!object) object = draft.kind->add(document_of(self), draft.name, ends, draft.count, &error);
  else if (!draft.kind->tie(document_of(self), object, ends, draft.count, &error)) object = NULL;
  if (error) {
    spore_window_complain_while(self, SPORE_CAUSE_PICK, error->message, NULL, NULL);
    if (self->draft.count) self->draft.count--; /* another click may mend it */
    show_draft(self);
    return;
  }
  spore_window_end_pick(self);
  spore_editor_document_select(self->document, spore_object_id(object));
  if (draft.kind->added) draft.kind->added(self, draft.count);
}

static void picked(SporeWindow *self, guint body, const SporeVec3 *place) {
  SporePickDraft *draft = &self->draft;
  if (!draft->type || !spore_window_may_edit(self)) return;
  spore_window_mend(self, SPORE_CAUSE_PICK);
  draft->bodies[draft->count] = body;
  draft->places[draft->count++] = *place;
  if (!body && draft->count == 1 && !draft->kind->anywhere) finish(self); /* which says what is wrong with it */
  else if (draft->count == draft->kind->count(draft->type)) finish(self);
  else show_draft(self);
}

/* Shows how it would lie with the cursor there. */
static void pointed(SporeWindow *self, guint body, const SporeVec3 *place) {
  const SporePickDraft *draft = &self->draft;
  SporeVec3 places[SPORE_LINK_MOST_ENDS], points[SPORE_OUTLINE_POINTS];
  if (!draft->type || !draft->kind->outline || draft->count >= SPORE_LINK_MOST_ENDS) return;
  for (guint i = 0; i < draft->count; i++) places[i] = draft->places[i];
  places[draft->count] = *place;
  guint count = draft->kind->outline(document_of(self), draft->name, places, draft->count + 1, points);
  spore_viewport_set_outline(SPORE_VIEWPORT(self->viewport), points, count);
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
    spore_window_mend(self, SPORE_CAUSE_PICK);
    self->draft.count--;
    show_draft(self);
  } else {
    spore_window_end_pick(self);
  }
}

void spore_window_add_pick_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"pick-back", act_pick_back}, {"pick-done", act_pick_done}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  g_signal_connect_object(self->viewport, "picked", G_CALLBACK(picked), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->viewport, "pointed", G_CALLBACK(pointed), self, G_CONNECT_SWAPPED);
}
