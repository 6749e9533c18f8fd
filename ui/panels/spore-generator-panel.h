/* The panel of a generator at work: options, quality of the result, Apply and Cancel.
 *
 * Signals
 *   shown-quality-changed ()   the user chose another quality to look at                                            */
#ifndef SPORE_UI_PANELS_SPORE_GENERATOR_PANEL_H
#define SPORE_UI_PANELS_SPORE_GENERATOR_PANEL_H

#include <gtk/gtk.h>

#include "core/mesh/cell_faces.h"
#include "ui/jobs/spore-generator.h"

G_BEGIN_DECLS

#define SPORE_TYPE_GENERATOR_PANEL spore_generator_panel_get_type()
G_DECLARE_FINAL_TYPE(SporeGeneratorPanel, spore_generator_panel, SPORE, GENERATOR_PANEL, GtkBox)

void spore_generator_panel_set_generator(SporeGeneratorPanel *self, SporeGenerator *generator);
/* Which of the qualities of the result's kind (quality.h). */
gsize spore_generator_panel_get_quality(SporeGeneratorPanel *self);
/* How the cells of this mesh are shown: whole, cut open, or drawn apart. */
SporeCellView spore_generator_panel_get_view(SporeGeneratorPanel *self, const SporeTetrahedralMesh *mesh);

G_END_DECLS
#endif
