/* What the files that compile a document share. */
#ifndef SPORE_SCENE_COMPILE_PRIVATE_H
#define SPORE_SCENE_COMPILE_PRIVATE_H

#include "core/runtime/runtime.h"
#include "core/scene/compile.h"
#include "core/scene/schema_fields.h"

/* A compilation under way. Functions below that return FALSE have set *error. */
typedef struct SporeCompiler {
  SporeDocument *document;
  GPtrArray *objects; /* body objects, by index in the world */
  GArray *bodies;     /* of SporeBodyDescription */
  GArray *links;      /* of SporeLinkDescription */
  GArray *tools;      /* of SporeToolDescription */
  GArray *emitters;   /* of SporeEmitterDescription */
  GArray *eyes;       /* of SporeEyeDescription */
  GPtrArray *spheres; /* of SporeSphereSet: models' own */
  GArray *recipes;    /* of SporeModelRecipe, SPORE_LOD_COUNT a body */
  GPtrArray *kept;    /* what descriptions and recipes borrow */
  const SporeCancel *cancel;
  gboolean unpruned; /* see SporeWorldDescription */
  GError **error;
} SporeCompiler;

/* Empties a compilation whose document, input of users and error are set. */
void spore_compiler_init(SporeCompiler *compiler);
void spore_compiler_clear(SporeCompiler *compiler);
/* Zeroed memory that lives as long as the compilation. */
gpointer spore_compiler_keep(SporeCompiler *compiler, gsize size);
/* Describes all of the document. FALSE with the error. */
gboolean spore_compiler_describe(SporeCompiler *compiler);
/* The world of what was described; borrows it. */
SporeWorldDescription spore_compiler_world(const SporeCompiler *compiler);
/* Makes that world, which owns the models then. Without it they are to be destroyed. NULL with the error. */
SporeWorld *spore_compiler_create(SporeCompiler *compiler, SporePool *pool);
void spore_compiler_destroy_models(const SporeCompiler *compiler);
/* The mesh that shows the body; *mesh is NULL where none does. */
gboolean spore_compiler_visual(SporeCompiler *compiler, const SporeObject *body, const SporeTriangleMesh **mesh);

/* Sets the error to a message about the object, with its place in the file. Returns FALSE. */
gboolean spore_compiler_refuse(SporeCompiler *compiler, const SporeObject *object, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/* The same with a fault of the kernel, whose code stays: want of memory is not bad input. */
gboolean spore_compiler_pass_on(SporeCompiler *compiler, const SporeObject *object, const SporeError *fault);
/* The object that a reference names; *target is NULL where the reference is not set. FALSE with an error: no object has
 * that name. */
gboolean spore_compiler_resolve(SporeCompiler *compiler, const SporeObject *object, const char *property,
                                SporeObject **target);
/* Index of the body that a reference names, or SPORE_NO_BODY where the reference is not set. */
gboolean spore_compiler_body_index(SporeCompiler *compiler, const SporeObject *object, const char *property,
                                   guint32 *index);

/* Sets the error to a fault of the kernel whose place is the path of an object; the line of the file takes its place.
 */
gboolean spore_compiler_say_in_scene(SporeCompiler *compiler, const SporeError *fault);
/* Each function adds the description of one object of the scene. Bodies must be added first. */
gboolean spore_compiler_add_body(SporeCompiler *compiler, SporeObject *body);
gboolean spore_compiler_add_link(SporeCompiler *compiler, const SporeObject *object);
gboolean spore_compiler_add_tool(SporeCompiler *compiler, const SporeObject *object);
gboolean spore_compiler_add_emitter(SporeCompiler *compiler, const SporeObject *object);

/* Describes the exercise of the scene; bodies must be described before. Without steps and metrics there is none. What
 * it borrows lives as long as the compilation and the document. */
gboolean spore_compiler_describe_exercise(SporeCompiler *compiler, SporeExerciseDescription *description);
/* Makes that exercise for the world. *exercise: NULL: there is none. */
gboolean spore_compiler_create_exercise(SporeCompiler *compiler, const SporeExerciseDescription *description,
                                        const SporeWorld *world, SporeExercise **exercise);
/* Merges the recorded input of all active bodies: `input` (NULL: none) first, the scene's own tracks for the other
 * bodies. */
gboolean spore_compiler_merge_input(SporeCompiler *compiler, SporeTrack *merged, const SporeTrack *input);
/* Opens a device for each channel of the merged track, simulation->track, and attaches it to its body. */
gboolean spore_compiler_open_devices(SporeCompiler *compiler, SporeSimulation *simulation);

#endif
