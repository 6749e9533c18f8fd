/* The stage: what is drawn of a document, built from its objects and moved by snapshots of the simulation. */
#include <string.h>

#include "ui/render/stage_body.h"
#include "ui/render/stage_ports.h"

SporeStage *spore_stage_new(SporeRenderer *renderer, SporeDocument *document) {
  SporeStage *stage = g_new0(SporeStage, 1);
  stage->renderer = renderer;
  stage->document = document;
  stage->options.surfaces = TRUE;
  stage->bodies = g_ptr_array_new();
  stage->textures = spore_stage_textures_new();
  stage->fits = spore_stage_fits_new();
  stage->port_lines = g_array_new(FALSE, FALSE, sizeof(guint));
  stage->lenses = g_array_new(FALSE, FALSE, sizeof(SporeLensState));
  stage->squeezes = g_array_new(FALSE, FALSE, sizeof(SporeSqueeze));
  stage->links = spore_stage_links_new();
  stage->contacts = g_array_new(FALSE, FALSE, sizeof(double));
  stage->painted_values = g_array_new(FALSE, FALSE, sizeof(float));
  stage->selection = g_hash_table_new(NULL, NULL);
  return stage;
}

void spore_stage_measure_aside(SporeStage *stage, void (*found)(gpointer data), gpointer data) {
  stage->found = found;
  stage->found_data = data;
}

static void clear(SporeStage *stage) {
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_free(stage, stage->bodies->pdata[i]);
  g_ptr_array_set_size(stage->bodies, 0);
  if (stage->contact_handle) spore_renderer_remove(stage->renderer, stage->contact_handle);
  stage->contact_handle = 0;
  spore_stage_links_clear(stage);
}

void spore_stage_free(SporeStage *stage) {
  if (!stage) return;
  spore_stage_set_candidate(stage, NULL);
  spore_stage_set_marks(stage, NULL);
  spore_stage_set_ports(stage, NULL, 0);
  clear(stage);
  spore_stage_drop_textures(stage); /* those of the last bodies */
  spore_stage_drop_textures(stage);
  g_hash_table_destroy(stage->textures);
  g_ptr_array_free(stage->bodies, TRUE);
  spore_stage_fits_free(stage->fits);
  g_hash_table_destroy(stage->selection);
  g_array_free(stage->contacts, TRUE);
  g_array_free(stage->links, TRUE);
  g_array_free(stage->painted_values, TRUE);
  g_array_free(stage->lenses, TRUE);
  g_array_free(stage->squeezes, TRUE);
  g_array_free(stage->port_lines, TRUE);
  g_free(stage);
}

void spore_stage_rebuild(SporeStage *stage, const SporeSimulation *simulation) {
  static const float contact_colour[3] = {0.95f, 0.62f, 0.05f};
  clear(stage);
  stage->simulation = simulation;
  stage->cut_count = 0;
  stage->touch_end = 0;
  g_array_set_size(stage->lenses, 0);
  g_array_set_size(stage->squeezes, 0);
  const SporeObject *bodies = spore_document_section(stage->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    g_ptr_array_add(stage->bodies, spore_stage_body_new(stage, spore_object_child(bodies, i), simulation, NULL));
  spore_stage_mix_liquids(stage);
  spore_stage_drop_textures(stage);
  stage->contact_handle = spore_renderer_add_lines(stage->renderer, NULL, 0, contact_colour, 2.5f);
  spore_renderer_set_visible(stage->renderer, stage->contact_handle, stage->options.contacts);
  spore_stage_links_rebuild(stage);
  spore_stage_place_candidate(stage);
  spore_stage_place_marks(stage);
}

/* Each contact is a line from its point along its force. The length grows with the force, up to a limit. */
static void show_contacts(SporeStage *stage, const SporeSnapshot *snapshot) {
  double lower[3], upper[3];
  spore_stage_bounds(stage, lower, upper);
  double longest = 0.25 * spore_vec3_distance(spore_vec3_load(lower), spore_vec3_load(upper));
  gsize count = MIN(snapshot->contact_count, snapshot->contact_capacity);
  g_array_set_size(stage->contacts, (guint)(6 * count));
  stage->contact_longest = longest;
  stage->contact_most = 0;
  double *out = (double *)stage->contacts->data;
  for (gsize i = 0; i < count; i++, out += 6) {
    const SporeSnapshotContact *contact = &snapshot->contacts[i];
    double force = spore_vec3_length(contact->force);
    double scale = longest / (1 + force); /* 1 N is half of the longest */
    stage->contact_most = MAX(stage->contact_most, force);
    spore_vec3_store(out, contact->point);
    spore_vec3_store(out + 3, spore_vec3_add_scaled(contact->point, scale, contact->force));
  }
  spore_renderer_move_lines(stage->renderer, stage->contact_handle, (const double *)stage->contacts->data, count);
}

static void show_cuts(SporeStage *stage, const SporeSnapshot *snapshot) {
  if (stage->cut_count == snapshot->cuts.count && stage->cut_run == snapshot->cut_run) return;
  stage->cut_count = snapshot->cuts.count;
  stage->cut_run = snapshot->cut_run;
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_cut(stage, stage->bodies->pdata[i], &snapshot->cuts);
}

/* The drawn body, made anew where the snapshot has it at another level. */
static SporeStageBody *body_of_level(SporeStage *stage, guint index, const SporeSnapshot *snapshot) {
  SporeStageBody *body = stage->bodies->pdata[index];
  if (!snapshot->level || body->world_body == SPORE_NO_BODY) return body;
  SporeLodGrade level = (SporeLodGrade)snapshot->level[body->world_body];
  SporeObject *object = level == body->level ? NULL : spore_document_by_id(stage->document, body->object);
  if (!object) return body;
  spore_stage_body_free(stage, body);
  body = stage->bodies->pdata[index] = spore_stage_body_new(stage, object, stage->simulation, &level);
  spore_stage_body_show(stage, body);
  return body;
}

/* Whether tissue is drawn squeezed otherwise than before. */
static gboolean take_squeezes(SporeStage *stage, const SporeSnapshot *snapshot) {
  gsize bytes = snapshot->squeeze_count * sizeof *snapshot->squeezes;
  if (stage->squeezes->len == snapshot->squeeze_count &&
      (bytes == 0 || memcmp(stage->squeezes->data, snapshot->squeezes, bytes) == 0))
    return FALSE;
  g_array_set_size(stage->squeezes, 0);
  if (bytes) g_array_append_vals(stage->squeezes, snapshot->squeezes, (guint)snapshot->squeeze_count);
  return TRUE;
}

void spore_stage_update(SporeStage *stage, const SporeSnapshot *snapshot) {
  gboolean flowed = FALSE, squeezed = take_squeezes(stage, snapshot);
  for (guint i = 0; i < stage->bodies->len; i++) {
    SporeStageBody *body = body_of_level(stage, i, snapshot);
    if (!body->moves && squeezed) spore_stage_body_place(stage, body);
    if (!body->moves) continue;
    const double *q = snapshot->q + body->q_offset;
    spore_stage_body_follow_knots(body, stage->simulation, snapshot);
    gboolean divided = body->cells && body->divided != snapshot->cuts.parted;
    if (!divided && !squeezed && memcmp(body->q, q, body->q_count * sizeof *q) == 0) continue;
    memcpy(body->q, q, body->q_count * sizeof *q);
    spore_stage_body_divide(stage, body, &snapshot->cuts);
    spore_stage_body_place(stage, body);
    flowed |= body->liquid;
  }
  if (flowed) spore_stage_mix_liquids(stage);
  show_cuts(stage, snapshot);
  g_array_set_size(stage->lenses, 0);
  if (snapshot->lens_count) g_array_append_vals(stage->lenses, snapshot->lenses, (guint)snapshot->lens_count);
  for (guint i = 0; snapshot->stain && i < stage->bodies->len; i++)
    spore_stage_body_stain(stage, stage->bodies->pdata[i], snapshot);
  spore_stage_show_field(stage, snapshot);
  spore_stage_show_touch(stage, snapshot);
  if (stage->marks_handle) spore_renderer_set_visible(stage->renderer, stage->marks_handle, snapshot->step == 0);
  if (stage->options.contacts && stage->contact_handle) show_contacts(stage, snapshot);
  spore_stage_show_links(stage, snapshot);
}

void spore_stage_set_options(SporeStage *stage, const SporeStageOptions *options) {
  if (options->field != stage->options.field) spore_stage_drop_field(stage);
  spore_stage_drop_touch(stage); /* the next snapshot brings it again */
  stage->options = *options;
  for (guint i = 0; i < stage->bodies->len; i++) {
    spore_stage_body_show(stage, stage->bodies->pdata[i]);
    spore_stage_body_place(stage, stage->bodies->pdata[i]);
  }
  spore_stage_mix_liquids(stage);
  if (stage->contact_handle) spore_renderer_set_visible(stage->renderer, stage->contact_handle, options->contacts);
  spore_stage_mark_links(stage, stage->marks_links);
}

void spore_stage_set_hidden(SporeStage *stage, GHashTable *hidden) {
  stage->hidden = hidden;
  for (guint i = 0; i < stage->bodies->len; i++) spore_stage_body_show(stage, stage->bodies->pdata[i]);
}

void spore_stage_set_clip(SporeStage *stage, const SporeClip *clip) { stage->clip = *clip; }

void spore_stage_set_selection(SporeStage *stage, const guint32 *object_ids, gsize count) {
  g_hash_table_remove_all(stage->selection);
  for (gsize i = 0; i < count; i++) {
    const SporeObject *object = spore_document_by_id(stage->document, object_ids[i]);
    while (object && strcmp(spore_object_type(object)->element, "body") != 0) object = spore_object_parent(object);
    if (object) g_hash_table_add(stage->selection, GUINT_TO_POINTER(spore_object_id(object)));
  }
  for (guint i = 0; i < stage->bodies->len; i++) {
    SporeStageBody *body = stage->bodies->pdata[i];
    gboolean selected = g_hash_table_contains(stage->selection, GUINT_TO_POINTER(body->object));
    if (body->style.selected == selected) continue;
    body->style.selected = selected;
    if (body->surface_handle) spore_renderer_style_surface(stage->renderer, body->surface_handle, &body->style);
  }
}
