/* The exercise of the scene: its steps, metrics and settings, and while the scene plays the clock, what is done, the
 * figures and the score. What is selected here is selected in the document. */
#ifndef SPORE_UI_PANELS_SPORE_EXERCISE_H
#define SPORE_UI_PANELS_SPORE_EXERCISE_H

#include "ui/sim/spore-player.h"

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_EXERCISE_PANEL spore_exercise_panel_get_type()
G_DECLARE_FINAL_TYPE(SporeExercisePanel, spore_exercise_panel, SPORE, EXERCISE_PANEL, GtkBox)

void spore_exercise_panel_set_document(SporeExercisePanel *self, SporeEditorDocument *document, SporePlayer *player);
/* The kinds of steps and of metrics that can be added, as menus. Borrowed. */
GMenuModel *spore_exercise_panel_get_step_menu(SporeExercisePanel *self);
GMenuModel *spore_exercise_panel_get_metric_menu(SporeExercisePanel *self);
/* A try-out: the run goes on from that step. NULL, or a step that the run does not have: nothing happens. */
void spore_exercise_panel_skip(SporeExercisePanel *self, const SporeObject *step);
/* Writes the report of the run so far, of the kind that the file's name says. FALSE with a GError: no run, no exercise,
 * another kind of file, or it cannot be written. */
gboolean spore_exercise_panel_save(SporeExercisePanel *self, const char *file, GError **error);

G_END_DECLS
#endif
