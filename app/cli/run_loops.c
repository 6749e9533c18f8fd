/* Reports how near windings of bodies along a line came to each other, and whether one went through another. */
#include "app/cli/run_loops.h"

#include <glib/gi18n.h>

static void say(SporeCli *cli, const char *name, const SporeLoopsBody *body, gboolean meets_itself) {
  if (body->through == 0) {
    if (meets_itself) spore_cli_say(cli, _("loops of %s: nearest %.2f of the sum of their radii\n"), name, body->least);
    return;
  }
  const char *remedy = !meets_itself ? _("set self=\"true\" in its collision unit, so that its loops meet")
                       : body->from_start
                           ? _("its loops lie in each other at the start: correct its curve")
                           : _("take a larger contact stiffness, more control points, or a smaller time_step");
  spore_cli_say(cli,
                _("loops of %s go through each other: in %llu steps two of its spheres that are more than two radii "
                  "apart along it were nearer than half the sum of their radii, at worst %.2f of that sum at %.3f s; "
                  "%s\n"),
                name, (unsigned long long)body->through, body->least, body->least_s, remedy);
}

gboolean spore_run_report_loops(SporeCli *cli, const SporeWorld *world, const SporeLoops *loops) {
  gboolean apart = TRUE;
  if (loops->count > 0) spore_cli_open_array(cli, "loops");
  for (gsize i = 0; i < loops->count; i++) {
    const SporeLoopsBody *body = &loops->bodies[i];
    const char *name = spore_world_body_name(world, body->body);
    gboolean meets_itself = spore_world_body_meets_itself(world, body->body);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "body", name);
    spore_cli_number(cli, "least", body->least);
    spore_cli_number(cli, "time_s", body->least_s);
    spore_cli_count(cli, "through", (gint64)body->through);
    spore_cli_close(cli);
    say(cli, name, body, meets_itself);
    apart = apart && (body->through == 0 || !meets_itself);
  }
  if (loops->count > 0) spore_cli_close_array(cli);
  return apart;
}
