/* What each action needs before it can be done. */
#include <glib/gi18n.h>

#include "core/author/exercise_edits.h"
#include "core/author/patient_positions.h"
#include "core/author/soft_edits.h"
#include "core/scene/kept_pose.h"
#include "core/scene/port_reach.h"
#include "ui/document/hands.h"
#include "ui/spore-window-private.h"

/* What an action may need, as bits. */
typedef guint64 Need;
#define NEED(bit) ((Need)1 << (bit))
#define IDLE NEED(0)
#define JOBLESS NEED(1)
#define BODIES NEED(2)
#define SESSION NEED(3)
#define STILL NEED(4)
#define PLAYING NEED(5)
#define UNDO NEED(6)
#define REDO NEED(7)
#define UNSAVED NEED(8)
#define NAMED NEED(9)
#define ALONE NEED(10)
#define SOFT NEED(11)
#define BODY NEED(12)
#define HIDDEN NEED(13)
#define LINK NEED(14)
#define STEP NEED(15)
#define PART NEED(16)
#define STUDY NEED(17)
#define POINT NEED(18)
#define UNMEASURED NEED(19)
#define PLACES NEED(20)
#define RESULT NEED(21)
#define LISTING NEED(22)
#define WORK NEED(23)
#define HANDS NEED(24)
#define DRAFT NEED(25)
#define PICKING NEED(26)
#define MEASURES NEED(27)
#define CAMERA NEED(28)
#define EXERCISE NEED(29)
#define PORTS NEED(30)
#define LOCKED NEED(32)
#define MISSING NEED(31)
#define POSE NEED(33)
#define MESSAGE NEED(34)

/* In the order in which they are told. */
static const struct {
  Need need;
  const char *missing; /* translatable */
} missing[] = {
    {IDLE | JOBLESS, N_("something else is being worked on; wait for it or cancel it")},
    {BODIES, N_("the scene has no body yet; import a mesh, or open the demo")},
    {SESSION, N_("nothing has been simulated yet; play first")},
    {STILL, N_("the scene is playing; pause it first")},
    {PLAYING, N_("the scene is not playing")},
    {UNDO, N_("there is nothing to undo")},
    {REDO, N_("there is nothing to redo")},
    {UNSAVED, N_("everything is saved")},
    {LINK, N_("select a link first")},
    {STEP, N_("select a step of the exercise first")},
    {PART, N_("select a step or a metric of the exercise first")},
    {SOFT, N_("select an organ first that is not soft yet")},
    {BODY, N_("select an organ first, in the outliner or in the view")},
    {NAMED, N_("select something first that has a name, in the outliner or in the view")},
    {ALONE, N_("select one thing alone first")},
    {HIDDEN, N_("nothing is hidden")},
    {LOCKED, N_("nothing is locked")},
    {MEASURES, N_("nothing is measured in the view")},
    {UNMEASURED, N_("the accuracy is being measured")},
    {STUDY, N_("measure the accuracy first")},
    {POINT, N_("measure the accuracy and choose a point first")},
    {PLACES, N_("preview a middle line or a sheet first")},
    {RESULT, N_("preview a generator first")},
    {LISTING, N_("open a label map first")},
    {WORK, N_("nothing is being worked on")},
    {DRAFT | PICKING, N_("nothing is being picked")},
    {HANDS, N_("the scene has no instrument yet; add one")},
    {CAMERA, N_("the scene has no camera yet; add an endoscope")},
    {PORTS, N_("no instrument passes through a port yet; add one with the place where it enters")},
    {MISSING, N_("no file of the scene is missing")},
    {POSE, N_("no pose was kept yet")},
    {MESSAGE, N_("no message is shown")},
    {EXERCISE, N_("the scene has no exercise yet; add a step in the Exercise tab")},
};

/* Those that need something. */
static const struct {
  const char *action;
  Need needs;
} needs[] = {
    {"fix", IDLE},
    {"fix-said", IDLE},
    {"close-message", MESSAGE},
    {"undo", UNDO},
    {"redo", REDO},
    {"save", UNSAVED},
    {"delete", NAMED},
    {"delete-alone", NAMED},
    {"keep-along", UNDO},
    {"move-row", NAMED},
    {"rename", NAMED | ALONE},
    {"rename-dialog", NAMED | ALONE},
    {"rename-row", NAMED},
    {"make-soft", IDLE | SOFT},
    {"add-level", IDLE | BODY},
    {"hide", BODY},
    {"isolate", BODY},
    {"show-all", HIDDEN},
    {"lock", BODY},
    {"put-in-folder", BODY},
    {"new-folder", BODY},
    {"unlock-all", LOCKED},
    {"measure", BODIES},
    {"clear-measures", MEASURES},
    {"select-organs", BODIES},
    {"add-pin", BODIES},
    {"add-link", BODIES},
    {"add-fluid", BODIES},
    {"gizmo", BODY},
    {"align", BODY},
    {"mirror", BODY},
    {"duplicate", BODY},
    {"tie-link", LINK},
    {"lead", HANDS},
    {"lead-next", HANDS},
    {"show-reach", PORTS | BODIES},
    {"colours", BODIES},
    {"box-select", BODIES},
    {"keep-scale", BODIES},
    {"swap-views", CAMERA | BODIES},
    {"second-view", CAMERA | BODIES},
    {"turn-optic", CAMERA},
    {"wipe-lens", SESSION | CAMERA},
    {"pick-back", PICKING},
    {"pick-done", DRAFT},
    {"show-guide", EXERCISE},
    {"add-step", BODIES},
    {"add-metric", BODIES},
    {"aim-step", STEP},
    {"skip-to-step", STEP | SESSION},
    {"move-part", PART},
    {"remove-part", PART},
    {"save-exercise", SESSION},
    {"save-exercise-dialog", SESSION},
    {"locate", IDLE},
    {"locate-dialog", IDLE | MISSING},
    {"import", IDLE},
    {"import-dialog", IDLE},
    {"import-dialog-with", IDLE},
    {"change-mesh", IDLE | BODIES},
    {"change-mesh-dialog", IDLE | BODIES},
    {"lay-picture", IDLE | BODIES},
    {"lay-picture-dialog", IDLE | BODIES},
    {"measure-mapping", IDLE | BODIES},
    {"preview-labels", JOBLESS},
    {"preview-labels-dialog", JOBLESS},
    {"pick-places", PLACES},
    {"automatic-places", PLACES},
    {"make-labels", LISTING},
    {"apply-generated", RESULT},
    {"cancel-job", WORK},
    {"play", BODIES | STILL},
    {"pause", PLAYING},
    {"play-pause", BODIES},
    {"step", BODIES | STILL},
    {"reset", SESSION},
    {"step-back", SESSION | STILL},
    {"go-to", SESSION},
    {"replay", SESSION},
    {"stay", SESSION},
    {"bookmark", SESSION},
    {"keep-pose", SESSION},
    {"forget-pose", POSE},
    {"save-recording", SESSION},
    {"keep-recording", SESSION},
    {"save-recording-dialog", SESSION},
    {"repeat-recording", BODIES},
    {"repeat-recording-dialog", BODIES},
    {"save-picture", BODIES},
    {"save-picture-dialog", BODIES},
    {"export", IDLE | BODIES},
    {"export-dialog", IDLE | BODIES},
    {"save-film", IDLE | SESSION},
    {"save-film-dialog", IDLE | SESSION},
    {"repeat-attempt", BODIES},
    {"film-attempts", IDLE},
    {"film-attempts-dialog", IDLE},
    {"save-numbers", SESSION},
    {"save-numbers-dialog", SESSION},
    {"save-plot", SESSION},
    {"save-plot-dialog", SESSION},
    {"watch", BODIES},
    {"measure-accuracy", BODIES | UNMEASURED},
    {"choose-point", STUDY},
    {"apply-point", POINT},
    {"save-study", STUDY},
    {"save-study-dialog", STUDY},
};

/* What is there now. */

gboolean spore_window_picks_places(SporeWindow *self) {
  return spore_generator_get_body(self->generator) &&
         spore_generators[spore_generator_get_options(self->generator)->kind]->places;
}

gboolean spore_window_is_picking(SporeWindow *self) {
  g_autoptr(GVariant) state = g_action_group_get_action_state(G_ACTION_GROUP(self), "pick-places");
  return g_variant_get_boolean(state);
}

static Need of_history(SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  gboolean unsaved =
      spore_editor_document_is_modified(self->document) || !spore_editor_document_get_save_file(self->document);
  return (spore_document_can_undo(document) ? UNDO : 0) | (spore_document_can_redo(document) ? REDO : 0) |
         (unsaved ? UNSAVED : 0);
}

static Need of_selection(SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  const SporeObject *selected = spore_editor_document_selected(self->document);
  g_autoptr(GPtrArray) bodies = spore_editor_document_selected_bodies(self->document);
  gsize count;
  spore_editor_document_get_selected(self->document, &count);
  gboolean soft = FALSE, step = spore_step_is(selected);
  for (guint i = 0; i < bodies->len; i++) soft = soft || spore_soft_may(document, bodies->pdata[i], NULL);
  return (selected && spore_object_name(selected) ? NAMED : 0) | (count == 1 ? ALONE : 0) | (soft ? SOFT : 0) |
         (bodies->len ? BODY : 0) | (spore_link_is(selected) ? LINK : 0) | (step ? STEP : 0) |
         (step || spore_metric_is(selected) ? PART : 0);
}

static Need of_work(SporeWindow *self) {
  gboolean places = spore_window_picks_places(self);
  const void *result = spore_generator_get_result(self->generator);
  gboolean works = self->job || spore_generator_is_active(self->generator) || spore_player_get_job(self->player);
  return (self->job ? 0 : JOBLESS) | (self->job || spore_generator_is_working(self->generator) ? 0 : IDLE) |
         (places ? PLACES : 0) | (result ? RESULT : 0) |
         (result && spore_generator_get_options(self->generator)->listing ? LISTING : 0) | (works ? WORK : 0);
}

static Need of_run(SporeWindow *self) {
  gboolean playing = spore_player_is_playing(self->player);
  return (spore_player_get_session(self->player) ? SESSION : 0) | (playing ? PLAYING : STILL);
}

static Need of_scene(SporeWindow *self) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GPtrArray) hands = spore_hands(document);
  g_autoptr(GArray) ports = spore_ports_of(document, NULL);
  gboolean measuring = spore_accuracy_is_measuring(SPORE_ACCURACY(self->accuracy));
  return (spore_object_child_count(spore_document_section(document, "bodies")) ? BODIES : 0) |
         (hands->len ? HANDS : 0) | (ports->len ? PORTS : 0) |
         (spore_object_child_of(spore_document_section(document, "tools"), "camera") ? CAMERA : 0) |
         (spore_object_child_count(spore_document_section(document, "exercise")) ? EXERCISE : 0) |
         (spore_document_kept_poses(document) ? POSE : 0) | (measuring ? 0 : UNMEASURED) |
         (self->missing ? MISSING : 0) | (spore_viewport_hidden_count(SPORE_VIEWPORT(self->viewport)) ? HIDDEN : 0) |
         (g_hash_table_size(spore_viewport_get_locked(SPORE_VIEWPORT(self->viewport))) ? LOCKED : 0) |
         (spore_viewport_measure_count(SPORE_VIEWPORT(self->viewport)) ? MEASURES : 0) |
         (spore_editor_document_get_study(self->document) ? STUDY : 0) |
         (spore_accuracy_can_apply(SPORE_ACCURACY(self->accuracy)) ? POINT : 0) |
         (self->draft.type                ? DRAFT | PICKING
          : spore_window_is_picking(self) ? PICKING
                                          : 0);
}

static Need of_messages(SporeWindow *self) {
  gboolean shown = gtk_widget_get_visible(self->message_bar) || gtk_widget_get_visible(self->missing_bar) ||
                   gtk_widget_get_visible(self->hold_bar);
  return shown ? MESSAGE : 0;
}

static Need there(SporeWindow *self) {
  return of_messages(self) | of_history(self) | of_selection(self) | of_work(self) | of_run(self) | of_scene(self);
}

/* What generators' actions need is the same for all of them, but for label maps, which need no body. */
static Need needs_of(const char *action) {
  for (gsize i = 0; i < G_N_ELEMENTS(needs); i++)
    if (g_str_equal(needs[i].action, action)) return needs[i].needs;
  if (g_str_has_prefix(action, "generate-")) return IDLE | BODIES;
  return g_str_has_prefix(action, "preview-") ? JOBLESS | BODIES : 0;
}

/* Gravity may be set in other ways, too. */
static void show_patient(SporeWindow *self) {
  const SporePatientPosition *position = spore_patient_position_of(spore_editor_document_get(self->document));
  GAction *action = g_action_map_lookup_action(G_ACTION_MAP(self), "patient");
  g_simple_action_set_state(G_SIMPLE_ACTION(action), g_variant_new_string(position ? position->name : ""));
}

void spore_window_update_actions(SporeWindow *self) {
  g_auto(GStrv) actions = g_action_group_list_actions(G_ACTION_GROUP(self));
  Need now = there(self);
  for (char **action = actions; *action; action++) {
    GAction *found = g_action_map_lookup_action(G_ACTION_MAP(self), *action);
    Need all = needs_of(*action);
    if (all) g_simple_action_set_enabled(G_SIMPLE_ACTION(found), (all & ~now) == 0);
  }
  show_patient(self);
}

const char *spore_window_missing(SporeWindow *self, const char *action) {
  Need lacks = needs_of(action) & ~there(self);
  for (gsize i = 0; i < G_N_ELEMENTS(missing); i++)
    if (missing[i].need & lacks) return _(missing[i].missing);
  return NULL;
}
