/* What is drawn and written over the picture: forces, legends, and figures of the simulation. */
#include <glib/gi18n.h>
#include <math.h>

#include "core/scene/length_unit.h"
#include "ui/document/labels.h"
#include "ui/jobs/loop-gaps.h"
#include "ui/viewport/spore-viewport-private.h"

#define MOST_LEVELS 4 /* bodies in the corner */
#define ARROW_PIXELS_A_NEWTON 40.0
#define ARROW_LONGEST_PIXELS 160.0

static gboolean probe_force(SporeViewport *self, SporeVec3 *tip, SporeVec3 *force) {
  guint32 body;
  if (!spore_viewport_probe(self, &body, tip)) return FALSE;
  *force = spore_vec3_load(spore_session_snapshot(spore_player_get_session(self->player))->reaction + 6 * body);
  return TRUE;
}

static void draw_arrow(cairo_t *cr, const double colour[4], double width, double x, double y, double dx, double dy) {
  double length = hypot(dx, dy);
  if (length < 3) return;
  double ux = dx / length, uy = dy / length;
  cairo_move_to(cr, x, y);
  cairo_line_to(cr, x + dx, y + dy);
  spore_viewport_stroke(cr, colour, width);
  cairo_move_to(cr, x + dx + 7 * ux, y + dy + 7 * uy);
  cairo_line_to(cr, x + dx - 5 * uy, y + dy + 5 * ux);
  cairo_line_to(cr, x + dx + 5 * uy, y + dy - 5 * ux);
  cairo_fill(cr);
}

/* Reaction force at the probe's tip, along its direction on the screen. */
static void draw_force(SporeViewport *self, cairo_t *cr, int width, int height) {
  SporeVec3 tip, force, eye, right, up, forward;
  double x, y;
  if (!probe_force(self, &tip, &force) || !spore_camera_project(&self->camera, tip, width, height, &x, &y)) return;
  spore_camera_eye(&self->camera, &eye, &right, &up, &forward);
  double newtons = spore_vec3_length(force);
  double scale = ARROW_PIXELS_A_NEWTON * fmin(1, ARROW_LONGEST_PIXELS / fmax(newtons * ARROW_PIXELS_A_NEWTON, 1e-9));
  draw_arrow(cr, (const double[4]){1, 0.78, 0.25, 1}, 3, x, y, spore_vec3_dot(force, right) * scale,
             -spore_vec3_dot(force, up) * scale);
}

static void draw_pull(SporeViewport *self, cairo_t *cr, int width, int height) {
  double x0, y0, x1, y1;
  if (self->drag != DRAG_PULL || !spore_camera_project(&self->camera, self->start, width, height, &x0, &y0) ||
      !spore_camera_project(&self->camera, self->cursor, width, height, &x1, &y1))
    return;
  draw_arrow(cr, (const double[4]){0.45, 0.8, 1, 1}, 2, x0, y0, x1 - x0, y1 - y0);
}

void spore_viewport_overlay_draw(SporeViewport *self, cairo_t *cr, int width, int height) {
  draw_force(self, cr, width, height);
  draw_pull(self, cr, width, height);
  spore_viewport_legends_draw(self, cr, width, height);
}

/* Figures in the corner. */

/* Counts of cuts, punctures and stitches. */
#define MILLILITRES 1e6 /* in a cubic metre */

static void append_tools(GString *text, const SporeSnapshot *snapshot) {
  const SporeToolCounts *tools = &snapshot->tools;
  if (tools->cut > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Cut %zu"), tools->cut);
  }
  if (tools->pierced > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Pierced %zu, stitches %zu"), tools->pierced, tools->stitches);
  }
  if (tools->poured > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Poured %.1f ml"), MILLILITRES * tools->poured);
  }
}

/* A line for each body that has several levels. */
static void append_levels(GString *text, const SporeWorld *world, const SporeSnapshot *snapshot) {
  guint32 count = snapshot->level ? (guint32)spore_world_body_count(world) : 0;
  for (guint32 body = 0, shown = 0; body < count && shown < MOST_LEVELS; body++) {
    SporeLodState state;
    if (!spore_world_lod_state(world, body, &state)) continue;
    g_autofree char *level = spore_label_of_name(spore_lod_names[snapshot->level[body]]);
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("%s: %s"), spore_world_body_name(world, body), _(level));
    shown++;
  }
}

/* What the solver did, and how far the step was off. */
static void append_solver(GString *text, const SporeWorld *world, const SporeSnapshot *snapshot,
                          const SporeSessionFigures *figures) {
  const SporeStepCounts *counts = &snapshot->counts;
  if (counts->newton_iterations > 0) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Solver %zu + %zu iterations  ·  residual %.1e"), counts->newton_iterations,
                           counts->linear_iterations, counts->residual);
  }
  if (isfinite(figures->local_error) && figures->error_body != SPORE_NO_BODY) {
    g_autofree char *error = spore_length_text(figures->local_error);
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Error of a step about %s (%s)"), error,
                           spore_world_body_name(world, figures->error_body));
  }
}

/* In all, and since time 0. */
static void append_energy(GString *text, const SporeSnapshot *snapshot, const SporeSessionFigures *figures) {
  const SporeEnergy *energy = &snapshot->energy;
  double total = energy->kinetic + energy->internal + energy->gravity + energy->contact;
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Energy %.3g J  ·  %+.2g J since the start"), total, total - figures->energy_start);
}

/* A step that was not solved is no small thing: the body, and what to do. */
static void append_unsolved(GString *text, const SporeWorld *world, const SporeSessionFigures *figures) {
  if (figures->unsolved_count == 0) return;
  g_string_append_c(text, '\n');
  g_string_append_printf(
      text, _("⚠ %s: %llu steps not solved: %s; %s"), spore_world_body_name(world, figures->unsolved.body),
      (unsigned long long)figures->unsolved.steps, figures->unsolved.cause, figures->unsolved.remedy);
}

/* How fast the run goes, in words. Time that passes as in life within a twentieth is not worth a figure. */
#define AS_IN_LIFE 0.05

/* asked: how many times as fast as in life it should be; 0: as fast as it goes. */
static void append_pace(GString *text, double factor, double asked) {
  if (!(factor > 0)) return;
  g_string_append(text, "  ·  ");
  if (fabs(factor - 1) <= AS_IN_LIFE) g_string_append(text, _("as fast as in life"));
  else if (factor > 1) g_string_append_printf(text, _("%.3g times as fast as in life"), factor);
  else g_string_append_printf(text, _("slower than in life: %.2g times"), factor);
  if (factor >= (1 - AS_IN_LIFE) * asked) return;
  g_string_append_c(text, '\n');
  g_string_append(text, _("This machine does not keep up; the Accuracy tab finds cheaper settings"));
}

/* How long the window kept whoever works in it waiting, at most. */
static void append_gaps(GString *text) {
  guint count;
  const SporeGap *gaps = spore_gaps_told(&count), *longest = gaps;
  for (guint i = 1; i < count; i++)
    if (gaps[i].longest_ms > longest->longest_ms) longest = &gaps[i];
  if (count == 0) return;
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("The window stood still for %.0f ms (%s)"), longest->longest_ms, longest->what);
}

/* Whether fine surfaces are drawn with fewer triangles than they have. */
static void append_triangles(GString *text, SporeViewport *self) {
  gsize whole, coarse;
  if (!self->renderer || spore_viewport_is_fine(self)) return;
  spore_renderer_count_triangles(self->renderer, &whole, &coarse);
  if (coarse == whole) return;
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Plain pictures: %zu of %zu triangles are drawn"), coarse, whole);
}

/* Whether a picture of something that moves has fewer pixels than the view. */
static void append_sharpness(GString *text, SporeViewport *self) {
  if (!self->picture.coarse) return;
  if (text->len > 0) g_string_append_c(text, '\n');
  g_string_append(text, _("Plain pictures: half as sharp while something moves"));
}

/* What an author wants to know, and a clinician does not. */
static void append_figures(GString *text, SporeViewport *self, const SporeSession *session,
                           const SporeSnapshot *snapshot, const SporeSessionFigures *figures) {
  const SporeWorld *world = spore_session_simulation(session)->world;
  double factor = spore_session_real_time_factor(session);
  guint64 late, steps;
  spore_session_late_steps(session, &late, &steps);
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Step %.2f ms"), snapshot->step_us / 1000);
  if (factor > 0) {
    g_string_append(text, "  ·  ");
    g_string_append_printf(text, _("%.2f × real time"), factor);
  }
  if (late > 0) {
    g_string_append(text, "  ·  ");
    g_string_append_printf(text, _("%.1f %% of the steps late"), 100 * (double)late / (double)steps);
  }
  g_string_append_c(text, '\n');
  g_string_append_printf(text, _("Contacts %zu"), snapshot->contact_count);
  if (snapshot->counts.contact_depth > 0) {
    g_autofree char *depth = spore_length_text(snapshot->counts.contact_depth);
    g_string_append(text, "  ·  ");
    g_string_append_printf(text, _("deepest %s"), depth);
  }
  if (snapshot->counts.sleeping > 0) {
    g_string_append(text, "  ·  ");
    g_string_append_printf(text, _("%zu bodies at rest"), snapshot->counts.sleeping);
  }
  append_solver(text, world, snapshot, figures);
  append_energy(text, snapshot, figures);
  append_levels(text, world, snapshot);
  append_triangles(text, self);
  append_gaps(text);
}

/* What is all but closed is so. */
#define CLOSED_RAD 0.01

static void append_opening(GString *text, SporeViewport *self) {
  double opening;
  if (!spore_viewport_hand_opening(self, &opening)) return;
  g_string_append(text, "  ·  ");
  if (opening < CLOSED_RAD) g_string_append(text, _("closed"));
  else g_string_append_printf(text, _("open %.0f°"), opening * 180 / G_PI);
}

static void append_run(GString *text, SporeViewport *self, SporeSession *session) {
  const SporeSnapshot *snapshot = spore_session_snapshot(session);
  const SporeWorld *world = spore_session_simulation(session)->world;
  SporeSessionFigures figures = spore_session_figures(session);
  g_string_append_printf(text, _("Time %.3f s"), snapshot->time_s);
  append_pace(text, spore_session_real_time_factor(session), spore_session_get_speed(session));
  append_tools(text, snapshot);
  SporeVec3 tip, force;
  if (probe_force(self, &tip, &force)) {
    g_string_append_c(text, '\n');
    g_string_append_printf(text, _("Force on %s: %.3f N"), spore_object_name(spore_viewport_get_led(self)),
                           spore_vec3_length(force));
    append_opening(text, self);
  }
  append_unsolved(text, world, &figures);
  if (self->figures) append_figures(text, self, session, snapshot, &figures);
}

/* What has no room below the tools is left out, from the end on. */
static void show_figures(SporeViewport *self, GString *text) {
  int room = gtk_widget_get_allocated_height(self->area) - gtk_widget_get_allocated_height(self->tools) -
             gtk_widget_get_margin_top(self->tools);
  int width = gtk_widget_get_allocated_width(self->area), height;
  gtk_label_set_text(GTK_LABEL(self->hud), text->str);
  gtk_widget_get_preferred_height_for_width(self->hud, width, &height, NULL); /* with its margins */
  for (char *end = strrchr(text->str, '\n'); end && height > room; end = strrchr(text->str, '\n')) {
    *end = '\0';
    g_autofree char *shorter = g_strconcat(text->str, "\n…", NULL);
    gtk_label_set_text(GTK_LABEL(self->hud), shorter);
    gtk_widget_get_preferred_height_for_width(self->hud, width, &height, NULL);
  }
}

void spore_viewport_overlay_update(SporeViewport *self) {
  SporeSession *session = self->player ? spore_player_get_session(self->player) : NULL;
  g_autoptr(GString) text = g_string_new(NULL);
  if (session) append_run(text, self, session);
  append_sharpness(text, self);
  gtk_widget_set_visible(self->hud, text->len > 0);
  if (text->len > 0) show_figures(self, text);
}

void spore_viewport_set_figures(SporeViewport *self, gboolean figures) {
  self->figures = figures;
  spore_viewport_overlay_update(self);
}
