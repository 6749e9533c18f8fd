/* The exercise: steps that nothing in the scene can do. Whether it can be put together at all is said where it is
 * compiled. */
#include <glib/gi18n.h>

#include "core/exercise/event.h"
#include "core/scene/check_private.h"

static gboolean some_tool(const SporeCheck *check, const SporeEventKind *kind) {
  const SporeObject *tools = spore_document_section(check->document, "tools");
  for (guint i = 0; i < spore_object_child_count(tools); i++)
    if (spore_event_kind_allows(kind, spore_object_type(spore_object_child(tools, i))->element)) return TRUE;
  return FALSE;
}

/* What a body does by itself needs no tool. */
static void check_step(SporeCheck *check, SporeObject *step) {
  const SporeEventKind *kind = spore_event_kind_find(spore_object_type(step)->element);
  if (!kind || !kind->needs_body || spore_parameter_find(&kind->parameters, "tool") < 0 || some_tool(check, kind))
    return;
  spore_check_say(check, SPORE_WARNING, step, _("add a tool that can, or remove the step"),
                  _("no tool of the scene can do the step \"%s\""), spore_object_name(step));
}

void spore_check_exercise(SporeCheck *check) { spore_check_each(check, "exercise", NULL, check_step); }
