/* Macros for the tables of the scene's elements. Each subject has one table; schema.c joins the tables. */
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

/* The rows by which generated data remember how they were made (generated.h). The other parameters of their element are
 * options of the generator. */
#define GENERATED(Type)                                                                                                \
  {.name = "source_hash",                                                                                              \
   .type = SPORE_TEXT,                                                                                                 \
   .unit = "",                                                                                                         \
   FIELD(Type, source_hash),                                                                                           \
   .change = SPORE_CHANGE_LIVE,                                                                                        \
   .doc = N_("Hash of the source's content at the time of generation; when it differs, the data are stale.")},         \
      {.name = "options_hash",                                                                                         \
       .type = SPORE_TEXT,                                                                                             \
       .unit = "",                                                                                                     \
       FIELD(Type, options_hash),                                                                                      \
       .change = SPORE_CHANGE_LIVE,                                                                                    \
       .doc = N_("Hash of the options at the time of generation; when it differs, the data are stale.")},              \
      {.name = "frozen",                                                                                               \
       .type = SPORE_BOOLEAN,                                                                                          \
       .unit = "",                                                                                                     \
       FIELD(Type, frozen),                                                                                            \
       .change = SPORE_CHANGE_LIVE,                                                                                    \
       .doc =                                                                                                          \
           N_("Whether the data stay as they are, whatever becomes of their source: nothing generates them anew.")},   \
  {                                                                                                                    \
    .name = "edited", .type = SPORE_BOOLEAN, .unit = "", FIELD(Type, edited), .change = SPORE_CHANGE_LIVE,             \
    .doc = N_("Whether the data were edited by hand since they were generated.")                                       \
  }

/* The rows by which an element that has two forms remembers what was advised. */
#define SPORE_ADVICES ((const char *const[]){"physical", "effect", NULL})
#define SPORE_ADVICE_ROWS(advice_doc, hash_doc)                                                                        \
  {.name = "advice",                                                                                                   \
   .type = SPORE_CHOICE,                                                                                               \
   .unit = "",                                                                                                         \
   ANY,                                                                                                                \
   .initial = {SPORE_FIDELITY_PHYSICAL},                                                                               \
   .choices = SPORE_ADVICES,                                                                                           \
   FIELD(SporeFidelityFields, advice),                                                                                 \
   .change = SPORE_CHANGE_LIVE,                                                                                        \
   .doc = advice_doc},                                                                                                 \
  {                                                                                                                    \
    .name = "advice_hash", .type = SPORE_TEXT, .unit = "", FIELD(SporeFidelityFields, advice_hash),                    \
    .change = SPORE_CHANGE_LIVE, .doc = hash_doc                                                                       \
  }

/* The rows of a ball in which a generator has a setting of its own. */
#define BALL(Type)                                                                                                     \
  NAME(Type, N_("Name of the region.")),                                                                               \
      {.name = "centre",                                                                                               \
       .type = SPORE_VECTOR,                                                                                           \
       .unit = "m",                                                                                                    \
       -POSITION_M,                                                                                                    \
       POSITION_M,                                                                                                     \
       FIELD(Type, centre),                                                                                            \
       .change = SPORE_CHANGE_LIVE,                                                                                    \
       .doc = N_("Middle of the region, in the axes of the mesh.")},                                                   \
  {                                                                                                                    \
    .name = "radius", .type = SPORE_REAL, .unit = "m", 1e-6, POSITION_M, .initial = {0.01}, FIELD(Type, radius),       \
    .change = SPORE_CHANGE_LIVE, .doc = N_("Radius of the region.")                                                    \
  }

/* Each ends with an element of no name. */
extern const SporeElement spore_scene_elements[]; /* root first */
extern const SporeElement spore_body_elements[];
extern const SporeElement spore_link_elements[];
extern const SporeElement spore_tool_elements[]; /* effects and devices, too */

#endif
