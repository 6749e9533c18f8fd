/* The error of each sphere of a set in the mesh that it was made from: |radius - depth of its centre|. In a large mesh
 * depths take longer than a picture, so a stage that is looked at has them measured on a thread. */
#include <gio/gio.h>
#include <math.h>
#include <string.h>

#include "core/mesh/bvh.h"
#include "ui/render/stage_body.h"

/* What is measured, of what. The main thread reads the result once it is ready. */
typedef struct Work {
  SporeStage *stage; /* NULL: it is gone */
  gboolean ready;
  SporeTriangleMesh mesh;
  const double *measured; /* vertices of the document's mesh, only compared */
  gsize count;
  double *spheres; /* count x 4 */
  SporeStageFit *fit;
} Work;

static void clear_work(gpointer data) {
  Work *work = data;
  spore_triangle_mesh_clear(&work->mesh);
  g_free(work->spheres);
  g_free(work->fit);
}

static void release_work(gpointer data) { g_atomic_rc_box_release_full(data, clear_work); }

/* NULL: no memory. */
static SporeStageFit *measure(const SporeTriangleMesh *mesh, const double *spheres, gsize count) {
  SporeMeshReport report;
  SporeBvh *bvh = spore_triangle_mesh_report(mesh, &report, NULL) ? spore_bvh_create(mesh, NULL) : NULL;
  if (!bvh) return NULL;
  SporeStageFit *fit = g_malloc(sizeof *fit + count * sizeof *fit->places);
  fit->high = SPORE_STAGE_FIT_SCALE * report.diagonal;
  for (gsize i = 0; i < count; i++) {
    const double *sphere = spheres + 4 * i;
    double error = fabs(sphere[3] - spore_bvh_depth(bvh, spore_vec3_load(sphere)));
    fit->places[i] = (float)MIN(error / fit->high, 1.0);
  }
  spore_bvh_free(bvh);
  return fit;
}

static void run(GTask *task, gpointer source, gpointer data, GCancellable *cancellable) {
  Work *work = data;
  work->fit = measure(&work->mesh, work->spheres, work->count);
  spore_triangle_mesh_clear(&work->mesh);
  g_task_return_boolean(task, TRUE);
}

static void measured(GObject *source, GAsyncResult *result, gpointer data) {
  Work *work = g_task_get_task_data(G_TASK(result));
  work->ready = TRUE;
  if (work->stage && work->fit) work->stage->found(work->stage->found_data);
}

static gboolean is_of(const Work *work, const SporeTriangleMesh *mesh, const SporeSphereSet *set) {
  return work->measured == mesh->vertices && work->count == set->count &&
         memcmp(work->spheres, set->spheres, 4 * set->count * sizeof *set->spheres) == 0;
}

/* Here, or on a thread. */
static Work *begin(SporeStage *stage, const SporeTriangleMesh *mesh, const SporeSphereSet *set) {
  Work *work = g_atomic_rc_box_new0(Work);
  work->stage = stage;
  work->measured = mesh->vertices;
  work->count = set->count;
  work->spheres = g_memdup2(set->spheres, 4 * set->count * sizeof *set->spheres);
  g_ptr_array_add(stage->fits, work);
  if (!stage->found) {
    work->fit = measure(mesh, set->spheres, set->count);
    work->ready = TRUE;
  } else if (spore_triangle_mesh_copy(&work->mesh, mesh, NULL)) {
    g_autoptr(GTask) task = g_task_new(NULL, NULL, measured, NULL);
    g_task_set_task_data(task, g_atomic_rc_box_acquire(work), release_work);
    g_task_run_in_thread(task, run);
  }
  return work;
}

const SporeStageFit *spore_stage_fit(SporeStage *stage, SporeObject *asset, const SporeSphereSet *set) {
  if (set->weights) return NULL; /* weighted spheres fit together; one of them has no error of its own */
  const char *name = spore_object_text(asset, "source");
  SporeObject *source = name ? spore_document_find(stage->document, "mesh", name) : NULL;
  const SporeTriangleMesh *mesh = source ? spore_document_mesh(stage->document, source, NULL) : NULL;
  if (!mesh) return NULL;
  Work *work = NULL;
  for (guint i = 0; i < stage->fits->len && !work; i++) {
    if (is_of(stage->fits->pdata[i], mesh, set)) work = stage->fits->pdata[i];
  }
  if (!work) work = begin(stage, mesh, set);
  return work->ready ? work->fit : NULL;
}

GPtrArray *spore_stage_fits_new(void) { return g_ptr_array_new_with_free_func(release_work); }

void spore_stage_fits_free(GPtrArray *fits) {
  for (guint i = 0; i < fits->len; i++) ((Work *)fits->pdata[i])->stage = NULL;
  g_ptr_array_free(fits, TRUE);
}

/* Forces on spheres. */

#define LEAST_TOUCH 0.01 /* N: the least end of the scale */

double spore_stage_round_up(double value) {
  double least = value * (1 - 1e-6), power = pow(10, floor(log10(least))), first = least / power;
  return power * (first <= 1 ? 1 : first <= 2 ? 2 : first <= 5 ? 5 : 10);
}

/* Which sphere belongs to which body never changes, though the world may be stepping. */
static gsize first_sphere(const SporeWorld *world, guint32 body) {
  const SporeSpheres *all = spore_world_spheres(world);
  gsize first = 0;
  while (first < all->count && all->body[first] != body) first++;
  return first;
}

/* Spheres that are particles or the body itself keep their look. */
static gboolean shows_touch(const SporeStage *stage, const SporeStageBody *body) {
  return body->spheres_handle && !body->solid && !body->particles && body->world_body != SPORE_NO_BODY &&
         body->centres.count == spore_world_body_sphere_count(stage->simulation->world, body->world_body);
}

static void colour_touch(const SporeStage *stage, const SporeStageBody *body, const double *forces) {
  const double *own = forces + first_sphere(stage->simulation->world, body->world_body);
  g_autofree float *places = g_new(float, body->centres.count);
  for (gsize i = 0; i < body->centres.count; i++) places[i] = (float)MIN(own[i] / stage->touch_end, 1);
  spore_renderer_value_spheres(stage->renderer, body->spheres_handle, places);
}

void spore_stage_show_touch(SporeStage *stage, const SporeSnapshot *snapshot) {
  if (!stage->simulation || !stage->options.spheres || !stage->options.contacts) return;
  gsize count = spore_world_spheres(stage->simulation->world)->count;
  g_autofree double *forces = g_new0(double, count + 1);
  double most = LEAST_TOUCH;
  for (gsize i = 0; i < MIN(snapshot->contact_count, snapshot->contact_capacity); i++) {
    const SporeSnapshotContact *contact = &snapshot->contacts[i];
    double force = spore_vec3_length(contact->force);
    forces[contact->sphere_a] += force;
    forces[contact->sphere_b] += force;
  }
  for (gsize i = 0; i < count; i++) most = MAX(most, forces[i]);
  stage->touch_end = spore_stage_round_up(most);
  for (guint i = 0; i < stage->bodies->len; i++)
    if (shows_touch(stage, stage->bodies->pdata[i])) colour_touch(stage, stage->bodies->pdata[i], forces);
}

void spore_stage_drop_touch(SporeStage *stage) {
  if (!stage->touch_end) return;
  stage->touch_end = 0;
  for (guint i = 0; i < stage->bodies->len; i++) {
    const SporeStageBody *body = stage->bodies->pdata[i];
    if (body->spheres_handle) spore_renderer_value_spheres(stage->renderer, body->spheres_handle, body->fits);
  }
}
