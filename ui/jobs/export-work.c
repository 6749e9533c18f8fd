/* Exports a copy of the scene. */
#include "ui/jobs/export-work.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/scene/compile.h"
#include "ui/jobs/under-way.h"
#include "ui/jobs/work-place.h"

#define ROUNDING 1e-6 /* of a step */

static double step_of(const SporeDocument *document) {
  return spore_object_number(spore_document_section(document, "solver"), "time_step");
}

SporeExportWork *spore_export_work_new(const SporeDocument *document, const SporeExportFormat *format,
                                       const char *output, SporeTrack *input, double time_s, double every_s) {
  SporeExportWork *work = g_new0(SporeExportWork, 1);
  double dt_s = step_of(document);
  spore_work_begin();
  work->document = spore_document_copy(document);
  work->format = format;
  work->output = g_strdup(output);
  work->input = input;
  work->export = (SporeExport){.document = work->document, .input = input, .output = work->output};
  if (format->moments >= SPORE_EXPORT_ONE_MOMENT) work->export.steps = (guint64)fmax(0, ceil(time_s / dt_s - ROUNDING));
  if (format->moments == SPORE_EXPORT_SERIES && every_s > 0)
    work->export.stride = (guint64)fmax(1, round(every_s / dt_s));
  spore_export_init(&work->export);
  return work;
}

gboolean spore_export_work_run(gpointer data, const SporeProgress *progress, GError **error) {
  SporeExportWork *work = data;
  SporeWorkPlace place;
  spore_work_place_init(&place, progress);
  work->export.progress = &place.progress, work->export.cancel = &place.cancel;
  gboolean done = spore_export_run(&work->export, work->format, error);
  work->export.progress = NULL, work->export.cancel = NULL;
  return done;
}

void spore_export_work_free(gpointer data) {
  SporeExportWork *work = data;
  spore_export_clear(&work->export);
  spore_document_free(work->document);
  spore_input_free(work->input);
  g_free(work->output);
  g_free(work);
  spore_work_end();
}

static void append_escaped(GString *text, const char *sentence) {
  g_autofree char *escaped = g_markup_escape_text(sentence, -1);
  g_string_append_printf(text, "\n%s", escaped);
}

static void append_heading(GString *text, const char *heading) {
  g_string_append_printf(text, "%s<b>%s</b>", text->len ? "\n\n" : "", heading);
}

static void append_written(GString *text, const SporeExport *export) {
  gsize bytes;
  guint unsaid = spore_export_unsaid(export, &bytes);
  append_heading(text, _("Written"));
  for (guint i = unsaid; i < export->written->len; i++) {
    const SporeExported *one = &g_array_index(export->written, SporeExported, i);
    g_autofree char *size = g_format_size(one->bytes), *line = g_strdup_printf("%s: %s", one->file, size);
    append_escaped(text, line);
  }
  if (!unsaid) return;
  g_autofree char *size = g_format_size(bytes);
  g_autofree char *others =
      g_strdup_printf(ngettext("and %u other file: %s", "and %u other files: %s", unsaid), unsaid, size);
  append_escaped(text, others);
}

static void append_sentences(GString *text, const char *heading, const GPtrArray *sentences) {
  if (!sentences->len) return;
  append_heading(text, heading);
  for (guint i = 0; i < sentences->len; i++) append_escaped(text, sentences->pdata[i]);
}

char *spore_export_work_report(const SporeExportWork *work) {
  const SporeExport *export = &work->export;
  GString *text = g_string_new(NULL);
  append_written(text, export);
  if (export->unsolved) {
    g_autofree char *line =
        g_strdup_printf(_("%llu steps were not solved as the scene is written: the Problems tab says of which body, "
                          "and why, when the scene plays"),
                        (unsigned long long)export->unsolved);
    append_heading(text, _("Not solved"));
    append_escaped(text, line);
  }
  append_sentences(text, _("Lost"), export->lost);
  append_sentences(text, _("Left out"), export->left_out);
  return g_string_free(text, FALSE);
}
