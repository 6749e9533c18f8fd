/* What a trainee sees of the exercise over the picture: time, score and errors so far, what to do now, and the steps.
 * The exercise panel shows its author the same. Hidden where the scene has no exercise. */
#ifndef SPORE_UI_PANELS_SPORE_EXERCISE_GUIDE_H
#define SPORE_UI_PANELS_SPORE_EXERCISE_GUIDE_H

#include <gtk/gtk.h>

#include "ui/sim/spore-player.h"

G_BEGIN_DECLS

#define SPORE_TYPE_EXERCISE_GUIDE spore_exercise_guide_get_type()
G_DECLARE_FINAL_TYPE(SporeExerciseGuide, spore_exercise_guide, SPORE, EXERCISE_GUIDE, GtkBox)

void spore_exercise_guide_set_document(SporeExerciseGuide *self, SporeEditorDocument *document, SporePlayer *player);
/* Whether it is shown where there is an exercise; at first it is not. */
void spore_exercise_guide_set_wanted(SporeExerciseGuide *self, gboolean wanted);

G_END_DECLS
#endif
