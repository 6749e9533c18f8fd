/* What an author does in one gesture, each one undo step made of document commands. No GTK. */
#ifndef SPORE_AUTHOR_EDITS_H
#define SPORE_AUTHOR_EDITS_H

#include "core/scene/document.h"

/* Mesh asset that the body shows, NULL with an error where it has none. */
SporeObject *spore_edit_visual_mesh(SporeDocument *document, SporeObject *body, GError **error);
/* Asset of one of these elements that a property of the body's unit names, or NULL: ("collision", "spheres",
 * "spheres"). */
SporeObject *spore_edit_used_asset(SporeDocument *document, SporeObject *body, const char *unit, const char *property,
                                   const char *elements);
/* The child of that element, made where there is none. Inside a group. */
SporeObject *spore_edit_child_or_new(SporeDocument *document, SporeObject *parent, const char *element, GError **error);

/* Gives the body a mechanical model of that element and so makes it passive, on the geometry it asks for where the body
 * has it; "" takes the mechanical unit away. */
gboolean spore_edit_set_model(SporeDocument *document, SporeObject *body, const char *model, GError **error);
/* A body that no model moves yet gets the usual one for the geometry: the first that takes it. Inside a group. */
gboolean spore_edit_give_usual_model(SporeDocument *document, SporeObject *body, SporeGeometryKind kind,
                                     GError **error);
/* Sets the parameters of the body's model to those of one of its presets. */
gboolean spore_edit_use_preset(SporeDocument *document, SporeObject *body, const char *name, GError **error);
/* Element of the body's model, or NULL. */
SporeObject *spore_edit_body_model(SporeObject *body);

/* A probe moved by the mouse, just above the highest point of what the scene shows. Returns its body. */
SporeObject *spore_edit_add_probe(SporeDocument *document, GError **error);
/* First active body, or NULL. */
SporeObject *spore_edit_find_probe(SporeDocument *document);

/* Holds the organ where it lies lowest and farthest behind, so that it does not fall. Returns the pin. */
SporeObject *spore_edit_add_pin(SporeDocument *document, SporeObject *body, GError **error);

/* The object of a path whose last part may be a unit that its body does not have yet: that is made. NULL with an error.
 */
SporeObject *spore_edit_object_or_unit(SporeDocument *document, const char *path, GError **error);
/* Ends the group of an edit, or takes back what it did. Returns done. */
gboolean spore_edit_finish(SporeDocument *document, gboolean done);

/* Sets by path ("bodies/liver/collision"), property name and text as in a file; text NULL: back to the default.
 * A unit of a body that is not there yet ("bodies/liver/collision") is made. */
gboolean spore_edit_set_property(SporeDocument *document, const char *path, const char *property, const char *text,
                                 GError **error);

#endif
