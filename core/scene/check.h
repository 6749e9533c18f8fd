/* Checks of a scene: finds mistakes before the scene runs. */
#ifndef SPORE_SCENE_CHECK_H
#define SPORE_SCENE_CHECK_H

#include "core/base/cancel.h"
#include "core/scene/document.h"

typedef enum SporeSeverity { SPORE_NOTE, SPORE_WARNING, SPORE_FAULT } SporeSeverity;
/* What can be done about a diagnostic without asking. */
typedef enum SporeFix {
  SPORE_FIX_NONE,
  SPORE_FIX_HOLD,     /* pin the body: spore_edit_add_pin */
  SPORE_FIX_LOCATE,   /* ask where the missing file is: spore_locate_work_new */
  SPORE_FIX_SET,      /* set properties to a value, or back to their defaults */
  SPORE_FIX_REMOVE,   /* remove the object */
  SPORE_FIX_GENERATE, /* generate the asset again, or spheres of the body */
} SporeFix;
typedef struct SporeDiagnostic {
  SporeSeverity severity;
  SporeFix fix;
  guint32 object;                 /* object's id; 0: the whole scene */
  guint32 fixed;                  /* id of the object that the fix changes */
  char *properties, *value;       /* of SPORE_FIX_SET: names joined by |, and the text; NULL: back to the default */
  char *place, *message, *remedy; /* place: FILE:LINE:COLUMN or object path; texts translated */
} SporeDiagnostic;
void spore_diagnostic_free(SporeDiagnostic *diagnostic);
/* GPtrArray of SporeDiagnostic *, worst first; never NULL. The reader has checked the format already. This function
 * checks references, assets, units (an organ 150 m long), mesh quality, initial overlap, loose passive bodies, unused
 * assets, stale generated data, the time step against the stiffness, and what a model reports that it computes badly.
 * cancel: ends the check with what was found so far; NULL: none. */
GPtrArray *spore_document_check(SporeDocument *document, const SporeCancel *cancel);

#endif
