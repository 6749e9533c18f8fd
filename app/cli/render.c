/* spore render: a picture of a scene, with or without a display. */
#include <glib/gi18n.h>
#include <stdio.h>

#include "app/cli/cli.h"
#include "app/cli/scene.h"
#include "ui/render/stage.h"

#define LARGEST_SIDE 8192

typedef struct RenderOptions {
  char *size, *output, *camera, *time;
  char **level;
  gboolean spheres, tetrahedra;
  SporeSceneOptions scene;
} RenderOptions;

static gboolean parse_size(const char *text, int *width, int *height, GError **error) {
  char end = 0;
  *width = 1280, *height = 720;
  if (!text || (sscanf(text, "%dx%d%c", width, height, &end) == 2 && *width >= 16 && *height >= 16 &&
                *width <= LARGEST_SIDE && *height <= LARGEST_SIDE))
    return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--size", _("'%s' is no size; expected WxH, 16 to %d a side"),
                           text, LARGEST_SIDE);
}

static gboolean draw(SporeRun *run, const RenderOptions *options, int width, int height, char **gl_renderer,
                     GError **error) {
  SporeOffscreen *offscreen = spore_offscreen_new(error);
  SporeRenderer *renderer = offscreen ? spore_renderer_new(offscreen, error) : NULL;
  gboolean drawn = FALSE;
  if (renderer) {
    SporeStage *stage = spore_stage_new(renderer, run->document);
    SporeStageOptions shown = {.surfaces = TRUE, .spheres = options->spheres, .tetrahedra = options->tetrahedra};
    spore_stage_set_options(stage, &shown);
    spore_stage_rebuild(stage, run->simulation);
    spore_stage_update(stage, spore_world_snapshot_acquire(run->simulation->world));
    SporeCamera camera;
    SporeRenderOptions how = {.width = width, .height = height, .antialias = TRUE};
    g_autofree guint8 *pixels = g_malloc((gsize)width * (gsize)height * 4);
    drawn = spore_stage_camera(stage, options->camera, (double)width / height, &camera, error) &&
            spore_renderer_draw(renderer, &camera, &how, pixels, (gsize)width * 4, error) &&
            spore_png_write(options->output, pixels, width, height, (gsize)width * 4, error);
    spore_stage_free(stage);
    *gl_renderer = g_strdup(spore_offscreen_renderer(offscreen));
  }
  spore_renderer_free(renderer);
  spore_offscreen_free(offscreen);
  return drawn;
}

static int render(SporeCli *cli, const char *scene, const RenderOptions *options) {
  GError *error = NULL;
  int width = 0, height = 0;
  double time_s = 0;
  if (!spore_cli_has_room(options->output, scene, &error) || !parse_size(options->size, &width, &height, &error) ||
      (options->time && !spore_cli_seconds("--time", options->time, &time_s, &error)))
    return spore_cli_fail(error);
  g_autoptr(SporeRun) run = spore_run_open(cli, scene, &options->scene, 1, &error);
  if (!run) return spore_cli_fail(error);
  SporeWorld *world = run->simulation->world;
  g_autoptr(GArray) levels = spore_level_changes_parse(world, options->level, &error);
  if (!levels) return spore_cli_fail(error);
  while (spore_world_time_s(world) < time_s * (1 - 1e-12) && !spore_cli_interrupted()) {
    spore_level_changes_post(levels, world);
    spore_world_step(world);
    spore_world_tidy(world);
    spore_progress(spore_cli_progress(cli), spore_world_time_s(world) / time_s, _("running"));
  }
  if (spore_cli_interrupted()) return SPORE_EXIT_INTERRUPTED;
  g_autofree char *gl_renderer = NULL;
  if (!draw(run, options, width, height, &gl_renderer, &error)) return spore_cli_fail(error);
  spore_cli_count(cli, "width", width);
  spore_cli_count(cli, "height", height);
  spore_cli_count(cli, "frames", 1);
  spore_cli_text(cli, "gl_renderer", gl_renderer);
  spore_cli_say(cli, _("%s: %d x %d, drawn by %s\n"), options->output, width, height, gl_renderer);
  return spore_cli_finish(cli, SPORE_EXIT_DONE);
}

int spore_command_render(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {{"width", N_("of the picture, pixels")},
                                              {"height", N_("of the picture, pixels")},
                                              {"frames", N_("number of pictures")},
                                              {"gl_renderer", N_("what drew it")},
                                              {NULL, NULL}};
  static const SporeCommandInfo info = {"render", "SCENE", N_("Makes a picture of a scene (PNG)."), 1, 1, members};
  RenderOptions options = {0};
  const GOptionEntry entries[] = {
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &options.output, N_("Picture to write"), "F.png"},
      {"time", 't', 0, G_OPTION_ARG_STRING, &options.time, N_("Simulated time of the picture (default 0)"), "S"},
      {"level", 0, 0, G_OPTION_ARG_STRING_ARRAY, &options.level,
       N_("Change the level of a body while it runs, at 0 s or later: thread=coarse@1.5"), "BODY=LEVEL[@S]"},
      {"size", 's', 0, G_OPTION_ARG_STRING, &options.size, N_("Size in pixels (default 1280x720)"), "WxH"},
      {"camera", 0, 0, G_OPTION_ARG_STRING, &options.camera,
       N_("Camera of the scene (default: the first, or one that sees all)"), "NAME"},
      {"spheres", 0, 0, G_OPTION_ARG_NONE, &options.spheres, N_("Show collision spheres"), NULL},
      {"tetrahedra", 0, 0, G_OPTION_ARG_NONE, &options.tetrahedra, N_("Show tetrahedra"), NULL},
      SPORE_SCENE_OPTION_ENTRIES(options.scene),
      G_OPTION_ENTRY_NULL};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) {
    if (!options.output) status = spore_cli_usage(_("spore render: no picture named; expected -o F.png"));
    else status = render(cli, argv[1], &options);
  }
  spore_scene_options_clear(&options.scene);
  g_free(options.output);
  g_free(options.time);
  g_free(options.size);
  g_free(options.camera);
  g_strfreev(options.level);
  return status;
}
