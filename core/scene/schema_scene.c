/* Parameter tables of the scene's root and of its sections: metadata, units, environment, solver and defaults. */
#include "core/scene/length_unit.h"
#include "core/scene/schema_tables.h"

static const SporeParameter root_parameters[] = {
    {.name = "version",
     .type = SPORE_TEXT,
     .unit = "",
     .initial_text = "1.0",
     FIELD(SporeRootFields, version),
     .required = true,
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Version of the file format, major.minor.")},
};

static const SporeParameter meta_parameters[] = {
    {.name = "title",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, title),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("What the scene is called.")},
    {.name = "author",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, author),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Who made the scene.")},
    {.name = "description",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, description),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("What the scene shows and where its data come from.")},
    {.name = "licence",
     .type = SPORE_TEXT,
     .unit = "",
     FIELD(SporeMetaFields, licence),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Terms under which the scene may be used.")},
};

static const SporeParameter units_parameters[] = {
    {.name = "length",
     .type = SPORE_CHOICE,
     .unit = "",
     ANY,
     .initial = {2},
     .choices = spore_length_units,
     FIELD(SporeUnitsFields, length),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Unit in which lengths are shown to people; the file itself is always in metres.")},
};

static const SporeParameter environment_parameters[] = {
    {.name = "gravity",
     .type = SPORE_VECTOR,
     .unit = "m/s^2",
     -1000,
     1000,
     .initial = {0, -9.81, 0},
     FIELD(SporeEnvironmentFields, gravity),
     .change = SPORE_CHANGE_LIVE,
     .doc = N_("Acceleration of free fall; y points up.")},
};

const SporeElement spore_scene_elements[] = {
    {"spore", N_("Scene"), N_("A scene: bodies, how they meet, and the tools that touch them."),
     TABLE(root_parameters, SporeRootFields), .ordered = TRUE,
     .children = CHILDREN("meta", "units", "environment", "solver", "defaults", "assets", "bodies", "links", "effects",
                          "tools", "devices", "exercise")},
    {"meta", N_("About"), N_("What the scene is and whose it is."), TABLE(meta_parameters, SporeMetaFields)},
    {"units", N_("Units"), N_("How quantities are shown to people."), TABLE(units_parameters, SporeUnitsFields)},
    {"environment", N_("Environment"), N_("What acts on every body."),
     TABLE(environment_parameters, SporeEnvironmentFields)},
    {"solver", N_("Solver"), N_("How the scene is moved forward in time."), .extra = &spore_solver_parameters,
     .size = sizeof(SporeSolverFields)},
    {"defaults", N_("Defaults"), N_("What objects start from."), .children = CHILDREN("contact"), .ordered = TRUE},
    {"assets", N_("Assets"), N_("Files that the scene is made from.")}, /* children: of the generators */
    {"contact", N_("Contact"), N_("Contact law of every body that does not set its own."),
     .extra = &spore_contact_parameters, .size = sizeof(SporeContactFields)},
    {NULL},
};
