/* The uniform block of a frame: projection, light, range of depth, and the view of the lamp. */
#include "ui/render/frame.h"

#include <math.h>
#include <string.h>

#include "core/math/colour.h"

#define VIGNETTE 0.62f
#define LIGHT_VIGNETTE 0.15f

/* Depth range, m along the view, of everything visible. */
static void depth_range(GPtrArray *drawables, SporeVec3 eye, SporeVec3 forward, double *near, double *far) {
  *near = HUGE_VAL, *far = -HUGE_VAL;
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    if (!drawable || !drawable->visible || !(drawable->lower[0] <= drawable->upper[0])) continue;
    for (int corner = 0; corner < 8; corner++) {
      SporeVec3 p = {(corner & 1 ? drawable->upper : drawable->lower)[0],
                     (corner & 2 ? drawable->upper : drawable->lower)[1],
                     (corner & 4 ? drawable->upper : drawable->lower)[2]};
      double depth = spore_vec3_dot(spore_vec3_sub(p, eye), forward);
      *near = MIN(*near, depth);
      *far = MAX(*far, depth);
    }
  }
}

/* Column-major, y flipped. */
static void projection(float out[16], double slope, double aspect, double near, double far) {
  memset(out, 0, 16 * sizeof(float));
  out[0] = (float)(1 / (slope * aspect));
  out[5] = (float)(-1 / slope);
  out[10] = (float)(-(far + near) / (far - near));
  out[11] = -1;
  out[14] = (float)(-2 * far * near / (far - near));
}

static void rotation(float out[16], SporeVec3 right, SporeVec3 up, SporeVec3 forward) {
  const float columns[16] = {(float)right.x,
                             (float)up.x,
                             (float)-forward.x,
                             0,
                             (float)right.y,
                             (float)up.y,
                             (float)-forward.y,
                             0,
                             (float)right.z,
                             (float)up.z,
                             (float)-forward.z,
                             0,
                             0,
                             0,
                             0,
                             1};
  memcpy(out, columns, sizeof columns);
}

/* The plane in view space, with the eye at the origin. */
static void set_clip(SporeFrame *frame, const SporeClip *clip, SporeVec3 right, SporeVec3 up, SporeVec3 forward) {
  float *out = frame->block.clip;
  out[0] = (float)spore_vec3_dot(clip->normal, right), out[1] = (float)spore_vec3_dot(clip->normal, up);
  out[2] = (float)-spore_vec3_dot(clip->normal, forward);
  out[3] = (float)(spore_vec3_dot(clip->normal, frame->eye) - clip->distance);
  frame->clip = *clip;
  frame->clips = spore_clip_is_on(clip);
}

void spore_frame_clip(const SporeFrame *frame, gboolean clips) {
  if (clips && frame->clips) glEnable(GL_CLIP_DISTANCE0);
  else glDisable(GL_CLIP_DISTANCE0);
}

const double spore_tint_colour[3] = {0.27, 0.45, 0.88}; /* no tissue has it */

/* The cones in view space, with the eye at the origin. */
static void set_cones(SporeFrame *frame, const SporeCanvas *canvas, SporeVec3 right, SporeVec3 up, SporeVec3 forward) {
  SporeFrameBlock *block = &frame->block;
  for (int k = 0; k < 3; k++) block->tint[k] = (float)spore_linear_light(spore_tint_colour[k]);
  block->tint[3] = (float)canvas->cone_count;
  for (guint i = 0; i < canvas->cone_count; i++) {
    const SporeCone *cone = &canvas->cones[i];
    SporeVec3 pivot = spore_vec3_sub(cone->pivot, frame->eye), along = cone->along;
    float *out = block->pivot[i];
    out[0] = (float)spore_vec3_dot(pivot, right), out[1] = (float)spore_vec3_dot(pivot, up);
    out[2] = (float)-spore_vec3_dot(pivot, forward);
    out = block->along[i];
    out[0] = (float)spore_vec3_dot(along, right), out[1] = (float)spore_vec3_dot(along, up);
    out[2] = (float)-spore_vec3_dot(along, forward);
    out = block->limits[i];
    out[0] = (float)cos(cone->angle), out[1] = (float)cone->least, out[2] = (float)cone->most;
  }
}

void spore_frame_prepare(SporeFrame *frame, const SporeCamera *camera, const SporeCanvas *canvas,
                         const SporeRenderOptions *options, int width, int height) {
  SporeVec3 right, up, forward;
  *frame = (SporeFrame){0};
  spore_camera_eye(camera, &frame->eye, &right, &up, &forward);
  double distance = camera->distance, slope = spore_camera_slope(camera, width, height);
  depth_range(canvas->drawables, frame->eye, forward, &frame->near, &frame->far);
  if (options->grid || !(frame->far > 0)) {
    frame->near = MIN(frame->near, distance * 0.05);
    frame->far = MAX(frame->far, distance * 12);
  }
  frame->far *= 1.01;
  frame->coarse = options->coarse;
  frame->light = options->light;
  frame->line_scale = (float)MAX(options->scale, 1);
  frame->near = MAX(frame->near * 0.99, frame->far * 3e-4);

  SporeFrameBlock *block = &frame->block;
  projection(block->projection, slope, (double)width / height, frame->near, frame->far);
  rotation(block->rotation, right, up, forward);
  /* The lamp is above and to the left of the lens, so that shapes have a side in shadow. */
  block->light[0] = (float)(-0.30 * distance), block->light[1] = (float)(0.42 * distance);
  block->light[2] = (float)(0.02 * distance), block->light[3] = (float)distance;
  block->viewport[0] = (float)width, block->viewport[1] = (float)height;
  block->viewport[2] = (float)(2 * slope / height), block->viewport[3] = options->light ? LIGHT_VIGNETTE : VIGNETTE;
  block->room[0] = options->light ? 1 : 0;
  block->lens[0] = (float)camera->distortion, block->lens[1] = (float)camera->blood;
  block->lens[2] = (float)camera->water, block->lens[3] = (float)camera->haze;
  set_clip(frame, &options->clip, right, up, forward);
  set_cones(frame, canvas, right, up, forward);
  block->up[0] = (float)right.y, block->up[1] = (float)up.y, block->up[2] = (float)-forward.y;
}

/* Radius about the target that holds every visible drawable, but at most the radius that a camera at that distance
 * sees. */
static double lit_radius(const SporeCamera *camera, GPtrArray *drawables) {
  double radius = 0;
  for (guint i = 0; i < drawables->len; i++) {
    const SporeDrawable *drawable = drawables->pdata[i];
    if (!drawable || !drawable->visible || !(drawable->lower[0] <= drawable->upper[0])) continue;
    const double target[3] = {camera->target.x, camera->target.y, camera->target.z};
    double d2 = 0;
    for (int k = 0; k < 3; k++) {
      double d = MAX(fabs(drawable->lower[k] - target[k]), fabs(drawable->upper[k] - target[k]));
      d2 += d * d;
    }
    radius = MAX(radius, sqrt(d2));
  }
  return MIN(radius, 1.2 * camera->distance);
}

void spore_frame_add_shadow(SporeFrame *frame, const SporeCamera *camera, GPtrArray *drawables) {
  double radius = lit_radius(camera, drawables);
  if (!(radius > 0)) return;
  const float *light = frame->block.light;
  SporeVec3 target = spore_vec3(0, 0, -camera->distance), up = spore_vec3(0, 1, 0);
  SporeVec3 back = spore_vec3_sub(spore_vec3((double)light[0], (double)light[1], (double)light[2]), target);
  back = spore_vec3_normalise(back, spore_vec3(0, 0, 1));
  SporeVec3 side = spore_vec3_normalise(spore_vec3_cross(up, back), spore_vec3(1, 0, 0));
  const SporeVec3 rows[3] = {side, spore_vec3_cross(back, side), spore_vec3_scale(-1, back)};
  float *out = frame->block.shadow;
  for (int i = 0; i < 3; i++) {
    out[i] = (float)(rows[i].x / radius), out[4 + i] = (float)(rows[i].y / radius);
    out[8 + i] = (float)(rows[i].z / radius), out[12 + i] = (float)(-spore_vec3_dot(rows[i], target) / radius);
  }
  out[15] = 1;
  frame->block.up[3] = 1;
}
