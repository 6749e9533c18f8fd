/* Commands from another thread: a ring with one writer and one reader. */
#include <assert.h>
#include <math.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

bool spore_world_post(SporeWorld *world, const SporeCommand *command) {
  assert(command);
  SporeCommands *commands = &world->commands;
  size_t written = atomic_load_explicit(&commands->written, memory_order_relaxed);
  size_t applied = atomic_load_explicit(&commands->applied, memory_order_acquire);
  assert(written - applied <= SPORE_COMMAND_CAPACITY);
  if (written - applied == SPORE_COMMAND_CAPACITY) return false;
  commands->ring[written % SPORE_COMMAND_CAPACITY] = *command;
  atomic_store_explicit(&commands->written, written + 1, memory_order_release);
  return true;
}

size_t spore_world_commands_posted(const SporeWorld *world) {
  return atomic_load_explicit(&world->commands.written, memory_order_acquire);
}

size_t spore_world_commands_applied(const SporeWorld *world) {
  return atomic_load_explicit(&world->commands.applied, memory_order_acquire);
}

typedef struct Retuning {
  const void *fields;
  SporeError error;
} Retuning;

static void retune_model(SporeModel *model, void *user) {
  Retuning *retuning = user;
  assert(model->type->retune && retuning->fields);
  if (!*retuning->error.message) model->type->retune(model, retuning->fields, &retuning->error);
}

static void retune(SporeWorld *world, SporeBody *body, const void *fields) {
  Retuning retuning = {fields, SPORE_ERROR_INIT};
  const SporeModelType *type = body->model ? body->model->type : NULL;
  if (!type || !type->retune) {
    spore_world_report(world, _("%s: has no parameters that can change while it runs; restart to apply them"),
                       body->name);
    return;
  }
  if (spore_parameters_check(&type->parameters, fields, &retuning.error))
    spore_body_each_model(body, retune_model, &retuning);
  if (*retuning.error.message) {
    spore_world_report(world, "%s: %s", body->name, retuning.error.message);
    return;
  }
  spore_body_forget_steps(world, body);
  body->total_mass = spore_model_total_mass(body->model);
  spore_body_set_mass(world, body);
  world->schedule.stale = true; /* a fluid may stain from now on */
}

static void set_contact(SporeWorld *world, SporeBody *body, const SporeContactFields *contact) {
  assert(contact);
  SporeError error = SPORE_ERROR_INIT;
  if (!spore_parameters_check(&spore_contact_parameters, contact, &error)) {
    spore_world_report(world, "%s: %s", body->name, error.message);
    return;
  }
  body->collision.fields = *contact;
  spore_body_put(world, (uint32_t)(body - world->bodies)); /* a stiffer contact has energy that motion has not given */
}

static void set_gravity(SporeWorld *world, SporeVec3 gravity) {
  if (!isfinite(gravity.x + gravity.y + gravity.z)) {
    spore_world_report(world, _("gravity is not finite; expected a vector in m/s^2; kept as it was"));
    return;
  }
  world->state.gravity = gravity;
  for (size_t b = 0; b < world->body_count; b++) world->bodies[b].history.step_s = 0;
  spore_world_wake_all(world);
}

static void set_element_effect(SporeWorld *world, const SporeCommand *command) {
  size_t index = (size_t)fmax(command->number, 0);
  if (command->kind == SPORE_COMMAND_TOOL_EFFECT && index < world->tools.count)
    spore_world_set_tool_effect(world, index, command->effect);
  if (command->kind == SPORE_COMMAND_EMITTER_EFFECT && index < world->tools.emitter_count)
    world->tools.emitters[index].effect = command->effect;
}

static void apply(SporeWorld *world, const SporeCommand *command) {
  world->solve.watch.started = false;
  if (command->kind == SPORE_COMMAND_GRAVITY) {
    set_gravity(world, command->vector);
    return;
  }
  if (command->kind == SPORE_COMMAND_WIPE) {
    spore_world_wipe_lens(world, (size_t)fmax(command->number, 0));
    return;
  }
  if (command->kind == SPORE_COMMAND_TOOL_EFFECT || command->kind == SPORE_COMMAND_EMITTER_EFFECT) {
    set_element_effect(world, command);
    return;
  }
  if (command->body >= world->body_count) return;
  SporeBody *body = &world->bodies[command->body];
  /* Sleeping bodies may lie on a body that physics does not move. */
  if (spore_body_is_physical(body) && !body->frozen) spore_world_wake(world, command->body);
  else spore_world_wake_all(world);
  switch (command->kind) {
  case SPORE_COMMAND_PULL:
    spore_world_pull(world, command);
    break;
  case SPORE_COMMAND_RELEASE:
    spore_world_release(world, command->body);
    break;
  case SPORE_COMMAND_RETUNE:
    retune(world, body, command->fields);
    break;
  case SPORE_COMMAND_CONTACT:
    set_contact(world, body, &command->contact);
    break;
  case SPORE_COMMAND_THAW:
    spore_body_put(world, command->body); /* others may have come into it meanwhile */
    spore_body_thaw(body);
    break;
  case SPORE_COMMAND_LOD:
    spore_world_change_lod(world, command->body, command->level);
    break;
  case SPORE_COMMAND_EFFECT:
    spore_world_set_effect(world, command->body, command->effect);
    break;
  case SPORE_COMMAND_GRAVITY:
  case SPORE_COMMAND_WIPE:
  case SPORE_COMMAND_TOOL_EFFECT:
  case SPORE_COMMAND_EMITTER_EFFECT:
    break;
  }
}

void spore_world_apply_commands(SporeWorld *world) {
  SporeCommands *commands = &world->commands;
  size_t applied = atomic_load_explicit(&commands->applied, memory_order_relaxed);
  size_t written = atomic_load_explicit(&commands->written, memory_order_acquire);
  assert(written - applied <= SPORE_COMMAND_CAPACITY);
  for (; applied != written; applied++) {
    SporeCommand *command = &commands->ring[applied % SPORE_COMMAND_CAPACITY];
    apply(world, command);
    spore_free(command->fields);
    command->fields = NULL;
    atomic_store_explicit(&commands->applied, applied + 1, memory_order_release);
  }
}

void spore_commands_clear(SporeCommands *commands) {
  size_t written = atomic_load(&commands->written);
  for (size_t i = atomic_load(&commands->applied); i != written; i++)
    spore_free(commands->ring[i % SPORE_COMMAND_CAPACITY].fields);
  spore_free(commands->ring);
}
