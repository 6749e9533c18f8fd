/* The structures that the scene's own tables describe, and those tables. */
#ifndef SPORE_SCENE_SCHEMA_FIELDS_H
#define SPORE_SCENE_SCHEMA_FIELDS_H

#include "core/exercise/exercise.h"
#include "core/scene/schema.h"
#include "core/sim/world.h"

/* How a body is moved: by physics, by an effect in its place, or as it was advised to be. */
typedef enum SporeFidelity { SPORE_FIDELITY_PHYSICAL, SPORE_FIDELITY_EFFECT, SPORE_FIDELITY_AUTO } SporeFidelity;

typedef struct SporeRootFields {
  const char *version;
} SporeRootFields;

typedef struct SporeMetaFields {
  const char *title, *author, *description, *licence;
} SporeMetaFields;

typedef struct SporeMeasuredFields {
  const char *method, *level, *body, *reference, *date, *scene_hash;
  double time_step, step_cost, reference_step, start, duration; /* s */
  double error, floor, reference_error;                         /* parts of a body's length */
  bool statistics;
} SporeMeasuredFields;

typedef struct SporeUnitsFields {
  int length; /* index into m cm mm um in */
} SporeUnitsFields;

typedef struct SporeEnvironmentFields {
  double gravity[3]; /* m/s^2 */
} SporeEnvironmentFields;

typedef struct SporeBodyFields {
  const char *name;
  int role; /* SporeRole */
  double position[3], rotation[3], velocity[3], spin[3];
  const char *kept_pose; /* NULL: none */
  bool name_guessed;
  const char *folder; /* NULL: none */
} SporeBodyFields;

typedef struct SporeMechanicalFields {
  const char *geometry, *root;
  int integrator;   /* 0: the scene's; else SporeIntegratorKind + 1 */
  int64_t substeps; /* 0: the scene's */
  int material;     /* of spore_material_names */
} SporeMechanicalFields;

typedef struct SporeRegionFields {
  const char *name;
  double centre[3], radius, stiffness_scale, density_scale;
  int material; /* of spore_material_names */
} SporeRegionFields;

typedef struct SporeDabFields {
  double centre[3], radius;
} SporeDabFields;

typedef struct SporeCollisionFields {
  const char *spheres;
  SporeContactFields contact;
} SporeCollisionFields;

typedef struct SporeVisualFields {
  const char *mesh, *texture, *places; /* NULL: none */
  double colour[3], wetness, opacity;
} SporeVisualFields;

extern const char *const spore_fidelities[]; /* in the order of SporeFidelity; NULL at the end */
typedef struct SporeFidelityFields {         /* of a tool or an effect: the mode and the advice alone */
  int mode, advice;                          /* SporeFidelity; the advice is physical or effect */
  const char *advice_hash;                   /* of what was advised on; NULL: there is no advice */
  int level;                                 /* SporeLodGrade */
  double level_tolerance;                    /* m */
  int automatic;                             /* SporeLodCause */
  double tool_distance, view_distance;       /* m */
  double level_wait;                         /* s */
} SporeFidelityFields;

typedef struct SporeLodFields {
  const char *geometry; /* NULL: the body's */
  const char *settings; /* NULL: none */
} SporeLodFields;

typedef struct SporeSeamFields {
  const char *name, *body_a, *body_b;
  double distance, stiffness, damping, strength;
} SporeSeamFields;

typedef struct SporeCameraFields {
  const char *name, *body;
  double position[3], target[3], angle, turn, field_of_view, distortion, lens, haze;
} SporeCameraFields;

typedef struct SporeProbeFields {
  const char *name, *body, *device;
} SporeProbeFields;

typedef struct SporeWoundFields {
  const char *name, *body, *source;
  double point[3], direction[3];
  SporeEmitterFields emitter;
} SporeWoundFields;

typedef struct SporeMouseFields {
  const char *name;
} SporeMouseFields;

typedef struct SporeTrackFields {
  const char *name, *file;
} SporeTrackFields;

/* One element of the scene's own, as the tables declare it. */
struct SporeElement {
  const char *element, *label, *doc;
  const SporeParameter *parameters;
  size_t count, size;
  const char *const *children; /* NULL-terminated element names; NULL: none */
  gboolean ordered, single_child;
  const SporeParameterTable *extra; /* a kernel table appended to the parameters, or NULL */
  size_t extra_offset;              /* of its structure in this one */
  const char *key; /* by which `children` name it, where another element has its name; NULL: its name */
};

#endif
