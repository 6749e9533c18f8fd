/* Generators: starting them, places that are picked for them, applying results and showing them. */
#include <glib/gi18n.h>

#include "core/scene/generated.h"
#include "core/author/edits.h"
#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"
#include "ui/spore-window-private.h"

#define USUAL_LABEL_CELLS 5000
#define LOOK_REST 4 /* time between pictures of running work, as a multiple of the time of a picture */

static void show_candidate(SporeWindow *self);

static SporeDocument *document_of(SporeWindow *self) { return spore_editor_document_get(self->document); }

/* Starting. */

/* What the user asked for, kept while a dialog asks whether edits may be replaced. */
typedef struct {
  SporeWindow *window;
  SporeGenerateKind kind;
  guint count; /* 0: as the body's asset says */
  gboolean apply;
} Request;

static void preview(SporeWindow *self, SporeObject *body, const SporeGenerateOptions *options, gboolean apply) {
  g_autoptr(GError) error = NULL;
  if (self->job) {
    spore_window_complain_work(self);
    return;
  }
  if (!spore_generator_is_active(self->generator)) spore_recovery_keep(self->recovery, self->document, NULL);
  g_action_group_change_action_state(G_ACTION_GROUP(self), "tool", g_variant_new_string("select"));
  if (!spore_generator_preview(self->generator, body, options, &error)) spore_window_failed(self, error);
  else if (apply) spore_generator_apply_when_done(self->generator);
  else spore_window_show_tab(self, self->generator_panel);
}

static void begin(const Request *request) {
  SporeWindow *self = request->window;
  SporeObject *body = spore_window_body_to_work_on(self);
  if (!body) return;
  SporeGenerateOptions options = spore_generate_options_of(document_of(self), body, request->kind);
  if (request->count) spore_generate_set_count(&options, request->count);
  preview(self, body, &options, request->apply);
}

static void answered(GtkDialog *dialog, int response, Request *request) {
  if (response == GTK_RESPONSE_ACCEPT) begin(request);
  gtk_widget_destroy(GTK_WIDGET(dialog));
}

static void free_request(gpointer data, GClosure *closure) { g_free(data); }

/* Assets that were edited by hand are replaced only after a question. */
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

/* Previews the label map that the body's tetrahedra were made from, with the same options. */
static void preview_label_map(SporeWindow *self, SporeObject *body, SporeObject *map, guint count) {
  g_autoptr(GError) error = NULL;
  g_autoptr(GBytes) content = spore_document_read_asset(document_of(self), spore_object_text(map, "file"), &error);
  if (!content) {
    spore_window_failed(self, error);
    return;
  }
  SporeLabelSource *source = spore_label_source_new_of(spore_object_text(map, "file"), content);
  SporeGenerateOptions options = {.kind = SPORE_GENERATE_LABELS, .labels = source, .listing = TRUE};
  spore_object_fields(spore_edit_body_tetrahedra(document_of(self), body), &options.fields);
  if (count) spore_generate_set_count(&options, count);
  preview(self, NULL, &options, FALSE);
  spore_label_source_unref(source);
}

static void start(SporeWindow *self, SporeGenerateKind kind, guint count, gboolean apply) {
  Request request = {self, kind, count, apply};
  SporeObject *body = spore_window_body_to_work_on(self);
  SporeObject *asset = body ? spore_generate_target(document_of(self), body, kind) : NULL;
  SporeObject *map =
      body && kind == SPORE_GENERATE_TETRAHEDRA ? spore_edit_body_label_map(document_of(self), body) : NULL;
  if (map) {
    preview_label_map(self, body, map, count);
    return;
  }
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
  while (!g_str_equal(spore_generators[kind]->name, name)) kind++;
  return kind;
}

static void act_generate(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, kind_of(action), MAX(1, g_variant_get_uint32(parameter)), TRUE);
}

static void act_preview(GSimpleAction *action, GVariant *parameter, gpointer data) {
  start(data, kind_of(action), g_variant_get_uint32(parameter), FALSE);
}

void spore_window_preview_labels(SporeWindow *self, const char *file) {
  SporeLabelSource *source = spore_label_source_new(file);
  SporeGenerateOptions options = {.kind = SPORE_GENERATE_LABELS, .labels = source, .listing = TRUE};
  spore_generate_set_initial(&options);
  spore_generate_set_count(&options, USUAL_LABEL_CELLS);
  preview(self, NULL, &options, FALSE);
  spore_label_source_unref(source);
}

static void act_preview_labels(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_window_preview_labels(data, g_variant_get_string(parameter, NULL));
}

static void act_preview_labels_dialog(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GtkFileChooserNative) native = gtk_file_chooser_native_new(
      _("Choose a label map"), GTK_WINDOW(self), GTK_FILE_CHOOSER_ACTION_OPEN, _("_Open"), _("_Cancel"));
  GtkFileFilter *filter = gtk_file_filter_new();
  gtk_file_filter_set_name(filter, _("Label maps: NIfTI, NRRD"));
  for (const char *const *pattern = (const char *const[]){"*.nii", "*.nii.gz", "*.nrrd", "*.nhdr", "*.hdr", NULL};
       *pattern; pattern++)
    gtk_file_filter_add_pattern(filter, *pattern);
  gtk_file_chooser_add_filter(GTK_FILE_CHOOSER(native), filter);
  if (gtk_native_dialog_run(GTK_NATIVE_DIALOG(native)) != GTK_RESPONSE_ACCEPT) return;
  g_autofree char *file = gtk_file_chooser_get_filename(GTK_FILE_CHOOSER(native));
  if (file) spore_window_preview_labels(self, file);
}

/* Places picked by hand. */

static void set_picking(SporeWindow *self, gboolean picking) {
  g_action_group_change_action_state(G_ACTION_GROUP(self), "pick-places", g_variant_new_boolean(picking));
}

/* Those picked so far, else those that the options have. */
static void show_places(SporeWindow *self) {
  SporeViewportPlaces places = {0};
  SporeObject *body = spore_generator_get_body(self->generator);
  const SporeGenerateOptions *options = spore_generator_get_options(self->generator);
  if (spore_window_is_picking(self)) places = self->picked;
  else if (body && spore_generate_get_places(options, places.at)) places.count = spore_generate_place_count(options);
  places.body = body ? spore_object_id(body) : 0;
  spore_viewport_set_places(SPORE_VIEWPORT(self->viewport), &places);
}

static void change_pick_places(GSimpleAction *action, GVariant *state, gpointer data) {
  SporeWindow *self = data;
  gboolean picking = g_variant_get_boolean(state) && spore_window_picks_places(self);
  g_simple_action_set_state(action, g_variant_new_boolean(picking));
  self->picked = (SporeViewportPlaces){0};
  spore_window_end_pick(self);
  spore_viewport_set_picking(SPORE_VIEWPORT(self->viewport), picking);
  show_places(self);
  show_candidate(self);
  spore_window_update_actions(self);
  spore_window_show_hint(self);
}

/* places NULL: those that the generator finds. */
static void set_places(SporeWindow *self, double places[SPORE_GENERATOR_PLACES][3]) {
  g_autoptr(GError) error = NULL;
  SporeGenerateOptions options = *spore_generator_get_options(self->generator);
  spore_generate_set_places(&options, places);
  if (!spore_generator_preview(self->generator, spore_generator_get_body(self->generator), &options, &error))
    spore_window_failed(self, error);
}

static void act_automatic_places(GSimpleAction *action, GVariant *parameter, gpointer data) {
  if (spore_window_picks_places(data)) set_places(data, NULL);
}

static void picked(SporeWindow *self, guint id, const SporeVec3 *place) {
  SporeObject *body = spore_generator_get_body(self->generator);
  if (!spore_window_is_picking(self) || !body || !id) return;
  spore_window_mend(self, SPORE_CAUSE_PICK);
  if (spore_object_id(body) != id) {
    g_autofree char *text = g_strdup_printf(_("That is another organ; click on “%s”"), spore_object_name(body));
    spore_window_complain_while(self, SPORE_CAUSE_PICK, text, NULL, NULL);
    return;
  }
  SporeViewportPlaces all = self->picked;
  spore_vec3_store(all.at[all.count++], spore_pose_apply_inverse(spore_body_pose(body), *place));
  self->picked = all;
  if (all.count < spore_generate_place_count(spore_generator_get_options(self->generator))) {
    show_places(self);
    spore_window_show_hint(self);
    return;
  }
  set_picking(self, FALSE);
  set_places(self, all.at);
}

static void places_moved(SporeWindow *self, SporeViewportPlaces *places) {
  if (spore_window_is_picking(self)) self->picked = *places;
  else if (spore_window_picks_places(self)) set_places(self, places->at);
}

/* The panel says why a preview that goes on has no result. Where a generator has found no places of its own, they are
 * picked. */
static void generator_failed(SporeWindow *self, const char *message) {
  double given[SPORE_GENERATOR_PLACES][3];
  const SporeGenerateOptions *options = spore_generator_get_options(self->generator);
  if (!spore_generator_is_active(self->generator)) {
    spore_window_complain(self, message);
    return;
  }
  spore_window_show_tab(self, self->generator_panel);
  const SporeGeneratorPlaces *places = spore_generators[options->kind]->places;
  gboolean asks = places && places->asked && !spore_generate_get_places(options, given);
  if (asks && !spore_window_is_picking(self)) set_picking(self, TRUE);
}

/* Ending. */

static void act_apply_generated(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  g_autoptr(GError) error = NULL;
  if (!spore_generator_apply(self->generator, &error)) spore_window_failed(self, error);
}

static void act_make_labels(GSimpleAction *action, GVariant *parameter, gpointer data) {
  spore_generator_make(((SporeWindow *)data)->generator);
}

static void act_cancel_job(GSimpleAction *action, GVariant *parameter, gpointer data) {
  SporeWindow *self = data;
  if (self->job) spore_job_cancel(self->job);
  spore_generator_cancel(self->generator);
  spore_player_cancel(self->player);
}

static void applied(SporeWindow *self) {
  const SporeGenerateWork *work = spore_generator_get_result(self->generator);
  if (work->options.kind == SPORE_GENERATE_SPHERES)
    g_action_group_change_action_state(G_ACTION_GROUP(self), "show-spheres", g_variant_new_boolean(TRUE));
  g_autofree char *facts = spore_generators[work->options.kind]->facts(work);
  g_auto(GStrv) lines = g_strsplit(facts, "\n", -1);
  g_autofree char *line = g_strjoinv("; ", lines);
  spore_window_log(self, "%s", line);
}

/* Showing. */

/* The candidate of the running work, or of its result. */
static SporeStageCandidate *candidate_of(SporeWindow *self, SporeQuality *quality) {
  const SporeGenerateWork *work = spore_generator_get_result(self->generator);
  SporeObject *body = spore_generator_get_body(self->generator);
  SporeJob *job = spore_generator_get_job(self->generator);
  /* While places are picked, the organ is shown. */
  if (spore_window_is_picking(self) || !spore_generator_is_active(self->generator) || (!work && !job)) return NULL;
  SporeStageCandidate *candidate = g_new0(SporeStageCandidate, 1);
  candidate->body = body ? spore_object_id(body) : 0;
  candidate->chosen = G_MAXSIZE;
  if (!work) {
    candidate->spheres = spore_job_get_look(job, &candidate->sphere_count);
    return candidate;
  }
  gsize which = spore_generator_panel_get_quality(SPORE_GENERATOR_PANEL(self->generator_panel));
  spore_quality_of(work, which, quality);
  const SporeGenerateQuality *shown = &spore_generate_type(work->options.kind)->qualities[which];
  candidate->view = spore_generator_panel_get_view(SPORE_GENERATOR_PANEL(self->generator_panel), &work->tetrahedra);
  if (quality->count) shown->show(work, spore_quality_places(quality), candidate);
  return candidate;
}

/* Where nothing was shown before, the view moves to the candidate. */
static void frame_first(SporeWindow *self, const SporeStageCandidate *candidate) {
  gboolean apart = candidate && !candidate->body && candidate->vertex_count;
  if (apart && !self->framed_apart) spore_viewport_frame(SPORE_VIEWPORT(self->viewport));
  if (apart || !spore_generator_is_active(self->generator)) self->framed_apart = apart;
}

static void show_candidate(SporeWindow *self) {
  SporeQuality quality = {0};
  SporeStageCandidate *candidate = candidate_of(self, &quality);
  spore_viewport_set_candidate(SPORE_VIEWPORT(self->viewport), candidate, &quality);
  frame_first(self, candidate);
  spore_quality_clear(&quality);
}

/* A job reports progress more often than its look changes, and more often than the look can be drawn. */
static gboolean shows_look_already(SporeWindow *self) {
  SporeJob *job = spore_generator_get_job(self->generator);
  gboolean same =
      job && job == self->look_job && !spore_generator_get_result(self->generator) && !spore_window_is_picking(self);
  guint serial = job ? spore_job_get_look_serial(job) : 0;
  gint64 now = g_get_monotonic_time();
  double rest_ms = LOOK_REST * spore_viewport_get_draw_ms(SPORE_VIEWPORT(self->viewport));
  if (same && (serial == self->look_serial || (double)(now - self->look_time) < 1e3 * rest_ms)) return TRUE;
  self->look_job = job;
  self->look_serial = serial;
  self->look_time = now;
  return FALSE;
}

static void changed(SporeWindow *self) {
  if (spore_window_is_picking(self) && !spore_window_picks_places(self)) set_picking(self, FALSE);
  show_places(self);
  if (!shows_look_already(self)) show_candidate(self);
  spore_window_show_job(self);
  if (!self->job && !spore_generator_is_working(self->generator)) spore_window_mend(self, SPORE_CAUSE_WORK);
  spore_window_update_actions(self);
}

void spore_window_set_generator(SporeWindow *self) {
  if (self->generator) g_signal_handlers_disconnect_by_data(self->generator, self);
  g_clear_object(&self->generator);
  if (self->document) self->generator = spore_generator_new(self->document);
  spore_generator_panel_set_generator(SPORE_GENERATOR_PANEL(self->generator_panel), self->generator);
  if (!self->generator) return;
  g_signal_connect_object(self->generator, "changed", G_CALLBACK(changed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->generator, "failed", G_CALLBACK(generator_failed), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->generator, "applied", G_CALLBACK(applied), self, G_CONNECT_SWAPPED);
}

void spore_window_add_generator_actions(SporeWindow *self) {
  static const GActionEntry actions[] = {
      {"apply-generated", act_apply_generated},
      {"cancel-job", act_cancel_job},
      {"preview-labels", act_preview_labels, "s"},
      {"preview-labels-dialog", act_preview_labels_dialog},
      {"make-labels", act_make_labels},
      {"automatic-places", act_automatic_places},
      {"pick-places", NULL, NULL, "false", change_pick_places},
  };
  g_action_map_add_action_entries(G_ACTION_MAP(self), actions, G_N_ELEMENTS(actions), self);
  for (SporeGenerateKind kind = 0; spore_generators[kind]; kind++) {
    g_autofree char *generate = g_strconcat("generate-", spore_generators[kind]->name, NULL);
    g_autofree char *preview = g_strconcat("preview-", spore_generators[kind]->name, NULL);
    const GActionEntry of_body[] = {{generate, act_generate, "u"}, {preview, act_preview, "u"}};
    if (kind != SPORE_GENERATE_LABELS)
      g_action_map_add_action_entries(G_ACTION_MAP(self), of_body, G_N_ELEMENTS(of_body), self);
  }
  g_signal_connect_object(self->viewport, "picked", G_CALLBACK(picked), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->viewport, "places-moved", G_CALLBACK(places_moved), self, G_CONNECT_SWAPPED);
  g_signal_connect_object(self->generator_panel, "shown-quality-changed", G_CALLBACK(show_candidate), self,
                          G_CONNECT_SWAPPED);
}
