/* The interface of a mechanical model: how a body moves.
 *
 * A model does not change while it runs, except by the slots that say so. Its state lies in the world's flat arrays:
 *   q  configuration, q_count doubles
 *   v  generalised velocity, block_count x 3 doubles; 3 components of v are a block
 * The first node_count blocks are material points: node i is at q[3i], and q' = v for it. A body that turns as a whole
 * has a frame: its origin is the last node. The frame has one block more, its angular velocity (world axes), and its
 * orientation (quaternion wxyz) lies in q behind the nodes. A rigid body is one node with such a frame.
 *
 * The world solves M v' = f(q, v) + gravity + contacts + links. A model adds its own internal force and, if it can, the
 * Jacobian of that force in 3x3 blocks. Gravity belongs to the world: it pulls block i by (1 - buoyancy) block_mass[i]
 * g.
 */
#ifndef SPORE_SIM_MODEL_H
#define SPORE_SIM_MODEL_H

#include "core/base/cancel.h"
#include "core/base/parameter.h"
#include "core/base/threads.h"
#include "core/linalg/block_matrix.h"
#include "core/math/spline.h"
#include "core/mesh/mesh.h"
#include "core/body/mapping.h"
#include "core/body/region.h"

/* The kind of geometry that a model is built from. */
typedef enum SporeGeometryKind {
  SPORE_GEOMETRY_NONE,       /* parameters alone */
  SPORE_GEOMETRY_SURFACE,    /* a triangle mesh, open or closed */
  SPORE_GEOMETRY_SOLID,      /* a closed triangle mesh */
  SPORE_GEOMETRY_TETRAHEDRA, /* a tetrahedral mesh */
  SPORE_GEOMETRY_CURVE       /* a line with radii */
} SporeGeometryKind;

/* The geometry that a model is built from, in the body's frame, m. It is borrowed during create. Geometry that the
 * model does not need is NULL. */
typedef struct SporeGeometry {
  const SporeTriangleMesh *surface;
  const SporeTetrahedralMesh *tetrahedra;
  const SporeCurve *curve;
  const SporeCurve *root;      /* for types that take a root; NULL: none */
  const SporeRegions *regions; /* for types that take regions; create counts their elements; NULL: none */
  const SporeCancel *cancel;   /* ends create; NULL: nothing does */
  const double *corners; /* 4 x 3, on the edge of an open surface and in turn around it, for a sheet; NULL: not given */
} SporeGeometry;

#define SPORE_NO_BODY UINT32_MAX /* in place of the index of a body: the world itself */

/* A kind of model: its name, its parameters, and the functions that its models have (slots). Defined below. */
typedef struct SporeModelType SporeModelType;

/* Measured values of parameters that go together: a tissue. */
typedef struct SporePreset {
  const char *name, *label; /* label: for people, translatable (N_) */
  const char *source;       /* where they were published */
  const char *settings[9];  /* a parameter, its value as in the file, the next parameter, ... NULL */
} SporePreset;

/* An edge of a body's surface that was cut: between the nodes a < b of the body. */
typedef struct SporeCutEdge {
  uint32_t body, a, b;
} SporeCutEdge;
/* What was cut since time 0, so that a drawn mesh can follow: edges, and the nodes of tetrahedra that cuts may split.
 */
typedef struct SporeCuts {
  size_t count, capacity; /* of edges */
  SporeCutEdge *edges;
  uint64_t parted;     /* changes whenever corners change */
  size_t corner_count; /* tetrahedra of all bodies whose nodes may be split; see spore_world_corner_start */
  uint32_t *corners;   /* corner_count x 4: the present nodes of each tetrahedron, in the order of its mesh */
} SporeCuts;

/* Heat that a step brings to tissue. It acts on what is nearer than `radius` to the point. Coagulation of an element
 * goes from 0 to 1. At coagulation c, lengths at rest are (1 - shrinkage c) times, and stiffness is (1 + (stiffening -
 * 1) c) times what they were when the model was created. */
typedef struct SporeHeat {
  SporeVec3 point;   /* m, world */
  double radius;     /* m */
  double dose;       /* coagulation that the step adds */
  double shrinkage;  /* part of the length */
  double stiffening; /* factor on the stiffness */
} SporeHeat;
/* The part of the dose that an element still takes whose coagulation is `before`: none above 1 in all. */
static inline double spore_heat_dose(const SporeHeat *heat, double before) {
  return heat->dose < 1 - before ? heat->dose : 1 - before;
}

/* Whether an edge of a body's surface ties two of the body's nodes. */
typedef enum SporeTie {
  SPORE_TIE_NONE, /* it never did */
  SPORE_TIE_GONE, /* it was cut, or tore */
  SPORE_TIE_HOLDS
} SporeTie;

/* Where and how a model's force is linearised for Newton's method. */
typedef struct SporeTangent {
  const double *q, *shape, *v; /* as for the slot force */
  const double *from; /* configuration from which the last iteration of Newton's method led to q; NULL: none did */
  double stiffness_scale, damping_scale; /* as for the slot jacobian */
  bool whole;                            /* the exact matrix, even where it is indefinite */
} SporeTangent;

/* Base of every model: the first member of the model's own structure. `create` fills it; spore_model_init does most. */
typedef struct SporeModel {
  const SporeModelType *type;
  size_t q_count, block_count, node_count;
  size_t spare_count; /* of the nodes, the last ones: they have next to no mass and stand still until a cut takes them
                         into use, one after the other */
  size_t q_room, block_room; /* the largest values that q_count and block_count may take; larger than these only where
                                nodes come and go */
  size_t line_room;          /* largest number of control points, where these come and go */
  size_t pair_room;          /* largest number of pairs of blocks in its pattern then, repeated pairs counted */
  double *block_mass;        /* kg, block_room; above 0 for nodes, 0 for the block of a frame's angular velocity */
  double particle_volume;    /* m^3, of a fluid: what each particle stands for; 0 else */
  double buoyancy;           /* part of its weight that the air around it carries; above 1 it rises */
  double stain;              /* 1/s, of a fluid: rate at which what its drops lie on takes on their colour; below 0: at
                                which they wash such colour off */
  double life_s; /* s, of particles: older ones are taken out of the world; the age of each particle, s, lies behind the
                    nodes in q; 0: they last for ever */
  bool tears;    /* the world calls tear after each step */
  double map_slack; /* m: a point that map cannot carry is put onto the body if it is no farther off than this */
  SporePool *pool;  /* threads for long loops, set by the world; the results must not depend on it */
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

/* Where a model's elements are met one after the other: so many seconds after the step began. */
typedef struct SporeSweep {
  double h;
  const double *before;      /* 3 a node: where it was when the step began */
  double *now;               /* 4 a node: where it is, and one over its mass, 0 of a node that is held */
  const SporeCancel *cancel; /* where it says so, what comes out is of no use; NULL: nothing does */
} SporeSweep;

/* What a nodal model can do whose elements can be met one after the other, each implicitly by itself. Slots are
 * required where they do not say otherwise. */
typedef struct SporeModelSweep {
  /* Whether this model can. NULL: all of the type can. */
  bool (*can)(const SporeModel *model);
  /* Puts the elements in order, when a body is to move so. False: no memory, or cancelled. */
  bool (*prepare)(SporeModel *model, const SporeCancel *cancel);
  /* The least part of a step after which its elements can be met so that no step is too large: more where meeting one
   * undoes more of what meeting others did. */
  double (*part)(const SporeModel *model);
  /* Moves the nodes of `now`: one sweep over all elements, which takes the place of the slot force. As h goes to 0 the
   * two agree. Allocates nothing. */
  void (*sweep)(SporeModel *model, const SporeSweep *at);
} SporeModelSweep;

/* A model of particles: its points keep no neighbours, and what is drawn is the skin around them, not a surface that
 * follows them. */
typedef struct SporeModelParticles {
  /* Of particles that are seen as puffs: radius, m, and opacity, 0..1, of one. NULL: they are not. */
  void (*puff)(const SporeModel *model, const double *q, size_t particle, double *radius, double *opacity);
  /* Required. As a special effect, in place of forces: the state after h seconds, by a formula that is right for any h
   * in air that is even there. gravity: less the buoyancy, m/s^2. q1 and v1 may be q and v. */
  void (*carry)(const SporeModel *model, SporeVec3 gravity, double h, const double *q, const double *v, double *q1,
                double *v1);
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
  bool root;                  /* takes a root, from which what holds the body begins */

  /* Required. */
  /* Builds from geometry and fields (a structure of parameters.size bytes, checked already). Refuses, with place
   * (element index) and remedy, what it could not simulate: zero mass, flat tetrahedra, a net without edges. What takes
   * long asks geometry->cancel between bounded pieces of work, and gives up. Call it by spore_model_create. */
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
  /* Mapping of `count` points given in the body's frame at rest; reproduces them at rest to rounding. cancel ends it,
   * with SPORE_ERROR_CANCELLED: a point may take as long as there are nodes, so that cancel is asked before each. */
  bool (*map)(const SporeModel *model, const double *points, size_t count, const SporeCancel *cancel,
              SporeMapping *mapping, SporeError *error);

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
  /* The same for balance of forces, of a model that may buckle: of `at` without damping and from. The whole is exact,
   * but where the model says what it leaves out: then a balance is found quickly, and one that is not stable is left.
   * NULL: jacobian serves. */
  void (*stiffness)(const SporeModel *model, const SporeTangent *at, SporeBlockMatrix *matrix);
  /* Moves q along v for h seconds, free of force: q1, v1 from q, v (may alias). NULL: q1 = q + h v, v1 = v.
   * A rigid body turns here and keeps its angular momentum. */
  void (*drift)(const SporeModel *model, const double *q, const double *v, double h, double *q1, double *v1);
  /* The longest drift (s) that turns a frame in this state to where it belongs. A longer one keeps the angular
   * momentum, but the frame's orientation is wrong after it. INFINITY, or NULL: any drift is right. */
  double (*longest_turn)(const SporeModel *model, const double *q, const double *v);
  /* Takes new parameter values while running; only ones marked SPORE_CHANGE_LIVE differ. */
  bool (*retune)(SporeModel *model, const void *fields, SporeError *error);
  /* Greatest angular frequency (rad/s) and damping rate (1/s) of the model's own forces. For models without a Jacobian
   * that are to be moved by explicit steps: where the scene leaves it open, a body takes Verlet and as many substeps as
   * these rates ask for. */
  void (*rates)(const SporeModel *model, double *frequency, double *damping);
  /* What the forces of the last evaluation bring in from outside, or take out, W: of a model with a thermostat. */
  double (*power)(const SporeModel *model);
  /* Drops what evaluations leave behind to make the next one quicker: the state was set from outside, and what follows
   * from it must not depend on what was before. */
  void (*forget)(SporeModel *model);
  /* The largest strain at q: by which part of its length at rest an element, a spring or a piece of a line is longer,
   * at most; below 0 where all are shorter. Allocates nothing; the same bits on every processor. NULL: none is known.
   */
  double (*strain)(const SporeModel *model, const double *q);
  /* The model's own collision spheres, in the body's frame at rest, for bodies whose scene gives them none, where map
   * takes them; of particles one at each node, in their order. *set: spore_sphere_set_clear. */
  bool (*spheres)(const SporeModel *model, SporeSphereSet *set, SporeError *error);
  /* Corners of the triangles of its surface, nodes, three each, from spore_allocate: what a needle pierces. False: no
   * memory. NULL: it cannot be pierced. */
  bool (*skin)(const SporeModel *model, uint32_t **triangles, size_t *count);
  /* The same material, as fields say, in elements that hang together nowhere: each has its own nodes, as many as the
   * others, one element after the other in the order of the mesh, corners first. *nodes: which node of this model, as
   * it was created, each of them is, from spore_allocate; *count: of elements. Any thread may ask, while a world moves
   * the model. NULL with the error: no memory. NULL: the force on an element does not follow from its own nodes alone.
   */
  SporeModel *(*apart)(const SporeModel *model, const void *fields, uint32_t **nodes, size_t *count, SporeError *error);
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
  const SporeModelSweep *sweep;
  const SporeModelAdapt *adapt;
  const SporeModelParticles *particles;
  const SporeModelLine *line;
};

/* A model of the type: its slot create. SPORE_ERROR_CANCELLED where geometry->cancel ended it, also where the model was
 * made by then. */
SporeModel *spore_model_create(const SporeModelType *type, const SporeGeometry *geometry, const void *fields,
                               SporeError *error);
/* Fills the base of a model of node_count nodes; framed: the last node is the origin of a frame, which has one block
 * and one quaternion more. block_mass is allocated and zero. False: no memory. */
bool spore_model_init(SporeModel *model, const SporeModelType *type, size_t node_count, bool framed, SporeError *error);
/* Frees what spore_model_init allocated, and zeroes the base. */
void spore_model_clear(SporeModel *model);
/* Whether all blocks are nodes: the model has no frame. */
static inline bool spore_model_is_nodal(const SporeModel *model) { return model->node_count == model->block_count; }
/* Whether the model's elements can be met one after the other. */
static inline bool spore_model_sweeps(const SporeModel *model) {
  const SporeModelSweep *sweep = model->type->sweep;
  return sweep && (!sweep->can || sweep->can(model));
}
/* Whether the model is one frame and no other node: points follow it rigidly. */
static inline bool spore_model_is_rigid(const SporeModel *model) {
  return model->node_count == 1 && model->block_count == 2;
}
/* Mass at q as a block-diagonal matrix: block_count x 9, kg; kg m^2 for the block of a frame. */
void spore_model_mass(const SporeModel *model, const double *q, double *blocks);
/* Sum of block_mass, kg. */
double spore_model_total_mass(const SporeModel *model);
/* A matrix with the model's own pattern, in which the model can look up its blocks. The caller clears it. False: no
 * memory. */
bool spore_model_matrix_create(const SporeModel *model, SporeBlockMatrix *matrix);

/* A registry is a NULL-terminated array of types; models/registry.c holds the one of this program. */
typedef const SporeModelType *const *SporeModelRegistry;
/* The type of that name; NULL: there is none. */
const SporeModelType *spore_model_type_find(SporeModelRegistry registry, const char *name);
/* False for a type without a required slot, or whose table is inconsistent: parameters of one name, defaults out of
 * range, presets of parameters that do not exist. The error's place is "models/NAME". */
bool spore_model_type_check(const SporeModelType *type, SporeError *error);

#endif
