/* Sets in a copy of a document what a variation says, and compiles the copy. */
#include "core/scene/variation.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/integrate/integrator.h"
#include "core/scene/fidelity.h"

/* Sets one property of the copy, held within its range. */
static gboolean set_number(SporeDocument *copy, SporeObject *object, const char *name, double number, GError **error) {
  int property = spore_parameter_find(spore_object_type(object)->table, name);
  g_assert(property >= 0);
  const SporeParameter *parameter = &spore_object_type(object)->table->parameters[property];
  SporeValue value = {.type = parameter->type, .number = {CLAMP(number, parameter->minimum, parameter->maximum)}};
  return spore_document_set(copy, object, (guint)property, &value, error);
}

static gboolean set_text(SporeDocument *copy, SporeObject *object, const char *name, const char *text, GError **error) {
  return !text || spore_document_set_text(copy, object, name, text, error);
}

static gboolean vary_solver(SporeDocument *copy, const SporeVariation *variation, GError **error) {
  SporeObject *solver = spore_document_section(copy, "solver");
  if (!set_text(copy, solver, "nonlinear", variation->nonlinear, error)) return FALSE;
  if (!set_text(copy, solver, "linear", variation->linear, error)) return FALSE;
  if (variation->dt_s > 0 && !set_number(copy, solver, "time_step", variation->dt_s, error)) return FALSE;
  if (variation->tolerance > 0 && !set_number(copy, solver, "tolerance", variation->tolerance, error)) return FALSE;
  if (variation->awake && !set_number(copy, solver, "sleep_speed", 0, error)) return FALSE;
  return TRUE;
}

/* Whether a parameter of a model is a stiffness, by its unit, or a mass, by its unit too. */
static gboolean is_one_of(const char *unit, const char *const *units) { return g_strv_contains(units, unit); }

static gboolean scale(SporeDocument *copy, SporeObject *model, const char *const *units, double factor,
                      GError **error) {
  const SporeParameterTable *table = spore_object_type(model)->table;
  if (factor <= 0 || factor == 1) return TRUE;
  for (gsize i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    if (parameter->type != SPORE_REAL || !is_one_of(parameter->unit, units)) continue;
    double number = spore_object_number(model, parameter->name);
    if (number > 0 && !set_number(copy, model, parameter->name, factor * number, error)) return FALSE;
  }
  return TRUE;
}

static const char *const stiffnesses[] = {"Pa", "N/m", "N/m^2", "N/m^3", NULL};

static gboolean vary_model(SporeDocument *copy, SporeObject *model, const SporeVariation *variation, GError **error) {
  static const char *const masses[] = {"kg", "kg/m", "kg/m^2", "kg/m^3", NULL};
  return scale(copy, model, stiffnesses, variation->stiffness, error) &&
         scale(copy, model, masses, variation->mass, error);
}

static gboolean set_rule(SporeDocument *copy, SporeObject *fidelity, SporeLodCause by, GError **error) {
  return set_text(copy, fidelity, "automatic", spore_lod_cause_names[by], error);
}

/* What is measured at a level stays at that level. */
static gboolean set_level(SporeDocument *copy, SporeObject *body, const char *level, GError **error) {
  SporeObject *fidelity = spore_object_child_of(body, "fidelity");
  if (!level || !fidelity) return TRUE;
  gboolean has = strcmp(level, spore_lod_names[SPORE_LOD_FINE]) == 0 || spore_object_child_of(fidelity, level);
  return !has ||
         (set_rule(copy, fidelity, SPORE_LOD_BY_HAND, error) && set_text(copy, fidelity, "level", level, error));
}

/* Runs that are compared do not follow the clock. */
static gboolean stop_clocks(SporeDocument *copy, GError **error) {
  SporeObject *bodies = spore_document_section(copy, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *fidelity = spore_object_child_of(spore_object_child(bodies, i), "fidelity");
    if (!fidelity || (int)spore_object_number(fidelity, "automatic") != SPORE_LOD_BY_TIME) continue;
    if (!set_rule(copy, fidelity, SPORE_LOD_BY_HAND, error)) return FALSE;
  }
  return TRUE;
}

/* Particles have no Jacobian: what is implicit would not be for them. */
static gboolean takes(const SporeObject *mechanical, const char *integrator) {
  const SporeModelType *model =
      spore_object_child_count(mechanical) > 0 ? spore_object_type(spore_object_child(mechanical, 0))->model : NULL;
  for (int kind = 0; spore_integrator_names[kind]; kind++)
    if (g_str_equal(spore_integrator_names[kind], integrator) && model && model->rates)
      return !spore_integrator((SporeIntegratorKind)kind)->implicit;
  return TRUE;
}

static gboolean set_integrator(SporeDocument *copy, SporeObject *mechanical, const char *integrator, guint *taken,
                               GError **error) {
  if (!integrator || !takes(mechanical, integrator)) return TRUE;
  ++*taken;
  return set_text(copy, mechanical, "integrator", integrator, error) &&
         set_number(copy, mechanical, "substeps", 1, error);
}

/* scaled: stiffness and mass are of this body, too. *taken: counts bodies that the integrator moves. */
static gboolean vary_body(SporeDocument *copy, SporeObject *body, const SporeVariation *variation, gboolean scaled,
                          guint *taken, GError **error) {
  SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  if (!mechanical) return TRUE; /* compiling says so */
  if (!set_integrator(copy, mechanical, variation->integrator, taken, error)) return FALSE;
  if (!set_level(copy, body, variation->level, error)) return FALSE;
  if (!scaled || spore_object_child_count(mechanical) == 0) return TRUE;
  return vary_model(copy, spore_object_child(mechanical, 0), variation, error);
}

static gboolean vary_contact(SporeDocument *copy, SporeObject *body, double factor, GError **error) {
  SporeObject *collision = spore_object_child_of(body, "collision");
  if (!collision || factor <= 0 || factor == 1) return TRUE;
  return set_number(copy, collision, "stiffness", factor * spore_object_number(collision, "stiffness"), error);
}

/* Removes what names the body; pins_alone: of links only pins. */
static gboolean untie(SporeDocument *copy, const SporeObject *body, gboolean pins_alone, GError **error) {
  static const char *const sections[] = {"links", "effects"};
  for (gsize k = 0; k < (pins_alone ? 1 : G_N_ELEMENTS(sections)); k++) {
    SporeObject *section = spore_document_section(copy, sections[k]);
    for (guint i = spore_object_child_count(section); i-- > 0;) {
      SporeObject *object = spore_object_child(section, i);
      if (!spore_object_refers_to(object, body) ||
          (pins_alone && strcmp(spore_object_type(object)->element, "pin") != 0))
        continue;
      if (!spore_document_remove(copy, object, error)) return FALSE;
    }
  }
  return TRUE;
}

static gboolean remove_child(SporeDocument *copy, SporeObject *body, const char *element, GError **error) {
  SporeObject *child = spore_object_child_of(body, element);
  return !child || spore_document_remove(copy, child, error);
}

/* Takes physics from the body: the body stays in its place, so that the indices of all bodies stay. */
static gboolean stop(SporeDocument *copy, const char *name, gboolean left_out, GError **error) {
  SporeObject *body = name ? spore_document_find(copy, "body", name) : NULL;
  if (!name) return TRUE;
  if (!body)
    return spore_error_raise(error, SPORE_ERROR_INPUT, name,
                             _("there is no body of that name; expected a passive body; name another one"));
  return untie(copy, body, !left_out, error) && remove_child(copy, body, "fidelity", error) &&
         remove_child(copy, body, "mechanical", error) && (!left_out || remove_child(copy, body, "collision", error)) &&
         set_text(copy, body, "role", "unmovable", error);
}

/* Whether the element, which is of that section, is physical or an effect. */
static gboolean vary_mode(SporeDocument *copy, SporeObject *element, const char *section,
                          const SporeVariation *variation, GError **error) {
  const char *varied = variation->effect_section ? variation->effect_section : "bodies";
  gboolean effect =
      variation->effect && g_str_equal(varied, section) && g_str_equal(variation->effect, spore_object_name(element));
  if (!effect && !(variation->physical && spore_object_child_of(element, "fidelity"))) return TRUE;
  return spore_fidelity_set_mode(copy, element, effect ? "effect" : "physical", error);
}

static gboolean vary_modes(SporeDocument *copy, const char *section, const SporeVariation *variation, GError **error) {
  SporeObject *elements = spore_document_section(copy, section);
  for (guint i = 0; i < spore_object_child_count(elements); i++)
    if (!vary_mode(copy, spore_object_child(elements, i), section, variation, error)) return FALSE;
  return TRUE;
}

/* What the variation says of one body. */
static SporeVariation of_body(const SporeVariation *variation, const char *body) {
  SporeVariation own = *variation;
  if (variation->kept && g_strv_contains(variation->kept, body)) own.level = NULL;
  for (gsize i = 0; i < variation->setting_count; i++)
    if (g_str_equal(variation->settings[i].body, body))
      own.integrator = variation->settings[i].integrator, own.level = variation->settings[i].level;
  return own;
}

gboolean spore_variation_set(SporeDocument *copy, const SporeVariation *variation, GError **error) {
  SporeObject *bodies = spore_document_section(copy, "bodies");
  guint passive = 0, named = 0, taken = 0;
  if (!vary_solver(copy, variation, error)) return FALSE;
  if (!vary_modes(copy, "tools", variation, error) || !vary_modes(copy, "effects", variation, error)) return FALSE;
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i);
    if (!vary_contact(copy, body, variation->contact, error)) return FALSE;
    if ((int)spore_object_number(body, "role") != SPORE_PASSIVE) continue;
    if (!vary_mode(copy, body, "bodies", variation, error)) return FALSE;
    passive++;
    if (variation->body && strcmp(variation->body, spore_object_name(body)) != 0) continue;
    named++;
    const SporeVariation own = of_body(variation, spore_object_name(body));
    if (!vary_body(copy, body, &own, !own.every_second || passive % 2 == 0, &taken, error)) return FALSE;
  }
  if (!stop(copy, variation->still, FALSE, error) || !stop(copy, variation->left_out, TRUE, error)) return FALSE;
  if (named == 0 && variation->body)
    return spore_error_raise(error, SPORE_ERROR_INPUT, variation->body,
                             _("physics moves no body of that name; expected a passive body; name another one"));
  if (named == 0 || taken > 0 || !variation->integrator) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, NULL,
                           _("%s moves no body here, since the forces of particles cannot be solved for; expected an "
                             "explicit method; choose verlet"),
                           variation->integrator);
}

SporeSimulation *spore_variation_make(SporeDocument *document, const SporeVariation *variation, SporePool *pool,
                                      const SporeTrack *input, const SporeCancel *cancel, GError **error) {
  SporeDocument *copy = spore_document_copy(document);
  SporeSimulation *simulation =
      spore_fidelity_resolve(copy, error) && spore_variation_set(copy, variation, error) && stop_clocks(copy, error)
          ? spore_simulation_new(copy, pool, input, cancel, error)
          : NULL;
  spore_document_free(copy);
  return simulation;
}

/* Sends a property of the object with one of these units; all of the object's properties go with it. */
static gboolean send(SporeDocument *copy, SporeObject *object, const char *const *units, SporeSimulation *simulation) {
  const SporeParameterTable *table = object ? spore_object_type(object)->table : NULL;
  for (guint p = 0; table && p < table->count; p++)
    if (table->parameters[p].type == SPORE_REAL && is_one_of(table->parameters[p].unit, units))
      return spore_simulation_apply(simulation, copy, object, p);
  return FALSE;
}

gboolean spore_variation_apply(SporeDocument *document, const SporeVariation *variation, SporeSimulation *simulation) {
  SporeDocument *copy = spore_document_copy(document);
  SporeObject *bodies = spore_document_section(copy, "bodies");
  gboolean any = FALSE, varied = spore_variation_set(copy, variation, NULL);
  for (guint i = 0; varied && i < spore_object_child_count(bodies); i++) {
    SporeObject *body = spore_object_child(bodies, i), *mechanical = spore_object_child_of(body, "mechanical");
    if (variation->stiffness > 0 && mechanical && spore_object_child_count(mechanical) > 0)
      any |= send(copy, spore_object_child(mechanical, 0), stiffnesses, simulation);
    if (variation->contact > 0) any |= send(copy, spore_object_child_of(body, "collision"), stiffnesses, simulation);
  }
  spore_document_free(copy);
  return any;
}
