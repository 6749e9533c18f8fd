/* Checks of materials: parameters that lie far from the values of the material that the author named. */
#include <glib/gi18n.h>

#include "core/scene/check_private.h"

/* Whether the model has a parameter for which the tissue has a value. */
static gboolean takes_something(const SporeObject *model, const SporeTissue *tissue) {
  const SporeParameterTable *table = spore_object_type(model)->table;
  for (size_t i = 0; i < table->count; i++)
    if (spore_tissue_value(tissue, &table->parameters[i])) return TRUE;
  return FALSE;
}

static void check_value(SporeCheck *check, const SporeObject *model, const SporeTissue *tissue, guint property) {
  const char *name = spore_object_type(model)->table->parameters[property].name;
  const SporeTissueQuantity *quantity = spore_tissue_find(tissue, name);
  if (!quantity || !spore_object_is_set(model, property) || quantity->maximum <= quantity->minimum) return;
  double value = spore_object_value(model, property)->number[0];
  if (value >= quantity->minimum && value <= quantity->maximum) return;
  if (value == 0 && !spore_tissue_fills(name)) return; /* switched off */
  g_autofree char *remedy =
      g_strdup_printf(_("leave it out, to have %g, or choose the material that it is of"), quantity->typical.number[0]);
  spore_check_say(check, SPORE_WARNING, model, remedy,
                  _("%s=\"%g\" lies outside of what was measured of %s: %g to %g %s (%s)"), name, value,
                  _(tissue->label), quantity->minimum, quantity->maximum, quantity->unit, _(quantity->source));
}

static void check_body(SporeCheck *check, SporeObject *body) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  if (!mechanical || spore_object_child_count(mechanical) == 0) return;
  const SporeObject *model = spore_object_child(mechanical, 0);
  const SporeTissue *tissue = spore_object_tissue(model);
  if (!tissue) return;
  for (guint i = 0; i < spore_object_type(model)->table->count; i++) check_value(check, model, tissue, i);
  if (takes_something(model, tissue)) return;
  spore_check_say(check, SPORE_NOTE, mechanical, _("set its values yourself, or choose another model or material"),
                  _("material=\"%s\" says nothing to %s, which has none of its figures"), tissue->name,
                  spore_object_type(model)->element);
}

void spore_check_materials(SporeCheck *check) { spore_check_each(check, "bodies", NULL, check_body); }
