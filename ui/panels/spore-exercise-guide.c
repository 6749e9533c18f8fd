/* The exercise as a trainee sees it, over the picture. */
#include "ui/panels/spore-exercise-guide.h"

#include <glib/gi18n.h>

#include "core/author/exercise_edits.h"
#include "ui/panels/exercise-look.h"
#include "ui/panels/exercise-rows.h"

#define REFRESH_MS 100
#define AROUND_STEP 2 /* rows that are in sight above the current step */

struct _SporeExerciseGuide {
  GtkBox parent;
  GtkWidget *phase, *clock, *score, *errors, *told, *scroller, *steps;
  SporeEditorDocument *document;
  SporePlayer *player;
  gboolean wanted;
  guint timer;        /* while it is shown */
  GtkWidget *current; /* row that was scrolled to; only compared */
};

G_DEFINE_FINAL_TYPE(SporeExerciseGuide, spore_exercise_guide, GTK_TYPE_BOX)

static const SporeObject *section_of(SporeExerciseGuide *self) {
  return spore_document_section(spore_editor_document_get(self->document), "exercise");
}

static void set_text(GtkWidget *label, const char *text) {
  if (g_strcmp0(gtk_label_get_text(GTK_LABEL(label)), text) != 0) gtk_label_set_text(GTK_LABEL(label), text);
}

/* The run. look: NULL: there is none. */

/* Brings the row that is to be done into sight. */
static void scroll_to(SporeExerciseGuide *self, GtkWidget *row) {
  int y;
  if (!row || row == self->current) return;
  int height = gtk_widget_get_allocated_height(row);
  if (height <= 1 || !gtk_widget_translate_coordinates(row, self->steps, 0, 0, NULL, &y)) return; /* not laid out yet */
  self->current = row;
  GtkAdjustment *place = gtk_scrolled_window_get_vadjustment(GTK_SCROLLED_WINDOW(self->scroller));
  gtk_adjustment_set_value(place, y - AROUND_STEP * height);
}

static void show_steps(SporeExerciseGuide *self, const SporeExerciseLook *look) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_autoptr(GList) rows = gtk_container_get_children(GTK_CONTAINER(self->steps));
  GtkWidget *current = NULL;
  for (GList *row = rows; row; row = row->next) {
    const SporeObject *step = spore_document_by_id(document, spore_exercise_row_id(row->data));
    const SporeStepState *state = look && step ? spore_exercise_look_step(look, spore_object_name(step)) : NULL;
    spore_step_row_show(row->data, state);
    if (!current && state && state->phase == SPORE_STEP_OPEN) current = row->data;
  }
  scroll_to(self, current);
}

/* How it stands, as a heading. */
static char *heading_of(const SporeExerciseLook *look) {
  g_autofree char *phase = spore_exercise_look_phase(look), *steps = spore_exercise_look_steps(look);
  if (look->state.phase == SPORE_EXERCISE_RUNNING) return g_strdup_printf("%s, %s", phase, steps);
  return g_strdup_printf("%s, %s, %s", phase, look->state.passed ? _("passed") : _("not passed"), steps);
}

static void show_figures(SporeExerciseGuide *self, const SporeExerciseLook *look) {
  g_autofree char *heading = look ? heading_of(look) : g_strdup(_("Play begins the exercise"));
  g_autofree char *clock = look ? spore_exercise_look_clock(look, section_of(self)) : g_strdup("–");
  g_autofree char *score = look ? g_strdup_printf("%.1f", look->state.score) : g_strdup("–");
  g_autofree char *errors = look ? g_strdup_printf("%llu", (unsigned long long)look->state.errors) : g_strdup("–");
  set_text(self->phase, heading);
  set_text(self->clock, clock);
  set_text(self->score, score);
  set_text(self->errors, errors);
  set_text(self->told, spore_exercise_look_told(look, section_of(self)));
  gtk_widget_set_visible(self->told, *gtk_label_get_text(GTK_LABEL(self->told)) != '\0');
}

static void show_run(SporeExerciseGuide *self) {
  g_auto(SporeExerciseLook) look = {0};
  gboolean runs = spore_exercise_look_take(spore_player_get_session(self->player), &look);
  show_figures(self, runs ? &look : NULL);
  show_steps(self, runs ? &look : NULL);
}

static gboolean tick(gpointer data) {
  show_run(data);
  return G_SOURCE_CONTINUE;
}

/* The document. */

static void build_steps(SporeExerciseGuide *self) {
  const SporeObject *section = section_of(self);
  guint number = 1;
  self->current = NULL;
  gtk_container_foreach(GTK_CONTAINER(self->steps), (GtkCallback)(void (*)(void))gtk_widget_destroy, NULL);
  for (guint i = 0; i < spore_object_child_count(section); i++) {
    const SporeObject *part = spore_object_child(section, i);
    if (!spore_step_is(part)) continue;
    GtkWidget *row = spore_step_row_new(part);
    spore_step_row_refresh(row, part, number++);
    gtk_container_add(GTK_CONTAINER(self->steps), row);
  }
}

/* Costs nothing while it is not shown. */
static void update(SporeExerciseGuide *self) {
  gboolean shown = self->wanted && self->document && spore_object_child_count(section_of(self)) > 0;
  gtk_widget_set_visible(GTK_WIDGET(self), shown);
  if (shown) {
    build_steps(self);
    show_run(self);
    if (!self->timer) self->timer = g_timeout_add(REFRESH_MS, tick, self);
  } else {
    g_clear_handle_id(&self->timer, g_source_remove);
  }
}

void spore_exercise_guide_set_wanted(SporeExerciseGuide *self, gboolean wanted) {
  self->wanted = wanted;
  update(self);
}

static void release_document(SporeExerciseGuide *self) {
  g_clear_handle_id(&self->timer, g_source_remove);
  if (self->document) g_signal_handlers_disconnect_by_data(self->document, self);
  g_clear_object(&self->player);
  g_clear_object(&self->document);
}

void spore_exercise_guide_set_document(SporeExerciseGuide *self, SporeEditorDocument *document, SporePlayer *player) {
  release_document(self);
  self->document = g_object_ref(document);
  self->player = g_object_ref(player);
  g_signal_connect_object(document, "changed", G_CALLBACK(update), self, G_CONNECT_SWAPPED);
  update(self);
}

/* Life. */

static void spore_exercise_guide_dispose(GObject *object) {
  release_document(SPORE_EXERCISE_GUIDE(object));
  G_OBJECT_CLASS(spore_exercise_guide_parent_class)->dispose(object);
}

static void spore_exercise_guide_class_init(SporeExerciseGuideClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_exercise_guide_dispose;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-exercise-guide.ui");
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, phase);
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, clock);
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, score);
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, errors);
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, told);
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, scroller);
  gtk_widget_class_bind_template_child(widget, SporeExerciseGuide, steps);
}

static void spore_exercise_guide_init(SporeExerciseGuide *self) { gtk_widget_init_template(GTK_WIDGET(self)); }
