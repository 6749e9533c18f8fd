/* Finds a mesh with the wanted number of cells and the least distance to the surface. Trial meshes are made and
 * measured. The size follows a secant iteration on the logarithm of the number of cells. Cells are refined where a mesh
 * is too far from the surface. */
#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/generate/common/common.h"
#include "core/generate/tetrahedra/private.h"
#include "core/mesh/common.h"

#define MOST_TRIES 12
#define MOST_REFINEMENTS 5
#define AIM 0.7 /* of the tolerance: the wanted distance of rough meshes */
#define SAMPLES 10000
#define TURNS 4           /* of moving the boundary */
#define GOAL 14           /* degrees, for the least angle */
#define LEAST_VOLUME 0.75 /* of the surface's: a mesh below has lost a part thinner than its cells */
#define USUAL_SLOPE 2.8   /* fall of log(number of cells) for each unit of log(size) */
#define EDGE_SCALE 0.7    /* circumradius bound of cells whose edges have length 1 */
#define NEAR_COUNT (3 * SPORE_TETRAHEDRA_COUNT)
#define HOPELESS 2.5 /* of the tolerance: too far, with the wanted cells after two refinements, */
#define MANY 2.0     /* or with this many times the wanted cells before */

typedef struct {
  SporeTetrahedraWork *work;
  const SporeTriangleMesh *surface; /* the surface that is meshed */
  SporeBvh *tree;                   /* of the surface */
  double *points, *samples;         /* of the surface, of the mesh */
  SporeSizingPlan plan;
  double volume; /* enclosed by the surface */
  double scale, made_scale, known_scale, known_count, slope;
  int refinements, tries_left;
  double *kept, *best; /* relative sizes of the plan: of the last mesh, of the best mesh */
  size_t nodes;
} Fit;

/* With `change`, refines the plan at points that are too far. Returns the largest distance. */
static double refine_at(Fit *fit, const SporeBvh *tree, const double *points, size_t count, bool change) {
  const double aim = AIM * fit->work->options.tolerance;
  double most = 0;
  for (size_t i = 0; i < count; i++) {
    SporeVec3 p = spore_vec3_load(points + 3 * i);
    double distance = spore_bvh_distance(tree, p, NULL, NULL);
    most = fmax(most, distance);
    if (!change || distance < aim) continue;
    double p_[3] = {p.x, p.y, p.z};
    double here = spore_sizing_at(&fit->plan.grid, p_) / fit->scale;
    spore_sizing_plan_refine(&fit->plan, p, here * fmin(fmax(sqrt(aim / distance), 0.5), 0.85));
  }
  return most;
}

/* Largest distance between mesh and surface. With `change`, the plan is refined where the distance is too large. Below
 * 0 with *error: failed. */
static double distance_of(Fit *fit, const SporeTetrahedralMesh *mesh, bool change, SporeError *error) {
  SporeTriangleMesh boundary = {.vertex_count = mesh->vertex_count, .vertices = mesh->vertices};
  double most = -1;
  SporeBvh *tree = NULL;
  if (!spore_tetrahedral_mesh_boundary(mesh, &boundary.triangles, &boundary.triangle_count))
    spore_mesh_no_memory(error);
  else if ((tree = spore_bvh_create(&boundary, error))) {
    spore_surface_samples(&boundary, SAMPLES, fit->samples, NULL);
    most = refine_at(fit, tree, fit->points, SAMPLES, change);
    most = fmax(most, refine_at(fit, fit->tree, fit->samples, SAMPLES, change));
  }
  spore_bvh_free(tree);
  spore_free(boundary.triangles);
  return most;
}

static gboolean mesh_at(Fit *fit, double scale, SporeTetrahedraFinish finish, SporeTetrahedralMesh *mesh,
                        GError **error) {
  const SporeTetrahedraOptions *options = &fit->work->options;
  double expected = options->cells ? (double)options->cells : fit->volume / (0.12 * pow(options->size, 3));
  spore_sizing_plan_scale(&fit->plan, scale);
  return spore_tetrahedra_refine(fit->work, fit->surface, &fit->plan.grid, finish, (size_t)(3 * expected) + 10000, mesh,
                                 error);
}

/* Computes the next size from the number of cells that the last size gave. */
static void step(Fit *fit, double count) {
  double gap = log(count / (double)fit->work->options.cells);
  if (fit->known_scale > 0 && fabs(log(fit->scale / fit->known_scale)) > 1e-3)
    fit->slope = log(count / fit->known_count) / log(fit->scale / fit->known_scale);
  fit->slope = fmin(fmax(fit->slope, -4), -1);
  fit->known_scale = fit->scale;
  fit->known_count = count;
  fit->scale *= exp(fmin(fmax(-gap / fit->slope, -1), 1));
}

typedef struct {
  double scale, gap, distance; /* gap: error of the logarithm of the number of cells */
} Found;

static gboolean has_choice(const Fit *fit) { return fit->work->options.method == SPORE_TETRAHEDRA_METHODS; }

/* Whether a lattice should be used instead, where the choice is free. The cells of a lattice keep thin parts that the
 * mesher misses. */
static gboolean is_hopeless(const Fit *fit, double count, double distance) {
  const SporeTetrahedraOptions *options = &fit->work->options;
  const double least = fit->refinements > 1 ? 1 : MANY;
  return has_choice(fit) && count >= least * (double)options->cells && distance > HOPELESS * options->tolerance;
}

static void keep_plan(Fit *fit) { memcpy(fit->kept, fit->plan.relative, fit->nodes * sizeof *fit->kept); }

/* The number of cells counts first, then the tolerance; above the tolerance, the nearer mesh is better. */
static gboolean is_better(const Fit *fit, const Found *best, double gap, double distance) {
  const double near = AIM * fit->work->options.tolerance;
  gboolean meets = gap < 0.8 * SPORE_TETRAHEDRA_COUNT, met = best->gap < 0.8 * SPORE_TETRAHEDRA_COUNT;
  if (!meets || !met) return meets || (!met && gap < best->gap);
  if (distance < near && best->distance < near) return gap < best->gap;
  return distance < best->distance;
}

/* Figures of a rough mesh; count 0: the mesher failed. */
typedef struct {
  double count, volume, gap, distance;
  gboolean changed; /* the plan is finer now where the mesh was too far */
} Rough;

static gboolean make_rough(Fit *fit, Rough *rough, GError **error) {
  SporeTetrahedralMesh mesh = {0};
  SporeTetrahedraQuality quality;
  SporeError failure = SPORE_ERROR_INIT;
  GError *refusal = NULL;
  *rough = (Rough){0};
  if (!mesh_at(fit, fit->scale, SPORE_TETRAHEDRA_ROUGH, &mesh, &refusal)) {
    if (refusal->code != SPORE_ERROR_NUMERICAL || !fit->tries_left) {
      g_propagate_error(error, refusal);
      return FALSE;
    }
    g_error_free(refusal);
    return TRUE;
  }
  spore_tetrahedral_mesh_quality(&mesh, &quality);
  rough->count = (double)mesh.tetrahedron_count;
  rough->volume = quality.volume;
  rough->gap = fabs(log(rough->count / (double)fit->work->options.cells));
  fit->made_scale = fit->scale;
  rough->changed =
      rough->gap < NEAR_COUNT && rough->volume >= LEAST_VOLUME * fit->volume && fit->refinements < MOST_REFINEMENTS;
  keep_plan(fit);
  rough->distance = distance_of(fit, &mesh, rough->changed, &failure);
  rough->changed = rough->changed && rough->distance >= AIM * fit->work->options.tolerance;
  spore_tetrahedral_mesh_clear(&mesh);
  g_debug("size %.4g: %.0f cells, distance %.3f %%, refined %d times", fit->scale, rough->count, 100 * rough->distance,
          fit->refinements);
  return rough->distance >= 0 || spore_error_propagate(&failure, error);
}

/* Sets the next size to try. FALSE: the mesh is good enough. */
static gboolean go_on(Fit *fit, const Rough *rough) {
  if (!rough->count) fit->scale = fit->made_scale > 0 ? sqrt(fit->scale * fit->made_scale) : 1.6 * fit->scale;
  else if (rough->volume < LEAST_VOLUME * fit->volume) fit->scale *= 0.8;
  else {
    step(fit, rough->count);
    if (rough->changed) fit->refinements++, fit->known_scale = 0;
    else if (rough->gap < 0.5 * SPORE_TETRAHEDRA_COUNT) return FALSE;
  }
  return TRUE;
}

static gboolean refuse(const Rough *rough, GError **error) {
  return spore_error_raise(error, SPORE_ERROR_NUMERICAL, NULL,
                           _("the mesher makes %.0f cells of it, %.1f %% of the diagonal away from what was given"),
                           rough->count, 100 * rough->distance);
}

/* Finds the scale and the plan by rough meshes. */
static gboolean search(Fit *fit, GError **error) {
  SporeTetrahedraWork *work = fit->work;
  const double from = work->fraction, share = work->share;
  Found best = {.distance = HUGE_VAL, .gap = HUGE_VAL};
  Rough rough;
  fit->tries_left = MOST_TRIES;
  do {
    work->fraction = from + 0.6 * share * (1 - (double)fit->tries_left-- / MOST_TRIES);
    work->share = 0.6 * share / MOST_TRIES;
    gboolean made = make_rough(fit, &rough, error);
    work->fraction = from, work->share = share;
    if (!made) return FALSE;
    if (is_hopeless(fit, rough.count, rough.distance)) return refuse(&rough, error);
    if (rough.count && (rough.volume >= LEAST_VOLUME * fit->volume || !fit->tries_left) &&
        is_better(fit, &best, rough.gap, rough.distance)) {
      best = (Found){fit->scale, rough.gap, rough.distance};
      memcpy(fit->best, fit->kept, fit->nodes * sizeof *fit->best);
    }
  } while (go_on(fit, &rough) && fit->tries_left);
  if (!(best.gap < (has_choice(fit) ? NEAR_COUNT : HUGE_VAL))) return refuse(&rough, error);
  fit->scale = best.scale;
  memcpy(fit->plan.relative, fit->best, fit->nodes * sizeof *fit->best);
  return TRUE;
}

/* Ways to improve a mesh, tried in turn until the angles are wide enough. No way has a time limit, so results are
 * reproducible. */
static const struct {
  double scale;
  SporeTetrahedraFinish finish;
} ways[] = {{1, SPORE_TETRAHEDRA_SMOOTH | SPORE_TETRAHEDRA_EXUDE},
            {1, SPORE_TETRAHEDRA_SMOOTH | SPORE_TETRAHEDRA_PERTURB | SPORE_TETRAHEDRA_EXUDE},
            {1, SPORE_TETRAHEDRA_PERTURB | SPORE_TETRAHEDRA_EXUDE},
            {0.98, SPORE_TETRAHEDRA_SMOOTH | SPORE_TETRAHEDRA_EXUDE}};
#define WAYS ((int)(sizeof ways / sizeof *ways))

/* Improves the mesher's result. */
static bool better(Fit *fit, SporeTetrahedralMesh *mesh, SporeError *error) {
  const SporeProgress progress = {spore_tetrahedra_report, fit->work};
  return spore_tetrahedra_mend(mesh, error) &&
         spore_tetrahedra_improve(mesh, NULL, fit->tree, GOAL, &progress, error) &&
         spore_tetrahedra_near(fit->work, fit->tree, TURNS, mesh, error);
}

static gboolean finish(Fit *fit, SporeTetrahedralMesh *mesh, GError **error) {
  SporeTetrahedraWork *work = fit->work;
  const SporeTetrahedraOptions *options = &work->options;
  const double from = work->fraction, share = work->share;
  double best = -1; /* least angle, up to the wanted one, plus 1 if the number of cells is met */
  for (int i = 0; i < WAYS && best < SPORE_TETRAHEDRA_ANGLE + 1; i++) {
    SporeTetrahedralMesh made = {0};
    SporeTetrahedraQuality quality;
    SporeError problem = SPORE_ERROR_INIT;
    GError *failure = NULL;
    work->fraction = from + share * (0.6 + 0.4 * i / WAYS);
    work->share = 0.4 * share / WAYS;
    if (!mesh_at(fit, ways[i].scale * fit->scale, ways[i].finish, &made, &failure)) {
      gboolean hopeless = failure->code == SPORE_ERROR_CANCELLED || (best < 0 && i + 1 == WAYS);
      if (hopeless) g_propagate_error(error, failure);
      else g_error_free(failure);
      if (!hopeless) continue;
      spore_tetrahedral_mesh_clear(mesh);
      return FALSE;
    }
    if (!better(fit, &made, &problem)) {
      spore_tetrahedral_mesh_clear(&made);
      spore_tetrahedral_mesh_clear(mesh);
      return spore_error_propagate(&problem, error);
    }
    spore_tetrahedral_mesh_quality(&made, &quality);
    g_debug("way %d: %zu cells, angle %.2f", i, made.tetrahedron_count, quality.min_dihedral_deg);
    double over = options->cells ? log((double)made.tetrahedron_count / (double)options->cells) : 0;
    double worth = fmin(quality.min_dihedral_deg, SPORE_TETRAHEDRA_ANGLE) + (fabs(over) < SPORE_TETRAHEDRA_COUNT);
    if (worth > best) {
      best = worth;
      spore_tetrahedral_mesh_clear(mesh);
      *mesh = made;
    } else spore_tetrahedral_mesh_clear(&made);
    if (fabs(over) > SPORE_TETRAHEDRA_COUNT) fit->scale *= exp(over / USUAL_SLOPE);
  }
  work->fraction = from, work->share = share;
  return best >= 0;
}

gboolean spore_tetrahedra_fit(SporeTetrahedraWork *work, const SporeTriangleMesh *surface, SporeTetrahedralMesh *mesh,
                              GError **error) {
  Fit fit = {.work = work, .surface = surface, .slope = -USUAL_SLOPE};
  SporeMeshReport report;
  SporeError failure = SPORE_ERROR_INIT;
  *mesh = (SporeTetrahedralMesh){0};
  gboolean done = spore_triangle_mesh_report(surface, &report, &failure) &&
                  spore_sizing_plan_create(&fit.plan, work, surface, &failure) &&
                  (fit.tree = spore_bvh_create(surface, &failure)) != NULL;
  fit.points = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  fit.samples = SPORE_NEW_ARRAY(double, 3 * SAMPLES);
  fit.nodes = done ? fit.plan.grid.count[0] * fit.plan.grid.count[1] * fit.plan.grid.count[2] : 0;
  fit.kept = SPORE_NEW_ARRAY(double, fit.nodes);
  fit.best = SPORE_NEW_ARRAY(double, fit.nodes);
  if (done && (!fit.points || !fit.samples || !fit.kept || !fit.best)) done = spore_mesh_no_memory(&failure);
  if (done) {
    spore_surface_samples(surface, SAMPLES, fit.points, NULL);
    fit.volume = fabs(report.volume);
    fit.scale =
        work->options.cells ? 1.25 * cbrt(fit.volume / (double)work->options.cells) : EDGE_SCALE * work->options.size;
    done = (!work->options.cells || search(&fit, error)) && finish(&fit, mesh, error);
  } else spore_error_propagate(&failure, error);
  spore_free(fit.points);
  spore_free(fit.samples);
  spore_free(fit.kept);
  spore_free(fit.best);
  spore_bvh_free(fit.tree);
  spore_sizing_plan_clear(&fit.plan);
  return done;
}
