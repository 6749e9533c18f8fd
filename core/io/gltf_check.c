/* Checks the JSON of glTF 2.0 files (Khronos, "glTF 2.0 Specification", sections 3.5 to 3.7 and 5). The text is
 * untrusted: nothing is expanded, and no depth or count is believed. */
#include "core/io/gltf_check.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/io/json_scan.h"
#include "core/mesh/mesh.h"

#define DEEPEST_NODE 256
#define NONE G_MAXUINT32

/* The file. */

enum { ACCESSORS, VIEWS, MESHES, NODES, SCENES, SECTIONS };
static const char *const section_names[SECTIONS] = {"accessors", "bufferViews", "meshes", "nodes", "scenes"};

typedef struct Gltf {
  const char *place;
  GError **error;
  gboolean failed; /* *error is set */
  SporeJson json;
  const char *sections[SECTIONS]; /* where each array begins; NULL: there is none */
  gsize counts[SECTIONS];
  guint64 *elements;           /* of each accessor */
  guint64 *vertices, *corners; /* of each mesh */
  guint32 *parents;            /* of each node; NONE: it has none */
  guint32 *roots;              /* 1 + the last scene that a node is a root of; 0: none */
} Gltf;

static gboolean fail(Gltf *gltf, const char *format, ...) G_GNUC_PRINTF(2, 3);
static gboolean fail(Gltf *gltf, const char *format, ...) {
  if (gltf->failed) return FALSE;
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  spore_error_raise(gltf->error, SPORE_ERROR_INPUT, gltf->place, "%s", message);
  gltf->failed = gltf->json.bad = TRUE;
  return FALSE;
}

/* A key could be hidden by an escape, which a library would undo. */
static gboolean is_key(Gltf *gltf, SporeJsonText key, const char *name) {
  if (memchr(key.text, '\\', key.length))
    return fail(gltf, _("a name in the glTF text has an escape (\\); expected plain names; export the mesh again"));
  return key.length == strlen(name) && memcmp(key.text, name, key.length) == 0;
}

/* Reads a whole number within the bounds; `section` and `index` are for the message. */
static gboolean read_whole(Gltf *gltf, int section, gsize index, const char *name, guint64 least, guint64 most,
                           guint64 *value) {
  SporeJsonText scalar = {"", 0};
  SporeJson *json = &gltf->json;
  while (json->at < json->end && g_ascii_isspace(*json->at)) json->at++;
  if (json->bad || !spore_json_scalar(json, &scalar)) return FALSE;
  gsize digits = 0;
  *value = 0;
  for (; digits < scalar.length && g_ascii_isdigit(scalar.text[digits]) && digits < 18; digits++)
    *value = 10 * *value + (guint64)(scalar.text[digits] - '0');
  if (digits == scalar.length && *value >= least && *value <= most) return TRUE;
  return fail(gltf,
              _("%s %zu of the glTF text has %s %.*s; expected a whole number from %llu to %llu; export the mesh "
                "again"),
              section_names[section], index, name, (int)MIN(scalar.length, 40), scalar.text, (unsigned long long)least,
              (unsigned long long)most);
}

/* Reads the number of an item of `target`. */
static gboolean read_index(Gltf *gltf, int section, gsize index, const char *name, int target, guint64 *value) {
  gsize count = gltf->counts[target];
  if (count == 0)
    return fail(gltf, _("%s %zu of the glTF text names one of its %s, and there are none; export the mesh again"),
                section_names[section], index, section_names[target]);
  return read_whole(gltf, section, index, name, 0, count - 1, value);
}

typedef void ReadItem(Gltf *gltf, gsize index);

/* Reads each item of an array by `read`; NULL: skips it. Returns the number of items. */
static gsize read_section(Gltf *gltf, int section, ReadItem *read) {
  gsize count = 0;
  if (!gltf->sections[section]) return 0;
  gltf->json.at = gltf->sections[section];
  if (!spore_json_take(&gltf->json, '[')) spore_json_fail(&gltf->json);
  while (spore_json_next_item(&gltf->json, ']', &count))
    if (read) read(gltf, count - 1);
    else spore_json_skip(&gltf->json, 1);
  return count;
}

static void find_sections(Gltf *gltf) {
  gsize count = 0;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    for (int s = 0; s < SECTIONS; s++) {
      if (!is_key(gltf, key, section_names[s])) continue;
      if (gltf->sections[s])
        fail(gltf, _("the glTF text has %s twice; expected them once; export the mesh again"), section_names[s]);
      gltf->sections[s] = gltf->json.at;
    }
    spore_json_skip(&gltf->json, 0);
  }
}

/* Items. */

static void read_view(Gltf *gltf, gsize index) {
  static const struct {
    const char *name;
    guint64 least, most;
  } members[] = {{"byteOffset", 0, G_MAXUINT32}, {"byteLength", 1, G_MAXUINT32}, {"byteStride", 4, 252}};
  gsize count = 0;
  guint64 value;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    gsize m = 0;
    while (m < G_N_ELEMENTS(members) && !is_key(gltf, key, members[m].name)) m++;
    if (m == G_N_ELEMENTS(members)) spore_json_skip(&gltf->json, 2);
    else read_whole(gltf, VIEWS, index, members[m].name, members[m].least, members[m].most, &value);
  }
}

static void read_accessor(Gltf *gltf, gsize index) {
  gsize count = 0;
  guint64 offset, elements = 0;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    if (is_key(gltf, key, "byteOffset")) read_whole(gltf, ACCESSORS, index, "byteOffset", 0, G_MAXUINT32, &offset);
    else if (is_key(gltf, key, "count")) {
      read_whole(gltf, ACCESSORS, index, "count", 1, 3 * (guint64)SPORE_MESH_MAXIMUM, &elements);
      gltf->elements[index] = MAX(gltf->elements[index], elements); /* which of two the importer takes is not known */
    } else spore_json_skip(&gltf->json, 2);
  }
}

static void read_attributes(Gltf *gltf, gsize mesh) {
  gsize count = 0;
  guint64 accessor;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    if (!is_key(gltf, key, "POSITION")) spore_json_skip(&gltf->json, 5);
    else if (read_index(gltf, MESHES, mesh, "POSITION", ACCESSORS, &accessor))
      gltf->vertices[mesh] += gltf->elements[accessor];
  }
}

static void read_primitive(Gltf *gltf, gsize mesh) {
  gsize count = 0;
  guint64 accessor;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    if (is_key(gltf, key, "attributes")) read_attributes(gltf, mesh);
    else if (!is_key(gltf, key, "indices")) spore_json_skip(&gltf->json, 4);
    else if (read_index(gltf, MESHES, mesh, "indices", ACCESSORS, &accessor))
      gltf->corners[mesh] += gltf->elements[accessor];
  }
}

static void read_mesh(Gltf *gltf, gsize index) {
  gsize count = 0, primitives = 0;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    if (!is_key(gltf, key, "primitives")) spore_json_skip(&gltf->json, 2);
    else if (!spore_json_take(&gltf->json, '[')) spore_json_fail(&gltf->json);
    else
      while (spore_json_next_item(&gltf->json, ']', &primitives)) read_primitive(gltf, index);
  }
}

static void read_children(Gltf *gltf, gsize index) {
  gsize count = 0;
  guint64 child;
  if (!spore_json_take(&gltf->json, '[')) spore_json_fail(&gltf->json);
  while (spore_json_next_item(&gltf->json, ']', &count)) {
    if (!read_index(gltf, NODES, index, "children", NODES, &child)) return;
    if (gltf->parents[child] != NONE)
      fail(gltf,
           _("node %llu of the glTF text lies in more than one other node; expected a tree; export the mesh again"),
           (unsigned long long)child);
    gltf->parents[child] = (guint32)index;
  }
}

/* Adds what a node shows to the totals, which are kept behind those of the meshes. */
static void read_node(Gltf *gltf, gsize index) {
  gsize count = 0, total = gltf->counts[MESHES];
  guint64 mesh;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key)) {
    if (is_key(gltf, key, "children")) read_children(gltf, index);
    else if (!is_key(gltf, key, "mesh")) spore_json_skip(&gltf->json, 2);
    else if (read_index(gltf, NODES, index, "mesh", MESHES, &mesh)) {
      gltf->vertices[total] += gltf->vertices[mesh];
      gltf->corners[total] += gltf->corners[mesh];
    }
  }
}

static void read_roots(Gltf *gltf, gsize scene) {
  gsize count = 0;
  guint64 node;
  if (!spore_json_take(&gltf->json, '[')) spore_json_fail(&gltf->json);
  while (spore_json_next_item(&gltf->json, ']', &count)) {
    if (!read_index(gltf, SCENES, scene, "nodes", NODES, &node)) return;
    if (gltf->parents[node] != NONE || gltf->roots[node] == scene + 1)
      fail(gltf, _("node %llu of the glTF text is in its scene twice; expected a tree; export the mesh again"),
           (unsigned long long)node);
    gltf->roots[node] = (guint32)scene + 1;
  }
}

static void read_scene(Gltf *gltf, gsize index) {
  gsize count = 0;
  SporeJsonText key;
  if (!spore_json_take(&gltf->json, '{')) spore_json_fail(&gltf->json);
  while (spore_json_next_member(&gltf->json, &count, &key))
    if (is_key(gltf, key, "nodes")) read_roots(gltf, index);
    else spore_json_skip(&gltf->json, 2);
}

/* The whole. */

/* Nodes that lie in each other in a circle are too deep as well. */
static void check_depth(Gltf *gltf) {
  for (gsize i = 0; i < gltf->counts[NODES]; i++) {
    int depth = 0;
    for (guint32 node = gltf->parents[i]; node != NONE && depth <= DEEPEST_NODE; node = gltf->parents[node]) depth++;
    if (depth > DEEPEST_NODE)
      fail(gltf, _("node %zu of the glTF text lies in more than %d others; expected fewer; export the mesh again"), i,
           DEEPEST_NODE);
  }
}

static void check_totals(Gltf *gltf) {
  guint64 vertices = 0, corners = 0;
  gsize meshes = gltf->counts[MESHES];
  for (gsize m = 0; m < meshes; m++) vertices += gltf->vertices[m], corners += gltf->corners[m];
  vertices = MAX(vertices, gltf->vertices[meshes]), corners = MAX(corners, gltf->corners[meshes]);
  if (vertices > SPORE_MESH_MAXIMUM || corners / 3 > SPORE_MESH_MAXIMUM)
    fail(gltf, _("the mesh has more than %u vertices or triangles; expected fewer; decimate it first"),
         SPORE_MESH_MAXIMUM);
}

static gboolean allocate(Gltf *gltf) {
  gltf->elements = SPORE_NEW_ARRAY(guint64, gltf->counts[ACCESSORS] + 1);
  gltf->vertices = SPORE_NEW_ARRAY(guint64, gltf->counts[MESHES] + 1);
  gltf->corners = SPORE_NEW_ARRAY(guint64, gltf->counts[MESHES] + 1);
  gltf->parents = SPORE_NEW_ARRAY(guint32, gltf->counts[NODES] + 1);
  gltf->roots = SPORE_NEW_ARRAY(guint32, gltf->counts[NODES] + 1);
  if (gltf->elements && gltf->vertices && gltf->corners && gltf->parents && gltf->roots) {
    for (gsize i = 0; i < gltf->counts[NODES]; i++) gltf->parents[i] = NONE;
    return TRUE;
  }
  gltf->failed = TRUE;
  return spore_error_raise(gltf->error, SPORE_ERROR_MEMORY, gltf->place,
                           _("there is not enough memory to import it; close other programs"));
}

static void read_all(Gltf *gltf) {
  static ReadItem *const readers[SECTIONS] = {[ACCESSORS] = read_accessor,
                                              [VIEWS] = read_view,
                                              [MESHES] = read_mesh,
                                              [NODES] = read_node,
                                              [SCENES] = read_scene};
  find_sections(gltf);
  for (int s = 0; s < SECTIONS && !gltf->json.bad; s++) gltf->counts[s] = read_section(gltf, s, NULL);
  if (gltf->json.bad || !allocate(gltf)) return;
  for (int s = 0; s < SECTIONS && !gltf->json.bad; s++) read_section(gltf, s, readers[s]);
  if (gltf->json.bad) return;
  check_depth(gltf);
  check_totals(gltf);
}

gboolean spore_gltf_check(const char *place, const char *text, gsize size, GError **error) {
  Gltf gltf = {.place = place, .error = error, .json = {text, text + size, FALSE}};
  read_all(&gltf);
  if (gltf.json.bad)
    fail(&gltf, _("the glTF text is not the JSON of a mesh, near byte %zu; expected glTF 2.0; export the mesh again"),
         (gsize)(gltf.json.at - text));
  spore_free(gltf.elements);
  spore_free(gltf.vertices);
  spore_free(gltf.corners);
  spore_free(gltf.parents);
  spore_free(gltf.roots);
  return !gltf.failed;
}
