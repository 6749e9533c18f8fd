/* What the tables of the scene's elements are written with: one table a subject, joined by schema.c. */
#ifndef SPORE_SCENE_SCHEMA_TABLES_H
#define SPORE_SCENE_SCHEMA_TABLES_H

#include <glib/gi18n.h>
#include <math.h>

#include "core/scene/schema_fields.h"

#define ANY -HUGE_VAL, HUGE_VAL
#define FIELD(Type, field) .offset = offsetof(Type, field)
#define NAME(Type, text)                                                                                               \
  { .name = "name", .type = SPORE_NAME, .unit = "", FIELD(Type, name), .required = true, .doc = text }
#define POSITION_M 1e6 /* beyond it a double no longer resolves a nanometre */

#define CHILDREN(...) ((const char *const[]){__VA_ARGS__, NULL})
#define TABLE(array, Type) .parameters = array, .count = G_N_ELEMENTS(array), .size = sizeof(Type)

/* Each ends with an element of no name. */
extern const SporeElement spore_scene_elements[]; /* root first */
extern const SporeElement spore_asset_elements[];
extern const SporeElement spore_body_elements[];
extern const SporeElement spore_link_elements[];
extern const SporeElement spore_tool_elements[]; /* effects and devices, too */

#endif
