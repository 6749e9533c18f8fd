/* The scene's own elements of links: their section, and the seam, which becomes many ball joints. */
#include "core/scene/schema_tables.h"
#include "core/sim/link/link_rows.h"

static const SporeParameter seam_parameters[] = {
    NAME(SporeSeamFields, N_("Name of the seam.")),
    SPORE_ROW_BODY(SporeSeamFields, body_a, body_a, N_("Body that is held, with nodes of its own.")),
    SPORE_ROW_BODY(SporeSeamFields, body_b, body_b, N_("Body that it is held at, with nodes of its own.")),
    SPORE_ROW_REAL(SporeSeamFields, distance, "m", 1e-9, 1, 1e-6,
                   N_("A node of one body and one of the other are held together where they lie no farther apart than "
                      "this at the start.")),
    SPORE_JOINT_ROWS(SporeSeamFields),
};

const SporeElement spore_link_elements[] = {
    {"links", N_("Links"), N_("What ties bodies to each other and to the scene."), .children = CHILDREN("seam")},
    {"seam", N_("Seam"), N_("Joins two bodies that deform wherever their nodes meet, as organs that share faces."),
     TABLE(seam_parameters, SporeSeamFields)},
    {NULL},
};
