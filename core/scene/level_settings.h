/* The settings of a level of detail: the parameters in which its model differs from the body's. */
#ifndef SPORE_SCENE_LEVEL_SETTINGS_H
#define SPORE_SCENE_LEVEL_SETTINGS_H

#include <glib.h>

#include "core/base/parameter.h"

/* Stores "name=value" settings, separated by blanks, in the fields of the table; NULL: there are none. Refuses names
 * that are not in the table, values out of range, and parameters that may change while the scene runs: those belong to
 * the body at every level. */
gboolean spore_level_settings_apply(const SporeParameterTable *table, const char *settings, void *fields,
                                    SporeError *error);

#endif
