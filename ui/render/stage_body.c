/* One body of the stage: what is drawn of it, built from its units and placed by its configuration. */
#include "ui/render/stage_body.h"

#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/drawing.h"
#include "core/scene/schema_fields.h"
#include "ui/render/colour_scale.h"

static const float sphere_colour[3] = {0.03f, 0.24f, 0.36f};
#define TUBE_SECTORS 16

static const float wire_colour[3] = {0.16f, 0.42f, 0.55f};

/* The configuration at time 0. It comes from the model, which never changes. The world may be stepping on another
 * thread. */
static void init_configuration(SporeStageBody *body, const SporeObject *object, const SporeSimulation *simulation,
                               const SporeLodGrade *level) {
  SporePose pose = spore_body_pose(object);
  const SporeModel *model = NULL;
  if (simulation) {
    const SporeWorld *world = simulation->world;
    for (gsize i = 0; i < spore_world_body_count(world); i++)
      if (simulation->body_object[i] == body->object) body->world_body = (guint32)i;
    if (body->world_body != SPORE_NO_BODY) {
      body->level = level ? *level : spore_world_first_lod(world, body->world_body);
      model = spore_world_lod_model(world, body->world_body, body->level);
      body->moves = spore_world_body_role(world, body->world_body) != SPORE_UNMOVABLE;
      body->q_offset = spore_world_q_offset(world, body->world_body);
    }
  }
  body->q_count = model ? model->q_room : 7;
  body->q = g_new0(double, body->q_count);
  if (model) {
    double *v = g_new0(double, 3 * model->block_room);
    model->type->place(model, pose, spore_vec3(0, 0, 0), spore_vec3(0, 0, 0), body->q, v);
    g_free(v);
  } else {
    spore_vec3_store(body->q, pose.position);
    spore_quat_store(body->q + 3, pose.orientation);
  }
}

static void keep_points(const SporeStageBody *body, gsize count, SporeStagePoints *mapped) {
  mapped->count = count;
  mapped->positions = g_new(double, 3 * count);
  spore_mapping_positions(&mapped->mapping, body->q, mapped->positions);
}

static gboolean map_points(const SporeStageBody *body, const SporeSimulation *simulation, const double *points,
                           gsize count, SporeStagePoints *mapped) {
  gboolean done =
      body->world_body != SPORE_NO_BODY
          ? spore_world_map_lod(simulation->world, body->world_body, body->level, points, count, &mapped->mapping, NULL)
          : spore_mapping_init_points(&mapped->mapping, SPORE_MAPPING_RIGID, points, count, NULL);
  if (done) keep_points(body, count, mapped);
  return done;
}

void spore_stage_body_follow_knots(SporeStageBody *body, const SporeSimulation *simulation,
                                   const SporeSnapshot *snapshot) {
  if (body->world_body == SPORE_NO_BODY || body->lines == snapshot->lines.number) return;
  body->lines = snapshot->lines.number;
  SporeSplineKnots knots = spore_snapshot_knots(simulation->world, snapshot, body->world_body);
  SporeStagePoints *all[] = {&body->surface, &body->centres, &body->nodes, &body->axis};
  for (guint i = 0; i < G_N_ELEMENTS(all); i++)
    spore_world_follow_knots(simulation->world, body->world_body, knots, &all[i]->mapping);
}

static void clear_points(SporeStagePoints *points) {
  if (points->count) spore_mapping_clear(&points->mapping);
  g_free(points->positions);
}

static SporeObject *asset_of(const SporeStage *stage, const SporeObject *unit, const char *property,
                             const char *elements) {
  const char *name = unit ? spore_object_text(unit, property) : NULL;
  return name ? spore_document_find(stage->document, elements, name) : NULL;
}

static const SporeTetrahedralMesh *tetrahedra_of(SporeStage *stage, const SporeObject *object) {
  SporeObject *asset = asset_of(stage, spore_object_child_of(object, "mechanical"), "geometry", "tetrahedra");
  return asset ? spore_document_tetrahedra(stage->document, asset, NULL) : NULL;
}

static void squeeze(const SporeStage *stage, const SporeStageBody *body, double *points, gsize count) {
  spore_squeeze_points((const SporeSqueeze *)(void *)stage->squeezes->data, stage->squeezes->len, body->world_body,
                       points, count);
}

/* The tube around the curve of the body. It is made anew around the moved axis, because the mapping does not know the
 * twist. */
static void place_tube(SporeStage *stage, SporeStageBody *body) {
  SporeTriangleMesh tube;
  spore_mapping_positions(&body->axis.mapping, body->q, body->axis.positions);
  for (gsize i = 0; i < body->axis.count; i++)
    memcpy(body->tube.points + 4 * i, body->axis.positions + 3 * i, 3 * sizeof(double));
  if (!spore_curve_tube(&body->tube, TUBE_SECTORS, &tube, NULL)) return;
  squeeze(stage, body, tube.vertices, tube.vertex_count);
  if (body->surface_handle) {
    memcpy(body->surface.positions, tube.vertices, 3 * tube.vertex_count * sizeof(double));
    spore_free(tube.triangles);
    spore_renderer_move_surface(stage->renderer, body->surface_handle, tube.vertices);
  } else {
    spore_stage_body_show_surface(stage, body, &tube);
  }
  spore_free(tube.vertices);
}

/* The tube is stained where its vertices lay at rest. Its rings are made anew and do not turn with the body, so that a
 * stain stays where it is along the tube, and about where it is around the tube. */
static void keep_tube_stain(SporeStage *stage, SporeStageBody *body, const SporeCurve *rest,
                            const SporeSimulation *simulation) {
  SporeTriangleMesh tube;
  if (!body->surface_handle || body->world_body == SPORE_NO_BODY) return;
  if (!spore_curve_tube(rest, TUBE_SECTORS, &tube, NULL)) return;
  if (tube.vertex_count == body->surface.count) {
    body->rest_tube = g_memdup2(tube.vertices, 3 * tube.vertex_count * sizeof *tube.vertices);
    spore_stage_body_keep_stain(stage, body, simulation->world, body->rest_tube);
  }
  spore_triangle_mesh_clear(&tube);
}

static void build_tube(SporeStage *stage, SporeStageBody *body, const SporeObject *object,
                       const SporeSimulation *simulation) {
  SporeObject *asset = asset_of(stage, spore_object_child_of(object, "mechanical"), "geometry", "curve");
  const SporeCurve *curve = asset ? spore_document_curve(stage->document, asset, NULL) : NULL;
  if (!curve) return;
  double *points = g_new(double, 3 * curve->count);
  for (gsize i = 0; i < curve->count; i++) memcpy(points + 3 * i, curve->points + 4 * i, 3 * sizeof(double));
  if (map_points(body, simulation, points, curve->count, &body->axis)) {
    body->rest_axis = curve->points;
    body->tube = (SporeCurve){curve->count, g_memdup2(curve->points, 4 * curve->count * sizeof(double))};
    place_tube(stage, body);
    keep_tube_stain(stage, body, curve, simulation);
  }
  g_free(points);
}

/* Adds the surface with the triangles of body->triangles. */
static void add_surface(SporeStage *stage, SporeStageBody *body, const SporeSimulation *simulation, double *vertices,
                        gsize vertex_count) {
  SporeStagePoints *surface = &body->surface;
  const SporeTriangleMesh mesh = {vertex_count, body->triangle_count, vertices, (uint32_t *)body->triangles, false};
  if (body->world_body == SPORE_NO_BODY) {
    if (!map_points(body, simulation, vertices, vertex_count, surface)) return;
  } else {
    if (!spore_world_map_drawn(simulation->world, body->world_body, body->level, &mesh, &surface->mapping, NULL))
      return;
    keep_points(body, vertex_count, surface);
  }
  body->surface_handle = spore_renderer_add_surface(stage->renderer, vertices, vertex_count, body->triangles,
                                                    body->triangle_count, &body->style);
  body->rest_surface = vertices;
  body->rest_count = vertex_count;
  spore_stage_body_lay_texture(stage, body, vertices, body->places);
  if (simulation && body->world_body != SPORE_NO_BODY)
    spore_stage_body_keep_stain(stage, body, simulation->world, vertices);
}

/* Puffs instead of a surface and spheres. */
static void build_smoke(SporeStage *stage, SporeStageBody *body, const SporeSimulation *simulation) {
  if (body->world_body == SPORE_NO_BODY) return;
  const SporeModel *model = spore_world_lod_model(simulation->world, body->world_body, SPORE_LOD_FINE);
  if (!model || !model->type->particles || !model->type->particles->puff) return;
  body->smoke = model;
  body->puffs = g_new(SporePuff, model->node_count);
  body->puffs_handle = spore_renderer_add_puffs(stage->renderer, body->style.colour);
}

static gboolean is_liquid(const SporeStageBody *body, const SporeObject *object, const SporeSimulation *simulation) {
  return body->world_body != SPORE_NO_BODY && spore_body_has_own_spheres(object) &&
         spore_world_lod_model(simulation->world, body->world_body, SPORE_LOD_FINE)->type->particles;
}

/* The mesh of the visual unit. Without one: the mesh of the mechanical unit, the boundary of its tetrahedra, or a tube
 * around its curve. */
static void build_surface(SporeStage *stage, SporeStageBody *body, const SporeObject *object,
                          const SporeSimulation *simulation) {
  const SporeObject *visual = spore_object_child_of(object, "visual");
  if (body->smoke || (!simulation && spore_body_is_kept_back(stage->document, object))) return;
  SporeObject *asset = asset_of(stage, visual, "mesh", "mesh");
  body->liquid = !asset && is_liquid(body, object, simulation);
  if (body->liquid) return; /* comes with its spheres */
  if (!asset) asset = asset_of(stage, spore_object_child_of(object, "mechanical"), "geometry", "mesh");
  else spore_stage_body_find_texture(stage, body, visual);
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(stage->document, asset, NULL) : NULL;
  if (mesh) {
    body->triangles = mesh->triangles;
    body->triangle_count = mesh->triangle_count;
    add_surface(stage, body, simulation, mesh->vertices, mesh->vertex_count);
    return;
  }
  const SporeTetrahedralMesh *tetrahedra = tetrahedra_of(stage, object);
  if (tetrahedra && spore_tetrahedral_mesh_boundary(tetrahedra, &body->own_triangles, &body->triangle_count)) {
    body->triangles = body->own_triangles;
    add_surface(stage, body, simulation, tetrahedra->vertices, tetrahedra->vertex_count);
    return;
  }
  build_tube(stage, body, object, simulation);
}

/* asset: of the set; NULL: the model's own spheres. */
static void show_spheres(SporeStage *stage, SporeStageBody *body, const SporeSimulation *simulation,
                         const SporeSphereSet *set, SporeObject *asset) {
  double *centres = g_new(double, 3 * set->count);
  for (gsize i = 0; i < set->count; i++) memcpy(centres + 3 * i, set->spheres + 4 * i, 3 * sizeof(double));
  gboolean mapped = map_points(body, simulation, centres, set->count, &body->centres);
  g_free(centres);
  if (!mapped) return;
  body->spheres = g_memdup2(set->spheres, set->count * 4 * sizeof(double));
  spore_spheres_radii(set, body->spheres + 3, 4);
  body->shown = set->count;
  body->solid = !body->surface_handle && !body->liquid;
  const SporeStageFit *fit = body->solid || !asset ? NULL : spore_stage_fit(stage, asset, set);
  body->fit_high = fit ? fit->high : 0;
  body->fits = fit ? g_memdup2(fit->places, set->count * sizeof *fit->places) : NULL;
  body->spheres_handle = spore_renderer_add_spheres(stage->renderer, body->spheres, set->count,
                                                    body->solid ? body->style.colour : sphere_colour,
                                                    fit ? fit->places : NULL, !body->solid);
  if (body->solid && body->world_body != SPORE_NO_BODY) spore_stage_body_keep_spheres_stain(body, simulation->world);
}

static void build_spheres(SporeStage *stage, SporeStageBody *body, const SporeObject *object,
                          const SporeSimulation *simulation) {
  SporeObject *asset = asset_of(stage, spore_object_child_of(object, "collision"), "spheres", "spheres");
  const SporeSphereSet *set = asset ? spore_document_spheres(stage->document, asset, NULL) : NULL;
  SporeSphereSet own = {0};
  if (set) {
    show_spheres(stage, body, simulation, set, asset);
  } else if (body->world_body != SPORE_NO_BODY && spore_body_has_own_spheres(object)) {
    const SporeModel *model = spore_world_lod_model(simulation->world, body->world_body, SPORE_LOD_FINE);
    body->particles = model->type->particles != NULL;
    if (model->type->spheres(model, &own, NULL)) show_spheres(stage, body, simulation, &own, NULL);
    spore_sphere_set_clear(&own);
  }
}

static void build_wire(SporeStage *stage, SporeStageBody *body, const SporeObject *object,
                       const SporeSimulation *simulation) {
  const SporeTetrahedralMesh *mesh = tetrahedra_of(stage, object);
  if (!mesh || !map_points(body, simulation, mesh->vertices, mesh->vertex_count, &body->nodes)) return;
  if (!spore_edges_of_tetrahedra(mesh->tetrahedra, mesh->tetrahedron_count, &body->edges, &body->edge_count)) return;
  body->segments = g_new(double, 6 * body->edge_count);
  body->wire_handle = spore_renderer_add_lines(stage->renderer, NULL, 0, wire_colour, 1.0f);
}

static void prepare_divide(SporeStage *stage, SporeStageBody *body, const SporeObject *object,
                           const SporeSimulation *simulation) {
  if (body->world_body == SPORE_NO_BODY) return;
  body->corner_start = spore_world_corner_start(simulation->world, body->world_body);
  const SporeTetrahedralMesh *cells = body->corner_start == SIZE_MAX ? NULL : tetrahedra_of(stage, object);
  if (!cells) return;
  SporeObject *asset = asset_of(stage, spore_object_child_of(object, "visual"), "mesh", "mesh");
  const SporeTriangleMesh *mesh = asset ? spore_document_mesh(stage->document, asset, NULL) : NULL;
  body->cells = cells;
  body->rest = mesh ? mesh->vertices : NULL;
  if (body->surface.count)
    spore_mapping_find_places(&body->surface.mapping, cells->tetrahedra, cells->tetrahedron_count, cells->vertex_count,
                              &body->surface_places);
  if (body->centres.count)
    spore_mapping_find_places(&body->centres.mapping, cells->tetrahedra, cells->tetrahedron_count, cells->vertex_count,
                              &body->centre_places);
}

SporeStageBody *spore_stage_body_new(SporeStage *stage, SporeObject *object, const SporeSimulation *simulation,
                                     const SporeLodGrade *level) {
  SporeStageBody *body = g_new0(SporeStageBody, 1);
  SporeVisualFields visual = {.colour = {0.75, 0.35, 0.32}, .wetness = 0.5, .opacity = 1};
  const SporeObject *unit = spore_object_child_of(object, "visual");
  if (unit) spore_object_fields(unit, &visual);
  body->object = spore_object_id(object);
  body->world_body = SPORE_NO_BODY;
  for (int i = 0; i < 3; i++) body->style.colour[i] = (float)spore_linear_light(visual.colour[i]);
  body->style.wetness = (float)visual.wetness;
  body->style.clearness = (float)(1 - visual.opacity);
  SporeBodyFields fields;
  spore_object_fields(object, &fields);
  body->style.material = fields.role == SPORE_ACTIVE ? SPORE_MATERIAL_METAL : SPORE_MATERIAL_TISSUE;
  body->style.selected = g_hash_table_contains(stage->selection, GUINT_TO_POINTER(body->object));
  init_configuration(body, object, simulation, level);
  build_smoke(stage, body, simulation);
  build_surface(stage, body, object, simulation);
  build_spheres(stage, body, object, simulation);
  build_wire(stage, body, object, simulation);
  prepare_divide(stage, body, object, simulation);
  spore_stage_body_show(stage, body);
  spore_stage_body_place(stage, body);
  return body;
}

void spore_stage_body_free(SporeStage *stage, SporeStageBody *body) {
  const guint handles[] = {body->surface_handle, body->spheres_handle, body->puffs_handle, body->wire_handle,
                           body->inside_handle};
  for (guint i = 0; i < G_N_ELEMENTS(handles); i++)
    if (handles[i]) spore_renderer_remove(stage->renderer, handles[i]);
  spore_stage_body_free_stain(body);
  spore_stage_body_free_shade(body);
  spore_free(body->surface_places);
  spore_free(body->centre_places);
  if (body->whole_surface.point_count) spore_mapping_clear(&body->whole_surface);
  clear_points(&body->surface);
  clear_points(&body->centres);
  clear_points(&body->nodes);
  clear_points(&body->axis);
  g_free(body->tube.points);
  g_free(body->rest_tube);
  spore_free(body->own_triangles);
  spore_free(body->places);
  spore_free(body->edges);
  g_free(body->spheres);
  g_free(body->fits);
  g_free(body->puffs);
  g_free(body->segments);
  g_free(body->q);
  g_free(body);
}

/* Moves the centres; of particles, keeps those that are in the world. All particles of a body have the same radius. */
static void place_centres(SporeStageBody *body) {
  spore_mapping_positions(&body->centres.mapping, body->q, body->centres.positions);
  if (!body->particles) return;
  body->shown = 0;
  for (gsize i = 0; i < body->centres.count; i++) {
    const double *centre = body->centres.positions + 3 * i;
    if (!spore_particle_is_out(centre))
      memmove(body->centres.positions + 3 * body->shown++, centre, 3 * sizeof *centre);
  }
}

static void place_spheres(SporeStage *stage, SporeStageBody *body) {
  place_centres(body);
  for (gsize i = 0; i < body->shown; i++)
    memcpy(body->spheres + 4 * i, body->centres.positions + 3 * i, 3 * sizeof(double));
  spore_renderer_move_spheres(stage->renderer, body->spheres_handle, body->spheres, body->shown);
}

/* Neighbouring puffs look different, and each puff keeps its look. */
#define GOLDEN_TURN 0.6180339887498949

static void place_smoke(SporeStage *stage, SporeStageBody *body) {
  gsize count = 0;
  for (gsize i = 0; i < body->smoke->node_count; i++) {
    SporePuff *puff = &body->puffs[count];
    if (spore_particle_is_out(body->q + 3 * i)) continue;
    memcpy(puff->centre, body->q + 3 * i, sizeof puff->centre);
    body->smoke->type->particles->puff(body->smoke, body->q, i, &puff->radius, &puff->opacity);
    puff->seed = 10 * fmod(GOLDEN_TURN * (double)i, 1);
    count++;
  }
  spore_renderer_move_puffs(stage->renderer, body->puffs_handle, body->puffs, count);
}

static void place_liquid(SporeStage *stage, SporeStageBody *body) {
  SporeTriangleMesh skin;
  place_centres(body);
  if (!spore_particle_skin(body->centres.positions, body->shown, 2 * SPORE_LIQUID_SPACING * body->spheres[3], &skin,
                           NULL))
    return;
  body->style.material = SPORE_MATERIAL_LIQUID;
  spore_stage_body_show_surface(stage, body, &skin);
  spore_free(skin.vertices);
}

static void place_wire(SporeStage *stage, SporeStageBody *body) {
  spore_mapping_positions(&body->nodes.mapping, body->q, body->nodes.positions);
  for (gsize i = 0; i < 2 * body->edge_count; i++)
    memcpy(body->segments + 3 * i, body->nodes.positions + 3 * (gsize)body->edges[i], 3 * sizeof(double));
  spore_renderer_move_lines(stage->renderer, body->wire_handle, body->segments, body->edge_count);
}

void spore_stage_body_place(SporeStage *stage, SporeStageBody *body) {
  if (body->liquid && body->centres.count) {
    place_liquid(stage, body);
  } else if (body->tube.count) {
    place_tube(stage, body);
  } else if (body->surface_handle) { /* hidden ones too: picking and bounds use their positions */
    spore_mapping_positions(&body->surface.mapping, body->q, body->surface.positions);
    squeeze(stage, body, body->surface.positions, body->surface.count);
    spore_renderer_move_surface(stage->renderer, body->surface_handle, body->surface.positions);
  }
  if (body->inside_handle) spore_renderer_move_surface(stage->renderer, body->inside_handle, body->q);
  if (body->smoke) place_smoke(stage, body);
  if (body->spheres_handle && (stage->options.spheres || body->solid)) place_spheres(stage, body);
  if (body->wire_handle && stage->options.tetrahedra) place_wire(stage, body);
}

/* The candidate that is shown in place of what the body has; NULL: none. */
static const SporeStageCandidate *candidate_for(const SporeStage *stage, const SporeStageBody *body) {
  return stage->candidate && stage->candidate->body == body->object ? stage->candidate : NULL;
}

gboolean spore_stage_body_shows_spheres(const SporeStage *stage, const SporeStageBody *body) {
  const SporeStageCandidate *instead = candidate_for(stage, body);
  if (!body->spheres_handle || !spore_stage_shows(stage, body->object) ||
      (instead && (instead->sphere_count || instead->triangle_count)))
    return FALSE;
  return stage->options.spheres || (body->solid && stage->options.surfaces);
}

void spore_stage_body_show(SporeStage *stage, SporeStageBody *body) {
  SporeRenderer *renderer = stage->renderer;
  const SporeStageCandidate *instead = candidate_for(stage, body);
  gboolean shown = spore_stage_shows(stage, body->object), surfaces = shown && stage->options.surfaces;
  if (body->surface_handle)
    spore_renderer_set_visible(renderer, body->surface_handle, surfaces && !(instead && instead->triangle_count));
  if (body->inside_handle) spore_renderer_set_visible(renderer, body->inside_handle, surfaces);
  if (body->spheres_handle)
    spore_renderer_set_visible(renderer, body->spheres_handle, spore_stage_body_shows_spheres(stage, body));
  if (body->puffs_handle) spore_renderer_set_visible(renderer, body->puffs_handle, surfaces);
  if (body->wire_handle) spore_renderer_set_visible(renderer, body->wire_handle, shown && stage->options.tetrahedra);
}
