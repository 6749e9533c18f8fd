/* Marks on a body before it moves: its regions, and the worst place of its mapping. No GTK. */
#ifndef SPORE_UI_DOCUMENT_BODY_MARKS_H
#define SPORE_UI_DOCUMENT_BODY_MARKS_H

#include "ui/document/mapping-report.h"

/* Those of the regions of the body, its spheres and its tetrahedra (spore_region_marks); and a cross at the worst place
 * of the mapping, where the report is up to date. Segments of 2 points of 3 in the body's axes, m. g_free; *count
 * segments. */
double *spore_body_marks(SporeDocument *document, SporeObject *body, const SporeMappingReport *report, gsize *count);

#endif
