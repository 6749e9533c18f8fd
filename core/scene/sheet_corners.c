/* The corners that a mesh asset names for a spline sheet. */
#include "core/scene/sheet_corners.h"

#include <string.h>

const char *const spore_sheet_corner_names[4] = {"first_corner", "second_corner", "third_corner", "fourth_corner"};

gboolean spore_sheet_corners(const SporeObject *mesh, double corners[12]) {
  gboolean given = FALSE;
  for (gsize k = 0; k < 4; k++) {
    int place = spore_parameter_find(spore_object_type(mesh)->table, spore_sheet_corner_names[k]);
    if (place < 0) return FALSE;
    memcpy(corners + 3 * k, spore_object_value(mesh, (guint)place)->number, 3 * sizeof *corners);
    given = given || memcmp(corners, corners + 3 * k, 3 * sizeof *corners) != 0;
  }
  return given;
}
