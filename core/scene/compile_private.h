/* Document to world, between its files. */
#ifndef SPORE_SCENE_COMPILE_PRIVATE_H
#define SPORE_SCENE_COMPILE_PRIVATE_H

#include "core/scene/compile.h"
#include "core/scene/schema_fields.h"

/* What is being put together. Functions below that return FALSE have set *error. */
typedef struct SporeCompiler {
  SporeDocument *document;
  GPtrArray *objects; /* body objects, by index in the world */
  GArray *bodies;     /* of SporeBodyDescription */
  GArray *links;      /* of SporeLinkDescription */
  GArray *tools;      /* of SporeToolDescription */
  GArray *emitters;   /* of SporeEmitterDescription */
  GPtrArray *spheres; /* of SporeSphereSet: models' own */
  GPtrArray *fields;  /* of tools, whose descriptions borrow them */
  GError **error;
} SporeCompiler;

/* Says what is wrong with the object, with its place in the file. FALSE. */
gboolean spore_compiler_refuse(SporeCompiler *compiler, const SporeObject *object, const char *format, ...)
    G_GNUC_PRINTF(3, 4);
/* The object that a reference names. FALSE: it names nothing that is there; *target NULL: it is not set. */
gboolean spore_compiler_resolve(SporeCompiler *compiler, const SporeObject *object, const char *property,
                                SporeObject **target);
/* Index of the body that a reference names, or SPORE_NO_BODY where it is not set. */
gboolean spore_compiler_body_index(SporeCompiler *compiler, const SporeObject *object, const char *property,
                                   guint32 *index);

/* Each describes one object of the scene to the world that is to be made; bodies first. */
gboolean spore_compiler_add_body(SporeCompiler *compiler, SporeObject *body);
gboolean spore_compiler_add_link(SporeCompiler *compiler, const SporeObject *object);
gboolean spore_compiler_add_tool(SporeCompiler *compiler, const SporeObject *object);
gboolean spore_compiler_add_emitter(SporeCompiler *compiler, const SporeObject *object);

/* What moves the active bodies: `input` (NULL: none), and the scene's own tracks for those that it leaves. */
gboolean spore_compiler_merge_input(SporeCompiler *compiler, SporeTrack *merged, const SporeTrack *input);
/* Devices that play the merged track, simulation->track, to the bodies of its world. */
gboolean spore_compiler_open_devices(SporeCompiler *compiler, SporeSimulation *simulation);

#endif
