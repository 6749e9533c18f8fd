/* The interface of a mechanical model: how a body moves.
 *
 * A model is immutable while it runs (retune apart); its state lies in the world's flat arrays:
 *   q  configuration, q_count doubles
 *   v  generalised velocity, block_count x 3 doubles
 * The first node_count blocks are material points: node i is at q[3i], and q' = v for it. A body that turns as a whole
 * has one block more, the angular velocity (world axes) of a frame whose origin is the last node, and behind the nodes
 * the frame's orientation (quaternion wxyz). A rigid body is one node with such a frame.
 *
 * The world solves M v' = f(q, v) + gravity + contacts + links. Models add their own internal force and, if they
 * can, its Jacobian in 3x3 blocks. Gravity is the world's: it pulls block i with (1 - buoyancy) block_mass[i] g. */
#ifndef SPORE_SIM_MODEL_H
#define SPORE_SIM_MODEL_H

#include "core/base/parameter.h"
#include "core/base/threads.h"
#include "core/linalg/block_matrix.h"
#include "core/math/spline.h"
#include "core/mesh/mesh.h"
#include "core/body/mapping.h"
#include "core/body/region.h"

typedef enum SporeGeometryKind {
  SPORE_GEOMETRY_NONE,       /* parameters alone */
  SPORE_GEOMETRY_SURFACE,    /* a triangle mesh, open or closed */
  SPORE_GEOMETRY_SOLID,      /* a closed triangle mesh */
  SPORE_GEOMETRY_TETRAHEDRA, /* a tetrahedral mesh */
  SPORE_GEOMETRY_CURVE       /* a line with radii */
} SporeGeometryKind;

/* What a model is built from, in the body's frame, m. Borrowed during create; what the model does not need is NULL. */
typedef struct SporeGeometry {
  const SporeTriangleMesh *surface;
  const SporeTetrahedralMesh *tetrahedra;
  const SporeCurve *curve;
  const SporeRegions *regions; /* NULL: none; for types that take them. Their elements are counted */
} SporeGeometry;

#define SPORE_NO_BODY UINT32_MAX /* in place of the index of a body: the world itself */

typedef struct SporeModelType SporeModelType;

/* Values of parameters that go together, from measurements. */
typedef struct SporePreset {
  const char *name, *label; /* label: for people, translatable (N_) */
  const char *source;       /* where they were published */
  const char *settings[9];  /* a parameter, its value as in the file, the next parameter, ... NULL */
} SporePreset;

/* Edges of a body's surface that were cut, between nodes a < b, and on which nodes tetrahedra hang that can be parted,
 * so that what is drawn can follow. */
typedef struct SporeCutEdge {
  uint32_t body, a, b;
} SporeCutEdge;
typedef struct SporeCuts {
  size_t count, capacity;
  SporeCutEdge *edges;
  uint64_t parted;     /* another number: corners differ */
  size_t corner_count; /* of all such bodies, see spore_world_corner_start */
  uint32_t *corners;   /* their nodes now, four a tetrahedron, in the order of the mesh */
} SporeCuts;

/* What a step's heat does to tissue nearer than radius to the point: it coagulates by `dose` more, of the 1 that is all
 * of it. With the dose its lengths at rest lose `shrinkage`, and its stiffness gains `stiffening` - 1, of what they
 * were when the model was created. */
typedef struct SporeHeat {
  SporeVec3 point;
  double radius; /* m */
  double dose, shrinkage, stiffening;
} SporeHeat;
/* What of the dose tissue still takes that got so much before. */
static inline double spore_heat_dose(const SporeHeat *heat, double before) {
  return heat->dose < 1 - before ? heat->dose : 1 - before;
}

/* Whether an edge of a body's surface ties two of its nodes. */
typedef enum SporeTie {
  SPORE_TIE_NONE, /* and never did */
  SPORE_TIE_GONE, /* it was cut, or tore */
  SPORE_TIE_HOLDS
} SporeTie;

/* Where and how a model's force is linearised for Newton's method. */
typedef struct SporeTangent {
  const double *q, *shape, *v; /* as for force */
  const double *from;          /* the configuration from which Newton's last step led to q; NULL: none did */
  double stiffness_scale, damping_scale;
  bool whole; /* the exact matrix, even where it is indefinite */
} SporeTangent;

/* Base of every model: the first member of the model's own structure. Filled by create. */
typedef struct SporeModel {
  const SporeModelType *type;
  size_t q_count, block_count, node_count;
  size_t spare_count; /* of the nodes, the last: of next to no mass and still, until a cut makes them one after the
                         other */
  size_t q_room, block_room; /* what q_count and block_count may become: more where nodes come and go */
  size_t line_room;          /* points that may lead its line then */
  size_t pair_room;          /* pairs of blocks that its pattern may then have, repeats and all */
  double *block_mass;        /* kg, block_room; above 0 for nodes, 0 for the turning of a frame */
  double buoyancy;           /* share of its weight that the air around bears: above 1 it rises */
  double life_s;    /* of particles, after which they are taken out of the world, with the age of each, s, behind the
                       nodes in q; 0: they last */
  bool tears;       /* tear has to be called at each step */
  double map_slack; /* m: how far off the body a point may lie that map cannot carry, and be put onto it */
  SporePool *pool;  /* for long loops of force and jacobian, given by the world; whatever it is, the same bits */
} SporeModel;

/* What a model whose ties or nodes scissors take apart can do, or one that tears. */
typedef struct SporeModelCut {
  /* Makes spare nodes, when the world has scissors, before anything else is made of the model. Refuses what it cannot
   * split, with the remedy. NULL: no spare nodes are needed. */
  bool (*reserve)(SporeModel *model, SporeError *error);
  /* Room for what mend needs, when the world has scissors, or the model tears; *edges += how many can be cut. NULL: no
   * edges. False: no memory. */
  bool (*prepare)(SporeModel *model, size_t *edges);
  /* Required. Takes away, at q, what ties nodes on both sides of a triangle (9 doubles, m), until mend, and adds the
   * edges among these ties to `cuts`, as edges of `body`. Returns the number of ties. Allocates nothing, and the
   * pattern stays. */
  size_t (*cut)(SporeModel *model, const double *q, const double *triangle, uint32_t body, SporeCuts *cuts);
  /* The same for what is strained, at q, more than it bears. Required where model->tears. */
  size_t (*tear)(SporeModel *model, const double *q, uint32_t body, SporeCuts *cuts);
  /* Whether nodes a and b are tied, after prepare. Required where there is no split. */
  SporeTie (*tie)(const SporeModel *model, uint32_t a, uint32_t b);
  /* Of a model whose nodes are split; `cut` only says where. Makes nodes, at this state, which it sets for them; new
   * nodes follow those made before. *from: the node that each of them was made from. Returns the number of new nodes.
   * Allocates nothing. The pattern is another one then: until settle nothing is asked of the model. */
  size_t (*split)(SporeModel *model, double *q, double *v, const uint32_t **from);
  /* The nodes of the model's tetrahedra now, 4 *count; NULL where it was made so that it cannot be split. Required
   * where there is a split. */
  const uint32_t *(*corners)(const SporeModel *model, size_t *count);
} SporeModelCut;

/* What a model that heat coagulates can do. Both slots are required. */
typedef struct SporeModelHeat {
  /* Room for coagulate, and what mend needs after it, when the world has something that heats. False: no memory. */
  bool (*prepare)(SporeModel *model);
  /* Coagulates, at q, until mend. Returns how many ties or elements took some of the dose. Allocates nothing, and the
   * pattern stays. */
  size_t (*coagulate)(SporeModel *model, const double *q, const SporeHeat *heat);
} SporeModelHeat;

/* What a model whose nodes come and go while it runs can do. Both slots are required, and settle. */
typedef struct SporeModelAdapt {
  /* Whether nodes are to come or go, at this state, after a step of h seconds. held: a flag a block, of what a pin
   * holds. The model keeps in mind what it would do, and sees to it that there is room. */
  bool (*weigh_nodes)(SporeModel *model, double h, const double *q, const uint8_t *held);
  /* Does what weigh_nodes found: the state and the flags become those of the nodes that there are then. Nodes that lead
   * a line stay one run of blocks. Allocates nothing. The pattern is another one then: until settle nothing is asked of
   * the model. */
  void (*change_nodes)(SporeModel *model, double *q, double *v, uint8_t *held);
} SporeModelAdapt;

/* A model of particles: its points keep no neighbours, and what is drawn is the skin around them, not a surface that
 * follows them. */
typedef struct SporeModelParticles {
  /* Of particles that are seen as puffs: radius, m, and opacity, 0..1, of one. NULL: they are not. */
  void (*puff)(const SporeModel *model, const double *q, size_t particle, double *radius, double *opacity);
} SporeModelParticles;

/* A model with a line that runs through the body, led by its first nodes (core/body/path.h). */
typedef struct SporeModelLine {
  /* Required. Knots of the line: what slides along the line may be linked to it. */
  SporeSplineKnots (*path)(const SporeModel *model);
  /* As map, for the vertices of a surface that is only drawn, where sections of the body turn as a whole. NULL: map
   * serves. */
  bool (*map_drawn)(const SporeModel *model, const SporeTriangleMesh *mesh, SporeMapping *mapping, SporeError *error);
  /* Makes the rows of a mapping that `map` made anew, for these knots of the line; place and map themselves speak of
   * the knots that the model was made with. Any thread may ask. It may allocate, but not for the knots that path says
   * now. Points that do not go with knots are left alone. False: no memory. Required where nodes come and go. */
  bool (*follow)(const SporeModel *model, SporeSplineKnots knots, SporeMapping *mapping);
} SporeModelLine;

struct SporeModelType {
  const char *name;  /* as in the file: "mass_spring_net" */
  const char *label; /* for people, translatable (N_) */
  const char *doc;   /* one paragraph, translatable (N_) */
  SporeParameterTable parameters;
  SporeGeometryKind geometry;
  const SporePreset *presets; /* ended by one without a name; NULL: none */
  bool regions;               /* takes regions of other stiffness and density */

  /* Required. */
  /* Builds from geometry and fields (a structure of parameters.size bytes, checked already). Refuses, with place
   * (element index) and remedy, what it could not simulate: zero mass, flat tetrahedra, a net without edges. */
  SporeModel *(*create)(const SporeGeometry *geometry, const void *fields, SporeError *error);
  void (*destroy)(SporeModel *model);
  /* State at rest when the body's frame stands at `pose`, moving with velocity (m/s) and spin (rad/s, world axes). */
  void (*place)(const SporeModel *model, SporePose pose, SporeVec3 velocity, SporeVec3 spin, double *q, double *v);
  /* f += internal force (N; N m for a rotation block): elastic at the configuration q, viscous at the configuration
   * `shape`, linear in v. Where shape is q the force is that of the state (q, v); an implicit step may instead take the
   * viscous one at the shape that it began from, so that its Jacobian is symmetric and whole. */
  void (*force)(const SporeModel *model, const double *q, const double *shape, const double *v, double *f);
  /* The same where the nodes of q are those of shape moved along v for h > 0 seconds, as in an implicit step: what is
   * linear in q is then that of the shape, which is asked for again and again, and of v. NULL: force serves. */
  void (*force_along)(const SporeModel *model, const double *q, const double *shape, const double *v, double h,
                      double *f);
  /* Internal potential energy, J: force(q, q, 0) = -dU/dq. */
  double (*potential)(const SporeModel *model, const double *q);
  /* Mapping of `count` points given in the body's frame at rest; reproduces them at rest to rounding. */
  bool (*map)(const SporeModel *model, const double *points, size_t count, SporeMapping *mapping, SporeError *error);

  /* Required of a model with a frame: its inertia at q, world axes, symmetric positive definite, kg m^2. */
  SporeMat3 (*inertia)(const SporeModel *model, const double *q);

  /* Optional. */
  /* Off-diagonal blocks that jacobian writes: calls spore_block_pattern_add(pattern, i, j) for i != j, either order. */
  bool (*pattern)(const SporeModel *model, SporeBlockPattern *pattern);
  /* matrix += stiffness_scale (-df/dq) + damping_scale (-df/dv) of that force, with shape held fast, symmetric; where
   * the exact matrix is indefinite, its positive semi-definite part. NULL: no internal stiffness (rigid). */
  void (*jacobian)(const SporeModel *model, const double *q, const double *shape, const double *v,
                   double stiffness_scale, double damping_scale, SporeBlockMatrix *matrix);
  /* The same for Newton's method. Stress is stiff across its line; where `from` is given, that stiffness is of the
   * stress that linearising there promised for q, and not of what q has. The two differ by how much the step bent what
   * is stiff, to second order; but times the stiffness, which hides all else (the stress is an unknown of its own, as
   * in mixed and primal-dual methods). NULL: jacobian serves. */
  void (*tangent)(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix);
  /* Moves q along v for h seconds, free of force: q1, v1 from q, v (may alias). NULL: q1 = q + h v, v1 = v.
   * A rigid body turns here and keeps its angular momentum. */
  void (*drift)(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1);
  /* Takes new parameter values while running; only ones marked SPORE_CHANGE_LIVE differ. */
  bool (*retune)(SporeModel *model, const void *fields, SporeError *error);
  /* Greatest angular frequency (rad/s) and damping rate (1/s) of the model's own forces. For models without a Jacobian
   * that are to be moved by explicit steps: where the scene leaves it open, a body takes Verlet and as many substeps as
   * these rates ask for. */
  void (*rates)(const SporeModel *model, double *frequency, double *damping);
  /* Drops what evaluations leave behind to make the next one quicker: the state was set from outside, and what follows
   * from it must not depend on what was before. */
  void (*forget)(SporeModel *model);
  /* The model's own collision spheres, in the body's frame at rest, for bodies whose scene gives them none, where map
   * takes them; of particles one at each node, in their order. *set: spore_sphere_set_clear. */
  bool (*spheres)(const SporeModel *model, SporeSphereSet *set, SporeError *error);
  /* Corners of the triangles of its surface, nodes, three each, from spore_allocate: what a needle pierces. False: no
   * memory. NULL: it cannot be pierced. */
  bool (*skin)(const SporeModel *model, uint32_t **triangles, size_t *count);
  /* Material points in the body's frame at rest that tell its configuration, 3 each, from spore_allocate; of a model
   * whose nodes are no material points. The first *seen of them lie in the body. NULL: the nodes do. */
  bool (*samples)(const SporeModel *model, double **points, size_t *count, size_t *seen);
  /* Looks up the model's blocks in a matrix of its pattern of now. Required where the pattern changes. */
  void (*settle)(SporeModel *model, const SporeBlockMatrix *matrix);
  /* As it was created: of a model that was prepared for either, or whose nodes come and go. */
  void (*mend)(SporeModel *model);
  /* What the last evaluation had to mend, or what the state after a step is not meant for (translated: cause and
   * remedy), or NULL. Told once a body. */
  const char *(*notice)(const SporeModel *model, const double *q);
  /* What the model as it was made computes badly (translated: "what; what to do"), or NULL. `spore check` tells it. */
  const char *(*doubt)(const SporeModel *model);

  /* What only some models can do; NULL: this one cannot. */
  const SporeModelCut *cut;
  const SporeModelHeat *heat;
  const SporeModelAdapt *adapt;
  const SporeModelParticles *particles;
  const SporeModelLine *line;
};

/* Helpers for models. */
bool spore_model_init(SporeModel *model, const SporeModelType *type, size_t node_count, bool framed, SporeError *error);
void spore_model_clear(SporeModel *model);
static inline bool spore_model_is_nodal(const SporeModel *model) { return model->node_count == model->block_count; }
/* One frame and no other node: points follow it rigidly. */
static inline bool spore_model_is_rigid(const SporeModel *model) {
  return model->node_count == 1 && model->block_count == 2;
}
/* Block-diagonal mass at q, block_count x 9. */
void spore_model_mass(const SporeModel *model, const double *q, double *blocks);
double spore_model_total_mass(const SporeModel *model);
/* A matrix of the model's own pattern, in which it looks up its blocks. False: no memory. */
bool spore_model_matrix_create(const SporeModel *model, SporeBlockMatrix *matrix);

/* A registry is an explicit NULL-terminated array; models/registry.c holds the one of this program. */
typedef const SporeModelType *const *SporeModelRegistry;
const SporeModelType *spore_model_type_find(SporeModelRegistry registry, const char *name);
/* Refuses a type that misses a required slot or whose table is inconsistent (duplicate names, default out of range,
 * presets of other parameters). */
bool spore_model_type_check(const SporeModelType *type, SporeError *error);

#endif
