/* The weld: holds four points of a tetrahedron together, so that the bodies move as one. */
#include <math.h>

#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static void place(const SporeLinkDescription *link, size_t term, SporeVec3 *a, SporeVec3 *b) {
  static const double corners[4][3] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}; /* edges of length 2^1.5 */
  *a = *b = spore_vec3_add_scaled(link->point_a, link->length / sqrt(8), spore_vec3_load(corners[term]));
}

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the weld.")),
    LINK_BODY_A(N_("Body that is held.")),
    LINK_BODY_B(N_("Body that it is held at; none: the scene.")),
    LINK_POINT(N_("Where the bodies are joined at the start, in the scene.")),
    LINK_LENGTH(N_("Distance between the points that are held: the longer, the stiffer against turning.")),
    SPORE_JOINT_ROWS(SporeLinkDescription),
};

const SporeLinkType spore_link_weld = {.element = "weld",
                                       .label = N_("Weld"),
                                       .doc = N_("Joins two bodies, or a body and the scene, as if they were one."),
                                       .parameters = SPORE_TABLE(rows, SporeLinkDescription),
                                       .term_count = 4,
                                       .is_joint = true,
                                       .held_freedoms = 6,
                                       .point_on_a = true,
                                       .point_on_b = true,
                                       .fault = spore_link_length_fault,
                                       .place = place};
