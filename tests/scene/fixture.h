/* What the tests of scenes share: a schema with a model of their own, and folders to work in. */
#ifndef SPORE_TESTS_SCENE_FIXTURE_H
#define SPORE_TESTS_SCENE_FIXTURE_H

#include "core/io/scene_xml.h"

/* A schema whose one model, `particle`, has a parameter of each type that holds a value. */
const SporeSchema *fixture_schema(void);

/* The schema of the program's own models. */
const SporeSchema *fixture_model_schema(void);
/* A folder with cube.off (closed, 0.1 m), open.off (a side missing), large.off (173 m across), wide.off (closed,
 * a corner at four of the corners of a cube of 0.2 m), sheet.off (flat, 0.1 m), cube.mesh (five tetrahedra),
 * ball.spheres (one of 0.05 m), felt.spheres (one of 0.1 m, with a weight and a level, felt to 0.05 m), away.spheres
 * (two, one of them 0.3 m off), and scene.spore with the text; and that scene, which must be good. */
char *fixture_scene_folder_new(const char *scene);
SporeDocument *fixture_load(const char *folder);
/* Such a folder and its scene. */
typedef struct FixtureScene {
  char *folder;
  SporeDocument *document;
} FixtureScene;
FixtureScene fixture_scene_new(const char *text);
void fixture_scene_free(FixtureScene *scene);

/* A new folder; removed with everything in it. */
char *fixture_folder_new(void);
void fixture_folder_free(char *folder);
/* Writes a file of the folder, making folders on the way; gives its path (g_free). */
char *fixture_write(const char *folder, const char *name, const char *text);
char *fixture_read(const char *folder, const char *name);
/* Names in the folder, sorted, joined by blanks (g_free). */
char *fixture_list(const char *folder);

/* A scene of the text, which must be good. */
SporeDocument *fixture_parse(const char *text);
char *fixture_format(const SporeDocument *document);
#define fixture_assert_error(error, code_, part)                                                                       \
  do {                                                                                                                 \
    g_assert_error(error, SPORE_ERROR, code_);                                                                         \
    if (!strstr((error)->message, part)) g_error("\"%s\" does not say \"%s\"", (error)->message, part);                \
    g_clear_error(&(error));                                                                                           \
  } while (0)

#endif
