/* spore export --format vtk: a series over time that ParaView opens. Each moment is a file of blocks (.vtm), each block
 * a file of a part of a body (.vtp, .vtu), and the series (.pvd) names the moments. */
#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "core/io/file_batch.h"
#include "core/io/vtk_write.h"
#include "ui/export/private.h"

/* A series under way. */
typedef struct Series {
  SporeExport *export;
  SporeFileBatch *batch;
  int directory;    /* open */
  char *shown;      /* the directory's name in messages, with a slash; empty: the present one */
  char *folder;     /* of the data below the directory, with a slash; empty: the directory itself */
  char *stem;       /* of the file that names the others */
  char *series;     /* this file, below the directory */
  GArray *times;    /* double, s */
  GPtrArray *files; /* of the moments, relative to that file */
  GPtrArray *still; /* by parts: the file of what never moves; NULL: not written yet */
} Series;

/* The output with a name of its own where it is "." or "..". g_free. */
static char *named_output(const char *output) {
  g_autofree char *name = g_path_get_basename(output);
  gboolean named = !g_str_equal(name, ".") && !g_str_equal(name, "..");
  return named ? g_strdup(output) : g_canonicalize_filename(output, NULL);
}

/* F.pvd: the data lie in a folder F beside it. Another name is that of a folder, which holds all. */
static gboolean open_series(Series *series, GError **error) {
  const char *output = series->export->output;
  g_autofree char *path = named_output(output);
  g_autofree char *above = g_path_get_dirname(path), *name = g_path_get_basename(path);
  gboolean is_file = g_str_has_suffix(name, ".pvd") && strlen(name) > strlen(".pvd");
  series->stem = is_file ? g_strndup(name, strlen(name) - strlen(".pvd")) : g_strdup(name);
  series->folder = g_strconcat(series->stem, "/", NULL);
  series->series = g_strconcat(is_file ? "" : series->folder, series->stem, ".pvd", NULL);
  series->shown = g_str_equal(above, ".") ? g_strdup("") : g_strconcat(above, "/", NULL);
  series->directory = open(above, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  return series->directory >= 0 || spore_file_refuse(errno, output, error);
}

static void close_series(Series *series) {
  spore_file_batch_free(series->batch);
  if (series->directory >= 0) close(series->directory);
  g_free(series->shown);
  g_free(series->folder);
  g_free(series->stem);
  g_free(series->series);
  g_array_unref(series->times);
  g_ptr_array_unref(series->files);
  g_ptr_array_unref(series->still);
}

/* name: below the directory. */
static gboolean add_file(Series *series, const char *name, gconstpointer content, gsize size, GError **error) {
  g_autofree char *shown = g_strconcat(series->shown, name, NULL);
  if (!spore_file_batch_add(series->batch, series->directory, shown, name, content, size, error)) return FALSE;
  spore_export_wrote(series->export, shown, size);
  return TRUE;
}

/* What a block is called: the body, and where the part lies beneath what shows the body, what it is. '+' is in no name
 * of a body. */
static char *block_name(const SporeDrawnPart *part) {
  static const char *const kinds[] = {"surface", "tetrahedra", "line", "points"};
  return part->shows ? g_strdup(part->name) : g_strconcat(part->name, "+", kinds[part->kind], NULL);
}

/* Writes the part. *file: its name beside the other files. */
static gboolean add_part(Series *series, const SporeDrawnPart *part, const char *block, double time_s, char **file,
                         GError **error) {
  const char *suffix = spore_vtk_suffix(part);
  *file = part->moves ? g_strdup_printf("%s-%06u.%s", block, series->times->len, suffix)
                      : g_strdup_printf("%s.%s", block, suffix);
  g_autofree char *name = g_strconcat(series->folder, *file, NULL);
  g_autoptr(GByteArray) content = spore_vtk_format(part, time_s);
  return add_file(series, name, content->data, content->len, error);
}

/* What the series shows less of than the editor does. */
static void lose(SporeExport *export, const SporeDrawing *drawing) {
  for (guint i = 0; i < spore_drawing_part_count(drawing); i++) {
    const SporeDrawnPart *part = spore_drawing_part(drawing, i);
    if (part->smoke) spore_export_lose(export, g_strdup_printf(_("%s: how opaque its puffs are"), part->name));
    if (part->liquid)
      spore_export_lose(export, g_strdup_printf(_("%s: the skin around its particles, which are points"), part->name));
  }
}

static gboolean add_moment(gpointer data, const SporeDrawing *drawing, double time_s, GError **error) {
  Series *series = data;
  g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GPtrArray) files = g_ptr_array_new_with_free_func(g_free);
  if (!series->times->len) lose(series->export, drawing);
  g_ptr_array_set_size(series->still, (gint)spore_drawing_part_count(drawing));
  for (guint i = 0; i < spore_drawing_part_count(drawing); i++) {
    const SporeDrawnPart *part = spore_drawing_part(drawing, i);
    char *block = block_name(part), *file = g_strdup(series->still->pdata[i]);
    gboolean added = file || add_part(series, part, block, time_s, &file, error);
    g_ptr_array_add(names, block);
    g_ptr_array_add(files, file);
    if (!added) return FALSE;
    if (!part->moves && !series->still->pdata[i]) series->still->pdata[i] = g_strdup(file);
  }
  g_autofree char *blocks = spore_vtk_format_blocks(names, files);
  g_autofree char *name = g_strdup_printf("%s%s-%06u.vtm", series->folder, series->stem, series->times->len);
  gboolean inside = g_str_has_prefix(series->series, series->folder);
  g_ptr_array_add(series->files, g_strdup(inside ? name + strlen(series->folder) : name));
  g_array_append_val(series->times, time_s);
  return add_file(series, name, blocks, strlen(blocks), error);
}

static gboolean write_series(Series *series, GError **error) {
  if (!open_series(series, error) || !spore_export_show(series->export, add_moment, series, error)) return FALSE;
  g_autofree char *text = spore_vtk_format_series((const double *)(gconstpointer)series->times->data, series->files);
  return add_file(series, series->series, text, strlen(text), error) && spore_file_batch_commit(series->batch, error);
}

gboolean spore_export_vtk(SporeExport *export, GError **error) {
  Series series = {.export = export,
                   .batch = spore_file_batch_new(),
                   .directory = -1,
                   .times = g_array_new(FALSE, FALSE, sizeof(double)),
                   .files = g_ptr_array_new_with_free_func(g_free),
                   .still = g_ptr_array_new_with_free_func(g_free)};
  gboolean done = write_series(&series, error);
  close_series(&series);
  spore_export_lose_physics(export, FALSE, FALSE);
  return done;
}
