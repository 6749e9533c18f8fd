/* Marks on a body: of its regions, and a cross at the worst place of its mapping. */
#include "ui/document/body-marks.h"

#include "core/author/generated_edits.h"
#include "core/author/region_edits.h"

#define WORST_PART 0.08 /* of the size: half of the cross at the worst place */

static void append_segments(GArray *all, const double *segments, gsize count) {
  if (count) g_array_append_vals(all, segments, (guint)(6 * count));
}

static void append_marks(GArray *all, const SporeObject *holder) {
  gsize count = 0;
  g_autofree double *segments = holder ? spore_region_marks(holder, &count) : NULL;
  append_segments(all, segments, count);
}

static void append_worst(GArray *all, const SporeMappingReport *report) {
  SporeVec3 place;
  double size;
  if (!spore_mapping_report_worst(report, &place, &size)) return;
  for (int axis = 0; axis < 3; axis++) {
    double segment[6] = {place.x, place.y, place.z, place.x, place.y, place.z};
    segment[axis] -= WORST_PART * size;
    segment[3 + axis] += WORST_PART * size;
    append_segments(all, segment, 1);
  }
}

double *spore_body_marks(SporeDocument *document, SporeObject *body, const SporeMappingReport *report, gsize *count) {
  GArray *all = g_array_new(FALSE, FALSE, sizeof(double));
  append_marks(all, spore_object_child_of(body, "regions"));
  append_marks(all, spore_edit_body_spheres(document, body));
  append_marks(all, spore_edit_body_tetrahedra(document, body));
  if (spore_mapping_report_holds(report, document, body)) append_worst(all, report);
  *count = all->len / 6;
  return (double *)(void *)g_array_free(all, FALSE);
}
