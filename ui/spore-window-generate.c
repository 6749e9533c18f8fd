#include <glib/gi18n.h>

#include "core/scene/generated.h"
#include "ui/document/edits.h"
#include "ui/jobs/generate-types.h"
#include "ui/spore-window-private.h"

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

/* Starting. */

/* What is asked for; carried over the question whether edits may be replaced. */
typedef struct {
  SporeWindow *window;
  SporeGenerateKind kind;
  guint count; /* 0: as the body's asset says */
  gboolean apply;
} Request;

static void show_panel(SporeWindow *self) {
  g_action_group_change_action_state(G_ACTION_GROUP(self), "show-problems", g_variant_new_boolean(TRUE));
  gtk_stack_set_visible_child(GTK_STACK(self->tabs), self->generator_panel);
}

static void begin(const Request *request) {
  SporeWindow *self = request->window;
  SporeObject *body = spore_window_body_to_work_on(self);
  if (!body) return;
  g_autoptr(GError) error = NULL;
  SporeGenerateOptions options = spore_generate_options_of(document_of(self), body, request->kind);
  if (request->count) spore_generate_set_count(&options, request->count);
  if (self->job) {
    spore_window_complain(self, _("Something else is still being worked on; wait for it or cancel it"));
    return;
  }
  if (!spore_generator_is_active(self->generator)) spore_recovery_keep(self->recovery, self->document, NULL);
  g_action_group_change_action_state(G_ACTION_GROUP(self), "tool", g_variant_new_string("select"));
  if (!spore_generator_preview(self->generator, body, &options, &error)) spore_window_failed(self, error);
  else if (request->apply) spore_generator_apply_when_done(self->generator);
  else show_panel(self);
}

static void answered(GtkDialog *dialog, int response, Request *request) {
  if (response == GTK_RESPONSE_ACCEPT) begin(request);
  gtk_widget_destroy(GTK_WIDGET(dialog));
}

static void free_request(gpointer data, GClosure *closure) { g_free(data); }

/* What was edited by hand is not replaced without a word. */
static void ask(const Request *request, SporeObject *asset) {
  GtkWidget *dialog = gtk_message_dialog_new(GTK_WINDOW(request->window),
                                             GTK_DIALOG_MODAL | GTK_DIALOG_DESTROY_WITH_PARENT, GTK_MESSAGE_QUESTION,
                                             GTK_BUTTONS_NONE, _("Generate “%s” again?"), spore_object_name(asset));
  gtk_message_dialog_format_secondary_text(GTK_MESSAGE_DIALOG(dialog),
                                           _("It was edited by hand; what is generated takes the place of the edits "
                                             "once it is applied."));
  gtk_dialog_add_buttons(GTK_DIALOG(dialog), _("Keep the edits"), GTK_RESPONSE_CANCEL, _("Generate again"),
                         GTK_RESPONSE_ACCEPT, NULL);
  gtk_dialog_set_default_response(GTK_DIALOG(dialog), GTK_RESPONSE_CANCEL);
  g_signal_connect_data(dialog, "response", G_CALLBACK(answered), g_memdup2(request, sizeof *request), free_request, 0);
  gtk_widget_show(dialog);
}

static void start(SporeWindow *self, SporeGenerateKind kind, guint count, gboolean apply) {
  Request request = {self, kind, count, apply};
  SporeObject *body = spore_window_body_to_work_on(self);
  SporeObject *asset = body ? spore_generate_target(document_of(self), body, kind) : NULL;
  gboolean goes_on = body && spore_generator_get_body(self->generator) == body &&
                     spore_generator_get_options(self->generator)->kind == kind;
  if (asset && spore_generated_is(asset, "edited") && !spore_generated_is(asset, "frozen") && !goes_on)
    ask(&request, asset);
  else if (body) begin(&request);
}

/* The kind that the action is named after. */
static SporeGenerateKind kind_of(GSimpleAction *action) {
  const char *name = strchr(g_action_get_name(G_ACTION(action)), '-') + 1;
  SporeGenerateKind kind = 0;
  while (!g_str_equal(spore_generate_type(kind)->name, name)) kind++;
  return kind;
}

static void act_generate(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, kind_of(action), MAX(1, g_variant_get_uint32(parameter)), TRUE);
}

static void act_preview(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, kind_of(action), g_variant_get_uint32(parameter), FALSE);
}

/* Ending. */

static void act_apply_generated(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_generator_apply(self->generator, &error)) spore_window_failed(self, error);
}

static void act_cancel_job(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (self->job) spore_job_cancel(self->job);
  spore_generator_cancel(self->generator);
}

static void applied(SporeWindow *self) {
  const SporeGenerateWork *work = spore_generator_get_result(self->generator);
  if (work->options.kind == SPORE_GENERATE_SPHERES)
    g_action_group_change_action_state(G_ACTION_GROUP(self), "show-spheres", g_variant_new_boolean(TRUE));
  g_autofree char *facts = spore_generate_type(work->options.kind)->facts(work);
  g_auto(GStrv) lines = g_strsplit(facts, "\n", -1);
  g_autofree char *line = g_strjoinv("; ", lines);
  spore_window_log(self, "%s", line);
}

/* Showing. */

/* Of what the work has come to, or what it gave. */
static SporeStageCandidate *candidate_of(SporeWindow *self, SporeQuality *quality) {
  const SporeGenerateWork *work = spore_generator_get_result(self->generator);
  SporeObject *body = spore_generator_get_body(self->generator);
  SporeJob *job = spore_generator_get_job(self->generator);
  if (!body || (!work && !job)) return NULL;
  SporeStageCandidate *candidate = g_new0(SporeStageCandidate, 1);
  candidate->body = spore_object_id(body);
  candidate->chosen = G_MAXSIZE;
  if (!work) {
    candidate->spheres = spore_job_get_look(job, &candidate->sphere_count);
    return candidate;
  }
  gsize which = spore_generator_panel_get_quality(SPORE_GENERATOR_PANEL(self->generator_panel));
  spore_quality_of(work, which, quality);
  const SporeGenerateQuality *shown = &spore_generate_type(work->options.kind)->qualities[which];
  if (quality->count) shown->show(work, spore_quality_places(quality), candidate);
  return candidate;
}

static void show_candidate(SporeWindow *self) {
  SporeQuality quality = {0};
  SporeStageCandidate *candidate = candidate_of(self, &quality);
  spore_viewport_set_candidate(SPORE_VIEWPORT(self->viewport), candidate, &quality);
  spore_quality_clear(&quality);
}

static void changed(SporeWindow *self) {
  show_candidate(self);
  spore_window_show_job(self);
  spore_window_update_actions(self);
}

void spore_window_set_generator(SporeWindow *self) {
  if (self->generator) g_signal_handlers_disconnect_by_data(self->generator, self);
  g_clear_object(&self->generator);
  if (self->document) self->generator = spore_generator_new(self->document);
  spore_generator_panel_set_generator(SPORE_GENERATOR_PANEL(self->generator_panel), self->generator);
  if (!self->generator) return;
  g_signal_connect_object(self->generator, "changed", G_CALLBACK(changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->generator, "failed", G_CALLBACK(spore_window_complain), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->generator, "applied", G_CALLBACK(applied), self, G_CONNECT_SWAPPED);
}

void spore_window_update_generator(SporeWindow *self, gboolean bodies) {
  gboolean idle = !self->job && !spore_generator_is_working(self->generator);
  for (SporeGenerateKind kind = 0; kind < SPORE_GENERATE_KIND_COUNT; kind++) {
    g_autofree char *generate = g_strconcat("generate-", spore_generate_type(kind)->name, NULL);
    g_autofree char *preview = g_strconcat("preview-", spore_generate_type(kind)->name, NULL);
    spore_window_set_enabled(self, generate, idle && bodies);
    spore_window_set_enabled(self, preview, !self->job && bodies);
  }
  spore_window_set_enabled(self, "apply-generated", spore_generator_get_result(self->generator) != NULL);
  spore_window_set_enabled(self, "cancel-job", self->job || spore_generator_is_active(self->generator));
}

void spore_window_add_generator_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"generate-spheres", act_generate, "u"},  {"generate-tetrahedra", act_generate, "u"},
      {"generate-curve", act_generate, "u"},    {"generate-surface", act_generate, "u"},
      {"preview-spheres", act_preview, "u"},    {"preview-tetrahedra", act_preview, "u"},
      {"preview-curve", act_preview, "u"},      {"preview-surface", act_preview, "u"},
      {"apply-generated", act_apply_generated}, {"cancel-job", act_cancel_job},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  g_signal_connect_object(self->generator_panel, "shown-quality-changed", G_CALLBACK(show_candidate), self,
                          G_CONNECT_SWAPPED);
}
