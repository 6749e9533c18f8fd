/* What the scene says of a body that may be physical or an effect. */
#include "core/scene/fidelity.h"

#include "core/scene/run_hash.h"
#include "core/scene/schema_fields.h"

static char *hash_of(SporeDocument *document) {
  return g_strdup_printf("%016" G_GINT64_MODIFIER "x", spore_document_advice_hash(document));
}

SporeFidelityState spore_fidelity_state(SporeDocument *document, const SporeObject *fidelity) {
  SporeFidelityFields fields;
  if (!fidelity) return SPORE_FIDELITY_IS_PHYSICAL;
  spore_object_fields(fidelity, &fields);
  if (fields.mode != SPORE_FIDELITY_AUTO)
    return fields.mode == SPORE_FIDELITY_EFFECT ? SPORE_FIDELITY_IS_EFFECT : SPORE_FIDELITY_IS_PHYSICAL;
  if (!fields.advice_hash || !*fields.advice_hash) return SPORE_FIDELITY_NOT_ADVISED;
  g_autofree char *hash = hash_of(document);
  if (!g_str_equal(hash, fields.advice_hash)) return SPORE_FIDELITY_OUTDATED;
  return fields.advice == SPORE_FIDELITY_EFFECT ? SPORE_FIDELITY_IS_EFFECT : SPORE_FIDELITY_IS_PHYSICAL;
}

gboolean spore_fidelity_set_mode(SporeDocument *document, SporeObject *body, const char *mode, GError **error) {
  SporeObject *fidelity = spore_object_child_of(body, "fidelity");
  if (!fidelity) fidelity = spore_document_insert(document, body, "fidelity", NULL, G_MAXUINT, error);
  return fidelity && spore_document_set_text(document, fidelity, "mode", mode, error);
}

gboolean spore_fidelity_advise(SporeDocument *document, SporeObject *body, gboolean effect, GError **error) {
  if (!spore_fidelity_set_mode(document, body, "auto", error)) return FALSE;
  SporeObject *fidelity = spore_object_child_of(body, "fidelity");
  g_autofree char *hash = hash_of(document);
  return spore_document_set_text(document, fidelity, "advice", effect ? "effect" : "physical", error) &&
         spore_document_set_text(document, fidelity, "advice_hash", hash, error);
}

gboolean spore_fidelity_resolve(SporeDocument *document, GError **error) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i), *fidelity = spore_object_child_of(body, "fidelity");
    if (!fidelity || (int)spore_object_number(fidelity, "mode") != SPORE_FIDELITY_AUTO) continue;
    gboolean effect = spore_fidelity_state(document, fidelity) == SPORE_FIDELITY_IS_EFFECT;
    if (!spore_fidelity_set_mode(document, body, effect ? "effect" : "physical", error)) return FALSE;
  }
  return TRUE;
}
