/* The parts of a body: what shows it, and what physics moves beneath. */
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/drawing_private.h"
#include "core/scene/schema_fields.h"

void spore_part_source_free(SporePartSource *source) {
  g_free(source->own_points);
  g_free(source->radii);
  if (source->mapped) spore_mapping_clear(&source->mapping);
  spore_free(source->places);
  spore_texture_clear(&source->texture);
  g_free(source);
}

/* A body whose parts are added. */
typedef struct Body {
  SporeDrawing *drawing;
  guint32 index;
  const SporeObject *object;
  const SporeModel *model; /* of its finest level; NULL: physics does not move it */
  SporeVisualFields visual;
  gboolean shown; /* a part shows it already */
} Body;

static SporeDrawnPart *add_part(Body *body, SporePartKind kind) {
  const SporeWorld *world = body->drawing->simulation->world;
  SporeDrawnPart part = {.kind = kind,
                         .body = body->index,
                         .name = spore_world_body_name(world, body->index),
                         .shows = !body->shown,
                         .moves = spore_world_body_role(world, body->index) != SPORE_UNMOVABLE,
                         .wetness = body->visual.wetness,
                         .opacity = body->visual.opacity,
                         .source = g_new0(SporePartSource, 1)};
  memcpy(part.colour, body->visual.colour, sizeof part.colour);
  part.source->corner_start = SIZE_MAX;
  body->shown = TRUE;
  g_array_append_val(body->drawing->parts, part);
  return &g_array_index(body->drawing->parts, SporeDrawnPart, body->drawing->parts->len - 1);
}

/* The asset that a unit of the body names; NULL: the unit names none of these elements. */
static SporeObject *asset_of(const Body *body, const char *unit, const char *property, const char *element) {
  const SporeObject *object = spore_object_child_of(body->object, unit);
  const char *name = object ? spore_object_text(object, property) : NULL;
  return name ? spore_document_find(body->drawing->document, element, name) : NULL;
}

static gboolean add_mesh(Body *body, SporeObject *asset, gboolean textured, GError **error) {
  const SporeTriangleMesh *mesh = spore_document_mesh(body->drawing->document, asset, error);
  if (!mesh) return FALSE;
  SporeDrawnPart *part = add_part(body, SPORE_PART_SURFACE);
  SporePartSource *source = part->source;
  source->count = mesh->vertex_count, source->points = mesh->vertices;
  source->whole_count = mesh->triangle_count, source->whole = mesh->triangles;
  const SporeObject *visual = textured ? spore_object_child_of(body->object, "visual") : NULL;
  if (visual && spore_texture_read(body->drawing->document, visual, &source->texture, NULL)) /* check says why not */
    part->picture = source->texture.picture;
  return TRUE;
}

static gboolean add_cells(Body *body, SporeObject *asset, GError **error) {
  const SporeTetrahedralMesh *mesh = spore_document_tetrahedra(body->drawing->document, asset, error);
  if (!mesh) return FALSE;
  guint first = body->drawing->parts->len;
  SporePartSource *source = add_part(body, SPORE_PART_CELLS)->source;
  source->count = mesh->vertex_count, source->points = mesh->vertices;
  source->whole_count = mesh->tetrahedron_count, source->whole = mesh->tetrahedra;
  gsize start = spore_world_corner_start(body->drawing->simulation->world, body->index);
  for (guint i = 0; i <= first && start != SIZE_MAX; i++) { /* the surface over them, too */
    const SporeDrawnPart *part = &g_array_index(body->drawing->parts, SporeDrawnPart, i);
    if (part->body == body->index) part->source->cells = mesh, part->source->corner_start = start;
  }
  return TRUE;
}

/* Points and radii from rows of x y z r. */
static void take_rows(SporePartSource *source, const double *rows, gsize count) {
  source->count = count;
  source->points = source->own_points = g_new(double, 3 * count + 1);
  source->radii = g_new(double, count + 1);
  for (gsize i = 0; i < count; i++) {
    memcpy(source->own_points + 3 * i, rows + 4 * i, 3 * sizeof *rows);
    source->radii[i] = rows[4 * i + 3];
  }
}

static gboolean add_line(Body *body, SporeObject *asset, GError **error) {
  const SporeCurve *curve = spore_document_curve(body->drawing->document, asset, error);
  if (curve) take_rows(add_part(body, SPORE_PART_LINE)->source, curve->points, curve->count);
  return curve != NULL;
}

static SporeDrawnPart *add_set(Body *body, const SporeSphereSet *set) {
  SporeDrawnPart *part = add_part(body, SPORE_PART_POINTS);
  take_rows(part->source, set->spheres, set->count);
  spore_spheres_radii(set, part->source->radii, 1);
  return part;
}

/* The model's own spheres: particles, where it has such. */
static gboolean add_own_spheres(Body *body, GError **error) {
  SporeSphereSet set = {0};
  SporeError fault = SPORE_ERROR_INIT;
  if (!body->model->type->spheres(body->model, &set, &fault)) return spore_error_propagate(&fault, error);
  SporeDrawnPart *part = add_set(body, &set);
  const SporeModelParticles *particles = body->model->type->particles;
  part->liquid = particles && !particles->puff;
  part->source->particles = particles ? body->model : NULL;
  spore_sphere_set_clear(&set);
  return TRUE;
}

/* Smoke: each node is a puff. */
static void add_puffs(Body *body) {
  SporeDrawnPart *part = add_part(body, SPORE_PART_POINTS);
  part->smoke = TRUE;
  part->source->particles = body->model;
  part->source->count = body->model->node_count;
  part->source->radii = g_new0(double, body->model->node_count + 1);
}

static gboolean add_spheres(Body *body, GError **error) {
  SporeObject *asset = asset_of(body, "collision", "spheres", "spheres");
  const SporeSphereSet *set = asset ? spore_document_spheres(body->drawing->document, asset, error) : NULL;
  if (set) add_set(body, set);
  if (set || asset) return set != NULL;
  return !body->model || !spore_body_has_own_spheres(body->object) || add_own_spheres(body, error);
}

/* The mesh of the visual unit; without it what the body is made of, and at last its spheres. */
static gboolean add_parts(Body *body, GError **error) {
  const SporeModelParticles *particles = body->model ? body->model->type->particles : NULL;
  SporeObject *mesh = asset_of(body, "visual", "mesh", "mesh");
  SporeObject *surface = asset_of(body, "mechanical", "geometry", "mesh");
  SporeObject *cells = asset_of(body, "mechanical", "geometry", "tetrahedra");
  SporeObject *curve = asset_of(body, "mechanical", "geometry", "curve");
  if (particles && particles->puff) return add_puffs(body), TRUE;
  if (mesh && !add_mesh(body, mesh, TRUE, error)) return FALSE;
  if (particles) return body->shown || add_spheres(body, error); /* its geometry is what it filled at the start */
  if (surface && !body->shown && !add_mesh(body, surface, FALSE, error)) return FALSE;
  if (cells && !add_cells(body, cells, error)) return FALSE;
  if (curve && !add_line(body, curve, error)) return FALSE;
  return body->shown || add_spheres(body, error);
}

gboolean spore_drawing_add_body(SporeDrawing *drawing, guint32 index, GError **error) {
  const SporeSimulation *simulation = drawing->simulation;
  Body body = {.drawing = drawing,
               .index = index,
               .object = spore_document_by_id(drawing->document, simulation->body_object[index]),
               .model = spore_world_lod_model(simulation->world, index, SPORE_LOD_FINE),
               .visual = {.colour = {0.75, 0.35, 0.32}, .wetness = 0.5, .opacity = 1}};
  const SporeObject *visual = spore_object_child_of(body.object, "visual");
  if (visual) spore_object_fields(visual, &body.visual);
  return add_parts(&body, error);
}
