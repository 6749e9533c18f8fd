/* What the advisor says. */
#include <glib/gi18n.h>

#include "core/author/advice_private.h"

/* Why a cheaper form will do. */
static char *praise_of(const SporeEvidence *evidence, SporeVerdict verdict, gboolean exercise) {
  static const char *const unmoved[SPORE_VERDICT_COUNT] = {
      [SPORE_VERDICT_STILL] = N_("nothing else moves otherwise where it stands still"),
      [SPORE_VERDICT_COARSE] = N_("nothing else moves otherwise at its coarsest level"),
      [SPORE_VERDICT_EFFECT] = N_("nothing else moves otherwise where its effect takes its place")};
  const SporeForm *form = &evidence->forms[verdict];
  gboolean told = evidence->floor <= SPORE_EVIDENCE_TELLING;
  GString *text = g_string_new(!told            ? _("how others move with it and without cannot be told from noise")
                               : form->left_out ? _("nothing else moves otherwise without it")
                                                : _(unmoved[verdict]));
  if (verdict == SPORE_VERDICT_STILL)
    g_string_append_printf(text, _("; it moves by %.2g %% of its length at most"), 100 * evidence->own_motion);
  if (exercise) g_string_append(text, _("; the exercise has the same steps done and the same score"));
  g_string_append_printf(text, _("; %.0f %% of a step is saved"), 100 * form->saved_us / evidence->step_us);
  return g_string_free(text, FALSE);
}

/* Who would miss it: what is otherwise without it, or where its effect takes its place. */
static char *missed(const SporeAdviceElement *element, const SporeSimulation *simulation) {
  const SporeEvidence *evidence = &element->evidence;
  const SporeForm *out = &evidence->forms[SPORE_VERDICT_EFFECT];
  const SporeInfluence *influence = &out->influence;
  double saved = 100 * out->saved_us / evidence->step_us;
  gboolean gone = out->left_out;
  if (influence->rms > evidence->floor && influence->worst_body != SPORE_NO_BODY)
    return g_strdup_printf(gone ? _("without it \"%s\" is up to %.2g %% of its length elsewhere")
                                : _("with its effect \"%s\" is up to %.2g %% of its length elsewhere"),
                           spore_world_body_name(simulation->world, influence->worst_body), 100 * influence->worst);
  if (influence->force > evidence->force_floor)
    return g_strdup_printf(gone ? _("without it hands feel %.2g N less or more")
                                : _("with its effect hands feel %.2g N less or more"),
                           influence->force);
  if (influence->steps > 0)
    return g_strdup_printf(gone ? _("without it step \"%s\" of the exercise is done otherwise")
                                : _("with its effect step \"%s\" of the exercise is done otherwise"),
                           spore_exercise_step_state(simulation->exercise, influence->step).name);
  if (influence->score > evidence->score_floor)
    return g_strdup_printf(gone ? _("without it the score of the exercise is %.1f away")
                                : _("with its effect the score of the exercise is %.1f away"),
                           influence->score);
  if (!(out->saved_us > 0)) return g_strdup(gone ? _("leaving it out saves nothing") : _("its effect saves nothing"));
  return g_strdup_printf(gone ? _("leaving it out saves %.1f %% of a step, which is not worth it")
                              : _("its effect saves %.1f %% of a step, which is not worth it"),
                         saved);
}

char *spore_advice_reason(const SporeAdviceElement *element, const SporeExerciseState *exercise,
                          const SporeSimulation *simulation) {
  const SporeEvidence *evidence = &element->evidence;
  if (evidence->held) return g_strdup_printf(_("\"%s\" acts on it"), evidence->held);
  if (evidence->alone) return g_strdup(_("it is all that moves by physics"));
  if (evidence->chaotic)
    return g_strdup_printf(_("a start that is a little off, or half the step, moves bodies by %.2g %% of their length: "
                             "nothing can be told"),
                           100 * evidence->floor);
  if (evidence->events && !evidence->forms[SPORE_VERDICT_EFFECT].left_out)
    return g_strdup(_("with its effect something else is cut, coagulated, taken, held, lost, or breaks"));
  if (evidence->events)
    return g_strdup(_("an instrument or a load does to it what does not happen without it: it is cut, coagulated, "
                      "taken, held, or breaks"));
  if (element->verdict != SPORE_VERDICT_PHYSICAL) return praise_of(evidence, element->verdict, exercise->steps > 0);
  if (evidence->awaited)
    return g_strdup_printf(_("step \"%s\" of the exercise is done to it, and not done with this input"),
                           evidence->awaited);
  return missed(element, simulation);
}

const char *spore_advice_change(const SporeAdviceElement *element, double *saved_us) {
  static const char *const changes[SPORE_VERDICT_COUNT] = {[SPORE_VERDICT_STILL] = N_("make it unmovable"),
                                                           [SPORE_VERDICT_COARSE] = N_("begin at its coarsest level"),
                                                           [SPORE_VERDICT_EFFECT] =
                                                               N_("let its special effect take its place")};
  if (element->verdict == SPORE_VERDICT_PHYSICAL) return NULL;
  const SporeForm *form = &element->evidence.forms[element->verdict];
  if (saved_us) *saved_us = form->saved_us;
  return form->left_out ? _("let a special effect take its place, or leave it out") : _(changes[element->verdict]);
}
