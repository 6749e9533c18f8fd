#include <math.h>

#include "ui/render/renderer.h"

void spore_camera_frame(SporeCamera *camera, const double lower[3], const double upper[3], double aspect) {
  double radius = 0;
  for (int i = 0; i < 3; i++) radius += (upper[i] - lower[i]) * (upper[i] - lower[i]) / 4;
  radius = sqrt(radius);
  camera->target = spore_vec3((lower[0] + upper[0]) / 2, (lower[1] + upper[1]) / 2, (lower[2] + upper[2]) / 2);
  if (!(camera->field_of_view > 0)) camera->field_of_view = 0.61;
  /* The sphere about the box must fit into the narrower of both angles. */
  double half = camera->field_of_view / 2;
  if (aspect < 1) half = atan(tan(half) * aspect);
  camera->distance = radius > 0 ? 0.92 * radius / sin(half) : 1;
}

void spore_camera_eye(const SporeCamera *camera, SporeVec3 *eye, SporeVec3 *right, SporeVec3 *up, SporeVec3 *forward) {
  double ca = cos(camera->azimuth), sa = sin(camera->azimuth);
  double ce = cos(camera->elevation), se = sin(camera->elevation);
  SporeVec3 back = spore_vec3(sa * ce, se, ca * ce);
  SporeVec3 side = spore_vec3(ca, 0, -sa);
  *eye = spore_vec3_add_scaled(camera->target, camera->distance, back);
  SporeVec3 level = spore_vec3_cross(back, side);
  double cr = cos(camera->roll), sr = sin(camera->roll);
  *right = spore_vec3_add_scaled(spore_vec3_scale(cr, side), -sr, level);
  *up = spore_vec3_add_scaled(spore_vec3_scale(cr, level), sr, side);
  *forward = spore_vec3_scale(-1, back);
}

void spore_camera_ray(const SporeCamera *camera, double x, double y, int width, int height, SporeVec3 *origin,
                      SporeVec3 *direction) {
  SporeVec3 right, up, forward;
  spore_camera_eye(camera, origin, &right, &up, &forward);
  double slope = tan(camera->field_of_view / 2), aspect = (double)width / height;
  SporeVec3 through = spore_vec3_add_scaled(forward, (2 * x / width - 1) * slope * aspect, right);
  through = spore_vec3_add_scaled(through, (1 - 2 * y / height) * slope, up);
  *direction = spore_vec3_normalise(through, forward);
}
