/* spore edit --move, --turn, --scale and --align: bodies with all that is placed on them. */
#ifndef SPORE_APP_CLI_EDIT_PLACE_H
#define SPORE_APP_CLI_EDIT_PLACE_H

#include "core/scene/document.h"

/* What the command line asks for; each a list that ends with NULL, or NULL. */
typedef struct SporeCliPlacing {
  char **move;  /* BODY=X,Y,Z: by so much, m */
  char **turn;  /* BODY=AXIS:DEGREES: about the middle of its box */
  char **scale; /* BODY,BODY=FACTOR: about the middle of the box around them */
  char **align; /* BODY,BODY=AXIS:least|middle|greatest: with the first */
} SporeCliPlacing;

/* Does it in that order, and adds the paths of the bodies (g_free) to `changed`. FALSE with a GError: what was given is
 * not of the form, there is no such body, or a place would be out of range. */
gboolean spore_cli_place(SporeDocument *document, const SporeCliPlacing *placing, GPtrArray *changed, GError **error);

#endif
