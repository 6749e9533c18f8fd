/* spore export --format player: a folder with the compiled scene and the program that runs it. */
#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <gnu/libc-version.h>
#include <string.h>
#include <sys/utsname.h>
#include <unistd.h>

#include "core/base/memory.h"
#include "core/io/file_batch.h"
#include "core/io/helper.h"
#include "ui/export/private.h"

#define PLAYER "spore-player"
#define SCENE "scene.run"

static const char play[] = "#!/bin/sh\n"
                           "# ./play [--steps N] [--json]\n"
                           "here=$(dirname \"$0\")\n"
                           "exec \"$here/" PLAYER "\" \"$here/" SCENE "\" \"$@\"\n";

/* A folder under way. */
typedef struct Folder {
  SporeExport *export;
  SporeFileBatch *batch;
  int above;  /* open: what the folder lies in */
  char *name; /* of the folder there */
} Folder;

/* program: people run the file. */
static gboolean add_file(Folder *folder, const char *file, gconstpointer content, gsize size, gboolean program,
                         GError **error) {
  g_autofree char *shown = g_build_filename(folder->export->output, file, NULL);
  g_autofree char *path = g_build_filename(folder->name, file, NULL);
  if (!spore_file_batch_add(folder->batch, folder->above, shown, path, content, size, error) ||
      (program && !spore_file_batch_let_run(folder->batch, error)))
    return FALSE;
  spore_export_wrote(folder->export, shown, size);
  return TRUE;
}

static gboolean add_text(Folder *folder, const char *file, const char *text, gboolean program, GError **error) {
  return add_file(folder, file, text, strlen(text), program, error);
}

static gboolean add_player(Folder *folder, GError **error) {
  g_autofree char *path = spore_helper_path(PLAYER), *content = NULL;
  gsize size = 0;
  if (!path)
    return spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, folder->export->output, "%s",
                             _("the program spore-player is not there; expected it beside spore; install SPORE whole, "
                               "or name its folder in SPORE_HELPERS"));
  return g_file_get_contents(path, &content, &size, error) && add_file(folder, PLAYER, content, size, TRUE, error);
}

static gboolean add_scene(Folder *folder, GError **error) {
  gsize size = 0;
  gpointer content = spore_export_format_runtime(folder->export, &size, error);
  gboolean done = content && add_file(folder, SCENE, content, size, FALSE, error);
  spore_free(content);
  return done;
}

static gboolean add_words(Folder *folder, GError **error) {
  struct utsname machine;
  uname(&machine);
  g_autofree char *text =
      g_strdup_printf(_("A scene of SPORE, and the program that runs it.\n\n"
                        "./play [--steps N] [--json] runs the scene, and says the state that it comes to and how its "
                        "exercise went.\n\n"
                        "It runs on Linux (%s) with the C library glibc %s or a later one; it needs no other library.\n"
                        "spore-player is free software: GPL-3.0-or-later. For training and preview only.\n"),
                      machine.machine, gnu_get_libc_version());
  return add_text(folder, "README.txt", text, FALSE, error);
}

/* A folder that holds something may be the author's own. */
static gboolean is_free(const Folder *folder, GError **error) {
  const char *output = folder->export->output;
  GDir *there = g_dir_open(output, 0, NULL);
  gboolean taken = there ? g_dir_read_name(there) != NULL : g_file_test(output, G_FILE_TEST_EXISTS);
  if (there) g_dir_close(there);
  return !taken || spore_error_raise(error, SPORE_ERROR_FILE, output, "%s",
                                     _("there is something already; expected a folder that is empty or not there; "
                                       "name another one"));
}

static gboolean write_folder(Folder *folder, GError **error) {
  folder->above = spore_file_open_folder(folder->export->output, error);
  return folder->above >= 0 && is_free(folder, error) && add_scene(folder, error) && add_player(folder, error) &&
         add_text(folder, "play", play, TRUE, error) && add_words(folder, error) &&
         spore_file_batch_commit(folder->batch, error);
}

gboolean spore_export_player(SporeExport *export, GError **error) {
  Folder folder = {
      .export = export, .batch = spore_file_batch_new(), .above = -1, .name = g_path_get_basename(export->output)};
  gboolean done = write_folder(&folder, error);
  spore_file_batch_free(folder.batch);
  if (folder.above >= 0) close(folder.above);
  g_free(folder.name);
  spore_export_lose(export, g_strdup(_("pictures: the player draws nothing, and no device of a hand leads the "
                                       "instruments; the recorded ones do")));
  return done;
}
