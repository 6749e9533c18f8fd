/* The spring: a damped spring between two points. */
#include "core/constraint/spring.h"

#include "core/base/text.h"
#include "core/sim/link/link_rows.h"

static void place(const SporeLinkDescription *link, size_t term, SporeVec3 *a, SporeVec3 *b) {
  *a = link->point_a;
  *b = link->point_b;
}

static void law(const SporeLinkDescription *link, SporeSpring *spring) {
  SporeVec3 along = spore_vec3_sub(link->point_a, link->point_b);
  spring->rest_length = link->rest_length < 0 ? spore_vec3_length(along) : link->rest_length;
  spring->fallback = spore_vec3_normalise(along, (SporeVec3){0, 1, 0});
}

static const SporeParameter rows[] = {
    LINK_NAME(N_("Name of the spring.")),
    LINK_BODY_A(N_("Body at the first end.")),
    LINK_BODY_B(N_("Body at the second end; none: the end is fixed in the scene.")),
    SPORE_ROW_PLACE(SporeLinkDescription, point_a, N_("Where the first end is tied at the start, in the scene.")),
    SPORE_ROW_PLACE(SporeLinkDescription, point_b, N_("Where the second end is tied at the start, in the scene.")),
    SPORE_ROW_REAL(SporeLinkDescription, stiffness, "N/m", 0, 1e12, 100, N_("Force for each metre of stretch.")),
    SPORE_ROW_REAL(SporeLinkDescription, damping, "N s/m", 0, 1e9, 0.1,
                   N_("Force against each metre per second of stretching.")),
    SPORE_ROW_REAL(SporeLinkDescription, rest_length, "m", -1, SPORE_POSITION_MAXIMUM_M, -1,
                   N_("Length at which the spring is slack; negative: its length at the start.")),
    SPORE_ROW_REAL(SporeLinkDescription, strength, "N", 0, 1e9, 0,
                   N_("Force above which the spring breaks for good; 0: never.")),
};

const SporeLinkType spore_link_spring = {.element = "spring",
                                         .label = N_("Spring"),
                                         .doc = N_("A damped spring between two bodies, or a body and the scene."),
                                         .parameters = SPORE_TABLE(rows, SporeLinkDescription),
                                         .term_count = 1,
                                         .point_on_a = true,
                                         .point_on_b = true,
                                         .place = place,
                                         .law = law};
