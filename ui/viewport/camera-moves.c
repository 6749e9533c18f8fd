#include "ui/viewport/camera-moves.h"

#define ORBIT_RAD_A_PIXEL 0.008
#define ELEVATION_LIMIT_RAD (G_PI_2 * 0.99)
#define NEAREST_M 1e-4
#define FARTHEST_M 1e4

void spore_camera_orbit(SporeCamera *camera, double dx, double dy) {
  camera->azimuth = remainder(camera->azimuth - dx * ORBIT_RAD_A_PIXEL, 2 * G_PI);
  camera->elevation = CLAMP(camera->elevation + dy * ORBIT_RAD_A_PIXEL, -ELEVATION_LIMIT_RAD, ELEVATION_LIMIT_RAD);
}

void spore_camera_pan(SporeCamera *camera, double dx, double dy, int height) {
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(camera, &eye, &right, &up, &forward);
  double m_a_pixel = 2 * camera->distance * tan(camera->field_of_view / 2) / MAX(height, 1);
  camera->target = spore_vec3_add_scaled(camera->target, -dx * m_a_pixel, right);
  camera->target = spore_vec3_add_scaled(camera->target, dy * m_a_pixel, up);
}

SporeVec3 spore_camera_unproject(const SporeCamera *camera, SporeVec3 through, double x, double y, int width,
                                 int height) {
  SporeVec3 eye, right, up, forward, origin, direction;
  spore_camera_eye(camera, &eye, &right, &up, &forward);
  spore_camera_ray(camera, x, y, width, height, &origin, &direction);
  double depth = spore_vec3_dot(spore_vec3_sub(through, origin), forward);
  double rate = spore_vec3_dot(direction, forward);
  return spore_vec3_add_scaled(origin, depth / fmax(rate, 1e-6), direction);
}

void spore_camera_zoom(SporeCamera *camera, double factor, double x, double y, int width, int height) {
  double distance = CLAMP(camera->distance * factor, NEAREST_M, FARTHEST_M);
  double taken = distance / camera->distance;
  SporeVec3 fixed = spore_camera_unproject(camera, camera->target, x, y, width, height);
  camera->target = spore_vec3_add_scaled(fixed, taken, spore_vec3_sub(camera->target, fixed));
  camera->distance = distance;
}

gboolean spore_camera_project(const SporeCamera *camera, SporeVec3 point, int width, int height, double *x, double *y) {
  SporeVec3 eye, right, up, forward;
  spore_camera_eye(camera, &eye, &right, &up, &forward);
  SporeVec3 d = spore_vec3_sub(point, eye);
  double depth = spore_vec3_dot(d, forward);
  if (depth <= 0) return FALSE;
  double scale = height / (2 * depth * tan(camera->field_of_view / 2));
  *x = width / 2.0 + spore_vec3_dot(d, right) * scale;
  *y = height / 2.0 - spore_vec3_dot(d, up) * scale;
  return TRUE;
}
