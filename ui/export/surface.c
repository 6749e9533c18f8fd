/* spore export --format obj, ply, stl: the surfaces of a scene at a moment. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/file_batch.h"
#include "core/io/surface_write.h"
#include "ui/export/private.h"

/* An export of surfaces: what the moment gave. */
typedef struct Surfaces {
  SporeExport *export;
  GArray *all; /* of SporeNamedSurface; their names are the document's */
} Surfaces;

static gboolean add_surface(Surfaces *surfaces, const SporeDrawnPart *part, GError **error) {
  SporeNamedSurface surface = spore_export_surface(part);
  gboolean done = spore_drawn_part_mesh(part, &surface.mesh, error);
  if (done && surface.mesh.triangle_count) g_array_append_val(surfaces->all, surface);
  else spore_named_surface_clear(&surface);
  return done;
}

static gboolean take_surfaces(gpointer data, const SporeDrawing *drawing, double time_s, GError **error) {
  Surfaces *surfaces = data;
  gboolean inner = FALSE;
  for (guint i = 0; i < spore_drawing_part_count(drawing); i++) {
    const SporeDrawnPart *part = spore_drawing_part(drawing, i);
    inner |= part->kind != SPORE_PART_SURFACE;
    if (part->smoke) {
      spore_export_lose(surfaces->export, g_strdup_printf(_("%s: smoke has no surface"), part->name));
    } else if (part->shows && !add_surface(surfaces, part, error)) {
      return FALSE;
    }
  }
  if (inner)
    spore_export_lose(surfaces->export, g_strdup(_("what lies beneath surfaces: tetrahedra, middle lines, particles")));
  return TRUE;
}

/* Writes what was taken. */
typedef gboolean (*SurfaceWriter)(SporeExport *export, const SporeNamedSurface *all, gsize count, GError **error);

static gboolean write_surfaces(SporeExport *export, SurfaceWriter write, gboolean colours, gboolean materials,
                               GError **error) {
  Surfaces surfaces = {export, g_array_new(FALSE, FALSE, sizeof(SporeNamedSurface))};
  g_array_set_clear_func(surfaces.all, (GDestroyNotify)spore_named_surface_clear);
  gboolean done = spore_export_show(export, take_surfaces, &surfaces, error);
  if (done && !surfaces.all->len) done = spore_export_refuse_empty(export, error);
  done = done && write(export, (const SporeNamedSurface *)(gconstpointer)surfaces.all->data, surfaces.all->len, error);
  g_array_unref(surfaces.all);
  spore_export_lose(export, g_strdup(_("motion: one moment is shown, without velocities")));
  spore_export_lose_physics(export, colours, materials);
  return done;
}

/* What lies beside the file has its name, with this ending. g_free. */
static char *beside(const char *output, const char *ending) {
  const char *end = g_str_has_suffix(output, ".obj") ? output + strlen(output) - strlen(".obj") : strchr(output, 0);
  return g_strdup_printf("%.*s%s", (int)(end - output), output, ending);
}

/* The first surface that wears the picture of surface i: it names the file. */
static gsize first_with(const SporeNamedSurface *all, gsize i) {
  gsize first = 0;
  while (!all[first].picture || !g_bytes_equal(all[first].picture, all[i].picture)) first++;
  return first;
}

/* Adds a file for each picture. names: of each surface's picture, without its folder, or NULL; g_free. */
static gboolean add_pictures(SporeFileBatch *batch, SporeExport *export, const SporeNamedSurface *all, gsize count,
                             char **names, GError **error) {
  for (gsize i = 0; i < count; i++) {
    if (!all[i].picture) continue;
    gsize first = first_with(all, i), size;
    gconstpointer bytes = g_bytes_get_data(all[i].picture, &size);
    g_autofree char *ending = g_strdup_printf("-%s.png", all[first].name), *file = beside(export->output, ending);
    names[i] = g_path_get_basename(file);
    if (first == i && !spore_file_batch_add_path(batch, file, bytes, size, error)) return FALSE;
    if (first == i) spore_export_wrote(export, file, size);
  }
  return TRUE;
}

static gboolean write_obj(SporeExport *export, const SporeNamedSurface *all, gsize count, GError **error) {
  gsize size, materials_size;
  g_autofree char *file = beside(export->output, ".mtl"), *name = g_path_get_basename(file);
  g_autofree char *text = spore_obj_format_scene(all, count, name, &size), *materials = NULL;
  spore_export_wrote(export, export->output, size);
  SporeFileBatch *batch = spore_file_batch_new();
  char **pictures = g_new0(char *, count);
  gboolean done = add_pictures(batch, export, all, count, pictures, error);
  if (done) materials = spore_mtl_format(all, count, pictures, &materials_size);
  done = done && spore_file_batch_add_path(batch, file, materials, materials_size, error) &&
         spore_file_batch_add_path(batch, export->output, text, size, error) && spore_file_batch_commit(batch, error);
  spore_file_batch_free(batch);
  if (done) spore_export_wrote(export, file, materials_size);
  for (gsize i = 0; i < count; i++) g_free(pictures[i]);
  g_free(pictures);
  return done;
}

static gboolean write_content(SporeExport *export, GByteArray *content, GError **error) {
  gboolean done = spore_export_write(export, content->data, content->len, error);
  g_byte_array_unref(content);
  return done;
}

static gboolean write_ply(SporeExport *export, const SporeNamedSurface *all, gsize count, GError **error) {
  return write_content(export, spore_ply_format(all, count), error);
}

static gboolean write_stl(SporeExport *export, const SporeNamedSurface *all, gsize count, GError **error) {
  return write_content(export, spore_stl_format(all, count), error);
}

static void lose_names(SporeExport *export) {
  spore_export_lose(export, g_strdup(_("which surface is of which body: they are one mesh")));
}

gboolean spore_export_obj(SporeExport *export, GError **error) {
  spore_export_lose(export, g_strdup(_("wetness")));
  return write_surfaces(export, write_obj, TRUE, TRUE, error);
}

gboolean spore_export_ply(SporeExport *export, GError **error) {
  lose_names(export);
  spore_export_lose(export, g_strdup(_("wetness")));
  return write_surfaces(export, write_ply, TRUE, FALSE, error);
}

gboolean spore_export_stl(SporeExport *export, GError **error) {
  lose_names(export);
  return write_surfaces(export, write_stl, FALSE, FALSE, error);
}
