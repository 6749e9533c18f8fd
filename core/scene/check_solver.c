/* Checks of the solver: choices of method and of contact that have no effect in this scene. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/integrate/integrator.h"
#include "core/scene/check_private.h"
#include "core/scene/schema_fields.h"

static gboolean is_passive(const SporeObject *body) {
  return spore_body_model_object(body) && (SporeRole)spore_object_number(body, "role") == SPORE_PASSIVE;
}

/* Whether the body's model consists of particles: it has no Jacobian, and explicit steps move it. */
static gboolean has_particles(const SporeObject *body) {
  return spore_object_type(spore_body_model_object(body))->model->rates != NULL;
}

/* What the body itself chooses, or SPORE_INTEGRATOR_DEFAULT. */
static SporeIntegratorKind own_integrator(const SporeObject *body) {
  return (SporeIntegratorKind)((int)spore_object_number(spore_object_child_of(body, "mechanical"), "integrator") - 1);
}

static SporeIntegratorKind scene_integrator(const SporeCheck *check) {
  return (SporeIntegratorKind)spore_object_number(spore_document_section(check->document, "solver"), "integrator");
}

/* The integrator that the world will choose (core/sim/create.c). SPORE_INTEGRATOR_DEFAULT: physics does not move the
 * body. */
static SporeIntegratorKind integrator_of(const SporeCheck *check, const SporeObject *body) {
  if (!is_passive(body) || own_integrator(body) != SPORE_INTEGRATOR_DEFAULT)
    return is_passive(body) ? own_integrator(body) : SPORE_INTEGRATOR_DEFAULT;
  SporeIntegratorKind kind = scene_integrator(check);
  return has_particles(body) && spore_integrator(kind)->implicit ? SPORE_INTEGRATOR_VERLET : kind;
}

/* Which choices the integrators of all bodies make use of. */
typedef struct Uses {
  guint moved;
  gboolean adaptive, implicit;
} Uses;

static Uses find_uses(const SporeCheck *check) {
  Uses uses = {0};
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    SporeIntegratorKind kind = integrator_of(check, spore_object_child(bodies, i));
    if (kind == SPORE_INTEGRATOR_DEFAULT) continue;
    uses.moved++;
    uses.adaptive |= kind == SPORE_INTEGRATOR_TR_BDF2;
    uses.implicit |= spore_integrator(kind)->implicit;
  }
  return uses;
}

static void check_solver(SporeCheck *check, const SporeObject *solver) {
  SporeSolverFields fields;
  spore_object_fields(solver, &fields);
  Uses uses = find_uses(check);
  if (uses.moved == 0) return;
  if (fields.error_tolerance > 0 && !uses.adaptive) {
    spore_check_say(check, SPORE_WARNING, solver, _("choose tr_bdf2 as integrator, or remove error_tolerance"), "%s",
                    _("error_tolerance is not used: no body is integrated by tr_bdf2"));
    spore_check_offer_set(check, solver, "error_tolerance", NULL);
  }
  if ((fields.nonlinear != SPORE_NONLINEAR_AUTOMATIC || fields.linear != SPORE_LINEAR_AUTOMATIC) && !uses.implicit) {
    spore_check_say(check, SPORE_NOTE, solver, _("choose an implicit integrator, or leave nonlinear and linear open"),
                    "%s",
                    _("every body is integrated explicitly: how equations are solved matters only in steps that "
                      "contacts, links or recovery make implicit"));
    spore_check_offer_set(check, solver, "nonlinear|linear", NULL);
  }
}

/* Speed (m/s) at which a body without contact sinks under the static integrator: no force balances its weight, so each
 * step moves it as far as the weight would from rest. */
static double static_sinking_speed(const SporeCheck *check) {
  SporeEnvironmentFields environment;
  SporeSolverFields solver;
  spore_object_fields(spore_document_section(check->document, "environment"), &environment);
  spore_object_fields(spore_document_section(check->document, "solver"), &solver);
  return spore_vec3_length(spore_vec3_load(environment.gravity)) * solver.time_step;
}

static void check_static(SporeCheck *check, const SporeObject *body) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  if (integrator_of(check, body) != SPORE_INTEGRATOR_STATIC) return;
  if (spore_object_number(mechanical, "substeps") > 1) {
    spore_check_say(
        check, SPORE_WARNING, mechanical, _("remove substeps, or choose another integrator"),
        _("substeps of \"%s\" gain nothing: static finds the balance of forces, in which time does not count"),
        spore_object_name(body));
    spore_check_offer_set(check, mechanical, "substeps", NULL);
  }
  if (!spore_check_is_used(check, body, SPORE_HOLDING))
    spore_check_say(check, SPORE_WARNING, mechanical,
                    _("pin it, tie it with a spring, or choose an integrator that moves it"),
                    _("\"%s\" is integrated by static, but neither pin nor spring holds it: it finds no balance but "
                      "where it touches something; in the open it sinks at %.2g m/s, and where it touches it settles "
                      "as slowly"),
                    spore_object_name(body), static_sinking_speed(check));
}

/* Notes methods that particles cannot use. */
static void check_particles(SporeCheck *check, const SporeObject *body) {
  if (!is_passive(body) || !has_particles(body)) return;
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  const SporeObject *solver = spore_document_section(check->document, "solver");
  guint property = (guint)spore_parameter_find(spore_object_type(solver)->table, "integrator");
  SporeIntegratorKind own = own_integrator(body), scene = scene_integrator(check);
  if (own != SPORE_INTEGRATOR_DEFAULT && own != SPORE_INTEGRATOR_STATIC && spore_integrator(own)->implicit) {
    spore_check_say(check, SPORE_WARNING, mechanical, _("leave the integrator open, or take verlet"),
                    _("particles of \"%s\" have no Jacobian that %s could use: its steps may be no longer than "
                      "verlet's, each costs many of them, and its equations may be left unsolved"),
                    spore_object_name(body), spore_integrator_names[own]);
    spore_check_offer_set(check, mechanical, "integrator", "verlet");
  }
  if (own == SPORE_INTEGRATOR_DEFAULT && spore_object_is_set(solver, property) && spore_integrator(scene)->implicit) {
    spore_check_say(check, SPORE_NOTE, mechanical, _("choose verlet for it, so that the scene says so"),
                    _("the scene's integrator %s is not used for \"%s\": particles are moved by verlet"),
                    spore_integrator_names[scene], spore_object_name(body));
    spore_check_offer_set(check, mechanical, "integrator", "verlet");
  }
}

/* Whether another body is in that collision group. */
static gboolean has_companion(const SporeCheck *check, const SporeObject *body, int64_t group) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *other = spore_object_child(bodies, i);
    const SporeObject *collision = spore_object_child_of(other, "collision");
    if (other != body && collision && (int64_t)spore_object_number(collision, "group") == group) return TRUE;
  }
  return FALSE;
}

static gboolean keeps_shape(const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body);
  const SporeModelType *type = model ? spore_object_type(model)->model : NULL;
  return type && type->inertia && !type->jacobian;
}

/* Whether the body's spheres have weights: they were fitted to be summed up to one depth. */
static gboolean has_weights(const SporeCheck *check, const SporeObject *collision) {
  SporeObject *asset = spore_object_reference(collision, "spheres");
  const SporeSphereSet *set = asset ? spore_document_spheres(check->document, asset, NULL) : NULL;
  return set && set->weights;
}

static void check_weights(SporeCheck *check, const SporeObject *body, const SporeObject *collision, gboolean summed) {
  if (summed || !has_weights(check, collision)) return;
  gboolean soft = is_passive(body) && !keeps_shape(body);
  spore_check_say(check, SPORE_NOTE, collision,
                  soft ? _("generate spheres without weights: the body deforms")
                       : _("set surface to depth_field, or generate spheres without weights"),
                  _("the weights of the spheres of \"%s\" are not used: others feel each sphere by itself"),
                  spore_object_name(body));
}

static void check_contact(SporeCheck *check, const SporeObject *body) {
  const SporeObject *collision = spore_object_child_of(body, "collision");
  if (!collision) return;
  SporeCollisionFields fields;
  spore_object_fields(collision, &fields);
  gboolean passive = (SporeRole)spore_object_number(body, "role") == SPORE_PASSIVE;
  gboolean fielded = fields.contact.surface == SPORE_SURFACE_DEPTH_FIELD;
  check_weights(check, body, collision, fielded && (!passive || keeps_shape(body)));
  if (passive && fielded && !keeps_shape(body))
    spore_check_say(check, SPORE_WARNING, collision, _("leave surface at spheres, or make the body rigid"),
                    _("the depth field of \"%s\" is not used: the body deforms, and others feel its spheres"),
                    spore_object_name(body));
  if (fields.contact.group > 0 && !has_companion(check, body, fields.contact.group))
    spore_check_say(check, SPORE_NOTE, collision, _("put the other bodies in it, or remove group"),
                    _("\"%s\" is alone in group %lld"), spore_object_name(body), (long long)fields.contact.group);
  if (!passive && fields.contact.self)
    spore_check_say(check, SPORE_NOTE, collision, _("remove self, or make the role passive"),
                    _("the spheres of \"%s\" do not move against each other: self has no effect"),
                    spore_object_name(body));
}

static void check_body(SporeCheck *check, SporeObject *body) {
  check_static(check, body);
  check_particles(check, body);
  check_contact(check, body);
}

void spore_check_solver(SporeCheck *check) {
  check_solver(check, spore_document_section(check->document, "solver"));
  spore_check_each(check, "bodies", NULL, check_body);
}
