/* Makes organs soft in one step: tetrahedra, collision spheres, the tissue that the name says, and a pin. */
#include "core/author/soft_edits.h"

#include <glib/gi18n.h>

#include "core/author/anatomy.h"
#include "core/author/edits.h"

/* An organ of a large selection keeps at least this much. */
#define LEAST_CELLS 100
#define MOST_CELLS 1000
#define LEAST_SPHERES 12
#define MOST_SPHERES 60
/* Share of an organ's work that tetrahedra take, about. */
#define TETRAHEDRA_SHARE 0.75

/* Preparing. */

gboolean spore_soft_may(SporeDocument *document, SporeObject *body, GError **error) {
  g_autofree char *path = spore_object_path(body);
  if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE)
    return spore_error_raise(error, SPORE_ERROR_INPUT, path,
                             _("a hand leads the body, which is an instrument; expected an organ; choose another"));
  SporeObject *model = spore_body_model_object(body);
  if (model)
    return spore_error_raise(error, SPORE_ERROR_INPUT, path,
                             _("the body has the model %s already; expected one without; remove its mechanical unit"),
                             spore_object_type(model)->element);
  return spore_edit_visual_mesh(document, body, error) != NULL;
}

static SporeGenerateWork *new_run(SporeDocument *document, SporeObject *body, SporeGenerateKind kind, gsize count,
                                  GError **error) {
  SporeGenerateOptions options = spore_generate_options_of(document, body, kind);
  spore_generate_set_count(&options, count);
  return spore_generate_work_new(document, body, &options, error);
}

static void free_organ(gpointer data) {
  SporeSoftOrgan *organ = data;
  g_free(organ->name);
  g_clear_pointer(&organ->tetrahedra, spore_generate_work_unref);
  g_clear_pointer(&organ->spheres, spore_generate_work_unref);
  g_clear_error(&organ->refused);
  g_free(organ);
}

static SporeSoftOrgan *new_organ(SporeDocument *document, SporeObject *body, guint count, GError **error) {
  if (!spore_soft_may(document, body, error)) return NULL;
  const gsize cells = CLAMP(SPORE_SOFT_CELLS / count, LEAST_CELLS, MOST_CELLS);
  const gsize spheres = CLAMP(SPORE_SOFT_SPHERES / count, LEAST_SPHERES, MOST_SPHERES);
  SporeSoftOrgan *organ = g_new0(SporeSoftOrgan, 1);
  organ->name = g_strdup(spore_object_name(body));
  organ->tetrahedra = new_run(document, body, SPORE_GENERATE_TETRAHEDRA, cells, error);
  const gboolean bare = !spore_edit_body_spheres(document, body);
  if (organ->tetrahedra && bare) organ->spheres = new_run(document, body, SPORE_GENERATE_SPHERES, spheres, error);
  if (organ->tetrahedra && (organ->spheres || !bare)) return organ;
  free_organ(organ);
  return NULL;
}

SporeSoftWork *spore_soft_work_new(SporeDocument *document, const GPtrArray *bodies, GError **error) {
  g_autoptr(GPtrArray) all = g_ptr_array_new();
  for (guint i = 0; i < bodies->len; i++)
    if (!g_ptr_array_find(all, bodies->pdata[i], NULL)) g_ptr_array_add(all, bodies->pdata[i]);
  g_return_val_if_fail(all->len > 0, NULL);
  SporeSoftWork *work = g_new(SporeSoftWork, 1);
  work->organs = g_ptr_array_new_with_free_func(free_organ);
  for (guint i = 0; i < all->len; i++) {
    SporeSoftOrgan *organ = new_organ(document, all->pdata[i], all->len, error);
    if (!organ) {
      spore_soft_work_free(work);
      return NULL;
    }
    g_ptr_array_add(work->organs, organ);
  }
  return work;
}

void spore_soft_work_free(gpointer data) {
  SporeSoftWork *work = data;
  g_ptr_array_unref(work->organs);
  g_free(work);
}

/* Running. */

/* Progress of one organ, whose name stands before what is done. It never falls: a generator that tries another method
 * begins again. */
typedef struct Part {
  const SporeProgress *whole;
  const SporeSoftOrgan *organ;
  double done, share;
  double furthest; /* 0 to 1 */
} Part;

static bool report_part(void *data, double fraction, const char *stage) {
  Part *part = data;
  g_autofree char *text = stage ? g_strdup_printf("%s: %s", part->organ->name, stage) : g_strdup(part->organ->name);
  part->furthest = MAX(part->furthest, fraction);
  return spore_progress(part->whole, part->done + part->share * part->furthest, text);
}

/* FALSE: cancelled. A run that cannot be done for another reason refuses the organ. */
static gboolean run_one(SporeSoftOrgan *organ, SporeGenerateWork *run, Part *part, GError **error) {
  const SporeProgress progress = {.report = report_part, .data = part};
  if (!run || organ->refused) return TRUE;
  g_autoptr(GError) failure = NULL;
  if (spore_generate_work_run(run, &progress, &failure)) return TRUE;
  GError **where = g_error_matches(failure, SPORE_ERROR, SPORE_ERROR_CANCELLED) ? error : &organ->refused;
  g_propagate_error(where, g_steal_pointer(&failure));
  return where == &organ->refused;
}

gboolean spore_soft_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeSoftWork *work = data;
  const double share = 1.0 / work->organs->len;
  guint made = 0;
  for (guint i = 0; i < work->organs->len; i++) {
    SporeSoftOrgan *organ = work->organs->pdata[i];
    Part solid = {progress, organ, i * share, TETRAHEDRA_SHARE * share, 0};
    Part felt = {progress, organ, (i + TETRAHEDRA_SHARE) * share, (1 - TETRAHEDRA_SHARE) * share, 0};
    if (!run_one(organ, organ->tetrahedra, &solid, error) || !run_one(organ, organ->spheres, &felt, error))
      return FALSE;
    made += !organ->refused;
  }
  if (made) return TRUE;
  const SporeSoftOrgan *first = work->organs->pdata[0];
  g_propagate_error(error, g_error_copy(first->refused));
  return FALSE;
}

/* Applying. */

static gboolean is_held(const SporeDocument *document, const SporeObject *body) {
  const SporeObject *links = spore_document_section(document, "links");
  for (guint i = 0; i < spore_object_child_count(links); i++)
    if (spore_object_refers_to(spore_object_child(links, i), body)) return TRUE;
  return FALSE;
}

/* A colour that the file or the author gave stays. */
static gboolean has_colour(const SporeObject *body) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  return spore_object_is_set(visual, (guint)spore_parameter_find(spore_object_type(visual)->table, "colour"));
}

static gboolean use_name(SporeDocument *document, SporeObject *body, GError **error) {
  const char *name = spore_object_name(body), *material = spore_anatomy_material(name);
  SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  double colour[3];
  if (material && !spore_document_set_text(document, mechanical, "material", material, error)) return FALSE;
  if (has_colour(body) || !spore_anatomy_knows(name)) return TRUE;
  spore_anatomy_colour(name, 0, colour);
  return spore_edit_set_colour(document, body, colour, error);
}

static gboolean apply_organ(const SporeSoftOrgan *organ, SporeDocument *document, GError **error) {
  if (!spore_generate_work_apply(organ->tetrahedra, document, error)) return FALSE;
  if (organ->spheres && !spore_generate_work_apply(organ->spheres, document, error)) return FALSE;
  SporeObject *body = spore_generate_work_body(organ->tetrahedra, document);
  return use_name(document, body, error) && (is_held(document, body) || spore_edit_add_pin(document, body, error));
}

gboolean spore_soft_work_apply(const SporeSoftWork *work, SporeDocument *document, GError **error) {
  gboolean done = TRUE;
  spore_document_begin(document, _("Make soft"));
  for (guint i = 0; done && i < work->organs->len; i++) {
    const SporeSoftOrgan *organ = work->organs->pdata[i];
    done = organ->refused || apply_organ(organ, document, error);
  }
  return spore_edit_finish(document, done);
}

static const SporeTissue *tissue_of(const SporeSoftOrgan *organ) {
  const char *material = spore_anatomy_material(organ->name);
  const SporeTissue *tissue = spore_tissues;
  while (material && tissue->name && !g_str_equal(tissue->name, material)) tissue++;
  return material && tissue->name ? tissue : NULL;
}

char *spore_soft_organ_text(const SporeSoftOrgan *organ) {
  if (organ->refused) return g_strdup_printf(_("%s: left out: %s"), organ->name, organ->refused->message);
  const SporeTissue *tissue = tissue_of(organ);
  const SporeGenerateWork *made = organ->tetrahedra;
  return g_strdup_printf(_("%s: %zu tetrahedra, error %.2f %%, tissue: %s"), organ->name,
                         made->tetrahedra.tetrahedron_count, 100 * made->tetrahedra_report.hausdorff,
                         tissue ? _(tissue->label) : _("not known by the name"));
}
