/* What differs at a level of a body, as the scene says it. */
#ifndef SPORE_SCENE_LEVEL_SETTINGS_H
#define SPORE_SCENE_LEVEL_SETTINGS_H

#include <glib.h>

#include "core/base/parameter.h"

/* Stores "name=value" settings, apart by blanks, in the fields of the table. NULL: there are none. Refuses names that
 * are not in the table, values out of range, and parameters that change while it runs: those are of the body, whatever
 * its level. */
gboolean spore_level_settings_apply(const SporeParameterTable *table, const char *settings, void *fields,
                                    SporeError *error);

#endif
