/* spore export --format gltf: surfaces with materials, and how they move. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/io/gltf_write.h"
#include "ui/export/private.h"

#define BOUND 1e-3 /* of a body's diagonal: how far what lies between two keys may be from the run */

/* A body of the file, and where it comes from. */
typedef struct Body {
  guint part;      /* of the drawing */
  guint32 *points; /* of the part: one a vertex; NULL: the vertices are made anew at each moment */
  SporeMotionKeys keys;
  gboolean framed, whole; /* whole: as at time 0, neither cut nor of another shape */
} Body;

typedef struct Film {
  SporeExport *export;
  GArray *bodies; /* of Body */
  GArray *gltf;   /* of SporeGltfBody, the same bodies */
  GArray *times;  /* double, s */
} Film;

static Body *body_of(const Film *film, guint i) { return &g_array_index(film->bodies, Body, i); }
static SporeGltfBody *gltf_of(const Film *film, guint i) { return &g_array_index(film->gltf, SporeGltfBody, i); }

/* The first moment: what there is. */

static double diagonal_of(const SporeTriangleMesh *mesh) {
  SporeVec3 lower = spore_vec3_load(mesh->vertices), upper = lower;
  for (gsize i = 1; i < mesh->vertex_count; i++) {
    SporeVec3 p = spore_vec3_load(mesh->vertices + 3 * i);
    lower = spore_vec3(MIN(lower.x, p.x), MIN(lower.y, p.y), MIN(lower.z, p.z));
    upper = spore_vec3(MAX(upper.x, p.x), MAX(upper.y, p.y), MAX(upper.z, p.z));
  }
  return spore_vec3_distance(lower, upper);
}

static gboolean add_body(Film *film, const SporeDrawnPart *part, guint number, GError **error) {
  gboolean moves = film->export->stride && part->moves;
  SporeGltfBody gltf = {.surface = spore_export_surface(part),
                        .pose = part->framed ? part->frame : spore_pose_identity()};
  Body body = {.part = number, .framed = part->framed, .whole = TRUE};
  SporeTriangleMesh *mesh = &gltf.surface.mesh;
  gboolean done = part->framed ? spore_drawn_part_local_mesh(part, mesh, error)
                               : spore_drawn_part_mesh_of_points(part, mesh, &body.points, error);
  if (!done || !mesh->triangle_count) {
    spore_named_surface_clear(&gltf.surface);
    g_free(body.points);
    return done;
  }
  if (moves && part->framed) gltf.poses = g_array_new(FALSE, FALSE, sizeof(SporePose));
  if (moves && !part->framed) spore_motion_keys_init(&body.keys, mesh->vertex_count, BOUND * diagonal_of(mesh));
  g_array_append_val(film->gltf, gltf);
  g_array_append_val(film->bodies, body);
  return TRUE;
}

static gboolean add_bodies(Film *film, const SporeDrawing *drawing, GError **error) {
  for (guint i = 0; i < spore_drawing_part_count(drawing); i++) {
    const SporeDrawnPart *part = spore_drawing_part(drawing, i);
    if (part->smoke) {
      spore_export_lose(film->export, g_strdup_printf(_("%s: smoke has no surface"), part->name));
    } else if (part->liquid && film->export->stride) {
      spore_export_lose(film->export,
                        g_strdup_printf(_("%s: the skin of a liquid is another one at each moment, and is "
                                          "left out of a motion"),
                                        part->name));
    } else if (part->shows && !add_body(film, part, i, error)) {
      return FALSE;
    }
  }
  return TRUE;
}

/* Each moment: where the bodies are. */

/* Vertices of the surface of time 0 where they are now. */
static gboolean follow_shape(Body *body, const SporeDrawnPart *part, double time_s, GError **error) {
  g_autofree double *positions = NULL;
  SporeTriangleMesh mesh = {0};
  if (part->cut) body->whole = FALSE;
  if (body->points) {
    positions = g_new(double, 3 * body->keys.count);
    for (gsize i = 0; i < body->keys.count; i++)
      memcpy(positions + 3 * i, part->positions + 3 * (gsize)body->points[i], 3 * sizeof *positions);
    spore_motion_keys_add(&body->keys, time_s, positions);
    return TRUE;
  }
  if (!spore_drawn_part_mesh(part, &mesh, error)) return FALSE;
  if (mesh.vertex_count == body->keys.count) spore_motion_keys_add(&body->keys, time_s, mesh.vertices);
  else body->whole = FALSE;
  spore_triangle_mesh_clear(&mesh);
  return TRUE;
}

static gboolean add_moment(gpointer data, const SporeDrawing *drawing, double time_s, GError **error) {
  Film *film = data;
  if (!film->times->len && !add_bodies(film, drawing, error)) return FALSE;
  g_array_append_val(film->times, time_s);
  for (guint i = 0; i < film->bodies->len; i++) {
    Body *body = body_of(film, i);
    GArray *poses = gltf_of(film, i)->poses;
    const SporeDrawnPart *part = spore_drawing_part(drawing, body->part);
    if (poses) {
      body->whole = body->whole && part->framed;
      if (body->whole) g_array_append_val(poses, part->frame);
      else g_array_append_val(poses, g_array_index(poses, SporePose, poses->len - 1));
    }
    if (body->keys.keys && !follow_shape(body, part, time_s, error)) return FALSE;
  }
  return TRUE;
}

/* At the end. */

static gboolean stands(const GArray *poses) {
  for (guint i = 1; i < poses->len; i++)
    if (memcmp(&g_array_index(poses, SporePose, i), &g_array_index(poses, SporePose, 0), sizeof(SporePose)) != 0)
      return FALSE;
  return TRUE;
}

static void clear_motion(gpointer data) { g_free(((SporeExportedMotion *)data)->body); }

static void tell_keys(const Film *film, const char *name, const SporeMotionKeys *keys) {
  const SporeExportedMotion motion = {g_strdup(name), keys->keys->len, film->times->len, keys->error, keys->bound};
  g_array_append_val(film->export->motions, motion);
}

static void end_motion(Film *film) {
  film->export->motions = g_array_new(FALSE, FALSE, sizeof(SporeExportedMotion));
  g_array_set_clear_func(film->export->motions, clear_motion);
  for (guint i = 0; i < film->bodies->len; i++) {
    Body *body = body_of(film, i);
    SporeGltfBody *gltf = gltf_of(film, i);
    if (gltf->poses && stands(gltf->poses)) g_clear_pointer(&gltf->poses, g_array_unref);
    if (body->keys.keys) {
      spore_motion_keys_end(&body->keys);
      gltf->keys = &body->keys;
      tell_keys(film, gltf->surface.name, gltf->keys);
    }
    if (!body->whole)
      spore_export_lose(film->export,
                        g_strdup_printf(body->framed ? _("%s: how it moves after it got another level of detail")
                                                     : _("%s: its cut; its surface stays in one piece, and stretches"),
                                        gltf->surface.name));
  }
}

static gboolean write_film(Film *film, GError **error) {
  SporeExport *export = film->export;
  if (!spore_export_show(export, add_moment, film, error)) return FALSE;
  if (!film->bodies->len) return spore_export_refuse_empty(export, error);
  end_motion(film);
  GByteArray *content = spore_gltf_format((const SporeGltfBody *)(gconstpointer)film->gltf->data, film->gltf->len,
                                          film->times, export->cancel, error);
  gboolean done = content && spore_export_write(export, content->data, content->len, error);
  if (content) g_byte_array_unref(content);
  return done;
}

static void clear_film(Film *film) {
  for (guint i = 0; i < film->bodies->len; i++) {
    Body *body = body_of(film, i);
    SporeGltfBody *gltf = gltf_of(film, i);
    spore_named_surface_clear(&gltf->surface);
    if (gltf->poses) g_array_unref(gltf->poses);
    if (body->keys.keys) spore_motion_keys_clear(&body->keys);
    g_free(body->points);
  }
  g_array_unref(film->bodies);
  g_array_unref(film->gltf);
  g_array_unref(film->times);
}

gboolean spore_export_gltf(SporeExport *export, GError **error) {
  if (g_str_has_suffix(export->output, ".gltf"))
    return spore_error_raise(
        error, SPORE_ERROR_INPUT, export->output,
        _("this is the name of a glTF in text; expected .glb, the one in a single file; name it so"));
  Film film = {export, g_array_new(FALSE, FALSE, sizeof(Body)), g_array_new(FALSE, FALSE, sizeof(SporeGltfBody)),
               g_array_new(FALSE, FALSE, sizeof(double))};
  gboolean done = write_film(&film, error);
  clear_film(&film);
  spore_export_lose(export, g_strdup(_("what lies beneath surfaces: tetrahedra, middle lines, particles")));
  spore_export_lose_physics(export, TRUE, TRUE);
  return done;
}
