#include "app/cli/level_changes.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/error.h"

static gboolean refuse(const char *setting, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--level",
                           _("'%s' is no change of level; expected BODY=LEVEL or BODY=LEVEL@SECONDS, such as "
                             "thread=coarse@1.5"),
                           setting);
}

/* BODY = LEVEL @ SECONDS, of which the last may be missing. */
static gboolean parse(const SporeWorld *world, const char *setting, SporeLevelChange *change, GError **error) {
  g_auto(GStrv) sides = g_strsplit(setting, "=", 2);
  if (g_strv_length(sides) != 2) return refuse(setting, error);
  g_auto(GStrv) words = g_strsplit(sides[1], "@", 2);
  char *end = NULL;
  if (words[0] && words[1]) change->time_s = g_ascii_strtod(words[1], &end);
  if (!words[0] || (end && (end == words[1] || *end)) || !(change->time_s >= 0)) return refuse(setting, error);
  change->body = spore_world_find_body(world, sides[0]);
  if (change->body == SPORE_NO_BODY)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--level",
                             _("the scene has no body '%s'; expected the name of one that has levels"), sides[0]);
  for (int k = 0; k < SPORE_LEVEL_COUNT; k++) {
    if (strcmp(spore_level_names[k], words[0]) != 0) continue;
    change->level = (SporeLevelGrade)k;
    if (spore_world_level_model(world, change->body, change->level)) return TRUE;
  }
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--level",
                           _("the body '%s' has no level '%s'; expected fine, or one of the levels in its fidelity"),
                           sides[0], words[0]);
}

GArray *spore_level_changes_parse(const SporeWorld *world, char **settings, GError **error) {
  GArray *changes = g_array_new(FALSE, TRUE, sizeof(SporeLevelChange));
  for (char **setting = settings; setting && *setting; setting++) {
    SporeLevelChange change = {0};
    if (!parse(world, *setting, &change, error)) {
      g_array_unref(changes);
      return NULL;
    }
    g_array_append_val(changes, change);
  }
  return changes;
}

void spore_level_changes_post(GArray *changes, SporeWorld *world) {
  for (guint i = 0; i < changes->len; i++) {
    SporeLevelChange *change = &g_array_index(changes, SporeLevelChange, i);
    if (change->posted || change->time_s > spore_world_time_s(world)) continue;
    const SporeCommand command = {.kind = SPORE_COMMAND_LEVEL, .body = change->body, .level = change->level};
    change->posted = spore_world_post(world, &command);
  }
}
