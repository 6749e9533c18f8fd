#include "fixture.h"

#include <ftw.h>
#include <glib/gstdio.h>
#include <stdio.h>
#include <string.h>

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
  if (!schema) schema = spore_schema_new(registry);
  return schema;
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
