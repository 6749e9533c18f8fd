/* A label map's labels with their names, volumes and sizes, from the helper that counts them. */
#include "core/io/label_survey.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/io/beside.h"
#include "core/io/helper.h"
#include "core/io/label_map.h"
#include "core/io/volume_wire.h"

#define MOST_SIDECAR ((gsize)1 << 20)

const char *const spore_label_namings[] = {NULL, "file", "sidecar", "guessed"};

void spore_label_survey_free(SporeLabelSurvey *survey) {
  g_array_unref(survey->entries);
  g_free(survey);
}

static void clear_entry(gpointer data) { g_free(((SporeLabelEntry *)data)->name); }

/* The table of a file beside the map, of its name with another ending: label -> char *. g_hash_table_unref. */
static GHashTable *read_sidecar(const char *file) {
  static const char *const endings[] = {".json", ".txt", ".ctbl", ".label"};
  GHashTable *names = g_hash_table_new_full(NULL, NULL, NULL, g_free);
  g_autofree char *stem = g_path_get_basename(file);
  if (g_str_has_suffix(stem, ".gz")) stem[strlen(stem) - 3] = '\0';
  char *dot = strrchr(stem, '.');
  if (dot && dot != stem) *dot = '\0';
  for (gsize i = 0; i < G_N_ELEMENTS(endings) && g_hash_table_size(names) == 0; i++) {
    g_autofree char *name = g_strconcat(stem, endings[i], NULL);
    g_autoptr(GBytes) content = spore_beside_read(file, name, NULL, 0, MOST_SIDECAR, NULL);
    gsize size;
    const char *text = content ? g_bytes_get_data(content, &size) : NULL;
    if (text && size) spore_label_table_read(text, size, i == 0, names);
  }
  return names;
}

static void name_entry(SporeLabelEntry *entry, const SporeVolumeLabel *said, GHashTable *table, GHashTable *sidecar) {
  g_autofree char *own = g_utf8_make_valid(said->name, (gssize)strnlen(said->name, sizeof said->name - 1));
  const char *listed = g_hash_table_lookup(table, GUINT_TO_POINTER((guint)entry->label)),
             *beside = g_hash_table_lookup(sidecar, GUINT_TO_POINTER((guint)entry->label));
  for (char *c = own; *c; c++)
    if (g_ascii_iscntrl(*c)) *c = ' ';
  entry->naming = listed || *g_strstrip(own) ? SPORE_LABEL_NAMED_BY_FILE
                  : beside                   ? SPORE_LABEL_NAMED_BY_SIDECAR
                                             : SPORE_LABEL_UNNAMED;
  if (listed || beside || *own) entry->name = g_strdup(listed ? listed : *own ? own : beside);
  else entry->name = spore_label_map_name(table, entry->label);
}

/* The helper is not trusted: a label must lie in the volume. */
static gboolean take_entry(const SporeVolumeLabel *said, const SporeLabelSurvey *survey, double voxel,
                           SporeLabelEntry *entry) {
  entry->label = (guint16)said->label;
  entry->voxels = said->voxels;
  entry->volume = (double)said->voxels * voxel;
  for (int k = 0; k < 3; k++) {
    if (said->lower[k] > said->upper[k] || said->upper[k] >= survey->size[k]) return FALSE;
    entry->size[k] = survey->spacing[k] * (said->upper[k] - said->lower[k] + 1);
    entry->cut[k][0] = said->lower[k] == 0;
    entry->cut[k][1] = said->upper[k] + 1 == survey->size[k];
  }
  return said->label >= 1 && said->label <= G_MAXUINT16;
}

/* Size and spacing of the volume. *voxel: volume of one voxel, m^3. */
static gboolean take_volume(const SporeVolumeAnswer *said, SporeLabelSurvey *survey, double *voxel) {
  const double *a = said->axes;
  SporeVec3 columns[3];
  for (int k = 0; k < 3; k++) {
    columns[k] = spore_vec3(a[k], a[4 + k], a[8 + k]);
    survey->size[k] = said->size[k];
    survey->spacing[k] = sqrt(spore_vec3_dot(columns[k], columns[k]));
  }
  *voxel = fabs(spore_vec3_dot(columns[0], spore_vec3_cross(columns[1], columns[2])));
  return isfinite(*voxel) && *voxel > 0;
}

static gboolean read_answer(const char *file, GBytes *content, GBytes *answer, SporeLabelSurvey *survey) {
  gsize size, content_size;
  const char *bytes = g_bytes_get_data(answer, &size), *given = g_bytes_get_data(content, &content_size);
  SporeVolumeSurvey head = {0};
  double voxel = 0;
  if (size >= sizeof head) memcpy(&head, bytes, sizeof head);
  gboolean sane = size >= sizeof head && head.count <= G_MAXUINT16 &&
                  size == sizeof head + head.count * sizeof(SporeVolumeLabel) &&
                  take_volume(&head.volume, survey, &voxel);
  g_autoptr(GHashTable) table = spore_label_map_names(given, content_size), sidecar = read_sidecar(file);
  for (guint64 i = 0; i < head.count && sane; i++) {
    SporeVolumeLabel said;
    SporeLabelEntry entry = {0};
    memcpy(&said, bytes + sizeof head + i * sizeof said, sizeof said);
    sane = take_entry(&said, survey, voxel, &entry);
    if (!sane) break;
    name_entry(&entry, &said, table, sidecar);
    g_array_append_val(survey->entries, entry);
  }
  return sane;
}

/* Guesses the names where neither the file nor a sidecar has one. */
static void guess(SporeLabelSurvey *survey) {
  g_autoptr(GArray) sizes = g_array_new(FALSE, FALSE, sizeof(SporeLabelSize));
  for (guint i = 0; i < survey->entries->len; i++) {
    const SporeLabelEntry *entry = &g_array_index(survey->entries, SporeLabelEntry, i);
    const SporeLabelSize size = {entry->label, entry->volume};
    if (entry->naming != SPORE_LABEL_UNNAMED) return;
    g_array_append_val(sizes, size);
  }
  g_autoptr(GHashTable) names = spore_label_guess((const SporeLabelSize *)(gconstpointer)sizes->data, sizes->len);
  for (guint i = 0; i < survey->entries->len; i++) {
    SporeLabelEntry *entry = &g_array_index(survey->entries, SporeLabelEntry, i);
    const char *name = g_hash_table_lookup(names, GUINT_TO_POINTER((guint)entry->label));
    if (!name) continue;
    g_free(entry->name);
    entry->name = g_strdup(name);
    entry->naming = SPORE_LABEL_GUESSED;
  }
}

SporeLabelSurvey *spore_label_survey(const char *file, GBytes *content, const SporeProgress *progress, GError **error) {
  if (!spore_label_map_readable(file, error)) return NULL;
  g_autoptr(GBytes) answer =
      spore_helper_run("spore-volume-list", file, content, &spore_label_map_limits, progress, error);
  if (!answer) return NULL;
  g_autoptr(SporeLabelSurvey) survey = g_new0(SporeLabelSurvey, 1);
  survey->entries = g_array_new(FALSE, FALSE, sizeof(SporeLabelEntry));
  g_array_set_clear_func(survey->entries, clear_entry);
  if (read_answer(file, content, answer, survey)) {
    guess(survey);
    return g_steal_pointer(&survey);
  }
  spore_error_raise(error, SPORE_ERROR_INTERNAL, file,
                    _("the volume helper gave a wrong answer; expected labels; report this"));
  return NULL;
}

const SporeLabelEntry *spore_label_survey_entry(const SporeLabelSurvey *survey, guint16 label) {
  for (guint i = 0; i < survey->entries->len; i++) {
    const SporeLabelEntry *entry = &g_array_index(survey->entries, SporeLabelEntry, i);
    if (entry->label == label) return entry;
  }
  return NULL;
}

/* The label that a word names, by number or by name in either case of letters; 0: none. */
static guint16 find(const SporeLabelSurvey *survey, const char *word) {
  guint64 value = 0;
  const gboolean number = g_ascii_string_to_unsigned(word, 10, 1, 65535, &value, NULL);
  g_autofree char *wanted = g_utf8_casefold(word, -1);
  for (guint i = 0; i < survey->entries->len; i++) {
    const SporeLabelEntry *entry = &g_array_index(survey->entries, SporeLabelEntry, i);
    g_autofree char *name = g_utf8_casefold(entry->name, -1);
    if (g_str_equal(name, wanted) || (number && entry->label == value)) return entry->label;
  }
  return 0;
}

static GArray *fail_unknown(const SporeLabelSurvey *survey, const char *word, GError **error) {
  g_autoptr(GString) known = g_string_new(NULL);
  for (guint i = 0; i < survey->entries->len && i < 20; i++)
    g_string_append_printf(known, "%s%s", i ? ", " : "", g_array_index(survey->entries, SporeLabelEntry, i).name);
  spore_error_raise(error, SPORE_ERROR_INPUT, "--labels",
                    _("'%s' is no label of it; expected numbers or names with commas, of these: %s; --list shows all"),
                    word, known->str);
  return NULL;
}

GArray *spore_label_survey_choose(const SporeLabelSurvey *survey, const char *text, GError **error) {
  g_autoptr(GArray) labels = g_array_new(FALSE, FALSE, sizeof(guint16));
  g_auto(GStrv) words = g_strsplit(text, ",", -1);
  for (char **word = words; *word; word++) {
    const guint16 label = find(survey, g_strstrip(*word));
    if (!label) return fail_unknown(survey, *word, error);
    g_array_append_val(labels, label);
  }
  return g_steal_pointer(&labels);
}
