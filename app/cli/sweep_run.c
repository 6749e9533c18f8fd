/* spore sweep run: the cases that have no result, each in a process of its own. What one of them does, a crash too,
 * touches no other. A result is written whole or not at all; a case that is killed has none, and runs again. */
#include <errno.h>
#include <fcntl.h>
#include <glib/gi18n.h>
#include <glib/gstdio.h>
#include <sched.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "app/cli/sweep.h"
#include "core/io/scene_xml.h"

#define JOBS_MAXIMUM 1024
#define OUTPUT_MAXIMUM (64 << 20) /* bytes: more is not what a command prints */
#define SAID_MAXIMUM 4096

typedef struct RunOptions {
  char *results;
  char **numbers;
  int jobs;
} RunOptions;

/* A process that works on a case. */
typedef struct Worker {
  pid_t process; /* 0: none */
  const SporeSweepCase *one;
  int output, errors; /* files in memory */
  int core;           /* that it has to itself; -1: none */
  gint64 started_us, started_s;
} Worker;

typedef struct Farm {
  SporeCli *cli;
  const SporeManifest *sweep;
  GPtrArray *waiting; /* cases */
  guint next;         /* of these */
  Worker *workers;
  guint jobs, working, total, done, busy;
  GPtrArray *failed; /* cases */
  int lock;          /* the file whose bytes are locked, one for each case that somebody works on */
  char *program, *processor;
} Farm;

/* Locks. They end with the process that holds them, however it ends. Where a file system has none, two runs at once may
 * do the same case twice, to the same result. */

static gboolean take_case(const Farm *farm, const SporeSweepCase *one) {
  struct flock byte = {.l_type = F_WRLCK, .l_whence = SEEK_SET, .l_start = one->number, .l_len = 1};
  return fcntl(farm->lock, F_OFD_SETLK, &byte) == 0 || (errno != EAGAIN && errno != EACCES);
}

static void leave_case(const Farm *farm, const SporeSweepCase *one) {
  struct flock byte = {.l_type = F_UNLCK, .l_whence = SEEK_SET, .l_start = one->number, .l_len = 1};
  fcntl(farm->lock, F_OFD_SETLK, &byte);
}

/* Processes. */

/* In the new process: everything that may be done between fork and exec. */
static _Noreturn void become(const Farm *farm, const Worker *worker, char **arguments, pid_t parent) {
  prctl(PR_SET_PDEATHSIG, SIGKILL); /* nobody would take the result */
  if (getppid() != parent) _exit(SPORE_EXIT_FAULT);
  cpu_set_t cores;
  CPU_ZERO(&cores);
  if (worker->core >= 0) {
    CPU_SET((size_t)worker->core, &cores);
    sched_setaffinity(0, sizeof cores, &cores);
  }
  if (chdir(farm->sweep->folder) == 0 && dup2(worker->output, STDOUT_FILENO) >= 0 &&
      dup2(worker->errors, STDERR_FILENO) >= 0)
    execv(farm->program, arguments);
  _exit(SPORE_EXIT_FAULT);
}

static gboolean start(Farm *farm, Worker *worker, const SporeSweepCase *one, GError **error) {
  g_autoptr(GPtrArray) arguments = g_ptr_array_new();
  g_ptr_array_add(arguments, farm->program);
  for (char **word = one->arguments; *word; word++) g_ptr_array_add(arguments, *word);
  g_ptr_array_add(arguments, NULL);
  worker->one = one;
  worker->output = memfd_create("output", MFD_CLOEXEC);
  worker->errors = memfd_create("errors", MFD_CLOEXEC);
  worker->started_us = g_get_monotonic_time();
  worker->started_s = g_get_real_time() / G_USEC_PER_SEC;
  pid_t parent = getpid();
  worker->process = worker->output >= 0 && worker->errors >= 0 ? fork() : -1;
  if (worker->process == 0) become(farm, worker, (char **)arguments->pdata, parent);
  if (worker->process > 0) return TRUE;
  worker->process = 0;
  return spore_error_raise(error, SPORE_ERROR_FILE, NULL,
                           _("case %u cannot be started (%s); ask for fewer --jobs, and run the sweep again"),
                           one->number, g_strerror(errno));
}

/* What a file in memory holds; NULL: too much. */
static char *content_of(int file, gsize most) {
  off_t size = lseek(file, 0, SEEK_END);
  if (size < 0 || (gsize)size > most) return NULL;
  char *text = g_malloc0((gsize)size + 1);
  gsize taken = 0;
  for (ssize_t got; taken < (gsize)size && (got = pread(file, text + taken, (gsize)size - taken, (off_t)taken)) > 0;)
    taken += (gsize)got;
  return text;
}

static JsonNode *output_of(const Worker *worker) {
  g_autofree char *text = content_of(worker->output, OUTPUT_MAXIMUM);
  g_autoptr(JsonParser) parser = json_parser_new();
  gboolean read = text && json_parser_load_from_data(parser, text, -1, NULL);
  JsonNode *root = read ? json_parser_get_root(parser) : NULL;
  return root && JSON_NODE_HOLDS_OBJECT(root) ? json_node_copy(root) : NULL;
}

/* The first line on stderr; NULL: there is none. */
static char *said_by(const Worker *worker) {
  char text[SAID_MAXIMUM + 1];
  ssize_t size = pread(worker->errors, text, SAID_MAXIMUM, 0);
  if (size <= 0) return NULL;
  text[size] = '\0';
  text[strcspn(text, "\n")] = '\0';
  return g_utf8_make_valid(text, -1);
}

/* Takes output. */
static char *format_result(const Farm *farm, const Worker *worker, int status, const char *said, JsonNode *output) {
  g_autoptr(JsonBuilder) builder = json_builder_new();
  g_autoptr(GDateTime) started = g_date_time_new_from_unix_utc(worker->started_s);
  g_autofree char *time = g_date_time_format_iso8601(started);
  json_builder_begin_object(builder);
  spore_sweep_add_count(builder, "case", worker->one->number);
  spore_sweep_add_text(builder, "hash", worker->one->hash);
  spore_sweep_add_count(builder, "status", status);
  spore_sweep_add_text(builder, "said", said);
  spore_sweep_add_text(builder, "host", g_get_host_name());
  spore_sweep_add_text(builder, "processor", farm->processor);
  spore_sweep_add_count(builder, "core", worker->core);
  spore_sweep_add_count(builder, "jobs", farm->jobs);
  spore_sweep_add_text(builder, "started", time);
  spore_sweep_add_text(builder, "version", SPORE_VERSION);
  json_builder_set_member_name(builder, "seconds");
  json_builder_add_double_value(builder, 1e-6 * (double)(g_get_monotonic_time() - worker->started_us));
  json_builder_set_member_name(builder, "result");
  if (output) json_builder_add_value(builder, output);
  else json_builder_add_null_value(builder);
  json_builder_end_object(builder);
  g_autoptr(JsonNode) root = json_builder_get_root(builder);
  return json_to_string(root, FALSE);
}

static void close_worker(const Farm *farm, Worker *worker) {
  leave_case(farm, worker->one);
  close(worker->output);
  close(worker->errors);
  worker->process = 0;
}

/* Keeps what came of the case. */
static gboolean keep(Farm *farm, Worker *worker, int ended, GError **error) {
  int status = WIFSIGNALED(ended) ? 128 + WTERMSIG(ended) : WEXITSTATUS(ended);
  g_autofree char *said = said_by(worker), *file = spore_sweep_result_file(farm->sweep, worker->one);
  const SporeSweepResult result = {.status = status, .output = output_of(worker)};
  gboolean failed = spore_sweep_result_failed(&result);
  g_autofree char *text = format_result(farm, worker, status, said, result.output);
  gboolean kept = spore_write_file(file, text, strlen(text), error);
  if (failed) {
    g_ptr_array_add(farm->failed, (gpointer)worker->one);
    spore_cli_say(farm->cli, _("case %u: status %d: %s\n"), worker->one->number, status, said ? said : "");
  }
  close_worker(farm, worker);
  farm->working--, farm->done++;
  return kept;
}

static void end_all(Farm *farm) {
  for (guint i = 0; i < farm->jobs; i++)
    if (farm->workers[i].process > 0) kill(farm->workers[i].process, SIGTERM);
  for (guint i = 0; i < farm->jobs; i++) {
    Worker *worker = &farm->workers[i];
    if (worker->process == 0) continue;
    while (waitpid(worker->process, NULL, 0) < 0 && errno == EINTR) continue;
    close_worker(farm, worker);
  }
}

/* The next case that has no result and that nobody else works on; NULL: there is none. */
static const SporeSweepCase *next_case(Farm *farm) {
  while (farm->next < farm->waiting->len) {
    const SporeSweepCase *one = g_ptr_array_index(farm->waiting, farm->next++);
    if (!take_case(farm, one)) {
      farm->busy++;
      continue;
    }
    g_autoptr(SporeSweepResult) result = spore_sweep_result_read(farm->sweep, one, NULL);
    if (!result || !spore_sweep_result_is_final(result)) return one;
    leave_case(farm, one);
    farm->total--; /* somebody was faster */
  }
  return NULL;
}

static gboolean fill_workers(Farm *farm, GError **error) {
  for (guint i = 0; i < farm->jobs; i++) {
    Worker *worker = &farm->workers[i];
    const SporeSweepCase *one = worker->process == 0 ? next_case(farm) : NULL;
    if (!one) continue;
    if (!start(farm, worker, one, error)) {
      leave_case(farm, one);
      return FALSE;
    }
    farm->working++;
  }
  return TRUE;
}

static Worker *worker_of(const Farm *farm, pid_t process) {
  for (guint i = 0; i < farm->jobs; i++)
    if (farm->workers[i].process == process) return &farm->workers[i];
  return NULL;
}

static gboolean work(Farm *farm, GError **error) {
  while (!spore_cli_interrupted() && fill_workers(farm, error) && farm->working > 0) {
    int ended;
    pid_t process = waitpid(-1, &ended, 0);
    Worker *worker = process > 0 ? worker_of(farm, process) : NULL;
    if (worker && !spore_cli_interrupted() && !keep(farm, worker, ended, error)) break;
    spore_progress(spore_cli_progress(farm->cli), (double)farm->done / MAX(1, farm->total), _("running cases"));
  }
  end_all(farm);
  if (error && *error) return FALSE;
  if (!spore_cli_interrupted()) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_CANCELLED, NULL,
                           _("interrupted; the results so far are kept, and the next run goes on from there"));
}

/* Which cases to run. */

static gboolean find_number(const SporeManifest *sweep, const char *text, guint64 *number, GError **error) {
  if (g_ascii_string_to_unsigned(text, 10, 0, sweep->cases->len - 1, number, NULL)) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, "--case", _("%s; expected a number from 0 to %u; correct it"),
                           text, sweep->cases->len - 1);
}

/* The scenes of the cases must be what they were when the sweep was planned. */
static gboolean check_scene(SporeCli *cli, const SporeManifest *sweep, const SporeSweepCase *one, GHashTable *hashes,
                            GError **error) {
  const char *known = g_hash_table_lookup(hashes, one->scene);
  if (!known) {
    g_autofree char *file =
        g_path_is_absolute(one->scene) ? g_strdup(one->scene) : g_build_filename(sweep->folder, one->scene, NULL);
    char *hash = spore_sweep_scene_hash(cli, file, error);
    if (!hash) return FALSE;
    g_hash_table_insert(hashes, g_strdup(one->scene), hash);
    known = hash;
  }
  if (g_str_equal(known, one->scene_hash)) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_INPUT, one->scene,
                           _("the scene or a file of it has changed since the sweep was planned; expected it as it "
                             "was; plan the sweep again: results that still hold are kept"));
}

/* Adds the case unless it has a result. */
static gboolean add_case(Farm *farm, const SporeSweepCase *one, GHashTable *hashes, GError **error) {
  GError *damage = NULL;
  g_autoptr(SporeSweepResult) result = spore_sweep_result_read(farm->sweep, one, &damage);
  if (damage) {
    g_propagate_error(error, damage);
    return FALSE;
  }
  if (result && spore_sweep_result_is_final(result)) {
    if (spore_sweep_result_failed(result)) g_ptr_array_add(farm->failed, (gpointer)one);
    return TRUE;
  }
  if (!check_scene(farm->cli, farm->sweep, one, hashes, error)) return FALSE;
  g_ptr_array_add(farm->waiting, (gpointer)one);
  return TRUE;
}

static gboolean find_cases(Farm *farm, const RunOptions *options, GError **error) {
  g_autoptr(GHashTable) hashes = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
  guint64 number;
  for (char **text = options->numbers; text && *text; text++)
    if (!find_number(farm->sweep, *text, &number, error) ||
        !add_case(farm, g_ptr_array_index(farm->sweep->cases, number), hashes, error))
      return FALSE;
  for (guint i = 0; !options->numbers && i < farm->sweep->cases->len; i++)
    if (!add_case(farm, g_ptr_array_index(farm->sweep->cases, i), hashes, error)) return FALSE;
  farm->total = farm->waiting->len;
  return TRUE;
}

/* The farm. */

static char *processor_name(void) {
  g_autofree char *text = NULL;
  if (!g_file_get_contents("/proc/cpuinfo", &text, NULL, NULL)) return NULL;
  const char *line = strstr(text, "model name");
  const char *name = line ? strchr(line, ':') : NULL;
  return name ? g_strstrip(g_strndup(name + 1, strcspn(name + 1, "\n"))) : NULL;
}

/* A core for each worker, where there are as many. */
static void spread(Farm *farm, const cpu_set_t *cores) {
  int core = 0;
  for (guint i = 0; i < farm->jobs; i++) {
    farm->workers[i].core = -1;
    if ((int)farm->jobs > CPU_COUNT(cores)) continue;
    while (!CPU_ISSET((size_t)core, cores)) core++;
    farm->workers[i].core = core++;
  }
}

static gboolean open_farm(Farm *farm, const RunOptions *options, GError **error) {
  cpu_set_t cores;
  CPU_ZERO(&cores);
  sched_getaffinity(0, sizeof cores, &cores);
  farm->jobs = options->jobs > 0 ? (guint)options->jobs : (guint)MAX(1, CPU_COUNT(&cores));
  farm->workers = g_new0(Worker, farm->jobs);
  spread(farm, &cores);
  g_autofree char *lock = g_build_filename(farm->sweep->results, "cases.lock", NULL);
  if (g_mkdir_with_parents(farm->sweep->results, 0777) == 0)
    farm->lock = g_open(lock, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  farm->program = g_file_read_link("/proc/self/exe", NULL);
  farm->processor = processor_name();
  if (farm->lock >= 0 && farm->program) return TRUE;
  return spore_error_raise(error, SPORE_ERROR_FILE, farm->sweep->results,
                           _("results cannot be written there (%s); name another folder with --results"),
                           g_strerror(errno));
}

static void close_farm(Farm *farm) {
  if (farm->lock >= 0) close(farm->lock);
  g_free(farm->workers);
  g_free(farm->program);
  g_free(farm->processor);
  g_ptr_array_unref(farm->waiting);
  g_ptr_array_unref(farm->failed);
}

static int say_end(const Farm *farm, guint kept) {
  SporeCli *cli = farm->cli;
  spore_cli_count(cli, "cases", farm->sweep->cases->len);
  spore_cli_count(cli, "run", farm->done);
  spore_cli_count(cli, "kept", kept);
  spore_cli_count(cli, "busy", farm->busy);
  spore_cli_open_array(cli, "failed");
  for (guint i = 0; i < farm->failed->len; i++)
    spore_cli_count(cli, NULL, ((const SporeSweepCase *)g_ptr_array_index(farm->failed, i))->number);
  spore_cli_close_array(cli);
  spore_cli_say(cli, _("%u run, %u had results, %u failed, %u in the hands of another run\n"), farm->done, kept,
                farm->failed->len, farm->busy);
  return spore_cli_finish(cli, farm->failed->len > 0 ? SPORE_EXIT_NOT_HELD : SPORE_EXIT_DONE);
}

static int run(SporeCli *cli, const char *file, const RunOptions *options) {
  GError *error = NULL;
  if (options->jobs < 0 || options->jobs > JOBS_MAXIMUM)
    return spore_cli_usage(_("--jobs: %d; expected 0 (one for each core) to %d; correct it"), options->jobs,
                           JOBS_MAXIMUM);
  g_autoptr(SporeManifest) sweep = spore_sweep_read(file, options->results, &error);
  if (!sweep) return spore_cli_fail(error);
  Farm farm = {.cli = cli, .sweep = sweep, .waiting = g_ptr_array_new(), .failed = g_ptr_array_new(), .lock = -1};
  gboolean found = open_farm(&farm, options, &error) && find_cases(&farm, options, &error);
  guint asked = options->numbers ? g_strv_length(options->numbers) : sweep->cases->len;
  gboolean worked = found && work(&farm, &error);
  int status = worked ? say_end(&farm, asked - farm.total) : spore_cli_fail(error);
  close_farm(&farm);
  return status;
}

int spore_sweep_run(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"cases", N_("number of cases in the manifest")},
      {"run", N_("how many ran now")},
      {"kept", N_("how many of those that were asked for had results")},
      {"busy", N_("how many another run of the sweep was working on")},
      {"failed", N_("numbers of the cases that gave nothing to go by; `spore sweep collect` says why")},
      {NULL}};
  RunOptions options = {0};
  const GOptionEntry entries[] = {{"case", 0, 0, G_OPTION_ARG_STRING_ARRAY, &options.numbers,
                                   N_("Run this case alone; may be given several times"), "N"},
                                  {"jobs", 'j', 0, G_OPTION_ARG_INT, &options.jobs,
                                   N_("Cases at a time (default: one for each core, which it then has to itself)"),
                                   "N"},
                                  {"results", 0, 0, G_OPTION_ARG_FILENAME, &options.results,
                                   N_("Folder of results (default: F.sweep.results)"), "FOLDER"},
                                  G_OPTION_ENTRY_NULL};
  static const SporeCommandInfo info = {
      .name = "sweep run",
      .arguments = "F.sweep",
      .summary = N_("Runs the cases that have no result yet. May be killed at any time, and be run again, and run "
                    "several times at once. The exit status is 1 where a case failed."),
      .minimum = 1,
      .maximum = 1,
      .report = members};
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  if (status == SPORE_EXIT_DONE) status = run(cli, argv[1], &options);
  g_strfreev(options.numbers);
  g_free(options.results);
  return status;
}
