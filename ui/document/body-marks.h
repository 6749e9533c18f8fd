/* What is pointed out on a body before it moves: where its regions are, and the worst place of its mapping. No GTK. */
#ifndef SPORE_UI_DOCUMENT_BODY_MARKS_H
#define SPORE_UI_DOCUMENT_BODY_MARKS_H

#include "ui/document/mapping-report.h"

/* Rings around the regions of the body, its spheres and its tetrahedra, and a cross where what is carried along lies
 * farthest off, where the report holds: segments of 2 points of 3 in the body's axes, m. g_free; *count segments. */
double *spore_body_marks(SporeDocument *document, SporeObject *body, const SporeMappingReport *report, gsize *count);

#endif
