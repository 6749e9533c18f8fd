/* Keeps the poses of a running simulation in its document. */
#include "core/author/pose_edits.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/author/edits.h"
#include "core/io/organ.h"
#include "core/scene/kept_pose.h"

#define FRAME 7 /* doubles in q of a body that physics does not move */

/* A body of the simulation. */
typedef struct Seen {
  SporeDocument *document;
  SporeObject *object;
  const SporeWorld *world;
  guint32 body;
} Seen;

static const double *q_of(const Seen *seen) { return spore_world_q(seen->world, seen->body); }

static const SporeModel *model_of(const Seen *seen) { return spore_world_body_model(seen->world, seen->body); }

/* Why the state of the body is not one to begin with; NULL: it is. g_free. */
static char *reason_against(const Seen *seen) {
  const char *name = spore_object_name(seen->object);
  SporeLineState line;
  SporeLodState level;
  if (spore_world_body_altered(seen->world, seen->body))
    return g_strdup_printf(_("\"%s\" was cut, torn or coagulated, and a pose does not keep that"), name);
  if (spore_world_line_state(seen->world, seen->body, &line) && line.points != line.made)
    return g_strdup_printf(_("\"%s\" has other control points than at the start"), name);
  if (spore_world_lod_state(seen->world, seen->body, &level) &&
      level.level != spore_world_first_lod(seen->world, seen->body))
    return g_strdup_printf(_("\"%s\" is at another level of detail than at the start"), name);
  gsize inverted = spore_kept_pose_inverted(seen->document, seen->object, model_of(seen), q_of(seen));
  if (inverted > 0) return g_strdup_printf(_("%zu tetrahedra of \"%s\" are inside out"), inverted, name);
  return NULL;
}

/* Whether the body is where its model, or its place in the scene, puts it. */
static gboolean is_at_rest(const Seen *seen) {
  const SporeModel *model = model_of(seen);
  const SporePose pose = spore_world_start_pose(seen->world, seen->body);
  const SporeVec3 none = {0, 0, 0};
  gsize count = model ? model->q_count - 3 * model->spare_count : FRAME;
  g_autofree double *q = g_new0(double, model ? model->q_room : FRAME);
  g_autofree double *v = g_new0(double, model ? 3 * model->block_room : 1);
  if (model) model->type->place(model, pose, none, none, q, v);
  else spore_vec3_store(q, pose.position), spore_quat_store(q + 3, pose.orientation);
  return memcmp(q, q_of(seen), count * sizeof *q) == 0;
}

static gboolean unset_pose(SporeDocument *document, SporeObject *body, GError **error) {
  int index = spore_parameter_find(spore_object_type(body)->table, "kept_pose");
  return !spore_object_is_set(body, (guint)index) || spore_document_unset(document, body, (guint)index, error);
}

/* What one body begins with. */
typedef struct Beginning {
  guint32 object;
  char *name;
  SporeKeptPose pose; /* q NULL: as its model, or its place in the scene, puts it */
  GBytes *content;    /* once the work has run */
} Beginning;

struct SporePoseWork {
  GArray *bodies; /* of Beginning */
  GPtrArray *left_out;
};

static void clear_beginning(gpointer data) {
  Beginning *beginning = data;
  g_free(beginning->name);
  spore_kept_pose_clear(&beginning->pose);
  g_clear_pointer(&beginning->content, g_bytes_unref);
}

void spore_pose_work_free(gpointer data) {
  SporePoseWork *work = data;
  g_array_unref(work->bodies);
  g_ptr_array_unref(work->left_out);
  g_free(work);
}

const GPtrArray *spore_pose_work_left_out(const SporePoseWork *work) { return work->left_out; }

/* Whether there is a pose to keep. */
static gboolean take_body(SporePoseWork *work, const Seen *seen) {
  if (spore_world_body_role(seen->world, seen->body) == SPORE_UNMOVABLE) return FALSE;
  char *reason = reason_against(seen);
  if (reason) {
    g_ptr_array_add(work->left_out, reason);
    return FALSE;
  }
  Beginning beginning = {.object = spore_object_id(seen->object), .name = g_strdup(spore_object_name(seen->object))};
  if (!is_at_rest(seen))
    beginning.pose = spore_kept_pose_take(model_of(seen), spore_world_start_pose(seen->world, seen->body), q_of(seen));
  g_array_append_val(work->bodies, beginning);
  return beginning.pose.q != NULL;
}

/* Says which instruments hold something: a pose keeps where jaws are, not the springs to what is between them. */
static void say_let_go(const SporeWorld *world, GPtrArray *left_out) {
  for (gsize i = 0; i < spore_world_tool_count(world); i++) {
    SporeToolState state = spore_world_tool_state(world, i);
    if (state.held > 0)
      g_ptr_array_add(left_out,
                      g_strdup_printf(_("\"%s\" begins with its jaws so, but lets go of what they hold, until "
                                        "its device closes them on it again"),
                                      state.name));
  }
}

SporePoseWork *spore_pose_work_new(SporeDocument *document, const SporeSimulation *simulation, GError **error) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  SporePoseWork *work = g_new0(SporePoseWork, 1);
  guint kept = 0;
  work->bodies = g_array_new(FALSE, FALSE, sizeof(Beginning));
  g_array_set_clear_func(work->bodies, clear_beginning);
  work->left_out = g_ptr_array_new_with_free_func(g_free);
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    Seen seen = {document, spore_object_child(bodies, i), simulation->world, SPORE_NO_BODY};
    seen.body = spore_simulation_body_of(simulation, seen.object);
    kept += seen.body != SPORE_NO_BODY && take_body(work, &seen);
  }
  if (kept > 0) {
    say_let_go(simulation->world, work->left_out);
    return work;
  }
  spore_error_raise(error, SPORE_ERROR_INPUT, "bodies", "%s",
                    work->left_out->len > 0 ? (const char *)work->left_out->pdata[0]
                                            : _("no body has moved; play first, and keep what you see then"));
  spore_pose_work_free(work);
  return NULL;
}

/* Tells of all numbers what is told of one body's. */
typedef struct Part {
  const SporeProgress *whole;
  double done, share;
} Part;

static bool report_part(void *data, double fraction, const char *stage) {
  const Part *part = data;
  return spore_progress(part->whole, part->done + part->share * fraction, _("writing the pose"));
}

gboolean spore_pose_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporePoseWork *work = data;
  double all = 1, done = 0;
  for (guint i = 0; i < work->bodies->len; i++) all += (double)g_array_index(work->bodies, Beginning, i).pose.count;
  for (guint i = 0; i < work->bodies->len; i++) {
    Beginning *body = &g_array_index(work->bodies, Beginning, i);
    Part part = {progress, done / all, (double)body->pose.count / all};
    const SporeProgress own = {report_part, &part, NULL};
    gsize size;
    if (!body->pose.q) continue;
    char *text = spore_kept_pose_format(&body->pose, &own, &size, error);
    if (!text) return FALSE;
    g_clear_pointer(&body->content, g_bytes_unref);
    body->content = g_bytes_new_take(text, size);
    done += (double)body->pose.count;
  }
  return TRUE;
}

static gboolean begin_so(const Beginning *body, SporeDocument *document, GError **error) {
  SporeObject *object = spore_document_by_id(document, body->object);
  if (!object) return TRUE;
  if (!body->content) return unset_pose(document, object, error);
  gsize size;
  const char *text = g_bytes_get_data(body->content, &size);
  g_autofree char *file = spore_content_file_name(body->name, "pose", text, size);
  spore_document_put_blob(document, file, body->content);
  return spore_document_set_text(document, object, "kept_pose", file, error);
}

gboolean spore_pose_work_apply(SporePoseWork *work, SporeDocument *document, GError **error) {
  gboolean done = TRUE;
  spore_document_begin(document, _("Keep this pose"));
  for (guint i = 0; done && i < work->bodies->len; i++)
    done = begin_so(&g_array_index(work->bodies, Beginning, i), document, error);
  return spore_edit_finish(document, done);
}

gboolean spore_edit_keep_pose(SporeDocument *document, const SporeSimulation *simulation, const SporeProgress *progress,
                              GPtrArray *left_out, GError **error) {
  SporePoseWork *work = spore_pose_work_new(document, simulation, error);
  gboolean done = work && spore_pose_work_run(work, progress, error) && spore_pose_work_apply(work, document, error);
  for (guint i = 0; done && i < work->left_out->len; i++) g_ptr_array_add(left_out, g_strdup(work->left_out->pdata[i]));
  g_clear_pointer(&work, spore_pose_work_free);
  return done;
}

static gboolean run(SporeWorld *world, guint64 steps, const SporeProgress *progress, GError **error) {
  for (guint64 i = 0; i < steps; i++) {
    gboolean wanted = spore_progress(progress, (double)i / (double)steps, _("running the scene"));
    if (wanted) spore_world_step(world);
    if (!wanted || spore_world_cancelled(world))
      return spore_error_raise(error, SPORE_ERROR_CANCELLED, NULL, "%s", _("cancelled"));
    spore_world_tidy(world);
  }
  return TRUE;
}

gboolean spore_edit_keep_pose_after(SporeDocument *document, double time_s, const SporeCancel *cancel,
                                    const SporeProgress *progress, GPtrArray *left_out, GError **error) {
  double step_s = spore_object_number(spore_document_section(document, "solver"), "time_step");
  g_autoptr(SporeSimulation) simulation = spore_simulation_new(document, NULL, NULL, cancel, error);
  return simulation && run(simulation->world, (guint64)llround(time_s / step_s), progress, error) &&
         spore_edit_keep_pose(document, simulation, progress, left_out, error);
}

gboolean spore_edit_forget_pose(SporeDocument *document, GError **error) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  gboolean done = TRUE;
  spore_document_begin(document, _("Forget the kept pose"));
  for (guint i = 0; done && i < spore_object_child_count(bodies); i++)
    done = unset_pose(document, spore_object_child(bodies, i), error);
  return spore_edit_finish(document, done);
}
