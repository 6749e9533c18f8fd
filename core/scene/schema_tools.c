/* The scene's own elements of effects, tools and devices. */
#include "core/base/parameter_rows.h"
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
    {.name = "angle",
     .type = SPORE_REAL,
     .unit = "rad",
     .minimum = 0,
     .maximum = 1.6,
     FIELD(SporeCameraFields, angle),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("How far it looks aside from the axis from its position to its target: 30 degrees for most endoscopes "
               "that look aside.")},
    {.name = "turn",
     .type = SPORE_REAL,
     .unit = "rad",
     .minimum = -3.1416,
     .maximum = 3.1416,
     FIELD(SporeCameraFields, turn),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("To which side it looks aside, as the optic is turned about that axis: 0: down, a quarter of a turn: to "
               "the right, a quarter of a turn back: to the left.")},
    {.name = "field_of_view",
     .type = SPORE_REAL,
     .unit = "rad",
     .minimum = 0.05,
     .maximum = 2.8,
     .initial = {0.7},
     FIELD(SporeCameraFields, field_of_view),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Vertical field of view.")},
    {.name = "distortion",
     .type = SPORE_REAL,
     .unit = "1",
     .minimum = 0,
     .maximum = 0.6,
     FIELD(SporeCameraFields, distortion),
     .change = SPORE_CHANGE_LIVE,
     .doc =
         N_("How the lens bends straight lines outward (barrel): how much nearer to the middle it draws a corner of "
            "the picture than at the scale of the middle, as a part of the distance. 0: not at all; rigid endoscopes: "
            "0.2 (Laryngoscope 125, 2015, p. 561).")},
    {.name = "lens",
     .type = SPORE_REAL,
     .unit = "m",
     .minimum = 0,
     .maximum = 0.05,
     FIELD(SporeCameraFields, lens),
     .change = SPORE_CHANGE_REBUILD,
     .doc =
         N_("Radius of its front lens, which blood and water wet until it is wiped: by the first button of its device, "
            "or when it is drawn out of its port. 0: it stays clean.")},
    {.name = "haze",
     .type = SPORE_REAL,
     .unit = "s",
     .minimum = 0,
     .maximum = 1000,
     FIELD(SporeCameraFields, haze),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How long smoke hazes the view after it was made, until a third of the haze is left. Smoke "
               "counts that is nearer than 10 cm, or within 45 degrees of where the camera looks. 0: there is none.")},
};

static const SporeParameter probe_parameters[] = {
    NAME(SporeProbeFields, N_("Name of the tool.")),
    SPORE_ROW_BODY(SporeProbeFields, body, body, N_("Active body that the tool moves.")),
    SPORE_ROW_REFERENCE(SporeProbeFields, device, device, "mouse|track", N_("Device that moves the tool.")),
};

static const SporeParameter emitter_parameters[] = {
    NAME(SporeWoundFields, N_("Name of the emitter.")),
    SPORE_ROW_BODY(SporeWoundFields, body, body, N_("Fluid that comes out.")),
    SPORE_ROW_BODY(SporeWoundFields, source, source, N_("Body that the mouth is in and moves with; none: the scene.")),
    SPORE_ROW_PLACE(SporeWoundFields, point, N_("Middle of the mouth at the start, in the scene.")),
    SPORE_ROW_DIRECTION(SporeWoundFields, direction, 1, 0, 0,
                        N_("Direction in which it comes out at the start, in the scene.")),
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

#define MODE(text)                                                                                                     \
  {                                                                                                                    \
    .name = "mode", .type = SPORE_CHOICE, .unit = "", ANY, .initial = {SPORE_FIDELITY_PHYSICAL},                       \
    .choices = spore_fidelities, FIELD(SporeFidelityFields, mode), .change = SPORE_CHANGE_LIVE, .doc = text            \
  }
#define ADVICE                                                                                                         \
  SPORE_ADVICE_ROWS(N_("What spore advise found for it, for mode auto."),                                              \
                    N_("What the advice was found for, as a number; where the scene has changed since, it is "         \
                       "physical."))

static const SporeParameter clip_parameters[] = {
    MODE(N_("What the clamp does. physical: it presses tissue, and holds it by the spheres that it presses. effect: a "
            "clip that is put on: nothing feels it, it goes along with what it closed on until it is opened, and the "
            "tissue between its jaws is drawn squeezed; wounds beside it stop as they do otherwise. auto: what was "
            "advised, as long as that holds for the scene. It may change while it runs.")),
    ADVICE,
};

static const SporeParameter seep_parameters[] = {
    MODE(N_("What comes out. physical: the particles of its fluid. effect: no particle; what would have come out is "
            "counted, and stains what the mouth is in around it, as far as it would run over that as a film of half a "
            "millimetre. auto: what was advised, as long as that holds for the scene. It may change while it runs.")),
    ADVICE,
};

const SporeElement spore_tool_elements[] = {
    {"effects", N_("Effects"), N_("What goes on besides what bodies do."), .children = CHILDREN("emitter")},
    {"emitter", N_("Emitter"), N_("A mouth that particles of a fluid come out of: a wound that bleeds."),
     TABLE(emitter_parameters, SporeWoundFields), .extra = &spore_emitter_parameters,
     .extra_offset = offsetof(SporeWoundFields, emitter), .ordered = TRUE, .children = CHILDREN("emitter/fidelity")},
    {"fidelity", N_("Fidelity"), N_("Whether particles come out, or an effect stands for them."),
     TABLE(seep_parameters, SporeFidelityFields), .key = "emitter/fidelity"},
    {"fidelity", N_("Fidelity"), N_("Whether the clamp is simulated, or an effect."),
     TABLE(clip_parameters, SporeFidelityFields), .key = "clamp/fidelity"},
    {"tools", N_("Tools"), N_("What the user holds, and looks through."), .children = CHILDREN("probe", "camera")},
    {"probe", N_("Probe"), N_("An active body moved by a device."), TABLE(probe_parameters, SporeProbeFields)},
    {"camera", N_("Camera"), N_("A view of the scene."), TABLE(camera_parameters, SporeCameraFields)},
    {"devices", N_("Devices"), N_("Where input comes from."), .children = CHILDREN("mouse", "track")},
    {"mouse", N_("Mouse"), N_("The pointer on the screen."), TABLE(mouse_parameters, SporeMouseFields)},
    {"track", N_("Track"), N_("Recorded input, played back."), TABLE(track_parameters, SporeTrackFields)},
    {"exercise", N_("Exercise"), N_("What the trainee is asked to do, and how well that is done."),
     .extra = &spore_exercise_parameters, .size = sizeof(SporeExerciseFields)},
    {NULL},
};
