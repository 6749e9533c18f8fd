/* The exercise: steps made by picking, metrics, their order and thresholds, and trying them out. */
#include "core/author/exercise_edits.h"
#include "core/exercise/event.h"
#include "ui/document/attempts.h"
#include "ui/spore-window-private.h"

#include <glib/gi18n.h>

static const SporePickKind step_pick = {
    .count = spore_step_end_count,
    .doc = spore_step_end_doc,
    .add = spore_edit_add_step,
    .tie = spore_edit_aim_step,
    .first = N_("%s, click %u of %u: %s Escape ends"),
    .later = N_("%s, click %u of %u: %s Escape goes back"),
};

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

/* The selected step or metric; NULL: neither is. */
static SporeObject *selected_part(SporeWindow *self) {
  SporeObject *selected = spore_editor_document_selected(self->document);
  return spore_step_is(selected) || spore_metric_is(selected) ? selected : NULL;
}

/* A kind that cannot be picked here is refused before the first click. */
static void act_add_step(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *element = g_variant_get_string(parameter, NULL);
  const SporeObjectType *section = spore_object_type(spore_document_section(document_of(self), "exercise"));
  const SporeObjectType *type = spore_object_type_child(section, element);
  g_autoptr(GError) error = NULL;
  spore_window_show_tab(self, self->exercise);
  if (spore_edit_can_add_step(document_of(self), element, &error))
    spore_window_begin_pick(self, (SporePickDraft){.kind = &step_pick, .type = type});
  else spore_window_failed(self, error);
}

static void act_aim_step(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *step = selected_part(self);
  if (!spore_step_is(step)) return;
  spore_window_begin_pick(
      self, (SporePickDraft){.kind = &step_pick, .type = spore_object_type(step), .object = spore_object_id(step)});
}

static void act_add_metric(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeObject *body = spore_editor_document_selected_body(self->document);
  g_autoptr(GError) error = NULL;
  SporeObject *metric = spore_edit_add_metric(document_of(self), g_variant_get_string(parameter, NULL), body, &error);
  spore_window_show_tab(self, self->exercise);
  if (metric) spore_editor_document_select(self->document, spore_object_id(metric));
  else spore_window_failed(self, error);
}

static void act_move_part(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *part = selected_part(self);
  g_autoptr(GError) error = NULL;
  int by = g_variant_get_int32(parameter) < 0 ? -1 : 1;
  if (part && !spore_edit_move_part(document_of(self), part, by, &error)) spore_window_failed(self, error);
}

static void act_remove_part(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *part = selected_part(self);
  g_autoptr(GError) error = NULL;
  if (part && !spore_edit_remove_part(document_of(self), part, &error)) spore_window_failed(self, error);
}

static void act_set_threshold(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *path, *name, *text;
  g_autoptr(GError) error = NULL;
  g_variant_get(parameter, "(&s&s&s)", &path, &name, &text);
  SporeObject *metric = spore_document_by_path(document_of(self), path);
  if (spore_metric_is(metric) && (g_str_equal(name, "good") || g_str_equal(name, "pass")) &&
      !spore_edit_set_threshold(document_of(self), metric, name, text, &error))
    spore_window_failed(self, error);
}

static void act_skip_to_step(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  spore_exercise_panel_skip(SPORE_EXERCISE_PANEL(self->exercise), selected_part(self));
}

static void act_repeat_attempt(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *scene = spore_editor_document_get_save_file(self->document);
  const SporeAttempt attempt = {.when = g_variant_get_int64(parameter)};
  g_autofree char *file = scene ? spore_attempts_track_file(scene, &attempt) : NULL;
  if (file) spore_player_repeat(self->player, file);
}

void spore_window_add_exercise_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"add-step", act_add_step, "s"},     {"aim-step", act_aim_step},
      {"add-metric", act_add_metric, "s"}, {"move-part", act_move_part, "i"},
      {"remove-part", act_remove_part},    {"set-threshold", act_set_threshold, "(sss)"},
      {"skip-to-step", act_skip_to_step},  {"repeat-attempt", act_repeat_attempt, "x"},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
}
