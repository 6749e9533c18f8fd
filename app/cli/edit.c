/* spore edit: changes a scene from the command line. */
#include <glib/gi18n.h>
#include <string.h>

#include "app/cli/edit_paint.h"
#include "app/cli/edit_place.h"
#include "app/cli/scene.h"
#include "core/author/addition.h"
#include "core/author/edits.h"
#include "core/author/fix.h"
#include "core/author/fluid_edits.h"
#include "core/author/instrument_edits.h"
#include "core/author/level_edits.h"
#include "core/author/locate.h"
#include "core/author/mirror_edits.h"
#include "core/author/patient_positions.h"
#include "core/author/port_edits.h"
#include "core/author/pose_edits.h"
#include "core/author/removal.h"
#include "core/author/soft_edits.h"
#include "core/author/texture_edits.h"
#include "core/io/scene_xml.h"
#include "core/scene/check.h"
#include "core/scene/watch_place.h"

/* The options of the command line. */
typedef struct Request {
  char **delete, **delete_alone, **locate, **add, **soft, **level, **set, **paint, **hold, **fluid, **mirror, **copy,
      **instrument, **port, **texture, *patient, *output;
  SporeCliPlacing placing;
  char *keep_pose; /* seconds; NULL: none is kept */
  gboolean probe, fix, forget_pose;
} Request;

/* What was done, for the report. */
typedef struct Done {
  GPtrArray *changed;  /* of char *: paths */
  GPtrArray *located;  /* of SporeLocateWork * */
  SporeSoftWork *soft; /* NULL: nothing was made soft */
} Done;

static SporeObject *hold(SporeDocument *document, const char *name, GError **error) {
  SporeObject *body = spore_cli_find_body(document, "--hold", name, error);
  return body ? spore_edit_add_pin(document, body, error) : NULL;
}

/* Notes the path of what was changed, for the report. */
static void note(GPtrArray *changed, const SporeObject *object) { g_ptr_array_add(changed, spore_object_path(object)); }

/* The bodies that are named; NULL with an error: there is no such body. g_ptr_array_unref. */
static GPtrArray *find_bodies(SporeDocument *document, char **names, GError **error) {
  g_autoptr(GPtrArray) bodies = g_ptr_array_new();
  for (; *names; names++) {
    SporeObject *body = spore_cli_find_body(document, "--soft", *names, error);
    if (!body) return NULL;
    g_ptr_array_add(bodies, body);
  }
  return g_steal_pointer(&bodies);
}

/* Unlike in the editor, an organ that cannot be made soft is an error: it was asked for by name. */
static gboolean refuse_left_out(const SporeSoftWork *work, GError **error) {
  for (guint i = 0; i < work->organs->len; i++) {
    const SporeSoftOrgan *organ = work->organs->pdata[i];
    if (!organ->refused) continue;
    g_propagate_error(error, g_error_copy(organ->refused));
    return FALSE;
  }
  return TRUE;
}

static void report_soft(SporeCli *cli, const SporeSoftWork *work) {
  spore_cli_open_array(cli, "soft");
  for (guint i = 0; i < work->organs->len; i++) {
    const SporeSoftOrgan *organ = work->organs->pdata[i];
    g_autofree char *text = spore_soft_organ_text(organ);
    spore_cli_say(cli, "%s\n", text);
    spore_cli_open(cli, NULL);
    spore_cli_text(cli, "body", organ->name);
    spore_cli_count(cli, "tetrahedra", (gint64)organ->tetrahedra->tetrahedra.tetrahedron_count);
    spore_cli_count(cli, "spheres", organ->spheres ? (gint64)organ->spheres->spheres.count : 0);
    spore_cli_number(cli, "distance", organ->tetrahedra->tetrahedra_report.hausdorff);
    spore_cli_close(cli);
  }
  spore_cli_close_array(cli);
}

static gboolean make_soft(SporeCli *cli, SporeDocument *document, char **names, Done *done, GError **error) {
  g_autoptr(GPtrArray) bodies = find_bodies(document, names, error);
  done->soft = bodies ? spore_soft_work_new(document, bodies, error) : NULL;
  for (guint i = 0; done->soft && i < bodies->len; i++) note(done->changed, bodies->pdata[i]);
  return done->soft && spore_soft_work_run(done->soft, spore_cli_progress(cli), error) &&
         refuse_left_out(done->soft, error) && spore_soft_work_apply(done->soft, document, error);
}

/* PATH of what has a name */
static gboolean delete_object(SporeDocument *document, const char *path, gboolean alone, GPtrArray *changed,
                              GError **error) {
  SporeObject *object = spore_document_by_path(document, path);
  if (!object || !spore_object_name(object))
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, "%s",
                             _("there is nothing of that name to delete; expected a path such as bodies/liver or "
                               "links/cord"));
  guint32 id = spore_object_id(object);
  g_autoptr(GArray) ids = g_array_new(FALSE, FALSE, sizeof id);
  g_array_append_val(ids, id);
  note(changed, object);
  g_autoptr(GPtrArray) along = spore_along_new();
  gboolean done = spore_edit_delete(document, ids, alone, along, error);
  for (guint i = 0; i < along->len; i++)
    g_ptr_array_add(changed, g_strdup(((const SporeAlong *)along->pdata[i])->path));
  return done;
}

/* The end of the name of a missing file, which may itself have a =; NULL: none of them begins the text. */
static const char *end_of_missing(SporeDocument *document, const char *text) {
  g_autoptr(GPtrArray) missing = spore_missing_files(document);
  for (guint i = 0; i < missing->len; i++) {
    size_t length = strlen(missing->pdata[i]);
    if (g_str_has_prefix(text, missing->pdata[i]) && text[length] == '=') return text + length;
  }
  return NULL;
}

/* MISSING=FILE */
static gboolean locate(SporeCli *cli, SporeDocument *document, const char *text, Done *done, GError **error) {
  const char *equals = end_of_missing(document, text);
  if (!equals) equals = strchr(text, '=');
  if (!equals || !equals[1])
    return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                             _("this is no missing file and its place; expected MISSING=FILE, such as "
                               "liver.off=/data/liver.off"));
  g_autofree char *missing = g_strndup(text, (gsize)(equals - text));
  SporeLocateWork *work = spore_locate_work_new(document, missing, equals + 1);
  g_ptr_array_add(done->located, work);
  return spore_locate_work_run(work, spore_cli_progress(cli), error) && spore_locate_work_apply(work, document, error);
}

static void report_located(SporeCli *cli, const GPtrArray *works) {
  spore_cli_open_array(cli, "located");
  for (guint i = 0; i < works->len; i++) {
    const GPtrArray *found = spore_locate_work_found(works->pdata[i]);
    for (guint k = 0; k < found->len; k++) {
      const SporeLocatedFile *file = found->pdata[k];
      if (file->refused) spore_cli_say(cli, _("not located: %s: %s\n"), file->missing, file->refused);
      else spore_cli_say(cli, _("located: %s: %s\n"), file->missing, file->place);
      spore_cli_open(cli, NULL);
      spore_cli_text(cli, "missing", file->missing);
      spore_cli_text(cli, "place", file->place);
      spore_cli_text(cli, "refused", file->refused);
      spore_cli_close(cli);
    }
  }
  spore_cli_close_array(cli);
}

/* BODY=LEVEL */
static gboolean add_level(SporeCli *cli, SporeDocument *document, const char *text, GPtrArray *changed,
                          GError **error) {
  const char *equals = strrchr(text, '=');
  g_autofree char *name = equals ? g_strndup(text, (gsize)(equals - text)) : NULL;
  if (!equals || (!g_str_equal(equals + 1, "coarse") && !g_str_equal(equals + 1, "medium")))
    return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                             _("this is no body and a level; expected BODY=coarse or BODY=medium, such as "
                               "liver=coarse"));
  SporeObject *body = spore_cli_find_body(document, "--level", name, error);
  SporeLevelWork *work = body ? spore_level_work_new(document, body, equals + 1, error) : NULL;
  SporeObject *level = work && spore_level_work_run(work, spore_cli_progress(cli), error)
                           ? spore_level_work_apply(work, document, error)
                           : NULL;
  if (level) note(changed, level);
  g_clear_pointer(&work, spore_level_work_free);
  return level != NULL;
}

static gboolean set(SporeDocument *document, const char *setting, GPtrArray *changed, GError **error) {
  if (!spore_cli_set(document, setting, error)) return FALSE;
  g_ptr_array_add(changed, g_strndup(setting, strcspn(setting, "=")));
  return TRUE;
}

/* The instrument of that name; NULL with an error that lists the library. */
static const SporeInstrumentKind *find_instrument(const char *text, const char *name, GError **error) {
  const SporeInstrumentKind *found = spore_instrument_find(name);
  g_autoptr(GString) names = g_string_new(NULL);
  if (found) return found;
  for (const SporeInstrumentKind *one = spore_instruments; one->name; one++)
    g_string_append_printf(names, names->len ? ", %s" : "%s", one->name);
  spore_error_raise(error, SPORE_ERROR_INPUT, text, _("there is no instrument \"%s\"; expected one of: %s"), name,
                    names->str);
  return NULL;
}

/* KIND[:NAME][@ENTRY[@TARGET]] */
static SporeObject *add_instrument(SporeDocument *document, const char *text, GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, "@", -1);
  guint count = g_strv_length(parts);
  SporeVec3 entry, target;
  char *name = count ? strchr(parts[0], ':') : NULL;
  if (name) *name++ = '\0';
  const SporeInstrumentKind *instrument = count ? find_instrument(text, parts[0], error) : NULL;
  if (count && !instrument) return NULL;
  if (!count || count > 3 || (count > 1 && !spore_place_parse(parts[1], &entry)) ||
      (count > 2 && !spore_place_parse(parts[2], &target))) {
    spore_error_raise(error, SPORE_ERROR_INPUT, text,
                      _("this is no instrument and its places; expected KIND@X,Y,Z@X,Y,Z in metres, where it enters "
                        "and what it points at, such as grasper@0.1,0.2,0.1@0,0.02,0"));
    return NULL;
  }
  const SporeInstrumentPlaces places = {count > 1 ? &entry : NULL, count > 2 ? &target : NULL};
  return spore_edit_add_instrument(document, instrument, name && *name ? name : NULL, places, error);
}

/* The fluid of that name; NULL with an error that lists the library. */
static const SporeFluidKind *find_fluid(const char *text, const char *name, GError **error) {
  const SporeFluidKind *found = spore_fluid_find(name);
  g_autoptr(GString) names = g_string_new(NULL);
  if (found) return found;
  for (const SporeFluidKind *one = spore_fluids; one->name; one++)
    g_string_append_printf(names, names->len ? ", %s" : "%s", one->name);
  spore_error_raise(error, SPORE_ERROR_INPUT, text, _("there is no fluid \"%s\"; expected one of: %s"), name,
                    names->str);
  return NULL;
}

/* KIND[:NAME]@PLACE */
static SporeObject *add_fluid(SporeDocument *document, const char *text, GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, "@", 2);
  SporeVec3 place;
  char *name = parts[0] ? strchr(parts[0], ':') : NULL;
  if (name) *name++ = '\0';
  const SporeFluidKind *kind = parts[0] ? find_fluid(text, parts[0], error) : NULL;
  if (parts[0] && !kind) return NULL;
  if (!kind || !parts[1] || !spore_place_parse(parts[1], &place)) {
    spore_error_raise(error, SPORE_ERROR_INPUT, text,
                      _("this is no fluid and its place; expected KIND@X,Y,Z in metres, on an organ, such as "
                        "bleeding@0,0.02,0"));
    return NULL;
  }
  return spore_edit_add_fluid(document, kind, name && *name ? name : NULL, NULL, place, error);
}

static gboolean add_fluids(SporeDocument *document, char **texts, GPtrArray *changed, GError **error) {
  for (; texts && *texts; texts++) {
    SporeObject *added = add_fluid(document, *texts, error);
    if (!added) return FALSE;
    note(changed, added);
  }
  return TRUE;
}

/* BODY=AXIS, in the middle of the scene */
static SporeObject *mirror(SporeDocument *document, const char *text, GError **error) {
  const char *equals = strrchr(text, '=');
  g_autofree char *name = equals ? g_strndup(text, (gsize)(equals - text)) : NULL;
  if (!equals || equals[1] < 'x' || equals[1] > 'z' || equals[2]) {
    spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                      _("this is no body and an axis; expected BODY=x, BODY=y or BODY=z, such as ovary_left=x"));
    return NULL;
  }
  SporeObject *body = spore_cli_find_body(document, "--mirror", name, error);
  int axis = equals[1] - 'x';
  return body ? spore_edit_mirror(document, body, axis, spore_scene_middle(document, axis), error) : NULL;
}

static gboolean mirror_all(SporeDocument *document, char **texts, GPtrArray *changed, GError **error) {
  for (; texts && *texts; texts++) {
    SporeObject *copy = mirror(document, *texts, error);
    if (!copy) return FALSE;
    note(changed, copy);
  }
  return TRUE;
}

/* BODY or BODY=X,Y,Z */
static gboolean copy(SporeDocument *document, const char *text, GPtrArray *changed, GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, "=", 2);
  SporeVec3 offset;
  g_autoptr(GPtrArray) bodies = g_ptr_array_new();
  SporeObject *body = spore_cli_find_body(document, "--copy", parts[0] ? parts[0] : "", error);
  if (!body) return FALSE;
  g_ptr_array_add(bodies, body);
  if (!parts[1]) offset = spore_copy_offset(document, bodies);
  else if (!spore_place_parse(parts[1], &offset))
    return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                             _("this is no body and a way; expected BODY=X,Y,Z in metres, such as liver=0.01,0,0"));
  g_autoptr(GPtrArray) copies = spore_edit_copy(document, bodies, offset, error);
  if (copies) note(changed, copies->pdata[0]);
  return copies != NULL;
}

/* BODY=FILE */
static gboolean lay_picture(SporeCli *cli, SporeDocument *document, const char *text, GPtrArray *changed,
                            GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, "=", 2);
  if (!parts[0] || !parts[1])
    return spore_error_raise(error, SPORE_ERROR_INPUT, text, "%s",
                             _("this is no body and a picture; expected BODY=FILE, such as liver=liver.png"));
  SporeObject *body = spore_cli_find_body(document, "--texture", parts[0], error);
  SporeTextureWork *work = body ? spore_texture_work_new(document, body, parts[1], error) : NULL;
  gboolean done = work && spore_texture_work_run(work, spore_cli_progress(cli), error) &&
                  spore_texture_work_apply(work, document, error);
  if (done) note(changed, spore_object_child_of(body, "visual"));
  g_clear_pointer(&work, spore_texture_work_free);
  return done;
}

/* PORT@PLACE */
static SporeObject *move_port(SporeDocument *document, const char *text, GError **error) {
  g_auto(GStrv) parts = g_strsplit(text, "@", 2);
  SporeVec3 place;
  if (g_strv_length(parts) < 2 || !spore_place_parse(parts[1], &place)) {
    spore_error_raise(error, SPORE_ERROR_INPUT, text,
                      _("this is no port and its place; expected PORT@X,Y,Z in metres, such as "
                        "grasper_1_port@0.1,0.2,0.1"));
    return NULL;
  }
  SporeObject *port = spore_document_find(document, "port", parts[0]);
  if (!port)
    spore_error_raise(error, SPORE_ERROR_INPUT, text,
                      _("there is no port \"%s\"; expected the name of a port of the scene; add an instrument with an "
                        "entry, or correct the name"),
                      parts[0]);
  return port && spore_edit_move_port(document, port, place, error) ? port : NULL;
}

static gboolean fix(SporeCli *cli, SporeDocument *document, const SporeDiagnostic *diagnostic, GPtrArray *changed,
                    GError **error) {
  SporeFixWork *work = spore_fix_work_new(document, diagnostic, error);
  gboolean done =
      work && spore_fix_work_run(work, spore_cli_progress(cli), error) && spore_fix_work_apply(work, document, error);
  if (done) g_ptr_array_add(changed, g_strdup(spore_fix_work_path(work)));
  g_clear_pointer(&work, spore_fix_work_free);
  return done;
}

/* Does all fixes that the check offers and that ask nothing. */
static gboolean fix_all(SporeCli *cli, SporeDocument *document, GPtrArray *changed, GError **error) {
  g_autoptr(GPtrArray) diagnostics = spore_document_check(document, spore_cli_cancel());
  for (guint i = 0; i < diagnostics->len; i++) {
    const SporeDiagnostic *diagnostic = diagnostics->pdata[i];
    if (spore_fix_asks_nothing(diagnostic) && !fix(cli, document, diagnostic, changed, error)) return FALSE;
  }
  return TRUE;
}

/* Runs the scene for that time, and lets it begin so. */
static gboolean keep_pose(SporeCli *cli, SporeDocument *document, const char *text, GPtrArray *changed,
                          GError **error) {
  double time_s;
  g_autoptr(GPtrArray) left_out = g_ptr_array_new_with_free_func(g_free);
  if (!spore_cli_seconds("--keep-pose", text, &time_s, error) ||
      !spore_edit_keep_pose_after(document, time_s, spore_cli_cancel(), spore_cli_progress(cli), left_out, error))
    return FALSE;
  spore_cli_open_array(cli, "not_kept");
  for (guint i = 0; i < left_out->len; i++) {
    spore_cli_text(cli, NULL, left_out->pdata[i]);
    spore_cli_say(cli, _("not kept: %s\n"), (const char *)left_out->pdata[i]);
  }
  spore_cli_close_array(cli);
  note(changed, spore_document_section(document, "bodies"));
  return TRUE;
}

static gboolean apply(SporeCli *cli, SporeDocument *document, const Request *request, Done *done, GError **error) {
  GPtrArray *changed = done->changed;
  for (char **path = request->delete; path && *path; path++)
    if (!delete_object(document, *path, FALSE, changed, error)) return FALSE;
  for (char **path = request->delete_alone; path && *path; path++)
    if (!delete_object(document, *path, TRUE, changed, error)) return FALSE;
  for (char **text = request->locate; text && *text; text++)
    if (!locate(cli, document, *text, done, error)) return FALSE;
  for (char **path = request->add; path && *path; path++) {
    SporeObject *added = spore_edit_add(document, *path, error);
    if (!added) return FALSE;
    note(changed, added);
  }
  if (request->soft && !make_soft(cli, document, request->soft, done, error)) return FALSE;
  for (char **text = request->level; text && *text; text++)
    if (!add_level(cli, document, *text, changed, error)) return FALSE;
  for (char **text = request->paint; text && *text; text++)
    if (!spore_cli_paint(document, *text, changed, error)) return FALSE;
  for (char **setting = request->set; setting && *setting; setting++)
    if (!set(document, *setting, changed, error)) return FALSE;
  if (request->patient && !spore_edit_lay_patient(document, request->patient, error)) return FALSE;
  if (request->patient) note(changed, spore_document_section(document, "environment"));
  for (char **name = request->hold; name && *name; name++) {
    SporeObject *pin = hold(document, *name, error);
    if (!pin) return FALSE;
    note(changed, pin);
  }
  for (char **text = request->instrument; text && *text; text++) {
    SporeObject *added = add_instrument(document, *text, error);
    if (!added) return FALSE;
    note(changed, added);
  }
  for (char **text = request->texture; text && *text; text++)
    if (!lay_picture(cli, document, *text, changed, error)) return FALSE;
  if (!mirror_all(document, request->mirror, changed, error)) return FALSE;
  for (char **text = request->copy; text && *text; text++)
    if (!copy(document, *text, changed, error)) return FALSE;
  if (!add_fluids(document, request->fluid, changed, error)) return FALSE;
  for (char **text = request->port; text && *text; text++) {
    SporeObject *moved = move_port(document, *text, error);
    if (!moved) return FALSE;
    note(changed, moved);
  }
  if (!spore_cli_place(document, &request->placing, changed, error)) return FALSE;
  SporeObject *probe = request->probe ? add_instrument(document, "probe:probe", error) : NULL;
  if (probe) note(changed, probe);
  if (request->probe && !probe) return FALSE;
  if (request->fix && !fix_all(cli, document, changed, error)) return FALSE;
  if (request->forget_pose && !spore_edit_forget_pose(document, error)) return FALSE;
  return !request->keep_pose || keep_pose(cli, document, request->keep_pose, changed, error);
}

static void report_changed(SporeCli *cli, const GPtrArray *changed) {
  spore_cli_open_array(cli, "changed");
  for (guint i = 0; i < changed->len; i++) {
    json_builder_add_string_value(cli->report, changed->pdata[i]);
    spore_cli_say(cli, _("changed: %s\n"), (const char *)changed->pdata[i]);
  }
  spore_cli_close_array(cli);
}

static gboolean edit(SporeCli *cli, const char *file, const Request *request, GError **error) {
  const char *output = request->output ? request->output : file;
  if (!spore_file_may_be_written(output, TRUE, error)) return FALSE;
  SporeDocument *document = spore_scene_load(cli->schema, file, error);
  g_autoptr(GPtrArray) changed = g_ptr_array_new_with_free_func(g_free);
  g_autoptr(GPtrArray) located = g_ptr_array_new_with_free_func(spore_locate_work_free);
  Done done = {.changed = changed, .located = located};
  gboolean saved =
      document && apply(cli, document, request, &done, error) && spore_cli_save_scene(document, output, error);
  if (saved) {
    spore_cli_text(cli, "scene", output);
    spore_cli_say(cli, _("%s: written\n"), output);
    if (located->len) report_located(cli, located);
    if (done.soft) report_soft(cli, done.soft);
    report_changed(cli, changed);
    spore_cli_open_array(cli, "diagnostics");
    spore_cli_diagnostics(cli, document);
    spore_cli_close_array(cli);
  }
  g_clear_pointer(&done.soft, spore_soft_work_free);
  if (document) spore_document_free(document);
  return saved;
}

int spore_command_edit(SporeCli *cli, int argc, char **argv) {
  static const SporeReportMember members[] = {
      {"scene", N_("file that was written")},
      {"located",
       N_("missing files that were found: missing (as the scene named it), place, refused (null, or why it is "
          "not taken)")},
      {"soft", N_("what was made soft: body, tetrahedra, spheres (0: it had its own), distance as a share of the "
                  "diagonal")},
      {"not_kept", N_("with --keep-pose: sentences on bodies that do not begin so, and on what is let go")},
      {"changed", N_("paths of what was added, set and deleted")},
      {"diagnostics", N_("what there is to mend in it: place, message, remedy")},
      {NULL, NULL}};
  static const SporeCommandInfo info = {
      "edit", "SCENE", N_("Changes a scene and saves it; then says what there is to mend in it."), 1, 1, members};
  Request request = {0};
  const GOptionEntry entries[] = {
      {"delete", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.delete,
       N_("Delete an object, before anything is added: a link, a body with the links that tie it, an instrument with "
          "all that belongs to it; and assets, steps and metrics that nothing else uses, which \"changed\" lists (may "
          "be "
          "repeated)"),
       "PATH"},
      {"delete-alone", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.delete_alone,
       N_("Likewise, but keep an organ's assets, and steps and metrics that name it (may be repeated)"), "PATH"},
      {"locate", 0, 0, G_OPTION_ARG_FILENAME_ARRAY, &request.locate,
       N_("Take a file that the scene misses from where it lies now, before anything is added, and other missing ones "
          "that lie beside it: liver.off=/data/liver.off (may be repeated)"),
       "MISSING=FILE"},
      {"add", 'a', 0, G_OPTION_ARG_STRING_ARRAY, &request.add,
       N_("Add an object, before anything is set: links/spring:cord, bodies/liver/mechanical/spline_1d (may be "
          "repeated)"),
       "PATH"},
      {"soft", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.soft,
       N_("Make an organ soft, before anything is set: tetrahedra, spheres, the tissue that its name says, and a pin "
          "where no link holds it (may be repeated)"),
       "BODY"},
      {"level", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.level,
       N_("Add a coarser level of detail to a body, of about a quarter (coarse) or half (medium) of its degrees of "
          "freedom: liver=coarse (may be repeated)"),
       "BODY=LEVEL"},
      {"set", 's', 0, G_OPTION_ARG_STRING_ARRAY, &request.set,
       N_("Set a property, and keep it: bodies/liver/mechanical/material=liver (may be repeated)"), "PATH=VALUE"},
      {"paint", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.paint,
       N_("Paint a region with one dab more, or a new one, before anything is set, m: "
          "bodies/liver/regions/scar=0,0.02,0,0.005; likewise where "
          "what is generated is to be finer: assets/liver_tetrahedra/rim=0,0.02,0,0.005 (may be repeated)"),
       "REGION=X,Y,Z,RADIUS"},
      {"patient", 0, 0, G_OPTION_ARG_STRING, &request.patient,
       N_("Turn gravity as it pulls on a patient who lies so: supine, prone, left_lateral, right_lateral, "
          "trendelenburg (head 15 degrees down), reverse_trendelenburg, upright; in the axes that RAS and LPS files "
          "are "
          "imported to: x right, y to the head, z to the back"),
       "POSITION"},
      {"hold", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.hold,
       N_("Pin a body where it lies lowest and farthest behind, so that it does not fall (may be repeated)"), "BODY"},
      {"instrument", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.instrument,
       N_("Add an instrument that the mouse moves: KIND, KIND:NAME, KIND@X,Y,Z (where it enters, m) or "
          "KIND@X,Y,Z@X,Y,Z (and what it points at); probe, grasper, clamp, clip, scissors, bipolar, suction, needle, "
          "irrigator, bag, endoscope, endoscope_30 (may be repeated)"),
       "KIND@ENTRY@TARGET"},
      {"texture", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.texture,
       N_("Lay a picture, PNG or JPEG, over an organ whose mesh says where its corners lie in one (UV), before it is "
          "mirrored or copied: liver=liver.png (may be repeated)"),
       "BODY=FILE"},
      {"mirror", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.mirror,
       N_("Add a mirrored copy of an organ, across that axis in the middle of the scene, with what ties it to the "
          "scene: "
          "BODY=x, BODY=y, BODY=z (may be repeated)"),
       "BODY=AXIS"},
      {"copy", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.copy,
       N_("Add a copy of an organ, with what ties it to the scene, beside it or so much farther, m: BODY, BODY=X,Y,Z "
          "(may "
          "be repeated)"),
       "BODY=X,Y,Z"},
      {"fluid", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.fluid,
       N_("Add a fluid at a place of an organ, m, after its instruments: KIND@X,Y,Z or KIND:NAME@X,Y,Z; bleeding, "
          "wound (bleeds from a "
          "cut until it is coagulated or clamped), pool (poured there), steam, coagulation (steam of the bipolar "
          "instrument that "
          "is nearest), irrigation (water out of the nearest suction tube, while its second button is down) "
          "(may be repeated)"),
       "KIND@X,Y,Z"},
      {"port", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.port,
       N_("Move a port, and its instrument with it: the instrument turns about its tip, a camera about what it looks "
          "at (may be repeated)"),
       "PORT@X,Y,Z"},
      {"move", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.placing.move,
       N_("Move a body or instrument, with all that is placed on it, by so much, m, after what is added: BODY=X,Y,Z "
          "(may be repeated)"),
       "BODY=X,Y,Z"},
      {"turn", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.placing.turn,
       N_("Turn a body or instrument, with all that is placed on it, about an axis through its middle: liver=z:30 "
          "(may be repeated)"),
       "BODY=AXIS:DEGREES"},
      {"scale", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.placing.scale,
       N_("Make an organ larger or smaller about its middle, with its meshes, cells and spheres and all that is placed "
          "on it: liver=1.2 (may be repeated)"),
       "BODY=FACTOR"},
      {"align", 0, 0, G_OPTION_ARG_STRING_ARRAY, &request.placing.align,
       N_("Move bodies along an axis until their least, middle or greatest coordinates are that of the first: "
          "liver,spleen=y:least (may be repeated)"),
       "BODY,BODY=AXIS:SIDE"},
      {"probe", 0, 0, G_OPTION_ARG_NONE, &request.probe, N_("Add a probe that the mouse moves, above the organs"),
       NULL},
      {"fix", 0, 0, G_OPTION_ARG_NONE, &request.fix,
       N_("Do, after all else, what has one plain remedy of what spore check finds: hold what falls, remove unused "
          "assets and settings, generate stale data and missing spheres, take enough substeps"),
       NULL},
      {"forget-pose", 0, 0, G_OPTION_ARG_NONE, &request.forget_pose,
       N_("Let all bodies begin as their geometry says, not in a pose that was kept"), NULL},
      {"keep-pose", 0, 0, G_OPTION_ARG_STRING, &request.keep_pose,
       N_("Run the scene for so many seconds, after all else, and let it begin as it is then: bodies stand still in "
          "the "
          "shape and place that they have come to"),
       "S"},
      {"output", 'o', 0, G_OPTION_ARG_FILENAME, &request.output, N_("Scene to write (default: the same)"), "F.spore"},
      G_OPTION_ENTRY_NULL};
  GError *error = NULL;
  int status = spore_cli_parse(cli, &info, entries, &argc, &argv);
  gboolean any = request.delete || request.delete_alone || request.locate || request.add || request.soft ||
                 request.level || request.set || request.paint || request.patient || request.hold ||
                 request.instrument || request.fluid || request.mirror || request.copy || request.port ||
                 request.texture || request.placing.move || request.placing.turn || request.placing.scale ||
                 request.placing.align || request.probe || request.fix || request.forget_pose || request.keep_pose;
  if (status == SPORE_EXIT_DONE && !any)
    status = spore_cli_usage(
        _("spore edit: nothing is asked for; expected --delete, --delete-alone, --locate, --add, --soft, --level, "
          "--set, --paint, --patient, --hold, --instrument, --texture, --mirror, --copy, --fluid, --port, --move, "
          "--turn, --scale, --align, --probe, "
          "--fix, --forget-pose or --keep-pose; give one of them"));
  if (status == SPORE_EXIT_DONE)
    status = edit(cli, argv[1], &request, &error) ? spore_cli_finish(cli, SPORE_EXIT_DONE) : spore_cli_fail(error);
  g_strfreev(request.delete);
  g_free(request.keep_pose);
  g_strfreev(request.delete_alone);
  g_strfreev(request.locate);
  g_strfreev(request.add);
  g_strfreev(request.soft);
  g_strfreev(request.level);
  g_strfreev(request.set);
  g_strfreev(request.paint);
  g_strfreev(request.hold);
  g_strfreev(request.fluid);
  g_strfreev(request.mirror);
  g_strfreev(request.texture);
  g_strfreev(request.copy);
  g_strfreev(request.instrument);
  g_strfreev(request.port);
  g_strfreev(request.placing.move);
  g_strfreev(request.placing.turn);
  g_strfreev(request.placing.scale);
  g_strfreev(request.placing.align);
  g_free(request.patient);
  g_free(request.output);
  return status;
}
