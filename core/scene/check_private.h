/* What the files of the checks share: messages, walks over objects, and one entry a subject. */
#ifndef SPORE_SCENE_CHECK_PRIVATE_H
#define SPORE_SCENE_CHECK_PRIVATE_H

#include "core/scene/check.h"
#include "core/scene/compile.h"
#include "core/scene/length_unit.h"

/* Elements that can hold a body where it is: links, and a needle its thread. */
#define SPORE_HOLDING "pin|spring|ball|hinge|weld|seam|slide|needle"

typedef struct SporeCheck {
  SporeDocument *document;
  const SporeCancel *cancel;
  GPtrArray *found;  /* of SporeDiagnostic * */
  GHashTable *users; /* object -> GPtrArray of the objects that refer to that object */
  guint faults;
} SporeCheck;

/* Adds a diagnostic about an object (NULL: the whole scene). message_format is a printf format for the arguments that
 * follow; the remedy is used as it is. */
void spore_check_say(SporeCheck *check, SporeSeverity severity, const SporeObject *object, const char *remedy,
                     const char *message_format, ...) G_GNUC_PRINTF(5, 6);
/* Says that the last diagnostic can be fixed so. */
void spore_check_offer(SporeCheck *check, SporeFix fix);
/* Says that the last diagnostic is fixed by setting properties (names joined by |) of the object to the text. NULL:
 * back to their defaults. */
void spore_check_offer_set(SporeCheck *check, const SporeObject *object, const char *properties, const char *value);
/* Adds the message of another room, "PLACE: what is wrong; what was expected; what to do", as a diagnostic about the
 * object. */
void spore_check_say_error(SporeCheck *check, SporeSeverity severity, const SporeObject *object, const GError *error);

/* Calls `visit` for each object of a section that has this element name; NULL: for each object. */
typedef void (*SporeCheckVisit)(SporeCheck *check, SporeObject *object);
void spore_check_each(SporeCheck *check, const char *section, const char *element, SporeCheckVisit visit);

/* Whether an object of one of these elements (joined by |; NULL: any) refers to the asset. */
gboolean spore_check_is_used(const SporeCheck *check, const SporeObject *object, const char *elements);

void spore_check_links(SporeCheck *check);    /* links that tie nothing, and bodies that are tied too often */
void spore_check_assets(SporeCheck *check);   /* assets: readable, used, of a likely size, up to date */
void spore_check_textures(SporeCheck *check); /* pictures of bodies that are missing, too large or of another mesh */
/* Values far from those of the material that the author named. */
void spore_check_materials(SporeCheck *check);
void spore_check_exercise(SporeCheck *check); /* steps of the exercise that no tool can do */
void spore_check_solver(SporeCheck *check);   /* methods and contact choices without effect */
/* Links whose points lie far from what they tie. */
void spore_check_link_points(SporeCheck *check, const SporeSimulation *simulation);
/* Pins that clamp a line elsewhere than at their radius. */
void spore_check_pins(SporeCheck *check, const SporeSimulation *simulation);
/* Drawn vertices and collision spheres that lie off the geometry that moves them. */
void spore_check_mapping(SporeCheck *check, const SporeSimulation *simulation);
/* Kept poses of another shape. */
void spore_check_poses(SporeCheck *check, const SporeSimulation *simulation);
/* Levels of detail whose rule of change has nothing to act on. */
void spore_check_levels(SporeCheck *check, const SporeSimulation *simulation);
void spore_check_motion(SporeCheck *check); /* overlaps and loose bodies; compiles the scene for it */

#endif
