/* Tetrahedra in a surface: the methods, their order, and the reasons for refusing one. */
#include "core/generate/tetrahedra/tetrahedra.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/profile.h"
#include "core/generate/common/common.h"
#include "core/generate/tetrahedra/private.h"

#define LOOKING 0.05 /* share of the progress, before and after the work */
#define MOST_WRAPS 3
#define MOST_WRAPPED 40000.0 /* most triangles of a closer wrap */
#define CLOSER 4             /* halving alpha gives at least this many times the triangles */
#define MOST_FIRST 200000.0  /* most triangles of the first wrap, or of the wrap that closes openings */
#define WRAPPED_NEAR 0.8     /* of the tolerance */
#define PREPARED_SAMPLES 10000
#define MOST_GIVEN 200000  /* triangles: with more, CGAL takes minutes, a lattice seconds */
#define SURE 0.9           /* of the tolerance */
#define BETTER 0.95        /* of the mesher's misfit: a lattice must be below this to replace the mesher's cells */
#define MOST_CHANGE 0.1    /* of the volume */
#define MOST_WRAPS_MIXED 1 /* of pieces that lie in one another: closer wraps take long, and a lattice seconds */

const char *const spore_tetrahedra_method_names[] = {"direct", "repaired", "wrapped", "voxels", NULL};

static gboolean refuse_option(const char *place, GError **error, const char *format, ...) G_GNUC_PRINTF(3, 4);
static gboolean refuse_option(const char *place, GError **error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  return spore_error_raise(error, SPORE_ERROR_INPUT, place, "%s", message);
}

static gboolean is_length(double x) { return x > 0 && isfinite(x); }

static gboolean check_regions(const char *place, const SporeTetrahedraOptions *options, GError **error) {
  if (options->region_count > SPORE_GENERATE_REGIONS)
    return refuse_option(place, error, _("there are %zu regions of another size; expected at most %d; give fewer"),
                         options->region_count, SPORE_GENERATE_REGIONS);
  for (gsize i = 0; i < options->region_count; i++) {
    const SporeGenerateRegion *region = options->regions + i;
    if (!spore_vec3_is_finite(spore_vec3_load(region->centre)) || !is_length(region->radius) ||
        !is_length(region->value))
      return refuse_option(place, error,
                           _("region %zu has radius %g m and size %g m; expected a finite centre and lengths above 0; "
                             "correct it"),
                           i, region->radius, region->value);
  }
  return TRUE;
}

static gboolean check_options(const char *place, const SporeTetrahedraOptions *options, GError **error) {
  if ((guint)options->method > SPORE_TETRAHEDRA_METHODS)
    return refuse_option(place, error, _("there is no method %d; expected 0 to %d; give one of them"),
                         (int)options->method, SPORE_TETRAHEDRA_METHODS);
  if (!options->cells && !is_length(options->size))
    return refuse_option(
        place, error, _("the cells' size is %g m; expected a length above 0, or a number of cells; give one of them"),
        options->size);
  if (!(options->tolerance >= 0 && options->tolerance < 1))
    return refuse_option(place, error,
                         _("the tolerance is %g of the diagonal; expected 0 (for %g) to 1; give another one"),
                         options->tolerance, SPORE_TETRAHEDRA_TOLERANCE);
  if (options->curvature != 0 && !(options->curvature >= 5 && options->curvature <= 90))
    return refuse_option(place, error,
                         _("the curvature is %g degrees an edge; expected 0 (none) or 5 to 90; give another one"),
                         options->curvature);
  if (!(options->gap >= 0 && isfinite(options->gap)))
    return refuse_option(place, error, _("the gap is %g m; expected 0 or a length; give another one"), options->gap);
  if (options->apart && (options->curvature > 0 || options->gap > 0 || options->region_count ||
                         (options->method != SPORE_TETRAHEDRA_METHODS && options->method != SPORE_TETRAHEDRA_VOXELS)))
    return refuse_option(
        place, error,
        _("pieces are to be kept apart, which a lattice does; expected the method left open or %s, no curvature, "
          "no gap and no regions; leave these out"),
        spore_tetrahedra_method_names[SPORE_TETRAHEDRA_VOXELS]);
  return check_regions(place, options, error);
}

/* Checks the number of cells, as if all had the same size. */
static gboolean check_count(const char *place, const SporeTetrahedraWork *work, GError **error) {
  const SporeTetrahedraOptions *options = &work->options;
  double cells = options->cells ? (double)options->cells : work->volume * 6 * sqrt(2) / pow(options->size, 3);
  if (cells <= SPORE_TETRAHEDRA_CELLS) return TRUE;
  return refuse_option(place, error,
                       _("that makes about %.0f cells; expected at most %u; ask for fewer or larger ones"), cells,
                       SPORE_TETRAHEDRA_CELLS);
}

/* Copies the surface, centred at the origin and scaled to a diagonal of 1, so that libraries see no extreme lengths. */
static bool normalise(SporeTetrahedraWork *work, const SporeTriangleMesh *surface,
                      const SporeTetrahedraOptions *options, const SporeMeshReport *report, const double centre[3],
                      SporeError *error) {
  work->options = *options;
  work->options.size /= report->diagonal;
  work->options.gap /= report->diagonal;
  if (!(options->tolerance > 0)) work->options.tolerance = SPORE_TETRAHEDRA_TOLERANCE;
  if (options->apart) work->options.method = SPORE_TETRAHEDRA_VOXELS;
  for (gsize i = 0; i < options->region_count; i++) {
    SporeGenerateRegion *region = work->regions + i;
    *region = options->regions[i];
    for (int k = 0; k < 3; k++) region->centre[k] = (region->centre[k] - centre[k]) / report->diagonal;
    region->radius /= report->diagonal;
    region->value /= report->diagonal;
  }
  work->options.regions = work->regions;
  if (!spore_triangle_mesh_copy(&work->surface, surface, error)) return false;
  if (options->parts) {
    work->parts = SPORE_NEW_ARRAY(uint32_t, surface->triangle_count);
    if (!work->parts) return spore_generate_no_memory(error);
    memcpy(work->parts, options->parts, surface->triangle_count * sizeof *work->parts);
  }
  for (gsize i = 0; i < 3 * surface->vertex_count; i++)
    work->surface.vertices[i] = (surface->vertices[i] - centre[i % 3]) / report->diagonal;
  return true;
}

static void clear(SporeTetrahedraWork *work) {
  spore_triangle_mesh_clear(&work->surface);
  spore_free(work->parts);
  spore_bvh_free(work->tree);
  spore_bvh_free(work->closed);
  spore_tetrahedra_clear_thin(&work->thin);
  spore_free(work->bounding);
  spore_free(work->inner);
  spore_free(work->borders);
  spore_free(work->border_sides);
}

/* Largest distance between a prepared surface and the bounds of the solid. Where the prepared surface closes a hole of
 * the given one, a winding number near one half counts as no distance. Below 0: no memory. */
static double distance_to(const SporeTetrahedraWork *work, const SporeTriangleMesh *surface) {
  double *points = SPORE_NEW_ARRAY(double, 3 * PREPARED_SAMPLES);
  SporeBvh *tree = points ? spore_bvh_create(surface, NULL) : NULL;
  double most = tree ? 0 : -1;
  gsize count = tree ? MIN(work->bounding_count, PREPARED_SAMPLES) : 0;
  for (gsize i = 0; i < count; i++) {
    const double *p = work->bounding + 3 * (i * work->bounding_count / count);
    most = fmax(most, spore_bvh_distance(tree, spore_vec3_load(p), NULL, NULL));
  }
  if (tree) spore_surface_samples(surface, PREPARED_SAMPLES, points, NULL);
  for (gsize i = 0; tree && i < PREPARED_SAMPLES; i++) {
    SporeVec3 p = spore_vec3_load(points + 3 * i);
    double distance = spore_bvh_distance(work->tree, p, NULL, NULL);
    if (distance > most && fabs(spore_bvh_winding(work->tree, p) - 0.5) > SPORE_TETRAHEDRA_CLOSING) most = distance;
  }
  spore_bvh_free(tree);
  spore_free(points);
  return most;
}

static gboolean fail(GError **error, const char *format, ...) G_GNUC_PRINTF(2, 3);
static gboolean fail(GError **error, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  return spore_error_raise(error, SPORE_ERROR_NUMERICAL, NULL, "%s", message);
}

/* Half the edge length, so that walls finer than the cells merge. The bounds keep the wrap fast and close to the shape.
 */
static double usual_alpha(const SporeTetrahedraWork *work) {
  double edge = work->options.cells ? cbrt(work->volume / (0.12 * (double)work->options.cells)) : work->options.size;
  return fmin(fmax(0.5 * edge, 1.0 / 150), 1.0 / 50);
}

static gboolean wrap_at(SporeTetrahedraWork *work, double alpha, double most_triangles, SporeTriangleMesh *surface,
                        GError **error) {
  const double share = work->share;
  work->share = share * 0.1;
  gboolean done =
      spore_tetrahedra_prepare(work, SPORE_TETRAHEDRA_WRAP, alpha, (size_t)(0.5 * most_triangles), surface, error);
  work->share = share;
  if (done) g_debug("a wrap of alpha %.4g has %zu triangles", alpha, surface->triangle_count);
  return done;
}

/* Wraps more tightly until the wrap is as close to the solid as the cells must be, or has too many triangles. */
static gboolean wrap(SporeTetrahedraWork *work, SporeTriangleMesh *surface, GError **error) {
  const bool by_gap = work->options.gap > 0;
  double alpha = by_gap ? work->options.gap : usual_alpha(work);
  if (!wrap_at(work, alpha, MOST_FIRST, surface, error)) return FALSE;
  if (by_gap) return TRUE;
  const int most = work->mixed && work->options.method == SPORE_TETRAHEDRA_METHODS ? MOST_WRAPS_MIXED : MOST_WRAPS;
  double distance = distance_to(work, surface);
  for (int i = 1; i < most && distance >= WRAPPED_NEAR * work->options.tolerance; i++) {
    SporeTriangleMesh closer = {0};
    GError *refusal = NULL;
    alpha *= 0.5;
    if (MOST_WRAPPED < CLOSER * (double)surface->triangle_count) break;
    gboolean done = wrap_at(work, alpha, MOST_WRAPPED, &closer, &refusal);
    if (!done && refusal->code != SPORE_ERROR_NUMERICAL) {
      g_propagate_error(error, refusal);
      return FALSE;
    }
    g_clear_error(&refusal);
    if (!done) break;
    spore_triangle_mesh_clear(surface);
    *surface = closer;
    distance = distance_to(work, surface);
  }
  if (distance <= work->options.tolerance) return TRUE;
  return fail(error, _("the wrap is %.1f %% of the diagonal away from what was given"), 100 * distance);
}

/* The surface that a method meshes. */
static gboolean prepare(SporeTetrahedraWork *work, SporeTetrahedraMethod method, SporeTriangleMesh *surface,
                        GError **error) {
  if (work->options.method == SPORE_TETRAHEDRA_METHODS && work->surface.triangle_count > MOST_GIVEN)
    return fail(
        error,
        _("the surface has %zu triangles; expected at most %d, of more a lattice is the quicker; decimate it, or "
          "ask for this method"),
        work->surface.triangle_count, MOST_GIVEN);
  if (method == SPORE_TETRAHEDRA_WRAPPED) return wrap(work, surface, error);
  if (work->options.method == SPORE_TETRAHEDRA_METHODS && work->mixed)
    return fail(error,
                _("pieces of the surface lie in one another, which this method does not make one solid of; leave "
                  "them out, or ask for this method"));
  if (work->options.gap > 0) return fail(error, _("openings are to be closed, which wrapping alone does"));
  SporeTetrahedraTask task = method == SPORE_TETRAHEDRA_DIRECT ? SPORE_TETRAHEDRA_CHECK : SPORE_TETRAHEDRA_REPAIR;
  const double share = work->share;
  work->share = share * 0.1;
  gboolean done = spore_tetrahedra_prepare(work, task, 0, 0, surface, error);
  work->share = share;
  if (!done || method == SPORE_TETRAHEDRA_DIRECT) return done;
  double distance = distance_to(work, surface);
  if (distance <= 0.5 * work->options.tolerance) return TRUE;
  return fail(error, _("the repaired surface is %.1f %% of the diagonal away from what was given"), 100 * distance);
}

static gboolean has_cgal(GError **error) {
  return SPORE_HAVE_CGAL ||
         spore_error_raise(error, SPORE_ERROR_UNSUPPORTED, NULL,
                           _("this build of SPORE is without CGAL; install libcgal-dev and build SPORE again"));
}

static gboolean attempt(SporeTetrahedraWork *work, SporeTetrahedraMethod method, SporeTetrahedralMesh *mesh,
                        GError **error) {
  SporeTriangleMesh surface = {0};
  SporeError failure = SPORE_ERROR_INIT;
  if (method == SPORE_TETRAHEDRA_VOXELS)
    return spore_tetrahedra_voxels(work, mesh, &failure) || spore_error_propagate(&failure, error);
  if (!has_cgal(error)) return FALSE;
  const double from = work->fraction, share = work->share;
  gboolean done = prepare(work, method, &surface, error);
  work->fraction = from + 0.1 * share;
  work->share = 0.9 * share;
  work->prepared = work->prepared || done;
  if (done && work->options.fill && !spore_tetrahedra_fill(&surface, NULL, &work->filled_by_method, &failure))
    done = spore_error_propagate(&failure, error);
  done = done && spore_tetrahedra_fit(work, &surface, mesh, error);
  work->fraction = from, work->share = share;
  spore_triangle_mesh_clear(&surface);
  return done;
}

/* Misfit of a mesh: the errors of distance, volume and count relative to what is allowed. 1 is added for an angle below
 * the least, and 1 for `parts`: the mesh has more pieces than the surface. Below 0: failed. */
static double misfit_of(const SporeTetrahedraWork *work, const SporeTetrahedralMesh *mesh, bool parts, double *distance,
                        double *change, SporeError *error) {
  SporeTetrahedraQuality quality;
  double inner, area;
  spore_tetrahedral_mesh_quality(mesh, &quality);
  *change = quality.volume / work->volume - 1;
  if (!spore_tetrahedra_distances(work, mesh, distance, &inner, &area, error)) return -1;
  double over = log((double)mesh->tetrahedron_count / (double)work->options.cells) / (2 * SPORE_TETRAHEDRA_COUNT);
  bool flat = quality.min_dihedral_deg < SPORE_TETRAHEDRA_ANGLE;
  double lost = work->open ? 0 : fabs(*change) / MOST_CHANGE;
  return fmax(fmax(*distance / (SURE * work->options.tolerance), lost), fmax(over, 0)) + flat + parts;
}

static bool falls_apart(const SporeTetrahedraReport *report) { return report->pieces > report->pieces_given; }

/* Where the mesher's cells miss the limits, the cells of a coarsened lattice may be better. Keeps the better mesh. */
static gboolean look_at_lattice(SporeTetrahedraWork *work, SporeTetrahedralMesh *mesh, SporeTetrahedraReport *report,
                                GError **error) {
  SporeTetrahedralMesh other = {0};
  SporeTetrahedraReport lattice = *report;
  SporeError failure = SPORE_ERROR_INIT;
  double far, lost, near, change, before = misfit_of(work, mesh, falls_apart(report), &far, &lost, &failure);
  if (before < 0) return spore_error_propagate(&failure, error);
  if (before <= 1) return TRUE;
  if (!spore_tetrahedra_voxels(work, &other, &failure) ||
      !spore_tetrahedra_drop_small(work, &other, &lattice, &failure)) {
    spore_tetrahedral_mesh_clear(&other);
    return failure.code != SPORE_ERROR_CANCELLED || spore_error_propagate(&failure, error);
  }
  double after = misfit_of(work, &other, falls_apart(&lattice), &near, &change, &failure);
  if (work->closed) /* the faces that close the holes are known now */
    before = misfit_of(work, mesh, falls_apart(report), &far, &lost, &failure);
  if (after >= 0 && before > 1 && after < BETTER * before) {
    g_snprintf(lattice.refused[report->method], sizeof lattice.refused[report->method],
               _("its cells are %.2f %% of the diagonal away from what was given and change the volume by %+.1f %%; "
                 "those of %s %.2f %% and %+.1f %%"),
               100 * far, 100 * lost, spore_tetrahedra_method_names[SPORE_TETRAHEDRA_VOXELS], 100 * near, 100 * change);
    lattice.method = SPORE_TETRAHEDRA_VOXELS;
    *report = lattice;
    SporeTetrahedralMesh kept = *mesh;
    *mesh = other, other = kept;
  }
  spore_tetrahedral_mesh_clear(&other);
  return (after >= 0 && before >= 0) || spore_error_propagate(&failure, error);
}

/* The method to try next. If a surface could be prepared but its cells were refused, another surface of the same shape
 * will not help, but a lattice may. */
static SporeTetrahedraMethod next_method(const SporeTetrahedraWork *work, const bool *tried) {
  int method = 0;
  if (work->prepared && !tried[SPORE_TETRAHEDRA_VOXELS]) return SPORE_TETRAHEDRA_VOXELS;
  while (method < SPORE_TETRAHEDRA_METHODS && tried[method]) method++;
  return (SporeTetrahedraMethod)method;
}

/* Runs the first method that works, or the requested one. */
static gboolean run_methods(SporeTetrahedraWork *work, const char *place, SporeTetrahedralMesh *mesh,
                            SporeTetrahedraReport *report, GError **error) {
  const SporeTetrahedraMethod asked = work->options.method;
  const gboolean all = asked == SPORE_TETRAHEDRA_METHODS;
  bool tried[SPORE_TETRAHEDRA_METHODS] = {false};
  GString *reasons = g_string_new(NULL);
  g_autoptr(GError) memory = NULL; /* of the first method that had too little */
  gboolean done = FALSE, hopeless = FALSE;
  for (SporeTetrahedraMethod method = all ? 0 : asked; method < SPORE_TETRAHEDRA_METHODS && !done && !hopeless;
       method = all ? next_method(work, tried) : SPORE_TETRAHEDRA_METHODS) {
    g_autoptr(GError) failure = NULL;
    report->method = method;
    tried[method] = true;
    done = attempt(work, method, mesh, &failure);
    if (done) break;
    hopeless = failure->code == SPORE_ERROR_CANCELLED;
    if (hopeless) spore_error_raise(error, SPORE_ERROR_CANCELLED, place, "%s", failure->message);
    g_strlcpy(report->refused[method], failure->message, sizeof report->refused[method]);
    g_string_append_printf(reasons, "%s%s: %.*s", reasons->len ? ", " : "", spore_tetrahedra_method_names[method],
                           (int)strcspn(failure->message, ";"), failure->message);
    if (!memory && failure->code == SPORE_ERROR_MEMORY) memory = g_steal_pointer(&failure);
  }
  if (!done && !hopeless && memory) spore_error_raise(error, SPORE_ERROR_MEMORY, place, "%s", memory->message);
  else if (!done && !hopeless)
    spore_error_raise(error, SPORE_ERROR_NUMERICAL, place,
                      all ? _("no tetrahedra could be made (%s); expected a surface that encloses a volume; close its "
                              "holes, simplify it, or ask for another number of cells")
                          : _("no tetrahedra could be made (%s); expected a surface that this method can fill; mend "
                              "it, or leave the choice of the method open"),
                      reasons->str);
  g_string_free(reasons, TRUE);
  return done;
}

/* Whether openings are to be closed first. */
static bool wraps(const SporeTetrahedraOptions *options) {
  return options->gap > 0 && options->method >= SPORE_TETRAHEDRA_WRAPPED;
}

/* Runs the methods, then compares the result with a lattice. */
static gboolean run_chain(SporeTetrahedraWork *work, const char *place, SporeTetrahedralMesh *mesh,
                          SporeTetrahedraReport *report, GError **error) {
  const SporeTetrahedraOptions *options = &work->options;
  const double from = work->fraction, share = work->share;
  const gboolean looks = options->method == SPORE_TETRAHEDRA_METHODS && options->cells;
  if (looks) work->share = 0.6 * share;
  SporeError failure = SPORE_ERROR_INIT;
  if (!run_methods(work, place, mesh, report, error)) return FALSE;
  if (!spore_tetrahedra_drop_small(work, mesh, report, &failure)) {
    spore_error_at(&failure, place);
    return spore_error_propagate(&failure, error);
  }
  work->fraction = from + 0.6 * share, work->share = 0.4 * share;
  if (!looks || report->method == SPORE_TETRAHEDRA_VOXELS) return TRUE;
  return look_at_lattice(work, mesh, report, error);
}

/* Closes openings by a wrap. The wrap is then filled like any other surface, by the mesher or by a lattice. */
static gboolean run_closed(SporeTetrahedraWork *work, const char *place, SporeTetrahedralMesh *mesh,
                           SporeTetrahedraReport *report, GError **error) {
  const double from = work->fraction, share = work->share;
  SporeTetrahedraWork closed = {.options = work->options, .progress = work->progress, .share = 0.1};
  SporeTetrahedraReport found = {0};
  SporeError failure = SPORE_ERROR_INIT;
  GError *refusal = NULL;
  closed.options.gap = 0;
  if (closed.options.method == SPORE_TETRAHEDRA_WRAPPED) closed.options.method = SPORE_TETRAHEDRA_DIRECT;
  work->share = 0.3 * share;
  if (!has_cgal(&refusal) || !wrap(work, &closed.surface, &refusal)) {
    spore_error_raise(error, refusal->code, place, _("openings could not be closed: %s"), refusal->message);
    g_error_free(refusal);
    return FALSE;
  }
  closed.fraction = from + 0.3 * share, closed.share = 0.1 * share;
  gboolean done = spore_tetrahedra_solid(&closed, &failure);
  closed.fraction = from + 0.4 * share, closed.share = 0.6 * share;
  if (!done) spore_error_at(&failure, place);
  done = done ? run_chain(&closed, place, mesh, &found, error) : spore_error_propagate(&failure, error);
  work->fraction = from, work->share = share;
  work->filled_by_method = closed.filled + closed.filled_by_method;
  *report = found;
  if (found.method == SPORE_TETRAHEDRA_DIRECT) report->method = SPORE_TETRAHEDRA_WRAPPED;
  g_strlcpy(report->refused[SPORE_TETRAHEDRA_WRAPPED], found.refused[SPORE_TETRAHEDRA_DIRECT],
            sizeof report->refused[0]);
  g_strlcpy(report->refused[SPORE_TETRAHEDRA_DIRECT], "", sizeof report->refused[0]);
  work->thin = closed.thin;
  closed.thin = (SporeTetrahedraThin){0};
  clear(&closed);
  return done;
}

static gboolean generate(SporeTetrahedraWork *work, const char *place, SporeTetrahedralMesh *result,
                         SporeTetrahedraReport *report, GError **error) {
  SporeError failure = SPORE_ERROR_INIT;
  work->share = LOOKING;
  gboolean done = spore_tetrahedra_solid(work, &failure);
  done = done && spore_tetrahedra_look_at_pieces(work, &failure);
  if (done) {
    work->fraction = LOOKING, work->share = 1 - 2 * LOOKING;
    if (!check_count(place, work, error)) return FALSE;
    if (!(wraps(&work->options) ? run_closed : run_chain)(work, place, result, report, error)) return FALSE;
    work->fraction = 1 - LOOKING, work->share = LOOKING;
    done = spore_tetrahedra_measure(work, result, report, &failure);
  }
  if (done) return TRUE;
  spore_error_at(&failure, place);
  return spore_error_propagate(&failure, error);
}

gboolean spore_tetrahedra_from_mesh(const char *place, const SporeTriangleMesh *surface,
                                    const SporeTetrahedraOptions *options, SporeTetrahedralMesh *result,
                                    SporeTetrahedraReport *report, const SporeProgress *progress, GError **error) {
  SporeTetrahedraWork work = {.progress = progress};
  SporeTetrahedraReport ignored;
  SporeMeshReport given;
  SporeError failure = SPORE_ERROR_INIT;
  guint64 started = spore_clock_ns();
  if (!report) report = &ignored;
  *report = (SporeTetrahedraReport){0};
  *result = (SporeTetrahedralMesh){0};
  if (!check_options(place, options, error)) return FALSE;
  gboolean done =
      spore_triangle_mesh_validate(surface, &failure) && spore_triangle_mesh_report(surface, &given, &failure);
  if (done && !(given.diagonal > 0))
    done = spore_error_set(&failure, SPORE_ERROR_INPUT, NULL,
                           _("all %zu triangles are in one point; expected a surface that encloses a volume; give "
                             "another mesh"),
                           surface->triangle_count);
  double centre[3];
  for (int axis = 0; done && axis < 3; axis++) centre[axis] = 0.5 * (given.lower[axis] + given.upper[axis]);
  done = done && normalise(&work, surface, options, &given, centre, &failure);
  if (!done) {
    spore_error_at(&failure, place);
    spore_error_propagate(&failure, error);
  } else done = generate(&work, place, result, report, error);
  if (done) spore_tetrahedra_to_metres(report, &work, result, given.diagonal, centre);
  else spore_tetrahedral_mesh_clear(result);
  clear(&work);
  report->seconds = 1e-9 * (double)(spore_clock_ns() - started);
  return done;
}
