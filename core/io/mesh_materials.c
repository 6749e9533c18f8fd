/* Materials of OBJ, which lie in a text beside it (Wavefront's "Object Files" and MTL, as Alias wrote them down). */
#include <math.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/beside.h"
#include "core/io/mesh_beside.h"
#include "core/io/mesh_text.h"

#define MOST_BYTES ((gsize)16 << 20) /* of a text of materials */
#define MOST_MATERIALS 10000u
#define MOST_MOVED 1e6 /* pictures */

/* Options of map_Kd and the words behind them; of the last three up to that many numbers. */
static const struct {
  const char *name;
  int words;
} options[] = {{"-blendu", 1}, {"-blendv", 1}, {"-boost", 1},   {"-mm", 2}, {"-texres", 1}, {"-clamp", 1}, {"-bm", 1},
               {"-cc", 1},     {"-type", 1},   {"-imfchan", 1}, {"-o", 3},  {"-s", 3},      {"-t", 3}};

/* A line of the text, without white space around it. FALSE: there is none any more. g_free. */
static gboolean next_line(const char **at, const char *end, char **line) {
  if (*at >= end) return FALSE;
  const char *stop = memchr(*at, '\n', (gsize)(end - *at));
  if (!stop) stop = end;
  *line = g_strstrip(g_strndup(*at, (gsize)(stop - *at)));
  *at = stop + 1;
  return TRUE;
}

/* What stands behind that word at the beginning of the line, or NULL. */
static const char *behind(const char *line, const char *word) {
  gsize length = strlen(word);
  if (g_ascii_strncasecmp(line, word, length) != 0 || !g_ascii_isspace(line[length])) return NULL;
  line += length;
  while (g_ascii_isspace(*line)) line++;
  return line;
}

static const char *behind_word(const char *text) {
  while (*text && !g_ascii_isspace(*text)) text++;
  while (g_ascii_isspace(*text)) text++;
  return text;
}

static gboolean is_number(const char *text) {
  char *end;
  g_ascii_strtod(text, &end);
  return end != text && (!*end || g_ascii_isspace(*end));
}

/* The numbers of an option, up to two; what is not said, or is none, stays. */
static void read_pair(const char *text, gboolean scales, double pair[2]) {
  for (int k = 0; k < 2 && is_number(text); k++, text = behind_word(text)) {
    double number = g_ascii_strtod(text, NULL);
    if (isfinite(number) && fabs(number) <= MOST_MOVED && (number != 0 || !scales)) pair[k] = number;
  }
}

/* The name of the picture behind its options. Those that move and repeat the picture are taken, and those that filter
 * it are passed over. */
static const char *behind_options(const char *text, SporeMeshMaterial *material) {
  for (gsize i = 0; *text == '-' && i < G_N_ELEMENTS(options); i++) {
    const char *rest = behind(text, options[i].name);
    if (!rest) continue;
    if (strcmp(options[i].name, "-s") == 0) read_pair(rest, TRUE, material->scale);
    if (strcmp(options[i].name, "-o") == 0) read_pair(rest, FALSE, material->offset);
    for (int word = 0; word < options[i].words && (options[i].words < 3 || is_number(rest)); word++)
      rest = behind_word(rest);
    text = rest;
    i = (gsize)-1; /* from the first option again */
  }
  return text;
}

/* The path in a name as programs of any system write it. g_free. */
static char *path_of(const char *name) {
  gsize length = strlen(name);
  gboolean quoted = length > 1 && *name == '"' && name[length - 1] == '"';
  char *path = g_strdelimit(quoted ? g_strndup(name + 1, length - 2) : g_strdup(name), "\\", '/');
  while (g_str_has_prefix(path, "./")) memmove(path, path + 2, strlen(path) - 1);
  return path;
}

/* A picture whose material says no colour is shown as it is. */
static void take_white(SporeMeshMaterial *material) {
  if (material->coloured) return;
  material->colour[0] = material->colour[1] = material->colour[2] = 1;
  material->coloured = true;
}

/* Kd with three numbers, or one for all. */
static void read_colour(SporeMeshMaterial *material, const char *text) {
  double colour[3];
  for (int k = 0; k < 3; k++) {
    if (k == 0 || *text) {
      if (!is_number(text)) return;
      colour[k] = CLAMP(g_ascii_strtod(text, NULL), 0, 1);
      text = behind_word(text);
    } else colour[k] = colour[0];
    if (!(colour[k] >= 0)) return;
  }
  memcpy(material->colour, colour, sizeof colour);
  material->coloured = true;
}

/* d with a number; "-halo" before it says that it holds at the middle alone, and is passed over. One that nothing is
 * seen of is not meant. */
static void read_opacity(SporeMeshMaterial *material, const char *text) {
  if (g_str_has_prefix(text, "-halo")) text = behind_word(text);
  if (!is_number(text)) return;
  double number = g_ascii_strtod(text, NULL);
  if (number > 0) material->opacity = MIN(number, 1);
}

/* Tr, as much as d lacks of 1; where both are said, d holds: some programs write the same number twice. */
static void read_transparency(SporeMeshMaterial *material, const char *text) {
  if (material->opacity > 0 || !is_number(text)) return;
  double number = g_ascii_strtod(text, NULL);
  if (number >= 0 && number < 1) material->opacity = 1 - number;
}

/* One line of a material, or the beginning of the next one. folder: that pictures are named from, "" or with a slash.
 */
static void read_line(SporeMeshBeside *beside, const char *file, const char *folder, const char *line,
                      SporeMeshMaterial **material) {
  const char *name = behind(line, "newmtl"), *colour = behind(line, "Kd"), *picture = behind(line, "map_Kd");
  const char *opacity = behind(line, "d");
  if (name && beside->materials->len < MOST_MATERIALS) {
    *material = g_new0(SporeMeshMaterial, 1);
    (*material)->name = g_strdup(name);
    (*material)->scale[0] = (*material)->scale[1] = 1;
    g_ptr_array_add(beside->materials, *material);
  }
  if (colour && *material) read_colour(*material, colour);
  if (opacity && *material) read_opacity(*material, opacity);
  if (behind(line, "Tr") && *material) read_transparency(*material, behind(line, "Tr"));
  if (behind(line, "map_d") && *material) (*material)->mapped = true;
  if (!picture || !*material) return;
  g_autofree char *named = path_of(behind_options(picture, *material)), *path = g_strconcat(folder, named, NULL);
  (*material)->picture = spore_mesh_beside_picture(beside, file, path, path);
  take_white(*material);
}

void spore_mesh_beside_describe(SporeMeshBeside *beside, const char *file, const char *folder, const char *text,
                                gsize size) {
  char *held = NULL, *line;
  SporeMeshMaterial *material = NULL;
  if (size && spore_mesh_text(&text, &size, &held))
    for (const char *at = text; next_line(&at, text + size, &line); g_free(line))
      read_line(beside, file, folder, line, &material);
  spore_free(held);
}

static void read_materials(SporeMeshBeside *beside, const char *file, const char *path) {
  g_autoptr(GError) error = NULL;
  g_autoptr(GBytes) content = spore_beside_read(file, path, NULL, 0, MOST_BYTES, &error);
  if (!content) {
    if (!beside->reason) beside->reason = spore_mesh_beside_reason(file, error);
    return;
  }
  const char *slash = strrchr(path, '/');
  g_autofree char *folder = g_strndup(path, slash ? (gsize)(slash + 1 - path) : 0);
  gsize size;
  const char *text = g_bytes_get_data(content, &size);
  spore_mesh_beside_describe(beside, file, folder, text, size);
}

/* A line names one file, whose name may have blanks, or several. */
static void read_libraries(SporeMeshBeside *beside, const char *file, const char *line) {
  g_autofree char *folder = g_path_get_dirname(file), *whole = g_build_filename(folder, line, NULL);
  if (!strchr(line, ' ') || g_file_test(whole, G_FILE_TEST_EXISTS)) {
    read_materials(beside, file, line);
    return;
  }
  g_auto(GStrv) names = g_strsplit(line, " ", -1);
  for (char **name = names; *name; name++)
    if (**name) read_materials(beside, file, *name);
}

void spore_mesh_beside_materials(SporeMeshBeside *beside, const char *file, const char *text, gsize size) {
  g_autoptr(GHashTable) known = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
  const char *end = text + size;
  for (const char *at = text; at && at < end; at = memchr(at, '\n', (gsize)(end - at)), at = at ? at + 1 : NULL) {
    if (*at != 'm') continue; /* most lines by far */
    const char *from = at;
    g_autofree char *line = NULL;
    const char *name = next_line(&from, end, &line) ? behind(line, "mtllib") : NULL;
    char *path = name ? path_of(name) : NULL;
    if (path && g_hash_table_add(known, path)) read_libraries(beside, file, path);
  }
}
