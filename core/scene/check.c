/* Checks of a scene: references, bodies and tools here, the other subjects in files of their own. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/check_private.h"
#include "core/scene/compile.h"
#include "core/scene/document_private.h"
#include "core/scene/fidelity.h"
#include "core/scene/schema_fields.h"

/* Checks that a reference names something, and notes who refers to what. */
static void check_reference(SporeCheck *check, SporeObject *object, const SporeParameter *parameter) {
  const char *name = spore_object_text(object, parameter->name);
  SporeObject *target = spore_object_reference(object, parameter->name);
  if (target) {
    GPtrArray *users = g_hash_table_lookup(check->users, target);
    if (!users) g_hash_table_insert(check->users, target, users = g_ptr_array_new());
    g_ptr_array_add(users, object);
  } else if (name) {
    spore_check_say(check, SPORE_FAULT, object, _("correct the name, or add what it names"),
                    _("%s=\"%s\" names nothing; expected the name of a %s"), parameter->name, name,
                    parameter->references);
  }
}

static void check_references(SporeCheck *check, SporeObject *object) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (guint i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_REFERENCE) check_reference(check, object, &table->parameters[i]);
  for (guint i = 0; i < spore_object_child_count(object); i++) check_references(check, spore_object_child(object, i));
}

/* Whether a device moves a body by such a tool; a camera has none. */
static gboolean has_device(const SporeObject *tool) {
  return spore_parameter_find(spore_object_type(tool)->table, "device") >= 0;
}

static gboolean is_moved(const SporeCheck *check, const SporeObject *body) {
  const GPtrArray *users = g_hash_table_lookup(check->users, body);
  for (guint i = 0; users && i < users->len; i++)
    if (has_device(users->pdata[i])) return TRUE;
  return FALSE;
}

/* Bodies. */

static void check_mechanical(SporeCheck *check, const SporeObject *body, SporeRole role) {
  const SporeObject *mechanical = spore_object_child_of(body, "mechanical");
  gboolean has_model = mechanical && spore_object_child_count(mechanical) > 0;
  if (role == SPORE_PASSIVE && !has_model)
    spore_check_say(check, SPORE_FAULT, body, _("choose a mechanical model, or make the role unmovable"),
                    _("\"%s\" is passive, but has no mechanical model that moves it"), spore_object_name(body));
  if (role != SPORE_PASSIVE && has_model)
    spore_check_say(check, SPORE_NOTE, mechanical, _("make the role passive, or remove the model"),
                    _("the mechanical model of \"%s\" is not used: its role is %s"), spore_object_name(body),
                    role == SPORE_ACTIVE ? "active" : "unmovable");
}

/* Whether a link or a tool works on the body in another way than by touching: then it may well be without spheres. */
static gboolean is_used_untouched(const SporeCheck *check, const SporeObject *body) {
  const GPtrArray *users = g_hash_table_lookup(check->users, body);
  for (guint i = 0; users && i < users->len; i++)
    if (!g_str_equal(spore_object_type(users->pdata[i])->element, "probe")) return TRUE;
  return FALSE;
}

/* A link or a tool that ties the body; the first of them. NULL: there is none. */
static const SporeObject *holder_of(SporeCheck *check, const SporeObject *body) {
  const GPtrArray *users = g_hash_table_lookup(check->users, body);
  for (guint i = 0; users && i < users->len; i++) {
    const SporeObject *section = spore_object_parent(users->pdata[i]);
    gboolean pin = g_str_equal(spore_object_type(users->pdata[i])->element, "pin");
    if (!pin && section && g_str_equal(spore_object_type(section)->element, "links")) return users->pdata[i];
  }
  return NULL;
}

/* Notes advice that is missing or does not hold any more. What the fidelity comes to. */
static SporeFidelityState check_advice(SporeCheck *check, const SporeObject *holder) {
  const SporeObject *fidelity = spore_object_child_of(holder, "fidelity");
  SporeFidelityState state = spore_fidelity_state(check->document, fidelity);
  const char *name = spore_object_name(holder);
  if (state == SPORE_FIDELITY_NOT_ADVISED)
    spore_check_say(check, SPORE_NOTE, fidelity, _("ask spore advise, with --apply"),
                    _("\"%s\" is to be what was advised, and nothing was: it is physical"), name);
  if (state == SPORE_FIDELITY_OUTDATED)
    spore_check_say(check, SPORE_NOTE, fidelity, _("ask spore advise again, with --apply"),
                    _("\"%s\" was advised on before the scene changed: it is physical"), name);
  return state;
}

static void check_fidelity(SporeCheck *check, SporeObject *body, SporeRole role) {
  const SporeObject *fidelity = spore_object_child_of(body, "fidelity"), *holder = holder_of(check, body);
  const char *name = spore_object_name(body);
  if (check_advice(check, body) != SPORE_FIDELITY_IS_EFFECT) return;
  if (role != SPORE_PASSIVE)
    spore_check_say(check, SPORE_NOTE, fidelity, _("make the mode physical, or the role passive"),
                    _("\"%s\" is to be an effect, and physics does not move it anyway"), name);
  if (role != SPORE_PASSIVE) spore_check_offer_set(check, fidelity, "mode", "physical");
  else if (holder)
    spore_check_say(check, SPORE_WARNING, fidelity, _("make the mode physical, or take the link away"),
                    _("\"%s\" is an effect, so that it does not give way to the link \"%s\""), name,
                    spore_object_name(holder));
}

/* Whether spheres can be made of what the body shows. */
static gboolean shows_mesh(const SporeObject *body) {
  const SporeObject *visual = spore_object_child_of(body, "visual");
  return visual && spore_object_reference(visual, "mesh");
}

static void check_body(SporeCheck *check, SporeObject *body) {
  const char *name = spore_object_name(body);
  SporeRole role = (SporeRole)spore_object_number(body, "role");
  check_mechanical(check, body, role);
  const SporeObject *collision = spore_object_child_of(body, "collision");
  gboolean backdrop = role == SPORE_UNMOVABLE && spore_object_child_of(body, "visual");
  gboolean felt = collision && (spore_object_text(collision, "spheres") || spore_body_has_own_spheres(body));
  if (!felt && !backdrop && !is_used_untouched(check, body))
    spore_check_say(check, SPORE_NOTE, body,
                    _("generate spheres and name them in its collision unit, if it should be felt"),
                    _("\"%s\" has no collision spheres: bodies pass through it"), name);
  if (!felt && !backdrop && !is_used_untouched(check, body) && role == SPORE_PASSIVE && shows_mesh(body))
    spore_check_offer(check, SPORE_FIX_GENERATE);
  if (role == SPORE_ACTIVE && !is_moved(check, body))
    spore_check_say(check, SPORE_WARNING, body, _("add a tool that names it, with a device"),
                    _("\"%s\" is active, but no tool moves it"), name);
  if (spore_object_number(body, "name_guessed") != 0)
    spore_check_say(check, SPORE_NOTE, body,
                    _("see whether it is that; rename it if not; then set name_guessed to false"),
                    _("the name \"%s\" is a guess: it stands at its label's number in a common set"), name);
  check_fidelity(check, body, role);
}

/* Tools. */

static void check_tool_body(SporeCheck *check, SporeObject *tool, const char *property) {
  const SporeObject *body = spore_object_reference(tool, property);
  if (body && (int)spore_object_number(body, "role") != SPORE_ACTIVE)
    spore_check_say(check, SPORE_FAULT, tool, _("make its role active, or choose another body"),
                    _("the tool \"%s\" moves \"%s\", which is not active"), spore_object_name(tool),
                    spore_object_name(body));
}

static void check_jaw(SporeCheck *check, SporeObject *tool, const char *property) {
  if (!spore_object_text(tool, property))
    spore_check_say(check, SPORE_FAULT, tool, _("add an active body for the jaw and name it"),
                    _("the tool \"%s\" has no %s"), spore_object_name(tool), property);
  check_tool_body(check, tool, property);
}

static void check_tool(SporeCheck *check, SporeObject *tool) {
  const char *name = spore_object_name(tool), *element = spore_object_type(tool)->element;
  if (!has_device(tool)) return;
  check_advice(check, tool);
  gboolean probe = strcmp(element, "probe") == 0; /* every other tool needs a body */
  if (!spore_object_text(tool, "body"))
    spore_check_say(check, probe ? SPORE_WARNING : SPORE_FAULT, tool, _("name an active body"),
                    _("the tool \"%s\" has no body"), name);
  check_tool_body(check, tool, "body");
  if (!spore_object_text(tool, "device"))
    spore_check_say(check, SPORE_WARNING, tool, _("name a mouse or a track"),
                    _("the tool \"%s\" has no device: nothing moves it"), name);
  if (spore_parameter_find(spore_object_type(tool)->table, "jaw_a") < 0) return;
  if (strcmp(element, "scissors") == 0 && !spore_object_text(tool, "jaw_a") && !spore_object_text(tool, "jaw_b"))
    return;
  check_jaw(check, tool, "jaw_a");
  check_jaw(check, tool, "jaw_b");
}

/* Effects. */

/* An emitter that is an effect is seen by what it stains. */
static void check_seeping(SporeCheck *check, SporeObject *emitter) {
  const SporeObject *fidelity = spore_object_child_of(emitter, "fidelity");
  if (check_advice(check, emitter) != SPORE_FIDELITY_IS_EFFECT || spore_fidelity_is_seen(emitter)) return;
  spore_check_say(
      check, SPORE_NOTE, fidelity, _("make the mode physical, and the fluid an effect if that is enough"),
      _("nothing is seen of \"%s\" as an effect: it has no organ as its source, or its fluid stains nothing"),
      spore_object_name(emitter));
  spore_check_offer_set(check, fidelity, "mode", "physical");
}

static void check_emitter(SporeCheck *check, SporeObject *emitter) {
  if (!spore_object_text(emitter, "body"))
    spore_check_say(check, SPORE_FAULT, emitter, _("name a fluid of particles, or remove the emitter"),
                    _("nothing comes out of the emitter \"%s\": it has no body"), spore_object_name(emitter));
  check_seeping(check, emitter);
}

/* The model by which physics moves the body; NULL: physics does not move it. */
static const SporeModelType *moving_model(const SporeObject *body) {
  const SporeObject *model = spore_body_model_object(body);
  return model && (SporeRole)spore_object_number(body, "role") == SPORE_PASSIVE ? spore_object_type(model)->model
                                                                                : NULL;
}

typedef gboolean (*CanBeChanged)(const SporeModelType *type);

static gboolean can_be_cut(const SporeModelType *type) { return type->cut != NULL; }
static gboolean can_be_coagulated(const SporeModelType *type) { return type->heat != NULL; }

static gboolean can_be_pierced(const SporeModelType *type) { return type->skin != NULL; }

static gboolean some_body(const SporeCheck *check, CanBeChanged can) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeModelType *type = moving_model(spore_object_child(bodies, i));
    if (type && can(type)) return TRUE;
  }
  return FALSE;
}

/* Notes tetrahedra that scissors pass through, because their model cannot be cut. */
static void check_uncut(SporeCheck *check, SporeObject *scissors) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeModelType *type = moving_model(spore_object_child(bodies, i));
    if (!type || type->cut || type->geometry != SPORE_GEOMETRY_TETRAHEDRA) continue;
    spore_check_say(check, SPORE_NOTE, scissors,
                    _("make it neo_hookean_tetrahedra, if it should be cut; nothing is to be done if not"),
                    _("\"%s\" passes through \"%s\", whose stiffness is that of the whole"),
                    spore_object_name(scissors), spore_object_name(spore_object_child(bodies, i)));
  }
}

/* Notes scissors in a scene in which nothing can be cut. */
static void check_scissors(SporeCheck *check, SporeObject *scissors) {
  check_uncut(check, scissors);
  if (some_body(check, can_be_cut)) return;
  spore_check_say(check, SPORE_NOTE, scissors,
                  _("make what is to be cut a mass_spring_net or neo_hookean_tetrahedra, or the tool a grasper"),
                  _("\"%s\" has nothing to work on: no body has a model that can be cut"), spore_object_name(scissors));
}

/* Notes bipolar forceps in a scene in which nothing can be heated. */
static void check_bipolar(SporeCheck *check, SporeObject *bipolar) {
  if (some_body(check, can_be_coagulated)) return;
  spore_check_say(check, SPORE_NOTE, bipolar,
                  _("make what is to be coagulated a mass_spring_net or neo_hookean_tetrahedra, or the tool a grasper"),
                  _("\"%s\" has nothing to work on: no body has a model that can be coagulated"),
                  spore_object_name(bipolar));
}

/* The collision group of a body that has spheres; -1: it has none. Two bodies in a group other than 0 do not touch. */
static int64_t group_of_felt(const SporeObject *body) {
  const SporeObject *collision = spore_object_child_of(body, "collision");
  gboolean felt = collision && (spore_object_text(collision, "spheres") || spore_body_has_own_spheres(body));
  return felt ? (int64_t)spore_object_number(collision, "group") : -1;
}

/* Whether spheres of that group touch those of a body that can be pierced. */
static gboolean stops_at_pierced(const SporeCheck *check, int64_t group) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *body = spore_object_child(bodies, i);
    const SporeModelType *type = moving_model(body);
    int64_t other = group_of_felt(body);
    if (type && can_be_pierced(type) && other >= 0 && (group == 0 || other != group)) return TRUE;
  }
  return FALSE;
}

/* Notes a needle that has nothing to pierce or no thread to draw; warns where its own spheres would stop it. */
static void check_needle(SporeCheck *check, SporeObject *needle) {
  const char *name = spore_object_name(needle);
  const SporeObject *body = spore_object_reference(needle, "body");
  int64_t group = body ? group_of_felt(body) : -1;
  if (!some_body(check, can_be_pierced))
    spore_check_say(check, SPORE_NOTE, needle,
                    _("make what is to be sewn a mass_spring_net, a deformable_surface or neo_hookean_tetrahedra"),
                    _("\"%s\" has nothing to work on: no body has a model that can be pierced"), name);
  if (!spore_object_text(needle, "thread"))
    spore_check_say(check, SPORE_NOTE, needle, _("name a body along a curve that begins at its swage"),
                    _("\"%s\" draws no thread: what it has pierced comes off behind it"), name);
  if (group >= 0 && stops_at_pierced(check, group))
    spore_check_say(check, SPORE_WARNING, needle, _("take the spheres away, or put both bodies in one group"),
                    _("the spheres of \"%s\" keep \"%s\" from what it is to pierce: its tip needs none to feel it"),
                    spore_object_name(body), name);
}

/* Warns of suction in a scene without a fluid. */
static void check_suction(SporeCheck *check, SporeObject *suction) {
  const SporeObject *bodies = spore_document_section(check->document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeModelType *type = moving_model(spore_object_child(bodies, i));
    if (type && type->particles) return;
  }
  spore_check_say(check, SPORE_NOTE, suction, _("add a fluid, or make it a probe"),
                  _("\"%s\" has nothing to take away: the scene has no fluid of particles"),
                  spore_object_name(suction));
}

/* The whole. */

static gint worst_first(gconstpointer a, gconstpointer b) {
  const SporeDiagnostic *one = *(SporeDiagnostic *const *)a, *other = *(SporeDiagnostic *const *)b;
  if (one->severity != other->severity) return (gint)other->severity - (gint)one->severity;
  return 0;
}

static void free_diagnostic(gpointer data) { spore_diagnostic_free(data); }

GPtrArray *spore_document_check(SporeDocument *document, const SporeCancel *cancel) {
  SporeCheck check = {.document = document, .cancel = cancel};
  check.found = g_ptr_array_new_with_free_func(free_diagnostic);
  check.users = g_hash_table_new_full(NULL, NULL, NULL, (GDestroyNotify)g_ptr_array_unref);
  check_references(&check, spore_document_root(document));
  if (spore_object_child_count(spore_document_section(document, "bodies")) == 0)
    spore_check_say(&check, SPORE_NOTE, NULL, _("import a mesh, or add a body"), "%s", _("the scene has no bodies"));
  spore_check_each(&check, "bodies", NULL, check_body);
  spore_check_each(&check, "tools", NULL, check_tool);
  spore_check_each(&check, "tools", "scissors", check_scissors);
  spore_check_each(&check, "tools", "bipolar", check_bipolar);
  spore_check_each(&check, "tools", "needle", check_needle);
  spore_check_each(&check, "tools", "suction", check_suction);
  spore_check_each(&check, "effects", "emitter", check_emitter);
  spore_check_links(&check);
  spore_check_exercise(&check);
  spore_check_assets(&check);
  spore_check_textures(&check);
  spore_check_materials(&check);
  spore_check_solver(&check);
  spore_check_motion(&check);
  g_ptr_array_sort(check.found, worst_first); /* a stable sort: equal entries keep their order */
  g_hash_table_unref(check.users);
  return check.found;
}
