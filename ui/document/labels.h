/* How names in parameter tables read to people. */
#ifndef SPORE_UI_DOCUMENT_LABELS_H
#define SPORE_UI_DOCUMENT_LABELS_H

#include <glib.h>

/* "Bending stiffness" of "bending_stiffness", not translated. g_free. */
char *spore_label_of_name(const char *name);
/* FALSE for abbreviations such as mm or LPS, which stay as they are. */
gboolean spore_name_is_word(const char *name);

#endif
