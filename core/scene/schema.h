/* What objects a scene may hold: their elements, properties and children. Made from the parameter tables, the
 * model registry and the generators; the reader, writer, RELAX NG, inspector and `spore models` all ask it. */
#ifndef SPORE_SCENE_SCHEMA_H
#define SPORE_SCENE_SCHEMA_H

#include <glib.h>

#include "core/body/model.h"

#define SPORE_FORMAT_MAJOR 1
#define SPORE_FORMAT_MINOR 0

/* Whether a file of that version ("1.0") can be read. Every minor version of this major version can: a newer minor
 * version only adds elements, and an unknown element is refused by name where it is used. */
bool spore_format_version_check(const char *version, SporeError *error);

/* Tree of elements (sections of the root in this order; units of a body in this order):
 *
 *   spore(version)
 *     meta(title author description licence) > measured(method time_step level body error floor step_cost statistics
 *                                              reference reference_step reference_error start duration date scene_hash)
 *     units(length)                        how lengths are shown to people; the file is SI
 *     environment(gravity)
 *     solver(spore_solver_parameters)
 *     defaults > contact(spore_contact_parameters)   what bodies' collision units start from
 *     assets > mesh(name file unit frame source nodes size keep_angle wall wall_detail
 *                first_corner second_corner third_corner fourth_corner inside control_points tolerance smoothing), and
 * what generated data remember curve(name file source points tolerance first_place last_place), the same spheres(name
 * file source method count tolerance seed) and what generated data remember (generated.h) > sphere_region(name centre
 * radius density) tetrahedra(name file source method cells size tolerance curvature fill gap), the same >
 * cell_region(name centre radius size) bodies > body(name role position rotation velocity spin) mechanical(geometry
 * integrator substeps material) > one model element (its own table) regions > region(name centre radius stiffness_scale
 * density_scale material) > dab(centre radius), which sphere_region and cell_region hold, too; collision(spheres +
 * spore_contact_parameters) visual(mesh colour wetness opacity texture texture_places) fidelity(mode level automatic
 * ...) > coarse(geometry settings) medium(geometry settings) links  > pin(name body point radius) | spring(name body_a
 * body_b point_a point_b stiffness damping rest_length) effects > emitter(name body ...) > fidelity(mode advice
 * advice_hash) tools > probe(name body device) | camera(name position target field_of_view) | each kind of tool, of
 * which a clamp holds fidelity, too devices > mouse(name) | track(name file) exercise(task time_limit order) > steps
 * (core/exercise/event.h) and metrics (core/exercise/metric.h), in any order
 *
 * Names are unique within a section (assets, bodies, links, tools, devices), so that "bodies/liver" says one object.
 * position and rotation place a body's frame: metres, and a rotation vector (axis times angle, rad).
 * A property of `collision` that is not set takes its value from `defaults > contact`, one of a model from the
 * material.
 */
typedef struct SporeObjectType SporeObjectType;
struct SporeObjectType {
  const char *element;              /* "body" */
  const char *key;                  /* the same; where elements of one name differ by parent, "clamp/fidelity" */
  const char *label, *doc;          /* translatable */
  const SporeParameterTable *table; /* properties, possibly empty; one of type SPORE_NAME makes it nameable */
  GPtrArray *children;              /* of const SporeObjectType *, in file order where `ordered` */
  gboolean ordered;                 /* children in fixed order, each element at most once */
  gboolean single_child;            /* at most one child in all (mechanical: one model) */
  const SporeModelType *model;      /* for a child of mechanical, else NULL */
  const char *defaults;             /* child of `defaults` that gives unset properties their value, or NULL */
  const SporeValue *initial;        /* table->count defaults, as spore_parameter_initial gives them */
};

typedef struct SporeSchema SporeSchema;
/* assets: what the generators of core/author bring, ended by NULL: each an array of elements ended by no name, an asset
 * first, then its regions. */
typedef struct SporeElement SporeElement;
SporeSchema *spore_schema_new(SporeModelRegistry registry, const SporeElement *const *assets);
void spore_schema_free(SporeSchema *schema);
SporeModelRegistry spore_schema_registry(const SporeSchema *schema);
const SporeObjectType *spore_schema_root(const SporeSchema *schema); /* element "spore" */
/* By its key. NULL: there is none. */
const SporeObjectType *spore_schema_find(const SporeSchema *schema, const char *key);
/* The child type of that element allowed in `parent`, or NULL. */
const SporeObjectType *spore_object_type_child(const SporeObjectType *parent, const char *element);

/* Nearest known name by edit distance among the children of `parent`, or NULL. */
const char *spore_object_type_nearest_child(const SporeObjectType *parent, const char *element);

/* RELAX NG (XML syntax) of the whole format. Free with g_free. */
char *spore_schema_relax_ng(const SporeSchema *schema);

#endif
