/* Worlds for the stability suite: bodies and links added one by one, then built. */
#ifndef SPORE_TESTS_RIG_H
#define SPORE_TESTS_RIG_H

#include "core/sim/world.h"
#include "models/registry.h"
#include "tests/conformance/shapes.h"
#include "tests/sanitized.h"

typedef struct Rig {
  GArray *bodies, *links; /* SporeBodyDescription, SporeLinkDescription: may be changed until rig_build */
  GArray *tools;          /* SporeToolDescription, likewise */
  GPtrArray *sets;        /* SporeSphereSet *, kept until rig_free */
  GPtrArray *fields;      /* of tools, likewise */
  SporeWorldDescription description;
  SporeWorld *world;
} Rig;

/* Steps of a long run: the part under sanitizers, said. */
unsigned rig_steps(unsigned whole, unsigned part);

/* Default solver, no gravity. */
Rig *rig_new(void);
void rig_free(Rig *rig);

/* A model from default parameters and pairs of name and value (double), ended by NULL. A surface, tetrahedral mesh or
 * curve is cleared. The model that may be refused gives NULL with *error; the others never NULL. */
SporeModel *rig_surface_model(const SporeModelType *type, SporeTriangleMesh *mesh, ...) G_GNUC_NULL_TERMINATED;
SporeModel *rig_solid_model(const SporeModelType *type, SporeTetrahedralMesh *mesh, ...) G_GNUC_NULL_TERMINATED;
SporeModel *rig_curve_model(const SporeModelType *type, SporeCurve *curve, ...) G_GNUC_NULL_TERMINATED;
/* Corotational. */
SporeModel *rig_tetrahedra_model(SporeTetrahedralMesh *mesh, ...) G_GNUC_NULL_TERMINATED;
SporeModel *rig_try_tetrahedra(SporeTetrahedralMesh *mesh, SporeError *error, ...) G_GNUC_NULL_TERMINATED;
SporeModel *rig_fluid_model(SporeTriangleMesh *mesh, int particles, ...) G_GNUC_NULL_TERMINATED;
/* Fields of a type with changes, for a retune command: spore_free. */
void *rig_fields(const SporeModelType *type, ...) G_GNUC_NULL_TERMINATED;

/* Add a body; the description returned is valid until the next is added. Contact law and pose are the defaults. */
SporeBodyDescription *rig_passive(Rig *rig, const char *name, SporeModel *model, const SporeSphereSet *spheres);
SporeBodyDescription *rig_unmovable(Rig *rig, const char *name, const SporeSphereSet *spheres);
SporeBodyDescription *rig_active(Rig *rig, const char *name, const SporeSphereSet *spheres);
void rig_pin(Rig *rig, guint body, SporeVec3 point, double radius);

/* Sphere sets owned by the rig. */
const SporeSphereSet *rig_spheres(Rig *rig, const double *points, size_t count, double radius);
const SporeSphereSet *rig_sphere(Rig *rig, double radius);
/* columns x rows spheres in the plane y = 0 about the origin, tops at y = 0. */
const SporeSphereSet *rig_floor(Rig *rig, unsigned columns, unsigned rows, double spacing, double radius);

SporeWorld *rig_build(Rig *rig);                     /* never NULL */
SporeWorld *rig_build_on(Rig *rig, SporePool *pool); /* likewise, on the pool's threads */
/* At one point of the world, 1e5 N/m, along y where the kind has a direction; the caller may change it. */
SporeLinkDescription *rig_link(Rig *rig, const char *name, const SporeLinkType *kind, uint32_t a, uint32_t b,
                               SporeVec3 at);
/* A tool of default parameters; the first of its bodies is `body`, it has no others. Description and fields may be
 * changed until the world is built. */
SporeToolDescription *rig_tool(Rig *rig, const SporeToolType *type, const char *name, uint32_t body);
void *rig_tool_fields(const SporeToolDescription *tool);
SporeWorld *rig_try_build(Rig *rig, SporeError *error);

/* Sum of all but gravity's reference; NAN where a state is not finite. */
double rig_energy(const SporeWorld *world);
gboolean rig_finite(const SporeWorld *world);
gboolean rig_any_frozen(const SporeWorld *world);
void rig_run(SporeWorld *world, unsigned steps);
/* Last message of the monitor, or "". */
const char *rig_last_message(const SporeWorld *world);

/* True when a message that is still kept begins with `start`. */
gboolean rig_said(const SporeWorld *world, const char *start);

/* A device that moves from `from` at a steady velocity. */
typedef struct RigMover {
  SporeDevice base; /* of rig_mover_type */
  SporeVec3 from, velocity;
} RigMover;
extern const SporeDeviceType rig_mover_type;

#endif
