/* The checks of a scene, by subject. */
#ifndef SPORE_SCENE_CHECK_PRIVATE_H
#define SPORE_SCENE_CHECK_PRIVATE_H

#include "core/scene/check.h"
#include "core/scene/compile.h"
#include "core/scene/length_unit.h"

/* Elements of the links that can hold a body where it is. */
#define SPORE_HOLDING_LINKS "pin|spring|ball|hinge|weld|seam|slide"

typedef struct SporeCheck {
  SporeDocument *document;
  GPtrArray *found;  /* of SporeDiagnostic * */
  GHashTable *users; /* object -> GPtrArray of the objects that refer to it */
  guint faults;
} SporeCheck;

/* message_format is printed with what follows; the remedy is taken as it is. */
void spore_check_say(SporeCheck *check, SporeSeverity severity, const SporeObject *object, const char *remedy,
                     const char *message_format, ...) G_GNUC_PRINTF(5, 6);
/* A message of another room, "PLACE: what is wrong; what was expected; what to do", at the object. */
void spore_check_say_error(SporeCheck *check, SporeSeverity severity, const SporeObject *object, const GError *error);

/* Calls visit for each object of a section whose element it is; NULL: each. */
typedef void (*SporeCheckVisit)(SporeCheck *check, SporeObject *object);
void spore_check_each(SporeCheck *check, const char *section, const char *element, SporeCheckVisit visit);

/* Whether an object of one of the elements (joined by |; NULL: any) refers to this one. */
gboolean spore_check_is_used(const SporeCheck *check, const SporeObject *object, const char *elements);

void spore_check_links(SporeCheck *check);  /* that tie nothing, and bodies that are tied too often */
void spore_check_assets(SporeCheck *check); /* readable, used, of a likely size, fresh */
/* Values far from those of the material that the author named. */
void spore_check_materials(SporeCheck *check);
void spore_check_solver(SporeCheck *check); /* choices that nothing makes use of */
/* Links whose points lie far from what they tie. */
void spore_check_link_points(SporeCheck *check, const SporeSimulation *simulation);
/* Vertices and spheres that lie off what carries them. */
void spore_check_mapping(SporeCheck *check, const SporeSimulation *simulation);
void spore_check_motion(SporeCheck *check); /* overlaps and loose bodies; compiles the scene */

#endif
