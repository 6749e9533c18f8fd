/* Surfaces: buffers, normals, the pattern of tissue, and their pass. */
#include <math.h>
#include <string.h>

#include "core/math/mat3.h"
#include "core/mesh/volume.h"
#include "ui/render/passes.h"

enum { VALUE = 3, STAIN = 4 }; /* attributes of the shader: a number at each vertex */

/* Value noise on a lattice, 0..1, for the coarse pattern. It is computed once a vertex instead of once a pixel. */
static double lattice(int x, int y, int z) {
  guint32 h = (guint32)x * 0x8da6b343u ^ (guint32)y * 0xd8163841u ^ (guint32)z * 0xcb1ab31fu;
  h = (h ^ (h >> 15)) * 0x2c1b3c6du;
  h = (h ^ (h >> 12)) * 0x297a2d39u;
  return (h ^ (h >> 15)) / 4294967295.0;
}

static double value_noise(const double p[3]) {
  int cell[3];
  double w[3];
  for (int i = 0; i < 3; i++) {
    double floor_p = floor(p[i]), f = p[i] - floor_p;
    cell[i] = (int)fmod(floor_p, 1 << 20);
    w[i] = f * f * (3 - 2 * f);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; corner++) {
    int dx = corner & 1, dy = corner >> 1 & 1, dz = corner >> 2;
    sum += (dx ? w[0] : 1 - w[0]) * (dy ? w[1] : 1 - w[1]) * (dz ? w[2] : 1 - w[2]) *
           lattice(cell[0] + dx, cell[1] + dy, cell[2] + dz);
  }
  return sum;
}

static float mottling(const double p[3]) {
  double sum = 0, weight = 0.5, q[3] = {0.45 * p[0], 0.45 * p[1], 0.45 * p[2]};
  for (int octave = 0; octave < 3; octave++) {
    sum += weight * value_noise(q);
    for (int i = 0; i < 3; i++) q[i] = 2.03 * q[i] + 5.7;
    weight /= 2;
  }
  return (float)(sum / 0.875);
}

/* Longest axis of the cloud of vertices: brushed metal is brushed along it. */
static void longest_axis(const SporeSurfaceGroup *surface, const double *vertices, float axis[3]) {
  double covariance[9] = {0};
  for (gsize v = 0; v < surface->vertex_count; v++)
    for (int i = 0; i < 9; i++)
      covariance[i] += (vertices[3 * v + i / 3] - surface->base.origin[i / 3]) *
                       (vertices[3 * v + i % 3] - surface->base.origin[i % 3]);
  SporeMat3 matrix, vectors;
  double values[3];
  memcpy(matrix.m, covariance, sizeof covariance);
  spore_mat3_eigen_symmetric(matrix, values, &vectors);
  SporeVec3 longest = spore_mat3_column(vectors, 2);
  axis[0] = (float)longest.x, axis[1] = (float)longest.y, axis[2] = (float)longest.z;
}

/* The size of the pattern grows slowly with the organ: cells of 8 mm on a uterus of 12 cm, 4.6 mm on an ovary of 4 cm.
 * */
static float pattern_cell(const SporeDrawable *base) {
  double d2 = 0;
  for (int i = 0; i < 3; i++) d2 += (base->upper[i] - base->lower[i]) * (base->upper[i] - base->lower[i]);
  double diagonal = sqrt(d2);
  return diagonal > 0 ? (float)(0.008 * sqrt(diagonal / 0.12)) : 1.0f;
}

static gboolean is_closed(const double *vertices, gsize vertex_count, const guint32 *triangles, gsize triangle_count) {
  SporeTriangleMesh mesh = {.vertex_count = vertex_count,
                            .triangle_count = triangle_count,
                            .vertices = (double *)vertices,
                            .triangles = (guint32 *)triangles};
  return spore_triangle_mesh_has_inside(&mesh) && spore_triangle_mesh_volume(&mesh) > 0;
}

/* Which vertex of the mesh a vertex is that is drawn. */
static inline gsize vertex_of(const SporeSurfaceGroup *surface, gsize drawn) {
  return surface->twins ? surface->twins[drawn] : drawn;
}

static void upload_rest(SporeSurfaceGroup *surface, const double *vertices) {
  float *rest = g_new(float, 4 * surface->drawn_count);
  for (gsize d = 0; d < surface->drawn_count; d++) {
    gsize v = vertex_of(surface, d);
    double cells[3];
    for (int i = 0; i < 3; i++) {
      cells[i] = (vertices[3 * v + i] - surface->base.origin[i]) / surface->cell;
      rest[4 * d + i] = (float)cells[i];
    }
    rest[4 * d + 3] = mottling(cells);
  }
  glBindBuffer(GL_ARRAY_BUFFER, surface->rest);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(surface->drawn_count * 4 * sizeof(float)), rest, GL_STATIC_DRAW);
  g_free(rest);
}

static void describe_vertices(const SporeSurfaceGroup *surface) {
  const GLsizei stride = 6 * sizeof(float);
  glBindVertexArray(surface->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, surface->moving);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, stride, (const void *)(3 * sizeof(float)));
  glBindBuffer(GL_ARRAY_BUFFER, surface->rest);
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, 0, NULL);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, surface->indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(surface->triangle_count * 3 * sizeof(guint32)), surface->triangles,
               GL_STATIC_DRAW);
  glBindVertexArray(0);
}

SporeSurfaceGroup *spore_surface_new(const double *vertices, gsize vertex_count, const guint32 *triangles,
                                     gsize triangle_count, const SporeSurfaceStyle *style, const float *values) {
  SporeSurfaceGroup *surface = g_new0(SporeSurfaceGroup, 1);
  surface->base.kind = SPORE_DRAW_SURFACE;
  surface->base.visible = TRUE;
  surface->vertex_count = surface->drawn_count = vertex_count;
  surface->triangle_count = triangle_count;
  surface->triangles = g_memdup2(triangles, triangle_count * 3 * sizeof(guint32));
  surface->normals = g_new(double, 3 * vertex_count);
  surface->style = *style;
  surface->closed = is_closed(vertices, vertex_count, triangles, triangle_count);
  glGenVertexArrays(1, &surface->vertex_array);
  glGenBuffers(1, &surface->moving);
  glGenBuffers(1, &surface->rest);
  glGenBuffers(1, &surface->indices);
  spore_drawable_set_bounds(&surface->base, vertices, vertex_count, 3, FALSE, TRUE);
  surface->cell = pattern_cell(&surface->base);
  longest_axis(surface, vertices, surface->axis);
  upload_rest(surface, vertices);
  spore_surface_move(surface, vertices);
  describe_vertices(surface);
  spore_surface_make_coarse(surface, vertices);
  if (values) spore_surface_value(surface, values);
  return surface;
}

/* The corners of the triangles as vertices that are drawn: a new one for each place that a vertex has. *places: of each
 * of them, g_free; returns the indices, triangle_count x 3, g_free. */
static guint32 *split_vertices(SporeSurfaceGroup *surface, const float *corners, GArray *places) {
  const guint32 none = G_MAXUINT32;
  g_autofree guint32 *first = g_new(guint32, surface->vertex_count + 1);
  g_autoptr(GArray) next = g_array_new(FALSE, FALSE, sizeof(guint32)); /* the next one of the same vertex */
  g_autoptr(GArray) twins = g_array_new(FALSE, FALSE, sizeof(guint32));
  guint32 *indices = g_new(guint32, 3 * surface->triangle_count + 1);
  memset(first, 0xff, surface->vertex_count * sizeof *first);
  for (gsize i = 0; i < 3 * surface->triangle_count; i++) {
    guint32 vertex = surface->triangles[i], drawn = first[vertex];
    while (drawn != none && memcmp(&g_array_index(places, float, 2 * drawn), corners + 2 * i, 2 * sizeof *corners) != 0)
      drawn = g_array_index(next, guint32, drawn);
    if (drawn == none) {
      drawn = twins->len;
      g_array_append_val(twins, vertex);
      g_array_append_val(next, first[vertex]);
      g_array_append_vals(places, corners + 2 * i, 2);
      first[vertex] = drawn;
    }
    indices[i] = drawn;
  }
  surface->drawn_count = twins->len;
  surface->twins = (guint32 *)g_array_free(g_steal_pointer(&twins), FALSE);
  return indices;
}

void spore_surface_lay(SporeSurfaceGroup *surface, const double *vertices, const SporeTextureImage *texture,
                       const float *places) {
  g_autoptr(GArray) drawn = g_array_new(FALSE, FALSE, sizeof(float));
  g_autofree guint32 *indices = split_vertices(surface, places, drawn);
  surface->texture = texture;
  upload_rest(surface, vertices);
  spore_surface_move(surface, vertices);
  glGenBuffers(1, &surface->places);
  glBindVertexArray(surface->vertex_array);
  glBindBuffer(GL_ARRAY_BUFFER, surface->places);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(drawn->len * sizeof(float)), drawn->data, GL_STATIC_DRAW);
  glEnableVertexAttribArray(5);
  glVertexAttribPointer(5, 2, GL_FLOAT, GL_FALSE, 0, NULL);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, surface->indices);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, (GLsizeiptr)(surface->triangle_count * 3 * sizeof *indices), indices,
               GL_STATIC_DRAW);
  glBindVertexArray(0);
}

gboolean spore_surface_is_clear(const SporeSurfaceGroup *surface) {
  return surface->style.clearness > 0 && !surface->style.wireframe;
}

gboolean spore_surface_is_filled(const SporeSurfaceGroup *surface) {
  return surface->closed && !surface->values && !surface->style.wireframe && !spore_surface_is_clear(surface);
}

void spore_surface_move(SporeSurfaceGroup *surface, const double *vertices) {
  spore_drawable_set_bounds(&surface->base, vertices, surface->vertex_count, 3, FALSE, FALSE);
  spore_triangle_mesh_normals(vertices, surface->vertex_count, surface->triangles, surface->triangle_count,
                              surface->normals);
  GLsizeiptr size = (GLsizeiptr)(surface->drawn_count * 6 * sizeof(float));
  glBindBuffer(GL_ARRAY_BUFFER, surface->moving);
  glBufferData(GL_ARRAY_BUFFER, size, NULL,
               GL_STREAM_DRAW); /* gives a new buffer while the last frame still reads the old one */
  float *out =
      size ? glMapBufferRange(GL_ARRAY_BUFFER, 0, size, GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_BUFFER_BIT) : NULL;
  if (!out) return;
  const double *origin = surface->base.origin, *normals = surface->normals;
  for (gsize d = 0; d < surface->drawn_count; d++, out += 6) {
    gsize v = vertex_of(surface, d);
    for (int i = 0; i < 3; i++) {
      out[i] = (float)(vertices[3 * v + i] - origin[i]);
      out[3 + i] = (float)normals[3 * v + i];
    }
  }
  glUnmapBuffer(GL_ARRAY_BUFFER);
}

/* Fills the buffer of a number at each vertex, which is made when it is first needed. */
static void fill_attribute(const SporeSurfaceGroup *surface, GLuint *buffer, GLuint attribute, const float *numbers) {
  gboolean first = *buffer == 0;
  if (first) glGenBuffers(1, buffer);
  g_autofree float *drawn = surface->twins ? g_new(float, surface->drawn_count) : NULL;
  for (gsize d = 0; drawn && d < surface->drawn_count; d++) drawn[d] = numbers[surface->twins[d]];
  glBindBuffer(GL_ARRAY_BUFFER, *buffer);
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(surface->drawn_count * sizeof *numbers), drawn ? drawn : numbers,
               GL_DYNAMIC_DRAW);
  if (!first) return;
  glBindVertexArray(surface->vertex_array);
  glEnableVertexAttribArray(attribute);
  glVertexAttribPointer(attribute, 1, GL_FLOAT, GL_FALSE, 0, NULL);
  glBindVertexArray(0);
}

void spore_surface_stain(SporeSurfaceGroup *surface, const float *stain) {
  fill_attribute(surface, &surface->stain, STAIN, stain);
}

/* Of a liquid, which nothing stains, the same numbers are shares. */
void spore_surface_mix(SporeSurfaceGroup *surface, const float *share, const SporeMixture *mixture) {
  surface->mixture = *mixture;
  fill_attribute(surface, &surface->stain, STAIN, share);
}

void spore_surface_value(SporeSurfaceGroup *surface, const float *values) {
  if (values) {
    fill_attribute(surface, &surface->values, VALUE, values);
    return;
  }
  if (!surface->values) return;
  glBindVertexArray(surface->vertex_array);
  glDisableVertexAttribArray(VALUE);
  glBindVertexArray(0);
  glDeleteBuffers(1, &surface->values);
  surface->values = 0;
}

static void draw_surface(const SporeSurfaceGroup *surface, const SporeFrame *frame, const SporeProgram *program,
                         gboolean colours) {
  const SporeSurfaceStyle *style = &surface->style;
  spore_drawable_set_offset(&surface->base, frame, program->offset);
  glUniform3fv(program->colour, 1, style->colour);
  glUniform1f(program->wetness, style->wetness);
  glUniform1f(program->clearness, style->clearness);
  glUniform4f(program->mixture, surface->mixture.colour[0], surface->mixture.colour[1], surface->mixture.colour[2],
              surface->mixture.clearness);
  glUniform1f(program->cell, surface->cell);
  glUniform1f(program->selected, style->selected ? 1 : 0);
  glUniform1i(program->material, style->material);
  glUniform3fv(program->axis, 1, surface->axis);
  if (surface->closed && !style->wireframe && !frame->clips) glEnable(GL_CULL_FACE);
  else glDisable(GL_CULL_FACE);
  glPolygonMode(GL_FRONT_AND_BACK, style->wireframe && colours ? GL_LINE : GL_FILL);
  glBindVertexArray(surface->vertex_array);
  if (!surface->values) glVertexAttrib1f(VALUE, -1);
  if (!surface->stain) glVertexAttrib1f(STAIN, 0);
  gsize shown = spore_surface_shown(surface, frame->coarse);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, shown < surface->triangle_count ? surface->coarse : surface->indices);
  glDrawElements(GL_TRIANGLES, (GLsizei)(3 * shown), GL_UNSIGNED_INT, NULL);
}

static gboolean is_drawn(const SporeDrawable *drawable, gboolean colours) {
  return drawable && drawable->visible && drawable->kind == SPORE_DRAW_SURFACE &&
         (colours || !((const SporeSurfaceGroup *)drawable)->style.wireframe);
}

/* Of a clear surface, only what is nearest is seen: its depth comes first. */
static void draw_clear(const SporeSurfaceGroup *surface, const SporeFrame *frame, const SporeProgram *program) {
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  draw_surface(surface, frame, program, TRUE);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  glEnable(GL_BLEND);
  draw_surface(surface, frame, program, TRUE);
  glDisable(GL_BLEND);
}

/* The program that does all that the surface needs, and least beside that. Depth is drawn of all by one. */
static SporeProgramKind kind_of(const SporeSurfaceGroup *surface, const SporeFrame *frame, SporeVariant variant) {
  SporeMaterial material = surface->style.material;
  gboolean stained = material == SPORE_MATERIAL_METAL && surface->stain;
  gboolean tinted = material == SPORE_MATERIAL_TISSUE && frame->block.tint[3] > 0;
  if (variant >= SPORE_VARIANT_DEPTH) return SPORE_PROGRAM_SURFACE;
  if (surface->values || stained || tinted || (surface->texture && material != SPORE_MATERIAL_TISSUE))
    return surface->texture ? SPORE_PROGRAM_TEXTURED_SURFACE : SPORE_PROGRAM_SURFACE;
  if (surface->texture) return SPORE_PROGRAM_TEXTURED_TISSUE;
  if (material == SPORE_MATERIAL_TISSUE) return SPORE_PROGRAM_TISSUE;
  return material == SPORE_MATERIAL_METAL ? SPORE_PROGRAM_METAL : SPORE_PROGRAM_LIQUID;
}

static gboolean draw_one(const SporeSurfaceGroup *surface, const SporeFrame *frame, SporePrograms *programs,
                         SporeVariant variant, GError **error) {
  const SporeProgram *program = spore_programs_get(programs, kind_of(surface, frame, variant), variant, error);
  gboolean colours = variant < SPORE_VARIANT_DEPTH;
  if (!program) return FALSE;
  glUseProgram(program->id);
  if (colours && surface->texture) {
    glActiveTexture(GL_TEXTURE0 + SPORE_UNIT_TEXTURE);
    glBindTexture(GL_TEXTURE_2D, surface->texture->id);
  }
  if (spore_surface_is_clear(surface)) draw_clear(surface, frame, program);
  else draw_surface(surface, frame, program, colours);
  return TRUE;
}

/* A surface, and the square of the distance of its box's farthest corner from the eye. */
typedef struct Farthest {
  const SporeSurfaceGroup *surface;
  double d2;
} Farthest;

static double farthest_d2(const SporeDrawable *drawable, SporeVec3 eye) {
  const double from[3] = {eye.x, eye.y, eye.z};
  double d2 = 0;
  for (int k = 0; k < 3; k++) {
    double d = fmax(fabs(drawable->lower[k] - from[k]), fabs(drawable->upper[k] - from[k]));
    d2 += d * d;
  }
  return d2;
}

static int compare_distance(gconstpointer a, gconstpointer b) {
  double x = ((const Farthest *)a)->d2, y = ((const Farthest *)b)->d2;
  return (x > y) - (x < y);
}

/* Surfaces in the order in which they are drawn: what lies within another, or before another, first, so that what is
 * behind is not shaded; clear ones as they were added. */
static GArray *in_order(GPtrArray *drawables, const SporeFrame *frame, gboolean colours, gboolean clear) {
  GArray *order = g_array_new(FALSE, FALSE, sizeof(Farthest));
  for (guint i = 0; i < drawables->len; i++) {
    if (!is_drawn(drawables->pdata[i], colours) || spore_surface_is_clear(drawables->pdata[i]) != clear) continue;
    const Farthest one = {drawables->pdata[i], farthest_d2(drawables->pdata[i], frame->eye)};
    g_array_append_val(order, one);
  }
  if (!clear) g_array_sort(order, compare_distance);
  return order;
}

gboolean spore_surface_pass(GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs,
                            SporeVariant variant, gboolean clear, GError **error) {
  if (!spore_drawables_show(drawables, SPORE_DRAW_SURFACE)) return TRUE;
  spore_frame_clip(frame, TRUE);
  g_autoptr(GArray) order = in_order(drawables, frame, variant < SPORE_VARIANT_DEPTH, clear);
  gboolean done = TRUE;
  for (guint i = 0; i < order->len && done; i++)
    done = draw_one(g_array_index(order, Farthest, i).surface, frame, programs, variant, error);
  spore_frame_clip(frame, FALSE);
  glDisable(GL_CULL_FACE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  return done;
}
