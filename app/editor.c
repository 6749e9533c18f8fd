/* spore-editor: the editor's window on a scene. */
#include <glib/gi18n.h>
#include <locale.h>
#include <stdlib.h>

#include "app/catalogue.h"
#include "app/ending.h"
#include "ui/document/preferences.h"
#include "ui/jobs/loop-gaps.h"
#include "ui/spore-application.h"

static gboolean show_version, tell_gaps;
static const GOptionEntry options[] = {
    {"version", 0, 0, G_OPTION_ARG_NONE, &show_version, N_("Say the version and end"), NULL},
    {"tell-gaps", 0, 0, G_OPTION_ARG_NONE, &tell_gaps,
     N_("Tell on stderr when the window did not answer for more than 100 ms, and what was going on"), NULL},
    {NULL},
};

static int handle_options(GApplication *application, GVariantDict *given, gpointer data) {
  if (!show_version) {
    spore_gaps_watch(tell_gaps);
    return -1; /* go on */
  }
  g_print("spore-editor %s\n", SPORE_VERSION);
  return EXIT_SUCCESS;
}

/* Beside the sources when the program runs from the build tree, else where scenes are installed. */
static const char *scenes_folder(void) {
  return g_file_test(SPORE_SOURCE_SCENES, G_FILE_TEST_IS_DIR) ? SPORE_SOURCE_SCENES : SPORE_INSTALLED_SCENES;
}

/* gettext looks for LANGUAGE first, but for the locale that has no language at all. */
static void choose_language(void) {
  const char *language = spore_preference_get(spore_preference_find("language"));
  if (g_str_equal(language, "system")) return;
  g_setenv("LANGUAGE", language, TRUE);
  setlocale(LC_ALL, "");
  if (g_str_equal(setlocale(LC_MESSAGES, NULL), "C")) g_setenv("LC_ALL", "C.UTF-8", TRUE);
}

int main(int argc, char **argv) {
  spore_ending_prepare();
  gtk_disable_setlocale(); /* numbers stay in the C locale, as in files */
  choose_language();
  spore_catalogue_start();
  spore_ending_translate();
  spore_ending_on_signals();
  g_set_prgname("spore-editor");
  g_set_application_name("SPORE");
  g_autoptr(SporeApplication) application = spore_application_new(SPORE_VERSION, scenes_folder());
  g_application_add_main_option_entries(G_APPLICATION(application), options);
  g_application_set_option_context_parameter_string(G_APPLICATION(application), _("[SCENE]"));
  g_application_set_option_context_summary(G_APPLICATION(application),
                                           _("Builds scenes for surgical simulation, and runs them."));
  g_signal_connect(application, "handle-local-options", G_CALLBACK(handle_options), NULL);
  return g_application_run(G_APPLICATION(application), argc, argv);
}
