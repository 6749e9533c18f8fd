/* spore export --format sofa: the start of a scene for SOFA, as components that its users know. Rigid bodies,
 * tetrahedra and nets of springs become objects; instruments and what is unmovable stand still. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/constraint/pin.h"
#include "core/scene/schema_fields.h"
#include "models/net/spring_pairs.h"
#include "models/registry.h"
#include "ui/export/private.h"

typedef struct Sofa Sofa;
typedef struct Kind Kind;

/* What a body becomes. */
struct Kind {
  const SporeModelType *type; /* NULL: any that stands still or is led */
  const char *material;       /* of tetrahedra: SOFA's name of a hyperelastic law; NULL: linear elements that turn */
  gboolean (*write)(Sofa *sofa, guint body, const Kind *kind, GError **error);
};

struct Sofa {
  SporeExport *export;
  const SporeDrawing *drawing;
  SporeWorld *world;
  const SporeSimulation *simulation;
  GString *text;
};

static const char plugins[] = "Sofa.Component.AnimationLoop Sofa.Component.Collision.Detection.Algorithm "
                              "Sofa.Component.Collision.Detection.Intersection Sofa.Component.Collision.Geometry "
                              "Sofa.Component.Collision.Response.Contact Sofa.Component.Constraint.Projective "
                              "Sofa.Component.LinearSolver.Iterative Sofa.Component.Mapping.Linear "
                              "Sofa.Component.Mapping.NonLinear Sofa.Component.Mass Sofa.Component.ODESolver.Backward "
                              "Sofa.Component.SolidMechanics.FEM.Elastic "
                              "Sofa.Component.SolidMechanics.FEM.HyperElastic Sofa.Component.SolidMechanics.Spring "
                              "Sofa.Component.StateContainer Sofa.Component.Topology.Container.Dynamic";

static SporeObject *object_of(const Sofa *sofa, guint body) {
  return spore_document_by_id(sofa->export->document, sofa->simulation->body_object[body]);
}

static const SporeObject *model_object(const Sofa *sofa, guint body) {
  const SporeObject *mechanical = spore_object_child_of(object_of(sofa, body), "mechanical");
  return spore_object_child_of(mechanical, spore_world_body_model(sofa->world, body)->type->name);
}

/* Elements of what moves by itself: a solver, with Rayleigh's damping. */
static void write_solver(Sofa *sofa, double mass_damping, double stiffness_damping) {
  g_string_append(sofa->text, "<EulerImplicitSolver");
  spore_export_attribute(sofa->text, "rayleighMass", &mass_damping, 1);
  spore_export_attribute(sofa->text, "rayleighStiffness", &stiffness_damping, 1);
  g_string_append(sofa->text, "/>\n<CGLinearSolver iterations=\"200\" tolerance=\"1e-9\" threshold=\"1e-12\"/>\n");
}

/* Spheres that others touch. */

static void write_spheres(Sofa *sofa, const double *places, const SporeSphereSet *set, const char *mapping) {
  GString *text = sofa->text;
  g_autofree double *radii = g_new(double, set->count);
  spore_spheres_radii(set, radii, 1);
  g_string_append(text, "<Node name=\"collision\">\n<MechanicalObject template=\"Vec3d\"");
  spore_export_attribute(text, "position", places, 3 * set->count);
  g_string_append_printf(text, "/>\n<SphereCollisionModel%s", mapping ? "" : " moving=\"0\" simulated=\"0\"");
  spore_export_attribute(text, "listRadius", radii, set->count);
  g_string_append_printf(text, "/>\n%s</Node>\n", mapping ? mapping : "");
}

/* framed: the places are in the frame of the body, else in the world as it starts. */
static gboolean write_collision(Sofa *sofa, guint body, gboolean framed, const char *mapping, GError **error) {
  const SporeObject *collision = spore_object_child_of(object_of(sofa, body), "collision");
  const char *name = collision ? spore_object_text(collision, "spheres") : NULL;
  SporeObject *asset = name ? spore_document_find(sofa->export->document, "spheres", name) : NULL;
  if (!asset) return TRUE;
  const SporeSphereSet *set = spore_document_spheres(sofa->export->document, asset, error);
  if (!set) return FALSE;
  g_autofree double *centres = g_new(double, 3 * set->count), *places = NULL;
  const SporePose start = spore_world_start_pose(sofa->world, body);
  for (gsize i = 0; i < set->count; i++)
    if (framed) memcpy(centres + 3 * i, set->spheres + 4 * i, 3 * sizeof *centres);
    else spore_vec3_store(centres + 3 * i, spore_pose_apply(start, spore_vec3_load(set->spheres + 4 * i)));
  if (framed && !spore_export_place(sofa->world, body, centres, set->count, &places, error)) return FALSE;
  write_spheres(sofa, places ? places : centres, set, mapping);
  return TRUE;
}

/* Rigid bodies. */

/* SOFA: x y z, then the quaternion with its real part last. */
static void write_rigid_state(Sofa *sofa, const double *q, const double *v) {
  const double place[] = {q[0], q[1], q[2], q[4], q[5], q[6], q[3]};
  g_string_append(sofa->text, "<MechanicalObject template=\"Rigid3d\"");
  spore_export_attribute(sofa->text, "position", place, G_N_ELEMENTS(place));
  spore_export_attribute(sofa->text, "velocity", v, 6);
  g_string_append(sofa->text, "/>\n");
}

/* Mass, volume, and the inertia of a unit of mass, in the frame of the body. */
static void write_rigid_mass(Sofa *sofa, const SporeModel *model, const double *q) {
  const SporeMat3 inertia = spore_export_inertia(model, q);
  double mass[11] = {spore_model_total_mass(model), 1};
  for (guint i = 0; i < 9; i++) mass[2 + i] = inertia.m[i] / mass[0];
  g_string_append(sofa->text, "<UniformMass");
  spore_export_attribute(sofa->text, "vertexMass", mass, G_N_ELEMENTS(mass));
  g_string_append(sofa->text, "/>\n");
}

static gboolean write_rigid(Sofa *sofa, guint body, const Kind *kind, GError **error) {
  const double *q = spore_world_q(sofa->world, body);
  write_solver(sofa, 0, 0);
  write_rigid_state(sofa, q, spore_world_v(sofa->world, body));
  write_rigid_mass(sofa, spore_world_body_model(sofa->world, body), q);
  return write_collision(sofa, body, TRUE, "<RigidMapping/>\n", error);
}

static gboolean write_still(Sofa *sofa, guint body, const Kind *kind, GError **error) {
  return write_collision(sofa, body, FALSE, NULL, error);
}

/* Bodies of mass points. */

static void append_rows(GString *text, const char *name, const guint32 *values, gsize count) {
  g_string_append_printf(text, " %s=\"", name);
  for (gsize i = 0; i < count; i++) g_string_append_printf(text, "%s%u", i ? " " : "", values[i]);
  g_string_append_c(text, '"');
}

/* Points that pins hold still. */
static void write_pins(Sofa *sofa, guint body, gsize count) {
  const SporeObject *links = spore_document_section(sofa->export->document, "links");
  g_autofree guint8 *held = g_new0(guint8, count);
  for (guint i = 0; i < spore_object_child_count(links); i++) {
    const SporeObject *object = spore_object_child(links, i);
    SporeLinkDescription link = {.type = spore_link_type_find(spore_object_type(object)->element)};
    if (link.type != &spore_link_pin) continue;
    spore_object_fields(object, &link);
    if (g_strcmp0(link.body_a_name, spore_world_body_name(sofa->world, body)) == 0)
      spore_pin_select(spore_world_q(sofa->world, body), count, link.point_a, link.radius, held);
  }
  g_autoptr(GArray) indices = g_array_new(FALSE, FALSE, sizeof(guint32));
  for (guint32 i = 0; i < count; i++)
    if (held[i]) g_array_append_val(indices, i);
  if (!indices->len) return;
  g_string_append(sofa->text, "<FixedProjectiveConstraint");
  append_rows(sofa->text, "indices", (const guint32 *)(gconstpointer)indices->data, indices->len);
  g_string_append(sofa->text, "/>\n");
}

/* Places, velocities, masses, and what is held. rest: count x 3. */
static void write_points(Sofa *sofa, guint body, gsize count, const double *rest) {
  GString *text = sofa->text;
  g_string_append(text, "<MechanicalObject template=\"Vec3d\"");
  spore_export_attribute(text, "position", spore_world_q(sofa->world, body), 3 * count);
  spore_export_attribute(text, "velocity", spore_world_v(sofa->world, body), 3 * count);
  spore_export_attribute(text, "rest_position", rest, 3 * count);
  g_string_append(text, "/>\n<DiagonalMass");
  spore_export_attribute(text, "vertexMass", spore_world_body_model(sofa->world, body)->block_mass, count);
  g_string_append(text, "/>\n");
  write_pins(sofa, body, count);
}

static void write_material(Sofa *sofa, const Kind *kind, double young, double poisson) {
  GString *text = sofa->text;
  if (kind->material) {
    const double law[] = {young / (2 * (1 + poisson)), young * poisson / ((1 + poisson) * (1 - 2 * poisson))};
    g_string_append_printf(text, "<TetrahedronHyperelasticityFEMForceField materialName=\"%s\"", kind->material);
    spore_export_attribute(text, "ParameterSet", law, 2);
  } else {
    g_string_append(text, "<TetrahedronFEMForceField method=\"polar\"");
    spore_export_attribute(text, "youngModulus", &young, 1);
    spore_export_attribute(text, "poissonRatio", &poisson, 1);
  }
  g_string_append(text, "/>\n");
}

static const SporeDrawnPart *cells_of(const Sofa *sofa, guint body) {
  for (guint i = 0; i < spore_drawing_part_count(sofa->drawing); i++) {
    const SporeDrawnPart *part = spore_drawing_part(sofa->drawing, i);
    if (part->body == body && part->kind == SPORE_PART_CELLS) return part;
  }
  return NULL;
}

static gboolean write_tetrahedra(Sofa *sofa, guint body, const Kind *kind, GError **error) {
  const SporeDrawnPart *cells = cells_of(sofa, body);
  const SporeObject *model = model_object(sofa, body);
  write_solver(sofa, spore_object_number(model, "mass_damping"), spore_object_number(model, "stiffness_damping"));
  g_string_append(sofa->text, "<TetrahedronSetTopologyContainer");
  spore_export_attribute(sofa->text, "position", cells->rest, 3 * cells->count);
  append_rows(sofa->text, "tetrahedra", cells->elements, 4 * cells->element_count);
  g_string_append(sofa->text, "/>\n<TetrahedronSetGeometryAlgorithms template=\"Vec3d\"/>\n");
  write_points(sofa, body, cells->count, cells->rest);
  write_material(sofa, kind, spore_object_number(model, "young_modulus"), spore_object_number(model, "poisson_ratio"));
  return write_collision(sofa, body, FALSE, "<BarycentricMapping/>\n", error);
}

/* The springs of one kind: ends, stiffness, damping, length at rest. */
static void write_springs(Sofa *sofa, const SporePairs *pairs, double stiffness, double damping, const double *rest) {
  GString *text = sofa->text;
  if (!(stiffness > 0) || !pairs->count) return;
  g_string_append(text, "<StiffSpringForceField template=\"Vec3d\" spring=\"");
  for (gsize i = 0; i < pairs->count; i++) {
    const guint32 a = (guint32)(pairs->keys[i] >> 32), b = (guint32)pairs->keys[i];
    const double numbers[] = {stiffness, damping,
                              spore_vec3_distance(spore_vec3_load(rest + 3 * a), spore_vec3_load(rest + 3 * b))};
    g_string_append_printf(text, "%s%u %u", i ? " " : "", a, b);
    for (guint k = 0; k < G_N_ELEMENTS(numbers); k++) {
      char number[G_ASCII_DTOSTR_BUF_SIZE];
      g_string_append_printf(text, " %s", g_ascii_formatd(number, sizeof number, "%.12g", numbers[k]));
    }
  }
  g_string_append(text, "\"/>\n");
}

static gboolean write_net_springs(Sofa *sofa, const SporeObject *model, const SporeTriangleMesh *mesh, GError **error) {
  SporePairs edges = {0}, shear = {0}, bending = {0};
  const double damping = spore_object_number(model, "damping");
  gboolean made = spore_pairs_structural(&edges, mesh) && spore_pairs_shear(&shear, mesh, &edges) &&
                  spore_pairs_bending(&bending, mesh, &edges, &shear);
  if (made) {
    write_springs(sofa, &edges, spore_object_number(model, "structural_stiffness"), damping, mesh->vertices);
    write_springs(sofa, &shear, spore_object_number(model, "shear_stiffness"), damping, mesh->vertices);
    write_springs(sofa, &bending, spore_object_number(model, "bending_stiffness"), damping, mesh->vertices);
  }
  spore_pairs_clear(&edges);
  spore_pairs_clear(&shear);
  spore_pairs_clear(&bending);
  return made || spore_error_raise(error, SPORE_ERROR_MEMORY, sofa->export->output, "%s",
                                   _("there is not enough memory to write it; close other programs"));
}

/* The surface that a net is made of; NULL: there is no such mesh. */
static const SporeTriangleMesh *net_mesh(const Sofa *sofa, guint body) {
  const SporeObject *mechanical = spore_object_child_of(object_of(sofa, body), "mechanical");
  const char *name = spore_object_text(mechanical, "geometry");
  SporeObject *asset = name ? spore_document_find(sofa->export->document, "mesh", name) : NULL;
  return asset ? spore_document_mesh(sofa->export->document, asset, NULL) : NULL;
}

static gboolean write_net(Sofa *sofa, guint body, const Kind *kind, GError **error) {
  const SporeTriangleMesh *mesh = net_mesh(sofa, body);
  const SporePose start = spore_world_start_pose(sofa->world, body);
  g_autofree double *rest = g_new(double, 3 * mesh->vertex_count);
  for (gsize i = 0; i < mesh->vertex_count; i++)
    spore_vec3_store(rest + 3 * i, spore_pose_apply(start, spore_vec3_load(mesh->vertices + 3 * i)));
  write_solver(sofa, 0, 0);
  g_string_append(sofa->text, "<TriangleSetTopologyContainer");
  spore_export_attribute(sofa->text, "position", rest, 3 * mesh->vertex_count);
  append_rows(sofa->text, "triangles", mesh->triangles, 3 * mesh->triangle_count);
  g_string_append(sofa->text, "/>\n<TriangleSetGeometryAlgorithms template=\"Vec3d\"/>\n");
  write_points(sofa, body, mesh->vertex_count, rest);
  return write_net_springs(sofa, model_object(sofa, body), mesh, error) &&
         write_collision(sofa, body, FALSE, "<BarycentricMapping/>\n", error);
}

/* The scene. */

static const Kind kinds[] = {
    {&spore_rigid_body, NULL, write_rigid},
    {&spore_mass_spring_net, NULL, write_net},
    {&spore_corotational_tetrahedra, NULL, write_tetrahedra},
    {&spore_neo_hookean_tetrahedra, "StableNeoHookean", write_tetrahedra},
    {&spore_saint_venant_kirchhoff_tetrahedra, "StVenantKirchhoff", write_tetrahedra},
};
static const Kind still = {NULL, NULL, write_still};

/* Whether the points of the model are those that the file takes: elements of ten nodes have more, and coarser levels of
 * detail have others. */
static gboolean fits(const Sofa *sofa, guint body, const Kind *kind) {
  const gsize nodes =
      spore_world_body_model(sofa->world, body)->node_count - spore_world_body_model(sofa->world, body)->spare_count;
  if (spore_world_first_lod(sofa->world, body) != SPORE_LOD_FINE) return FALSE;
  if (kind->write == write_tetrahedra) {
    const SporeDrawnPart *cells = cells_of(sofa, body);
    return cells && cells->count == nodes;
  }
  const SporeTriangleMesh *mesh = kind->write == write_net ? net_mesh(sofa, body) : NULL;
  return kind->write != write_net || (mesh && mesh->vertex_count == nodes);
}

/* NULL: the file cannot have the body. */
static const Kind *kind_of(const Sofa *sofa, guint body) {
  const SporeModel *model = spore_world_body_model(sofa->world, body);
  if (spore_world_body_role(sofa->world, body) != SPORE_PASSIVE) return &still;
  for (gsize i = 0; model && i < G_N_ELEMENTS(kinds); i++)
    if (kinds[i].type == model->type) return fits(sofa, body, &kinds[i]) ? &kinds[i] : NULL;
  return NULL;
}

static void tell_body(const Sofa *sofa, guint body, const Kind *kind) {
  const char *name = spore_world_body_name(sofa->world, body);
  if (!kind)
    spore_export_lose(sofa->export,
                      g_strdup_printf(_("%s: the file has no such body (%s), or not at its level of detail"), name,
                                      _(spore_world_body_model(sofa->world, body)->type->label)));
  else if (spore_world_body_role(sofa->world, body) == SPORE_ACTIVE)
    spore_export_lose(sofa->export, g_strdup_printf(_("%s: it stands still, since no device leads it there"), name));
  if (kind && kind != &still && spore_object_child_of(object_of(sofa, body), "regions"))
    spore_export_lose(sofa->export, g_strdup_printf(_("%s: its stiffer and softer regions"), name));
}

static void write_head(Sofa *sofa) {
  SporeDocument *document = sofa->export->document;
  const double dt_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  SporeEnvironmentFields environment;
  spore_object_fields(spore_document_section(document, "environment"), &environment);
  g_string_append(sofa->text, "<?xml version=\"1.0\"?>\n<!-- SPORE: m, kg, s -->\n<Node name=\"root\"");
  spore_export_attribute(sofa->text, "dt", &dt_s, 1);
  spore_export_attribute(sofa->text, "gravity", environment.gravity, 3);
  g_string_append_printf(sofa->text,
                         ">\n<RequiredPlugin pluginName=\"%s\"/>\n<DefaultAnimationLoop/>\n<CollisionPipeline/>\n"
                         "<BruteForceBroadPhase/>\n<BVHNarrowPhase/>\n<DiscreteIntersection/>\n"
                         "<CollisionResponse response=\"PenalityContactForceField\"/>\n",
                         plugins);
}

static gboolean write_scene(gpointer data, const SporeDrawing *drawing, double time_s, GError **error) {
  Sofa *sofa = data;
  sofa->drawing = drawing;
  sofa->simulation = spore_drawing_simulation(drawing);
  sofa->world = sofa->simulation->world;
  write_head(sofa);
  for (guint body = 0; body < spore_world_body_count(sofa->world); body++) {
    const Kind *kind = kind_of(sofa, body);
    tell_body(sofa, body, kind);
    if (!kind) continue;
    g_string_append_printf(sofa->text, "<Node name=\"%s\">\n", spore_world_body_name(sofa->world, body));
    if (!kind->write(sofa, body, kind, error)) return FALSE;
    g_string_append(sofa->text, "</Node>\n");
  }
  g_string_append(sofa->text, "</Node>\n");
  return TRUE;
}

/* Links but pins of bodies that the file has. */
static void lose_links(SporeExport *export) {
  const SporeObject *links = spore_document_section(export->document, "links");
  guint lost = 0, count = spore_object_child_count(links);
  for (guint i = 0; i < count; i++)
    if (!g_str_equal(spore_object_type(spore_object_child(links, i))->element, spore_link_pin.element)) lost++;
  if (lost) spore_export_lose(export, g_strdup_printf(_("%u of %u links: the file has pins alone"), lost, count));
}

gboolean spore_export_sofa(SporeExport *export, GError **error) {
  Sofa sofa = {.export = export, .text = g_string_new(NULL)};
  gboolean done = spore_export_show(export, write_scene, &sofa, error) &&
                  spore_export_write(export, sofa.text->str, sofa.text->len, error);
  g_string_free(sofa.text, TRUE);
  lose_links(export);
  spore_export_lose_poses(export);
  spore_export_lose(export, g_strdup(_("surfaces and colours")));
  spore_export_lose(export, g_strdup(_("the contact law, friction, and who touches whom: SOFA's penalties take their "
                                       "place")));
  spore_export_lose(export, g_strdup(_("the integrator and the solvers: there they are implicit Euler and conjugate "
                                       "gradients")));
  spore_export_lose_sections(export, FALSE);
  return done;
}
