/* spore export --format mjcf: rigid bodies for MuJoCo 2.2, as they stand at a moment. Spheres are what others touch;
 * unmovable bodies belong to the world, active ones follow a mocap, passive ones are free. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/schema_fields.h"
#include "ui/export/private.h"

/* What a body becomes. */
typedef enum Fate {
  FATE_LOST, /* nothing: the format has no such body */
  FATE_STILL,
  FATE_LED,
  FATE_FREE
} Fate;

typedef struct Model {
  SporeExport *export;
  const SporeSimulation *simulation;
  guint count; /* of bodies */
  Fate *fates;
  GString **inside; /* of each body's element */
  GString *world;   /* sites that belong to no body */
  GString *equalities, *tendons;
  guint sites, lost_links;
  gsize free_spheres; /* of all bodies that are free */
  GString *text;      /* the file; NULL: not made yet */
} Model;

static const SporeObject *object_of(const Model *model, guint body) {
  return spore_document_by_id(model->export->document, model->simulation->body_object[body]);
}

static void append_vector(GString *text, const char *name, SporeVec3 v) {
  spore_export_attribute(text, name, (const double[]){v.x, v.y, v.z}, 3);
}

/* Bodies. */

static Fate fate_of(const SporeWorld *world, guint body) {
  const SporeRole role = spore_world_body_role(world, body);
  const SporeModel *model = spore_world_body_model(world, body);
  if (role == SPORE_UNMOVABLE) return FATE_STILL;
  if (role == SPORE_ACTIVE) return FATE_LED;
  return model && spore_model_is_rigid(model) ? FATE_FREE : FATE_LOST;
}

static gboolean add_spheres(Model *model, guint body, const SporeSphereSet *set, double friction,
                            const double colour[3], GError **error) {
  g_autofree double *centres = g_new(double, 3 * set->count), *radii = g_new(double, set->count), *places = NULL;
  for (gsize i = 0; i < set->count; i++) memcpy(centres + 3 * i, set->spheres + 4 * i, 3 * sizeof *centres);
  spore_spheres_radii(set, radii, 1);
  if (!spore_export_place(model->simulation->world, body, centres, set->count, &places, error)) return FALSE;
  if (model->fates[body] == FATE_FREE) model->free_spheres += set->count;
  for (gsize i = 0; i < set->count; i++) {
    GString *text = model->inside[body];
    g_string_append(text, "<geom");
    spore_export_attribute(text, "pos", places + 3 * i, 3);
    spore_export_attribute(text, "size", radii + i, 1);
    spore_export_attribute(text, "friction", (const double[]){friction, 0.005, 0.0001}, 3);
    spore_export_attribute(text, "rgba", (const double[]){colour[0], colour[1], colour[2], 1}, 4);
    g_string_append(text, "/>\n");
  }
  return TRUE;
}

static gboolean add_collision(Model *model, guint body, GError **error) {
  const SporeObject *object = object_of(model, body), *visual = spore_object_child_of(object, "visual");
  const SporeObject *collision = spore_object_child_of(object, "collision");
  const char *name = collision ? spore_object_text(collision, "spheres") : NULL;
  if (!name) return TRUE;
  SporeObject *asset = spore_document_find(model->export->document, "spheres", name);
  const SporeSphereSet *set = asset ? spore_document_spheres(model->export->document, asset, error) : NULL;
  SporeVisualFields shown = {.colour = {0.7, 0.7, 0.7}};
  SporeCollisionFields fields;
  if (visual) spore_object_fields(visual, &shown);
  spore_object_fields(collision, &fields);
  return set && add_spheres(model, body, set, fields.contact.friction, shown.colour, error);
}

/* Mass and inertia, in the frame of the element: its origin is the centre of mass. */
static void add_inertia(Model *model, guint body, const double *q) {
  const SporeModel *rigid = spore_world_body_model(model->simulation->world, body);
  const double mass = spore_model_total_mass(rigid);
  const SporeMat3 inertia = spore_export_inertia(rigid, q);
  const double *i = inertia.m;
  GString *text = model->inside[body];
  g_string_append(text, "<freejoint/>\n<inertial pos=\"0 0 0\"");
  spore_export_attribute(text, "mass", &mass, 1);
  spore_export_attribute(text, "fullinertia", (const double[]){i[0], i[4], i[8], i[1], i[2], i[5]}, 6);
  g_string_append(text, "/>\n");
}

static gboolean add_body(Model *model, guint body, GError **error) {
  const SporeWorld *world = model->simulation->world;
  model->fates[body] = fate_of(world, body);
  if (model->fates[body] == FATE_LOST) {
    spore_export_lose(model->export, g_strdup_printf(_("%s: it is no rigid body (%s), and the file has only those"),
                                                     spore_world_body_name(world, body),
                                                     _(spore_world_body_model(world, body)->type->label)));
    return TRUE;
  }
  if (model->fates[body] == FATE_FREE) add_inertia(model, body, spore_world_q(world, body));
  return add_collision(model, body, error);
}

/* Links. */

/* Adds a site at a place in the world at time 0, to a body or to the world. Returns its number. */
static gboolean add_site(Model *model, guint body, SporeVec3 point, guint *site, SporeVec3 *inside, GError **error) {
  *inside = point;
  if (body != SPORE_NO_BODY) {
    double at[3];
    g_autofree double *place = NULL;
    SporePose start = spore_world_start_pose(model->simulation->world, body);
    spore_vec3_store(at, spore_pose_apply_inverse(start, point));
    if (!spore_export_place(model->simulation->world, body, at, 1, &place, error)) return FALSE;
    *inside = spore_vec3_load(place);
  }
  GString *text = body == SPORE_NO_BODY ? model->world : model->inside[body];
  *site = model->sites++;
  g_string_append_printf(text, "<site name=\"site%u\"", *site);
  append_vector(text, "pos", *inside);
  g_string_append(text, "/>\n");
  return TRUE;
}

static gboolean add_spring(Model *model, const SporeLinkDescription *link, GError **error) {
  guint a, b;
  SporeVec3 inside;
  if (!add_site(model, link->body_a, link->point_a, &a, &inside, error) ||
      !add_site(model, link->body_b, link->point_b, &b, &inside, error))
    return FALSE;
  double length = link->rest_length < 0 ? spore_vec3_distance(link->point_a, link->point_b) : link->rest_length;
  g_string_append_printf(model->tendons, "<spatial name=\"%s\"", link->name);
  spore_export_attribute(model->tendons, "springlength", &length, 1);
  spore_export_attribute(model->tendons, "stiffness", &link->stiffness, 1);
  spore_export_attribute(model->tendons, "damping", &link->damping, 1);
  g_string_append_printf(model->tendons, "><site site=\"site%u\"/><site site=\"site%u\"/></spatial>\n", a, b);
  return TRUE;
}

static gboolean add_ball(Model *model, const SporeLinkDescription *link, GError **error) {
  guint site;
  SporeVec3 inside;
  if (!add_site(model, link->body_a, link->point_a, &site, &inside, error)) return FALSE;
  g_string_append_printf(model->equalities, "<connect name=\"%s\" body1=\"%s\"", link->name, link->body_a_name);
  if (link->body_b != SPORE_NO_BODY) g_string_append_printf(model->equalities, " body2=\"%s\"", link->body_b_name);
  append_vector(model->equalities, "anchor", inside);
  g_string_append(model->equalities, "/>\n");
  return TRUE;
}

static guint32 find_body(const Model *model, const char *name) {
  return name ? spore_world_find_body(model->simulation->world, name) : SPORE_NO_BODY;
}

static gboolean is_there(const Model *model, guint32 body) {
  return body == SPORE_NO_BODY || model->fates[body] != FATE_LOST;
}

static gboolean add_link(Model *model, const SporeObject *object, GError **error) {
  SporeLinkDescription link = {.type = spore_link_type_find(spore_object_type(object)->element)};
  const SporeLinkType *type = link.type;
  if (type == &spore_link_spring || type == &spore_link_ball) {
    spore_object_fields(object, &link);
    link.body_a = find_body(model, link.body_a_name);
    link.body_b = find_body(model, link.body_b_name);
    if (is_there(model, link.body_a) && is_there(model, link.body_b))
      return type == &spore_link_spring ? add_spring(model, &link, error) : add_ball(model, &link, error);
  }
  model->lost_links++;
  return TRUE;
}

/* The file. */

static void write_body(const Model *model, guint body, GString *text) {
  const SporeWorld *world = model->simulation->world;
  const double *q = spore_world_q(world, body);
  if (model->fates[body] == FATE_LOST) return;
  g_string_append_printf(text, "<body name=\"%s\"", spore_world_body_name(world, body));
  if (model->fates[body] != FATE_STILL) {
    spore_export_attribute(text, "pos", q, 3);
    spore_export_attribute(text, "quat", q + 3, 4);
  }
  if (model->fates[body] == FATE_LED) g_string_append(text, " mocap=\"true\"");
  g_string_append_printf(text, ">\n%s</body>\n", model->inside[body]->str);
}

/* MuJoCo 2.2 has room for 100 contacts and 500 rows of constraints where a file says nothing, and leaves out the rest:
 * room for 4 contacts of each sphere of a free body, with 4 rows each. */
static void write_sizes(const Model *model, GString *text) {
  gsize contacts = 100 + 4 * model->free_spheres;
  g_string_append_printf(text, "<size nconmax=\"%zu\" njmax=\"%zu\"/>\n", contacts, 100 + 4 * contacts);
}

static GString *write_model(const Model *model) {
  SporeDocument *document = model->export->document;
  double dt_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  SporeEnvironmentFields environment;
  spore_object_fields(spore_document_section(document, "environment"), &environment);
  GString *text =
      g_string_new("<mujoco model=\"spore\">\n<!-- SPORE: m, kg, s -->\n<compiler angle=\"radian\"/>\n<option");
  spore_export_attribute(text, "timestep", &dt_s, 1);
  spore_export_attribute(text, "gravity", environment.gravity, 3);
  g_string_append(text, "/>\n");
  write_sizes(model, text);
  g_string_append(text, "<default><geom type=\"sphere\"/></default>\n<worldbody>\n");
  g_string_append(text, model->world->str);
  for (guint body = 0; body < model->count; body++) write_body(model, body, text);
  g_string_append_printf(text, "</worldbody>\n<tendon>\n%s</tendon>\n<equality>\n%s</equality>\n</mujoco>\n",
                         model->tendons->str, model->equalities->str);
  return text;
}

static gboolean make_model(gpointer data, const SporeDrawing *drawing, double time_s, GError **error) {
  Model *model = data;
  model->simulation = spore_drawing_simulation(drawing);
  model->count = (guint)spore_world_body_count(model->simulation->world);
  model->fates = g_new0(Fate, model->count + 1);
  model->inside = g_new0(GString *, model->count + 1);
  for (guint body = 0; body < model->count; body++) model->inside[body] = g_string_new(NULL);
  for (guint body = 0; body < model->count; body++)
    if (!add_body(model, body, error)) return FALSE;
  const SporeObject *links = spore_document_section(model->export->document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++)
    if (!add_link(model, spore_object_child(links, i), error)) return FALSE;
  if (model->lost_links)
    spore_export_lose(model->export,
                      g_strdup_printf(_("%u of %u links: the file has springs and ball joints between rigid "
                                        "bodies"),
                                      model->lost_links, spore_object_child_count(links)));
  spore_export_lose_poses(model->export);
  model->text = write_model(model);
  return TRUE;
}

static void clear_model(Model *model) {
  for (guint body = 0; body < model->count; body++) g_string_free(model->inside[body], TRUE);
  g_free(model->inside);
  g_free(model->fates);
  g_string_free(model->world, TRUE);
  g_string_free(model->equalities, TRUE);
  g_string_free(model->tendons, TRUE);
  if (model->text) g_string_free(model->text, TRUE);
}

gboolean spore_export_mjcf(SporeExport *export, GError **error) {
  Model model = {
      .export = export, .world = g_string_new(NULL), .equalities = g_string_new(NULL), .tendons = g_string_new(NULL)};
  gboolean done = spore_export_show(export, make_model, &model, error) &&
                  spore_export_write(export, model.text->str, model.text->len, error);
  clear_model(&model);
  spore_export_lose(export, g_strdup(_("surfaces, velocities, and the strength at which links break")));
  spore_export_lose(export, g_strdup(_("the contact law: MuJoCo has its own; the friction is in the file")));
  spore_export_lose_sections(export, FALSE);
  return done;
}
