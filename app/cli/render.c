/* spore render: a picture of a scene, a row of pictures, or a film; with or without a display. */
#include <glib/gi18n.h>
#include <math.h>
#include <stdio.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "core/scene/port_reach.h"
#include "ui/render/filming.h"
#include "ui/render/stage_ports.h"

#define LARGEST_SIDE 8192
#define LARGEST_FPS 1000
#define LARGEST_SPEED 1000
#define HIGHEST_FIELD 1e15

typedef struct RenderOptions {
  char *size, *output, *camera, *time, *beside, *clip, *reach, *field, *field_end;
  char *from, *fps, *speed; /* of a film or a row of pictures */
  char **level;
  gboolean spheres, tetrahedra, contacts, links, light, no_legends;
  SporeSceneOptions scene;
} RenderOptions;

/* The runs that are drawn, side by side. */
typedef struct Runs {
  guint count;
  SporeRun *runs[SPORE_FILMING_MOST];
  GArray *levels[SPORE_FILMING_MOST]; /* changes of level */
} Runs;

static void clear_runs(Runs *runs) {
  for (guint i = 0; i < runs->count; i++) {
    if (runs->levels[i]) g_array_unref(runs->levels[i]);
    spore_run_free(runs->runs[i]);
  }
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Runs, clear_runs)

/* What the options say without a scene. */

static gboolean parse_size(const char *text, int *width, int *height, GError **error) {
  char end = 0;
  *width = 1280, *height = 720;
  if (!text || (sscanf(text, "%dx%d%c", width, height, &end) == 2 && *width >= 16 && *height >= 16 &&
                *width <= LARGEST_SIDE && *height <= LARGEST_SIDE))
    return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--size", _("'%s' is no size; expected WxH, 16 to %d a side"),
                           text, LARGEST_SIDE);
}

/* A number above 0; NULL keeps what is there. */
static gboolean parse_rate(const char *option, const char *text, double largest, double *rate, GError **error) {
  if (!text || (spore_cli_seconds(option, text, rate, NULL) && *rate > 0 && *rate <= largest)) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, option,
                           _("'%s'; expected a number that is more than 0 and at most %g"), text, largest);
}

/* FALSE: it is not exactly four finite numbers between commas. */
static gboolean read_four(const char *text, double number[4]) {
  for (int k = 0; k < 4; k++) {
    char *end;
    number[k] = g_ascii_strtod(text, &end);
    if (end == text || !isfinite(number[k]) || *end != (k < 3 ? ',' : '\0')) return FALSE;
    text = end + 1;
  }
  return TRUE;
}

/* The direction may have any length but 0. text NULL: nothing is hidden. */
static gboolean parse_clip(const char *text, SporeClip *clip, GError **error) {
  double number[4];
  if (!text) return TRUE;
  SporeVec3 normal = read_four(text, number) ? spore_vec3_load(number) : (SporeVec3){0};
  if (!(spore_vec3_length(normal) > 0))
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--clip",
                             _("'%s' is no plane; expected NX,NY,NZ,D: a direction other than 0, and how far along it "
                               "from the origin the plane lies, in metres; such as 0,0,1,0.02"),
                             text);
  *clip = (SporeClip){spore_vec3_normalise(normal, normal), number[3]};
  return TRUE;
}

/* One scale for all pictures, or their colours could not be compared. */
static gboolean parse_field(const RenderOptions *options, SporeReelKind kind, SporeStageOptions *shown,
                            GError **error) {
  if (options->field_end && !options->field)
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--field-end", "%s",
                             _("it is the end of a scale, and no colours are asked for; expected --field as well"));
  for (guint i = 0; options->field && spore_stage_field_names[i]; i++)
    if (g_str_equal(options->field, spore_stage_field_names[i])) shown->field = i;
  if (options->field && shown->field == SPORE_FIELD_NONE) {
    g_autofree char *names = g_strjoinv(", ", (char **)spore_stage_field_names + 1);
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--field",
                             _("'%s' is nothing that colours show; expected one of: %s"), options->field, names);
  }
  if (options->field && shown->field != SPORE_FIELD_LEVEL && shown->field != SPORE_FIELD_CELLS && !options->field_end &&
      (options->beside || kind != SPORE_REEL_PICTURE))
    return spore_error_raise(error, SPORE_ERROR_INPUT, "--field", "%s",
                             _("several pictures need one scale of colours; expected --field-end as well"));
  return parse_rate("--field-end", options->field_end, HIGHEST_FIELD, &shown->field_end, error);
}

/* A film's size is bounded where the pictures of two runs stand in a row. */
static gboolean check_width(const RenderOptions *options, int width, GError **error) {
  if (!options->beside || 2 * width <= LARGEST_SIDE) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--size",
                           _("two pictures of %d pixels side by side are too wide; expected at most %d each"), width,
                           LARGEST_SIDE / 2);
}

static gboolean parse_filming(const RenderOptions *options, SporeFilming *filming, GError **error) {
  const struct {
    const char *option, *text;
  } of_films[] = {{"--from", options->from}, {"--fps", options->fps}, {"--speed", options->speed}};
  SporeReelKind kind;
  *filming = (SporeFilming){.file = options->output,
                            .fps = 30,
                            .speed = 1,
                            .camera = options->camera,
                            .ports = options->reach,
                            .shown = {.surfaces = TRUE,
                                      .spheres = options->spheres,
                                      .tetrahedra = options->tetrahedra,
                                      .contacts = options->contacts,
                                      .links = options->links},
                            .light = options->light,
                            .legends = !options->no_legends,
                            .cancel = spore_cli_cancel()};
  if (!spore_reel_kind(options->output, &kind, error)) return FALSE;
  for (gsize i = 0; kind == SPORE_REEL_PICTURE && i < G_N_ELEMENTS(of_films); i++)
    if (of_films[i].text)
      return spore_error_raise(error, SPORE_ERROR_INPUT, options->output,
                               _("is the name of one picture, and %s is of several; expected F-%%05d.png (a row of "
                                 "pictures) or F.webm (a film)"),
                               of_films[i].option);
  return parse_field(options, kind, &filming->shown, error) &&
         parse_size(options->size, &filming->width, &filming->height, error) &&
         check_width(options, filming->width, error) && parse_clip(options->clip, &filming->clip, error) &&
         parse_rate("--fps", options->fps, LARGEST_FPS, &filming->fps, error) &&
         parse_rate("--speed", options->speed, LARGEST_SPEED, &filming->speed, error) &&
         (!options->from || spore_cli_seconds("--from", options->from, &filming->from_s, error)) &&
         (!options->time || spore_cli_seconds("--time", options->time, &filming->to_s, error));
}

static gboolean check_output(const char *scene, const RenderOptions *options, GError **error) {
  const char *const inputs[] = {scene, options->scene.input, options->beside};
  g_autofree char *first = spore_reel_file(options->output, 0);
  for (gsize i = 0; i < G_N_ELEMENTS(inputs); i++)
    if (inputs[i] && !spore_cli_has_room(first, inputs[i], error)) return FALSE;
  return TRUE;
}

/* What they say with a scene. */

static gboolean open_run(SporeCli *cli, const char *scene, const SporeSceneOptions *how, char **level, Runs *runs,
                         GError **error) {
  SporeRun *run = spore_run_open(cli, scene, how, 1, error);
  if (!run) return FALSE;
  guint index = runs->count++;
  runs->runs[index] = run;
  runs->levels[index] = spore_level_changes_parse(run->simulation->world, level, error);
  return runs->levels[index] != NULL;
}

static gboolean open_runs(SporeCli *cli, const char *scene, const RenderOptions *options, Runs *runs, GError **error) {
  if (!open_run(cli, scene, &options->scene, options->level, runs, error)) return FALSE;
  SporeSceneOptions beside = options->scene;
  beside.input = options->beside;
  return !options->beside || open_run(cli, scene, &beside, options->level, runs, error);
}

/* A film ends where the recorded input does, unless --time says where. */
static gboolean find_end(const RenderOptions *options, const Runs *runs, SporeFilming *filming, GError **error) {
  SporeReelKind kind;
  if (!spore_reel_kind(options->output, &kind, error) || kind == SPORE_REEL_PICTURE) return kind == SPORE_REEL_PICTURE;
  for (guint i = 0; !options->time && i < runs->count; i++)
    filming->to_s = fmax(filming->to_s, spore_track_end_s(runs->runs[i]->simulation->track));
  if (filming->to_s > filming->from_s) return TRUE;
  if (!options->time && filming->to_s <= 0)
    return spore_error_raise(error, SPORE_ERROR_INPUT, options->output, "%s",
                             _("nothing says when it ends, since the scene has no recorded input; expected --time S"));
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--time",
                           _("ends at %g s, and begins at %g s; expected an end after the beginning"), filming->to_s,
                           filming->from_s);
}

static void change_levels(gpointer data, guint simulation) {
  Runs *runs = data;
  spore_level_changes_post(runs->levels[simulation], runs->runs[simulation]->simulation->world);
}

static void say_reach(SporeCli *cli, SporeDocument *document, const GArray *ports, const SporeObject *body) {
  double share;
  if ((SporeRole)spore_object_number(body, "role") == SPORE_ACTIVE ||
      !spore_ports_share(document, (const SporePortReach *)(void *)ports->data, ports->len, body, &share))
    return;
  g_autofree char *part = spore_port_share_text(share);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "body", spore_object_name(body));
  spore_cli_number(cli, "share", share);
  spore_cli_close(cli);
  spore_cli_say(cli, _("  reached of \"%s\": %s\n"), spore_object_name(body), part);
}

/* The legend of the tint. */
static gboolean tell_reach(SporeCli *cli, SporeDocument *document, const char *name, GError **error) {
  g_autoptr(GArray) ports = spore_stage_find_ports(document, name, error);
  const SporeObject *bodies = spore_document_section(document, "bodies");
  if (!ports) return FALSE;
  SporeStageLegend legend;
  spore_stage_reach_legend(ports->len, spore_object_name(g_array_index(ports, SporePortReach, 0).port), &legend);
  g_autofree char *text = spore_stage_legend_text(&legend);
  spore_stage_legend_clear(&legend);
  spore_cli_say(cli, "%s\n", text);
  spore_cli_open_array(cli, "reach");
  for (guint i = 0; i < spore_object_child_count(bodies); i++)
    say_reach(cli, document, ports, spore_object_child(bodies, i));
  spore_cli_close_array(cli);
  return TRUE;
}

static void tell_legends(SporeCli *cli, const char *field, const SporeFilmed *filmed) {
  if (field) spore_cli_text(cli, "field", field);
  if (filmed->field_end > 0) spore_cli_number(cli, "field_end", filmed->field_end);
  spore_cli_say(cli, "%s", filmed->legends);
  if (filmed->no_legends) spore_cli_say(cli, _("The picture has no legend: %s\n"), filmed->no_legends->message);
  else if (filmed->legends_left_out > 0)
    spore_cli_say(cli,
                  ngettext("The picture is too small for %u legend; a larger --size has room\n",
                           "The picture is too small for %u legends; a larger --size has room\n",
                           filmed->legends_left_out),
                  filmed->legends_left_out);
}

static void tell(SporeCli *cli, const char *output, const SporeFilmed *filmed) {
  spore_cli_count(cli, "width", filmed->width);
  spore_cli_count(cli, "height", filmed->height);
  spore_cli_count(cli, "frames", (gint64)filmed->pictures);
  spore_cli_number(cli, "length_s", filmed->length_s);
  spore_cli_text(cli, "gl_renderer", filmed->gl_renderer);
  if (filmed->length_s > 0)
    spore_cli_say(cli, _("%s: %d x %d, %llu pictures, %.2f s, drawn by %s\n"), output, filmed->width, filmed->height,
                  (unsigned long long)filmed->pictures, filmed->length_s, filmed->gl_renderer);
  else spore_cli_say(cli, _("%s: %d x %d, drawn by %s\n"), output, filmed->width, filmed->height, filmed->gl_renderer);
}

static int render(SporeCli *cli, const char *scene, const RenderOptions *options) {
  GError *error = NULL;
  SporeFilming filming;
  g_auto(Runs) runs = {0};
  if (!parse_filming(options, &filming, &error) || !check_output(scene, options, &error) ||
      !open_runs(cli, scene, options, &runs, &error) || !find_end(options, &runs, &filming, &error))
    return spore_cli_fail(error);
  filming.count = runs.count;
  for (guint i = 0; i < runs.count; i++)
    filming.documents[i] = runs.runs[i]->document, filming.simulations[i] = runs.runs[i]->simulation;
  filming.before_step = change_levels;
  filming.data = &runs;
  SporeFilmed filmed;
  if (options->reach && !tell_reach(cli, runs.runs[0]->document, options->reach, &error)) return spore_cli_fail(error);
  if (!spore_filming_run(&filming, spore_cli_progress(cli), &filmed, &error)) return spore_cli_fail(error);
  tell(cli, options->output, &filmed);
  tell_legends(cli, options->field, &filmed);
  g_free(filmed.legends);
  g_clear_error(&filmed.no_legends);
  g_free(filmed.gl_renderer);
  return spore_cli_finish(cli, SPORE_EXIT_DONE);
}

static void clear_options(RenderOptions *options) {
  char *const texts[] = {options->field,  options->field_end, options->clip,   options->reach,
                         options->size,   options->output,    options->camera, options->time,
                         options->beside, options->from,      options->fps,    options->speed};
  for (gsize i = 0; i < G_N_ELEMENTS(texts); i++) g_free(texts[i]);
  g_strfreev(options->level);
  spore_scene_options_clear(&options->scene);
}

int spore_command_render(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"width", N_("of the picture, pixels")},
      {"height", N_("of the picture, pixels")},
      {"frames", N_("number of pictures")},
      {"length_s", N_("of the film or the row, s; 0: a single picture")},
      {"gl_renderer", N_("what drew it")},
      {"reach", N_("with --reach, of each organ: body, share of its surface that is reached at the start")},
      {"field", N_("what colours show: strain, stress, velocity, level or cells, with --field")},
      {"field_end", N_("end of the scale of colours, which begins at 0; strain: 1 is 100 %; stress: Pa; velocity: m/s; "
                       "cells: degrees")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "render", "SCENE", N_("Makes a picture of a scene (PNG), a row of pictures, or a film (WebM)."), 1, 1, members};
  RenderOptions options = {0};
  const GOptionEntry entries[] = {
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output,
       N_("F.png: a picture; F-%05d.png: a row of pictures, numbered from 0; F.webm: a film"), "F"},
      {"time", 't', 0, G_OPTION_ARG_STRING, &options.time,
       N_("Simulated time of the picture (default 0), or of the end of the film (default: when the recorded input "
          "ends)"),
       "S"},
      {"from", 0, 0, G_OPTION_ARG_STRING, &options.from, N_("Simulated time at which the film begins (default 0)"),
       "S"},
      {"fps", 0, 0, G_OPTION_ARG_STRING, &options.fps, N_("Pictures of the film in a second (default 30)"), "N"},
      {"speed", 0, 0, G_OPTION_ARG_STRING, &options.speed,
       N_("Simulated seconds in a second of the film (default 1); 0.25: slow motion"), "X"},
      {"beside", 0, 0, G_OPTION_ARG_FILENAME, &options.beside,
       N_("Show at the right, at the same moments, the scene with this recorded device input"), "TRACK"},
      {"level", 0, 0, G_OPTION_ARG_STRING_ARRAY, &options.level,
       N_("Change the level of a body while it runs, at 0 s or later: thread=coarse@1.5"), "BODY=LEVEL[@S]"},
      {"size", 's', 0, G_OPTION_ARG_STRING, &options.size,
       N_("Size in pixels (default 1280x720); with --beside, of each of the two"), "WxH"},
      {"camera", 0, 0, G_OPTION_ARG_STRING, &options.camera,
       N_("Camera of the scene (default: the first, or one that sees all)"), "NAME"},
      {"clip", 0, 0, G_OPTION_ARG_STRING, &options.clip,
       N_("Hide what lies beyond a plane: further along the direction NX,NY,NZ than D metres from the origin"),
       "NX,NY,NZ,D"},
      {"light", 0, 0, G_OPTION_ARG_NONE, &options.light, N_("Draw the room around the scene light, as for print"),
       NULL},
      {"reach", 0, 0, G_OPTION_ARG_STRING, &options.reach,
       N_("Show what is reached through this port, or through all of them (all): cones, and what none reaches in blue"),
       "PORT"},
      {"field", 0, 0, G_OPTION_ARG_STRING, &options.field,
       N_("Colour soft bodies by strain (largest principal Green's strain), stress (von Mises, from the body's own "
          "law), "
          "velocity, level of detail, or cells (least angle of the worst one there)"),
       "WHAT"},
      {"field-end", 0, 0, G_OPTION_ARG_STRING, &options.field_end,
       N_("End of the scale of colours, in SI units (0.2: 20 % strain); default: it follows the state that is shown"),
       "N"},
      {"spheres", 0, 0, G_OPTION_ARG_NONE, &options.spheres, N_("Show collision spheres"), NULL},
      {"contacts", 0, 0, G_OPTION_ARG_NONE, &options.contacts, N_("Show contact forces"), NULL},
      {"links", 0, 0, G_OPTION_ARG_NONE, &options.links,
       N_("Show links, a colour for each kind; what bears most is named"), NULL},
      {"tetrahedra", 0, 0, G_OPTION_ARG_NONE, &options.tetrahedra, N_("Show tetrahedra"), NULL},
      {"no-legends", 0, 0, G_OPTION_ARG_NONE, &options.no_legends,
       N_("Leave the legends of colours and lines out of the picture"), NULL},
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    if (!options.output) status = spore_cli_usage(_("spore render: no picture named; expected -o F.png or F.webm"));
    else status = render(cli, argv[1], &options);
  }
  clear_options(&options);
  return status;
}
