/* Reads the settings in which one level of detail differs from its body. */
#include "core/scene/level_settings.h"

#include <glib/gi18n.h>
#include <string.h>

/* One "name=value". */
static gboolean apply(const SporeParameterTable *table, const char *setting, void *fields, SporeError *error) {
  const char *equals = strchr(setting, '=');
  g_autofree char *name = equals ? g_strndup(setting, (gsize)(equals - setting)) : NULL;
  if (!name)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("\"%.60s\" is no setting; expected name=value, apart by blanks; write control_points=12"),
                           setting);
  int index = spore_parameter_find(table, name);
  const char *nearest = spore_parameter_nearest(table, name);
  if (index < 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           nearest ? _("the model has no parameter \"%.60s\"; did you mean \"%s\"?")
                                   : _("the model has no parameter \"%.60s\"; `spore models` lists what there is"),
                           name, nearest);
  const SporeParameter *parameter = &table->parameters[index];
  if (parameter->change == SPORE_CHANGE_LIVE || parameter->type >= SPORE_TEXT)
    return spore_error_set(
        error, SPORE_ERROR_INPUT, NULL,
        _("%s says what the body is, and not how finely it is made: expected the same at each level; "
          "set it in its mechanical unit"),
        parameter->name);
  SporeValue value;
  if (!spore_parameter_parse(parameter, equals + 1, &value, error)) return FALSE;
  spore_parameter_store(parameter, &value, fields);
  spore_value_clear(&value);
  return TRUE;
}

gboolean spore_level_settings_apply(const SporeParameterTable *table, const char *settings, void *fields,
                                    SporeError *error) {
  g_auto(GStrv) words = g_strsplit_set(settings ? settings : "", " \t\r\n", -1);
  for (char **word = words; *word; word++)
    if (**word && !apply(table, *word, fields, error)) return FALSE;
  return TRUE;
}
