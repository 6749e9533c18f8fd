/* How well the mappings of a body follow it, for what is drawn and for its spheres; in words. No GTK. */
#ifndef SPORE_UI_DOCUMENT_MAPPING_REPORT_H
#define SPORE_UI_DOCUMENT_MAPPING_REPORT_H

#include "core/base/progress.h"
#include "core/scene/mapping_quality.h"

typedef struct SporeMappingReport {
  guint32 body;     /* object id; 0: nothing was measured */
  guint64 revision; /* of the document that was measured */
  gboolean known[SPORE_MAPPED_UNITS];
  SporeMappingQuality quality[SPORE_MAPPED_UNITS];
  char *trouble; /* why nothing could be; NULL: it was */
} SporeMappingReport;

/* Compiles the scene, which may take long, and fills the report of the body that the report names. On any thread that
 * owns the document. FALSE: cancelled. */
gboolean spore_mapping_report_measure(SporeMappingReport *report, SporeDocument *document, SporeObject *body,
                                      const SporeProgress *progress, GError **error);
void spore_mapping_report_clear(SporeMappingReport *report);
/* Whether the report is of this body, as the document is now. */
gboolean spore_mapping_report_holds(const SporeMappingReport *report, const SporeDocument *document,
                                    const SporeObject *body);
/* Translated, a line each. g_free. */
char *spore_mapping_report_text(const SporeMappingReport *report);
/* The vertex or sphere that is farthest off; FALSE: none. size: of the geometry that moves the body, m. */
gboolean spore_mapping_report_worst(const SporeMappingReport *report, SporeVec3 *place, double *size);

#endif
