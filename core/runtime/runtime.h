/* A compiled scene as one file, for programs that embed the kernel: what `spore export --format runtime` writes. The
 * file holds what the world, its models and its recorded input are made from. Loading it needs libc and libm alone, and
 * the world that comes of it runs to the same bits as the scene.
 *
 * Layout: a head of magic bytes, byte order, version, signature of the tables of rows, size and checksum (40 bytes),
 * then all members in the order of these tables (rows.c). Numbers are as the machine holds them. */
#ifndef SPORE_RUNTIME_RUNTIME_H
#define SPORE_RUNTIME_RUNTIME_H

#include "core/exercise/exercise.h"
#include "core/haptic/track.h"
#include "core/sim/world.h"

/* What a model is made from: the arguments of spore_model_create. */
typedef struct SporeModelRecipe {
  const SporeModelType *type; /* NULL: there is no model */
  SporeGeometry geometry;
  const void *fields; /* type->parameters.size bytes */
} SporeModelRecipe;

/* The mesh that shows a body, in the body's frame at rest, m. */
typedef struct SporeRuntimeVisual {
  uint32_t body;
  const SporeTriangleMesh *mesh;
} SporeRuntimeVisual;

/* What a runtime file holds. */
typedef struct SporeRuntimeScene {
  SporeWorldDescription world;     /* the models in it are not kept: the recipes make them anew */
  const SporeModelRecipe *recipes; /* three a body, by SporeLodGrade */
  size_t visual_count;
  const SporeRuntimeVisual *visuals;
  SporeTrack track;                  /* recorded input of active bodies, by their names */
  SporeExerciseDescription exercise; /* without steps and metrics: there is none */
} SporeRuntimeScene;

/* The content of a runtime file, from spore_allocate; *size: its bytes. NULL: no memory. */
void *spore_runtime_format(const SporeRuntimeScene *scene, size_t *size);

/* A scene that was loaded: its world, its recorded devices, its exercise and its visual meshes. */
typedef struct SporeRuntime SporeRuntime;

/* Loads a file. registry: the models that it may name (spore_model_registry). The pool and cancel are borrowed, as by
 * spore_world_create; each may be NULL. Recorded input is attached to its bodies. NULL with the error, whose place is
 * the file: it cannot be read, is damaged or hostile, or is of another version or byte order; or the world cannot be
 * made. The memory that a file can make this function ask for is bounded by a multiple of the file's size, but for what
 * models take by their parameters. */
SporeRuntime *spore_runtime_load(const char *file, SporeModelRegistry registry, SporePool *pool,
                                 const SporeCancel *cancel, SporeError *error);
/* The same from memory; `place` names the content in messages. The content is not needed afterwards. */
SporeRuntime *spore_runtime_parse(const char *place, const void *content, size_t size, SporeModelRegistry registry,
                                  SporePool *pool, const SporeCancel *cancel, SporeError *error);
/* Frees all of it, the world too. Devices that the caller set stay the caller's. NULL is allowed. */
void spore_runtime_free(SporeRuntime *runtime);

/* The world, owned by the runtime. It names bodies (spore_world_body_name) and tools (spore_world_tool_state). */
SporeWorld *spore_runtime_world(SporeRuntime *runtime);
/* The exercise, owned by the runtime; NULL: the scene has none. spore_exercise_watch is to be called after each step of
 * the world, and spore_world_tidy before it, as `spore run` does: then events, metrics and score are the same. */
SporeExercise *spore_runtime_exercise(SporeRuntime *runtime);
/* Number of visual meshes. */
size_t spore_runtime_visual_count(const SporeRuntime *runtime);
/* Visual mesh i: its body, whose name it bears, and its triangles. */
const SporeRuntimeVisual *spore_runtime_visual(const SporeRuntime *runtime, size_t i);
/* Where a snapshot has the vertices of visual mesh i: mesh->vertex_count x 3, world, m. For the thread that acquired
 * the snapshot. The first call for a mesh makes its mapping, which allocates; so does a line whose knots changed.
 * Vertices follow the nodes of tetrahedra at time 0: where a cut splits nodes, triangles across the cut are stretched.
 * False with the error: no memory, or the body cannot carry the mesh. */
bool spore_runtime_vertices(SporeRuntime *runtime, size_t i, const SporeSnapshot *snapshot, double *vertices,
                            SporeError *error);

#endif
