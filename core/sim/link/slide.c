/* The slide: a point of one body runs along a line of the other. */
#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the slide.")),
    LINK_BODY_A(N_("Body whose point slides.")),
    LINK_BODY_B(N_("Body that the line belongs to: a thread or a tube, along which the point runs however it bends, or "
                   "a rigid one; none: the scene.")),
    LINK_POINT(N_("Point that slides, where it is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the line at the start, in the scene; a thread or a tube has its own.")),
    LINK_SLIDING_ROWS,
    SPORE_JOINT_ROWS(SporeLinkDescription),
};

const SporeLinkType spore_link_slide = {
    .element = "slide",
    .label = N_("Slide"),
    .doc = N_("Leaves a point of a body free to run along a line, straight or that of a thread, and holds it there."),
    .parameters = SPORE_TABLE(rows, SporeLinkDescription),
    .term_count = 1,
    .is_joint = true,
    .line = SPORE_LINE_OF_BODY_B,
    .held_freedoms = 2,
    .point_on_a = true};
