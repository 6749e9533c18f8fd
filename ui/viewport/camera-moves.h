/* How gestures move the camera, and where points of the scene lie on the screen. Pixels, origin top left. */
#ifndef SPORE_UI_VIEWPORT_CAMERA_MOVES_H
#define SPORE_UI_VIEWPORT_CAMERA_MOVES_H

#include "ui/render/renderer.h"

void spore_camera_orbit(SporeCamera *camera, double dx, double dy);
void spore_camera_pan(SporeCamera *camera, double dx, double dy, int height);
/* factor < 1 comes nearer; what lies under the pixel (on the target's plane) stays there. */
void spore_camera_zoom(SporeCamera *camera, double factor, double x, double y, int width, int height);
/* Point under the pixel in the plane through `through` that faces the camera. */
SporeVec3 spore_camera_unproject(const SporeCamera *camera, SporeVec3 through, double x, double y, int width,
                                 int height);
/* FALSE: behind the camera. */
gboolean spore_camera_project(const SporeCamera *camera, SporeVec3 point, int width, int height, double *x, double *y);

#endif
