/* Sphere sets from a surface. */
#include <glib/gi18n.h>

#include "core/author/generated_edits.h"
#include "ui/jobs/generate-types.h"

static void show_set(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_spheres(&work->spheres, places, candidate);
}

static void show_mesh(const SporeGenerateWork *work, float *places, SporeStageCandidate *candidate) {
  spore_generate_show_surface(&work->mesh, places, candidate);
}

static void measure_distance(const SporeGenerateWork *work, SporeQuality *quality) {
  const SporeSpheresQuality *found = &work->spheres_quality;
  quality->count = found->vertex_count;
  quality->values = spore_generate_scaled(found->distance, quality->count, 1, 1e3);
  quality->weights = g_memdup2(found->area, quality->count * sizeof(double));
}

static void measure_outside(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres_quality.sphere_count;
  quality->values = spore_generate_scaled(work->spheres_quality.outside, quality->count, 1, 100);
}

static void measure_depth(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres_quality.sphere_count;
  quality->values = spore_generate_scaled(work->spheres_quality.depth_error, quality->count, 1, 1e3);
}

static void measure_radius(const SporeGenerateWork *work, SporeQuality *quality) {
  quality->count = work->spheres.count;
  quality->values = spore_generate_scaled(work->spheres.spheres + 3, quality->count, 4, 1e3);
}

static const SporeGenerateQuality qualities[] = {
    {N_("Surface distance"), "mm", FALSE, measure_distance, show_mesh},
    {N_("Outside share"), "%", FALSE, measure_outside, show_set},
    {N_("Depth error"), "mm", FALSE, measure_depth, show_set},
    {N_("Radius"), "mm", FALSE, measure_radius, show_set},
};

const SporeGenerateType spore_generate_spheres = {
    .shows = "spheres",
    .counts = (const size_t[]){8, 16, 32, 64, 128, 256, 512, 0},
    .error_label = N_("Depth error"),
    .worth = 1,
    .qualities = qualities,
    .quality_count = G_N_ELEMENTS(qualities),
};
