/* What the scene says of what may be physical or an effect. */
#include "core/scene/fidelity.h"

#include <string.h>

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

GPtrArray *spore_fidelity_holders(SporeDocument *document) {
  static const char *const sections[] = {"bodies", "tools", "effects"};
  GPtrArray *holders = g_ptr_array_new();
  for (gsize k = 0; k < G_N_ELEMENTS(sections); k++) {
    SporeObject *section = spore_document_section(document, sections[k]);
    for (guint i = 0; i < spore_object_child_count(section); i++)
      if (spore_object_child_of(spore_object_child(section, i), "fidelity"))
        g_ptr_array_add(holders, spore_object_child(section, i));
  }
  return holders;
}

gboolean spore_fidelity_is_effect(SporeDocument *document, const SporeObject *holder) {
  return spore_fidelity_state(document, spore_object_child_of(holder, "fidelity")) == SPORE_FIDELITY_IS_EFFECT;
}

gboolean spore_fidelity_is_seen(const SporeObject *holder) {
  const SporeObjectType *type = spore_object_type(holder);
  if (!spore_object_type_child(type, "fidelity")) return FALSE;
  if (strcmp(type->element, "emitter") != 0) return TRUE;
  const SporeObject *fluid = spore_object_reference(holder, "body"), *source = spore_object_reference(holder, "source");
  const SporeObject *model = fluid ? spore_body_model_object(fluid) : NULL;
  int stain = model ? spore_parameter_find(spore_object_type(model)->table, "stain") : -1;
  return source && (int)spore_object_number(source, "role") != SPORE_ACTIVE && stain >= 0 &&
         spore_object_number(model, "stain") > 0;
}

gboolean spore_fidelity_set_mode(SporeDocument *document, SporeObject *holder, const char *mode, GError **error) {
  SporeObject *fidelity = spore_object_child_of(holder, "fidelity");
  if (!fidelity) fidelity = spore_document_insert(document, holder, "fidelity", NULL, G_MAXUINT, error);
  return fidelity && spore_document_set_text(document, fidelity, "mode", mode, error);
}

gboolean spore_fidelity_advise(SporeDocument *document, SporeObject *holder, gboolean effect, GError **error) {
  if (!spore_fidelity_set_mode(document, holder, "auto", error)) return FALSE;
  SporeObject *fidelity = spore_object_child_of(holder, "fidelity");
  g_autofree char *hash = hash_of(document);
  return spore_document_set_text(document, fidelity, "advice", effect ? "effect" : "physical", error) &&
         spore_document_set_text(document, fidelity, "advice_hash", hash, error);
}

gboolean spore_fidelity_resolve(SporeDocument *document, GError **error) {
  g_autoptr(GPtrArray) holders = spore_fidelity_holders(document);
  for (guint i = 0; i < holders->len; i++) {
    SporeObject *holder = holders->pdata[i];
    if ((int)spore_object_number(spore_object_child_of(holder, "fidelity"), "mode") != SPORE_FIDELITY_AUTO) continue;
    gboolean effect = spore_fidelity_is_effect(document, holder);
    if (!spore_fidelity_set_mode(document, holder, effect ? "effect" : "physical", error)) return FALSE;
  }
  return TRUE;
}
