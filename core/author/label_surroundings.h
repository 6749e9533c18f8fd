/* Labels of a map that are not made soft, as unmovable surfaces of a scene. */
#ifndef SPORE_AUTHOR_LABEL_SURROUNDINGS_H
#define SPORE_AUTHOR_LABEL_SURROUNDINGS_H

#include "core/generate/labels/labels.h"
#include "core/scene/document.h"

typedef struct SporeLabelSurrounding {
  SporeLabelSurface surface;
  char *name;       /* of the body */
  gboolean guessed; /* the name is a guess */
} SporeLabelSurrounding;

/* GArray of SporeLabelSurrounding, which frees surfaces and names. */
GArray *spore_label_surroundings_new(void);
/* Makes the surfaces of all of them. FALSE with an error: as spore_label_surfaces. */
gboolean spore_label_surroundings_make(GArray *surroundings, const SporeLabelMap *map, const SporeProgress *progress,
                                       GError **error);

/* Adds an unmovable body for each surface, with a mesh that it shows. One step of undo. FALSE with an error: nothing is
 * added; cancelled, too. */
gboolean spore_edit_add_surroundings(SporeDocument *document, SporeLabelSurrounding *surroundings, gsize count,
                                     const SporeProgress *progress, GError **error);

#endif
