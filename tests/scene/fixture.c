/* What the tests of scenes share: a schema with one small model, and scene folders to load and to write. */
#include "fixture.h"

#include <ftw.h>
#include <glib/gstdio.h>
#include <stdio.h>
#include <string.h>

#include "core/author/generator.h"
#include "models/registry.h"

typedef struct ParticleFields {
  double mass, pull[3];
  int64_t samples;
  bool heavy;
  int shape;
  const char *note;
} ParticleFields;

static const char *const shapes[] = {"point", "ball", "cube", NULL};

static const SporeParameter particle_parameters[] = {
    {"mass", SPORE_REAL, "kg", 0.001, 1000, {1}, .offset = offsetof(ParticleFields, mass), .doc = "Mass."},
    {"pull", SPORE_VECTOR, "N", -10, 10, {0, 1, 0}, .offset = offsetof(ParticleFields, pull), .doc = "Force."},
    {"samples", SPORE_INTEGER, "", 1, 100, {5}, .offset = offsetof(ParticleFields, samples), .doc = "Count."},
    {"heavy", SPORE_BOOLEAN, "", 0, 1, {0}, .offset = offsetof(ParticleFields, heavy), .doc = "Whether <it> is."},
    {"shape",
     SPORE_CHOICE,
     "",
     0,
     0,
     {1},
     .choices = shapes,
     .offset = offsetof(ParticleFields, shape),
     .doc = "Shape."},
    {"note", SPORE_TEXT, "", .offset = offsetof(ParticleFields, note), .doc = "Anything."},
};

static const SporeModelType particle = {
    .name = "particle",
    .label = "Particle",
    .doc = "A model that nobody runs.",
    .parameters = {particle_parameters, G_N_ELEMENTS(particle_parameters), sizeof(ParticleFields)},
};
static const SporeModelType *const registry[] = {&particle, NULL};

const SporeSchema *fixture_schema(void) {
  static SporeSchema *schema;
  if (!schema) schema = spore_schema_new(registry, spore_generator_elements());
  return schema;
}

const SporeSchema *fixture_model_schema(void) {
  static SporeSchema *schema;
  if (!schema) schema = spore_schema_new(spore_model_registry, spore_generator_elements());
  return schema;
}

#define CORNERS                                                                                                        \
  "-.05 -.05 -.05\n.05 -.05 -.05\n.05 .05 -.05\n-.05 .05 -.05\n-.05 -.05 .05\n.05 -.05 .05\n.05 .05 .05\n-.05 .05 "    \
  ".05\n"
static const char open_off[] =
    "OFF\n8 10 0\n" CORNERS "3 0 3 2\n3 0 2 1\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 "
    "7 6\n3 1 2 6\n3 1 6 5\n";
static const char cube_off[] =
    "OFF\n8 12 0\n" CORNERS "3 0 3 2\n3 0 2 1\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n3 2 3 7\n3 2 "
    "7 6\n3 1 2 6\n3 1 6 5\n3 0 4 7\n3 0 7 3\n";
static const char inside_off[] =
    "OFF\n8 12 0\n" CORNERS
    "3 0 2 3\n3 0 1 2\n3 4 6 5\n3 4 7 6\n3 0 5 1\n3 0 4 5\n3 2 7 3\n3 2 6 7\n3 1 6 2\n3 1 5 6\n3 0 7 4\n3 0 3 7\n";
static const char large_off[] =
    "OFF\n4 4 0\n0 0 0\n100 0 0\n0 100 0\n100 100 100\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n";
static const char wide_off[] =
    "OFF\n4 4 0\n-.1 -.1 -.1\n.1 .1 -.1\n.1 -.1 .1\n-.1 .1 .1\n3 0 1 2\n3 0 3 1\n3 0 2 3\n3 1 3 2\n";
static const char sheet_off[] = "OFF\n4 2 0\n0 0 0\n.1 0 0\n.1 .1 0\n0 .1 0\n3 0 1 2\n3 0 2 3\n";
static const char cube_mesh[] =
    "MeshVersionFormatted 2\nDimension 3\nVertices 8\n-.05 -.05 -.05 0\n.05 -.05 -.05 0\n.05 .05 -.05 0\n-.05 .05 -.05 "
    "0\n-.05 -.05 .05 0\n.05 -.05 .05 0\n.05 .05 .05 0\n-.05 .05 .05 0\nTetrahedra 5\n1 2 3 6 0\n1 3 4 8 0\n1 6 8 5 "
    "0\n3 8 6 7 0\n1 3 8 6 0\nEnd\n";

char *fixture_scene_folder_new(const char *scene) {
  char *folder = fixture_folder_new();
  g_free(fixture_write(folder, "cube.off", cube_off));
  g_free(fixture_write(folder, "open.off", open_off));
  g_free(fixture_write(folder, "inside.off", inside_off));
  g_free(fixture_write(folder, "large.off", large_off));
  g_free(fixture_write(folder, "wide.off", wide_off));
  g_free(fixture_write(folder, "sheet.off", sheet_off));
  g_free(fixture_write(folder, "cube.mesh", cube_mesh));
  g_free(fixture_write(folder, "ball.spheres", "# one\n0 0 0 0.05\n"));
  g_free(fixture_write(folder, "felt.spheres", "# level 0.025\n0 0 0 0.1 0.5\n"));
  g_free(fixture_write(folder, "away.spheres", "0 0 0 0.05\n0.3 0 0 0.05\n"));
  g_free(fixture_write(folder, "far.spheres", "0 0 0 0.05\n0.8 0 0.8 0.05\n"));
  g_free(fixture_write(folder, "line.curve", "0 0 0 0.002\n0.1 0 0 0.002\n"));
  g_free(fixture_write(folder, "scene.spore", scene));
  return folder;
}

SporeDocument *fixture_load(const char *folder) {
  GError *error = NULL;
  g_autofree char *file = g_build_filename(folder, "scene.spore", NULL);
  SporeDocument *document = spore_scene_load(fixture_model_schema(), file, &error);
  g_assert_no_error(error);
  return document;
}

char *fixture_folder_new(void) {
  GError *error = NULL;
  char *folder = g_dir_make_tmp("spore-test-XXXXXX", &error);
  g_assert_no_error(error);
  return folder;
}

static int remove_one(const char *path, const struct stat *status, int kind, struct FTW *walk) { return remove(path); }

void fixture_folder_free(char *folder) {
  g_assert_cmpint(nftw(folder, remove_one, 16, FTW_DEPTH | FTW_PHYS), ==, 0);
  g_free(folder);
}

FixtureScene fixture_scene_new(const char *text) {
  FixtureScene scene = {.folder = fixture_scene_folder_new(text)};
  scene.document = fixture_load(scene.folder);
  return scene;
}

void fixture_scene_free(FixtureScene *scene) {
  spore_document_free(scene->document);
  fixture_folder_free(scene->folder);
}

char *fixture_write(const char *folder, const char *name, const char *text) {
  GError *error = NULL;
  char *path = g_build_filename(folder, name, NULL);
  g_autofree char *above = g_path_get_dirname(path);
  g_assert_cmpint(g_mkdir_with_parents(above, 0777), ==, 0);
  g_file_set_contents(path, text, -1, &error);
  g_assert_no_error(error);
  return path;
}

char *fixture_read(const char *folder, const char *name) {
  g_autofree char *path = g_build_filename(folder, name, NULL);
  char *text = NULL;
  g_file_get_contents(path, &text, NULL, NULL);
  return text;
}

static int compare_names(gconstpointer a, gconstpointer b) {
  return strcmp(*(const char *const *)a, *(const char *const *)b);
}

char *fixture_list(const char *folder) {
  g_autoptr(GDir) directory = g_dir_open(folder, 0, NULL);
  g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
  for (const char *name; (name = g_dir_read_name(directory));) g_ptr_array_add(names, g_strdup(name));
  g_ptr_array_sort(names, compare_names);
  g_ptr_array_add(names, NULL);
  return g_strjoinv(" ", (char **)names->pdata);
}

SporeDocument *fixture_parse(const char *text) {
  GError *error = NULL;
  SporeDocument *document = spore_scene_parse(fixture_schema(), NULL, text, strlen(text), &error);
  g_assert_no_error(error);
  return document;
}

char *fixture_format(const SporeDocument *document) { return spore_scene_format(document, NULL); }
