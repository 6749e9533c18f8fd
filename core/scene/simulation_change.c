/* Changes to a running simulation: it takes over state from an earlier simulation, and hears edits of the document. */
#include <string.h>

#include "core/base/memory.h"
#include "core/scene/compile.h"
#include "core/scene/fidelity.h"
#include "core/scene/schema_fields.h"

static gboolean same_state(const SporeModel *a, const SporeModel *b) {
  if (!a || !b) return a == b;
  return a->type == b->type && a->q_count == b->q_count && a->block_count == b->block_count;
}

/* Whether the line has the knots it started with: refinement has neither inserted nor removed any. */
static gboolean has_first_knots(const SporeWorld *world, guint32 body) {
  SporeLineState line;
  return !spore_world_line_state(world, body, &line) || line.points == line.made;
}

/* Sets the same level of detail, where the body still has that level. */
static void carry_level(SporeWorld *to, guint32 body, const SporeWorld *from, guint32 old) {
  SporeLodState state;
  if (!spore_world_lod_state(from, old, &state) || !spore_world_lod_model(to, body, state.level)) return;
  spore_world_set_lod(to, body, state.level);
}

/* Before the states, with which they are shown. */
static void carry_stains(SporeWorld *to, const SporeWorld *from) {
  for (guint32 i = 0; i < spore_world_body_count(to); i++) {
    guint32 old = spore_world_find_body(from, spore_world_body_name(to, i));
    if (old != SPORE_NO_BODY) spore_world_carry_stain(to, i, from, old);
  }
}

void spore_simulation_carry_over(SporeSimulation *to, const SporeSimulation *from) {
  size_t count = spore_world_body_count(to->world);
  carry_stains(to->world, from->world);
  spore_world_carry_lenses(to->world, from->world);
  for (guint32 i = 0; i < count; i++) {
    SporeRole role = spore_world_body_role(to->world, i);
    guint32 old = spore_world_find_body(from->world, spore_world_body_name(to->world, i));
    if (old == SPORE_NO_BODY || role == SPORE_UNMOVABLE || spore_world_body_role(from->world, old) != role) continue;
    carry_level(to->world, i, from->world, old);
    if (has_first_knots(from->world, old) &&
        same_state(spore_world_body_model(to->world, i), spore_world_body_model(from->world, old)))
      spore_world_set_state(to->world, i, spore_world_q(from->world, old), spore_world_v(from->world, old));
  }
}

static gboolean holds_text(const SporeParameterTable *table) {
  for (size_t i = 0; i < table->count; i++)
    if (table->parameters[i].type >= SPORE_TEXT) return TRUE;
  return FALSE;
}

static gboolean retune(SporeSimulation *simulation, SporeObject *object, guint32 body) {
  const SporeModel *model = spore_world_body_model(simulation->world, body);
  const SporeModelType *type = spore_object_type(object)->model;
  if (!model) return TRUE; /* unmovable and active bodies have none */
  if (model->type != type || !type->retune || holds_text(&type->parameters)) return FALSE;
  void *fields = spore_allocate(1, type->parameters.size);
  if (!fields) return FALSE;
  spore_object_fields(object, fields);
  SporeCommand command = {.kind = SPORE_COMMAND_RETUNE, .body = body, .fields = fields};
  if (spore_world_post(simulation->world, &command)) return TRUE;
  spore_free(fields);
  return FALSE;
}

static gboolean post_contact(SporeSimulation *simulation, const SporeObject *collision, guint32 body) {
  SporeCollisionFields fields;
  spore_object_fields(collision, &fields);
  SporeCommand command = {.kind = SPORE_COMMAND_CONTACT, .body = body, .contact = fields.contact};
  return spore_world_post(simulation->world, &command);
}

/* The default contact law changed: every body that has a collision unit hears it. */
static gboolean post_contacts(SporeSimulation *simulation, SporeDocument *document) {
  SporeObject *bodies = spore_document_section(document, "bodies");
  for (guint i = 0; i < spore_object_child_count(bodies); i++) {
    const SporeObject *collision = spore_object_child_of(spore_object_child(bodies, i), "collision");
    guint32 body = spore_simulation_body_of(simulation, spore_object_child(bodies, i));
    if (collision && (body == SPORE_NO_BODY || !post_contact(simulation, collision, body))) return FALSE;
  }
  return TRUE;
}

static gboolean post_gravity(SporeSimulation *simulation, const SporeObject *environment) {
  SporeEnvironmentFields fields;
  spore_object_fields(environment, &fields);
  SporeCommand command = {.kind = SPORE_COMMAND_GRAVITY, .vector = spore_vec3_load(fields.gravity)};
  return spore_world_post(simulation->world, &command);
}

static gboolean post_level(SporeSimulation *simulation, const SporeObject *fidelity) {
  SporeCommand command = {.kind = SPORE_COMMAND_LOD,
                          .body = spore_simulation_body_of(simulation, (SporeObject *)fidelity)};
  SporeFidelityFields fields;
  spore_object_fields(fidelity, &fields);
  command.level = (SporeLodGrade)fields.level;
  return command.body != SPORE_NO_BODY && spore_world_post(simulation->world, &command);
}

/* The number of the tool in the world; -1: it has none. */
static double tool_of(const SporeWorld *world, const SporeObject *tool) {
  for (size_t i = 0; i < spore_world_tool_count(world); i++)
    if (g_strcmp0(spore_world_tool_state(world, i).name, spore_object_name(tool)) == 0) return (double)i;
  return -1;
}

/* The number of an emitter is its place among them. */
static double emitter_of(const SporeObject *emitter) {
  const SporeObject *section = spore_object_parent(emitter);
  for (guint i = 0; i < spore_object_child_count(section); i++)
    if (spore_object_child(section, i) == emitter) return i;
  return -1;
}

static gboolean post_effect(SporeSimulation *simulation, SporeDocument *document, SporeObject *fidelity) {
  SporeObject *holder = spore_object_parent(fidelity);
  const char *section = spore_object_type(spore_object_parent(holder))->element;
  SporeCommand command = {.kind = SPORE_COMMAND_EFFECT,
                          .body = spore_simulation_body_of(simulation, fidelity),
                          .effect = spore_fidelity_is_effect(document, holder)};
  if (strcmp(section, "tools") == 0)
    command.kind = SPORE_COMMAND_TOOL_EFFECT, command.number = tool_of(simulation->world, holder);
  if (strcmp(section, "effects") == 0) command.kind = SPORE_COMMAND_EMITTER_EFFECT, command.number = emitter_of(holder);
  gboolean there = command.kind == SPORE_COMMAND_EFFECT ? command.body != SPORE_NO_BODY : command.number >= 0;
  return there && spore_world_post(simulation->world, &command);
}

gboolean spore_simulation_apply(SporeSimulation *simulation, SporeDocument *document, SporeObject *object,
                                guint property) {
  const SporeObjectType *type = spore_object_type(object);
  if (type->table->parameters[property].change != SPORE_CHANGE_LIVE) return FALSE;
  if (strcmp(type->element, "environment") == 0) return post_gravity(simulation, object);
  if (strcmp(type->element, "contact") == 0) return post_contacts(simulation, document);
  if (strcmp(type->element, "solver") == 0) return FALSE;
  if (strcmp(type->element, "fidelity") == 0)
    return strcmp(type->table->parameters[property].name, "level") == 0 ? post_level(simulation, object)
                                                                        : post_effect(simulation, document, object);
  if (!type->model && strcmp(type->element, "collision") != 0)
    return TRUE; /* the property is only shown, or only used by a generator */
  guint32 body = spore_simulation_body_of(simulation, object);
  if (body == SPORE_NO_BODY) return FALSE;
  return type->model ? retune(simulation, object, body) : post_contact(simulation, object, body);
}
