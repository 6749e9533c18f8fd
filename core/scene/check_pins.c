/* Pins on lines and sheets that hold much less of them than their radius says. They never hold more: a place is held
 * where all control points that weigh on it are, and it lies between those. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/check_private.h"
#include "core/scene/pinned_line.h"
#include "core/scene/pinned_sheet.h"

#define SHOWN_SHARE 0.25 /* of the deflection of the free part, which goes with the third power of its length */

static void check_side(SporeCheck *check, SporeObject *pin, const SporePinnedSide *side) {
  const char *body = spore_object_name(spore_object_reference(pin, "body"));
  if (side->turns || -3 * side->beyond_m <= SHOWN_SHARE * side->free_m) return;
  g_autofree char *distance = spore_length_text(-side->beyond_m);
  spore_check_say(check, SPORE_NOTE, pin, _("give the body more control points, or choose another radius"),
                  _("\"%s\" holds %zu control points of \"%s\", which bends as if it were clamped %s within the pin's "
                    "radius"),
                  spore_object_name(pin), side->held, body, distance);
}

static void check_sheet(SporeCheck *check, SporeObject *pin, const SporePinnedSheet *sheet) {
  if (!sheet->still || 3 * sheet->moves_m <= SHOWN_SHARE * sheet->free_m) return;
  g_autofree char *distance = spore_length_text(sheet->moves_m);
  spore_check_say(
      check, SPORE_NOTE, pin, _("give the body more control points, or choose another radius"),
      _("\"%s\" holds %zu control points of \"%s\", which stands still only deeper than %s within the pin's radius"),
      spore_object_name(pin), sheet->held, spore_object_name(spore_object_reference(pin, "body")), distance);
}

void spore_check_pins(SporeCheck *check, const SporeSimulation *simulation) {
  const SporeObject *links = spore_document_section(check->document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    SporeObject *link = spore_object_child(links, i);
    SporePinnedSide measured;
    if (strcmp(spore_object_type(link)->element, "pin") != 0) continue;
    for (int side = -1; side <= 1; side += 2)
      if (spore_pinned_side_measure(simulation, link, side, &measured)) check_side(check, link, &measured);
    SporePinnedSheet sheet;
    if (spore_pinned_sheet_measure(simulation, link, &sheet)) check_sheet(check, link, &sheet);
  }
}
