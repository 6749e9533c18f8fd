/* The program: schema, actions of the whole (app.quit, app.about, app.new-window), keys. */
#ifndef SPORE_UI_SPORE_APPLICATION_H
#define SPORE_UI_SPORE_APPLICATION_H

#include <gtk/gtk.h>

#include "core/scene/schema.h"

G_BEGIN_DECLS

#define SPORE_TYPE_APPLICATION spore_application_get_type()
G_DECLARE_FINAL_TYPE(SporeApplication, spore_application, SPORE, APPLICATION, GtkApplication)

/* scenes: folder of the scenes that ship. */
SporeApplication *spore_application_new(const char *version, const char *scenes);
const SporeSchema *spore_application_get_schema(SporeApplication *self);
/* File of the demo scene. g_free; NULL: not installed. */
char *spore_application_get_demo(SporeApplication *self);

G_END_DECLS
#endif
