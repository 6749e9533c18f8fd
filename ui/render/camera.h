/* The camera: how it looks, how gestures move it, and where points lie in its picture. Pixels, origin top left. */
#ifndef SPORE_UI_RENDER_CAMERA_H
#define SPORE_UI_RENDER_CAMERA_H

#include <glib.h>

#include "core/math/vec3.h"

typedef struct SporeCamera {
  SporeVec3 target;          /* looked at, and orbited */
  double distance;           /* m */
  double azimuth, elevation; /* rad; 0, 0 looks along -z from +z, y up */
  double roll;               /* rad about the line of sight; the picture turns the other way, to the left */
  double field_of_view;      /* vertical, rad */
  /* Of the lens, 0 to 0.6: how much nearer to the middle a corner of the picture is drawn than a lens
   * of the middle's scale draws it, as a part of its distance (barrel). 0: straight lines stay straight. */
  double distortion;
  /* Shares 0..1 of the front that blood and water cover, and of the light from the target that haze takes away. */
  double blood, water, haze;
} SporeCamera;
/* Moves the camera so that the box fits into a picture of that aspect; keeps the direction. */
void spore_camera_frame(SporeCamera *camera, const double lower[3], const double upper[3], double aspect);
void spore_camera_eye(const SporeCamera *camera, SporeVec3 *eye, SporeVec3 *right, SporeVec3 *up, SporeVec3 *forward);
/* Half the height of the straight picture that a lens bends into one of that size, at distance 1: the lens takes its
 * corners from the corners, and the middle of its upper edge from where the field of view ends. */
double spore_camera_slope(const SporeCamera *camera, int width, int height);
/* Ray (unit direction) through a pixel of the picture as the lens draws it. */
void spore_camera_ray(const SporeCamera *camera, double x, double y, int width, int height, SporeVec3 *origin,
                      SporeVec3 *direction);
void spore_camera_orbit(SporeCamera *camera, double dx, double dy);
void spore_camera_pan(SporeCamera *camera, double dx, double dy, int height);
/* factor < 1 comes nearer. The point under the pixel, in the plane of the target, stays under the pixel. */
void spore_camera_zoom(SporeCamera *camera, double factor, double x, double y, int width, int height);
/* Point under the pixel in the plane through `through` that faces the camera. */
SporeVec3 spore_camera_unproject(const SporeCamera *camera, SporeVec3 through, double x, double y, int width,
                                 int height);
/* FALSE: behind the camera. */
gboolean spore_camera_project(const SporeCamera *camera, SporeVec3 point, int width, int height, double *x, double *y);

#endif
