/* Translations: the catalogue that is installed, or the one of the build tree where the program is not installed. */
#include "app/catalogue.h"

#include <glib.h>
#include <libintl.h>
#include <locale.h>

#include "core/base/error.h"

static const char *translate(const char *text) { return dgettext(GETTEXT_PACKAGE, text); }

/* A program that runs from the build tree finds its catalogues in the build tree. */
static char *catalogue_folder(void) {
  g_autofree char *program = g_file_read_link("/proc/self/exe", NULL);
  if (program) {
    g_autofree char *folder = g_path_get_dirname(program);
    g_autofree char *built = g_build_filename(folder, "..", "po", NULL);
    if (g_file_test(built, G_FILE_TEST_IS_DIR)) return g_steal_pointer(&built);
  }
  return g_strdup(SPORE_LOCALE_FOLDER);
}

void spore_catalogue_start(void) {
  setlocale(LC_ALL, "");
  setlocale(LC_NUMERIC, "C");
  g_autofree char *folder = catalogue_folder();
  bindtextdomain(GETTEXT_PACKAGE, folder);
  bind_textdomain_codeset(GETTEXT_PACKAGE, "UTF-8");
  textdomain(GETTEXT_PACKAGE);
  spore_set_translate(translate);
}
