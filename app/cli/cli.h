/* What the commands of `spore` share: options, output, interruption. */
#ifndef SPORE_APP_CLI_H
#define SPORE_APP_CLI_H

#include <json-glib/json-glib.h>

#include "core/base/cancel.h"
#include "core/base/progress.h"
#include "core/scene/document.h"

/* Exit statuses. After an interrupt the status is the one that a shell expects. */
enum {
  SPORE_EXIT_DONE = 0,
  SPORE_EXIT_NOT_HELD = 1,
  SPORE_EXIT_INPUT = 2,
  SPORE_EXIT_FAULT = 3,
  SPORE_EXIT_INTERRUPTED = 130
};

typedef struct SporeCli {
  SporeSchema *schema;
  gboolean json, quiet; /* --json, --quiet */
  JsonBuilder *report;  /* an open object; printed by spore_cli_finish when json */
} SporeCli;

/* A member of the object that --json prints, with the members below it. */
typedef struct SporeReportMember {
  const char *name; /* members of members joined by dots */
  const char *doc;  /* translatable; names the members below */
} SporeReportMember;

typedef struct SporeCommandInfo {
  const char *name;
  const char *arguments;           /* "SCENE" */
  const char *summary;             /* translatable */
  int minimum, maximum;            /* number of plain arguments */
  const SporeReportMember *report; /* ends with one without a name; printed by --help */
  char *(*describe)(void);         /* what else --help says, translated, g_free; NULL: nothing */
} SporeCommandInfo;

/* Reads options (entries end with G_OPTION_ENTRY_NULL; --json, --quiet and --help are added) and leaves the plain
 * arguments in *argv[1..*argc-1]. Returns SPORE_EXIT_DONE to go on. Prints its own message when it fails. */
int spore_cli_parse(SporeCli *cli, const SporeCommandInfo *info, const GOptionEntry *entries, int *argc, char ***argv);
/* The same; `data` is handed to callbacks among the entries. */
int spore_cli_parse_with(SporeCli *cli, const SporeCommandInfo *info, const GOptionEntry *entries, gpointer data,
                         int *argc, char ***argv);

/* Prints a message for people on stdout, unless --json or --quiet. */
void spore_cli_say(const SporeCli *cli, const char *format, ...) G_GNUC_PRINTF(2, 3);
/* Prints the error on stderr, frees it, and returns the exit status for that kind of error. */
int spore_cli_fail(GError *error);
/* A usage error: status 2. */
int spore_cli_usage(const char *format, ...) G_GNUC_PRINTF(1, 2);
/* Closes the report's object, prints the report with --json, and returns status. */
int spore_cli_finish(SporeCli *cli, int status);

/* Members of the report. Numbers that JSON cannot hold become null. */
void spore_cli_number(SporeCli *cli, const char *member, double value);
void spore_cli_count(SporeCli *cli, const char *member, gint64 value);
void spore_cli_flag(SporeCli *cli, const char *member, gboolean value);
void spore_cli_text(SporeCli *cli, const char *member, const char *value);
void spore_cli_open(SporeCli *cli, const char *member); /* object; NULL inside an array */
void spore_cli_open_array(SporeCli *cli, const char *member);
void spore_cli_close(SporeCli *cli);
void spore_cli_close_array(SporeCli *cli);

/* True after Ctrl-C or SIGTERM. */
gboolean spore_cli_interrupted(void);
/* The same question for the kernel. */
const SporeCancel *spore_cli_cancel(void);
/* Progress on stderr when that is a terminal; cancels on interruption. */
const SporeProgress *spore_cli_progress(const SporeCli *cli);

/* Content of a regular file. expected: what it should be, translated ("a mesh"), for messages. */
GBytes *spore_cli_read_file(const char *file, const char *expected, GError **error);
/* Reads a mesh file. --unit and --frame are names; frame NULL: the axes that the file states, else Y_UP. */
gboolean spore_cli_read_mesh(SporeCli *cli, const char *file, const char *unit, const char *frame,
                             SporeTriangleMesh *mesh, GBytes **content, int *unit_index, int *frame_index,
                             GError **error);
/* The same with the parts of the file, as spore_mesh_decode_tagged gives them. */
gboolean spore_cli_read_parts(SporeCli *cli, const char *file, const char *unit, const char *frame,
                              SporeTriangleMesh *mesh, guint32 **parts, char ***names, GError **error);
/* TRUE unless output and input are the same file, even under different names: writing would destroy the input. */
gboolean spore_cli_keeps(const char *output, const char *input, GError **error);
/* As before, and the output can be written: its folder exists and takes files. Checked before work that takes long. */
gboolean spore_cli_has_room(const char *output, const char *input, GError **error);
/* The same for a scene, whose folder is made where it is missing. */
gboolean spore_cli_has_room_for_scene(const char *output, const char *input, GError **error);
/* Saves a scene. Makes its folder where it is missing, and takes the folder back where the scene cannot be saved. */
gboolean spore_cli_save_scene(SporeDocument *document, const char *file, GError **error);
/* A duration of 0 s or more that was given as text. */
gboolean spore_cli_seconds(const char *option, const char *text, double *seconds, GError **error);
/* Index of text in a NULL-terminated list; -1 with a GError that lists it. */
int spore_cli_choice(const char *option, const char *text, const char *const *choices, GError **error);

int spore_command_accuracy(SporeCli *cli, int argc, char **argv);
int spore_command_advise(SporeCli *cli, int argc, char **argv);
int spore_command_centreline(SporeCli *cli, int argc, char **argv);
int spore_command_check(SporeCli *cli, int argc, char **argv);
int spore_command_edit(SporeCli *cli, int argc, char **argv);
int spore_command_export(SporeCli *cli, int argc, char **argv);
int spore_command_import(SporeCli *cli, int argc, char **argv);
int spore_command_models(SporeCli *cli, int argc, char **argv);
int spore_command_plan(SporeCli *cli, int argc, char **argv);
int spore_command_render(SporeCli *cli, int argc, char **argv);
int spore_command_run(SporeCli *cli, int argc, char **argv);
int spore_command_schema(SporeCli *cli, int argc, char **argv);
int spore_command_spheres(SporeCli *cli, int argc, char **argv);
int spore_command_stability(SporeCli *cli, int argc, char **argv);
int spore_command_spline(SporeCli *cli, int argc, char **argv);
int spore_command_surface(SporeCli *cli, int argc, char **argv);
int spore_command_sweep(SporeCli *cli, int argc, char **argv);
int spore_command_tetrahedra(SporeCli *cli, int argc, char **argv);

#endif
