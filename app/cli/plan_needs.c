/* What spore plan says of a scene's needs: models, files, shaders and libraries, and what leaving the rest out saves.
 */
#include <glib/gi18n.h>
#include <link.h>
#include <math.h>

#include "app/cli/plan_tables.h"
#include "core/scene/needs.h"
#ifdef SPORE_HAVE_RENDER
#include "ui/render/shader_needs.h"
#endif

/* Models. */

static void report_models(SporeCli *cli, const SporeWorld *world) {
  g_autoptr(GHashTable) counts = g_hash_table_new(g_str_hash, g_str_equal);
  g_autoptr(GPtrArray) names = g_ptr_array_new();
  g_autoptr(GString) row = g_string_new(NULL);
  for (guint32 body = 0; body < spore_world_body_count(world); body++) {
    const SporeModel *model = spore_world_body_model(world, body);
    if (!model) continue;
    gpointer name = (gpointer)(guintptr)model->type->name;
    int count = GPOINTER_TO_INT(g_hash_table_lookup(counts, name));
    if (count == 0) g_ptr_array_add(names, name);
    g_hash_table_insert(counts, name, GINT_TO_POINTER(count + 1));
  }
  spore_cli_open_array(cli, "models");
  for (guint i = 0; i < names->len; i++) {
    const char *name = names->pdata[i];
    int count = GPOINTER_TO_INT(g_hash_table_lookup(counts, name));
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", name);
    spore_cli_count(cli, "bodies", count);
    spore_cli_close(cli);
    g_string_append_printf(row, i ? ", %s (%d)" : "%s (%d)", name, count);
  }
  spore_cli_close_array(cli);
  if (names->len) spore_cli_say(cli, _("models (bodies): %s\n"), row->str);
}

/* Files. */

static void report_asset(SporeCli *cli, const SporeAssetNeed *need) {
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "name", spore_object_name(need->asset));
  spore_cli_text(cli, "use", spore_asset_use_names[need->use]);
  spore_cli_number(cli, "bytes", need->bytes ? (double)need->bytes : NAN);
  spore_cli_close(cli);
}

static void report_assets(SporeCli *cli, const GArray *needs) {
  guint count[SPORE_ASSET_USE_COUNT] = {0};
  double bytes[SPORE_ASSET_USE_COUNT] = {0};
  spore_cli_open_array(cli, "assets");
  for (guint i = 0; i < needs->len; i++) {
    const SporeAssetNeed *need = &g_array_index(needs, SporeAssetNeed, i);
    report_asset(cli, need);
    count[need->use]++;
    bytes[need->use] += (double)need->bytes;
  }
  spore_cli_close_array(cli);
  if (needs->len > 0)
    spore_cli_say(cli, _("files: %u simulated (%.1f kB), %u only drawn (%.1f kB)\n"), count[SPORE_ASSET_SIMULATED],
                  1e-3 * bytes[SPORE_ASSET_SIMULATED], count[SPORE_ASSET_DRAWN], 1e-3 * bytes[SPORE_ASSET_DRAWN]);
}

static void report_texture(SporeCli *cli, const SporeTextureNeed *need) {
  g_autoptr(GString) bodies = g_string_new(NULL);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "file", need->file);
  spore_cli_number(cli, "bytes", need->bytes ? (double)need->bytes : NAN);
  spore_cli_open_array(cli, "bodies");
  for (guint i = 0; i < need->bodies->len; i++) {
    const char *name = spore_object_name(need->bodies->pdata[i]);
    spore_cli_text(cli, NULL, name);
    g_string_append_printf(bodies, i ? ", %s" : "%s", name);
  }
  spore_cli_close_array(cli);
  spore_cli_close(cli);
  spore_cli_say(cli, _("texture: %s (%.1f kB), of %s\n"), need->file, 1e-3 * (double)need->bytes, bodies->str);
}

static void report_textures(SporeCli *cli, SporeDocument *document) {
  g_autoptr(GArray) needs = spore_document_texture_needs(document);
  spore_cli_open_array(cli, "textures");
  for (guint i = 0; i < needs->len; i++) report_texture(cli, &g_array_index(needs, SporeTextureNeed, i));
  spore_cli_close_array(cli);
}

/* Files that are left out together. */
static void report_left_out(SporeCli *cli, guint count, double bytes, const char *reason) {
  if (count == 0) return;
  g_autofree char *what = g_strdup_printf(ngettext("%u file", "%u files", count), count);
  spore_cli_open(cli, NULL);
  spore_cli_text(cli, "what", what);
  spore_cli_text(cli, "reason", reason);
  spore_cli_number(cli, "saves", NAN);
  spore_cli_number(cli, "bytes", bytes);
  spore_cli_close(cli);
  spore_cli_say(cli, _("left out: %s (%s): saves %.1f kB\n"), what, reason, 1e-3 * bytes);
}

static void report_files(SporeCli *cli, const GArray *needs, SporeAssetUse use, const char *reason) {
  guint count = 0;
  double bytes = 0;
  for (guint i = 0; i < needs->len; i++) {
    const SporeAssetNeed *need = &g_array_index(needs, SporeAssetNeed, i);
    if (need->use != use) continue;
    count++;
    bytes += (double)need->bytes;
  }
  report_left_out(cli, count, bytes, reason);
}

void spore_plan_report_files_left_out(SporeCli *cli, SporeDocument *document, const GArray *needs) {
  g_autoptr(GArray) textures = spore_document_texture_needs(document);
  double bytes = 0;
  for (guint i = 0; i < textures->len; i++) bytes += (double)g_array_index(textures, SporeTextureNeed, i).bytes;
  report_left_out(cli, textures->len, bytes, _("textures: a run draws nothing"));

  report_files(cli, needs, SPORE_ASSET_SOURCE, _("sources: a run reads what was generated from them"));
  report_files(cli, needs, SPORE_ASSET_UNUSED, _("nothing names them"));
}

/* Shaders. A run draws nothing, so that what is listed is of a picture, in a build that makes some. */

static void report_shaders(SporeCli *cli, const SporeRun *run) {
  g_autoptr(GString) row = g_string_new(NULL);
  spore_cli_open_array(cli, "shaders");
#ifdef SPORE_HAVE_RENDER
  g_autoptr(GArray) needs = spore_shader_needs(run->document, run->simulation);
  for (guint i = 0; i < needs->len; i++) {
    const SporeShaderNeed *need = &g_array_index(needs, SporeShaderNeed, i);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "name", need->name);
    spore_cli_count(cli, "bodies", need->bodies);
    spore_cli_close(cli);
    g_string_append_printf(row, i ? ", %s" : "%s", need->name);
    if (need->bodies) g_string_append_printf(row, " (%u)", need->bodies);
  }
#else
  (void)run;
#endif
  spore_cli_close_array(cli);
  spore_cli_say(cli, _("shaders: none, a run draws nothing; of a picture (bodies): %s\n"), row->len ? row->str : "-");
}

/* Libraries. */

static int report_library(struct dl_phdr_info *info, gsize size, void *data) {
  (void)size;
  if (info->dlpi_name && g_str_has_prefix(info->dlpi_name, "/")) {
    g_autofree char *name = g_path_get_basename(info->dlpi_name);
    spore_cli_text(data, NULL, name);
  }
  return 0;
}

void spore_plan_report_needs(SporeCli *cli, const SporeRun *run, const GArray *needs) {
  report_models(cli, run->simulation->world);
  report_assets(cli, needs);
  report_textures(cli, run->document);
  report_shaders(cli, run);
  spore_cli_open_array(cli, "libraries");
  dl_iterate_phdr(report_library, cli);
  spore_cli_close_array(cli);
}

/* Leaving out. */

int spore_plan_report_pruning(SporeCli *cli, const SporePruning *pruning) {
  spore_cli_open(cli, "unpruned");
  spore_cli_number(cli, "us", pruning->unpruned_us);
  spore_cli_number(cli, "ratio", pruning->ratio);
  spore_cli_text(cli, "equal", pruning->equal ? "bit" : pruning->most_asleep > 0 ? "bound" : "no");
  spore_cli_number(cli, "worst", pruning->worst);
  spore_cli_close(cli);
  spore_cli_say(cli,
                _("with nothing left out a step takes %.2f us instead of %.2f us (%.2f times as long, %.2f to %.2f in "
                  "half of the steps)"),
                pruning->unpruned_us, pruning->us, pruning->ratio, pruning->ratio_low, pruning->ratio_high);
  if (pruning->equal) {
    spore_cli_say(cli, _("; each of %zu steps gives the same state to the bit\n"), pruning->steps);
    return SPORE_EXIT_DONE;
  }
  if (pruning->most_asleep > 0) {
    spore_cli_say(cli,
                  _("; in %zu steps no node is farther off than %.2g m: where nothing is left out, bodies that sleep "
                    "(%zu at most) go on creeping\n"),
                  pruning->steps, pruning->worst, pruning->most_asleep);
    return SPORE_EXIT_DONE;
  }
  spore_cli_say(cli,
                _("; but a node is %.2g m off after %zu steps, although no body sleeps: this is a fault of ours\n"),
                pruning->worst, pruning->steps);
  return SPORE_EXIT_NOT_HELD;
}

gboolean spore_plan_measure_pruning(SporeRun *run, SporePruning *pruning, SporeSimulation **unpruned, GError **error) {
  *unpruned = spore_simulation_new_unpruned(run->document, run->pool, run->input.channel_count ? &run->input : NULL,
                                            spore_cli_cancel(), error);
  if (!*unpruned) return FALSE;
  double ratios[SPORE_PRUNING_STEPS];
  spore_pruning_measure(run->simulation->world, (*unpruned)->world, SPORE_PRUNING_STEPS, ratios, pruning);
  return TRUE;
}
