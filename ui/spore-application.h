/* The program: schema, actions of the whole (app.quit, app.about, app.new-window), keys. */
#ifndef SPORE_UI_SPORE_APPLICATION_H
#define SPORE_UI_SPORE_APPLICATION_H

#include <gtk/gtk.h>

G_BEGIN_DECLS

#define SPORE_TYPE_APPLICATION spore_application_get_type()
G_DECLARE_FINAL_TYPE(SporeApplication, spore_application, SPORE, APPLICATION, GtkApplication)

/* scenes: folder of the scenes that ship. */
SporeApplication *spore_application_new(const char *version, const char *scenes);

G_END_DECLS
#endif
