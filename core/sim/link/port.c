/* The port: a line of one body passes through a point of the other, as an instrument through a trocar (a remote
 * centre of motion). */
#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the port.")),
    LINK_BODY_A(N_("What goes through the port: an instrument with its shaft, or a thread or a tube.")),
    LINK_BODY_B(N_("Body that the port is in; none: the scene.")),
    LINK_POINT(N_("Where the port is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the shaft at the start, in the scene; a thread or a tube has its own.")),
    LINK_SLIDING_ROWS,
    SPORE_JOINT_ROWS(SporeLinkDescription),
};

const SporeLinkType spore_link_port = {
    .element = "port",
    .label = N_("Port"),
    .doc = N_("Lets an instrument or a thread through at one point, as a trocar or a stitch does: it turns and slides "
              "there."),
    .parameters = SPORE_TABLE(rows, SporeLinkDescription),
    .term_count = 1,
    .is_joint = true,
    .line = SPORE_LINE_OF_BODY_A,
    .held_freedoms = 2,
    .point_on_b = true};
