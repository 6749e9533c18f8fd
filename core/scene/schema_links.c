#include "core/scene/schema_tables.h"

static const SporeParameter pin_parameters[] = {
    NAME(SporePinFields, N_("Name of the pin.")),
    {.name = "body",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporePinFields, body),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Body that is held.")},
    {.name = "point",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporePinFields, point),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Centre of what is held, in the scene.")},
    {.name = "radius",
     .type = SPORE_REAL,
     .unit = "m",
     0,
     POSITION_M,
     .initial = {0.005},
     FIELD(SporePinFields, radius),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Every part of the body nearer than this to the point at the start is held still.")},
};

static const SporeParameter spring_parameters[] = {
    NAME(SporeSpringFields, N_("Name of the spring.")),
    {.name = "body_a",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporeSpringFields, body_a),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Body at the first end.")},
    {.name = "body_b",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporeSpringFields, body_b),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Body at the second end; none: the end is fixed in the scene.")},
    {.name = "point_a",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeSpringFields, point_a),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Where the first end is tied at the start, in the scene.")},
    {.name = "point_b",
     .type = SPORE_VECTOR,
     .unit = "m",
     -POSITION_M,
     POSITION_M,
     FIELD(SporeSpringFields, point_b),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Where the second end is tied at the start, in the scene.")},
    {.name = "stiffness",
     .type = SPORE_REAL,
     .unit = "N/m",
     0,
     1e12,
     .initial = {100},
     FIELD(SporeSpringFields, stiffness),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force for each metre of stretch.")},
    {.name = "damping",
     .type = SPORE_REAL,
     .unit = "N s/m",
     0,
     1e9,
     .initial = {0.1},
     FIELD(SporeSpringFields, damping),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force against each metre per second of stretching.")},
    {.name = "rest_length",
     .type = SPORE_REAL,
     .unit = "m",
     -1,
     POSITION_M,
     .initial = {-1},
     FIELD(SporeSpringFields, rest_length),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Length at which the spring is slack; negative: its length at the start.")},
    {.name = "strength",
     .type = SPORE_REAL,
     .unit = "N",
     0,
     1e9,
     .initial = {0},
     FIELD(SporeSpringFields, strength),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Force above which the spring breaks for good; 0: never.")},
};

static const char *const line_ends[] = {"stop", "slip_off", NULL};

#define LINK_BODY(field, text)                                                                                         \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REFERENCE, .unit = "", .references = "body", FIELD(SporeLinkFields, field),          \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define LINK_POINT(text)                                                                                               \
  {                                                                                                                    \
    .name = "point", .type = SPORE_VECTOR, .unit = "m", -POSITION_M, POSITION_M, FIELD(SporeLinkFields, point),        \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define LINK_DIRECTION(text)                                                                                           \
  {                                                                                                                    \
    .name = "direction", .type = SPORE_VECTOR, .unit = "", -POSITION_M, POSITION_M, .initial = {0, 1, 0},              \
    FIELD(SporeLinkFields, direction), .change = SPORE_CHANGE_REBUILD, .doc = text                                     \
  }
#define LINK_FRICTION                                                                                                  \
  {                                                                                                                    \
    .name = "friction", .type = SPORE_REAL, .unit = "", .maximum = 10, FIELD(SporeLinkFields, friction),               \
    .change = SPORE_CHANGE_REBUILD,                                                                                    \
    .doc = N_("Coulomb coefficient against running along the line: force for each newton that it holds across.")       \
  }
#define LINK_ENDS                                                                                                      \
  {                                                                                                                    \
    .name = "ends", .type = SPORE_CHOICE, .unit = "", .maximum = 1, .choices = line_ends,                              \
    FIELD(SporeLinkFields, ends), .change = SPORE_CHANGE_REBUILD,                                                      \
    .doc = N_("What happens at the ends of a thread's or tube's own line: stop, it is held there; slip_off, it is "    \
              "let go for good.")                                                                                      \
  }
#define LINK_LENGTH(text)                                                                                              \
  {                                                                                                                    \
    .name = "length", .type = SPORE_REAL, .unit = "m", 1e-6, POSITION_M, .initial = {0.01},                            \
    FIELD(SporeLinkFields, length), .change = SPORE_CHANGE_REBUILD, .doc = text                                        \
  }

static const SporeParameter ball_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the ball joint.")),
    LINK_BODY(body_a, N_("Body that is held.")),
    LINK_BODY(body_b, N_("Body that it is held at; none: the scene.")),
    LINK_POINT(N_("Where the bodies are held together at the start, in the scene.")),
};

static const SporeParameter hinge_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the hinge.")),
    LINK_BODY(body_a, N_("Body that turns.")),
    LINK_BODY(body_b, N_("Body that it turns on; none: the scene.")),
    LINK_POINT(N_("A point of the axis at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the axis at the start, in the scene.")),
    LINK_LENGTH(N_("Distance between the two points of the axis that are held: the longer, the stiffer.")),
};

static const SporeParameter weld_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the weld.")),
    LINK_BODY(body_a, N_("Body that is held.")),
    LINK_BODY(body_b, N_("Body that it is held at; none: the scene.")),
    LINK_POINT(N_("Where the bodies are joined at the start, in the scene.")),
    LINK_LENGTH(N_("Distance between the points that are held: the longer, the stiffer against turning.")),
};

static const SporeParameter seam_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the seam.")),
    LINK_BODY(body_a, N_("Body that is held, with nodes of its own.")),
    LINK_BODY(body_b, N_("Body that it is held at, with nodes of its own.")),
    {.name = "distance",
     .type = SPORE_REAL,
     .unit = "m",
     .minimum = 1e-9,
     .maximum = 1,
     .initial = {1e-6},
     FIELD(SporeLinkFields, distance),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("A node of one body and one of the other are held together where they lie no farther apart than this "
               "at the start.")},
};

static const SporeParameter slide_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the slide.")),
    LINK_BODY(body_a, N_("Body whose point slides.")),
    LINK_BODY(body_b, N_("Body that the line belongs to: a thread or a tube, along which the point runs however it "
                         "bends, or a rigid one; none: the scene.")),
    LINK_POINT(N_("Point that slides, where it is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the line at the start, in the scene; a thread or a tube has its own.")),
    LINK_FRICTION,
    LINK_ENDS,
};

static const SporeParameter port_parameters[] = {
    NAME(SporeLinkFields, N_("Name of the port.")),
    LINK_BODY(body_a, N_("What goes through the port: an instrument with its shaft, or a thread or a tube.")),
    LINK_BODY(body_b, N_("Body that the port is in; none: the scene.")),
    LINK_POINT(N_("Where the port is at the start, in the scene.")),
    LINK_DIRECTION(N_("Direction of the shaft at the start, in the scene; a thread or a tube has its own.")),
    LINK_FRICTION,
    LINK_ENDS,
};

#define JOINT .extra = &spore_joint_parameters, .extra_offset = offsetof(SporeLinkFields, joint)

const SporeElement spore_link_elements[] = {
    {"links", N_("Links"), N_("What ties bodies to each other and to the scene."),
     .children = CHILDREN("pin", "spring", "ball", "hinge", "weld", "seam", "slide", "port")},
    {"pin", N_("Pin"), N_("Holds part of a body still."), TABLE(pin_parameters, SporePinFields)},
    {"spring", N_("Spring"), N_("A damped spring between two bodies, or a body and the scene."),
     TABLE(spring_parameters, SporeSpringFields)},
    {"ball", N_("Ball joint"), N_("Holds a point of a body at another, or at the scene, and leaves it free to turn."),
     TABLE(ball_parameters, SporeLinkFields), JOINT},
    {"hinge", N_("Hinge"), N_("Leaves a body free to turn about an axis, and holds all else."),
     TABLE(hinge_parameters, SporeLinkFields), JOINT},
    {"weld", N_("Weld"), N_("Joins two bodies, or a body and the scene, as if they were one."),
     TABLE(weld_parameters, SporeLinkFields), JOINT},
    {"seam", N_("Seam"), N_("Joins two bodies that deform wherever their nodes meet, as organs that share faces."),
     TABLE(seam_parameters, SporeLinkFields), JOINT},
    {"slide", N_("Slide"),
     N_("Leaves a point of a body free to run along a line, straight or that of a thread, and holds it there."),
     TABLE(slide_parameters, SporeLinkFields), JOINT},
    {"port", N_("Port"),
     N_("Lets an instrument or a thread through at one point, as a trocar or a stitch does: it turns and slides "
        "there."),
     TABLE(port_parameters, SporeLinkFields), JOINT},
    {NULL},
};
