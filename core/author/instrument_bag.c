/* The film of a specimen bag: rings of points, as many as fit into each, straight below the rim, and round below. */
#include "core/author/instrument_bag.h"

#include <math.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/io/mesh_import.h"

#define DEPTH 0.052     /* m */
#define SIDE 0.0068     /* m: between the points of the film */
#define THICKNESS 0.001 /* m: radius of its spheres */
#define MOST_POINTS 512 /* of a film */
#define LEAST_ROUND 5   /* points of a ring */
#define COLOUR "0.55 0.72 0.86"

/* Of thin, slack polyethylene, as the net of the bag in resources/scenes/bag.spore. */
static const char *const film_settings[] = {"surface_density",
                                            "0.24",
                                            "structural_stiffness",
                                            "200",
                                            "shear_stiffness",
                                            "60",
                                            "bending_stiffness",
                                            "0.5",
                                            "damping",
                                            "0.03",
                                            NULL};
static const char *const contact_settings[] = {"stiffness", "300",  "damping", "0.02", "friction",
                                               "0.2",       "self", "true",    NULL};
static const char *const visual_settings[] = {"colour", COLOUR, "wetness", "0.5", NULL};
static const char *const tie_settings[] = {"stiffness", "500", NULL};

typedef struct Film {
  double vertices[3 * MOST_POINTS];
  guint32 triangles[6 * MOST_POINTS];
  guint vertex_count, triangle_count, rim; /* rim: points along the mouth, which come first */
} Film;

/* A ring of points: the number of the first, how many, and how far the first is turned, in places. */
typedef struct Round {
  guint first, count;
  double turn;
} Round;

static guint add_point(Film *film, double x, double y, double z) {
  const double at[] = {x, y, z};
  memcpy(film->vertices + 3 * film->vertex_count, at, sizeof at);
  return film->vertex_count++;
}

static void add_triangle(Film *film, guint a, guint b, guint c) {
  const guint32 corners[] = {a, c, b}; /* outside is away from the hoop's axis */
  memcpy(film->triangles + 3 * film->triangle_count++, corners, sizeof corners);
}

static Round add_round(Film *film, double middle, double radius, double depth, gboolean half) {
  guint fit = 2 * (guint)lround(G_PI * radius / SIDE);
  Round round = {film->vertex_count, MAX(fit, LEAST_ROUND), half ? 0.5 : 0};
  for (guint i = 0; i < round.count; i++) {
    double angle = 2 * G_PI * (i + round.turn) / round.count;
    add_point(film, radius * sin(angle), middle + radius * cos(angle), -depth);
  }
  return round;
}

/* Triangles between two rings, from the outer to the inner one: the ring goes on whose next point comes first. */
static void zip(Film *film, const Round *outer, const Round *inner) {
  for (guint i = 0, k = 0; i < outer->count || k < inner->count;) {
    double ahead_outer = i < outer->count ? (i + 1 + outer->turn) / outer->count : HUGE_VAL;
    double ahead_inner = k < inner->count ? (k + 1 + inner->turn) / inner->count : HUGE_VAL;
    guint a = outer->first + i % outer->count, b = inner->first + k % inner->count;
    if (ahead_outer <= ahead_inner) add_triangle(film, a, outer->first + ++i % outer->count, b);
    else add_triangle(film, a, inner->first + ++k % inner->count, b);
  }
}

/* middle: of the hoop along the shaft's axis, m. */
static void make_film(Film *film, double mouth, double middle) {
  double straight = fmax(0, DEPTH - mouth), whole = straight + 0.5 * G_PI * mouth;
  guint rings = (guint)lround(whole / SIDE);
  Round last = add_round(film, middle, mouth, 0, FALSE);
  film->rim = last.count;
  for (guint i = 1; i < rings; i++) {
    double way = whole * i / rings, bend = fmax(0, way - straight) / mouth;
    double depth = fmin(way, straight) + mouth * sin(bend);
    Round next = add_round(film, middle, mouth * cos(bend), depth, i % 2);
    zip(film, &last, &next);
    last = next;
  }
  guint bottom = add_point(film, 0, middle, -straight - mouth);
  for (guint i = 0; i < last.count; i++) add_triangle(film, last.first + i, last.first + (i + 1) % last.count, bottom);
}

static SporeObject *film_mesh(SporeDocument *document, Film *film, GError **error) {
  const SporeTriangleMesh mesh = {.vertex_count = film->vertex_count,
                                  .triangle_count = film->triangle_count,
                                  .vertices = film->vertices,
                                  .triangles = film->triangles};
  gsize size;
  char *text = spore_off_format(&mesh, &size);
  return spore_edit_put_asset(document, "mesh", "bag_film", "off", text, size, error);
}

/* At the points, and in the middle of each triangle for what is thin enough to go between. */
static SporeObject *film_spheres(SporeDocument *document, const Film *film, GError **error) {
  g_autoptr(GArray) spheres = g_array_new(FALSE, FALSE, sizeof(double));
  for (guint i = 0; i < film->vertex_count; i++) {
    const double *at = film->vertices + 3 * i, row[] = {at[0], at[1], at[2], THICKNESS};
    g_array_append_vals(spheres, row, 4);
  }
  for (guint i = 0; i < film->triangle_count; i++) {
    double row[4] = {0, 0, 0, THICKNESS};
    for (guint n = 0; n < 9; n++) row[n % 3] += film->vertices[3 * film->triangles[3 * i + n / 3] + n % 3] / 3;
    g_array_append_vals(spheres, row, 4);
  }
  const SporeSphereSet set = {.count = spheres->len / 4, .spheres = (double *)spheres->data};
  gsize size;
  char *text = spore_spheres_format(&set, &size);
  return spore_edit_put_asset(document, "spheres", "bag_film_spheres", "spheres", text, size, error);
}

static gboolean set_all(SporeDocument *document, SporeObject *object, const char *const *settings, GError **error) {
  for (; *settings; settings += 2)
    if (!spore_document_set_text(document, object, settings[0], settings[1], error)) return FALSE;
  return TRUE;
}

/* The unit of the body that uses the asset. */
static SporeObject *use(SporeDocument *document, SporeObject *body, const char *unit, const char *property,
                        const SporeObject *asset, GError **error) {
  SporeObject *part = asset ? spore_edit_child_or_new(document, body, unit, error) : NULL;
  return part && spore_document_set_text(document, part, property, spore_object_name(asset), error) ? part : NULL;
}

static gboolean dress(SporeDocument *document, SporeObject *body, Film *film, GError **error) {
  SporeObject *mesh = film_mesh(document, film, error);
  SporeObject *mechanical = mesh ? use(document, body, "mechanical", "geometry", mesh, error) : NULL;
  SporeObject *model =
      mechanical ? spore_document_insert(document, mechanical, "mass_spring_net", NULL, G_MAXUINT, error) : NULL;
  if (!model || !set_all(document, model, film_settings, error)) return FALSE;
  SporeObject *collision = use(document, body, "collision", "spheres", film_spheres(document, film, error), error);
  if (!collision || !set_all(document, collision, contact_settings, error)) return FALSE;
  SporeObject *visual = use(document, body, "visual", "mesh", mesh, error);
  return visual && set_all(document, visual, visual_settings, error);
}

/* Every second point of the rim. */
static gboolean tie(SporeDocument *document, const SporeObject *holder, const SporeObject *body, const Film *film,
                    SporePose pose, GError **error) {
  for (guint i = 0; i < film->rim; i += 2) {
    g_autofree char *name = g_strdup_printf("%s_%u", spore_object_name(holder), i / 2 + 1);
    SporeObject *ball =
        spore_document_insert(document, spore_document_section(document, "links"), "ball", name, G_MAXUINT, error);
    SporeVec3 at = spore_pose_apply(pose, spore_vec3_load(film->vertices + 3 * i));
    if (!ball || !spore_document_set_text(document, ball, "body_a", spore_object_name(body), error) ||
        !spore_document_set_text(document, ball, "body_b", spore_object_name(holder), error) ||
        !spore_edit_set_vector(document, ball, "point", at, error) || !set_all(document, ball, tie_settings, error))
      return FALSE;
  }
  return TRUE;
}

SporeObject *spore_instrument_add_film(SporeDocument *document, const SporeInstrumentKind *instrument,
                                       const SporeObject *holder, SporePose pose, GError **error) {
  g_autofree Film *film = g_new0(Film, 1);
  g_autofree char *name = g_strdup_printf("%s_film", spore_object_name(holder));
  make_film(film, instrument->head_radius, instrument->head_radius - instrument->head_length);
  SporeObject *body =
      spore_document_insert(document, spore_document_section(document, "bodies"), "body", name, G_MAXUINT, error);
  gboolean done =
      body && spore_edit_set_vector(document, body, "position", pose.position, error) &&
      spore_edit_set_vector(document, body, "rotation", spore_quat_to_rotation_vector(pose.orientation), error) &&
      dress(document, body, film, error) && tie(document, holder, body, film, pose, error);
  return done ? body : NULL;
}
