/* What every part of the window stands on: messages, the job that runs, which actions are enabled, and the hint. */
#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/fix.h"
#include "core/scene/generated.h"
#include "ui/document/hands.h"
#include "ui/spore-window-private.h"

/* Telling. */

void spore_window_log(SporeWindow *self, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *text = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  g_autoptr(GDateTime) now = g_date_time_new_now_local();
  g_autofree char *clock = g_date_time_format(now, "%H:%M:%S");
  g_autofree char *line = g_strdup_printf("%s  %s\n", clock, text);
  GtkTextBuffer *buffer = gtk_text_view_get_buffer(GTK_TEXT_VIEW(self->log));
  GtkTextIter end;
  gtk_text_buffer_get_end_iter(buffer, &end);
  gtk_text_buffer_insert(buffer, &end, line, -1);
  /* Scrolls to a mark, because the new line is not laid out yet. */
  gtk_text_buffer_place_cursor(buffer, &end);
  gtk_text_view_scroll_to_mark(GTK_TEXT_VIEW(self->log), gtk_text_buffer_get_insert(buffer), 0, FALSE, 0, 0);
}

void spore_window_show_tab(SporeWindow *self, GtkWidget *what) {
  g_action_group_change_action_state(G_ACTION_GROUP(self), "show-problems", g_variant_new_boolean(TRUE));
  while (gtk_widget_get_parent(what) != self->tabs) what = gtk_widget_get_parent(what);
  gtk_stack_set_visible_child(GTK_STACK(self->tabs), what);
}

/* GTK complains of a name whose target it does not have yet. */
static void set_remedy(GtkActionable *button, const char *action) {
  g_autofree char *name = NULL;
  g_autoptr(GVariant) target = NULL;
  if (action) g_action_parse_detailed_name(action, &name, &target, NULL);
  gtk_actionable_set_action_name(button, NULL);
  gtk_actionable_set_action_target_value(button, target);
  gtk_actionable_set_action_name(button, name);
}

static void offer_remedy(SporeWindow *self, const char *remedy, const char *action) {
  gtk_widget_set_visible(self->message_remedy, remedy != NULL);
  if (remedy) gtk_button_set_label(GTK_BUTTON(self->message_remedy), remedy);
  set_remedy(GTK_ACTIONABLE(self->message_remedy), action);
}

const SporeDiagnostic *spore_window_said_problem(SporeWindow *self) {
  return spore_problems_fixable(SPORE_PROBLEMS(self->problems), gtk_label_get_text(GTK_LABEL(self->message)));
}

void spore_window_offer_fix(SporeWindow *self) {
  if (!gtk_widget_get_visible(self->message_bar) || gtk_widget_get_visible(self->message_remedy)) return;
  const SporeDiagnostic *problem = spore_window_said_problem(self);
  g_autofree char *label = problem ? spore_fix_label(problem) : NULL;
  if (label) offer_remedy(self, label, "win.fix-said");
}

void spore_window_complain_while(SporeWindow *self, SporeCause cause, const char *message, const char *remedy,
                                 const char *action) {
  self->cause = cause;
  gtk_label_set_text(GTK_LABEL(self->message), message);
  offer_remedy(self, remedy, action);
  gtk_widget_show(self->message_bar);
  spore_window_offer_fix(self);
  spore_window_log(self, "%s", message);
}

void spore_window_complain(SporeWindow *self, const char *message) {
  spore_window_complain_while(self, SPORE_CAUSE_LASTS, message, NULL, NULL);
}

void spore_window_mend(SporeWindow *self, guint causes) {
  if (self->cause & causes) gtk_widget_hide(self->message_bar);
}

gboolean spore_window_failed(SporeWindow *self, const GError *error) {
  gboolean refused = g_error_matches(error, SPORE_ERROR, SPORE_ERROR_INPUT);
  if (error && !g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED))
    spore_window_complain_while(self, refused ? SPORE_CAUSE_EDIT : SPORE_CAUSE_LASTS, error->message, NULL, NULL);
  return error != NULL;
}

gboolean spore_window_wrote(SporeWindow *self, const char *file, const GError *error) {
  if (error) {
    SporeCause cause = SPORE_CAUSE_FILE;
    if (g_error_matches(error, SPORE_ERROR, SPORE_ERROR_INPUT)) cause |= SPORE_CAUSE_EDIT;
    if (!g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED))
      spore_window_complain_while(self, cause, error->message, NULL, NULL);
    return FALSE;
  }
  spore_window_mend(self, SPORE_CAUSE_FILE);
  spore_window_log(self, _("Saved %s"), file);
  return TRUE;
}

/* The bars that the user may close without an answer, from the topmost on. */
gboolean spore_window_close_message(SporeWindow *self) {
  GtkWidget *const bars[] = {self->message_bar, self->missing_bar, self->hold_bar};
  for (guint i = 0; i < G_N_ELEMENTS(bars); i++) {
    if (!gtk_widget_get_visible(bars[i])) continue;
    gtk_info_bar_response(GTK_INFO_BAR(bars[i]), GTK_RESPONSE_CLOSE);
    return TRUE;
  }
  return FALSE;
}

/* Jobs. */

/* The job that is shown: one at a time, those that the user began by name first. */
static SporeJob *shown_job(SporeWindow *self) {
  SporeJob *job = self->job;
  if (!job && self->generator) job = spore_generator_get_job(self->generator);
  return !job && self->player ? spore_player_get_job(self->player) : job;
}

void spore_window_show_job(SporeWindow *self) {
  SporeJob *job = shown_job(self);
  gtk_widget_set_visible(self->job_box, job != NULL);
  if (!job) return;
  g_autofree char *stage = spore_job_get_stage(job);
  g_autofree char *text =
      *stage ? g_strdup_printf("%s: %s", spore_job_get_title(job), stage) : g_strdup(spore_job_get_title(job));
  gtk_label_set_text(GTK_LABEL(self->job_label), text);
  double fraction = spore_job_get_fraction(job);
  if (fraction > 0) gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(self->job_bar), fraction);
  else gtk_progress_bar_pulse(GTK_PROGRESS_BAR(self->job_bar));
}

static void job_finished(SporeJob *job, SporeWindow *self) {
  if (self->job != job) return;
  g_clear_object(&self->job);
  spore_window_mend(self, SPORE_CAUSE_WORK);
  spore_window_show_job(self);
  spore_window_update_actions(self);
}

void spore_window_complain_work(SporeWindow *self) {
  spore_window_complain_while(self, SPORE_CAUSE_WORK,
                              _("Something else is still being worked on; wait for it or cancel it"), _("Cancel it"),
                              "win.cancel-job");
}

gboolean spore_window_start_job(SporeWindow *self, const char *title, SporeJobWork work, gpointer data,
                                GDestroyNotify free_data, SporeJobDone done) {
  if (self->job || spore_generator_is_working(self->generator)) {
    spore_window_complain_work(self);
    free_data(data);
    return FALSE;
  }
  spore_recovery_keep(self->recovery, self->document, NULL);
  self->job = spore_job_start(title, work, data, free_data, done, G_OBJECT(self));
  g_signal_connect_object(self->job, "progressed", G_CALLBACK(spore_window_show_job), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->job, "finished", G_CALLBACK(job_finished), self, 0);
  spore_window_show_job(self);
  spore_window_update_actions(self);
  return TRUE;
}

/* What is worked on. */

SporeObject *spore_window_body_to_work_on(SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  SporeObject *selected = spore_editor_document_selected_body(self->document);
  if (selected) return selected;
  SporeObject *bodies = spore_document_section(document, "bodies"), *only = NULL;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (!spore_edit_visual_mesh(document, body, NULL)) continue;
    if (only) {
      only = NULL;
      break;
    }
    only = body;
  }
  if (!only)
    spore_window_complain_while(self, SPORE_CAUSE_SELECTION,
                                _("Select the organ first, in the outliner or in the viewport"), NULL, NULL);
  return only;
}

double spore_window_played_s(SporeWindow *self) {
  SporeSession *session = spore_player_get_session(self->player);
  return session ? spore_session_snapshot(session)->time_s : 0;
}

gboolean spore_window_is_at_start(SporeWindow *self) { return spore_window_played_s(self) == 0; }

gboolean spore_window_may_edit(SporeWindow *self) {
  if (spore_window_is_at_start(self)) return TRUE;
  spore_window_complain_while(self, SPORE_CAUSE_RUN,
                              _("Editing by hand needs the scene at its start; go back to it first (Shift+F5)"),
                              _("Back to the start"), "win.reset");
  return FALSE;
}

/* The hint. */

/* What to click on, while places are picked; else NULL. */
static const char *picking_hint(SporeWindow *self) {
  if (!spore_window_is_picking(self)) return NULL;
  return _(spore_generators[spore_generator_get_options(self->generator)->kind]->places->hints[self->picked.count]);
}

/* What to click on, while the ends of an object are picked; else NULL. g_free. */
static char *draft_hint(SporeWindow *self) {
  const SporePickDraft *draft = &self->draft;
  guint ends = draft->type ? draft->kind->count(draft->type) : 0;
  if (draft->count >= ends) return NULL; /* the object is being made */
  const char *doc = draft->kind->doc(draft->type, draft->count);
  const char *hint = draft->count ? draft->kind->later : draft->kind->first;
  return g_strdup_printf(_(hint), _(draft->label), draft->count + 1, ends, doc);
}

/* How the instrument is led; NULL: there is none, or it does not run. Which one it is stands beside it in the view. */
static const char *leading_hint(SporeWindow *self) {
  const SporeObject *led = spore_viewport_get_led(SPORE_VIEWPORT(self->viewport));
  if (!led || !spore_player_get_session(self->player)) return NULL;
  if (spore_hand_pours(spore_editor_document_get(self->document), led))
    return _(
        "Drag leads it, Shift+drag turns it; right button or C draws away, Ctrl+right button or O pours, L lets go; "
        "N, P: another one");
  return spore_hand_latches(spore_editor_document_get(self->document), led)
             ? _("Drag leads it, Shift+drag turns it; right button or C closes it, Ctrl+right button or O opens it; N, "
                 "P: "
                 "another one")
             : _("Drag leads it, Shift+drag turns it; right button or C closes it, O lets go; N, P: another one");
}

/* What the gizmo does; NULL: there is none. */
static const char *gizmo_hint(SporeWindow *self) {
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(self), "gizmo");
  const char *gizmo = g_variant_get_string(state, NULL);
  if (!spore_window_is_at_start(self) || !spore_editor_document_selected_body(self->document)) return NULL;
  if (g_str_equal(gizmo, "move"))
    return _("Drag a handle to move what is selected: Ctrl by 1 mm, with Shift by 5 mm; X, Y, Z keep to an axis; "
             "Escape takes it back; W ends");
  if (g_str_equal(gizmo, "turn"))
    return _("Drag a ring to turn what is selected: Ctrl by 15 degrees; X, Y, Z keep to an axis; Escape takes it back; "
             "E ends");
  if (g_str_equal(gizmo, "scale"))
    return _("Drag the circle to make what is selected larger or smaller: Ctrl by tenths, with Shift by halves; Escape "
             "takes it back; R ends");
  return NULL;
}

static const char *hint_for(SporeWindow *self) {
  if (picking_hint(self)) return picking_hint(self);
  g_autoptr(GVariant) boxing = g_action_group_get_action_state(G_ACTION_GROUP(self), "box-select");
  if (g_variant_get_boolean(boxing))
    return _("Drag a box: to the right it takes what lies inside, to the left all that it touches; Escape gives up");
  g_autoptr(GVariant) present = g_action_group_get_action_state(G_ACTION_GROUP(self), "present");
  if (g_variant_get_boolean(present)) return _("F11 or Escape brings the panels back; F5 plays and pauses");
  SporeDocument *document = spore_editor_document_get(self->document);
  if (spore_object_child_count(spore_document_section(document, "bodies")) == 0)
    return _("Import a mesh to begin, or open the demo");
  g_autoptr(GVariant) tool = g_action_group_get_action_state(G_ACTION_GROUP(self), "tool");
  if (spore_viewport_has_brush(SPORE_VIEWPORT(self->viewport)))
    return _("Drag over the organ to paint the region, with Ctrl to erase; the wheel, + and − size the brush; Insert "
             "paints in the middle of the view; Escape ends");
  if (spore_viewport_edits_regions(SPORE_VIEWPORT(self->viewport)))
    return _("Click puts the region there; its middle and its rim have a handle to drag; N and P choose, Insert adds");
  gboolean edits = g_str_equal(g_variant_get_string(tool, NULL), "edit");
  if (edits && spore_viewport_has_ports(SPORE_VIEWPORT(self->viewport)))
    return _("Drag the handle of the port: its instrument turns about its tip and goes with it; Escape takes it back");
  if (edits && !spore_viewport_has_edited(SPORE_VIEWPORT(self->viewport)))
    return _("Nothing to edit by hand here: select an organ that has spheres or a middle line");
  if (edits)
    return _("Drag moves a sphere or point, the wheel resizes it; N and P choose, Insert adds, Delete deletes");
  if (g_str_equal(g_variant_get_string(tool, NULL), "probe") && leading_hint(self)) return leading_hint(self);
  if (gizmo_hint(self) && spore_viewport_is_locked(SPORE_VIEWPORT(self->viewport)))
    return _("What is selected is locked: K, or the lock beside its name, frees it");
  if (gizmo_hint(self)) return gizmo_hint(self);
  if (spore_player_is_repeating(self->player))
    return _("Recorded input is repeated; F5 pauses and goes on, Shift+F5 ends it and goes back to the start");
  if (spore_player_is_playing(self->player))
    return _("Choose Lead: drag leads an instrument, the right button closes it; Ctrl+drag pulls tissue; F5 pauses");
  if (!spore_player_get_session(self->player))
    return _("Click selects, a drag beside the organs turns, wheel zooms, F frames; F5 plays");
  return _("Paused: F5 goes on, F6 makes one step, Shift+F5 goes back to the start");
}

void spore_window_show_hint(SporeWindow *self) {
  guint hidden = spore_viewport_hidden_count(SPORE_VIEWPORT(self->viewport));
  g_autofree char *of_draft = draft_hint(self);
  g_autofree char *of_measure = spore_viewport_measure_hint(SPORE_VIEWPORT(self->viewport));
  const char *hint = of_draft ? of_draft : of_measure ? of_measure : hint_for(self);
  g_autofree char *text = hidden ? g_strdup_printf(ngettext("%u body is hidden, A shows all; %s",
                                                            "%u bodies are hidden, A shows all; %s", hidden),
                                                   hidden, hint)
                                 : g_strdup(hint);
  gtk_label_set_text(GTK_LABEL(self->hint), text);
  gtk_widget_set_tooltip_text(self->hint, text); /* a narrow window has no room for all of it */
}
