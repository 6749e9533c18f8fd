/* Moves vertices between labels to where the labels meet, with small shifts to meet the labels' volumes. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/labels/private.h"

#define ROUNDS 12
#define REPORT_VERTICES 1024
#define FLATTEST 0.9659258262890683 /* cosine of 15 degrees */
#define REACH 0.75                  /* edges: search distance from a vertex for the border of its labels */
#define STEPS 12                    /* to each side */
#define BISECTIONS 20
#define ALONG 0.4 /* of the way from a vertex to the mean of its neighbours on the border */
#define MOST_SIDES 4
#define MOST_GROWTH 0.3 /* edges: largest shift of a border for the volume */
#define GRADIENT 0.25   /* edges: step of the central differences */
#define MEETINGS 6      /* iterations to find where three labels meet */
#define OF_A_PAIR 0.4   /* least total share of two labels on their border */
#define FEEDBACK 0.7    /* of the shift computed from a border's area */

/* The labels around a vertex, ascending; 0: outside. */
typedef struct Border {
  uint16_t label[MOST_SIDES];
  uint8_t count;    /* 0: inside an organ; more than MOST_SIDES count as that many */
  SporeVec3 normal; /* summed over the faces between labels, from the lower to the higher label; length: the area */
  SporeVec3 sum;    /* of the places of neighbours on the same border */
  double neighbours;
} Border;

typedef struct Fit {
  const SporeLabelField *field;
  SporeTetrahedralMesh *mesh;
  double edge;
  uint32_t *neighbours;   /* of cells */
  uint32_t *start, *star; /* cells around each vertex: star[start[v]] to star[start[v + 1]] */
  Border *border;
  const double *wanted; /* volume of each label, m^3 */
  SporeLabelPoints *points;
  size_t face_count;
  double *volume, *area, *growth; /* of each label: volume now, m^3; area and outward shift of its border, m^2, m */
} Fit;

static SporeVec3 vertex(const Fit *f, uint32_t v) { return spore_vec3_load(f->mesh->vertices + 3 * (size_t)v); }

static bool make_stars(Fit *f) {
  size_t n = f->mesh->vertex_count, corners = 4 * f->mesh->tetrahedron_count;
  f->start = SPORE_NEW_ARRAY(uint32_t, n + 2);
  f->star = SPORE_NEW_ARRAY(uint32_t, corners);
  if (!f->start || !f->star) return false;
  for (size_t i = 0; i < corners; i++) f->start[f->mesh->tetrahedra[i] + 2]++;
  for (size_t v = 2; v < n + 2; v++) f->start[v] += f->start[v - 1];
  for (size_t i = 0; i < corners; i++) f->star[f->start[f->mesh->tetrahedra[i] + 1]++] = (uint32_t)(i / 4);
  return true;
}

static void add_label(Border *border, uint16_t label) {
  int at = 0;
  while (at < border->count && border->label[at] < label) at++;
  if ((at < border->count && border->label[at] == label) || border->count == MOST_SIDES) return;
  memmove(border->label + at + 1, border->label + at, (size_t)(border->count - at) * sizeof label);
  border->label[at] = label;
  border->count++;
}

/* Calls visit for each face between two labels once, outward from `label` to `other`. */
static void each_border_face(Fit *f, void (*visit)(Fit *f, const uint32_t corner[3], uint16_t label, uint16_t other)) {
  for (size_t c = 0; c < f->mesh->tetrahedron_count; c++)
    for (int k = 0; k < 4; k++) {
      uint32_t across = f->neighbours[4 * c + (size_t)k];
      uint16_t label = (uint16_t)f->mesh->labels[c],
               other = across == UINT32_MAX ? 0 : (uint16_t)f->mesh->labels[across];
      if (label == other || (across != UINT32_MAX && label > other)) continue;
      uint32_t corner[3];
      for (int i = 0; i < 3; i++) corner[i] = f->mesh->tetrahedra[4 * c + spore_tetrahedron_faces[k][i]];
      visit(f, corner, label, other);
    }
}

static void note_labels(Fit *f, const uint32_t corner[3], uint16_t label, uint16_t other) {
  for (int i = 0; i < 3; i++) {
    add_label(f->border + corner[i], label);
    add_label(f->border + corner[i], other);
  }
}

/* Whether the neighbour has all labels of the vertex. Such neighbours pull the vertex along its border. */
static bool same_border(const Border *of, const Border *neighbour) {
  int shared = 0;
  for (int i = 0; i < of->count; i++)
    for (int j = 0; j < neighbour->count; j++) shared += of->label[i] == neighbour->label[j];
  return shared == of->count;
}

static void note_shape(Fit *f, const uint32_t corner[3], uint16_t label, uint16_t other) {
  SporeVec3 a = vertex(f, corner[0]), b = vertex(f, corner[1]), c = vertex(f, corner[2]);
  SporeVec3 area =
      spore_vec3_scale(other > label ? 0.5 : -0.5, spore_vec3_cross(spore_vec3_sub(b, a), spore_vec3_sub(c, a)));
  f->face_count++;
  f->area[label] += spore_vec3_length(area);
  f->area[other] += spore_vec3_length(area);
  for (int i = 0; i < 3; i++) {
    Border *border = f->border + corner[i];
    border->normal = spore_vec3_add(border->normal, area);
    for (int j = 1; j < 3; j++) {
      uint32_t next = corner[(i + j) % 3];
      if (!same_border(border, f->border + next)) continue;
      border->sum = spore_vec3_add(border->sum, vertex(f, next));
      border->neighbours++;
    }
  }
}

/* Share of the higher label minus the share of the lower one. If the lower label is nothing: share of all organs minus
 * the share of nothing. */
static double balance(const Fit *f, const Border *border, SporeVec3 p) {
  SporeLabelShare shares[SPORE_LABEL_MOST];
  int count = spore_label_field_shares(f->field, p, shares);
  double sum = 0;
  for (int i = 0; i < count; i++) {
    bool lower = shares[i].label == border->label[0],
         higher = shares[i].label == border->label[1] || (border->label[0] == 0 && !lower);
    sum += higher ? (double)shares[i].share : lower ? -(double)shares[i].share : 0;
  }
  return sum;
}

/* Signed distance along the unit vector n to the nearest place where the share of the higher label overtakes the
 * share of the lower one; 0: none near. */
static double way_to_border(const Fit *f, const Border *border, SporeVec3 p, SporeVec3 n) {
  double step = REACH * f->edge / STEPS;
  for (int s = 0; s < STEPS; s++)
    for (int side = 0; side < 2; side++) {
      double low = side ? -(s + 1) * step : s * step, high = low + step;
      if (!(balance(f, border, spore_vec3_add_scaled(p, low, n)) <= 0) ||
          !(balance(f, border, spore_vec3_add_scaled(p, high, n)) > 0))
        continue;
      for (int b = 0; b < BISECTIONS; b++) {
        double middle = 0.5 * (low + high);
        if (balance(f, border, spore_vec3_add_scaled(p, middle, n)) <= 0) low = middle;
        else high = middle;
      }
      return 0.5 * (low + high);
    }
  return 0;
}

/* Adjusts the outward shift of each label's border to the label's error in volume. */
static void adjust_growth(Fit *f) {
  for (int label = 0; label < 65536; label++) f->volume[label] = 0;
  for (size_t c = 0; c < f->mesh->tetrahedron_count; c++) {
    const uint32_t *v = f->mesh->tetrahedra + 4 * c;
    f->volume[f->mesh->labels[c]] +=
        spore_vec3_volume(vertex(f, v[0]), vertex(f, v[1]), vertex(f, v[2]), vertex(f, v[3])) / 6;
  }
  double most = MOST_GROWTH * f->edge;
  for (int label = 1; label < 65536; label++) {
    if (!(f->area[label] > 0)) continue;
    double growth = f->growth[label] + FEEDBACK * (f->wanted[label] - f->volume[label]) / f->area[label];
    f->growth[label] = fmax(-most, fmin(most, growth));
  }
}

/* Largest absolute cosine of a dihedral angle; over 1: the cell is inverted. */
static double flatness(const Fit *f, uint32_t cell) {
  const uint32_t *v = f->mesh->tetrahedra + 4 * (size_t)cell;
  SporeVec3 p[4], normal[4];
  for (int k = 0; k < 4; k++) p[k] = vertex(f, v[k]);
  if (!(spore_vec3_volume(p[0], p[1], p[2], p[3]) > 0)) return 2;
  for (int k = 0; k < 4; k++) {
    SporeVec3 a = p[spore_tetrahedron_faces[k][0]];
    normal[k] = spore_vec3_normalise(spore_vec3_cross(spore_vec3_sub(p[spore_tetrahedron_faces[k][1]], a),
                                                      spore_vec3_sub(p[spore_tetrahedron_faces[k][2]], a)),
                                     spore_vec3(0, 0, 0));
  }
  double most = 0;
  for (int i = 0; i < 4; i++)
    for (int j = i + 1; j < 4; j++) most = fmax(most, fabs(spore_vec3_dot(normal[i], normal[j])));
  return most;
}

static double star_flatness(const Fit *f, uint32_t v) {
  double most = 0;
  for (uint32_t i = f->start[v]; i < f->start[v + 1]; i++) most = fmax(most, flatness(f, f->star[i]));
  return most;
}

/* Moves a vertex toward `to`, in the largest tried step after which the cells around it are within FLATTEST, or no
 * flatter than before. strict: no flatter than before. */
static void move(Fit *f, uint32_t v, SporeVec3 to, bool strict) {
  SporeVec3 from = vertex(f, v);
  double before = star_flatness(f, v), limit = strict ? before : fmax(before, FLATTEST);
  for (double part = 1; part > 0.1; part *= 0.5) {
    spore_vec3_store(f->mesh->vertices + 3 * (size_t)v, spore_vec3_add_scaled(from, part, spore_vec3_sub(to, from)));
    if (star_flatness(f, v) <= limit) return;
  }
  spore_vec3_store(f->mesh->vertices + 3 * (size_t)v, from);
}

/* Unit gradient of the balance, from the lower label to the higher one; 0: the labels are not near. */
static SporeVec3 way_between(const Fit *f, const Border *pair, SporeVec3 p) {
  const double h = GRADIENT * f->edge;
  const SporeVec3 step[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
  double d[3];
  for (int k = 0; k < 3; k++)
    d[k] = balance(f, pair, spore_vec3_add(p, step[k])) - balance(f, pair, spore_vec3_sub(p, step[k]));
  return spore_vec3_normalise(spore_vec3_load(d), spore_vec3(0, 0, 0));
}

/* Place near the line or corner where all labels of a vertex meet. The place moves toward the border of each pair of
 * labels in turn. */
static SporeVec3 meeting_place(const Fit *f, const Border *border, SporeVec3 p) {
  for (int turn = 0; turn < MEETINGS; turn++)
    for (int i = 0; i < border->count; i++)
      for (int j = 0; j < i; j++) {
        const Border pair = {.label = {border->label[j], border->label[i]}, .count = 2};
        SporeVec3 n = way_between(f, &pair, p);
        p = spore_vec3_add_scaled(p, 0.5 * way_to_border(f, &pair, p, n), n);
      }
  return p;
}

static void move_on_border(Fit *f, uint32_t v, const Border *border) {
  SporeVec3 p = vertex(f, v), along = {0, 0, 0}, n = spore_vec3_normalise(border->normal, spore_vec3(0, 0, 0));
  if (border->neighbours > 0)
    along = spore_vec3_scale(ALONG, spore_vec3_sub(spore_vec3_scale(1 / border->neighbours, border->sum), p));
  if (border->count > 2) { /* the line where three organs meet, or their common corner */
    move(f, v, meeting_place(f, border, spore_vec3_add(p, along)), false);
    return;
  }
  SporeVec3 q = spore_vec3_add(p, spore_vec3_add_scaled(along, -spore_vec3_dot(along, n), n));
  double way = way_to_border(f, border, q, n) + f->growth[border->label[0]] - f->growth[border->label[1]];
  move(f, v, spore_vec3_add_scaled(q, way, n), false);
}

static void move_inside(Fit *f, uint32_t v) {
  SporeVec3 sum = {0, 0, 0};
  double count = 0;
  for (uint32_t i = f->start[v]; i < f->start[v + 1]; i++)
    for (int k = 0; k < 4; k++) {
      uint32_t other = f->mesh->tetrahedra[4 * (size_t)f->star[i] + (size_t)k];
      if (other == v) continue;
      sum = spore_vec3_add(sum, vertex(f, other));
      count++;
    }
  if (count > 0) move(f, v, spore_vec3_scale(1 / count, sum), true);
}

static bool run(Fit *f, const SporeProgress *progress, SporeError *error) {
  each_border_face(f, note_labels);
  for (int round = 0; round < ROUNDS; round++) {
    for (size_t v = 0; v < f->mesh->vertex_count; v++) {
      f->border[v].normal = f->border[v].sum = spore_vec3(0, 0, 0);
      f->border[v].neighbours = 0;
    }
    for (int label = 0; label < 65536; label++) f->area[label] = 0;
    f->face_count = 0;
    each_border_face(f, note_shape);
    if (round > 2) adjust_growth(f); /* from round 3 on, when the borders are near their places */
    for (uint32_t v = 0; v < f->mesh->vertex_count; v++) {
      double done = round + (double)v / (double)f->mesh->vertex_count;
      if (v % REPORT_VERTICES == 0 && !spore_progress_step(progress, done / ROUNDS, _("fitting the borders"), error))
        return false;
      if (f->border[v].count) move_on_border(f, v, f->border + v);
      else move_inside(f, v);
    }
  }
  return true;
}

/* Points of the borders. */

static void add_point(SporeLabelPoints *points, const uint32_t host[3], const Border *between, SporeVec3 normal,
                      SporeVec3 place) {
  size_t at = points->points.count++;
  memcpy(points->points.hosts + 3 * at, host, 3 * sizeof *host);
  spore_vec3_store(points->points.places + 3 * at, place);
  spore_vec3_store(points->normal + 3 * at, normal);
  points->between[2 * at] = between->label[0];
  points->between[2 * at + 1] = between->label[between->count == 2];
}

/* Whether the pair dominates the place: the border of two labels ends where other labels begin. Always true against
 * nothing. */
static bool is_between(const Fit *f, const Border *pair, SporeVec3 p) {
  SporeLabelShare shares[SPORE_LABEL_MOST];
  int count = spore_label_field_shares(f->field, p, shares);
  double sum = 0;
  for (int i = 0; i < count; i++)
    if (shares[i].label == pair->label[0] || shares[i].label == pair->label[1]) sum += (double)shares[i].share;
  return pair->label[0] == 0 || sum > OF_A_PAIR;
}

static void note_points(Fit *f, const uint32_t corner[3], uint16_t label, uint16_t other) {
  SporeVec3 p[3], n, middle = {0, 0, 0};
  const Border pair = {.label = {label < other ? label : other, label < other ? other : label}, .count = 2};
  for (int k = 0; k < 3; k++) middle = spore_vec3_add_scaled(middle, 1.0 / 3, p[k] = vertex(f, corner[k]));
  n = spore_vec3_normalise(spore_vec3_cross(spore_vec3_sub(p[1], p[0]), spore_vec3_sub(p[2], p[0])),
                           spore_vec3(0, 0, 0));
  if (other < label) n = spore_vec3_scale(-1, n);
  SporeVec3 place = spore_vec3_add_scaled(middle, way_to_border(f, &pair, middle, n), n);
  add_point(f->points, corner, &pair, n, is_between(f, &pair, place) ? place : middle);
  for (int k = 0; k < 3; k++) { /* on the line where three labels meet, once for each face there */
    const Border *border = f->border + corner[k];
    if (border->count < 3 || !same_border(border, f->border + corner[(k + 1) % 3])) continue;
    SporeVec3 half = spore_vec3_scale(0.5, spore_vec3_add(p[k], p[(k + 1) % 3]));
    add_point(f->points, corner, border, n, meeting_place(f, border, half));
  }
}

static bool make_points(Fit *f) {
  SporeLabelPoints *made = f->points;
  size_t most = 4 * f->face_count; /* a face and its three sides */
  *made =
      (SporeLabelPoints){.between = SPORE_NEW_ARRAY(uint16_t, 2 * most), .normal = SPORE_NEW_ARRAY(double, 3 * most)};
  made->points.places = SPORE_NEW_ARRAY(double, 3 * most);
  made->points.hosts = SPORE_NEW_ARRAY(uint32_t, 3 * most);
  made->points.off = SPORE_NEW_ARRAY(double, most);
  if (!made->between || !made->normal || !made->points.places || !made->points.hosts || !made->points.off) return false;
  each_border_face(f, note_points);
  return true;
}

void spore_label_points_clear(SporeLabelPoints *points) {
  spore_skin_points_clear(&points->points);
  spore_free(points->between);
  spore_free(points->normal);
  *points = (SporeLabelPoints){0};
}

bool spore_label_fit(const SporeLabelField *field, SporeTetrahedralMesh *mesh, double edge, const double *volumes,
                     SporeLabelPoints *points, const SporeProgress *progress, SporeError *error) {
  Fit f = {.field = field,
           .mesh = mesh,
           .edge = edge,
           .points = points,
           .wanted = volumes,
           .volume = SPORE_NEW_ARRAY(double, 65536),
           .area = SPORE_NEW_ARRAY(double, 65536),
           .growth = SPORE_NEW_ARRAY(double, 65536),
           .border = SPORE_NEW_ARRAY(Border, mesh->vertex_count)};
  bool ready = f.volume && f.area && f.growth && f.border && spore_tetrahedral_mesh_neighbours(mesh, &f.neighbours) &&
               make_stars(&f);
  bool done = !ready || run(&f, progress, error);
  if (!ready || (done && points && !make_points(&f))) done = spore_generate_no_memory(error);
  if (!done && points) spore_label_points_clear(points);
  spore_free(f.neighbours);
  spore_free(f.volume);
  spore_free(f.area);
  spore_free(f.growth);
  spore_free(f.border);
  spore_free(f.start);
  spore_free(f.star);
  return done;
}
