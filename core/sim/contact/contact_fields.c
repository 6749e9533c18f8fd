/* Contact parameters of a body. */
#include <math.h>

#include "core/base/text.h"
#include "core/sim/world.h"

static const char *const surface_names[] = {"spheres", "depth_field", NULL};

static const SporeParameter parameters[] = {
    {.name = "stiffness",
     .type = SPORE_REAL,
     .unit = "N/m",
     .minimum = 0,
     .maximum = 1e9,
     .initial = {1000},
     .offset = offsetof(SporeContactFields, stiffness),
     .change = SPORE_CHANGE_LIVE,
     .doc =
         N_("Force with which each sphere resists being entered, per depth; the springs of two bodies act in series. "
            "A contact stops a mass m up to the speed r sqrt(k/m), r the radius of the smaller sphere.")},
    {.name = "damping",
     .type = SPORE_REAL,
     .unit = "N s/m",
     .minimum = 0,
     .maximum = 1e6,
     .initial = {1},
     .offset = offsetof(SporeContactFields, damping),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Force against the speed at which spheres enter each other: takes the bounce away. With 0 they part as "
               "fast as they came.")},
    {.name = "friction",
     .type = SPORE_REAL,
     .unit = "",
     .minimum = 0,
     .maximum = 10,
     .initial = {0.3},
     .offset = offsetof(SporeContactFields, friction),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Coulomb coefficient; of two bodies in contact the smaller one counts.")},
    {.name = "self",
     .type = SPORE_BOOLEAN,
     .unit = "",
     .maximum = 1,
     .offset = offsetof(SporeContactFields, self),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("The body's own spheres collide with each other, those that touch at rest excepted.")},
    {.name = "margin",
     .type = SPORE_REAL,
     .unit = "m",
     .minimum = 0,
     .maximum = 1e3,
     .initial = {0},
     .offset = offsetof(SporeContactFields, margin),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_(
         "How far apart spheres may be when a step begins and yet stop each other in it. Bodies by an explicit method "
         "move implicitly in such a step: for what is so light and pulled so hard that it crosses a gap within a step, "
         "as a thread "
         "that is tied. A quarter of the radius serves there; each near pair costs as much as a contact. Of a sphere "
         "no more than its radius counts.")},
    {.name = "group",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 0,
     .maximum = 1000000,
     .initial = {0},
     .offset = offsetof(SporeContactFields, group),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Bodies of the same group never collide with each other, such as the parts of one instrument; 0: in "
               "none.")},
    {.name = "surface",
     .type = SPORE_CHOICE,
     .unit = "",
     .minimum = -HUGE_VAL,
     .maximum = HUGE_VAL,
     .initial = {SPORE_SURFACE_SPHERES},
     .choices = surface_names,
     .offset = offsetof(SporeContactFields, surface),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("What others feel of a body that keeps its shape: each of its spheres, or one depth that is smooth from "
               "sphere to sphere, for what others slide over. A ball led over spheres a radius apart is pushed 0.9 "
               "degrees off the true normal instead of 14, by 2% of its depth too much or too little instead of 48%; "
               "over a womb of 110 spheres 4.2 degrees instead of 3.7, and 20% instead of 210%, since spheres that "
               "overlap add up. A contact costs about four times as much.")},
};

const SporeParameterTable spore_contact_parameters = {parameters, sizeof parameters / sizeof *parameters,
                                                      sizeof(SporeContactFields)};
