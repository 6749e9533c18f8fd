/* Surfaces of many labels at once: out of one net, each then made of fewer triangles. */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/generate/labels/nets.h"
#include "core/generate/labels/private.h"
#include "core/mesh/bvh.h"
#include "core/mesh/common.h"
#include "core/mesh/simplify.h"

#define ALL_LABELS 65536
static const double thinned[] = {0.4, 0.3}; /* voxels: how far off triangles that replace others may come to be */
#define SPACING 0.5                         /* voxels: between the points at which that is looked at */
#define MEASURED 0.5                        /* voxels: between the points at which the distance is measured */
#define MOST_PARTS 256                      /* of a side */
#define NET_SHARE 0.15                      /* of the time: the scan and the smoothing */
#define FACES_A_REPORT 4096

typedef struct Work {
  const SporeLabelMap *map;
  SporeLabelNet net;
  uint32_t *own;  /* faces of each label, those of one label together */
  size_t *first;  /* ALL_LABELS + 1: where a label's begin */
  uint16_t label; /* the one at hand */
} Work;

/* Whether a voxel has the label at hand; none outside the map has. */
static bool has(const Work *w, int64_t i, int64_t j, int64_t k) {
  const size_t *n = w->map->size;
  if (i < 0 || j < 0 || k < 0 || i >= (int64_t)n[0] || j >= (int64_t)n[1] || k >= (int64_t)n[2]) return false;
  return w->map->labels[((size_t)k * n[1] + (size_t)j) * n[0] + (size_t)i] == w->label;
}

/* Distance (voxels) from a place, in indices, to the faces of the label's voxels, which is that to the nearest voxel of
 * the other kind; 1 where it is over one half. Up to there, one of the eight voxels with their middles around the place
 * is the nearest. */
static double off_label(void *data, SporeVec3 place) {
  const Work *w = data;
  const double x[3] = {place.x, place.y, place.z};
  double gap[3][2], best = 0.25; /* squares */
  int64_t at[3];
  int own = 0; /* which of the eight has the place */
  for (int k = 0; k < 3; k++) {
    at[k] = (int64_t)floor(x[k]);
    const double beyond = x[k] - (double)at[k] - 0.5;
    gap[k][0] = beyond > 0 ? beyond * beyond : 0, gap[k][1] = beyond < 0 ? beyond * beyond : 0;
    own |= (beyond > 0) << k;
  }
  const bool is_in = has(w, at[0] + (own & 1), at[1] + (own >> 1 & 1), at[2] + (own >> 2));
  bool found = false;
  for (int c = 0; c < 8; c++) {
    const double square = gap[0][c & 1] + gap[1][c >> 1 & 1] + gap[2][c >> 2];
    if (square > best || has(w, at[0] + (c & 1), at[1] + (c >> 1 & 1), at[2] + (c >> 2)) == is_in) continue;
    best = square;
    found = true;
  }
  return found ? sqrt(best) : 1;
}

/* The largest distance of points of the triangles from the faces. */
static bool measure_triangles(Work *w, const SporeTriangleMesh *mesh, double *off, const SporeProgress *progress,
                              SporeError *error) {
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    if (t % FACES_A_REPORT == 0 && !spore_progress_step(progress, 1, _("measuring the distance"), error)) return false;
    SporeVec3 p[3];
    double longest = 0;
    for (size_t k = 0; k < 3; k++) p[k] = spore_mesh_vertex(mesh->vertices, mesh->triangles[3 * t + k]);
    for (size_t k = 0; k < 3; k++) longest = fmax(longest, spore_vec3_distance(p[k], p[(k + 1) % 3]));
    const int parts = (int)fmin(fmax(ceil(longest / MEASURED), 1), MOST_PARTS);
    for (int i = 0; i <= parts; i++)
      for (int j = 0; i + j <= parts; j++) {
        SporeVec3 place = spore_vec3_add_scaled(p[0], (double)i / parts, spore_vec3_sub(p[1], p[0]));
        place = spore_vec3_add_scaled(place, (double)j / parts, spore_vec3_sub(p[2], p[0]));
        *off = fmax(*off, off_label(w, place));
      }
  }
  return true;
}

/* The largest distance of corners and middles of the label's faces from the mesh. */
static bool measure_faces(Work *w, const SporeTriangleMesh *mesh, double *off, const SporeProgress *progress,
                          SporeError *error) {
  SporeBvh *bvh = spore_bvh_create(mesh, error);
  bool done = bvh != NULL;
  for (size_t f = w->first[w->label]; done && f < w->first[w->label + 1]; f++) {
    SporeVec3 middle = {0, 0, 0};
    if (f % FACES_A_REPORT == 0) done = spore_progress_step(progress, 1, _("measuring the distance"), error);
    for (int c = 0; c < 4; c++) {
      const uint32_t *at = w->net.corner + 3 * (size_t)w->net.faces[w->own[f]].node[c];
      middle = spore_vec3_add_scaled(middle, 0.25, spore_vec3(at[0] - 0.5, at[1] - 0.5, at[2] - 0.5));
    }
    *off = fmax(*off, spore_bvh_distance(bvh, middle, NULL, NULL));
  }
  spore_bvh_free(bvh);
  return done;
}

static bool measure(Work *w, SporeLabelSurface *surface, const SporeProgress *progress, SporeError *error) {
  surface->off = 0;
  return measure_triangles(w, &surface->mesh, &surface->off, progress, error) &&
         measure_faces(w, &surface->mesh, &surface->off, progress, error);
}

static bool thin_within(Work *w, SporeLabelSurface *surface, double most, const SporeProgress *progress,
                        SporeError *error) {
  const SporeSurfaceLimit limit = {.depth = 1, .most = most, .spacing = SPACING, .off = off_label, .data = w};
  return spore_triangle_mesh_thin(&surface->mesh, &limit, progress, error) && measure(w, surface, progress, error);
}

/* Makes the surface of fewer triangles. Where it comes off too far between the points that were looked at, it is done
 * again with less room; at last it stays as it was. */
static bool thin(Work *w, SporeLabelSurface *surface, const SporeProgress *progress, SporeError *error) {
  SporeTriangleMesh whole = surface->mesh;
  surface->mesh = (SporeTriangleMesh){0};
  surface->off = HUGE_VAL;
  bool done = true;
  for (size_t i = 0; done && surface->off > SPORE_LABEL_SURFACE_OFF && i < G_N_ELEMENTS(thinned); i++) {
    spore_triangle_mesh_clear(&surface->mesh);
    done =
        spore_triangle_mesh_copy(&surface->mesh, &whole, error) && thin_within(w, surface, thinned[i], progress, error);
  }
  if (done && surface->off > SPORE_LABEL_SURFACE_OFF) {
    const SporeTriangleMesh swap = surface->mesh;
    surface->mesh = whole, whole = swap;
    done = measure(w, surface, progress, error);
  }
  spore_triangle_mesh_clear(&whole);
  return done;
}

static bool make(Work *w, SporeLabelSurface *surface, const SporeProgress *progress, SporeError *error) {
  const uint32_t *own = w->own + w->first[surface->label];
  const size_t count = w->first[surface->label + 1] - w->first[surface->label];
  w->label = surface->label;
  if (!count)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("no voxel has the label %u; expected some; give one that there is"),
                           (unsigned)surface->label);
  bool done = spore_label_net_surface(&w->net, surface->label, own, count, &surface->mesh, error);
  surface->triangles_before = surface->mesh.triangle_count;
  done = done && thin(w, surface, progress, error);
  if (done) spore_label_surface_place(w->map, &surface->mesh);
  return done;
}

/* Puts the faces of each label together. */
static bool sort_faces(Work *w, SporeError *error) {
  w->first = SPORE_NEW_ARRAY(size_t, ALL_LABELS + 1);
  size_t *at = SPORE_NEW_ARRAY(size_t, ALL_LABELS), count = 0;
  bool done = w->first && at;
  for (size_t f = 0; done && f < w->net.face_count; f++)
    for (int side = 0; side < 2; side++) at[w->net.faces[f].label[side]]++;
  for (size_t l = 1; done && l < ALL_LABELS; l++) {
    w->first[l] = count;
    count += at[l];
    at[l] = w->first[l];
  }
  if (done) w->first[ALL_LABELS] = count, w->own = SPORE_NEW_ARRAY(uint32_t, count);
  done = done && w->own;
  for (size_t f = 0; done && f < w->net.face_count; f++)
    for (int side = 0; side < 2; side++) {
      const uint16_t label = w->net.faces[f].label[side];
      if (label) w->own[at[label]++] = (uint32_t)f;
    }
  spore_free(at);
  return done || spore_generate_no_memory(error);
}

static bool make_net(Work *w, const SporeLabelSurface *surfaces, size_t count, const SporeProgress *progress,
                     SporeError *error) {
  bool *wanted = SPORE_NEW_ARRAY(bool, ALL_LABELS);
  if (!wanted) return spore_generate_no_memory(error);
  for (size_t i = 0; i < count; i++) wanted[surfaces[i].label] = true;
  SporeProgressShare scanning = {progress, 0, NET_SHARE / 2}, smoothing = {progress, NET_SHARE / 2, NET_SHARE / 2};
  const SporeProgress scan = spore_progress_of_share(&scanning), smooth = spore_progress_of_share(&smoothing);
  bool done = spore_label_net_create(&w->net, w->map, wanted, &scan, error) &&
              spore_label_net_smooth(&w->net, &smooth, error) && sort_faces(w, error);
  spore_free(wanted);
  return done;
}

bool spore_label_surfaces(const SporeLabelMap *map, SporeLabelSurface *surfaces, size_t count,
                          const SporeProgress *progress, SporeError *error) {
  Work w = {.map = map};
  for (size_t i = 0; i < count; i++) surfaces[i].mesh = (SporeTriangleMesh){0};
  bool done = make_net(&w, surfaces, count, progress, error);
  size_t before = 0;
  for (size_t i = 0; done && i < count; i++) {
    const size_t own = w.first[surfaces[i].label + 1] - w.first[surfaces[i].label], all = MAX(w.first[ALL_LABELS], 1);
    SporeProgressShare share = {progress, NET_SHARE + (1 - NET_SHARE) * (double)before / (double)all,
                                (1 - NET_SHARE) * (double)own / (double)all};
    const SporeProgress one = spore_progress_of_share(&share);
    done = make(&w, &surfaces[i], &one, error);
    before += own;
  }
  for (size_t i = 0; !done && i < count; i++) spore_triangle_mesh_clear(&surfaces[i].mesh);
  spore_label_net_clear(&w.net);
  spore_free(w.own);
  spore_free(w.first);
  return done;
}
