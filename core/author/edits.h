/* Edits that an author makes in one gesture. Each is one undo step of document commands. No GTK. */
#ifndef SPORE_AUTHOR_EDITS_H
#define SPORE_AUTHOR_EDITS_H

#include "core/scene/document.h"

/* Mesh asset that the body shows, NULL with an error where it has none. */
SporeObject *spore_edit_visual_mesh(SporeDocument *document, SporeObject *body, GError **error);
/* Asset of one of these elements that a property of the body's unit names, or NULL: ("collision", "spheres",
 * "spheres"). */
SporeObject *spore_edit_used_asset(SporeDocument *document, SporeObject *body, const char *unit, const char *property,
                                   const char *elements);
/* Whether anything in the scene names the object. */
gboolean spore_edit_is_used(const SporeDocument *document, const SporeObject *object);
/* The asset of that element with this content, which is made where the scene has none, and is named so then. Takes
 * text, of `size` bytes, from g_malloc. Call it inside a group. */
SporeObject *spore_edit_put_asset(SporeDocument *document, const char *element, const char *name, const char *extension,
                                  char *text, gsize size, GError **error);
/* The child of that element. A missing child is made. Call it inside a group. */
SporeObject *spore_edit_child_or_new(SporeDocument *document, SporeObject *parent, const char *element, GError **error);

/* Gives the body a mechanical model of that element, on the geometry that the model needs where the body has one. The
 * body becomes passive. "" removes the mechanical unit. */
gboolean spore_edit_set_model(SporeDocument *document, SporeObject *body, const char *model, GError **error);
/* Gives a body without a model the usual model for the geometry: the first model that accepts it. Call it inside a
 * group. */
gboolean spore_edit_give_usual_model(SporeDocument *document, SporeObject *body, SporeGeometryKind kind,
                                     GError **error);
/* Sets the parameters of the body's model to those of one of its presets. */
gboolean spore_edit_use_preset(SporeDocument *document, SporeObject *body, const char *name, GError **error);

/* Pins the organ at its lowest and rearmost point, so that it does not fall. Returns the pin. */
SporeObject *spore_edit_add_pin(SporeDocument *document, SporeObject *body, GError **error);

/* Draws the body in that colour: red, green and blue as in sRGB, 0 to 1. Call it inside a group. */
gboolean spore_edit_set_colour(SporeDocument *document, SporeObject *body, const double colour[3], GError **error);

/* Sets a vector to four decimals: a place to a tenth of a millimetre. */
gboolean spore_edit_set_vector(SporeDocument *document, SporeObject *object, const char *property, SporeVec3 v,
                               GError **error);
/* The object of a path. Where the last part is a unit that the body lacks, the unit is made. NULL with an error. */
SporeObject *spore_edit_object_or_unit(SporeDocument *document, const char *path, GError **error);
/* Ends the group of an edit (done), or undoes the edits of the group (not done). Returns done. */
gboolean spore_edit_finish(SporeDocument *document, gboolean done);

/* Sets a property by path ("bodies/liver/collision"), name and text as in a file; text NULL: back to the default. A
 * missing unit of a body is made. */
gboolean spore_edit_set_property(SporeDocument *document, const char *path, const char *property, const char *text,
                                 GError **error);
/* The same for each of the paths, which end with NULL, as one undo step. FALSE: nothing was changed. */
gboolean spore_edit_set_property_of_all(SporeDocument *document, char *const *paths, const char *property,
                                        const char *text, GError **error);

#endif
