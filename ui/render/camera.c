/* The camera: how it looks, how gestures move it, and where points lie in its picture.
 *
 * The lens follows the division model (Fitzgibbon 2001, Simultaneous linear estimation of multiple view geometry and
 * lens distortion; used for endoscopes by Melo, Barreto and Falcao 2012): what is drawn at distance r from the middle,
 * in half diagonals of the picture, comes from the distance r (1 - d) / (1 - d r^2) of a straight picture. Its inverse
 * has a closed form. */
#include "ui/render/camera.h"

#include <math.h>

#define ORBIT_RAD_A_PIXEL 0.008
#define ELEVATION_LIMIT_RAD (G_PI_2 * 0.99)
#define NEAREST_M 1e-4
#define FARTHEST_M 1e4

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

/* Squared distance from the middle, in half diagonals, of a place whose coordinates are -1..1 in the picture. */
static double off_middle(double x, double y, int width, int height) {
  double w = (double)width * width, h = (double)height * height;
  return (x * x * w + y * y * h) / (w + h);
}

/* How many times as far from the middle the straight picture has what the lens draws there. */
static double straightened(const SporeCamera *camera, double off) {
  return (1 - camera->distortion) / (1 - camera->distortion * off);
}

/* The inverse: how many times as far the lens draws what is `off` in the straight picture. */
static double bent(const SporeCamera *camera, double off) {
  double rest = 1 - camera->distortion;
  return 2 / (rest + sqrt(rest * rest + 4 * camera->distortion * off));
}

double spore_camera_slope(const SporeCamera *camera, int width, int height) {
  return tan(camera->field_of_view / 2) / straightened(camera, off_middle(0, 1, width, height));
}

void spore_camera_ray(const SporeCamera *camera, double x, double y, int width, int height, SporeVec3 *origin,
                      SporeVec3 *direction) {
  SporeVec3 right, up, forward;
  spore_camera_eye(camera, origin, &right, &up, &forward);
  double over = 2 * x / width - 1, above = 1 - 2 * y / height, aspect = (double)width / height;
  double scale =
      spore_camera_slope(camera, width, height) * straightened(camera, off_middle(over, above, width, height));
  SporeVec3 through = spore_vec3_add_scaled(forward, over * scale * aspect, right);
  through = spore_vec3_add_scaled(through, above * scale, up);
  *direction = spore_vec3_normalise(through, forward);
}

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
  double half = depth * spore_camera_slope(camera, width, height);
  double over = spore_vec3_dot(d, right) * height / (half * width), above = spore_vec3_dot(d, up) / half;
  double scale = bent(camera, off_middle(over, above, width, height));
  *x = width / 2.0 * (1 + over * scale);
  *y = height / 2.0 * (1 - above * scale);
  return TRUE;
}
