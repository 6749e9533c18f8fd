#include "core/scene/schema_tables.h"

static const SporeParameter camera_parameters[] = {
    NAME(SporeCameraFields, N_("Name of the camera.")),
    {.name = "body",
     .type = SPORE_REFERENCE,
     .unit = "",
     .references = "body",
     FIELD(SporeCameraFields, body),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Body that the camera moves with, such as an endoscope, rigid or active; none: it stands still.")},
    {.name = "position",
     .type = SPORE_VECTOR,
     .unit = "m",
     .minimum = -POSITION_M,
     .maximum = POSITION_M,
     .initial = {0, 0, 0.3},
     FIELD(SporeCameraFields, position),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Where the camera stands, with its body at the start.")},
    {.name = "target",
     .type = SPORE_VECTOR,
     .unit = "m",
     .minimum = -POSITION_M,
     .maximum = POSITION_M,
     FIELD(SporeCameraFields, target),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("What it looks at, with its body at the start; up is the scene's y.")},
    {.name = "field_of_view",
     .type = SPORE_REAL,
     .unit = "rad",
     .minimum = 0.05,
     .maximum = 2.8,
     .initial = {0.7},
     FIELD(SporeCameraFields, field_of_view),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Vertical field of view.")},
};

#define TOOL_BODY(Type, field, text)                                                                                   \
  {                                                                                                                    \
    .name = #field, .type = SPORE_REFERENCE, .unit = "", .references = "body", FIELD(Type, field),                     \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define TOOL_DEVICE(Type)                                                                                              \
  {                                                                                                                    \
    .name = "device", .type = SPORE_REFERENCE, .unit = "", .references = "mouse|track", FIELD(Type, device),           \
    .change = SPORE_CHANGE_REBUILD, .doc = N_("Device that moves the tool.")                                           \
  }
#define TOOL_PLACE(Type, field, text)                                                                                  \
  {                                                                                                                    \
    .name = #field, .type = SPORE_VECTOR, .unit = "m", -POSITION_M, POSITION_M, FIELD(Type, field),                    \
    .change = SPORE_CHANGE_REBUILD, .doc = text                                                                        \
  }
#define TOOL_DIRECTION(Type, field, text)                                                                              \
  {                                                                                                                    \
    .name = #field, .type = SPORE_VECTOR, .unit = "", -POSITION_M, POSITION_M, .initial = {1, 0, 0},                   \
    FIELD(Type, field), .change = SPORE_CHANGE_REBUILD, .doc = text                                                    \
  }

static const SporeParameter probe_parameters[] = {
    NAME(SporeProbeFields, N_("Name of the tool.")),
    TOOL_BODY(SporeProbeFields, body, N_("Active body that the tool moves.")),
    TOOL_DEVICE(SporeProbeFields),
};

#define JAW_TOOL                                                                                                       \
  NAME(SporeJawToolFields, N_("Name of the tool.")),                                                                   \
      TOOL_BODY(SporeJawToolFields, body, N_("Active body that the tool moves: the shaft.")),                          \
      TOOL_DEVICE(SporeJawToolFields),                                                                                 \
      TOOL_BODY(SporeJawToolFields, jaw_a, N_("Active body of the first jaw, where it is when closed.")),              \
      TOOL_BODY(SporeJawToolFields, jaw_b, N_("Active body of the second jaw, where it is when closed.")),             \
      TOOL_PLACE(SporeJawToolFields, hinge, N_("Where the jaws are hinged at the start, in the scene.")),              \
      TOOL_DIRECTION(SporeJawToolFields, axis,                                                                         \
                     N_("Axis of the hinge at the start, in the scene: the first jaw opens by turning about it, the "  \
                        "second against it."))

static const SporeParameter jaw_tool_parameters[] = {JAW_TOOL};

static const SporeParameter scissors_parameters[] = {
    JAW_TOOL,
    TOOL_PLACE(SporeJawToolFields, tip, N_("Where the blades end at the start, closed, in the scene.")),
};

static const SporeParameter suction_parameters[] = {
    NAME(SporeSuctionToolFields, N_("Name of the tool.")),
    TOOL_BODY(SporeSuctionToolFields, body, N_("Active body that the tool moves: the tube.")),
    TOOL_DEVICE(SporeSuctionToolFields),
    TOOL_PLACE(SporeSuctionToolFields, point, N_("Middle of the mouth at the start, in the scene.")),
};

static const SporeParameter bipolar_parameters[] = {
    NAME(SporeBipolarToolFields, N_("Name of the tool.")),
    TOOL_BODY(SporeBipolarToolFields, body, N_("Active body that the tool moves: the forceps.")),
    TOOL_DEVICE(SporeBipolarToolFields),
    TOOL_PLACE(SporeBipolarToolFields, point, N_("Where it heats, between its tips, at the start, in the scene.")),
};

static const SporeParameter needle_parameters[] = {
    NAME(SporeNeedleToolFields, N_("Name of the tool.")),
    TOOL_BODY(SporeNeedleToolFields, body, N_("Active body that the tool moves: the needle. It needs no spheres.")),
    TOOL_DEVICE(SporeNeedleToolFields),
    TOOL_BODY(SporeNeedleToolFields, thread, N_("Thread, a body along a curve that begins or ends at the swage.")),
    TOOL_PLACE(SporeNeedleToolFields, tip, N_("Its tip at the start, in the scene.")),
    TOOL_PLACE(SporeNeedleToolFields, middle, N_("A point between on its arc at the start, in the scene.")),
    TOOL_PLACE(SporeNeedleToolFields, swage, N_("Where it ends and the thread begins, at the start, in the scene.")),
};

static const SporeParameter emitter_parameters[] = {
    NAME(SporeWoundFields, N_("Name of the emitter.")),
    TOOL_BODY(SporeWoundFields, body, N_("Fluid that comes out.")),
    TOOL_BODY(SporeWoundFields, source, N_("Body that the mouth is in and moves with; none: the scene.")),
    TOOL_PLACE(SporeWoundFields, point, N_("Middle of the mouth at the start, in the scene.")),
    TOOL_DIRECTION(SporeWoundFields, direction, N_("Direction in which it comes out at the start, in the scene.")),
};

static const SporeParameter mouse_parameters[] = {
    NAME(SporeMouseFields, N_("Name by which tools refer to the mouse.")),
};

static const SporeParameter track_parameters[] = {
    NAME(SporeTrackFields, N_("Name by which tools refer to the track.")),
    {.name = "file",
     .type = SPORE_FILE,
     .unit = "",
     FIELD(SporeTrackFields, file),
     .required = true,
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("File of recorded input, inside the scene's folder: a line spore-track 1, then for each active body a "
               "line device NAME and its rows of time (s), position (m), orientation (quaternion w x y z), grip and "
               "buttons; # begins a comment.")},
};

#define JAWS .extra = &spore_jaw_parameters, .extra_offset = offsetof(SporeJawToolFields, jaws)

const SporeElement spore_tool_elements[] = {
    {"effects", N_("Effects"), N_("What goes on besides what bodies do."), .children = CHILDREN("emitter")},
    {"emitter", N_("Emitter"), N_("A mouth that particles of a fluid come out of: a wound that bleeds."),
     TABLE(emitter_parameters, SporeWoundFields), .extra = &spore_emitter_parameters,
     .extra_offset = offsetof(SporeWoundFields, emitter)},
    {"tools", N_("Tools"), N_("What the user holds, and looks through."),
     .children = CHILDREN("probe", "grasper", "clamp", "scissors", "suction", "bipolar", "needle", "camera")},
    {"probe", N_("Probe"), N_("An active body moved by a device."), TABLE(probe_parameters, SporeProbeFields)},
    {"grasper", N_("Grasper"), N_("Two jaws that close on tissue and hold it."),
     TABLE(jaw_tool_parameters, SporeJawToolFields), JAWS},
    {"clamp", N_("Clamp"), N_("Two jaws that stay closed on what they took hold of, until the second button."),
     TABLE(jaw_tool_parameters, SporeJawToolFields), JAWS},
    {"scissors", N_("Scissors"),
     N_("Blades that cut nets and tetrahedra where they close; jaws are the bodies that are seen and felt of them, and "
        "may be left out."),
     TABLE(scissors_parameters, SporeJawToolFields), JAWS},
    {"suction", N_("Suction"), N_("A tube that takes the particles of fluids away."),
     TABLE(suction_parameters, SporeSuctionToolFields), .extra = &spore_suction_parameters,
     .extra_offset = offsetof(SporeSuctionToolFields, suction)},
    {"bipolar", N_("Bipolar forceps"),
     N_("Forceps that coagulate nets and tetrahedra while the first button is down: these shrink and stiffen there, "
        "for good."),
     TABLE(bipolar_parameters, SporeBipolarToolFields), .extra = &spore_bipolar_parameters,
     .extra_offset = offsetof(SporeBipolarToolFields, bipolar)},
    {"needle", N_("Needle"),
     N_("A curved needle that pierces nets, surfaces and tetrahedra, and draws a thread through them."),
     TABLE(needle_parameters, SporeNeedleToolFields), .extra = &spore_needle_parameters,
     .extra_offset = offsetof(SporeNeedleToolFields, needle)},
    {"camera", N_("Camera"), N_("A view of the scene."), TABLE(camera_parameters, SporeCameraFields)},
    {"devices", N_("Devices"), N_("Where input comes from."), .children = CHILDREN("mouse", "track")},
    {"mouse", N_("Mouse"), N_("The pointer on the screen."), TABLE(mouse_parameters, SporeMouseFields)},
    {"track", N_("Track"), N_("Recorded input, played back."), TABLE(track_parameters, SporeTrackFields)},
    {"exercise", N_("Exercise"), N_("What the trainee is asked to do.")},
    {NULL},
};
