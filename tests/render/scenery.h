/* What the tests of the renderer draw, and how pictures are compared. */
#ifndef SPORE_TESTS_RENDER_SCENERY_H
#define SPORE_TESTS_RENDER_SCENERY_H

#include "ui/render/renderer.h"

#define PICTURE_WIDTH 320
#define PICTURE_HEIGHT 240

typedef struct Picture {
  int width, height;
  guint8 *pixels; /* height x width x 4, BGRx */
} Picture;

/* Context and renderer, or the test ends with the reason. */
typedef struct Bench {
  SporeOffscreen *offscreen;
  SporeRenderer *renderer;
} Bench;
Bench bench_open(void);
void bench_close(Bench *bench);

/* A bumpy ball of that radius about the origin. */
SporeTriangleMesh make_organ(double radius);

/* Camera on the z axis at a distance, looking at the origin. */
SporeCamera straight_camera(double distance);

Picture draw_picture(SporeRenderer *renderer, const SporeCamera *camera, int width, int height, gboolean antialias,
                     gboolean grid);
void picture_clear(Picture *picture);
/* Red, green and blue, 0..255. */
void picture_pixel(const Picture *picture, int x, int y, int rgb[3]);
Picture picture_read(const char *file); /* pixels NULL: not there, or no PNG */

typedef struct PictureDifference {
  double mean, percentile_99; /* of the largest channel's difference, 0..255 */
} PictureDifference;
PictureDifference picture_compare(const Picture *a, const Picture *b);

#endif
