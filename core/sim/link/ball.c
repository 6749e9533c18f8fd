/* The ball joint: holds two points together and leaves all rotations free. */
#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the ball joint.")),
    LINK_BODY_A(N_("Body that is held.")),
    LINK_BODY_B(N_("Body that it is held at; none: the scene.")),
    LINK_POINT(N_("Where the bodies are held together at the start, in the scene.")),
    SPORE_JOINT_ROWS(SporeLinkDescription),
};

const SporeLinkType spore_link_ball = {
    .element = "ball",
    .label = N_("Ball joint"),
    .doc = N_("Holds a point of a body at another, or at the scene, and leaves it free to turn."),
    .parameters = SPORE_TABLE(rows, SporeLinkDescription),
    .term_count = 1,
    .is_joint = true,
    .held_freedoms = 3,
    .point_on_a = true,
    .point_on_b = true};
