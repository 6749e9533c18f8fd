/* The renderer: drawables by handle, and drawing them into a picture that is read back. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "ui/render/frame.h"
#include "ui/render/passes.h"

/* A hardware driver takes several samples of each edge at little cost. */
#define HARDWARE_SAMPLES 4
#define LARGEST_PICTURE 16384
#define SMALL_PICTURE 8 /* that makes programs ready */

struct SporeRenderer {
  SporeOffscreen *offscreen; /* borrowed */
  SporeCanvas canvas;
  SporeTarget screen;        /* what is read back */
  SporeTarget straight;      /* what a lens bends into the screen's picture */
  SporeTarget sampled;       /* what is drawn into when the hardware takes several samples */
  SporeTarget background;    /* alone, for plain pictures on processors */
  gboolean background_light; /* of which room */
  SporePicture picture;
  GLsync begun; /* passed when the picture that was begun is drawn; NULL: none was */
  int samples, largest;
};

static void forget_begun(SporeRenderer *renderer) {
  if (renderer->begun) glDeleteSync(renderer->begun);
  renderer->begun = NULL;
}

SporeRenderer *spore_renderer_new(SporeOffscreen *offscreen, GError **error) {
  if (!spore_offscreen_make_current(offscreen)) {
    spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, _("graphics"),
                      _("the OpenGL context cannot be made current; a context that no other thread uses was expected; "
                        "close other 3D programs and start again"));
    return NULL;
  }
  SporeRenderer *renderer = g_new0(SporeRenderer, 1);
  renderer->offscreen = offscreen;
  renderer->canvas.drawables = g_ptr_array_new();
  renderer->canvas.grid = spore_grid_new();
  renderer->canvas.textures = g_ptr_array_new();
  glGenBuffers(1, &renderer->canvas.block);
  glGenVertexArrays(1, &renderer->canvas.screen_array);
  glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &renderer->largest);
  renderer->samples = spore_offscreen_is_software(offscreen) ? 0 : HARDWARE_SAMPLES;
  const SporeProgramKind needed[] = {SPORE_PROGRAM_SURFACE, SPORE_PROGRAM_SPHERE, SPORE_PROGRAM_LINE,
                                     SPORE_PROGRAM_BACKGROUND};
  for (guint i = 0; i < G_N_ELEMENTS(needed); i++)
    if (!spore_programs_get(&renderer->canvas.programs, needed[i], SPORE_VARIANT_FAST, error)) {
      spore_renderer_free(renderer);
      return NULL;
    }
  return renderer;
}

void spore_renderer_free(SporeRenderer *renderer) {
  if (!renderer) return;
  spore_renderer_clear(renderer);
  for (guint i = 0; i < renderer->canvas.grid->len; i++) spore_drawable_free(renderer->canvas.grid->pdata[i]);
  for (guint i = 0; i < renderer->canvas.textures->len; i++)
    spore_texture_image_free(renderer->canvas.textures->pdata[i]);
  spore_programs_clear(&renderer->canvas.programs);
  spore_target_clear(&renderer->screen);
  spore_target_clear(&renderer->straight);
  spore_target_clear(&renderer->sampled);
  spore_target_clear(&renderer->background);
  spore_picture_clear(&renderer->picture);
  forget_begun(renderer);
  glDeleteBuffers(1, &renderer->canvas.block);
  glDeleteVertexArrays(1, &renderer->canvas.screen_array);
  g_ptr_array_free(renderer->canvas.drawables, TRUE);
  g_ptr_array_free(renderer->canvas.grid, TRUE);
  g_ptr_array_free(renderer->canvas.textures, TRUE);
  g_free(renderer);
}

gboolean spore_renderer_has_used(const SporeRenderer *renderer, const char *shader) {
  const SporePrograms *programs = &renderer->canvas.programs;
  for (int kind = 0; kind < SPORE_PROGRAM_COUNT; kind++)
    if (programs->programs[kind][SPORE_VARIANT_FULL].id &&
        g_str_equal(spore_program_name((SporeProgramKind)kind), shader))
      return TRUE;
  return FALSE;
}

/* Handles. */

/* The first free place, whose number from 1 is the handle. */
static guint keep(GPtrArray *array, gpointer thing) {
  guint i = 0;
  while (i < array->len && array->pdata[i]) i++;
  if (i == array->len) g_ptr_array_add(array, thing);
  else array->pdata[i] = thing;
  return i + 1;
}

static guint add(SporeRenderer *renderer, SporeDrawable *drawable) {
  return keep(renderer->canvas.drawables, drawable);
}

static SporeDrawable *find(SporeRenderer *renderer, guint handle) {
  spore_offscreen_make_current(renderer->offscreen);
  return handle > 0 && handle <= renderer->canvas.drawables->len ? renderer->canvas.drawables->pdata[handle - 1] : NULL;
}

static void *find_kind(SporeRenderer *renderer, guint handle, SporeDrawableKind kind) {
  SporeDrawable *drawable = find(renderer, handle);
  g_return_val_if_fail(drawable && drawable->kind == kind, NULL);
  return drawable;
}

guint spore_renderer_add_surface(SporeRenderer *renderer, const double *vertices, gsize vertex_count,
                                 const guint32 *triangles, gsize triangle_count, const SporeSurfaceStyle *style) {
  spore_offscreen_make_current(renderer->offscreen);
  return add(renderer, &spore_surface_new(vertices, vertex_count, triangles, triangle_count, style, NULL)->base);
}

guint spore_renderer_add_valued_surface(SporeRenderer *renderer, const double *vertices, gsize vertex_count,
                                        const guint32 *triangles, gsize triangle_count, const float *values) {
  static const SporeSurfaceStyle plain = {.colour = {0.5f, 0.5f, 0.5f}};
  spore_offscreen_make_current(renderer->offscreen);
  return add(renderer, &spore_surface_new(vertices, vertex_count, triangles, triangle_count, &plain, values)->base);
}

void spore_renderer_value_surface(SporeRenderer *renderer, guint surface, const float *values) {
  SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  if (drawable) spore_surface_value(drawable, values);
}

gboolean spore_renderer_fills_surface(SporeRenderer *renderer, guint surface) {
  const SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  return drawable && spore_surface_is_filled(drawable);
}

void spore_renderer_move_surface(SporeRenderer *renderer, guint surface, const double *vertices) {
  SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  if (drawable) spore_surface_move(drawable, vertices);
}

guint spore_renderer_add_texture(SporeRenderer *renderer, const char *place, GBytes *png, GError **error) {
  spore_offscreen_make_current(renderer->offscreen);
  SporeTextureImage *image = spore_texture_image_new(place, png, error);
  return image ? keep(renderer->canvas.textures, image) : 0;
}

void spore_renderer_remove_texture(SporeRenderer *renderer, guint texture) {
  g_return_if_fail(texture > 0 && texture <= renderer->canvas.textures->len);
  spore_offscreen_make_current(renderer->offscreen);
  spore_texture_image_free(renderer->canvas.textures->pdata[texture - 1]);
  renderer->canvas.textures->pdata[texture - 1] = NULL;
}

void spore_renderer_lay_texture(SporeRenderer *renderer, guint surface, const double *vertices, guint texture,
                                const float *places) {
  SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  g_return_if_fail(texture > 0 && texture <= renderer->canvas.textures->len);
  if (drawable) spore_surface_lay(drawable, vertices, renderer->canvas.textures->pdata[texture - 1], places);
}

void spore_renderer_stain_surface(SporeRenderer *renderer, guint surface, const float *stain) {
  SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  if (drawable) spore_surface_stain(drawable, stain);
}

void spore_renderer_mix_surface(SporeRenderer *renderer, guint surface, const float *share,
                                const SporeMixture *mixture) {
  SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  if (drawable) spore_surface_mix(drawable, share, mixture);
}

void spore_renderer_style_surface(SporeRenderer *renderer, guint surface, const SporeSurfaceStyle *style) {
  SporeSurfaceGroup *drawable = find_kind(renderer, surface, SPORE_DRAW_SURFACE);
  if (drawable) drawable->style = *style;
}

guint spore_renderer_add_spheres(SporeRenderer *renderer, const double *spheres, gsize count, const float colour[3],
                                 const float *values, gboolean overlay) {
  spore_offscreen_make_current(renderer->offscreen);
  return add(renderer, &spore_sphere_group_new(spheres, count, colour, values, overlay)->base);
}

void spore_renderer_stain_spheres(SporeRenderer *renderer, guint group, const float *stain) {
  SporeSphereGroup *drawable = find_kind(renderer, group, SPORE_DRAW_SPHERES);
  if (drawable) spore_sphere_group_stain(drawable, stain);
}

void spore_renderer_move_spheres(SporeRenderer *renderer, guint group, const double *spheres, gsize count) {
  SporeSphereGroup *drawable = find_kind(renderer, group, SPORE_DRAW_SPHERES);
  if (drawable) spore_sphere_group_move(drawable, spheres, count);
}

void spore_renderer_value_spheres(SporeRenderer *renderer, guint group, const float *values) {
  SporeSphereGroup *drawable = find_kind(renderer, group, SPORE_DRAW_SPHERES);
  if (drawable) spore_sphere_group_value(drawable, values);
}

guint spore_renderer_add_puffs(SporeRenderer *renderer, const float colour[3]) {
  spore_offscreen_make_current(renderer->offscreen);
  return add(renderer, &spore_puff_group_new(colour)->base);
}

void spore_renderer_move_puffs(SporeRenderer *renderer, guint group, const SporePuff *puffs, gsize count) {
  SporePuffGroup *drawable = find_kind(renderer, group, SPORE_DRAW_PUFFS);
  if (drawable) spore_puff_group_move(drawable, puffs, count);
}

guint spore_renderer_add_lines(SporeRenderer *renderer, const double *points, gsize count, const float colour[3],
                               float width) {
  spore_offscreen_make_current(renderer->offscreen);
  return add(renderer, &spore_line_group_new(points, count, colour, width)->base);
}

void spore_renderer_see_lines_through(SporeRenderer *renderer, guint group, double share) {
  SporeLineGroup *drawable = find_kind(renderer, group, SPORE_DRAW_LINES);
  if (drawable) drawable->hidden = (float)share;
}

void spore_renderer_move_lines(SporeRenderer *renderer, guint group, const double *points, gsize count) {
  SporeLineGroup *drawable = find_kind(renderer, group, SPORE_DRAW_LINES);
  if (drawable) spore_line_group_move(drawable, points, count);
}

void spore_renderer_tint_beyond(SporeRenderer *renderer, const SporeCone *cones, guint count) {
  g_return_if_fail(count <= SPORE_CONES_MOST);
  if (count) memcpy(renderer->canvas.cones, cones, count * sizeof *cones);
  renderer->canvas.cone_count = count;
}

void spore_renderer_remove(SporeRenderer *renderer, guint handle) {
  SporeDrawable *drawable = find(renderer, handle);
  g_return_if_fail(drawable);
  renderer->canvas.drawables->pdata[handle - 1] = NULL;
  spore_drawable_free(drawable);
}

void spore_renderer_set_visible(SporeRenderer *renderer, guint handle, gboolean visible) {
  SporeDrawable *drawable = find(renderer, handle);
  g_return_if_fail(drawable);
  drawable->visible = visible;
}

void spore_renderer_clear(SporeRenderer *renderer) {
  spore_offscreen_make_current(renderer->offscreen);
  for (guint i = 0; i < renderer->canvas.drawables->len; i++) spore_drawable_free(renderer->canvas.drawables->pdata[i]);
  g_ptr_array_set_size(renderer->canvas.drawables, 0);
}

void spore_renderer_count_triangles(const SporeRenderer *renderer, gsize *whole, gsize *coarse) {
  *whole = *coarse = 0;
  for (guint i = 0; i < renderer->canvas.drawables->len; i++) {
    const SporeDrawable *drawable = renderer->canvas.drawables->pdata[i];
    if (!drawable || !drawable->visible || drawable->kind != SPORE_DRAW_SURFACE) continue;
    *whole += spore_surface_shown((const SporeSurfaceGroup *)drawable, FALSE);
    *coarse += spore_surface_shown((const SporeSurfaceGroup *)drawable, TRUE);
  }
}

/* Drawing. */

static void set_state(void) {
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glFrontFace(GL_CW); /* the projection is upside down */
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_FRAMEBUFFER_SRGB);
}

static gboolean lost_context(GError **error) {
  return spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, _("graphics"),
                           _("the OpenGL context was lost; it was expected to last; start again"));
}

gboolean spore_renderer_warm(SporeRenderer *renderer, GError **error) {
  SporeTarget small = {0};
  if (!spore_offscreen_is_software(renderer->offscreen)) return TRUE;
  if (!spore_offscreen_make_current(renderer->offscreen)) return lost_context(error);
  set_state();
  gboolean warm =
      spore_target_prepare(&small, SMALL_PICTURE, SMALL_PICTURE, 0, GL_SRGB8_ALPHA8, GL_DEPTH24_STENCIL8, error) &&
      spore_canvas_warm(&renderer->canvas, &small, error);
  spore_target_clear(&small);
  return warm;
}

/* Puts the background into the target. It is the same from picture to picture where no haze lies before it, and on
 * processors a copy costs a twentieth of drawing it. The frame is set. */
static gboolean lay_background(SporeRenderer *renderer, const SporeRenderOptions *options, const SporeTarget *target,
                               GError **error) {
  SporeTarget *background = &renderer->background;
  int width = target->width, height = target->height;
  gboolean kept = background->framebuffer && background->width == width && background->height == height &&
                  renderer->background_light == options->light;
  if (!kept) {
    if (!spore_target_prepare(background, width, height, 0, GL_SRGB8_ALPHA8, 0, error)) return FALSE;
    spore_target_bind(background);
    if (!spore_background_pass(&renderer->canvas, SPORE_VARIANT_FAST, error)) {
      spore_target_clear(background);
      return FALSE;
    }
    renderer->background_light = options->light;
  }
  glBindFramebuffer(GL_READ_FRAMEBUFFER, background->framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target->framebuffer);
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  return TRUE;
}

static gboolean draw_fast(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                          const SporeTarget *screen, GError **error) {
  SporeFrame frame;
  const SporeTarget *target = screen;
  int width = screen->width, height = screen->height;
  if (renderer->samples) {
    if (!spore_target_prepare(&renderer->sampled, width, height, renderer->samples, GL_SRGB8_ALPHA8,
                              GL_DEPTH24_STENCIL8, error))
      return FALSE;
    target = &renderer->sampled;
  }
  spore_frame_prepare(&frame, camera, &renderer->canvas, options, width, height);
  spore_canvas_set_frame(&renderer->canvas, &frame);
  frame.backed = renderer->samples == 0 && camera->haze == 0;
  if (frame.backed && !lay_background(renderer, options, target, error)) return FALSE;
  spore_target_bind(target);
  glClear(GL_DEPTH_BUFFER_BIT); /* the background covers what nothing else does */
  if (!spore_canvas_draw(&renderer->canvas, &frame, SPORE_VARIANT_FAST, options->grid, error)) return FALSE;
  if (target == screen) return TRUE;
  glBindFramebuffer(GL_READ_FRAMEBUFFER, target->framebuffer);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, screen->framebuffer);
  glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  spore_target_bind(screen);
  return TRUE;
}

static gboolean draw_straight(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                              const SporeTarget *target, GError **error) {
  if (!options->antialias) return draw_fast(renderer, camera, options, target, error);
  return spore_picture_draw(&renderer->picture, &renderer->canvas, camera, options, target, renderer->largest, error);
}

/* Draws the straight picture, in full quality so large that its middle is as sharp as without a lens; then bends it. */
static gboolean draw_through_lens(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                                  GError **error) {
  SporeFrame frame;
  SporeTarget *straight = &renderer->straight;
  int width = options->width, height = options->height, largest = MIN(renderer->largest, LARGEST_PICTURE);
  double scale = options->antialias ? MIN(1 / (1 - camera->distortion), (double)largest / MAX(width, height)) : 1;
  if (!spore_target_prepare(straight, (int)lround(scale * width), (int)lround(scale * height), 0, GL_SRGB8_ALPHA8,
                            GL_DEPTH24_STENCIL8, error) ||
      !draw_straight(renderer, camera, options, straight, error))
    return FALSE;
  spore_frame_prepare(&frame, camera, &renderer->canvas, options, width, height);
  spore_canvas_set_frame(&renderer->canvas, &frame);
  spore_target_bind(&renderer->screen);
  return spore_lens_pass(&renderer->canvas, straight, camera->blood > 0 || camera->water > 0, error);
}

gboolean spore_renderer_begin(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                              GError **error) {
  int width = options->width, height = options->height, largest = MIN(renderer->largest, LARGEST_PICTURE);
  if (width < 1 || height < 1 || width > largest || height > largest)
    return spore_error_raise(error, SPORE_ERROR_INPUT, _("picture size"),
                             _("%d x %d pixels cannot be drawn; 1 to %d each way was expected; ask for another size"),
                             width, height, largest);
  if (!spore_offscreen_make_current(renderer->offscreen)) return lost_context(error);
  forget_begun(renderer);
  while (glGetError() != GL_NO_ERROR) {
  }
  if (options->grid) spore_grid_update(renderer->canvas.grid, camera, options->light);
  set_state();
  if (!spore_target_prepare(&renderer->screen, width, height, 0, GL_SRGB8_ALPHA8, GL_DEPTH24_STENCIL8, error))
    return FALSE;
  gboolean lens = camera->distortion > 0 || camera->blood > 0 || camera->water > 0;
  gboolean drawn = lens ? draw_through_lens(renderer, camera, options, error)
                        : draw_straight(renderer, camera, options, &renderer->screen, error);
  if (drawn) renderer->begun = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
  return drawn;
}

gboolean spore_renderer_is_drawn(SporeRenderer *renderer, guint wait_ms) {
  if (!renderer->begun || !spore_offscreen_make_current(renderer->offscreen)) return FALSE;
  return glClientWaitSync(renderer->begun, GL_SYNC_FLUSH_COMMANDS_BIT, (GLuint64)wait_ms * 1000000) !=
         GL_TIMEOUT_EXPIRED; /* a wait that failed is told by what reads */
}

gboolean spore_renderer_read(SporeRenderer *renderer, guint8 *pixels, gsize stride, GError **error) {
  int width = renderer->screen.width, height = renderer->screen.height;
  g_return_val_if_fail(renderer->begun && stride >= 4 * (gsize)width && stride % 4 == 0, FALSE);
  if (!spore_offscreen_make_current(renderer->offscreen)) return lost_context(error);
  forget_begun(renderer);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, renderer->screen.framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 4);
  glPixelStorei(GL_PACK_ROW_LENGTH, (GLint)(stride / 4));
  glReadPixels(0, 0, width, height, GL_BGRA, GL_UNSIGNED_INT_8_8_8_8_REV, pixels);
  GLenum code = glGetError();
  if (code == GL_NO_ERROR) return TRUE;
  return spore_error_raise(
      error, SPORE_ERROR_INTERNAL, _("graphics"),
      _("drawing failed with OpenGL error %#x; none was expected; please report it together with the "
        "name of the graphics card"),
      code);
}

gboolean spore_renderer_draw(SporeRenderer *renderer, const SporeCamera *camera, const SporeRenderOptions *options,
                             guint8 *pixels, gsize stride, GError **error) {
  return spore_renderer_begin(renderer, camera, options, error) && spore_renderer_read(renderer, pixels, stride, error);
}
