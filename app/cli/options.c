/* Options of a generator: read from the command line and described in its help by the generator's table. */
#include "app/cli/options.h"

#include <glib/gi18n.h>
#include <math.h>
#include <string.h>

#include "core/scene/schema_fields.h"

#define HELP_VALUE 64

/* Spellings that scene files do not use. They are refused with the word of the scene file. */
static const struct {
  const char *command, *old, *new;
} renamed[] = {
    {"spheres", "--mode", "--method"},
    {"surface", "--detail", "--wall-detail"},
    {"centreline", "--ends", "--first-place X,Y,Z --last-place X,Y,Z"},
};

/* What the parser needs besides the options. */
typedef struct Parsing {
  SporeCliOptions *options;
  const char *letters;
  GArray *entries;  /* of GOptionEntry */
  GPtrArray *texts; /* that the entries point to */
} Parsing;

static const SporeElement *region_of(const SporeGeneratorType *type) {
  return type->elements && type->elements[0].element ? type->elements + 1 : NULL;
}

/* "--depth-error" of "depth_error". g_free. */
static char *option_of(const char *name) {
  char *option = g_strdup_printf("--%s", name);
  return g_strdelimit(option, "_", '-');
}

/* The letter of a parameter; 0: none. */
static char letter_of(const char *letters, const char *name) {
  g_auto(GStrv) pairs = g_strsplit(letters, " ", -1);
  for (char **pair = pairs; *pair; pair++)
    if (**pair && (*pair)[1] == '=' && strcmp(*pair + 2, name) == 0) return **pair;
  return 0;
}

static gboolean is_option(const Parsing *parsing, const SporeParameter *parameter, const char *option) {
  char letter = letter_of(parsing->letters, parameter->name);
  g_autofree char *name = option_of(parameter->name);
  return letter && option[1] == letter && option[2] == '\0' ? TRUE : strcmp(option, name) == 0;
}

/* Values. */

static gboolean refuse(const char *option, SporeError *fault, GError **error) {
  g_set_error(error, G_OPTION_ERROR, G_OPTION_ERROR_BAD_VALUE, "%s: %s", option, fault->message);
  return FALSE;
}

/* A place is written with commas on the command line, and with blanks in a file. */
static gboolean read_value(const SporeParameter *parameter, const char *option, const char *text, SporeValue *value,
                           GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  g_autofree char *plain = g_strdup(text);
  if (parameter->type == SPORE_VECTOR) g_strdelimit(plain, ",", ' ');
  return spore_parameter_parse(parameter, plain, value, &fault) || refuse(option, &fault, error);
}

static gboolean take_option(const char *option, const char *text, gpointer data, GError **error) {
  Parsing *parsing = data;
  SporeCliOptions *options = parsing->options;
  for (size_t i = 0; i < options->table.count; i++) {
    const SporeParameter *parameter = &options->table.parameters[i];
    if (!spore_generator_takes(options->type, parameter) || !is_option(parsing, parameter, option)) continue;
    options->given[i] = TRUE;
    return read_value(parameter, option, text ? text : "true", &options->values[i], error);
  }
  g_assert_not_reached();
}

static gboolean take_purpose(const char *option, const char *text, gpointer data, GError **error) {
  Parsing *parsing = data;
  SporeValue value = {0};
  if (!read_value(parsing->options->type->purpose, "--as", text, &value, error)) return FALSE;
  parsing->options->purpose = (int)value.number[0];
  return TRUE;
}

/* X,Y,Z,RADIUS,VALUE. The value is the last parameter of the region's table. */
static gboolean take_region(const char *option, const char *text, gpointer data, GError **error) {
  Parsing *parsing = data;
  const SporeElement *element = region_of(parsing->options->type);
  g_auto(GStrv) words = g_strsplit(text, ",", -1);
  SporeValue value = {0};
  SporeGenerateRegion region = {.region = parsing->options->regions->len};
  if (g_strv_length(words) != 5) {
    g_autofree char *last = g_ascii_strup(element->parameters[element->count - 1].name, -1);
    g_set_error(error, G_OPTION_ERROR, G_OPTION_ERROR_BAD_VALUE,
                _("--region \"%s\" is no region; expected X,Y,Z,RADIUS,%s with lengths in metres, such as "
                  "0,0.02,0,0.01,4; correct it"),
                text, last);
    return FALSE;
  }
  g_autofree char *centre = g_strjoin(" ", words[0], words[1], words[2], NULL);
  const char *const texts[] = {centre, words[3], words[4]};
  double *const places[] = {region.centre, &region.radius, &region.value};
  for (gsize i = 0; i < G_N_ELEMENTS(texts); i++) {
    const SporeParameter *parameter = &element->parameters[element->count - 3 + i];
    if (!read_value(parameter, "--region", texts[i], &value, error)) return FALSE;
    memcpy(places[i], value.number, (i == 0 ? 3 : 1) * sizeof(double));
  }
  g_array_append_val(parsing->options->regions, region);
  return TRUE;
}

/* Help. */

static const char *keep(Parsing *parsing, char *text) {
  g_ptr_array_add(parsing->texts, text);
  return text;
}

/* What help shows for the value: its choices, or the unit of its number. */
static const char *value_name(Parsing *parsing, const SporeParameter *parameter) {
  if (parameter->type == SPORE_BOOLEAN) return NULL;
  if (parameter->type == SPORE_CHOICE) return keep(parsing, g_strjoinv("|", (char **)parameter->choices));
  if (parameter->type == SPORE_VECTOR) return "X,Y,Z";
  if (parameter->type == SPORE_INTEGER) return "N";
  return *parameter->unit ? keep(parsing, g_ascii_strup(parameter->unit, -1)) : "X";
}

/* The words of the table, and the default, unless the default belongs to another way. */
static const char *description(Parsing *parsing, const SporeParameter *parameter) {
  SporeValue initial = {0};
  char text[HELP_VALUE];
  gboolean plain = parameter->type == SPORE_BOOLEAN || parameter->type == SPORE_VECTOR;
  if (plain || spore_generator_way(parsing->options->type, parameter->name) >= 0 ||
      !spore_parameter_initial(parameter, &initial))
    return parameter->doc;
  spore_parameter_format(parameter, &initial, text, sizeof text);
  return keep(parsing, g_strdup_printf(_("%s Default: %s."), _(parameter->doc), text));
}

static void add_entry(Parsing *parsing, const SporeParameter *parameter) {
  g_autofree char *option = option_of(parameter->name);
  const GOptionEntry entry = {
      .long_name = keep(parsing, g_strdup(option + 2)),
      .short_name = letter_of(parsing->letters, parameter->name),
      .flags = parameter->type == SPORE_BOOLEAN ? G_OPTION_FLAG_NO_ARG : G_OPTION_FLAG_NONE,
      .arg = G_OPTION_ARG_CALLBACK,
      .arg_data = (gpointer)take_option,
      .description = description(parsing, parameter),
      .arg_description = value_name(parsing, parameter),
  };
  g_array_append_val(parsing->entries, entry);
}

static void add_region_entry(Parsing *parsing, const SporeElement *region) {
  const SporeParameter *last = &region->parameters[region->count - 1];
  g_autofree char *name = g_ascii_strup(last->name, -1);
  const GOptionEntry entry = {
      .long_name = "region",
      .short_name = 'r',
      .arg = G_OPTION_ARG_CALLBACK,
      .arg_data = (gpointer)take_region,
      .description = keep(parsing, g_strdup_printf(_("In the ball about X,Y,Z, lengths in metres; may be given several "
                                                     "times. %s: %s"),
                                                   name, _(last->doc))),
      .arg_description = keep(parsing, g_strdup_printf("X,Y,Z,RADIUS,%s", name)),
  };
  g_array_append_val(parsing->entries, entry);
}

static void add_purpose_entry(Parsing *parsing, const SporeParameter *purpose) {
  const GOptionEntry entry = {
      .long_name = "as",
      .short_name = 'a',
      .arg = G_OPTION_ARG_CALLBACK,
      .arg_data = (gpointer)take_purpose,
      .description = purpose->doc,
      .arg_description = keep(parsing, g_strjoinv("|", (char **)purpose->choices)),
  };
  g_array_append_val(parsing->entries, entry);
}

static void add_entries(Parsing *parsing, const GOptionEntry *more) {
  const SporeCliOptions *options = parsing->options;
  for (size_t i = 0; i < options->table.count; i++)
    if (spore_generator_takes(options->type, &options->table.parameters[i]))
      add_entry(parsing, &options->table.parameters[i]);
  const SporeElement *region = region_of(options->type);
  if (region && region->element) add_region_entry(parsing, region);
  if (options->type->purpose) add_purpose_entry(parsing, options->type->purpose);
  for (; more->long_name; more++) g_array_append_val(parsing->entries, *more);
}

/* Reading. */

static int refuse_renamed(const char *command, int argc, char **argv) {
  for (int i = 1; i < argc; i++)
    for (gsize k = 0; k < G_N_ELEMENTS(renamed); k++) {
      gsize length = strlen(renamed[k].old);
      if (strcmp(command, renamed[k].command) == 0 && strncmp(argv[i], renamed[k].old, length) == 0 &&
          (argv[i][length] == '\0' || argv[i][length] == '='))
        return spore_cli_usage(_("spore %s: %s is spelled %s, as in scene files; write that; see `spore %s --help`"),
                               command, renamed[k].old, renamed[k].new, command);
    }
  return SPORE_EXIT_DONE;
}

/* Given with a value other than 0; 0 asks for nothing. */
static gboolean is_asked(const SporeCliOptions *options, size_t i) {
  return options->given[i] && options->values[i].number[0] != 0;
}

/* Two ways exclude each other. */
static int check_ways(const SporeCliOptions *options, const char *command) {
  const SporeParameter *first = NULL;
  for (size_t i = 0; i < options->table.count; i++) {
    const SporeParameter *parameter = &options->table.parameters[i];
    int way = is_asked(options, i) ? spore_generator_way(options->type, parameter->name) : -1;
    if (way < 0) continue;
    if (!first) first = parameter;
    if (way == spore_generator_way(options->type, first->name)) continue;
    g_autofree char *one = option_of(first->name), *other = option_of(parameter->name);
    return spore_cli_usage(_("spore %s: %s and %s are two ways to say how fine the result shall be; expected one; "
                             "give one of them"),
                           command, one, other);
  }
  return SPORE_EXIT_DONE;
}

int spore_cli_options_parse(SporeCliOptions *options, SporeCli *cli, const SporeGeneratorType *type,
                            const char *letters, const SporeCommandInfo *info, const GOptionEntry *more, int *argc,
                            char ***argv) {
  SporeParameterTable table = spore_generator_table(type);
  *options = (SporeCliOptions){.type = type,
                               .table = table,
                               .given = g_new0(gboolean, table.count),
                               .values = g_new0(SporeValue, table.count),
                               .purpose = -1,
                               .regions = g_array_new(FALSE, FALSE, sizeof(SporeGenerateRegion))};
  Parsing parsing = {options, letters, g_array_new(TRUE, TRUE, sizeof(GOptionEntry)),
                     g_ptr_array_new_with_free_func(g_free)};
  add_entries(&parsing, more);
  int status = refuse_renamed(info->name, *argc, *argv);
  if (status == SPORE_EXIT_DONE)
    status =
        spore_cli_parse_with(cli, info, (const GOptionEntry *)(gpointer)parsing.entries->data, &parsing, argc, argv);
  if (status == SPORE_EXIT_DONE) status = check_ways(options, info->name);
  g_array_unref(parsing.entries);
  g_ptr_array_unref(parsing.texts);
  return status;
}

void spore_cli_options_clear(SporeCliOptions *options) {
  for (size_t i = 0; options->values && i < options->table.count; i++)
    if (options->given[i]) spore_value_clear(&options->values[i]);
  g_clear_pointer(&options->given, g_free);
  g_clear_pointer(&options->values, g_free);
  g_clear_pointer(&options->regions, g_array_unref);
}

gboolean spore_cli_options_has(const SporeCliOptions *options, const char *name) {
  return options->given[spore_parameter_find(&options->table, name)];
}

double spore_cli_options_number(const SporeCliOptions *options, const char *name) {
  int place = spore_parameter_find(&options->table, name);
  return options->given[place] ? options->values[place].number[0] : 0;
}

int spore_cli_options_way(const SporeCliOptions *options) {
  for (size_t i = 0; i < options->table.count; i++) {
    int way = is_asked(options, i) ? spore_generator_way(options->type, options->table.parameters[i].name) : -1;
    if (way >= 0) return way;
  }
  return -1;
}

char *spore_cli_options_ways(const SporeCliOptions *options) {
  GString *text = g_string_new(NULL);
  for (size_t i = 0; i < options->table.count; i++) {
    if (spore_generator_way(options->type, options->table.parameters[i].name) < 0) continue;
    g_autofree char *option = option_of(options->table.parameters[i].name);
    g_string_append_printf(text, text->len ? ", %s" : "%s", option);
  }
  return g_string_free(text, FALSE);
}

void spore_cli_options_fill(const SporeCliOptions *options, void *fields) {
  int way = spore_cli_options_way(options);
  if (way >= 0) {
    for (size_t i = 0; i < options->table.count; i++) { /* the other options of that way are dropped too */
      const SporeParameter *parameter = &options->table.parameters[i];
      const SporeValue nothing = {.type = parameter->type};
      if (spore_generator_way(options->type, parameter->name) == way && !(parameter->minimum > 0))
        spore_parameter_store(parameter, &nothing, fields);
    }
    spore_generator_choose_way(options->type, way, fields);
  }
  for (size_t i = 0; i < options->table.count; i++)
    if (options->given[i]) spore_parameter_store(&options->table.parameters[i], &options->values[i], fields);
}

char *spore_cli_options_foreign(const SporeCliOptions *options, const SporeGeneratorType *other) {
  for (size_t i = 0; i < options->table.count; i++)
    if (options->given[i] && !spore_generator_takes(other, &options->table.parameters[i]))
      return option_of(options->table.parameters[i].name);
  return options->regions->len ? g_strdup("--region") : NULL;
}
