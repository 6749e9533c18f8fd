/* How a patient lies: where gravity pulls, in the axes that the import gives meshes and label maps whose frame is RAS
 * or LPS: x to the patient's right, y to the head, z to the back (core/io/mesh_import.h). No GTK. */
#ifndef SPORE_AUTHOR_PATIENT_POSITIONS_H
#define SPORE_AUTHOR_PATIENT_POSITIONS_H

#include "core/scene/document.h"

typedef struct SporePatientPosition {
  const char *name, *label; /* label: translatable */
  SporeVec3 down;           /* unit vector */
} SporePatientPosition;

/* supine, prone, left_lateral (on the left side), right_lateral, trendelenburg (on the back, the head 15 degrees down),
 * reverse_trendelenburg (the head 15 degrees up), upright; NULL-terminated by name. */
extern const SporePatientPosition spore_patient_positions[];

/* Turns gravity as it pulls on a patient who lies so, as one undo step; its strength stays, or is that of the earth
 * where there was none. FALSE with a GError that lists the names: there is no such position. */
gboolean spore_edit_lay_patient(SporeDocument *document, const char *name, GError **error);
/* The position that gravity agrees with, to a tenth of a degree; NULL: none. */
const SporePatientPosition *spore_patient_position_of(const SporeDocument *document);

#endif
