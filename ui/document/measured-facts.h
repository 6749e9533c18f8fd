/* What a study measured, beside the settings that it measured: in words, for the inspector. No GTK. */
#ifndef SPORE_UI_DOCUMENT_MEASURED_FACTS_H
#define SPORE_UI_DOCUMENT_MEASURED_FACTS_H

#include "ui/document/spore-editor-document.h"

/* Error and cost of the value that a property has, with what else the scene has: by the last study, else by what the
 * scene remembers. path: of the object. *hint: the other values that the study measured; g_free. *stale: the scene has
 * changed since. g_free. NULL, and no hint: it was not measured, or is nothing that a study varies. */
char *spore_measured_note(SporeEditorDocument *document, const char *path, const char *property, char **hint,
                          gboolean *stale);
/* "measured: 1.2 % off, 0.11 ms a step (implicit_euler at 4 ms)", with what it is stale by. g_free. NULL: the scene
 * remembers nothing. */
char *spore_measured_sentence(SporeEditorDocument *document);

#endif
