/* Register of steps that were not solved as the scene is written: of which body, why, how often and how far. */
#include <assert.h>
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/sim/world_private.h"

static const struct {
  const char *cause, *remedy;
  const char *unit;
} causes[] = {
    [SPORE_UNSOLVED_RESIDUAL] = {N_("its equations are not solved to tolerance"),
                                 N_("take a smaller time_step or more newton_iterations"), ""},
    [SPORE_UNSOLVED_ROUNDING] = {N_("rounding is more than its equations may miss"),
                                 N_("take softer laws and links, move it nearer to the origin, or raise the tolerance"),
                                 ""},
    [SPORE_UNSOLVED_FRICTION] = {N_("friction was left out, since with friction no motion was found"),
                                 N_("take a smaller time_step or less friction"), NULL},
    [SPORE_UNSOLVED_RETAKEN] = {N_("a step went wrong, and was taken again in smaller ones"),
                                N_("take a smaller time_step"), NULL},
    [SPORE_UNSOLVED_STOOD_IN] =
        {N_("another integrator took steps that the scene's could not take"),
         N_("take a smaller time_step or less friction, or choose implicit_euler for all but particles"), NULL},
    [SPORE_UNSOLVED_MODEL] = {N_("its model is not meant for what became of it, as its message says"),
                              N_("do what the message advises"), NULL},
    [SPORE_UNSOLVED_SAFER] = {N_("another integrator than the scene's moves it, since that one failed"),
                              N_("take a smaller time_step, or choose implicit_euler for it"), NULL},
    [SPORE_UNSOLVED_FROZEN] = {N_("it stands still, since its motion could not be computed"),
                               N_("reset, or change its parameters"), NULL},
    [SPORE_UNSOLVED_PASSED] = {N_("a contact does not hold it: it comes too fast, or a sphere goes deeper than its "
                                  "radius, or passes another"),
                               N_("take a larger contact stiffness, or a smaller time_step"), "m/s"},
    [SPORE_UNSOLVED_LEFT_OUT] = {N_("contacts are left out, perhaps its own: there is no memory for them"),
                                 N_("close other programs, or use fewer or smaller spheres"), ""},
    [SPORE_UNSOLVED_ENERGY] = {N_("its steps made more than a hundredth of its energy out of nothing"),
                               N_("take a smaller time_step, or choose implicit_euler for all but particles"), ""},
    [SPORE_UNSOLVED_HALVES] =
        {N_("an explicit step and two of half its size are more than a quarter of its speed apart"),
         N_("take a smaller time_step or more substeps"), ""},
    [SPORE_UNSOLVED_TURNED] = {N_("it spins so fast about changing axes that a step loses where it points"),
                               N_("take a smaller time_step or more substeps"), "rad"},
};
_Static_assert(sizeof causes / sizeof *causes == SPORE_UNSOLVED_CAUSES, "one row a cause");

static size_t entries(const SporeWorld *world) { return world->body_count * SPORE_UNSOLVED_CAUSES; }

bool spore_world_create_unsolved(SporeWorld *world) {
  assert(!world->state.unsolved);
  world->state.unsolved = SPORE_NEW_ARRAY(SporeUnsolvedCount, entries(world));
  return world->state.unsolved != NULL;
}

void spore_world_reset_unsolved(SporeWorld *world) {
  assert(world->state.unsolved || world->body_count == 0);
  if (world->body_count > 0) memset(world->state.unsolved, 0, entries(world) * sizeof *world->state.unsolved);
}

void spore_world_count_unsolved(SporeWorld *world, uint32_t body, SporeUnsolvedCause cause, double worst) {
  assert(body < world->body_count && cause < SPORE_UNSOLVED_CAUSES);
  SporeUnsolvedCount *count = &world->state.unsolved[body * SPORE_UNSOLVED_CAUSES + cause];
  if (isnan(worst)) worst = HUGE_VAL;
  count->worst = fmax(count->worst, worst);
  if (count->steps > 0 && count->last == world->state.step) return;
  count->steps++;
  count->last = world->state.step;
}

const char *spore_unsolved_cause(SporeUnsolvedCause cause) {
  assert(cause < SPORE_UNSOLVED_CAUSES);
  return _(causes[cause].cause);
}

const char *spore_unsolved_remedy(SporeUnsolvedCause cause) {
  assert(cause < SPORE_UNSOLVED_CAUSES);
  return _(causes[cause].remedy);
}

size_t spore_world_unsolved_count(const SporeWorld *world) {
  size_t count = 0;
  for (size_t e = 0; e < entries(world); e++) count += world->state.unsolved[e].steps > 0;
  return count;
}

SporeUnsolved spore_world_unsolved(const SporeWorld *world, size_t i) {
  assert(i < spore_world_unsolved_count(world));
  size_t e = 0;
  for (;; e++)
    if (world->state.unsolved[e].steps > 0 && i-- == 0) break;
  const SporeUnsolvedCount *count = &world->state.unsolved[e];
  size_t cause = e % SPORE_UNSOLVED_CAUSES;
  return (SporeUnsolved){.body = (uint32_t)(e / SPORE_UNSOLVED_CAUSES),
                         .kind = (SporeUnsolvedCause)cause,
                         .steps = count->steps,
                         .worst = count->worst,
                         .unit = causes[cause].unit,
                         .cause = _(causes[cause].cause),
                         .remedy = _(causes[cause].remedy)};
}
