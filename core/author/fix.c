/* Does what diagnostics offer: holds, sets, removes and generates. */
#include "core/author/fix.h"

#include <glib/gi18n.h>

#include "core/author/edits.h"
#include "core/author/generator_work.h"

struct SporeFixWork {
  SporeFix fix;
  guint32 object;
  char *path, *properties, *value, *label; /* as of the diagnostic */
  SporeGenerateWork *generate;             /* NULL: there is nothing to generate */
};

const char *spore_fix_name(SporeFix fix) {
  static const char *const names[] = {NULL, "hold", "locate", "set", "remove", "generate"};
  return names[fix];
}

gboolean spore_fix_asks_nothing(const SporeDiagnostic *diagnostic) {
  return diagnostic->fix != SPORE_FIX_NONE && diagnostic->fix != SPORE_FIX_LOCATE;
}

char *spore_fix_label(const SporeDiagnostic *diagnostic) {
  g_autofree char *names = diagnostic->properties ? g_strdelimit(g_strdup(diagnostic->properties), "|", ' ') : NULL;
  switch (diagnostic->fix) {
  case SPORE_FIX_HOLD:
    return g_strdup(_("Hold it"));
  case SPORE_FIX_LOCATE:
    return g_strdup(_("Locate it…"));
  case SPORE_FIX_REMOVE:
    return g_strdup(_("Remove it"));
  case SPORE_FIX_GENERATE:
    return g_strdup(_("Generate it"));
  case SPORE_FIX_SET:
    return diagnostic->value ? g_strdup_printf(_("Set %s to %s"), names, diagnostic->value)
                             : g_strdup_printf(_("Take out %s"), names);
  default:
    return NULL;
  }
}

/* The body whose asset of that kind this is; the object itself where it is a body without spheres. */
static SporeObject *body_made_of(SporeDocument *document, SporeObject *object, SporeGenerateKind *kind) {
  static const SporeGenerateKind kinds[] = {SPORE_GENERATE_SPHERES, SPORE_GENERATE_TETRAHEDRA, SPORE_GENERATE_SURFACE,
                                            SPORE_GENERATE_CURVE};
  const SporeObject *bodies = spore_document_section(document, "bodies");
  *kind = SPORE_GENERATE_SPHERES;
  if (g_str_equal(spore_object_type(object)->element, "body")) return object;
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    for (gsize k = 0; k < G_N_ELEMENTS(kinds); k++) {
      *kind = kinds[k];
      if (spore_generate_target(document, spore_object_child(bodies, i), *kind) == object)
        return spore_object_child(bodies, i);
    }
  return NULL;
}

static gboolean make_generator(SporeFixWork *work, SporeDocument *document, SporeObject *object, GError **error) {
  SporeGenerateKind kind;
  SporeObject *body = body_made_of(document, object, &kind);
  if (!body)
    return spore_error_raise(error, SPORE_ERROR_INPUT, work->path,
                             _("no body is made of it; expected one; generate it from a body, or remove it"));
  SporeGenerateOptions options = spore_generate_options_of(document, body, kind);
  work->generate = spore_generate_work_new(document, body, &options, error);
  return work->generate != NULL;
}

SporeFixWork *spore_fix_work_new(SporeDocument *document, const SporeDiagnostic *diagnostic, GError **error) {
  SporeObject *object = spore_document_by_id(document, diagnostic->fixed);
  if (!spore_fix_asks_nothing(diagnostic) || !object) {
    spore_error_raise(error, SPORE_ERROR_INPUT, diagnostic->place, "%s",
                      _("there is no fix for this; expected a problem with one; do what its remedy says"));
    return NULL;
  }
  SporeFixWork *work = g_new0(SporeFixWork, 1);
  *work = (SporeFixWork){.fix = diagnostic->fix,
                         .object = diagnostic->fixed,
                         .path = spore_object_path(object),
                         .properties = g_strdup(diagnostic->properties),
                         .value = g_strdup(diagnostic->value),
                         .label = spore_fix_label(diagnostic)};
  if (work->fix != SPORE_FIX_GENERATE || make_generator(work, document, object, error)) return work;
  spore_fix_work_free(work);
  return NULL;
}

void spore_fix_work_free(gpointer data) {
  SporeFixWork *work = data;
  g_free(work->path);
  g_free(work->properties);
  g_free(work->value);
  g_free(work->label);
  if (work->generate) spore_generate_work_unref(work->generate);
  g_free(work);
}

gboolean spore_fix_work_is_long(const SporeFixWork *work) { return work->generate != NULL; }

gboolean spore_fix_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeFixWork *work = data;
  return !work->generate || spore_generate_work_run(work->generate, progress, error);
}

static gboolean set(const SporeFixWork *work, SporeDocument *document, SporeObject *object, GError **error) {
  g_auto(GStrv) names = g_strsplit(work->properties, "|", -1);
  for (guint i = 0; names[i]; i++) {
    int property = spore_parameter_find(spore_object_type(object)->table, names[i]);
    gboolean done = work->value ? spore_document_set_text(document, object, names[i], work->value, error)
                                : spore_document_unset(document, object, (guint)property, error);
    if (!done) return FALSE;
  }
  return TRUE;
}

gboolean spore_fix_work_apply(const SporeFixWork *work, SporeDocument *document, GError **error) {
  SporeObject *object = spore_document_by_id(document, work->object);
  gboolean done = FALSE;
  if (!object) return spore_error_raise(error, SPORE_ERROR_INPUT, work->path, _("it is not there any more"));
  if (work->generate) return spore_generate_work_apply(work->generate, document, error);
  spore_document_begin(document, work->label);
  if (work->fix == SPORE_FIX_HOLD) done = spore_edit_add_pin(document, object, error) != NULL;
  else if (work->fix == SPORE_FIX_REMOVE) done = spore_document_remove(document, object, error);
  else done = set(work, document, object, error);
  return spore_edit_finish(document, done);
}

const char *spore_fix_work_path(const SporeFixWork *work) { return work->path; }
