/* Inside the renderer: what is drawn, the programs that draw it, and the passes in which it happens. */
#ifndef SPORE_UI_RENDER_PASSES_H
#define SPORE_UI_RENDER_PASSES_H

#include <epoxy/gl.h>

#include "ui/render/renderer.h"

/* Programs. Each is made from its shaders in one of several variants, when it is first needed. */
typedef enum SporeVariant {
  SPORE_VARIANT_FAST,   /* one pass to the screen's colours */
  SPORE_VARIANT_FULL,   /* linear light for the composite pass; occlusion, shadow, fine detail */
  SPORE_VARIANT_DEPTH,  /* depth alone, from the eye */
  SPORE_VARIANT_SHADOW, /* depth alone, from the light */
  SPORE_VARIANT_COUNT
} SporeVariant;

typedef enum SporeProgramKind {
  SPORE_PROGRAM_SURFACE, /* of any kind; those below do a part of it, at a part of the cost */
  SPORE_PROGRAM_TEXTURED_SURFACE,
  SPORE_PROGRAM_TISSUE,
  SPORE_PROGRAM_TEXTURED_TISSUE,
  SPORE_PROGRAM_METAL,
  SPORE_PROGRAM_LIQUID,
  SPORE_PROGRAM_SPHERE,
  SPORE_PROGRAM_HIDDEN_SPHERE,
  SPORE_PROGRAM_PUFF,
  SPORE_PROGRAM_LINE,
  SPORE_PROGRAM_BACKGROUND,
  SPORE_PROGRAM_OCCLUSION,
  SPORE_PROGRAM_SMOOTH,
  SPORE_PROGRAM_GLOW,
  SPORE_PROGRAM_COMPOSITE,
  SPORE_PROGRAM_LENS,
  SPORE_PROGRAM_DRY_LENS,
  SPORE_PROGRAM_COUNT
} SporeProgramKind;

typedef struct SporeProgram {
  GLuint id; /* 0: not made yet */
  GLint offset, colour, wetness, clearness, mixture, cell, selected, material, axis, dim, width, near, fade,
      direction; /* -1: has none */
} SporeProgram;

typedef struct SporePrograms {
  SporeProgram programs[SPORE_PROGRAM_COUNT][SPORE_VARIANT_COUNT];
} SporePrograms;

/* Compiles the program when it is first needed. NULL with a GError that holds the compiler's messages. */
const SporeProgram *spore_programs_get(SporePrograms *programs, SporeProgramKind kind, SporeVariant variant,
                                       GError **error);
void spore_programs_clear(SporePrograms *programs);
/* File of its fragment shader. */
const char *spore_program_name(SporeProgramKind kind);

/* Texture units of the full variant. */
enum {
  SPORE_UNIT_OCCLUSION,
  SPORE_UNIT_SHADOW,
  SPORE_UNIT_COLOUR,
  SPORE_UNIT_DEPTH,
  SPORE_UNIT_GLOW,
  SPORE_UNIT_TEXTURE
};

/* What all shaders know; laid out as the uniform block `Frame` (std140). */
typedef struct SporeFrameBlock {
  float projection[16], rotation[16], shadow[16], light[4], viewport[4], up[4], clip[4], tint[4], lens[4], room[4];
  float pivot[SPORE_CONES_MOST][4], along[SPORE_CONES_MOST][4], limits[SPORE_CONES_MOST][4];
} SporeFrameBlock;

typedef struct SporeFrame {
  SporeFrameBlock block;
  SporeVec3 eye;    /* world, m */
  double near, far; /* m */
  gboolean coarse;  /* fine surfaces are drawn with fewer triangles */
  gboolean light;   /* the room is; see SporeRenderOptions */
  float line_scale; /* pixels in one of a line's width */
  SporeClip clip;   /* in the world */
  gboolean clips;   /* something may be hidden by the plane */
  gboolean backed;  /* the background is there before anything is drawn */
} SporeFrame;

/* What is drawn. Buffers hold positions relative to `origin`, so that single precision suffices far from the origin of
 * the world. */
typedef enum SporeDrawableKind {
  SPORE_DRAW_SURFACE,
  SPORE_DRAW_SPHERES,
  SPORE_DRAW_PUFFS,
  SPORE_DRAW_LINES
} SporeDrawableKind;
typedef struct SporeDrawable {
  SporeDrawableKind kind;
  gboolean visible;
  double origin[3], lower[3], upper[3]; /* m, world */
} SporeDrawable;

/* A picture that surfaces wear, on the graphics device with its smaller copies. */
typedef struct SporeTextureImage {
  GLuint id;
  float mean[3]; /* of its colours, linear light */
} SporeTextureImage;
/* NULL with a GError: the PNG cannot be decoded, or there is no memory for it. */
SporeTextureImage *spore_texture_image_new(const char *place, GBytes *png, GError **error);
void spore_texture_image_free(SporeTextureImage *image);

typedef struct SporeSurfaceGroup {
  SporeDrawable base;
  GLuint vertex_array, moving, rest, values, stain, indices; /* values, stain: 0: has none */
  gsize vertex_count, triangle_count;
  guint32 *triangles; /* triangle_count x 3 */
  GLuint coarse;      /* indices of fewer triangles; 0: it is always drawn whole */
  gsize coarse_count;
  double *normals; /* vertex_count x 3 */
  /* Of a textured surface: its vertices as they are drawn, one for each place that a vertex has in the texture. */
  const SporeTextureImage *texture; /* borrowed; NULL: the surface has none, and the vertices are drawn as they are */
  GLuint places;
  gsize drawn_count; /* vertices that are drawn */
  guint32 *twins;    /* drawn_count: which vertex each is; NULL: each itself */
  SporeSurfaceStyle style;
  SporeMixture mixture; /* of a liquid: its shares are `stain` */
  gboolean closed;      /* so that back faces are never seen */
  float cell;           /* m: size of the pattern of the tissue */
  float axis[3];        /* longest axis at rest */
} SporeSurfaceGroup;

typedef struct SporeSphereGroup {
  SporeDrawable base;
  GLuint vertex_array, moving, values, stain; /* values, stain: 0: has none */
  gsize count, added;                         /* that are drawn; that there is a value of each */
  float colour[3];
  gboolean overlay;
} SporeSphereGroup;

typedef struct SporePuffGroup {
  SporeDrawable base;
  GLuint vertex_array, moving;
  gsize count;
  SporePuff *puffs; /* sorted anew for every picture */
  float colour[3];
} SporePuffGroup;

typedef struct SporeLineGroup {
  SporeDrawable base;
  GLuint vertex_array, moving;
  gsize count;
  float colour[3], width;
  float fade;   /* m; 0: lines do not fade */
  float hidden; /* opacity of the hidden parts, 0..1 */
} SporeLineGroup;

/* The context must be current for all functions below. */
SporeSurfaceGroup *spore_surface_new(const double *vertices, gsize vertex_count, const guint32 *triangles,
                                     gsize triangle_count, const SporeSurfaceStyle *style, const float *values);
/* Lays a texture over a new surface. places: triangle_count x 3 x 2; vertices: as given to spore_surface_new. */
void spore_surface_lay(SporeSurfaceGroup *surface, const double *vertices, const SporeTextureImage *texture,
                       const float *places);
/* Makes the triangles that stand in for those of a fine surface. vertices: as given to spore_surface_new. */
void spore_surface_make_coarse(SporeSurfaceGroup *surface, const double *vertices);
/* How many triangles a picture of that frame draws of it. */
static inline gsize spore_surface_shown(const SporeSurfaceGroup *surface, gboolean coarse) {
  return coarse && surface->coarse && !surface->texture ? surface->coarse_count : surface->triangle_count;
}
void spore_surface_stain(SporeSurfaceGroup *surface, const float *stain);
void spore_surface_mix(SporeSurfaceGroup *surface, const float *share, const SporeMixture *mixture);
/* values: NULL: it has none any more. */
void spore_surface_value(SporeSurfaceGroup *surface, const float *values);
void spore_surface_move(SporeSurfaceGroup *surface, const double *vertices);
/* Whether something is seen through it. */
gboolean spore_surface_is_clear(const SporeSurfaceGroup *surface);
/* Whether its cut by the plane of the frame is filled. */
gboolean spore_surface_is_filled(const SporeSurfaceGroup *surface);
SporeSphereGroup *spore_sphere_group_new(const double *spheres, gsize count, const float colour[3], const float *values,
                                         gboolean overlay);
void spore_sphere_group_stain(SporeSphereGroup *group, const float *stain);
/* values: one for each sphere that was added; NULL: none has one any more. */
void spore_sphere_group_value(SporeSphereGroup *group, const float *values);
void spore_sphere_group_move(SporeSphereGroup *group, const double *spheres, gsize count);
SporePuffGroup *spore_puff_group_new(const float colour[3]);
void spore_puff_group_move(SporePuffGroup *group, const SporePuff *puffs, gsize count);
SporeLineGroup *spore_line_group_new(const double *points, gsize count, const float colour[3], float width);
void spore_line_group_move(SporeLineGroup *group, const double *points, gsize count);
void spore_drawable_free(SporeDrawable *drawable);
/* Whether one of that kind is to be seen. */
gboolean spore_drawables_show(const GPtrArray *drawables, SporeDrawableKind kind);

/* Sets the uniform of the drawable's offset: its origin relative to the eye. */
void spore_drawable_set_offset(const SporeDrawable *drawable, const SporeFrame *frame, GLint location);
/* Sets the bounds from points of `stride` doubles, each grown by its fourth number with radius; and the origin to the
 * middle with set_origin. */
void spore_drawable_set_bounds(SporeDrawable *drawable, const double *points, gsize count, gsize stride,
                               gboolean radius, gboolean set_origin);

/* The plane of the frame clips what is drawn by shaders that write gl_ClipDistance, until it is told to stop. */
void spore_frame_clip(const SporeFrame *frame, gboolean clips);

/* Passes: draw every visible drawable of their kind (NULL entries are skipped) to the bound framebuffer. Of surfaces
 * those that are clear, or the others. */
gboolean spore_surface_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs,
                            SporeVariant variant, gboolean clear, GError **error);
/* Fills the faces at which the plane of the frame cuts closed surfaces, as the inside of each; those of open surfaces
 * stay open. Uses the stencil of the framebuffer. */
gboolean spore_cap_pass(const GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs,
                        SporeVariant variant, GError **error);
/* overlays FALSE: solid spheres; TRUE: overlays, dimmed where hidden. */
gboolean spore_sphere_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                           gboolean overlays, GError **error);
/* Puffs are drawn over solids and hide nothing. They are sorted within a group. */
gboolean spore_puff_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                         GError **error);
/* hidden: lines are drawn dimmed where something stands before them. */
gboolean spore_line_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs, SporeVariant variant,
                         gboolean hidden, GError **error);

/* Floor grid and axes at y = 0 about what the camera looks at; a list of line groups. */
GPtrArray *spore_grid_new(void);
void spore_grid_update(GPtrArray *grid, const SporeCamera *camera, gboolean light);

/* Framebuffer with a texture or renderbuffer for colour and for depth. */
typedef struct SporeTarget {
  int width, height, samples;
  GLuint framebuffer, colour, depth; /* textures when samples is 0, else renderbuffers */
} SporeTarget;
/* Makes the buffers again only when the size or the samples changed. colour_format or depth_format 0: no such buffer.
 * GL_DEPTH24_STENCIL8: with a stencil. */
gboolean spore_target_prepare(SporeTarget *target, int width, int height, int samples, GLenum colour_format,
                              GLenum depth_format, GError **error);
/* Makes the target the one that is drawn into, over its whole area. */
void spore_target_bind(const SporeTarget *target);
void spore_target_clear(SporeTarget *target);

/* Everything that a picture is drawn from. */
typedef struct SporeCanvas {
  GPtrArray *drawables; /* SporeDrawable * by handle - 1, NULL where removed */
  GPtrArray *grid;      /* SporeLineGroup * */
  GPtrArray *textures;  /* SporeTextureImage * by handle - 1, NULL where removed */
  SporeCone cones[SPORE_CONES_MOST];
  guint cone_count; /* 0: nothing is tinted */
  SporePrograms programs;
  GLuint block, screen_array; /* uniform buffer; vertex array without attributes */
} SporeCanvas;

/* Gives the frame to the shaders. */
void spore_canvas_set_frame(SporeCanvas *canvas, const SporeFrame *frame);
gboolean spore_background_pass(SporeCanvas *canvas, SporeVariant variant, GError **error);
/* Draws the straight picture, as the lens of the frame shows it, into the bound framebuffer. straight: NULL: black;
 * wet: blood or water cover a share of the lens. */
gboolean spore_lens_pass(SporeCanvas *canvas, const SporeTarget *straight, gboolean wet, GError **error);
/* Draws everything that has a colour into the bound framebuffer, whose depth is cleared. */
gboolean spore_canvas_draw(SporeCanvas *canvas, const SporeFrame *frame, SporeVariant variant, gboolean grid,
                           GError **error);

/* Makes the programs of the fast variant ready, by draws into `target`, whose buffers are of the formats that pictures
 * have. */
gboolean spore_canvas_warm(SporeCanvas *canvas, const SporeTarget *target, GError **error);

/* Full quality: shadow, occlusion, several samples a pixel in linear light, glare; then film. */
typedef struct SporePicture {
  SporeTarget shadow, depth, occlusion, smoothed, colour, glow, glare;
} SporePicture;
/* Draws into `screen` (prepared, without samples). largest: of a buffer's sides, pixels. */
gboolean spore_picture_draw(SporePicture *picture, SporeCanvas *canvas, const SporeCamera *camera,
                            const SporeRenderOptions *options, const SporeTarget *screen, int largest, GError **error);
void spore_picture_clear(SporePicture *picture);

#endif
