/* From a voxel path to a smooth line: points move to the centroids of their sections, and the line is extended to
 * the ends of the organ. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/centreline/private.h"

#define SPACING 0.35    /* of points while the line is refined, in radii */
#define THIN 0.4        /* of the mean radius: least radius used for the spacing where the line is thinner */
#define ROUNDS 10       /* of centring and smoothing */
#define SMOOTHING 3.0   /* of a round: removes waves shorter than about 2 pi SMOOTHING^(1/4) points */
#define FOLLOWING 0.5   /* the same of the last rounds: tight turns are not cut */
#define LAST 4          /* rounds */
#define REACH 2.0       /* of a section, in radii */
#define MOVE 0.7        /* of the distance to the section's centroid */
#define END_DEPTH 0.35  /* of the radius: an end this near to the surface is extended straight to it */
#define CUT 3.0         /* radii of each end that are cut off and found again, at most */
#define MIDDLED 0.7     /* of the largest depth ahead */
#define STEERED 0.75    /* of the radius: least depth at which an extended end is centred */
#define BACK 4          /* points in each of the two pieces that give an end's direction */
#define HOOK 2.0        /* mean radii of each end within which a sharp bend is cut off */
#define BEND 3          /* points on either side between which a bend is measured */
#define SHARP 0.75      /* cosine of a sharp bend */
#define TIGHTEST 0.5    /* largest curvature of an extension, times the mean radius */
#define LONGEST_END 5.0 /* radii by which an end may be extended */

/* Points that are added one by one: x y z r. */
typedef struct Line {
  size_t count, capacity;
  double *points;
} Line;

static bool line_add(Line *line, SporeVec3 p, double radius) {
  double *points = spore_room_for_one(line->points, line->count, &line->capacity, 256, 4 * sizeof *points);
  if (!points) return false;
  line->points = points;
  double *point = line->points + 4 * line->count++;
  spore_vec3_store(point, p);
  point[3] = radius;
  return true;
}

static SporeVec3 at(const Line *line, size_t i) { return spore_vec3_load(line->points + 4 * i); }

static double depth_at(const SporeSolid *solid, SporeVec3 p) { return spore_bvh_depth(solid->bvh, p); }

static double mean_radius(const Line *line) {
  double sum = 0;
  for (size_t i = 0; i < line->count; i++) sum += line->points[4 * i + 3];
  return sum / (double)line->count;
}

/* Length of the piece before point i, in radii. Where the line is thinner than `least`, `least` is the radius. */
static double piece(const Line *line, size_t i, double least) {
  double radius = 0.5 * (fmax(line->points[4 * i - 1], least) + fmax(line->points[4 * i + 3], least));
  return spore_vec3_distance(at(line, i - 1), at(line, i)) / radius;
}

/* Resamples the line to points SPACING radii apart. The first and the last point are kept. */
static bool respace(Line *line) {
  double whole = 0, walked = 0, least = THIN * mean_radius(line);
  for (size_t i = 1; i < line->count; i++) whole += piece(line, i, least);
  size_t gaps = (size_t)fmax(4, ceil(whole / SPACING)), next = 1;
  Line spaced = {0};
  bool done = line_add(&spaced, at(line, 0), line->points[3]);
  for (size_t i = 1; done && i < line->count; i++) {
    SporeVec3 a = at(line, i - 1), b = at(line, i);
    double ra = line->points[4 * i - 1], rb = line->points[4 * i + 3], step = piece(line, i, least);
    for (; done && next < gaps && (double)next / (double)gaps * whole <= walked + step; next++) {
      double part = step > 0 ? ((double)next / (double)gaps * whole - walked) / step : 0;
      done = line_add(&spaced, spore_vec3_add_scaled(a, part, spore_vec3_sub(b, a)), ra + part * (rb - ra));
    }
    walked += step;
  }
  done = done && line_add(&spaced, at(line, line->count - 1), line->points[4 * line->count - 1]);
  spore_free(line->points);
  *line = spaced;
  return done;
}

/* Solves (W + stiffness D'D) x = W p in place for each of the `stride` columns of p, D the second difference: the
 * smoothing spline of Whittaker (1923). weight: count; band: scratch, 3 count. */
static void smooth_columns(double *p, size_t count, size_t columns, const double *weight, double stiffness,
                           double *band) {
  for (size_t i = 0; i < count; i++) {
    double *row = band + 3 * i; /* entries (i, i), (i, i + 1), (i, i + 2) */
    bool before = i >= 2, across = i >= 1 && i + 1 < count, after = i + 2 < count;
    row[0] = weight[i] + stiffness * ((before ? 1 : 0) + (across ? 4 : 0) + (after ? 1 : 0));
    row[1] = stiffness * ((across && i + 1 < count ? -2 : 0) + (after ? -2 : 0));
    row[2] = after ? stiffness : 0;
    for (size_t c = 0; c < columns; c++) p[4 * i + c] *= weight[i];
  }
  for (size_t i = 0; i < count; i++) { /* L D L' */
    double *row = band + 3 * i;
    for (size_t k = 1; k <= 2 && i + k < count; k++) {
      double factor = row[k] / row[0];
      double *other = band + 3 * (i + k);
      other[0] -= factor * row[k];
      if (k == 1) other[1] -= factor * row[2];
      for (size_t c = 0; c < columns; c++) p[4 * (i + k) + c] -= factor * p[4 * i + c];
    }
  }
  for (size_t i = count; i-- > 0;) {
    const double *row = band + 3 * i;
    for (size_t c = 0; c < columns; c++) {
      double sum = p[4 * i + c];
      if (i + 1 < count) sum -= row[1] * p[4 * (i + 1) + c];
      if (i + 2 < count) sum -= row[2] * p[4 * (i + 2) + c];
      p[4 * i + c] = sum / row[0];
    }
  }
}

/* Smooths positions; the two ends have the weight `end`. */
static bool smooth(Line *line, double stiffness, double end) {
  double *weight = SPORE_NEW_ARRAY(double, line->count), *band = SPORE_NEW_ARRAY(double, 3 * line->count);
  bool done = weight && band;
  for (size_t i = 0; done && i < line->count; i++) weight[i] = i == 0 || i + 1 == line->count ? end : 1;
  if (done) smooth_columns(line->points, line->count, 3, weight, stiffness, band);
  spore_free(weight);
  spore_free(band);
  return done;
}

static SporeVec3 direction_at(const Line *line, size_t i) {
  size_t before = i >= 2 ? i - 2 : 0, after = i + 2 < line->count ? i + 2 : line->count - 1;
  return spore_vec3_normalise(spore_vec3_sub(at(line, after), at(line, before)), spore_vec3(1, 0, 0));
}

/* Moves each point toward the centroid of its section. */
static void middle(Line *line, const SporeSolid *solid) {
  double *moved = line->points;
  SporeVec3 before = at(line, 0);
  for (size_t i = 0; i < line->count; i++) {
    SporeVec3 p = at(line, i), across;
    across = i == 0 ? direction_at(line, 0)
                    : spore_vec3_normalise(spore_vec3_sub(at(line, i + 1 < line->count ? i + 1 : i), before),
                                           spore_vec3(1, 0, 0));
    before = p;
    double depth = depth_at(solid, p);
    if (!(depth > 0)) continue;
    SporeVec3 middle_of = spore_section_middle(solid, p, across, REACH * depth);
    spore_vec3_store(moved + 4 * i, spore_vec3_add_scaled(p, MOVE, spore_vec3_sub(middle_of, p)));
    moved[4 * i + 3] = depth;
  }
}

static void turn_round(Line *line) {
  for (size_t i = 0; i < line->count / 2; i++)
    for (size_t k = 0; k < 4; k++) {
      double *a = line->points + 4 * i + k, *b = line->points + 4 * (line->count - 1 - i) + k, swap = *a;
      *a = *b, *b = swap;
    }
}

/* Direction at the end of the line, and its rate of change, 1/m: from two pieces of BACK points each. */
static SporeVec3 heading(const Line *line, SporeVec3 *turn) {
  size_t last = line->count - 1, step = last >= 2 * BACK ? BACK : last / 2;
  SporeVec3 a = spore_vec3_sub(at(line, last - step), at(line, last - 2 * step)),
            b = spore_vec3_sub(at(line, last), at(line, last - step));
  double length = 0.5 * (spore_vec3_length(a) + spore_vec3_length(b));
  SporeVec3 any = spore_vec3(1, 0, 0), now = spore_vec3_normalise(b, any);
  *turn = spore_vec3_scale(length > 0 ? 1 / length : 0, spore_vec3_sub(now, spore_vec3_normalise(a, now)));
  double most = TIGHTEST / mean_radius(line), sharp = spore_vec3_length(*turn);
  if (sharp > most) *turn = spore_vec3_scale(most / sharp, *turn);
  return spore_vec3_normalise(spore_vec3_add_scaled(now, 0.5 * length, *turn), now);
}

/* How far the line may continue from p along d: to the surface or, if nearer, to the section that contains `end`. */
static double way_left(const SporeSolid *solid, SporeVec3 p, SporeVec3 d, double reach, const double *end) {
  double left = spore_section_wall(solid, p, d, reach);
  if (end) left = fmin(left, spore_vec3_dot(spore_vec3_sub(spore_vec3_load(end), p), d));
  return left;
}

/* Extends the end of the line to the surface, or to the section that contains the end that was asked for. */
static bool lead_on(Line *line, const SporeSolid *solid, const double *end) {
  SporeVec3 turn, p = at(line, line->count - 1), d = heading(line, &turn);
  double radius = line->points[4 * line->count - 1], limit = LONGEST_END * radius;
  for (double gone = 0; gone < limit;) { /* the radius follows a taper */
    double step = SPACING * radius, left = way_left(solid, p, d, 4 * radius, end);
    if (left < (END_DEPTH + SPACING) * radius) {
      d = spore_vec3_normalise(spore_vec3_add_scaled(d, 0.5 * left, turn), d);
      double last = way_left(solid, p, d, 4 * radius, end) * (1 - 1e-3);
      return last <= 0.05 * radius || line_add(line, spore_vec3_add_scaled(p, last, d), END_DEPTH * radius);
    }
    SporeVec3 next = spore_vec3_add_scaled(p, step, d);
    d = spore_vec3_normalise(spore_vec3_add_scaled(d, step, turn), d);
    double depth = depth_at(solid, next);
    if (!(depth > 0)) return true;
    if (depth > STEERED * radius) { /* nearer to the end the sides do not give a reliable centroid */
      SporeVec3 middle_of = spore_section_middle(solid, next, d, 1.5 * radius);
      next = spore_vec3_add_scaled(next, 0.5, spore_vec3_sub(middle_of, next));
      d = spore_vec3_normalise(spore_vec3_add_scaled(d, 0.3 / step, spore_vec3_sub(next, p)), d);
    }
    p = next;
    gone += step;
    if (depth > STEERED * radius) radius = depth;
    if (!line_add(line, p, fmax(depth, END_DEPTH * radius))) return false;
  }
  return true;
}

static bool lead_on_both(Line *line, const SporeSolid *solid, const SporeCentrelineOptions *options) {
  for (int side = 1; side >= 0; side--) {
    if (!lead_on(line, solid, options->ends_given ? options->ends[side] : NULL)) return false;
    turn_round(line);
  }
  return true;
}

/* Largest radius of the points from `first` on, within a length of `reach`. */
static double widest(const Line *line, size_t first, double reach) {
  double most = 0, gone = 0;
  for (size_t i = first; i < line->count && gone <= reach; i++) {
    most = fmax(most, line->points[4 * i + 3]);
    if (i + 1 < line->count) gone += spore_vec3_distance(at(line, i), at(line, i + 1));
  }
  return most;
}

/* First point at which the line is in the middle of the organ: the depth ahead is not much larger, or CUT radii are
 * passed. Before this point the line may run along a wall or come out of a corner. */
static size_t end_of_cap(const Line *line) {
  double gone = 0, usual = mean_radius(line);
  for (size_t i = 0; i + 1 < line->count; i++) {
    double depth = line->points[4 * i + 3], ahead = widest(line, i, fmax(4 * depth, 2 * usual));
    if (gone >= ahead && (depth > MIDDLED * ahead || gone >= CUT * ahead)) return i;
    gone += spore_vec3_distance(at(line, i), at(line, i + 1));
  }
  return line->count - 1;
}

void spore_centreline_set_radii(const SporeSolid *solid, SporeCurve *curve) {
  Line line = {curve->count, curve->count, curve->points};
  for (size_t i = 0; i < line.count; i++) {
    double depth = depth_at(solid, at(&line, i));
    if (depth > 0) line.points[4 * i + 3] = depth;
  }
  for (int side = 0; side < 2; side++) {
    size_t inner = end_of_cap(&line);
    double least = END_DEPTH * line.points[4 * inner + 3];
    for (size_t i = 0; i < inner; i++) line.points[4 * i + 3] = fmax(line.points[4 * i + 3], least);
    turn_round(&line);
  }
}

/* Last point that is at most `reach` along the line after point `from`. */
static size_t point_after(const Line *line, size_t from, double reach) {
  double gone = 0;
  while (from + 1 < line->count && (gone += spore_vec3_distance(at(line, from), at(line, from + 1))) <= reach) from++;
  return from;
}

/* Drops the points before a sharp bend near the beginning: there the path came out of the rim of an open lumen. */
static void cut_hook(Line *line) {
  double usual = mean_radius(line);
  size_t last = point_after(line, 0, HOOK * usual), hook = 0;
  for (size_t i = 1; i < last && last < line->count / 3; i++) {
    size_t bend = point_after(line, i, 0.5 * usual), after = point_after(line, bend, usual);
    SporeVec3 back = spore_vec3_sub(at(line, bend), at(line, i - 1)),
              on = spore_vec3_sub(at(line, after), at(line, bend));
    if (spore_vec3_dot(back, on) < SHARP * spore_vec3_length(back) * spore_vec3_length(on)) hook = bend;
  }
  line->count -= hook;
  memmove(line->points, line->points + 4 * hook, 4 * line->count * sizeof *line->points);
}

/* Number of points at a given end that are nearer to the end than to the surface. */
static size_t end_given(const Line *line) {
  double gone = 0;
  for (size_t i = 0; i + 1 < line->count; i++) {
    if (gone >= line->points[4 * i + 3]) return i;
    gone += spore_vec3_distance(at(line, i), at(line, i + 1));
  }
  return 0;
}

/* The centres of the path's voxels, without the ends. At the ends the path leaves the middle for the outermost
 * corner; they are found again. */
static bool take_way(Line *line, const SporeVoxelTube *tube, const SporeVoxelPath *path, bool given) {
  for (size_t i = 0; i < path->count; i++)
    if (!line_add(line, spore_voxel_middle(tube, path->voxel[i]), tube->depth[path->voxel[i]])) return false;
  for (int side = 0; side < 2; side++) {
    size_t cap = given ? end_given(line) : end_of_cap(line), most = path->count / 4;
    cap = cap < most ? cap : most;
    line->count -= cap;
    memmove(line->points, line->points + 4 * cap, 4 * line->count * sizeof *line->points);
    turn_round(line);
  }
  return true;
}

bool spore_centreline_refine(const SporeSolid *solid, const SporeVoxelTube *tube, const SporeVoxelPath *path,
                             const SporeCentrelineOptions *options, SporeCurve *curve,
                             const SporeProgressPart *progress, SporeError *error) {
  Line line = {0};
  *curve = (SporeCurve){0};
  bool room = take_way(&line, tube, path, options->ends_given), going = true;
  for (int round = 0; room && going && round < ROUNDS; round++) {
    going = spore_progress_part(progress, (double)round / ROUNDS, _("middling the line"), error);
    room = respace(&line);
    if (room) middle(&line, solid);
    room = room && smooth(&line, round < ROUNDS - LAST ? SMOOTHING : FOLLOWING, 1);
    for (int side = 0; room && !options->ends_given && side < 2; side++) {
      cut_hook(&line);
      turn_round(&line);
    }
    const SporeProgress *whole = progress->whole;
    if (room && whole && whole->show) whole->show(whole->data, line.points, line.count);
  }
  room = room && going && lead_on_both(&line, solid, options) && respace(&line) && smooth(&line, 2, 1e3);
  bool done = going && (room || spore_generate_no_memory(error)) && spore_curve_allocate(curve, line.count, error);
  if (done) {
    memcpy(curve->points, line.points, 4 * line.count * sizeof *line.points);
    spore_centreline_set_radii(solid, curve);
  }
  spore_free(line.points);
  return done;
}
