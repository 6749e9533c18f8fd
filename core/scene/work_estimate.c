/* Sentences about bodies that take long to make, to factorise and to step. */
#include "core/scene/work_estimate.h"

#include <glib/gi18n.h>

#define LONG_S 1.

static void say_text(SporeWorkSay say, gpointer data, const char *remedy, const char *format, ...) G_GNUC_PRINTF(4, 5);
static void say_text(SporeWorkSay say, gpointer data, const char *remedy, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *sentence = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  say(data, sentence, remedy);
}

void spore_body_say_work(const SporeWorld *world, guint32 body, SporeWorkSay say, gpointer data) {
  SporeBodyWork work;
  if (!spore_world_body_work(world, body, &work)) return;
  const char *name = spore_world_body_name(world, body), *fewer = _("take fewer control points or nodes");
  if (work.make_s > LONG_S) say_text(say, data, fewer, _("\"%s\" takes about %.2g s to make"), name, work.make_s);
  if (work.factor_s > LONG_S)
    say_text(say, data, fewer, _("\"%s\" takes about %.2g s each time that its matrix is factorised"), name,
             work.factor_s);
  if (work.step_s > work.time_step_s)
    say_text(say, data, _("take fewer control points or nodes, or a longer time_step"),
             _("\"%s\" takes at least about %.2g s a step, longer than its time step of %g s"), name, work.step_s,
             work.time_step_s);
}
