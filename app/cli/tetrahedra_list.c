/* spore tetrahedra --list: which labels a map holds, with names, volumes and sizes. */
#include "app/cli/tetrahedra_list.h"

#include <glib/gi18n.h>

static const char *const sides[3][2] = {{"i-", "i+"}, {"j-", "j+"}, {"k-", "k+"}};

/* The sides of the volume that the label reaches. "": none. g_free. */
static char *sides_of(const SporeLabelEntry *entry) {
  g_autoptr(GString) text = g_string_new(NULL);
  for (int k = 0; k < 3; k++)
    for (int end = 0; end < 2; end++)
      if (entry->cut[k][end]) g_string_append_printf(text, "%s%s", text->len ? " " : "", sides[k][end]);
  return g_string_free(g_steal_pointer(&text), FALSE);
}

void spore_cli_report_sides(SporeCli *cli, const SporeLabelEntry *entry) {
  spore_cli_open_array(cli, "cut");
  for (int side = 0; side < 6; side++)
    if (entry->cut[side / 2][side % 2]) spore_cli_text(cli, NULL, sides[side / 2][side % 2]);
  spore_cli_close_array(cli);
}

void spore_cli_say_sides(const SporeCli *cli, const SporeLabelEntry *entry) {
  g_autofree char *reached = sides_of(entry);
  if (*reached) spore_cli_say(cli, _("  reaches the edge of the volume, which may cut it (%s)"), reached);
}

static void report_entry(SporeCli *cli, const SporeLabelEntry *entry) {
  spore_cli_open(cli, NULL);
  spore_cli_count(cli, "label", entry->label);
  spore_cli_text(cli, "name", entry->naming == SPORE_LABEL_UNNAMED ? NULL : entry->name);
  spore_cli_text(cli, "named", spore_label_namings[entry->naming]);
  spore_cli_count(cli, "voxels", (gint64)entry->voxels);
  spore_cli_number(cli, "volume_m3", entry->volume);
  spore_cli_open_array(cli, "size_m");
  for (int k = 0; k < 3; k++) spore_cli_number(cli, NULL, entry->size[k]);
  spore_cli_close_array(cli);
  spore_cli_report_sides(cli, entry);
  spore_cli_close(cli);
}

static void say_entry(const SporeCli *cli, const SporeLabelEntry *entry) {
  g_autofree char *size =
      g_strdup_printf("%.3g x %.3g x %.3g", 100 * entry->size[0], 100 * entry->size[1], 100 * entry->size[2]);
  spore_cli_say(cli, "%5u  %-28s %10.4g  %-20s", entry->label, entry->name, 1e6 * entry->volume, size);
  if (entry->naming == SPORE_LABEL_GUESSED) spore_cli_say(cli, _("  guessed"));
  spore_cli_say_sides(cli, entry);
  spore_cli_say(cli, "\n");
}

void spore_cli_report_list(SporeCli *cli, const SporeLabelSurvey *survey) {
  spore_cli_say(cli, _("%zu x %zu x %zu voxels of %.3g x %.3g x %.3g mm; labels: %u\n"), survey->size[0],
                survey->size[1], survey->size[2], 1000 * survey->spacing[0], 1000 * survey->spacing[1],
                1000 * survey->spacing[2], survey->entries->len);
  spore_cli_say(cli, "%5s  %-28s %10s  %s\n", _("label"), _("name"), _("volume cm3"), _("size cm"));
  gboolean guessed = FALSE;
  spore_cli_open_array(cli, "labels");
  for (guint i = 0; i < survey->entries->len; i++) {
    const SporeLabelEntry *entry = &g_array_index(survey->entries, SporeLabelEntry, i);
    report_entry(cli, entry);
    say_entry(cli, entry);
    guessed = guessed || entry->naming == SPORE_LABEL_GUESSED;
  }
  spore_cli_close_array(cli);
  if (guessed)
    spore_cli_say(cli, _("guessed: by the label's number in a common set; a table beside the file (NAME.json: "
                         "{\"1\": \"spleen\"}) settles the names\n"));
}
