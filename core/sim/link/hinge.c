/* The hinge: holds two points of the axis about which the bodies turn. */
#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static const char *fault(const SporeLinkDescription *link) {
  const char *direction = spore_link_direction_fault(link);
  return direction ? direction : spore_link_length_fault(link);
}

static void place(const SporeLinkDescription *link, size_t term, SporeVec3 *a, SporeVec3 *b) {
  SporeVec3 along = spore_vec3_normalise(link->direction, (SporeVec3){0, 0, 0});
  *a = *b = spore_vec3_add_scaled(link->point_a, ((double)term - 0.5) * link->length, along);
}

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the hinge.")),
    LINK_BODY_A(N_("Body that turns.")),
    LINK_BODY_B(N_("Body that it turns on; none: the scene.")),
    LINK_POINT(N_("A point of the axis at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the axis at the start, in the scene.")),
    LINK_LENGTH(N_("Distance between the two points of the axis that are held: the longer, the stiffer.")),
    SPORE_JOINT_ROWS(SporeLinkDescription),
};

const SporeLinkType spore_link_hinge = {.element = "hinge",
                                        .label = N_("Hinge"),
                                        .doc = N_("Leaves a body free to turn about an axis, and holds all else."),
                                        .parameters = SPORE_TABLE(rows, SporeLinkDescription),
                                        .term_count = 2,
                                        .is_joint = true,
                                        .held_freedoms = 5,
                                        .point_on_a = true,
                                        .point_on_b = true,
                                        .fault = fault,
                                        .place = place};
