/* What is done to the scene, the simulation and the view by actions of the window. */
#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/instrument_edits.h"
#include "core/author/patient_positions.h"
#include "core/author/region_edits.h"
#include "core/scene/camera_sight.h"
#include "ui/spore-window-private.h"

#define STUDY_HEIGHT 350 /* pixels of the bottom, for a work-precision plot */

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

/* History and objects. */

static void act_move_row(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_outliner_move(SPORE_OUTLINER(((SporeWindow *)data)->outliner), g_variant_get_int32(parameter));
}

static void act_undo(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_document_undo(document_of(data));
}

static void act_redo(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_document_redo(document_of(data));
}

static void act_select(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *object = spore_document_by_path(document_of(self), g_variant_get_string(parameter, NULL));
  spore_editor_document_select(self->document, object ? spore_object_id(object) : 0);
}

static void act_rename(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *object = spore_editor_document_selected(self->document);
  g_autoptr(GError) error = NULL;
  if (object && !spore_document_rename(document_of(self), object, g_variant_get_string(parameter, NULL), &error))
    spore_window_failed(self, error);
}

static void act_rename_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_outliner_rename(SPORE_OUTLINER(((SporeWindow *)data)->outliner));
}

static void act_set_property(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *path, *name, *value;
  g_autoptr(GError) error = NULL;
  g_variant_get(parameter, "(&s&s&s)", &path, &name, &value);
  if (!spore_edit_set_property(document_of(self), path, name, value, &error)) spore_window_failed(self, error);
}

static void act_unset_property(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const char *path, *name;
  g_autoptr(GError) error = NULL;
  g_variant_get(parameter, "(&s&s)", &path, &name);
  if (!spore_edit_set_property(document_of(self), path, name, NULL, &error)) spore_window_failed(self, error);
}

static void act_set_model(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_window_body_to_work_on(self);
  g_autoptr(GError) error = NULL;
  if (body && !spore_edit_set_model(document_of(self), body, g_variant_get_string(parameter, NULL), &error))
    spore_window_failed(self, error);
}

static void act_use_preset(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_window_body_to_work_on(self);
  g_autoptr(GError) error = NULL;
  if (body && !spore_edit_use_preset(document_of(self), body, g_variant_get_string(parameter, NULL), &error))
    spore_window_failed(self, error);
}

static void act_add_region(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_window_body_to_work_on(self);
  g_autoptr(GError) error = NULL;
  if (body && !spore_edit_add_region(document_of(self), body, g_variant_get_string(parameter, NULL), &error))
    spore_window_failed(self, error);
}

/* The region is placed by its handles in the view. */
static void act_place_region(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  SporeObject *region = spore_edit_find_region(document_of(self), g_variant_get_string(parameter, NULL), &error);
  if (spore_window_failed(self, error) || !spore_window_may_edit(self)) return;
  g_action_group_change_action_state(G_ACTION_GROUP(self), "tool", g_variant_new_string("edit"));
  spore_viewport_edit_region(SPORE_VIEWPORT(self->viewport), region);
  spore_window_show_hint(self);
}

/* path: of a region, or of what holds regions. */
static void act_paint_region(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeObject *body = spore_window_body_to_work_on(self);
  if (!body || !spore_window_may_edit(self)) return;
  g_action_group_change_action_state(G_ACTION_GROUP(self), "tool", g_variant_new_string("edit"));
  spore_viewport_begin_brush(SPORE_VIEWPORT(self->viewport), body, g_variant_get_string(parameter, NULL));
  spore_window_show_hint(self);
}

static void act_remove_region(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_edit_remove_region(document_of(self), g_variant_get_string(parameter, NULL), &error))
    spore_window_failed(self, error);
}

/* The state follows gravity; see spore-window-needs.c. */
static void change_patient(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_edit_lay_patient(document_of(self), g_variant_get_string(state, NULL), &error))
    spore_window_failed(self, error);
}

/* Simulation. */

static void act_play(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_player_play(((SporeWindow *)data)->player);
}

static void act_pause(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_player_pause(((SporeWindow *)data)->player);
}

static void act_play_pause(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  (spore_player_is_playing(self->player) ? spore_player_pause : spore_player_play)(self->player);
}

static void act_step(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_player_step(((SporeWindow *)data)->player);
}

static void act_reset(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_player_reset(((SporeWindow *)data)->player);
}

static void act_step_back(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_timeline_step_back(SPORE_TIMELINE(self->timeline), &error)) spore_window_failed(self, error);
}

static void act_go_to(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_timeline_go_to(SPORE_TIMELINE(self->timeline), g_variant_get_double(parameter), &error))
    spore_window_failed(self, error);
}

static void act_replay(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_timeline_replay(SPORE_TIMELINE(self->timeline), &error)) spore_window_failed(self, error);
}

static void act_stay(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_player_stay(((SporeWindow *)data)->player);
}

static void act_bookmark(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (spore_timeline_bookmark(SPORE_TIMELINE(self->timeline))) spore_window_show_tab(self, self->timeline);
}

static void act_plot(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (spore_plots_show(SPORE_PLOTS(self->plots), g_variant_get_string(parameter, NULL)))
    spore_window_show_tab(self, self->plots);
}

static void act_watch(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (spore_plots_watch(SPORE_PLOTS(self->plots), g_variant_get_string(parameter, NULL), &error))
    spore_window_show_tab(self, self->plots);
  else spore_window_failed(self, error);
}

static void act_forget_points(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_plots_forget_points(SPORE_PLOTS(((SporeWindow *)data)->plots));
}

static void change_speed(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  const char *text = g_variant_get_string(state, NULL);
  double speed = g_ascii_strtod(text, NULL);
  if (!(speed >= 0 && speed <= 100)) return;
  g_autofree char *label = speed > 0 ? g_strdup_printf("%g×", speed) : g_strdup(_("Max"));
  gtk_button_set_label(GTK_BUTTON(self->speed_button), label);
  spore_player_set_speed(self->player, speed);
  g_simple_action_set_state(action, state);
}

/* View. */

static void change_tool(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  const char *name = g_variant_get_string(state, NULL);
  gboolean edit = g_str_equal(name, "edit");
  if (edit && !spore_window_may_edit(self)) return;
  spore_window_stop_picking(self);
  spore_viewport_set_tool(SPORE_VIEWPORT(self->viewport), edit                         ? SPORE_VIEWPORT_TOOL_EDIT
                                                          : g_str_equal(name, "probe") ? SPORE_VIEWPORT_TOOL_PROBE
                                                                                       : SPORE_VIEWPORT_TOOL_SELECT);
  g_simple_action_set_state(action, state);
  spore_window_show_hint(self);
}

static gboolean is_on(SporeWindow *self, const char *action) {
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(self), action);
  return g_variant_get_boolean(state);
}

static void change_boxing(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_simple_action_set_state(action, state);
  spore_viewport_set_boxing(SPORE_VIEWPORT(self->viewport), g_variant_get_boolean(state));
  spore_window_show_hint(self);
}

/* What the colours of surfaces show. */
static SporeStageField field_of(SporeWindow *self) {
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(self), "colours");
  SporeStageField field = SPORE_FIELD_NONE;
  for (SporeStageField i = 0; i < SPORE_FIELD_COUNT; i++)
    if (g_str_equal(g_variant_get_string(state, NULL), spore_stage_field_names[i])) field = i;
  return field;
}

static void show_overlays(SporeWindow *self) {
  SporeStageOptions options = {.surfaces = is_on(self, "show-surfaces"),
                               .spheres = is_on(self, "show-spheres"),
                               .tetrahedra = is_on(self, "show-tetrahedra"),
                               .contacts = is_on(self, "show-contacts"),
                               .links = is_on(self, "show-links"),
                               .field = field_of(self)};
  spore_viewport_set_options(SPORE_VIEWPORT(self->viewport), &options, is_on(self, "keep-scale"));
}

static void change_overlay(GSimpleAction *action, GVariant *state, gpointer data) {
  g_simple_action_set_state(action, state);
  show_overlays(data);
}

/* Without colours there is no scale to keep. */
static void change_keep_scale(GSimpleAction *action, GVariant *state, gpointer data) {
  gboolean keep = g_variant_get_boolean(state) && field_of(data) != SPORE_FIELD_NONE;
  g_simple_action_set_state(action, g_variant_new_boolean(keep));
  show_overlays(data);
}

/* Another measure has another scale. */
static void change_colours(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_simple_action_set_state(action, state);
  g_action_group_change_action_state(G_ACTION_GROUP(self), "keep-scale", g_variant_new_boolean(FALSE));
}

static void change_reach(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_simple_action_set_state(action, state);
  spore_viewport_set_reach(SPORE_VIEWPORT(self->viewport), g_variant_get_boolean(state));
}

static void change_figures(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_simple_action_set_state(action, state);
  spore_viewport_set_figures(SPORE_VIEWPORT(self->viewport), g_variant_get_boolean(state));
}

/* Panels stand beside the view, but not while it has the whole screen. */
static void change_panel(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_simple_action_set_state(action, state);
  gboolean beside = !is_on(self, "present");
  gtk_widget_set_visible(self->outliner, beside && is_on(self, "show-outliner"));
  gtk_widget_set_visible(self->inspector, beside && is_on(self, "show-inspector"));
  gtk_widget_set_visible(self->bottom, beside && is_on(self, "show-problems"));
}

/* Over the view while it has the whole screen: the panel shows the same. */
static void change_guide(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  g_simple_action_set_state(action, state);
  gboolean wanted = is_on(self, "present") && is_on(self, "show-guide");
  spore_exercise_guide_set_wanted(SPORE_EXERCISE_GUIDE(self->guide), wanted);
}

/* The view has the whole screen, or gives it back. */
static void change_present(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  change_panel(action, state, data);
  change_guide(action, state, data);
  gtk_widget_set_visible(self->controls, g_variant_get_boolean(state));
  if (g_variant_get_boolean(state)) gtk_window_fullscreen(GTK_WINDOW(self));
  else gtk_window_unfullscreen(GTK_WINDOW(self));
  spore_viewport_set_presented(SPORE_VIEWPORT(self->viewport), g_variant_get_boolean(state));
  spore_window_show_hint(self);
}

static void act_frame(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_viewport_frame(SPORE_VIEWPORT(((SporeWindow *)data)->viewport));
}

static void act_view(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_viewport_view(SPORE_VIEWPORT(((SporeWindow *)data)->viewport), g_variant_get_string(parameter, NULL));
}

static void act_swap_views(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_viewport_swap_views(SPORE_VIEWPORT(((SporeWindow *)data)->viewport));
}

static void change_second_view(GSimpleAction *action, GVariant *state, gpointer data) {
  g_simple_action_set_state(action, state);
  spore_viewport_set_second_view(SPORE_VIEWPORT(((SporeWindow *)data)->viewport), g_variant_get_boolean(state));
}

static void act_turn_optic(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  SporeObject *camera = spore_viewport_scene_camera(SPORE_VIEWPORT(self->viewport));
  if (camera &&
      !spore_edit_turn_optic(document_of(self), camera, g_variant_get_double(parameter) * (G_PI / 180), &error))
    spore_window_failed(self, error);
}

static void act_wipe_lens(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  SporeSession *session = spore_player_get_session(self->player);
  const SporeObject *camera = spore_viewport_scene_camera(SPORE_VIEWPORT(self->viewport));
  if (!session || !camera) return;
  const SporeCommand wipe = {.kind = SPORE_COMMAND_WIPE, .number = spore_camera_number(document_of(self), camera)};
  spore_session_post(session, &wipe);
}

static void change_cut(GSimpleAction *action, GVariant *state, gpointer data) {
  spore_viewport_set_cut(SPORE_VIEWPORT(((SporeWindow *)data)->viewport), g_variant_get_string(state, NULL));
  g_simple_action_set_state(action, state);
}

static void change_cut_side(GSimpleAction *action, GVariant *state, gpointer data) {
  spore_viewport_turn_cut(SPORE_VIEWPORT(((SporeWindow *)data)->viewport), g_variant_get_boolean(state));
  g_simple_action_set_state(action, state);
}

static void act_measure(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  const SporeGauge *gauge = spore_gauge_find(g_variant_get_string(parameter, NULL));
  if (!gauge) return;
  spore_window_stop_picking(self);
  spore_viewport_measure(SPORE_VIEWPORT(self->viewport), gauge);
}

static void act_clear_measures(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_viewport_clear_measures(SPORE_VIEWPORT(((SporeWindow *)data)->viewport));
}

static void measuring(SporeWindow *self) {
  if (!self->player) return; /* the document is being put into the window */
  spore_window_show_hint(self);
  spore_window_update_actions(self);
}

static void act_filter(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_outliner_focus_filter(SPORE_OUTLINER(((SporeWindow *)data)->outliner));
}

static void act_report(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_window_complain(data, g_variant_get_string(parameter, NULL));
}

static void act_close_message(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_window_close_message(data);
}

static void marks_changed(SporeWindow *self) {
  spore_viewport_set_marks(SPORE_VIEWPORT(self->viewport), spore_inspector_get_marks(SPORE_INSPECTOR(self->inspector)));
}

/* The accuracy study. */

static void act_measure_accuracy(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  spore_window_show_tab(self, self->accuracy);
  spore_accuracy_measure(SPORE_ACCURACY(self->accuracy));
}

static void act_choose_point(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_accuracy_choose(SPORE_ACCURACY(((SporeWindow *)data)->accuracy), g_variant_get_uint32(parameter));
}

static void act_apply_point(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_accuracy_apply(SPORE_ACCURACY(self->accuracy), &error)) spore_window_failed(self, error);
}

/* Makes the bottom tall enough for a plot, where the view keeps its least height. Once: what the user makes of it after
 * that stays. */
static void make_room(SporeWindow *self) {
  int least, height = gtk_widget_get_allocated_height(self->middle);
  gtk_widget_get_preferred_height(self->viewport, &least, NULL);
  int position = MAX(least, height - STUDY_HEIGHT);
  if (!self->made_room && position < gtk_paned_get_position(GTK_PANED(self->middle)))
    gtk_paned_set_position(GTK_PANED(self->middle), position);
  self->made_room = TRUE;
}

static void study_changed(SporeWindow *self) {
  if (!self->player) return; /* the document is being put into the window */
  if (spore_editor_document_get_study(self->document)) make_room(self);
  spore_window_update_actions(self);
}

void spore_window_add_scene_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"undo", act_undo},
      {"redo", act_redo},
      {"select", act_select, "s"},
      {"rename", act_rename, "s"},
      {"move-row", act_move_row, "i"},
      {"rename-dialog", act_rename_dialog},
      {"rename-row", act_rename_dialog},
      {"set-property", act_set_property, "(sss)"},
      {"unset-property", act_unset_property, "(ss)"},
      {"set-model", act_set_model, "s"},
      {"use-preset", act_use_preset, "s"},
      {"add-region", act_add_region, "s"},
      {"place-region", act_place_region, "s"},
      {"paint-region", act_paint_region, "s"},
      {"remove-region", act_remove_region, "s"},
      {"patient", NULL, "s", "''", change_patient},
      {"play", act_play},
      {"pause", act_pause},
      {"play-pause", act_play_pause},
      {"step", act_step},
      {"reset", act_reset},
      {"step-back", act_step_back},
      {"go-to", act_go_to, "d"},
      {"replay", act_replay},
      {"stay", act_stay},
      {"bookmark", act_bookmark},
      {"speed", NULL, "s", "'1'", change_speed},
      {"plot", act_plot, "s"},
      {"watch", act_watch, "s"},
      {"forget-points", act_forget_points},
      {"tool", NULL, "s", "'select'", change_tool},
      {"show-surfaces", NULL, NULL, "true", change_overlay},
      {"show-spheres", NULL, NULL, "false", change_overlay},
      {"show-tetrahedra", NULL, NULL, "false", change_overlay},
      {"show-contacts", NULL, NULL, "false", change_overlay},
      {"show-links", NULL, NULL, "false", change_overlay},
      {"box-select", NULL, NULL, "false", change_boxing},
      {"colours", NULL, "s", "'none'", change_colours},
      {"keep-scale", NULL, NULL, "false", change_keep_scale},
      {"show-reach", NULL, NULL, "false", change_reach},
      {"show-figures", NULL, NULL, "false", change_figures},
      {"show-outliner", NULL, NULL, "true", change_panel},
      {"show-inspector", NULL, NULL, "true", change_panel},
      {"show-problems", NULL, NULL, "true", change_panel},
      {"present", NULL, NULL, "false", change_present},
      {"show-guide", NULL, NULL, "true", change_guide},
      {"measure-accuracy", act_measure_accuracy},
      {"choose-point", act_choose_point, "u"},
      {"apply-point", act_apply_point},
      {"frame", act_frame},
      {"view", act_view, "s"},
      {"swap-views", act_swap_views},
      {"second-view", NULL, NULL, "false", change_second_view},
      {"turn-optic", act_turn_optic, "d"},
      {"wipe-lens", act_wipe_lens},
      {"cut", NULL, "s", "'none'", change_cut},
      {"cut-other-side", NULL, NULL, "false", change_cut_side},
      {"measure", act_measure, "s"},
      {"clear-measures", act_clear_measures},
      {"filter", act_filter},
      {"report", act_report, "s"},
      {"close-message", act_close_message},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  g_signal_connect_object(self->accuracy, "study-changed", G_CALLBACK(study_changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->viewport, "measuring", G_CALLBACK(measuring), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->inspector, "marks-changed", G_CALLBACK(marks_changed), self, G_CONNECT_SWAPPED);
}
