/* Which labels a label map holds, told without its voxels: much faster, and in little memory. */
#ifndef SPORE_IO_LABEL_SURVEY_H
#define SPORE_IO_LABEL_SURVEY_H

#include <glib.h>

#include "core/base/progress.h"
#include "core/math/vec3.h"
#include "core/scene/error.h"

typedef enum SporeLabelNaming {
  SPORE_LABEL_UNNAMED,
  SPORE_LABEL_NAMED_BY_FILE,    /* by the table in the file itself: NRRD's segments, the labels in a NIfTI extension */
  SPORE_LABEL_NAMED_BY_SIDECAR, /* by a table in a file of the same name beside it: .json, .txt, .ctbl, .label */
  SPORE_LABEL_GUESSED           /* by spore_label_guess, where neither names any label */
} SporeLabelNaming;
extern const char *const spore_label_namings[]; /* NULL "file" "sidecar" "guessed" */

typedef struct SporeLabelEntry {
  guint16 label;
  guint64 voxels;
  double volume;      /* m^3 */
  double size[3];     /* m, of the box of its voxels, along the map's axes */
  gboolean cut[3][2]; /* it reaches the first or last voxel along that axis: the field of view may have cut it */
  char *name;         /* "label 3", translated, where it is unnamed */
  SporeLabelNaming naming;
} SporeLabelEntry;

typedef struct SporeLabelSurvey {
  gsize size[3];     /* voxels */
  double spacing[3]; /* m, between voxels along the map's axes */
  GArray *entries;   /* of SporeLabelEntry, ascending by label */
} SporeLabelSurvey;

/* Surveys a whole label map (spore_label_map_whole) in a helper process. NULL with an error: as
 * spore_label_map_decode. */
SporeLabelSurvey *spore_label_survey(const char *file, GBytes *content, const SporeProgress *progress, GError **error);
void spore_label_survey_free(SporeLabelSurvey *survey);
G_DEFINE_AUTOPTR_CLEANUP_FUNC(SporeLabelSurvey, spore_label_survey_free)

/* What the survey found of a label; NULL: there is no such label. Borrowed. */
const SporeLabelEntry *spore_label_survey_entry(const SporeLabelSurvey *survey, guint16 label);

/* Reads "1,liver,5": labels by number or by name. GArray of guint16; NULL with an error that lists the names nearest.
 */
GArray *spore_label_survey_choose(const SporeLabelSurvey *survey, const char *text, GError **error);

typedef struct SporeLabelSize {
  guint16 label;
  double volume; /* m^3 */
} SporeLabelSize;
/* Guesses the names of a map's labels by their numbers in common sets: only where a set holds every one of at least
 * ten labels, and only names on which all such sets agree. label -> char *; empty: nothing is guessed.
 * g_hash_table_unref. */
GHashTable *spore_label_guess(const SporeLabelSize *labels, gsize count);

/* Adds names of a sidecar's text to the table of label -> char *. json: it is JSON, else lines "3 liver". */
void spore_label_table_read(const char *text, gsize size, gboolean json, GHashTable *names);

#endif
