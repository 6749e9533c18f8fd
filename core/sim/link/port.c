/* The port: a line of one body passes through a point of the other, as an instrument through a trocar (a remote
 * centre of motion). */
#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

/* What is shown to authors alone, so that a run goes on when it changes. */
#define REACH(field, unit_text, least, most, start, text)                                                              \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REAL, .unit = unit_text, .minimum = least, .maximum = most, .initial = {start},      \
    .offset = offsetof(SporeLinkDescription, field), .change = SPORE_CHANGE_LIVE, .doc = text                          \
  }

/* The angle: Lum, Rosen, Sinanan and Hannaford (IEEE Trans. Biomed. Eng. 53(7), 2006) measured how surgeons move
 * instruments in a cone of 60 degrees for 95 % of the time, and that one of 90 degrees reaches the whole abdomen. The
 * greatest depth: a standard instrument is 330 mm long (Manasnayakorn, Cuschieri and Hanna, "Ideal manipulation angle
 * and instrument length in hand-assisted laparoscopic surgery"), of which 30 mm are taken to stay outside the wall. */
static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the port.")),
    LINK_BODY_A(N_("What goes through the port: an instrument with its shaft, or a thread or a tube.")),
    LINK_BODY_B(N_("Body that the port is in; none: the scene.")),
    LINK_POINT(N_("Where the port is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the shaft at the start, in the scene; a thread or a tube has its own.")),
    LINK_SLIDING_ROWS,
    SPORE_JOINT_ROWS(SporeLinkDescription),
    REACH(reach_angle, "rad", 0.01, 1.5, 0.7853981633974483,
          N_("How far the shaft may tilt from its direction at the start, half the angle of the cone that is shown; a "
             "run does not keep to it.")),
    REACH(reach_least, "m", 0, 0.1, 0.02,
          N_("From the port to the nearest place that the tip works at; nearer, the jaws are in the cannula still.")),
    REACH(reach_most, "m", 0.1, 1, 0.3,
          N_("From the port to the farthest place that the tip gets to; farther, the handle would meet the cannula.")),
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
