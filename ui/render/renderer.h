/* Drawing with OpenGL 3.3 core. No GTK here: the editor, `spore render` and the golden pictures share it. */
#ifndef SPORE_UI_RENDER_RENDERER_H
#define SPORE_UI_RENDER_RENDERER_H

#include <glib.h>

#include "core/mesh/mesh.h"
#include "core/scene/error.h"
#include "ui/render/camera.h"

/* An OpenGL context without a window, on a machine with or without a display (EGL surfaceless, else a device). It is
 * current in the thread that made it; make_current makes it current in the calling thread. */
typedef struct SporeOffscreen SporeOffscreen;
SporeOffscreen *spore_offscreen_new(GError **error);
void spore_offscreen_free(SporeOffscreen *offscreen);
gboolean spore_offscreen_make_current(SporeOffscreen *offscreen);
/* Current in no thread, so that another thread can make it current. On the thread in which it is. */
void spore_offscreen_release(SporeOffscreen *offscreen);
const char *spore_offscreen_renderer(const SporeOffscreen *offscreen); /* GL_RENDERER */
gboolean spore_offscreen_is_software(const SporeOffscreen *offscreen);

/* What is drawn: surfaces and sphere groups, by handle. Buffers are copied. */
typedef struct SporeRenderer SporeRenderer;
typedef enum SporeMaterial { SPORE_MATERIAL_TISSUE, SPORE_MATERIAL_METAL, SPORE_MATERIAL_LIQUID } SporeMaterial;
typedef struct SporeSurfaceStyle {
  float colour[3]; /* linear light */
  float wetness;   /* 0..1: film of the specular lobe */
  SporeMaterial material;
  gboolean selected, wireframe;
  float clearness; /* 0..1: how much is seen of what lies behind it */
} SporeSurfaceStyle;

SporeRenderer *spore_renderer_new(SporeOffscreen *offscreen, GError **error);
void spore_renderer_free(SporeRenderer *renderer);
/* Whether a picture that was drawn needed this shader: file of a fragment shader in resources/shaders. */
gboolean spore_renderer_has_used(const SporeRenderer *renderer, const char *shader);
guint spore_renderer_add_surface(SporeRenderer *renderer, const double *vertices, gsize vertex_count,
                                 const guint32 *triangles, gsize triangle_count, const SporeSurfaceStyle *style);
/* A surface coloured by the scale (colour_scale.h). values: one a vertex, 0..1; below 0: grey. */
guint spore_renderer_add_valued_surface(SporeRenderer *renderer, const double *vertices, gsize vertex_count,
                                        const guint32 *triangles, gsize triangle_count, const float *values);
/* Colours a surface by the scale, in place of its own look. values: one a vertex, 0..1, and as 1 beyond; below 0: its
 * own look; NULL: all of it has its own look again. */
void spore_renderer_value_surface(SporeRenderer *renderer, guint surface, const float *values);
/* Whether its cut by a plane is filled: it is closed. */
gboolean spore_renderer_fills_surface(SporeRenderer *renderer, guint surface);
void spore_renderer_move_surface(SporeRenderer *renderer, guint surface, const double *vertices); /* normals follow */
/* A picture for surfaces; its content is a PNG (core/scene/texture.h). 0 with a GError: it cannot be decoded, or there
 * is no memory for it. */
guint spore_renderer_add_texture(SporeRenderer *renderer, const char *place, GBytes *png, GError **error);
/* Surfaces that wear it are removed before. */
void spore_renderer_remove_texture(SporeRenderer *renderer, guint texture);
/* Lays a texture over a new surface: it is multiplied by the colour. vertices: as they were added; places: of each
 * corner of each triangle, triangle_count x 3 x 2, from the picture's upper left corner (0 0) to its lower right one.
 */
void spore_renderer_lay_texture(SporeRenderer *renderer, guint surface, const double *vertices, guint texture,
                                const float *places);
/* stain: one a vertex, 0..1: how much blood covers it; none at first. */
void spore_renderer_stain_surface(SporeRenderer *renderer, guint surface, const float *stain);
/* What a liquid is mixed with. */
typedef struct SporeMixture {
  float colour[3], clearness; /* as of SporeSurfaceStyle */
} SporeMixture;
/* share: one a vertex of a liquid's surface, 0..1: how much of what is there is the mixture; none at first. */
void spore_renderer_mix_surface(SporeRenderer *renderer, guint surface, const float *share,
                                const SporeMixture *mixture);
void spore_renderer_style_surface(SporeRenderer *renderer, guint surface, const SporeSurfaceStyle *style);
/* Spheres as impostors that write depth. values: one a sphere in 0..1 for the colour map, or NULL for `colour`. */
guint spore_renderer_add_spheres(SporeRenderer *renderer, const double *spheres, gsize count, const float colour[3],
                                 const float *values, gboolean overlay);
/* stain: one a sphere, 0..1, as of surfaces; none at first. */
void spore_renderer_stain_spheres(SporeRenderer *renderer, guint group, const float *stain);
/* count: as many as were added; for spheres without values, also fewer. */
void spore_renderer_move_spheres(SporeRenderer *renderer, guint group, const double *spheres, gsize count);
/* Colours spheres by the scale. values: one a sphere, as many as were added, 0..1; NULL: they have the group's colour.
 */
void spore_renderer_value_spheres(SporeRenderer *renderer, guint group, const float *values);
/* Puffs of smoke, each soft and translucent; none at first. */
typedef struct SporePuff {
  double centre[3], radius; /* m, world */
  double opacity;           /* 0..1, of its middle */
  double seed;              /* of its pattern: a small number that stays the same */
} SporePuff;
guint spore_renderer_add_puffs(SporeRenderer *renderer, const float colour[3]);
void spore_renderer_move_puffs(SporeRenderer *renderer, guint group, const SporePuff *puffs, gsize count);
/* Line segments, count x 2 points x 3; overlays are drawn dimmed where hidden. */
guint spore_renderer_add_lines(SporeRenderer *renderer, const double *points, gsize count, const float colour[3],
                               float width);
/* Sets the opacity of the hidden parts of lines, 0..1; at first a fifth. */
void spore_renderer_see_lines_through(SporeRenderer *renderer, guint group, double share);
void spore_renderer_move_lines(SporeRenderer *renderer, guint group, const double *points, gsize count);
/* Places that are reached: within an angle of a direction, and between two distances. */
typedef struct SporeCone {
  SporeVec3 pivot, along; /* world, m; of length 1 */
  double angle;           /* rad */
  double least, most;     /* m */
} SporeCone;
#define SPORE_CONES_MOST 32
/* Tints the tissue of surfaces that lies in none of the cones; count, at most SPORE_CONES_MOST, 0: nothing is tinted.
 * spore_tint_colour: of the tint, 0..1 of a screen, for legends. */
void spore_renderer_tint_beyond(SporeRenderer *renderer, const SporeCone *cones, guint count);
extern const double spore_tint_colour[3];
void spore_renderer_remove(SporeRenderer *renderer, guint handle);
void spore_renderer_set_visible(SporeRenderer *renderer, guint handle, gboolean visible);
void spore_renderer_clear(SporeRenderer *renderer);

/* A plane that hides what lies before it, at places p with normal . p > distance. Zeros hide nothing. */
typedef struct SporeClip {
  SporeVec3 normal; /* unit, world */
  double distance;  /* m */
} SporeClip;
static inline gboolean spore_clip_hides(const SporeClip *clip, SporeVec3 place) {
  return spore_vec3_dot(clip->normal, place) > clip->distance;
}
static inline gboolean spore_clip_is_on(const SporeClip *clip) { return spore_vec3_length(clip->normal) > 0; }

typedef struct SporeRenderOptions {
  int width, height;
  gboolean grid; /* floor grid and axes: editing; off for pictures. Never clipped */
  gboolean antialias;
  gboolean coarse; /* surfaces of very many triangles are drawn with fewer of them */
  int scale;       /* pixels of the picture in one of the widget's: lines are so much wider; 0: 1 */
  gboolean light;  /* the room around the scene, as for print; else dark, as a body is */
  SporeClip clip;  /* closed surfaces that it cuts are filled there; others are seen from inside */
} SporeRenderOptions;
/* A software driver compiles a program when it first draws with it, for a hundred times as long as it draws: makes
 * those ready that pictures without antialias are drawn with. Another driver has nothing to gain. */
gboolean spore_renderer_warm(SporeRenderer *renderer, GError **error);
/* Triangles of the surfaces that are shown, and how many of them a coarse picture draws. */
void spore_renderer_count_triangles(const SporeRenderer *renderer, gsize *whole, gsize *coarse);
/* Begins a picture, which the driver draws while the caller goes on. What was begun before and not read is forgotten.
 */
gboolean spore_renderer_begin(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                              GError **error);
/* Whether the picture that was begun is drawn; waits for that for at most so long. FALSE: none was begun. */
gboolean spore_renderer_is_drawn(SporeRenderer *renderer, guint wait_ms);
/* Reads back the picture that was begun, and waits for it: pixels is height rows of `stride` bytes, top first, as
 * CAIRO_FORMAT_RGB24 (native BGRx). */
gboolean spore_renderer_read(SporeRenderer *renderer, guint8 *pixels, gsize stride, GError **error);
/* Draws and reads back. */
gboolean spore_renderer_draw(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                             guint8 *pixels, gsize stride, GError **error);

/* Pixels, laid out as above, as the content of a PNG. NULL with a GError: no memory. */
GBytes *spore_png_encode(const guint8 *pixels, int width, int height, gsize stride, GError **error);
/* Writes pixels, laid out as above, as a PNG; the file that was there stays where that fails (spore_write_file). */
gboolean spore_png_write(const char *file, const guint8 *pixels, int width, int height, gsize stride, GError **error);

#endif
