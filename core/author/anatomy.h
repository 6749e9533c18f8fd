/* What the name of an organ says: the colour that it is drawn in, and its tissue. */
#ifndef SPORE_AUTHOR_ANATOMY_H
#define SPORE_AUTHOR_ANATOMY_H

#include "core/scene/document.h"

/* Red, green and blue as in sRGB, 0 to 1: as atlases paint that organ; of names that say nothing, one of many muted
 * colours, by the number. */
void spore_anatomy_colour(const char *name, guint number, double colour[3]);
/* Whether the name says an organ or a tissue. */
gboolean spore_anatomy_knows(const char *name);
/* A material of the scene, by name; NULL: the name says none. */
const char *spore_anatomy_material(const char *name);

/* Why a volume can hardly be that of an organ of that name: "what; remedy", translated. NULL: it can, or the name says
 * no organ whose size is known. g_free. */
char *spore_anatomy_doubt(const char *name, double volume_m3);

/* Cells for its volume that an organ of that name should have, relative to one whose name says no tissue: the root of
 * how much softer than 5 kPa its tissue is, from 1/2 to 2, as what is softer bends and gives way more. */
double spore_anatomy_cell_weight(const char *name);

/* Gives a body, made under that name, its colour and, where it has a mechanical unit, its material. Call it inside a
 * group. */
gboolean spore_edit_use_anatomy(SporeDocument *document, SporeObject *body, const char *name, guint number,
                                GError **error);

#endif
