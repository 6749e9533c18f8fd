/* What the commands of spore share: options, the report and its lines, exit statuses, and interruption. */
#include "app/cli/cli.h"

#include <errno.h>
#include <glib/gi18n.h>
#include <glib/gstdio.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include "core/base/number.h"
#include "core/io/file_batch.h"
#include "core/io/mesh_import.h"
#include "core/io/scene_xml.h"
#include "core/mesh/common.h"
#include "core/scene/length_unit.h"

#define GRACE_NS 300000000 /* of half a second that a user waits: to take back memory takes the system time, too */
#define AGAIN_NS 20000000

static volatile sig_atomic_t interrupted;
static timer_t grace;
static bool has_grace;

gboolean spore_cli_interrupted(void) { return interrupted != 0; }

static bool asked(void *data) { return interrupted != 0; }

const SporeCancel *spore_cli_cancel(void) {
  static const SporeCancel cancel = {asked, NULL};
  return &cancel;
}

static void end_after(long nanoseconds) {
  const struct itimerspec when = {.it_value = {.tv_nsec = nanoseconds}};
  if (has_grace) timer_settime(grace, 0, &when, NULL);
}

static void on_signal(int number) {
  if (!interrupted) end_after(GRACE_NS);
  interrupted = number;
}

/* A file that is being written is written to the end, and then taken back with all that do not stand yet. */
static void on_grace(int number) {
  if (spore_file_batches_end()) _exit(SPORE_EXIT_INTERRUPTED);
  end_after(AGAIN_NS);
}

/* The handler of a signal sets a flag. Work that sees the flag ends by itself. What does not look at the flag, such as
 * a library that reads a mesh, is ended by a timer. */
static void catch_signals(void) {
  struct sigaction action = {.sa_handler = on_signal};
  struct sigaction ending = {.sa_handler = on_grace, .sa_flags = SA_RESTART};
  struct sigevent event = {.sigev_notify = SIGEV_SIGNAL, .sigev_signo = SIGALRM};
  has_grace = timer_create(CLOCK_MONOTONIC, &event, &grace) == 0;
  sigaction(SIGALRM, &ending, NULL);
  sigaction(SIGINT, &action, NULL);
  sigaction(SIGTERM, &action, NULL);
}

static char *describe(const SporeCommandInfo *info) {
  g_autofree char *more = info->describe ? info->describe() : NULL;
  GString *text = g_string_new(more);
  if (more) g_string_append(text, "\n\n");
  g_string_append(text, _("Members of the object that --json prints:"));
  for (const SporeReportMember *members = info->report; members->name; members++)
    g_string_append_printf(text, "\n  %-21s %s", members->name, _(members->doc));
  return g_string_free(text, FALSE);
}

int spore_cli_parse(SporeCli *cli, const SporeCommandInfo *info, const GOptionEntry *entries, int *argc, char ***argv) {
  return spore_cli_parse_with(cli, info, entries, NULL, argc, argv);
}

/* GLib leaves "--" where it is when what follows begins with a dash. */
static void drop_end_of_options(int *argc, char **argv) {
  int end = 1;
  while (end < *argc && !g_str_equal(argv[end], "--")) end++;
  if (end == *argc) return;
  for (int i = end; i < *argc; i++) argv[i] = argv[i + 1];
  --*argc;
}

int spore_cli_parse_with(SporeCli *cli, const SporeCommandInfo *info, const GOptionEntry *entries, gpointer data,
                         int *argc, char ***argv) {
  const GOptionEntry shared[] = {
      {"json", 0, 0, G_OPTION_ARG_NONE, &cli->json, N_("Print one JSON object and nothing else"), NULL},
      {"quiet", 'q', 0, G_OPTION_ARG_NONE, &cli->quiet, N_("Print errors only"), NULL},
      G_OPTION_ENTRY_NULL};
  g_autoptr(GOptionContext) context = g_option_context_new(info->arguments);
  g_autofree char *description = describe(info);
  g_option_context_set_summary(context, _(info->summary));
  g_option_context_set_description(context, description);
  GOptionGroup *group = g_option_group_new(NULL, NULL, NULL, data, NULL);
  g_option_group_set_translation_domain(group, GETTEXT_PACKAGE);
  g_option_group_add_entries(group, entries);
  g_option_group_add_entries(group, shared);
  g_option_context_set_main_group(context, group); /* takes ownership */
  g_autoptr(GError) error = NULL;
  if (!g_option_context_parse(context, argc, argv, &error))
    return spore_cli_usage(_("spore %s: %s; see `spore %s --help`"), info->name, error->message, info->name);
  drop_end_of_options(argc, *argv);
  if (*argc - 1 < info->minimum || *argc - 1 > info->maximum)
    return spore_cli_usage(_("spore %s: %d plain arguments given; expected %s; see `spore %s --help`"), info->name,
                           *argc - 1, info->arguments, info->name);
  catch_signals();
  return SPORE_EXIT_DONE;
}

void spore_cli_say(const SporeCli *cli, const char *format, ...) {
  if (cli->json || cli->quiet) return;
  va_list arguments;
  va_start(arguments, format);
  vprintf(format, arguments);
  va_end(arguments);
}

int spore_cli_fail(GError *error) {
  int status = g_error_matches(error, SPORE_ERROR, SPORE_ERROR_CANCELLED) ? SPORE_EXIT_INTERRUPTED
                                                                          : spore_error_exit_status(error);
  fprintf(stderr, "%s\n", error->message);
  g_error_free(error);
  return status;
}

int spore_cli_usage(const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *line = spore_error_line(g_strdup_vprintf(format, arguments));
  va_end(arguments);
  fprintf(stderr, "%s\n", line);
  return SPORE_EXIT_INPUT;
}

int spore_cli_finish(SporeCli *cli, int status) {
  if (!cli->json) return status;
  json_builder_end_object(cli->report);
  g_autoptr(JsonGenerator) generator = json_generator_new();
  g_autoptr(JsonNode) root = json_builder_get_root(cli->report);
  json_generator_set_root(generator, root);
  json_generator_set_pretty(generator, TRUE);
  g_autofree char *text = json_generator_to_data(generator, NULL);
  puts(text);
  return status;
}

static void name_member(SporeCli *cli, const char *member) {
  if (member) json_builder_set_member_name(cli->report, member);
}

void spore_cli_number(SporeCli *cli, const char *member, double value) {
  name_member(cli, member);
  if (isfinite(value)) json_builder_add_double_value(cli->report, value);
  else json_builder_add_null_value(cli->report);
}

void spore_cli_count(SporeCli *cli, const char *member, gint64 value) {
  name_member(cli, member);
  json_builder_add_int_value(cli->report, value);
}

void spore_cli_flag(SporeCli *cli, const char *member, gboolean value) {
  name_member(cli, member);
  json_builder_add_boolean_value(cli->report, value);
}

void spore_cli_text(SporeCli *cli, const char *member, const char *value) {
  name_member(cli, member);
  if (value) json_builder_add_string_value(cli->report, value);
  else json_builder_add_null_value(cli->report);
}

void spore_cli_open(SporeCli *cli, const char *member) {
  name_member(cli, member);
  json_builder_begin_object(cli->report);
}

void spore_cli_open_array(SporeCli *cli, const char *member) {
  name_member(cli, member);
  json_builder_begin_array(cli->report);
}

void spore_cli_close(SporeCli *cli) { json_builder_end_object(cli->report); }
void spore_cli_close_array(SporeCli *cli) { json_builder_end_array(cli->report); }

static bool report_progress(void *data, double fraction, const char *stage) {
  const SporeCli *cli = data;
  static int shown = -1;
  int percent = (int)(100 * CLAMP(fraction, 0, 1));
  if (percent != shown && !cli->quiet && isatty(STDERR_FILENO)) {
    fprintf(stderr, "\r\033[K%3d%% %s", percent, stage ? stage : "");
    if (percent == 100) fprintf(stderr, "\r\033[K");
    shown = percent;
  }
  return !spore_cli_interrupted();
}

const SporeProgress *spore_cli_progress(const SporeCli *cli) {
  static SporeProgress progress = {.report = report_progress};
  progress.data = (void *)cli;
  return &progress;
}

gboolean spore_cli_keeps(const char *output, const char *input, GError **error) {
  struct stat one, other;
  if (stat(output, &one) != 0 || stat(input, &other) != 0 || !S_ISREG(one.st_mode) || one.st_dev != other.st_dev ||
      one.st_ino != other.st_ino)
    return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, output,
                           _("this is the input; expected another file to write to; name one"));
}

gboolean spore_cli_has_room(const char *output, const char *input, GError **error) {
  return spore_file_may_be_written(output, FALSE, error) && spore_cli_keeps(output, input, error);
}

gboolean spore_cli_has_room_for_scene(const char *output, const char *input, GError **error) {
  return spore_file_may_be_written(output, TRUE, error) && spore_cli_keeps(output, input, error);
}

/* The folders on the way to the file that do not exist, innermost first. */
static GPtrArray *missing_folders(const char *file) {
  GPtrArray *missing = g_ptr_array_new_with_free_func(g_free);
  char *folder = g_path_get_dirname(file);
  while (!g_file_test(folder, G_FILE_TEST_EXISTS)) {
    g_ptr_array_add(missing, folder);
    folder = g_path_get_dirname(folder);
  }
  g_free(folder);
  return missing;
}

gboolean spore_cli_save_scene(SporeDocument *document, const char *file, GError **error) {
  g_autofree char *folder = g_path_get_dirname(file);
  g_autoptr(GPtrArray) missing = missing_folders(file);
  gboolean made = g_mkdir_with_parents(folder, 0777) == 0;
  if (!made)
    spore_error_raise(error, SPORE_ERROR_FILE, folder, _("the folder cannot be made (%s); name another place"),
                      g_strerror(errno));
  if (made && spore_scene_save(document, file, error)) return TRUE;
  for (guint i = 0; i < missing->len; i++) g_rmdir(g_ptr_array_index(missing, i));
  return FALSE;
}

gboolean spore_cli_seconds(const char *option, const char *text, double *seconds, GError **error) {
  gsize length = strlen(text);
  if (spore_number_read(text, length, seconds) == length && length > 0 && *seconds >= 0 && isfinite(*seconds))
    return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, option, _("%s s; expected a time of 0 s or more"), text);
}

int spore_cli_choice(const char *option, const char *text, const char *const *choices, GError **error) {
  for (int i = 0; choices[i]; i++)
    if (g_str_equal(choices[i], text)) return i;
  g_autofree char *all = g_strjoinv(", ", (char **)choices);
  spore_error_raise(error, SPORE_ERROR_INPUT, option, _("'%s' is not known; expected one of %s"), text, all);
  return -1;
}

GBytes *spore_cli_read_file(const char *file, const char *expected, GError **error) {
  char *bytes = NULL;
  gsize size = 0;
  g_autoptr(GError) cause = NULL;
  if (g_file_test(file, G_FILE_TEST_EXISTS) && !g_file_test(file, G_FILE_TEST_IS_REGULAR))
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("is not a regular file; expected %s; name such a file"),
                      expected);
  else if (!g_file_get_contents(file, &bytes, &size, &cause))
    spore_error_raise(error, SPORE_ERROR_FILE, file, _("cannot be read (%s); expected %s; check the path"),
                      cause->message, expected);
  return bytes ? g_bytes_new_take(bytes, size) : NULL;
}

/* Said before the work starts, so that a wrong unit is noticed at once. */
static void say_size(const SporeCli *cli, const char *file, const SporeTriangleMesh *mesh, int unit) {
  double diagonal_m = spore_mesh_diagonal(mesh->vertices, mesh->vertex_count, 3);
  g_autofree char *length = spore_length_text(diagonal_m), *doubt = spore_length_doubt(diagonal_m, unit);
  if (doubt) spore_cli_say(cli, _("%s: %s across in %s; %s (--unit)\n"), file, length, spore_length_units[unit], doubt);
}

/* A mesh file that is read: as given, and as it was understood. */
typedef struct Read {
  const char *file, *unit, *frame; /* frame NULL: the axes that the file states */
  int unit_chosen, frame_chosen;
  GBytes *content;
} Read;

/* The content, unit and axes of a mesh file; the caller unrefs the content. */
static gboolean read_content(Read *read, GError **error) {
  read->unit_chosen = spore_cli_choice("--unit", read->unit ? read->unit : "m", spore_length_units, error);
  read->frame_chosen = read->frame ? spore_cli_choice("--frame", read->frame, spore_mesh_frames, error) : 0;
  if (read->unit_chosen < 0 || read->frame_chosen < 0) return FALSE;
  g_autoptr(GBytes) given = spore_cli_read_file(read->file, _("a mesh"), error);
  read->content = given ? spore_mesh_whole(read->file, given, error) : NULL;
  if (!read->content) return FALSE;
  gsize size = 0;
  const char *bytes = g_bytes_get_data(read->content, &size);
  int hint = spore_mesh_frame_hint(bytes, size);
  if (!read->frame && hint >= 0) read->frame_chosen = hint;
  return TRUE;
}

/* Decodes the content. */
static gboolean decode(SporeCli *cli, const Read *read, SporeTriangleMesh *mesh, guint32 **parts, char ***names,
                       GError **error) {
  gsize size = 0;
  const char *bytes = g_bytes_get_data(read->content, &size);
  if (!spore_mesh_decode_tagged(read->file, read->file, bytes, size, read->unit_chosen, read->frame_chosen, mesh, parts,
                                names, spore_cli_progress(cli), error))
    return FALSE;
  say_size(cli, read->file, mesh, read->unit_chosen);
  return TRUE;
}

gboolean spore_cli_read_parts(SporeCli *cli, const char *file, const char *unit, const char *frame,
                              SporeTriangleMesh *mesh, guint32 **parts, char ***names, GError **error) {
  Read read = {.file = file, .unit = unit, .frame = frame};
  if (!read_content(&read, error)) return FALSE;
  gboolean done = decode(cli, &read, mesh, parts, names, error);
  g_bytes_unref(read.content);
  return done;
}

gboolean spore_cli_read_mesh(SporeCli *cli, const char *file, const char *unit, const char *frame,
                             SporeTriangleMesh *mesh, GBytes **content, int *unit_index, int *frame_index,
                             GError **error) {
  Read read = {.file = file, .unit = unit, .frame = frame};
  if (!read_content(&read, error)) return FALSE;
  g_autoptr(GBytes) whole = read.content;
  if (!decode(cli, &read, mesh, NULL, NULL, error)) return FALSE;
  if (content) *content = g_steal_pointer(&whole);
  if (unit_index) *unit_index = read.unit_chosen;
  if (frame_index) *frame_index = read.frame_chosen;
  return TRUE;
}
