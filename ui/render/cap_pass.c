/* Caps: where the plane of the frame cuts a closed surface, the face of the cut is filled.
 *
 * Along the ray of a pixel, what is left of a closed surface shows as many back faces as front faces, unless the ray
 * enters or leaves it through the face of the cut. The stencil counts them; then the plane is drawn where the count is
 * not zero. All caps are drawn as one and the same polygon, so that those of nested surfaces have the same depth, and
 * the smaller one, drawn later, is seen. */
#include <math.h>
#include <string.h>

#include "ui/render/passes.h"

#define MOST_CORNERS 6    /* of a plane through a box */
#define VERTEX_FLOATS 7   /* position from the eye, place in the pattern, mottling */
#define INSIDE_LIGHT 0.7f /* of the colour of the outside */
#define INSIDE_WETNESS 0.25f
#define MOTTLING 0.5f

/* The part of the plane that caps may lie on; none: count 0. */
typedef struct Plane {
  SporeVec3 normal; /* to the side that is hidden */
  double distance;
  guint count;
  SporeVec3 corners[MOST_CORNERS]; /* in turn about the normal */
} Plane;

static gboolean is_crossed(const SporeDrawable *drawable, const Plane *plane) {
  const double normal[3] = {plane->normal.x, plane->normal.y, plane->normal.z};
  double low = -plane->distance, high = -plane->distance;
  for (int k = 0; k < 3; k++) {
    double a = normal[k] * drawable->lower[k], b = normal[k] * drawable->upper[k];
    low += fmin(a, b), high += fmax(a, b);
  }
  return low < 0 && high > 0;
}

/* The surfaces that the plane cuts, the largest first. */
static int by_size(gconstpointer a, gconstpointer b) {
  double sizes[2] = {0};
  const SporeDrawable *drawables[2] = {*(SporeDrawable *const *)a, *(SporeDrawable *const *)b};
  for (int i = 0; i < 2; i++)
    for (int k = 0; k < 3; k++) sizes[i] += pow(drawables[i]->upper[k] - drawables[i]->lower[k], 2);
  return sizes[0] < sizes[1] ? 1 : sizes[0] > sizes[1] ? -1 : 0;
}

static GPtrArray *find_cut(const GPtrArray *drawables, const Plane *plane) {
  GPtrArray *cut = g_ptr_array_new();
  for (guint i = 0; i < drawables->len; i++) {
    SporeDrawable *drawable = drawables->pdata[i];
    if (!drawable || !drawable->visible || drawable->kind != SPORE_DRAW_SURFACE) continue;
    const SporeSurfaceGroup *surface = (const SporeSurfaceGroup *)drawable;
    if (spore_surface_is_filled(surface) && is_crossed(drawable, plane)) g_ptr_array_add(cut, drawable);
  }
  g_ptr_array_sort(cut, by_size);
  return cut;
}

static void box_of(const GPtrArray *cut, double box[2][3]) {
  for (int k = 0; k < 3; k++) box[0][k] = HUGE_VAL, box[1][k] = -HUGE_VAL;
  for (guint i = 0; i < cut->len; i++) {
    const SporeDrawable *drawable = cut->pdata[i];
    for (int k = 0; k < 3; k++) {
      box[0][k] = fmin(box[0][k], drawable->lower[k]);
      box[1][k] = fmax(box[1][k], drawable->upper[k]);
    }
  }
}

/* Adds where the plane meets the edge of the box along an axis; sides: on which of the others' sides the edge lies. */
static void meet_edge(Plane *plane, double box[2][3], int axis, int side) {
  double from[3];
  from[axis] = box[0][axis];
  from[(axis + 1) % 3] = box[side & 1][(axis + 1) % 3];
  from[(axis + 2) % 3] = box[side >> 1][(axis + 2) % 3];
  double to[3] = {from[0], from[1], from[2]};
  to[axis] = box[1][axis];
  SporeVec3 a = spore_vec3_load(from), b = spore_vec3_load(to);
  double above = spore_vec3_dot(plane->normal, a) - plane->distance;
  double below = spore_vec3_dot(plane->normal, b) - plane->distance;
  if ((above < 0) == (below < 0) || plane->count == MOST_CORNERS) return;
  plane->corners[plane->count++] = spore_vec3_add_scaled(a, above / (above - below), spore_vec3_sub(b, a));
}

/* Puts the corners in turn about the normal. */
static void sort_corners(Plane *plane) {
  SporeVec3 middle = {0, 0, 0}, u = spore_vec3_any_across(plane->normal), v = spore_vec3_cross(plane->normal, u);
  double turns[MOST_CORNERS];
  for (guint i = 0; i < plane->count; i++)
    middle = spore_vec3_add_scaled(middle, 1.0 / plane->count, plane->corners[i]);
  for (guint i = 0; i < plane->count; i++) {
    SporeVec3 way = spore_vec3_sub(plane->corners[i], middle), corner = plane->corners[i];
    double turn = atan2(spore_vec3_dot(way, v), spore_vec3_dot(way, u));
    guint k = i;
    for (; k > 0 && turns[k - 1] > turn; k--) turns[k] = turns[k - 1], plane->corners[k] = plane->corners[k - 1];
    turns[k] = turn, plane->corners[k] = corner;
  }
}

static void find_corners(Plane *plane, const GPtrArray *cut) {
  double box[2][3];
  box_of(cut, box);
  for (int axis = 0; axis < 3; axis++)
    for (int side = 0; side < 4; side++) meet_edge(plane, box, axis, side);
  sort_corners(plane);
}

/* Leaves in the stencil where the ray of a pixel goes through the face of the cut. */
static void count_faces(const SporeSurfaceGroup *surface, const SporeFrame *frame, const SporeProgram *program) {
  glClear(GL_STENCIL_BUFFER_BIT);
  glUseProgram(program->id);
  spore_drawable_set_offset(&surface->base, frame, program->offset);
  glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glEnable(GL_DEPTH_CLAMP); /* faces beside the range of depth count, too */
  spore_frame_clip(frame, TRUE);
  glStencilFunc(GL_ALWAYS, 0, ~0u);
  glStencilOpSeparate(GL_FRONT, GL_KEEP, GL_KEEP, GL_DECR_WRAP);
  glStencilOpSeparate(GL_BACK, GL_KEEP, GL_KEEP, GL_INCR_WRAP);
  glBindVertexArray(surface->vertex_array);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, surface->indices);
  glDrawElements(GL_TRIANGLES, (GLsizei)(3 * surface->triangle_count), GL_UNSIGNED_INT, NULL);
  spore_frame_clip(frame, FALSE);
  glDisable(GL_DEPTH_CLAMP);
  glEnable(GL_DEPTH_TEST);
  glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

static void upload_plane(const Plane *plane, const SporeSurfaceGroup *surface, const SporeFrame *frame) {
  float vertices[MOST_CORNERS * VERTEX_FLOATS], *out = vertices;
  for (guint i = 0; i < plane->count; i++, out += VERTEX_FLOATS) {
    const SporeVec3 from_eye = spore_vec3_sub(plane->corners[i], frame->eye),
                    in_body = spore_vec3_sub(plane->corners[i], spore_vec3_load(surface->base.origin));
    out[0] = (float)from_eye.x, out[1] = (float)from_eye.y, out[2] = (float)from_eye.z;
    out[3] = (float)in_body.x / surface->cell, out[4] = (float)in_body.y / surface->cell;
    out[5] = (float)in_body.z / surface->cell, out[6] = MOTTLING;
  }
  glBufferData(GL_ARRAY_BUFFER, (GLsizeiptr)(plane->count * VERTEX_FLOATS * sizeof(float)), vertices, GL_STREAM_DRAW);
}

/* Draws the plane where the stencil says, as the inside of the body. */
static void draw_cap(const Plane *plane, const SporeSurfaceGroup *surface, const SporeProgram *program) {
  float colour[3];
  for (int k = 0; k < 3; k++) colour[k] = surface->style.colour[k] * (surface->texture ? surface->texture->mean[k] : 1);
  glUseProgram(program->id);
  glUniform3f(program->offset, 0, 0, 0);
  glUniform3f(program->colour, INSIDE_LIGHT * colour[0], INSIDE_LIGHT * colour[1], INSIDE_LIGHT * colour[2]);
  glUniform1f(program->wetness, INSIDE_WETNESS * surface->style.wetness);
  glUniform1f(program->cell, surface->cell);
  glUniform1f(program->selected, surface->style.selected ? 1 : 0);
  glUniform1i(program->material, surface->style.material);
  glUniform3fv(program->axis, 1, surface->axis);
  glVertexAttrib3f(1, (float)plane->normal.x, (float)plane->normal.y, (float)plane->normal.z);
  glVertexAttrib1f(3, -1);
  glStencilFunc(GL_NOTEQUAL, 0, ~0u);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glEnable(GL_CULL_FACE); /* it faces the side that is hidden */
  glDrawArrays(GL_TRIANGLE_FAN, 0, (GLsizei)plane->count);
  glDisable(GL_CULL_FACE);
}

/* Names of the vertex array and its buffer. */
typedef struct PlaneArray {
  GLuint array, buffer;
} PlaneArray;

static PlaneArray make_array(void) {
  const GLsizei stride = VERTEX_FLOATS * sizeof(float);
  PlaneArray made;
  glGenVertexArrays(1, &made.array);
  glGenBuffers(1, &made.buffer);
  glBindVertexArray(made.array);
  glBindBuffer(GL_ARRAY_BUFFER, made.buffer);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, NULL);
  glEnableVertexAttribArray(2);
  glVertexAttribPointer(2, 4, GL_FLOAT, GL_FALSE, stride, (const void *)(3 * sizeof(float)));
  return made;
}

gboolean spore_cap_pass(const GPtrArray *drawables, const SporeFrame *frame, SporePrograms *programs,
                        SporeVariant variant, GError **error) {
  Plane plane = {.normal = frame->clip.normal, .distance = frame->clip.distance};
  if (!frame->clips) return TRUE;
  g_autoptr(GPtrArray) cut = find_cut(drawables, &plane);
  if (cut->len == 0) return TRUE;
  const SporeProgram *count = spore_programs_get(programs, SPORE_PROGRAM_SURFACE, SPORE_VARIANT_DEPTH, error);
  const SporeProgram *draw = count ? spore_programs_get(programs, SPORE_PROGRAM_SURFACE, variant, error) : NULL;
  if (!draw) return FALSE;
  find_corners(&plane, cut);
  PlaneArray made = make_array();
  glEnable(GL_STENCIL_TEST);
  for (guint i = 0; i < cut->len; i++) {
    count_faces(cut->pdata[i], frame, count);
    glBindVertexArray(made.array);
    glBindBuffer(GL_ARRAY_BUFFER, made.buffer);
    upload_plane(&plane, cut->pdata[i], frame);
    draw_cap(&plane, cut->pdata[i], draw);
  }
  glDisable(GL_STENCIL_TEST);
  glBindVertexArray(0);
  glDeleteVertexArrays(1, &made.array);
  glDeleteBuffers(1, &made.buffer);
  return TRUE;
}
