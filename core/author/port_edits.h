/* Ports that an author moves. No GTK. */
#ifndef SPORE_AUTHOR_PORT_EDITS_H
#define SPORE_AUTHOR_PORT_EDITS_H

#include "core/scene/port_reach.h"

/* Moves a port to a place of the scene, m, as one undo step. Its instrument turns about what it aims at until its shaft
 * passes through the port, as a trocar has it: its bodies, the places of its tool, and its camera, which goes on
 * looking at the same place. A recorded input stays as it is. FALSE with a GError: no instrument passes through the
 * link, or the place is too near to what the instrument aims at. */
gboolean spore_edit_move_port(SporeDocument *document, SporeObject *port, SporeVec3 pivot, GError **error);

/* What an instrument reaches, in sentences, a line each, translated; g_free. selected: a body, and how much of it each
 * port reaches; or a port, or a body, tool or camera that goes through one, and how much of each organ that reaches.
 * NULL: there is nothing to say. */
char *spore_port_sentences(SporeDocument *document, const SporeObject *selected);

#endif
