/* Where a line bends as if it were clamped, of which a pin holds control points. */
#include "core/scene/pinned_line.h"

#include <string.h>

#include "core/body/path.h"
#include "core/constraint/pin.h"
#include "core/scene/schema_fields.h"

#define PARTS 16 /* of a span, in which the end of the radius is sought */

/* A line and the control points of it that a pin holds. */
typedef struct PinnedLine {
  SporeSplineKnots knots;
  const double *points;
  size_t first, last; /* held */
  SporeVec3 centre;
  double radius;
} PinnedLine;

static gboolean is_within(const PinnedLine *line, double parameter) {
  SporeVec3 at = spore_path_at(line->knots, line->points, parameter).position;
  return spore_vec3_distance(at, line->centre) <= line->radius;
}

/* Parameter at which the line leaves the radius, seen from the place nearest to the pin; that place itself, where the
 * line does not enter the radius. */
static double edge_of(const PinnedLine *line, double end) {
  double start = spore_path_seek(line->knots, line->points, NULL, line->centre).parameter, edge = start;
  size_t parts = PARTS * line->knots.span_count;
  double step = (end - start) / (double)parts;
  for (size_t i = 0; i <= parts && is_within(line, start + (double)i * step); i++) edge = start + (double)i * step;
  return edge;
}

/* Finds the held control points. FALSE: there are none, or they are not one run. */
static gboolean find_held(PinnedLine *line) {
  size_t count = line->knots.span_count + 3;
  g_autofree uint8_t *held = g_new0(uint8_t, count);
  size_t found = spore_pin_select(line->points, count, line->centre, line->radius, held);
  if (found == 0) return FALSE;
  while (!held[line->first]) line->first++;
  line->last = line->first + found - 1;
  return line->last < count && memchr(held + line->first, 0, found) == NULL;
}

gboolean spore_pinned_side_measure(const SporeSimulation *simulation, SporeObject *pin, int side,
                                   SporePinnedSide *measured) {
  SporeObject *body = spore_object_reference(pin, "body");
  guint32 index = body ? spore_simulation_body_of(simulation, body) : SPORE_NO_BODY;
  const SporeModel *model = index == SPORE_NO_BODY ? NULL : spore_world_body_model(simulation->world, index);
  if (!model || !model->type->line || !model->type->line->path) return FALSE;
  SporeLinkDescription fields = {0};
  spore_object_fields(pin, &fields);
  PinnedLine line = {.knots = model->type->line->path(model),
                     .points = spore_world_q(simulation->world, index),
                     .centre = fields.point_a,
                     .radius = fields.radius};
  if (!find_held(&line) || (side > 0 ? line.last == line.knots.span_count + 2 : line.first == 0)) return FALSE;
  double end = side > 0 ? spore_spline_end(line.knots) : 0, edge = edge_of(&line, end), clamp = edge;
  bool clamps = spore_pin_clamp(line.knots, line.first, line.last, side, &clamp);
  *measured = (SporePinnedSide){.held = line.last - line.first + 1,
                                .turns = !clamps,
                                .beyond_m = side * spore_path_length(line.knots, line.points, edge, clamp),
                                .free_m = side * spore_path_length(line.knots, line.points, edge, end)};
  return measured->free_m > 0;
}
