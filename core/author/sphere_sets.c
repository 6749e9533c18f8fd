/* Generates the sets of spheres of a copy of a document anew, by other numbers. */
#include "core/author/sphere_sets.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/generator_work.h"

#define LEAST_SPHERES 1.
#define MOST_SPHERES 5000. /* of a set: the largest that the option count takes */

/* The generated set of a body; NULL: it has none. */
static SporeObject *generated_set(SporeDocument *document, SporeObject *body) {
  SporeObject *asset = spore_edit_body_spheres(document, body);
  const char *source = asset ? spore_object_text(asset, "source") : NULL;
  return source && *source ? asset : NULL;
}

static gboolean generate(SporeDocument *copy, SporeObject *body, SporeObject *asset, double factor,
                         const SporeProgress *progress, GError **error) {
  const SporeSphereSet *set = spore_document_spheres(copy, asset, error);
  if (!set) return FALSE;
  double wanted = CLAMP(round(factor * (double)set->count), LEAST_SPHERES, MOST_SPHERES);
  SporeGenerateOptions options = spore_generate_options_of(copy, body, SPORE_GENERATE_SPHERES);
  options = spore_generate_by_number(&options);
  spore_generate_set_count(&options, (size_t)wanted);
  SporeGenerateWork *work = spore_generate_work_new(copy, body, &options, error);
  gboolean done =
      work && spore_generate_work_run(work, progress, error) && spore_generate_work_apply(work, copy, error);
  if (work) spore_generate_work_unref(work);
  return done;
}

/* Each set once, whatever bodies share it. *varied: how many there were. */
static gboolean vary(SporeDocument *copy, const char *name, double factor, guint *varied, const SporeProgress *progress,
                     GError **error) {
  g_autoptr(GHashTable) seen = g_hash_table_new(NULL, NULL);
  const SporeObject *bodies = spore_document_section(copy, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i), *asset = generated_set(copy, body);
    if (!asset || (name && !g_str_equal(name, spore_object_name(body))) || !g_hash_table_add(seen, asset)) continue;
    ++*varied;
    if (factor != 1 && !generate(copy, body, asset, factor, progress, error)) return FALSE;
  }
  return TRUE;
}

SporeDocument *spore_sphere_sets_vary(SporeDocument *document, const char *body, double factor,
                                      const SporeProgress *progress, GError **error) {
  SporeDocument *copy = spore_document_copy(document);
  guint varied = 0;
  gboolean good = vary(copy, body, factor, &varied, progress, error);
  if (good && varied > 0) return copy;
  if (good)
    spore_error_raise(error, SPORE_ERROR_INPUT, body,
                      _("no spheres here were generated from a mesh of the scene; expected a set with a source; "
                        "generate spheres (spore spheres SCENE --body NAME)"));
  spore_document_free(copy);
  return NULL;
}
