#include <math.h>

#include "ui/render/passes.h"

/* Grid cells each way from what the camera looks at. */
#define GRID_CELLS 20

enum { GRID_FINE, GRID_COARSE, GRID_X, GRID_Z, GRID_GROUPS };

GPtrArray *spore_grid_new(void) {
  static const float colours[GRID_GROUPS][3] = {
      {0.045f, 0.042f, 0.042f}, {0.085f, 0.080f, 0.080f}, {0.42f, 0.06f, 0.06f}, {0.06f, 0.14f, 0.50f}};
  GPtrArray *grid = g_ptr_array_new();
  for (int i = 0; i < GRID_GROUPS; i++)
    g_ptr_array_add(grid, spore_line_group_new(NULL, 0, colours[i], i < GRID_X ? 1.0f : 1.6f));
  return grid;
}

static void add_line(GArray *points, double x0, double z0, double x1, double z1) {
  double line[6] = {x0, 0, z0, x1, 0, z1};
  g_array_append_vals(points, line, 6);
}

static void set_group(GPtrArray *grid, guint group, GArray *points, double fade) {
  SporeLineGroup *lines = grid->pdata[group];
  spore_line_group_move(lines, (const double *)points->data, points->len / 6);
  lines->fade = (float)fade;
  g_array_set_size(points, 0);
}

void spore_grid_update(GPtrArray *grid, const SporeCamera *camera) {
  double cell = pow(10, floor(log10(camera->distance * 0.35))), reach = GRID_CELLS * cell;
  double fade = 2.2 * camera->distance + reach * 0.5;
  long middle_x = lround(camera->target.x / cell), middle_z = lround(camera->target.z / cell);
  double low_x = ((double)middle_x - GRID_CELLS) * cell, low_z = ((double)middle_z - GRID_CELLS) * cell;
  GArray *points = g_array_new(FALSE, FALSE, sizeof(double));
  for (int coarse = 0; coarse < 2; coarse++) {
    for (int i = 0; i <= 2 * GRID_CELLS; i++) {
      long line_x = middle_x + i - GRID_CELLS, line_z = middle_z + i - GRID_CELLS;
      double x = (double)line_x * cell, z = (double)line_z * cell;
      if (line_x != 0 && (line_x % 10 == 0) == coarse) add_line(points, x, low_z, x, low_z + 2 * reach);
      if (line_z != 0 && (line_z % 10 == 0) == coarse) add_line(points, low_x, z, low_x + 2 * reach, z);
    }
    set_group(grid, coarse ? GRID_COARSE : GRID_FINE, points, fade);
  }
  if (low_z <= 0 && low_z + 2 * reach >= 0) add_line(points, low_x, 0, low_x + 2 * reach, 0);
  set_group(grid, GRID_X, points, fade);
  if (low_x <= 0 && low_x + 2 * reach >= 0) add_line(points, 0, low_z, 0, low_z + 2 * reach);
  set_group(grid, GRID_Z, points, fade);
  g_array_free(points, TRUE);
}
