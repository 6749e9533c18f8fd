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

static void clear_surface(gpointer data) { spore_triangle_mesh_clear(&((SporeNamedSurface *)data)->mesh); }

static gboolean add_surface(Surfaces *surfaces, const SporeDrawnPart *part, GError **error) {
  SporeNamedSurface surface = {.name = g_intern_string(part->name), .wetness = part->wetness};
  memcpy(surface.colour, part->colour, sizeof surface.colour);
  if (!spore_drawn_part_mesh(part, &surface.mesh, error)) return FALSE;
  if (surface.mesh.triangle_count) g_array_append_val(surfaces->all, surface);
  else spore_triangle_mesh_clear(&surface.mesh);
  return TRUE;
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

static gboolean write_surfaces(SporeExport *export, SurfaceWriter write, gboolean colours, GError **error) {
  Surfaces surfaces = {export, g_array_new(FALSE, FALSE, sizeof(SporeNamedSurface))};
  g_array_set_clear_func(surfaces.all, clear_surface);
  gboolean done = spore_export_show(export, take_surfaces, &surfaces, error);
  if (done && !surfaces.all->len) done = spore_export_refuse_empty(export, error);
  done = done && write(export, (const SporeNamedSurface *)(gconstpointer)surfaces.all->data, surfaces.all->len, error);
  g_array_unref(surfaces.all);
  spore_export_lose(export, g_strdup(_("motion: one moment is shown, without velocities")));
  spore_export_lose_physics(export, colours);
  return done;
}

/* The materials lie beside the file, under its name. */
static char *materials_of(const char *output) {
  const char *end = g_str_has_suffix(output, ".obj") ? output + strlen(output) - strlen(".obj") : strchr(output, 0);
  return g_strdup_printf("%.*s.mtl", (int)(end - output), output);
}

static gboolean write_obj(SporeExport *export, const SporeNamedSurface *all, gsize count, GError **error) {
  gsize size, materials_size;
  g_autofree char *file = materials_of(export->output), *name = g_path_get_basename(file);
  g_autofree char *text = spore_obj_format_scene(all, count, name, &size);
  g_autofree char *materials = spore_mtl_format(all, count, &materials_size);
  SporeFileBatch *batch = spore_file_batch_new();
  gboolean done = spore_file_batch_add_path(batch, file, materials, materials_size, error) &&
                  spore_file_batch_add_path(batch, export->output, text, size, error) &&
                  spore_file_batch_commit(batch, error);
  spore_file_batch_free(batch);
  spore_export_wrote(export, export->output, size);
  spore_export_wrote(export, file, materials_size);
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
  return write_surfaces(export, write_obj, TRUE, error);
}

gboolean spore_export_ply(SporeExport *export, GError **error) {
  lose_names(export);
  spore_export_lose(export, g_strdup(_("wetness")));
  return write_surfaces(export, write_ply, TRUE, error);
}

gboolean spore_export_stl(SporeExport *export, GError **error) {
  lose_names(export);
  return write_surfaces(export, write_stl, FALSE, error);
}
