/* Changes of level that the command line asks for. */
#ifndef SPORE_APP_CLI_LEVEL_CHANGES_H
#define SPORE_APP_CLI_LEVEL_CHANGES_H

#include <glib.h>

#include "core/sim/world.h"

typedef struct SporeLevelChange {
  guint32 body;
  SporeLevelGrade level;
  double time_s;
  gboolean posted;
} SporeLevelChange;

/* From BODY=LEVEL or BODY=LEVEL@SECONDS each; settings may be NULL. NULL with a GError: no such body, level or time.
 * g_array_unref. */
GArray *spore_level_changes_parse(const SporeWorld *world, char **settings, GError **error);
/* Posts those that are due by now. */
void spore_level_changes_post(GArray *changes, SporeWorld *world);

#endif
