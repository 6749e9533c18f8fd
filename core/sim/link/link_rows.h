/* Rows shared by the parameter tables of several links. For C files that declare a table. */
#ifndef SPORE_SIM_LINK_ROWS_H
#define SPORE_SIM_LINK_ROWS_H

#include "core/base/parameter_rows.h"
#include "core/sim/link/link_type.h"

#define LINK_NAME(text) SPORE_ROW_NAME(SporeLinkDescription, name, text)
#define LINK_BODY_A(text) SPORE_ROW_BODY(SporeLinkDescription, body_a, body_a_name, text)
#define LINK_BODY_B(text) SPORE_ROW_BODY(SporeLinkDescription, body_b, body_b_name, text)
#define LINK_POINT(text) SPORE_ROW_PLACE_AT(SporeLinkDescription, point, point_a, text)
#define LINK_DIRECTION(text) SPORE_ROW_DIRECTION(SporeLinkDescription, direction, 0, 1, 0, text)
#define LINK_LENGTH(text) SPORE_ROW_REAL(SporeLinkDescription, length, "m", 1e-6, SPORE_POSITION_MAXIMUM_M, 0.01, text)

/* Parameters of a joint. Type: SporeLinkDescription, or a structure with members of these names. */
#define SPORE_JOINT_ROWS(Type)                                                                                         \
  SPORE_ROW_REAL(Type, stiffness, "N/m", 1e-3, 1e12, 1e5,                                                              \
                 N_("Force for each metre that what is held together comes apart.")),                                  \
      SPORE_ROW_REAL(Type, damping, "N s/m", -1, 1e9, -1,                                                              \
                     N_("Force against each metre per second of coming apart; negative: so much that the lighter "     \
                        "body does not swing.")),                                                                      \
      SPORE_ROW_REAL(Type, strength, "N", 0, 1e9, 0, N_("Force above which it breaks for good; 0: never."))

extern const char *const spore_link_ends[3]; /* choices of `ends`, NULL at the end */
/* Parameters of a point that slides along a line. */
#define LINK_SLIDING_ROWS                                                                                              \
  SPORE_ROW_REAL(SporeLinkDescription, friction, "", 0, 10, 0,                                                         \
                 N_("Coulomb coefficient against running along the line: force for each newton that it holds "         \
                    "across.")),                                                                                       \
      SPORE_ROW_CHOICE(SporeLinkDescription, ends, spore_link_ends,                                                    \
                       N_("What happens at the ends of a thread's or tube's own line: stop, it is held there; "        \
                          "slip_off, it is let go for good."))

/* The fault of a link that needs a direction or a length, or NULL. */
const char *spore_link_direction_fault(const SporeLinkDescription *link);
const char *spore_link_length_fault(const SporeLinkDescription *link);

#endif
