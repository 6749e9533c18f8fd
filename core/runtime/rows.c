/* What a runtime file keeps: a table for each structure that a world is made from.
 *
 * A list of members gives the table and a guard: an initialiser of the structure that must name as many members as
 * there are. A new member without a row does not compile. */
#include "core/runtime/rows.h"

#include <string.h>

#include "core/base/hash.h"

#pragma GCC diagnostic error "-Wmissing-field-initializers"

/* What stands in the guard for a member. */
#define GUARD_SKIPPED 0
#define GUARD_OPTION 0
#define GUARD_REAL 0
#define GUARD_REALS                                                                                                    \
  {}
#define GUARD_WORD 0
#define GUARD_WIDE 0
#define GUARD_SIZE 0
#define GUARD_CHOICE 0
#define GUARD_FLAG 0
#define GUARD_BODY 0
#define GUARD_BODIES                                                                                                   \
  {}
#define GUARD_TEXT 0
#define GUARD_RECORD                                                                                                   \
  {}
#define GUARD_FIELDS                                                                                                   \
  {}
#define GUARD_TYPE 0
#define GUARD_TYPE_FIELDS 0
#define GUARD_TYPE_VALUES                                                                                              \
  {}
#define GUARD_POINTER 0

#define GUARD(Type, member, what, ...) GUARD_##what,
#define ROW(Type, member, what, ...)                                                                                   \
  {.name = #member, .kind = SPORE_ROW_##what, .offset = offsetof(Type, member), ##__VA_ARGS__},
#define TABLE(storage, variable, Type, MEMBERS)                                                                        \
  static const Type variable##_guard __attribute__((unused)) = {MEMBERS(GUARD, Type)};                                 \
  static const SporeRow variable##_rows[] = {MEMBERS(ROW, Type)};                                                      \
  storage const SporeRowTable variable = {#Type, sizeof(Type), sizeof variable##_rows / sizeof *variable##_rows,       \
                                          variable##_rows};

#define DOUBLES(Type) .repeat = sizeof(Type) / sizeof(double)
#define MANY(Type, number, times, what) .count = offsetof(Type, number), .repeat = (times), .element = SPORE_ROW_##what
#define RECORDS(Type, number, times, rows) MANY(Type, number, times, RECORD), .table = &(rows)
#define ONE(rows) .count = SPORE_ROW_ONCE, .repeat = 1, .element = SPORE_ROW_RECORD, .table = &(rows)

/* Geometry. */

#define TRIANGLES(X, T)                                                                                                \
  X(T, vertex_count, SIZE)                                                                                             \
  X(T, triangle_count, SIZE)                                                                                           \
  X(T, vertices, POINTER, MANY(T, vertex_count, 3, REAL))                                                              \
  X(T, triangles, POINTER, MANY(T, triangle_count, 3, WORD))                                                           \
  X(T, reoriented, FLAG)
TABLE(static, triangles, SporeTriangleMesh, TRIANGLES)

#define TETRAHEDRA(X, T)                                                                                               \
  X(T, vertex_count, SIZE)                                                                                             \
  X(T, tetrahedron_count, SIZE)                                                                                        \
  X(T, vertices, POINTER, MANY(T, vertex_count, 3, REAL))                                                              \
  X(T, tetrahedra, POINTER, MANY(T, tetrahedron_count, 4, WORD))                                                       \
  X(T, labels, POINTER, MANY(T, tetrahedron_count, 1, WORD))
TABLE(static, tetrahedra, SporeTetrahedralMesh, TETRAHEDRA)

#define SPHERES(X, T)                                                                                                  \
  X(T, count, SIZE)                                                                                                    \
  X(T, spheres, POINTER, MANY(T, count, 4, REAL))                                                                      \
  X(T, weights, POINTER, MANY(T, count, 1, REAL))                                                                      \
  X(T, level, REAL)
TABLE(static, spheres, SporeSphereSet, SPHERES)

#define CURVE(X, T) X(T, count, SIZE) X(T, points, POINTER, MANY(T, count, 4, REAL))
TABLE(static, curve, SporeCurve, CURVE)

#define REGION(X, T)                                                                                                   \
  X(T, ball_count, SIZE)                                                                                               \
  X(T, balls, POINTER, MANY(T, ball_count, 4, REAL))                                                                   \
  X(T, stiffness, REAL)                                                                                                \
  X(T, density, REAL)                                                                                                  \
  X(T, elements, SKIPPED)
TABLE(static, region, SporeRegion, REGION)

#define REGIONS(X, T) X(T, count, SIZE) X(T, regions, POINTER, RECORDS(T, count, 1, region))
TABLE(static, regions, SporeRegions, REGIONS)

#define GEOMETRY(X, T)                                                                                                 \
  X(T, surface, POINTER, ONE(triangles))                                                                               \
  X(T, tetrahedra, POINTER, ONE(tetrahedra))                                                                           \
  X(T, curve, POINTER, ONE(curve))                                                                                     \
  X(T, root, POINTER, ONE(curve))                                                                                      \
  X(T, regions, POINTER, ONE(regions))                                                                                 \
  X(T, cancel, SKIPPED)                                                                                                \
  X(T, corners, POINTER, .count = SPORE_ROW_ONCE, .repeat = 12, .element = SPORE_ROW_REAL)
TABLE(static, geometry, SporeGeometry, GEOMETRY)

/* Models, links, tools, steps and metrics are named by their types. */

static const void *find_model(SporeModelRegistry registry, const char *name) {
  return spore_model_type_find(registry, name);
}
static const char *name_of_model(const void *type) { return ((const SporeModelType *)type)->name; }
static const SporeParameterTable *of_model(const void *type) { return &((const SporeModelType *)type)->parameters; }
static const SporeRowTypes model_types = {find_model, name_of_model, of_model};

static const void *find_link(SporeModelRegistry registry, const char *name) { return spore_link_type_find(name); }
static const char *name_of_link(const void *type) { return ((const SporeLinkType *)type)->element; }
static const SporeParameterTable *of_link(const void *type) { return &((const SporeLinkType *)type)->parameters; }
static const SporeRowTypes link_types = {find_link, name_of_link, of_link};

static const void *find_tool(SporeModelRegistry registry, const char *name) { return spore_tool_type_find(name); }
static const char *name_of_tool(const void *type) { return ((const SporeToolType *)type)->element; }
static const SporeParameterTable *of_tool(const void *type) { return &((const SporeToolType *)type)->parameters; }
static const SporeRowTypes tool_types = {find_tool, name_of_tool, of_tool};

static const void *find_event(SporeModelRegistry registry, const char *name) { return spore_event_kind_find(name); }
static const char *name_of_event(const void *type) { return ((const SporeEventKind *)type)->element; }
static const SporeParameterTable *of_event(const void *type) { return &((const SporeEventKind *)type)->parameters; }
static const SporeRowTypes event_types = {find_event, name_of_event, of_event};

static const void *find_metric(SporeModelRegistry registry, const char *name) { return spore_metric_kind_find(name); }
static const char *name_of_metric(const void *type) { return ((const SporeMetricKind *)type)->element; }
static const SporeParameterTable *of_metric(const void *type) { return &((const SporeMetricKind *)type)->parameters; }
static const SporeRowTypes metric_types = {find_metric, name_of_metric, of_metric};

#define RECIPE(X, T)                                                                                                   \
  X(T, type, TYPE, .types = &model_types)                                                                              \
  X(T, geometry, RECORD, .table = &geometry)                                                                           \
  X(T, fields, TYPE_FIELDS, .types = &model_types)
TABLE(static, recipe, SporeModelRecipe, RECIPE)

/* Descriptions. */

#define RULE(X, T)                                                                                                     \
  X(T, by, CHOICE, .least = SPORE_LOD_BY_HAND, .most = SPORE_LOD_BY_TIME)                                              \
  X(T, tool_distance, REAL)                                                                                            \
  X(T, view_distance, REAL)                                                                                            \
  X(T, wait_s, REAL)
TABLE(static, rule, SporeLodRule, RULE)

#define GUARD_MODELS                                                                                                   \
  {}
#define SPORE_ROW_MODELS SPORE_ROW_SKIPPED /* an array of pointers */
#define LEVELS(X, T)                                                                                                   \
  X(T, model, MODELS)                                                                                                  \
  X(T, first, CHOICE, .least = SPORE_LOD_COARSE, .most = SPORE_LOD_FINE)                                               \
  X(T, tolerance, REAL)                                                                                                \
  X(T, rule, RECORD, .table = &rule)                                                                                   \
  X(T, surface_count, SIZE)                                                                                            \
  X(T, surface, POINTER, MANY(T, surface_count, 3, REAL))
TABLE(static, levels, SporeLodDescription, LEVELS)

#define BODY(X, T)                                                                                                     \
  X(T, name, TEXT)                                                                                                     \
  X(T, role, CHOICE, .least = SPORE_UNMOVABLE, .most = SPORE_PASSIVE)                                                  \
  X(T, model, SKIPPED)                                                                                                 \
  X(T, lod, RECORD, .table = &levels)                                                                                  \
  X(T, integrator, CHOICE, .least = SPORE_INTEGRATOR_DEFAULT, .most = SPORE_INTEGRATOR_COUNT - 1)                      \
  X(T, substeps, SIZE)                                                                                                 \
  X(T, pose, REALS, DOUBLES(SporePose))                                                                                \
  X(T, velocity, REALS, DOUBLES(SporeVec3))                                                                            \
  X(T, spin, REALS, DOUBLES(SporeVec3))                                                                                \
  X(T, effect, FLAG)                                                                                                   \
  X(T, start_count, SIZE)                                                                                              \
  X(T, start, POINTER, MANY(T, start_count, 1, REAL))                                                                  \
  X(T, spheres, POINTER, ONE(spheres))                                                                                 \
  X(T, contact, FIELDS, .parameters = &spore_contact_parameters)
TABLE(static, body, SporeBodyDescription, BODY)

#define LINK(X, T)                                                                                                     \
  X(T, name, TEXT)                                                                                                     \
  X(T, type, TYPE, .types = &link_types)                                                                               \
  X(T, body_a, BODY)                                                                                                   \
  X(T, body_b, BODY)                                                                                                   \
  X(T, point_a, REALS, DOUBLES(SporeVec3))                                                                             \
  X(T, point_b, REALS, DOUBLES(SporeVec3))                                                                             \
  X(T, direction, REALS, DOUBLES(SporeVec3))                                                                           \
  X(T, radius, REAL)                                                                                                   \
  X(T, length, REAL)                                                                                                   \
  X(T, stiffness, REAL)                                                                                                \
  X(T, damping, REAL)                                                                                                  \
  X(T, rest_length, REAL)                                                                                              \
  X(T, strength, REAL)                                                                                                 \
  X(T, friction, REAL)                                                                                                 \
  X(T, ends, CHOICE, .least = SPORE_ENDS_STOP, .most = SPORE_ENDS_SLIP_OFF)                                            \
  X(T, reach_angle, REAL)                                                                                              \
  X(T, reach_least, REAL)                                                                                              \
  X(T, reach_most, REAL)                                                                                               \
  X(T, body_a_name, TEXT)                                                                                              \
  X(T, body_b_name, TEXT)
TABLE(static, link, SporeLinkDescription, LINK)

#define TOOL(X, T)                                                                                                     \
  X(T, type, TYPE, .types = &tool_types)                                                                               \
  X(T, bodies, BODIES, .repeat = SPORE_TOOL_BODIES)                                                                    \
  X(T, fields, TYPE_FIELDS, .types = &tool_types)                                                                      \
  X(T, effect, FLAG)
TABLE(static, tool, SporeToolDescription, TOOL)

#define EMITTER(X, T)                                                                                                  \
  X(T, name, TEXT)                                                                                                     \
  X(T, body, BODY)                                                                                                     \
  X(T, source, BODY)                                                                                                   \
  X(T, point, REALS, DOUBLES(SporeVec3))                                                                               \
  X(T, direction, REALS, DOUBLES(SporeVec3))                                                                           \
  X(T, fields, FIELDS, .parameters = &spore_emitter_parameters)                                                        \
  X(T, effect, FLAG)
TABLE(static, emitter, SporeEmitterDescription, EMITTER)

#define EYE(X, T)                                                                                                      \
  X(T, body, BODY)                                                                                                     \
  X(T, point, REALS, DOUBLES(SporeVec3))                                                                               \
  X(T, sight, REALS, DOUBLES(SporeVec3))                                                                               \
  X(T, lens, REAL)                                                                                                     \
  X(T, haze_s, REAL)
TABLE(static, eye, SporeEyeDescription, EYE)

#define WORLD(X, T)                                                                                                    \
  X(T, body_count, SIZE)                                                                                               \
  X(T, link_count, SIZE)                                                                                               \
  X(T, tool_count, SIZE)                                                                                               \
  X(T, emitter_count, SIZE)                                                                                            \
  X(T, eye_count, SIZE)                                                                                                \
  X(T, tools, POINTER, RECORDS(T, tool_count, 1, tool))                                                                \
  X(T, emitters, POINTER, RECORDS(T, emitter_count, 1, emitter))                                                       \
  X(T, eyes, POINTER, RECORDS(T, eye_count, 1, eye))                                                                   \
  X(T, bodies, POINTER, RECORDS(T, body_count, 1, body))                                                               \
  X(T, links, POINTER, RECORDS(T, link_count, 1, link))                                                                \
  X(T, gravity, REALS, DOUBLES(SporeVec3))                                                                             \
  X(T, solver, FIELDS, .parameters = &spore_solver_parameters)                                                         \
  X(T, cancel, SKIPPED)                                                                                                \
  X(T, unpruned, OPTION)
TABLE(static, world, SporeWorldDescription, WORLD)

/* Recorded input. */

#define SAMPLE(X, T)                                                                                                   \
  X(T, t_ns, WIDE)                                                                                                     \
  X(T, position, REALS, .repeat = 3)                                                                                   \
  X(T, orientation, REALS, .repeat = 4)                                                                                \
  X(T, velocity, REALS, .repeat = 3)                                                                                   \
  X(T, spin, REALS, .repeat = 3)                                                                                       \
  X(T, grip_rad, REAL)                                                                                                 \
  X(T, buttons, WORD)                                                                                                  \
  X(T, flags, WORD)
TABLE(static, sample, SporeDeviceState, SAMPLE)

#define CHANNEL(X, T)                                                                                                  \
  X(T, name, TEXT)                                                                                                     \
  X(T, count, SIZE)                                                                                                    \
  X(T, capacity, SKIPPED)                                                                                              \
  X(T, time_s, POINTER, MANY(T, count, 1, REAL))                                                                       \
  X(T, states, POINTER, RECORDS(T, count, 1, sample))
TABLE(static, channel, SporeTrackChannel, CHANNEL)

#define TRACK(X, T) X(T, channel_count, SIZE) X(T, channels, POINTER, RECORDS(T, channel_count, 1, channel))
TABLE(static, track, SporeTrack, TRACK)

#define VISUAL(X, T) X(T, body, BODY) X(T, mesh, POINTER, ONE(triangles))
TABLE(static, visual, SporeRuntimeVisual, VISUAL)

/* The exercise. */

#define INSTRUMENT(X, T)                                                                                               \
  X(T, name, TEXT)                                                                                                     \
  X(T, bodies, BODIES, .repeat = SPORE_TOOL_BODIES)                                                                    \
  X(T, tool, WORD)
TABLE(static, instrument, SporeInstrument, INSTRUMENT)

#define VIEW(X, T)                                                                                                     \
  X(T, position, REALS, DOUBLES(SporeVec3))                                                                            \
  X(T, target, REALS, DOUBLES(SporeVec3))                                                                              \
  X(T, field_of_view, REAL)                                                                                            \
  X(T, body, BODY)
TABLE(static, view, SporeView, VIEW)

#define EVENT(X, T)                                                                                                    \
  X(T, kind, TYPE, .types = &event_types)                                                                              \
  X(T, fields, TYPE_VALUES, .types = &event_types)                                                                     \
  X(T, instrument, WORD)                                                                                               \
  X(T, body, BODY)                                                                                                     \
  X(T, container, BODY)                                                                                                \
  X(T, after, WORD)
TABLE(static, event, SporeExerciseStep, EVENT)

#define METRIC(X, T)                                                                                                   \
  X(T, kind, TYPE, .types = &metric_types)                                                                             \
  X(T, fields, TYPE_VALUES, .types = &metric_types)                                                                    \
  X(T, instrument, WORD)                                                                                               \
  X(T, body, BODY)                                                                                                     \
  X(T, view, WORD)
TABLE(static, metric, SporeExerciseMetric, METRIC)

#define EXERCISE(X, T)                                                                                                 \
  X(T, fields, FIELDS, .parameters = &spore_exercise_parameters)                                                       \
  X(T, up, REALS, DOUBLES(SporeVec3))                                                                                  \
  X(T, instrument_count, SIZE)                                                                                         \
  X(T, view_count, SIZE)                                                                                               \
  X(T, step_count, SIZE)                                                                                               \
  X(T, metric_count, SIZE)                                                                                             \
  X(T, instruments, POINTER, RECORDS(T, instrument_count, 1, instrument))                                              \
  X(T, views, POINTER, RECORDS(T, view_count, 1, view))                                                                \
  X(T, steps, POINTER, RECORDS(T, step_count, 1, event))                                                               \
  X(T, metrics, POINTER, RECORDS(T, metric_count, 1, metric))
TABLE(static, exercise, SporeExerciseDescription, EXERCISE)

#define SCENE(X, T)                                                                                                    \
  X(T, world, RECORD, .table = &world)                                                                                 \
  X(T, recipes, POINTER, RECORDS(T, world.body_count, SPORE_LOD_COUNT, recipe))                                        \
  X(T, visual_count, SIZE)                                                                                             \
  X(T, visuals, POINTER, RECORDS(T, visual_count, 1, visual))                                                          \
  X(T, track, RECORD, .table = &track)                                                                                 \
  X(T, exercise, RECORD, .table = &exercise)
TABLE(, spore_rows_scene, SporeRuntimeScene, SCENE)

/* Signatures. */

static uint64_t hash_word(uint64_t hash, uint64_t word) { return spore_hash(hash, &word, sizeof word); }

static uint64_t hash_table(uint64_t hash, const SporeRowTable *table) {
  hash = spore_hash(hash, table->name, strlen(table->name));
  for (size_t i = 0; i < table->count; i++) {
    const SporeRow *row = &table->rows[i];
    hash = spore_hash(hash, row->name, strlen(row->name));
    hash = hash_word(hash_word(hash_word(hash, row->kind), row->repeat), row->element);
    if (row->table) hash = hash_table(hash, row->table);
  }
  return hash;
}

uint64_t spore_rows_signature(void) { return hash_table(SPORE_HASH_INIT, &spore_rows_scene); }

uint64_t spore_parameters_signature(const SporeParameterTable *table) {
  uint64_t hash = SPORE_HASH_INIT;
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    hash = hash_word(spore_hash(hash, parameter->name, strlen(parameter->name)), parameter->type);
    for (const char *const *choice = parameter->choices; choice && *choice; choice++)
      hash = spore_hash(hash, *choice, strlen(*choice));
  }
  return hash;
}
