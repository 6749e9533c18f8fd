#include <glib/gi18n.h>

#include "core/scene/generated.h"
#include "ui/document/edits.h"
#include "ui/jobs/quality.h"
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
  if (request->count && request->kind == SPORE_GENERATE_SPHERES) options.spheres.count = request->count;
  if (request->count && request->kind == SPORE_GENERATE_TETRAHEDRA) options.tetrahedra.cells = request->count;
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

static void act_generate_spheres(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, SPORE_GENERATE_SPHERES, MAX(1, g_variant_get_uint32(parameter)), TRUE);
}

static void act_generate_tetrahedra(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, SPORE_GENERATE_TETRAHEDRA, MAX(1, g_variant_get_uint32(parameter)), TRUE);
}

static void act_preview_spheres(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, SPORE_GENERATE_SPHERES, g_variant_get_uint32(parameter), FALSE);
}

static void act_preview_tetrahedra(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, SPORE_GENERATE_TETRAHEDRA, g_variant_get_uint32(parameter), FALSE);
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
  const SporeTetrahedraReport *tetrahedra = &work->tetrahedra_report;
  if (work->options.kind == SPORE_GENERATE_SPHERES) {
    g_action_group_change_action_state(G_ACTION_GROUP(self), "show-spheres", g_variant_new_boolean(TRUE));
    spore_window_log(self, _("%zu spheres in %.1f s: coverage %.1f %%, depth error %.1f %%"), work->spheres.count,
                     work->spheres_report.seconds, 100 * work->spheres_report.coverage,
                     100 * work->spheres_report.depth_error);
    return;
  }
  spore_window_log(self, _("%zu tetrahedra in %.1f s (%s): least angle %.1f°, error %.2f %%"),
                   work->tetrahedra.tetrahedron_count, tetrahedra->seconds,
                   spore_tetrahedra_method_names[tetrahedra->method], tetrahedra->quality.min_dihedral_deg,
                   100 * tetrahedra->hausdorff);
}

/* Showing. */

static float *places_of(const SporeQuality *quality) {
  float *places = g_new(float, quality->count);
  for (gsize i = 0; i < quality->count; i++) places[i] = (float)spore_quality_place(quality, i);
  return places;
}

static void take_surface(SporeStageCandidate *candidate, const SporeTriangleMesh *mesh, const SporeQuality *quality) {
  candidate->vertex_count = mesh->vertex_count;
  candidate->triangle_count = mesh->triangle_count;
  candidate->vertices = g_memdup2(mesh->vertices, 3 * mesh->vertex_count * sizeof(double));
  candidate->triangles = g_memdup2(mesh->triangles, 3 * mesh->triangle_count * sizeof(guint32));
  candidate->vertex_values = places_of(quality);
}

static void take_spheres(SporeStageCandidate *candidate, const SporeSphereSet *set, const SporeQuality *quality) {
  candidate->sphere_count = set->count;
  candidate->spheres = g_memdup2(set->spheres, 4 * set->count * sizeof(double));
  candidate->sphere_values = places_of(quality);
}

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
  spore_quality_of(work, spore_generator_panel_get_quality(SPORE_GENERATOR_PANEL(self->generator_panel)), quality);
  if (work->options.kind == SPORE_GENERATE_SPHERES && quality->of_surface)
    take_surface(candidate, &work->mesh, quality);
  else if (work->options.kind == SPORE_GENERATE_SPHERES) take_spheres(candidate, &work->spheres, quality);
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
  spore_window_set_enabled(self, "generate-spheres", idle && bodies);
  spore_window_set_enabled(self, "generate-tetrahedra", idle && bodies);
  spore_window_set_enabled(self, "preview-spheres", !self->job && bodies);
  spore_window_set_enabled(self, "preview-tetrahedra", !self->job && bodies);
  spore_window_set_enabled(self, "apply-generated", spore_generator_get_result(self->generator) != NULL);
  spore_window_set_enabled(self, "cancel-job", self->job || spore_generator_is_active(self->generator));
}

void spore_window_add_generator_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"generate-spheres", act_generate_spheres, "u"}, {"generate-tetrahedra", act_generate_tetrahedra, "u"},
      {"preview-spheres", act_preview_spheres, "u"},   {"preview-tetrahedra", act_preview_tetrahedra, "u"},
      {"apply-generated", act_apply_generated},        {"cancel-job", act_cancel_job},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  g_signal_connect_object(self->generator_panel, "shown-quality-changed", G_CALLBACK(show_candidate), self,
                          G_CONNECT_SWAPPED);
}
