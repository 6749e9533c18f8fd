/* Moving, turning, scaling, aligning and copying what is selected. */
#include "core/author/mirror_edits.h"
#include "core/author/placement.h"
#include "ui/spore-window-private.h"

static const char *const gizmos[] = {"none", "move", "turn", "scale", NULL}; /* by SporeGizmo */

/* The same once more: none. */
static void change_gizmo(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GVariant) now = g_action_get_state(G_ACTION(action));
  const char *name = g_variant_equal(now, state) ? gizmos[SPORE_GIZMO_NONE] : g_variant_get_string(state, NULL);
  SporeGizmo gizmo = SPORE_GIZMO_NONE;
  while (gizmos[gizmo] && !g_str_equal(gizmos[gizmo], name)) gizmo++;
  if (!gizmos[gizmo] || (gizmo != SPORE_GIZMO_NONE && !spore_window_may_edit(self))) return;
  g_action_group_change_action_state(G_ACTION_GROUP(self), "tool", g_variant_new_string("select"));
  spore_viewport_set_gizmo(SPORE_VIEWPORT(self->viewport), gizmo);
  g_simple_action_set_state(action, g_variant_new_string(name));
  spore_window_show_hint(self);
}

/* AXIS-ALIGNMENT */
static void act_align(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *text = g_variant_get_string(parameter, NULL);
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GError) error = NULL;
  if (text[0] < 'x' || text[0] > 'z' || text[1] != '-' || !spore_window_may_edit(self)) return;
  int alignment = spore_alignment_find(text + 2);
  if (alignment >= 0 && !spore_edit_align(spore_editor_document_get(self->document), bodies, text[0] - 'x',
                                          (SporeAlignment)alignment, &error))
    spore_window_failed(self, error);
}

/* AXIS-PLANE: through the middle of the body itself, or of the scene */
static void act_mirror(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *text = g_variant_get_string(parameter, NULL);
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *body = spore_editor_document_selected_body(self->document);
  g_autoptr(GError) error = NULL;
  if (text[0] < 'x' || text[0] > 'z' || text[1] != '-' || !body || !spore_window_may_edit(self)) return;
  int axis = text[0] - 'x';
  double lower[3], upper[3];
  spore_body_box(document, body, lower, upper);
  gboolean own = g_str_equal(text + 2, "own");
  double at = own ? 0.5 * (lower[axis] + upper[axis]) : spore_scene_middle(document, axis);
  SporeObject *copy = spore_edit_mirror(document, body, axis, at, &error);
  if (copy) spore_editor_document_select(self->document, spore_object_id(copy));
  else spore_window_failed(self, error);
}

static void act_duplicate(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  g_autoptr(GError) error = NULL;
  if (!bodies->len || !spore_window_may_edit(self)) return;
  g_autoptr(GPtrArray) copies = spore_edit_copy(document, bodies, spore_copy_offset(document, bodies), &error);
  if (copies) spore_window_select(self, copies);
  else spore_window_failed(self, error);
}

void spore_window_add_placement_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {{"gizmo", NULL, "s", "'none'", change_gizmo},
                                         {"align", act_align, "s"},
                                         {"mirror", act_mirror, "s"},
                                         {"duplicate", act_duplicate}};
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
