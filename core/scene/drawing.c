/* The parts of a drawing at a moment. */
#include "core/scene/drawing.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/cut_edges.h"
#include "core/scene/drawing_private.h"

gboolean spore_drawn_part_refuse(const SporeDrawnPart *part, SporeError *fault, GError **error) {
  g_autofree char *place = g_strdup_printf("bodies/%s", part->name);
  spore_error_at(fault, place);
  return spore_error_propagate(fault, error);
}

/* Mappings. */

static gboolean make_mapping(const SporeSimulation *simulation, SporeDrawnPart *part, SporeLodGrade level,
                             GError **error) {
  SporePartSource *source = part->source;
  SporeError fault = SPORE_ERROR_INIT;
  const SporeTriangleMesh mesh = {source->count, source->whole_count, (double *)source->points,
                                  (uint32_t *)source->whole, false};
  if (source->mapped) spore_mapping_clear(&source->mapping);
  source->mapped = part->kind == SPORE_PART_SURFACE
                       ? spore_world_map_drawn(simulation->world, part->body, level, &mesh, &source->mapping, &fault)
                       : spore_world_map_lod(simulation->world, part->body, level, source->points, source->count,
                                             &source->mapping, &fault);
  if (!source->mapped) return spore_drawn_part_refuse(part, &fault, error);
  source->level = level;
  source->knots = source->parted = G_MAXUINT64;
  spore_free(source->places);
  source->places = NULL;
  gboolean divided = part->kind == SPORE_PART_SURFACE && level == SPORE_LOD_FINE; /* the finest level alone is cut */
  const SporeTetrahedralMesh *cells = divided ? source->cells : NULL;
  if (!cells || spore_mapping_find_places(&source->mapping, cells->tetrahedra, cells->tetrahedron_count,
                                          cells->vertex_count, &source->places))
    return TRUE;
  spore_error_set(&fault, SPORE_ERROR_MEMORY, NULL, _("not enough memory for its drawn vertices"));
  return spore_drawn_part_refuse(part, &fault, error);
}

static gboolean follow_knots(const SporeSimulation *simulation, const SporeSnapshot *snapshot, SporeDrawnPart *part,
                             GError **error) {
  SporePartSource *source = part->source;
  if (source->knots == snapshot->lines.number) return TRUE;
  const SporeSplineKnots knots = spore_snapshot_knots(simulation->world, snapshot, part->body);
  source->knots = snapshot->lines.number;
  if (spore_world_follow_knots(simulation->world, part->body, knots, &source->mapping)) return TRUE;
  SporeError fault = SPORE_ERROR_INIT;
  spore_error_set(&fault, SPORE_ERROR_MEMORY, NULL, _("not enough memory for its drawn vertices"));
  return spore_drawn_part_refuse(part, &fault, error);
}

/* Elements. */

/* Whether the corners of the triangle follow different copies of one node. */
static gboolean is_straddling(const SporePartSource *source, const guint32 *corners, const guint32 *triangle) {
  const SporeMapping *mapping = &source->mapping;
  for (int c = 0; c < 3; c++)
    for (guint32 k = mapping->row_start[triangle[c]]; k < mapping->row_start[triangle[c] + 1]; k++)
      for (int d = 0; d < c; d++)
        for (guint32 m = mapping->row_start[triangle[d]]; m < mapping->row_start[triangle[d] + 1]; m++) {
          guint32 one = source->places[k], other = source->places[m];
          if (one != UINT32_MAX && other != UINT32_MAX && corners[one] != corners[other] &&
              source->cells->tetrahedra[one] == source->cells->tetrahedra[other])
            return TRUE;
        }
  return FALSE;
}

static void keep_triangle(SporeDrawnPart *part, gsize i) {
  gsize kept = part->element_count++;
  memcpy(part->elements + 3 * kept, part->source->whole + 3 * i, 3 * sizeof *part->elements);
  if (part->places) memcpy(part->places + 6 * kept, part->source->texture.places + 6 * i, 6 * sizeof *part->places);
}

/* The triangles that no cut goes through. */
static void take_triangles(SporeDrawnPart *part, const SporeSnapshot *snapshot) {
  const SporePartSource *source = part->source;
  const guint32 *corners = source->places ? snapshot->cuts.corners + 4 * source->corner_start : NULL;
  gboolean follows = source->mapping.kind == SPORE_MAPPING_IDENTITY || source->mapping.kind == SPORE_MAPPING_LINEAR;
  g_autoptr(GArray) edges = source->cells || !follows ? NULL : spore_cut_edges_of(&snapshot->cuts, part->body);
  part->element_count = 0;
  for (gsize i = 0; i < source->whole_count; i++) {
    const guint32 *triangle = source->whole + 3 * i;
    gboolean cut = corners ? is_straddling(source, corners, triangle)
                           : edges && edges->len && spore_triangle_is_cut(&source->mapping, triangle, edges);
    if (!cut) keep_triangle(part, i);
  }
  part->cut = part->element_count != source->whole_count;
}

/* The present nodes of tetrahedra that cuts may divide; NULL: they are not divided at this level. */
static const guint32 *corners_of(const SporeDrawnPart *part, const SporeSnapshot *snapshot) {
  const SporePartSource *source = part->source;
  return source->cells && source->level == SPORE_LOD_FINE ? snapshot->cuts.corners + 4 * source->corner_start : NULL;
}

static void take_elements(SporeDrawnPart *part, const SporeSnapshot *snapshot) {
  SporePartSource *source = part->source;
  if (part->kind == SPORE_PART_SURFACE) {
    take_triangles(part, snapshot);
  } else if (part->kind == SPORE_PART_CELLS) {
    const guint32 *corners = corners_of(part, snapshot);
    gsize bytes = 4 * source->whole_count * sizeof *source->whole;
    part->element_count = source->whole_count;
    part->cut = corners && memcmp(corners, source->whole, bytes) != 0;
    memcpy(part->elements, corners ? corners : source->whole, bytes);
  }
}

/* Points. */

static void make_room(SporeDrawnPart *part, gsize count) {
  part->count = count;
  part->positions = g_renew(double, part->positions, 3 * count + 1);
  part->velocities = g_renew(double, part->velocities, 3 * count + 1);
  if (part->kind == SPORE_PART_CELLS) part->rest = g_renew(double, part->rest, 3 * count + 1);
}

/* Nodes that were divided have the place at rest of the node that they come from. */
static void place_rest(SporeDrawnPart *part, SporePose start) {
  const SporePartSource *source = part->source;
  for (gsize i = 0; i < source->count; i++)
    spore_vec3_store(part->rest + 3 * i, spore_pose_apply(start, spore_vec3_load(source->points + 3 * i)));
  for (gsize i = 0; part->cut && i < 4 * source->whole_count; i++)
    memcpy(part->rest + 3 * (gsize)part->elements[i], part->rest + 3 * (gsize)source->whole[i], 3 * sizeof(double));
}

static gsize node_count(const SporeDrawnPart *part) {
  gsize count = part->source->count;
  for (gsize i = 0; part->cut && i < 4 * part->element_count; i++)
    if (part->elements[i] >= count) count = (gsize)part->elements[i] + 1;
  return count;
}

static void place_points(SporeDrawnPart *part, const SporeSnapshot *snapshot, const double *q, const double *v) {
  const SporePartSource *source = part->source;
  SporeMapping nodes = source->mapping;
  gboolean divided = part->kind == SPORE_PART_CELLS && part->cut;
  if (divided) spore_mapping_init_identity(&nodes, node_count(part));
  make_room(part, nodes.point_count);
  spore_mapping_positions(&nodes, q, part->positions);
  spore_mapping_velocities(&nodes, q, v, part->velocities);
  if (part->shows)
    spore_squeeze_points(snapshot->squeezes, snapshot->squeeze_count, part->body, part->positions, part->count);
}

/* Keeps particles that are in the world. */
static void keep_particles(SporeDrawnPart *part, const double *q) {
  const SporePartSource *source = part->source;
  gsize count = 0;
  double opacity;
  for (gsize i = 0; i < part->count; i++) {
    if (spore_particle_is_out(part->positions + 3 * i)) continue;
    memmove(part->positions + 3 * count, part->positions + 3 * i, 3 * sizeof(double));
    memmove(part->velocities + 3 * count, part->velocities + 3 * i, 3 * sizeof(double));
    part->radii[count] = source->radii[i];
    if (part->smoke) source->particles->type->particles->puff(source->particles, q, i, &part->radii[count], &opacity);
    count++;
  }
  part->count = count;
}

/* A rigid body turns about its centre of mass, from where its mapping counts; the frame is that of the points at rest.
 */
static void place_frame(SporeDrawnPart *part, SporePose start, const double *q) {
  const SporePartSource *source = part->source;
  const SporeMappingKind kind = source->mapping.kind;
  part->framed = !part->smoke && source->count > 0 && (kind == SPORE_MAPPING_RIGID || kind == SPORE_MAPPING_FIXED);
  part->frame = start;
  if (!part->framed || kind == SPORE_MAPPING_FIXED) return;
  SporeVec3 offset = spore_vec3_sub(spore_vec3_load(source->mapping.points), spore_vec3_load(source->points));
  part->frame = spore_pose_load(q);
  part->frame.position = spore_pose_apply(part->frame, offset);
}

static gboolean update_part(const SporeDrawing *drawing, const SporeSnapshot *snapshot, SporeDrawnPart *part,
                            GError **error) {
  const SporeWorld *world = drawing->simulation->world;
  SporePartSource *source = part->source;
  const SporePose start = spore_world_start_pose(world, part->body);
  const double *q = snapshot->q + spore_world_q_offset(world, part->body);
  const double *v = snapshot->v + spore_world_v_offset(world, part->body);
  const SporeLodGrade level =
      snapshot->level ? (SporeLodGrade)snapshot->level[part->body] : spore_world_first_lod(world, part->body);
  if (part->smoke) {
    spore_mapping_init_identity(&source->mapping, source->count);
    source->mapped = TRUE;
  } else {
    if ((!source->mapped || source->level != level) && !make_mapping(drawing->simulation, part, level, error))
      return FALSE;
    if (!follow_knots(drawing->simulation, snapshot, part, error)) return FALSE;
  }
  if (source->places && source->parted != snapshot->cuts.parted)
    spore_mapping_follow(&source->mapping, source->places, snapshot->cuts.corners + 4 * source->corner_start);
  source->parted = snapshot->cuts.parted;
  take_elements(part, snapshot);
  place_points(part, snapshot, q, v);
  if (part->rest) place_rest(part, start);
  if (source->particles) keep_particles(part, q);
  place_frame(part, start, q);
  return TRUE;
}

gboolean spore_drawing_update(SporeDrawing *drawing, GError **error) {
  const SporeSnapshot *snapshot = spore_world_snapshot_acquire(drawing->simulation->world);
  for (guint i = 0; i < drawing->parts->len; i++)
    if (!update_part(drawing, snapshot, &g_array_index(drawing->parts, SporeDrawnPart, i), error)) return FALSE;
  return TRUE;
}

/* The drawing. */

static void clear_part(gpointer data) {
  SporeDrawnPart *part = data;
  spore_part_source_free(part->source);
  g_free(part->positions);
  g_free(part->velocities);
  g_free(part->radii);
  g_free(part->elements);
  g_free(part->places);
  g_free(part->rest);
}

/* Room for as much as the part can ever hold beside its points. */
static void make_arrays(SporeDrawnPart *part) {
  const SporePartSource *source = part->source;
  if (source->radii) part->radii = g_memdup2(source->radii, (source->count + 1) * sizeof *source->radii);
  if (source->whole) part->elements = g_new(guint32, 4 * source->whole_count + 1);
  if (part->picture) part->places = g_new(float, 6 * source->whole_count + 1);
}

SporeDrawing *spore_drawing_new(SporeDocument *document, const SporeSimulation *simulation, GError **error) {
  g_autoptr(SporeDrawing) drawing = g_new0(SporeDrawing, 1);
  drawing->document = document;
  drawing->simulation = simulation;
  drawing->parts = g_array_new(FALSE, TRUE, sizeof(SporeDrawnPart));
  g_array_set_clear_func(drawing->parts, clear_part);
  for (guint32 body = 0; body < spore_world_body_count(simulation->world); body++)
    if (!spore_drawing_add_body(drawing, body, error)) return NULL;
  for (guint i = 0; i < drawing->parts->len; i++) make_arrays(&g_array_index(drawing->parts, SporeDrawnPart, i));
  return spore_drawing_update(drawing, error) ? g_steal_pointer(&drawing) : NULL;
}

void spore_drawing_free(SporeDrawing *drawing) {
  g_array_unref(drawing->parts);
  g_free(drawing);
}

const SporeSimulation *spore_drawing_simulation(const SporeDrawing *drawing) { return drawing->simulation; }

guint spore_drawing_part_count(const SporeDrawing *drawing) { return drawing->parts->len; }

const SporeDrawnPart *spore_drawing_part(const SporeDrawing *drawing, guint i) {
  g_assert(i < drawing->parts->len);
  return &g_array_index(drawing->parts, SporeDrawnPart, i);
}
