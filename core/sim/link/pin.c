/* The pin: holds part of a body still. */
#include "core/constraint/pin.h"

#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static size_t hold(const SporeLinkDescription *link, const double *points, size_t count, uint8_t *marks) {
  return spore_pin_select(points, count, link->point_a, link->radius, marks);
}

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the pin.")),
    SPORE_ROW_BODY(SporeLinkDescription, body, body_a_name, N_("Body that is held.")),
    LINK_POINT(N_("Centre of what is held, in the scene.")),
    SPORE_ROW_REAL(
        SporeLinkDescription, radius, "m", 0, SPORE_POSITION_MAXIMUM_M, 0.005,
        N_("Every node or control point of the body nearer than this to the point at the start is held still.")),
};

const SporeLinkType spore_link_pin = {.element = "pin",
                                      .label = N_("Pin"),
                                      .doc = N_("Holds part of a body still."),
                                      .parameters = SPORE_TABLE(rows, SporeLinkDescription),
                                      .hold = hold};
