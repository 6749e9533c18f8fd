/* Whether balls cover a solid, without sampling. The surface: a triangle whose corners lie in one ball lies in that
 * ball, so triangles are divided until each piece lies in one ball. The inside: once the surface is covered, the
 * uncovered rest consists of closed hollows between balls. The balls bulge into a hollow, so a point of the hollow's
 * wall on fewer than three spheres is not an extreme point of the hollow. So a hollow lies in the convex hull of its
 * corners, each on three spheres. There is no hollow if each such corner inside the solid lies in another ball. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/spheres/bounding.h"

#define FINEST 4e-4   /* of the diagonal: longest edge of the smallest pieces */
#define TOUCHING 1e-9 /* of the diagonal: corners nearer than this to the outside of a ball count as free */
#define HOLLOW_ROUNDS 64

typedef struct Piece {
  SporeVec3 a, b, c;
} Piece;

typedef enum Aim { CHECK, LIST, GROW } Aim;

typedef struct Cover {
  const SporeSolid *solid;
  SporeBalls *balls;
  Aim target;
  uint32_t *near;          /* balls that reach the triangle, those near the piece first; later scratch for hollows */
  double finest, touching; /* m */
  double *gaps;            /* gap_count x 3: middles of pieces that no ball contains */
  size_t gap_count, gap_capacity, gaps_most;
  bool failed; /* no memory */
} Cover;

/* Radius at which ball i contains the piece. */
static double radius_for(const SporeBalls *balls, size_t i, const Piece *p) {
  SporeVec3 c = spore_balls_centre(balls, i);
  return fmax(spore_vec3_distance(p->a, c), fmax(spore_vec3_distance(p->b, c), spore_vec3_distance(p->c, c)));
}

/* The ball of the `count` listed ones (list NULL: all) that needs the least growth to contain the piece. *growth: the
 * growth; not above 0: the ball contains the piece. */
static size_t least_growth(const SporeBalls *balls, const uint32_t *list, size_t count, const Piece *piece,
                           double *growth) {
  size_t best = 0;
  *growth = HUGE_VAL;
  for (size_t k = 0; k<count && * growth> 0; k++) {
    size_t i = list ? list[k] : k;
    double needed = radius_for(balls, i, piece) - balls->r[i] * (1 - 1e-12);
    if (needed < *growth) *growth = needed, best = i;
  }
  return best;
}

/* Length of the longest edge. Rotates the corners so that this edge is ab. */
static double longest_edge(Piece *p) {
  double ab = spore_vec3_distance(p->a, p->b), bc = spore_vec3_distance(p->b, p->c),
         ca = spore_vec3_distance(p->c, p->a);
  if (bc >= ab && bc >= ca) *p = (Piece){p->b, p->c, p->a};
  else if (ca >= ab) *p = (Piece){p->c, p->a, p->b};
  return fmax(ab, fmax(bc, ca));
}

static bool add_gap(Cover *cover, const Piece *piece) {
  if (cover->gap_count == cover->gaps_most) return false;
  double *gaps = spore_room_for_one(cover->gaps, cover->gap_count, &cover->gap_capacity, 1024, 3 * sizeof *gaps);
  cover->failed |= !gaps;
  if (!gaps) return false;
  cover->gaps = gaps;
  SporeVec3 sum = spore_vec3_add(piece->a, spore_vec3_add(piece->b, piece->c));
  spore_vec3_store(cover->gaps + 3 * cover->gap_count++, spore_vec3_scale(1. / 3, sum));
  return true;
}

/* Puts the listed balls that can matter to the piece or to a part of it first; returns their number. The others would
 * have to grow by more than twice the edge. */
static size_t keep_near(Cover *cover, const Piece *piece, double edge, size_t near_count) {
  size_t kept = 0;
  for (size_t k = 0; k < near_count; k++) {
    uint32_t i = cover->near[k];
    if (spore_vec3_distance(piece->a, spore_balls_centre(cover->balls, i)) > cover->balls->r[i] + 2 * edge) continue;
    cover->near[k] = cover->near[kept];
    cover->near[kept++] = i;
  }
  return kept;
}

/* Divides until one ball contains each piece. A piece that is small relative to its distance from all balls is not
 * divided further. near_count: of the listed balls, those that can matter. False: no ball contains some piece and no
 * ball may grow, the list is full, or there is no memory. */
static bool cover_piece(Cover *cover, Piece piece, size_t near_count) {
  double growth, edge = longest_edge(&piece);
  near_count = keep_near(cover, &piece, edge, near_count);
  size_t ball = least_growth(cover->balls, cover->near, near_count, &piece, &growth);
  if (growth <= 0) return true;
  if (edge <= cover->finest || growth > 2 * edge) {
    if (cover->target == CHECK) return false;
    if (cover->target == LIST) return add_gap(cover, &piece);
    if (growth > edge) ball = least_growth(cover->balls, NULL, cover->balls->count, &piece, &growth);
    if (growth > 0) cover->balls->r[ball] = radius_for(cover->balls, ball, &piece) * (1 + 4e-12);
    return true;
  }
  SporeVec3 middle = spore_vec3_scale(0.5, spore_vec3_add(piece.a, piece.b));
  return cover_piece(cover, (Piece){piece.a, middle, piece.c}, near_count) &&
         cover_piece(cover, (Piece){middle, piece.b, piece.c}, near_count);
}

static bool cover_surface(Cover *cover) {
  const SporeTriangleMesh *mesh = &cover->solid->mesh;
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    SporeVec3 p[3];
    for (int k = 0; k < 3; k++) p[k] = spore_vec3_load(mesh->vertices + 3 * (size_t)mesh->triangles[3 * t + k]);
    Piece piece = {p[0], p[1], p[2]};
    double edge = longest_edge(&piece);
    size_t near = 0;
    for (size_t i = 0; i < cover->balls->count; i++)
      if (spore_vec3_distance(p[0], spore_balls_centre(cover->balls, i)) <= cover->balls->r[i] + edge)
        cover->near[near++] = (uint32_t)i;
    if (!cover_piece(cover, piece, near)) return false;
  }
  return true;
}

/* The two points that lie on three spheres; false: there are none. */
static bool meeting_points(const SporeBalls *balls, size_t i, size_t j, size_t k, SporeVec3 meeting[2]) {
  SporeVec3 a = spore_balls_centre(balls, i), ab = spore_vec3_sub(spore_balls_centre(balls, j), a),
            ac = spore_vec3_sub(spore_balls_centre(balls, k), a), n = spore_vec3_cross(ab, ac);
  double ri = balls->r[i] * balls->r[i], nn = spore_vec3_dot(n, n);
  double p = 0.5 * (spore_vec3_dot(ab, ab) + ri - balls->r[j] * balls->r[j]);
  double q = 0.5 * (spore_vec3_dot(ac, ac) + ri - balls->r[k] * balls->r[k]);
  if (!(nn > 0)) return false;
  /* x with x . ab = p, x . ac = q, x . n = 0 */
  SporeVec3 x = spore_vec3_scale(1 / nn, spore_vec3_add(spore_vec3_scale(p, spore_vec3_cross(ac, n)),
                                                        spore_vec3_scale(q, spore_vec3_cross(n, ab))));
  double height = (ri - spore_vec3_dot(x, x)) / nn;
  if (!(height >= 0)) return false;
  SporeVec3 foot = spore_vec3_add(a, x);
  meeting[0] = spore_vec3_add_scaled(foot, sqrt(height), n);
  meeting[1] = spore_vec3_add_scaled(foot, -sqrt(height), n);
  return true;
}

static bool is_free(const Cover *cover, SporeVec3 p, const uint32_t *near, size_t near_count, size_t j, size_t k) {
  for (size_t l = 0; l < near_count; l++)
    if (near[l] != j && near[l] != k &&
        spore_vec3_distance(p, spore_balls_centre(cover->balls, near[l])) < cover->balls->r[near[l]] - cover->touching)
      return false;
  return spore_bvh_inside(cover->solid->bvh, p);
}

/* A corner of a hollow: on the spheres ball[0 .. 2]. */
typedef struct Corner {
  SporeVec3 place;
  uint32_t ball[3];
  uint32_t hollow; /* a corner of the same hollow, or itself */
} Corner;

typedef struct Corners {
  Corner *corner;
  size_t count, capacity;
  bool failed;
} Corners;

static void add_corner(Corners *corners, SporeVec3 place, size_t i, size_t j, size_t k) {
  Corner *corner = spore_room_for_one(corners->corner, corners->count, &corners->capacity, 64, sizeof *corner);
  corners->failed |= !corner;
  if (!corner) return;
  corners->corner = corner;
  corners->corner[corners->count] = (Corner){place, {(uint32_t)i, (uint32_t)j, (uint32_t)k}, (uint32_t)corners->count};
  corners->count++;
}

/* Corners on ball i and two later ones. */
static void find_corners(const Cover *cover, size_t i, Corners *corners) {
  const SporeBalls *balls = cover->balls;
  size_t near = 0;
  for (size_t j = 0; j < balls->count; j++)
    if (j != i &&
        spore_vec3_distance(spore_balls_centre(balls, i), spore_balls_centre(balls, j)) < balls->r[i] + balls->r[j])
      cover->near[near++] = (uint32_t)j;
  for (size_t a = 0; a < near; a++)
    for (size_t b = a + 1; cover->near[a] > i && b < near; b++) {
      size_t j = cover->near[a], k = cover->near[b];
      SporeVec3 meeting[2];
      if (spore_vec3_distance(spore_balls_centre(balls, j), spore_balls_centre(balls, k)) >=
              balls->r[j] + balls->r[k] ||
          !meeting_points(balls, i, j, k, meeting))
        continue;
      for (int side = 0; side < 2; side++)
        if (is_free(cover, meeting[side], cover->near, near, j, k)) add_corner(corners, meeting[side], i, j, k);
    }
}

static uint32_t hollow_of(const Corners *corners, uint32_t c) {
  while (corners->corner[c].hollow != c) c = corners->corner[c].hollow;
  return c;
}

static int common_balls(const Corner *a, const Corner *b) {
  int common = 0;
  for (int s = 0; s < 3; s++)
    for (int t = 0; t < 3; t++) common += a->ball[s] == b->ball[t];
  return common;
}

/* Joins corners with two common spheres into one hollow, as an edge of a hollow lies on two spheres. */
static void join_corners(Corners *corners) {
  for (uint32_t a = 0; a < corners->count; a++)
    for (uint32_t b = a + 1; b < corners->count; b++)
      if (common_balls(&corners->corner[a], &corners->corner[b]) >= 2)
        corners->corner[hollow_of(corners, b)].hollow = hollow_of(corners, a);
}

/* Grows the ball that needs the least growth to contain all corners of the hollow. */
static void fill_hollow(Cover *cover, const Corners *corners, uint32_t hollow) {
  double least = HUGE_VAL, radius = 0;
  size_t best = 0;
  for (size_t i = 0; i < cover->balls->count; i++) {
    double farthest = 0;
    for (uint32_t c = 0; c < corners->count; c++)
      if (hollow_of(corners, c) == hollow)
        farthest = fmax(farthest, spore_vec3_distance(corners->corner[c].place, spore_balls_centre(cover->balls, i)));
    double growth = farthest - cover->balls->r[i];
    if (growth < least) least = growth, best = i, radius = farthest;
  }
  cover->balls->r[best] = fmax(cover->balls->r[best], radius) + 10 * cover->touching;
}

/* False: hollows are left, or there is no memory. */
static bool cover_hollows(Cover *cover) {
  Corners corners = {0};
  bool left = true;
  for (int round = 0; left && round < HOLLOW_ROUNDS; round++) {
    corners.count = 0;
    for (size_t i = 0; i < cover->balls->count && !corners.failed; i++) find_corners(cover, i, &corners);
    left = corners.count || corners.failed;
    if (cover->target == CHECK || corners.failed) break;
    join_corners(&corners);
    for (uint32_t c = 0; c < corners.count; c++)
      if (hollow_of(&corners, c) == c) fill_hollow(cover, &corners, c);
  }
  spore_free(corners.corner);
  cover->failed = corners.failed;
  return !left;
}

/* False: no memory. */
static bool open_cover(Cover *cover, const SporeSolid *solid, SporeBalls *balls, Aim target, double finest) {
  *cover = (Cover){.solid = solid,
                   .balls = balls,
                   .target = target,
                   .near = SPORE_NEW_ARRAY(uint32_t, balls->count),
                   .finest = finest * solid->diagonal,
                   .touching = TOUCHING * solid->diagonal};
  cover->failed = !cover->near;
  return cover->near;
}

bool spore_balls_cover(const SporeSolid *solid, const SporeBalls *balls) {
  SporeBalls looked_at = *balls; /* the balls do not grow */
  Cover cover;
  bool covered = open_cover(&cover, solid, &looked_at, CHECK, FINEST) && cover_surface(&cover) && cover_hollows(&cover);
  spore_free(cover.near);
  return covered;
}

bool spore_balls_grow_to_cover(const SporeSolid *solid, SporeBalls *balls) {
  Cover cover;
  if (open_cover(&cover, solid, balls, GROW, FINEST) && cover_surface(&cover)) cover_hollows(&cover);
  spore_free(cover.near);
  return !cover.failed;
}

bool spore_balls_gaps(const SporeSolid *solid, const SporeBalls *balls, double margin, double finest, size_t most,
                      double **points, size_t *count) {
  SporeBalls smaller;
  Cover cover;
  *points = NULL, *count = 0;
  if (!spore_balls_create(&smaller, balls->count)) return false;
  spore_balls_copy(&smaller, balls);
  for (size_t i = 0; i < balls->count; i++) smaller.r[i] -= margin * solid->diagonal;
  bool done = open_cover(&cover, solid, &smaller, LIST, finest), whole;
  cover.gaps_most = most;
  whole = done && cover_surface(&cover);
  while (done && !whole && !cover.failed) { /* too many gaps: larger pieces */
    cover.gap_count = 0;
    cover.finest *= 2;
    whole = cover_surface(&cover);
  }
  done = done && !cover.failed;
  spore_free(cover.near);
  spore_balls_clear(&smaller);
  *points = cover.gaps, *count = cover.gap_count;
  return done;
}
