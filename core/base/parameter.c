/* Reading, checking, storing and formatting parameters by their table. */
#include "core/base/parameter.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "core/base/memory.h"
#include "core/base/name.h"
#include "core/base/number.h"
#include "core/base/text.h"

#define LARGEST_INTEGER 9007199254740992.0 /* 2^53: every integer up to it is a double */

static bool holds_text(SporeParameterType type) { return type >= SPORE_TEXT; }

static int component_count(SporeParameterType type) { return holds_text(type) ? 0 : type == SPORE_VECTOR ? 3 : 1; }

int spore_parameter_find(const SporeParameterTable *table, const char *name) {
  for (size_t i = 0; i < table->count; i++)
    if (strcmp(table->parameters[i].name, name) == 0) return (int)i;
  return -1;
}

const char *spore_parameter_nearest(const SporeParameterTable *table, const char *name) {
  const char *nearest = NULL;
  size_t best = SIZE_MAX;
  for (size_t i = 0; i < table->count; i++) {
    size_t distance = spore_name_distance(name, table->parameters[i].name);
    if (distance < best) best = distance, nearest = table->parameters[i].name;
  }
  return nearest && spore_name_is_near(name, best) ? nearest : NULL;
}

/* Values. */

static char *copy_text(const char *text, size_t length) {
  char *copy = SPORE_NEW_ARRAY(char, length + 1);
  if (copy) memcpy(copy, text, length);
  return copy;
}

void spore_value_clear(SporeValue *value) {
  spore_free(value->text);
  *value = (SporeValue){.type = value->type};
}

bool spore_value_copy(SporeValue *to, const SporeValue *from) {
  SporeValue copy = *from;
  if (from->text && !(copy.text = copy_text(from->text, strlen(from->text)))) return false;
  *to = copy;
  return true;
}

bool spore_value_equal(const SporeValue *a, const SporeValue *b) {
  if (a->type != b->type) return false;
  if (holds_text(a->type)) return a->text && b->text ? strcmp(a->text, b->text) == 0 : a->text == b->text;
  return memcmp(a->number, b->number, (size_t)component_count(a->type) * sizeof a->number[0]) == 0;
}

bool spore_parameter_initial(const SporeParameter *parameter, SporeValue *value) {
  SporeValue initial = {.type = parameter->type};
  if (holds_text(parameter->type)) {
    if (parameter->initial_text &&
        !(initial.text = copy_text(parameter->initial_text, strlen(parameter->initial_text))))
      return false;
  } else {
    memcpy(initial.number, parameter->initial, (size_t)component_count(parameter->type) * sizeof initial.number[0]);
  }
  *value = initial;
  return true;
}

/* What is expected of a value, for messages. */

#define EXPECTATION 256

static void describe_range(const SporeParameter *parameter, char text[EXPECTATION]) {
  char low[SPORE_NUMBER_TEXT], high[SPORE_NUMBER_TEXT];
  spore_number_format(parameter->minimum, low);
  spore_number_format(parameter->maximum, high);
  const char *space = parameter->unit[0] ? " " : "";
  const char *kind = parameter->type == SPORE_VECTOR    ? _("three numbers")
                     : parameter->type == SPORE_INTEGER ? _("an integer")
                                                        : _("a number");
  bool has_low = isfinite(parameter->minimum), has_high = isfinite(parameter->maximum);
  if (has_low && has_high)
    snprintf(text, EXPECTATION, _("%s from %s to %s%s%s"), kind, low, high, space, parameter->unit);
  else if (has_low) snprintf(text, EXPECTATION, _("%s, at least %s%s%s"), kind, low, space, parameter->unit);
  else if (has_high) snprintf(text, EXPECTATION, _("%s, at most %s%s%s"), kind, high, space, parameter->unit);
  else snprintf(text, EXPECTATION, space[0] ? _("%s in %s") : "%s", kind, parameter->unit);
}

static void describe_choices(const SporeParameter *parameter, char text[EXPECTATION]) {
  size_t used = 0;
  text[0] = '\0';
  for (const char *const *choice = parameter->choices; *choice && used < EXPECTATION; choice++)
    used += (size_t)snprintf(text + used, EXPECTATION - used, "%s%s", used ? ", " : _("one of "), *choice);
}

static void describe_expectation(const SporeParameter *parameter, char text[EXPECTATION]) {
  switch (parameter->type) {
  case SPORE_REAL:
  case SPORE_INTEGER:
  case SPORE_VECTOR:
    describe_range(parameter, text);
    break;
  case SPORE_BOOLEAN:
    snprintf(text, EXPECTATION, "%s", _("true or false"));
    break;
  case SPORE_CHOICE:
    describe_choices(parameter, text);
    break;
  case SPORE_TEXT:
    snprintf(text, EXPECTATION, "%s", _("text without control characters"));
    break;
  case SPORE_FILE:
    snprintf(text, EXPECTATION, "%s", _("a relative path with / that stays inside the scene's folder"));
    break;
  case SPORE_REFERENCE:
    snprintf(text, EXPECTATION, _("the name of an object (%s)"), parameter->references ? parameter->references : "");
    break;
  case SPORE_NAME:
    snprintf(text, EXPECTATION, "%s", _("a letter or _ followed by letters, digits, _ . or -"));
    break;
  }
}

/* Always false. `given` is the value as text; `wrong`: what is the matter with it, translated. */
static bool refuse(const SporeParameter *parameter, const char *given, const char *wrong, SporeError *error) {
  char expected[EXPECTATION];
  describe_expectation(parameter, expected);
  SporeValue initial = {0};
  char text[128] = "";
  const char *remedy = _("correct the value");
  const char *nearest = parameter->type == SPORE_CHOICE ? spore_name_nearest(parameter->choices, given) : NULL;
  char advice[192];
  if (nearest) {
    snprintf(advice, sizeof advice, _("did you mean %s?"), nearest);
    remedy = advice;
  } else if (!parameter->required && spore_parameter_initial(parameter, &initial)) {
    int length = spore_parameter_format(parameter, &initial, text, sizeof text);
    spore_value_clear(&initial);
    if (length > 0 && length < (int)sizeof text) {
      snprintf(advice, sizeof advice, _("the default is %s"), text);
      remedy = advice;
    }
  }
  return spore_error_set(error, SPORE_ERROR_INPUT, NULL, _("%s=\"%.100s\" %s; expected %s; %s"), parameter->name, given,
                         wrong, expected, remedy);
}

/* Checks. */

static bool is_inside_path(const char *path) {
  if (path[0] == '\0' || path[0] == '/') return false;
  for (const char *part = path;;) {
    size_t length = strcspn(part, "/");
    if (length == 2 && part[0] == '.' && part[1] == '.') return false;
    if (memchr(part, '\\', length) || memchr(part, ':', length)) return false;
    if (part[length] == '\0') return true;
    part += length + 1;
  }
}

static bool has_control_characters(const char *text) {
  for (const unsigned char *c = (const unsigned char *)text; *c; c++)
    if ((*c < 0x20 && *c != '\t' && *c != '\n' && *c != '\r') || *c == 0x7F) return true;
  return false;
}

static bool check_text(const SporeParameter *parameter, const char *text, SporeError *error) {
  if (!text) {
    if (!parameter->required) return true;
    char expected[EXPECTATION];
    describe_expectation(parameter, expected);
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL, _("%s is missing; expected %s; set it"), parameter->name,
                           expected);
  }
  if (has_control_characters(text)) return refuse(parameter, text, _("holds control characters"), error);
  if (parameter->type == SPORE_FILE && !is_inside_path(text))
    return refuse(parameter, text, _("is not a path inside the scene's folder"), error);
  if ((parameter->type == SPORE_NAME || parameter->type == SPORE_REFERENCE) && !spore_name_is_valid(text))
    return refuse(parameter, text, _("is not a name"), error);
  return true;
}

static int choice_count(const SporeParameter *parameter) {
  int count = 0;
  while (parameter->choices[count]) count++;
  return count;
}

/* NULL: nothing is the matter; else what is, translated. */
static const char *fault_of_number(const SporeParameter *parameter, double number) {
  if (!isfinite(number)) return _("is not a finite number");
  switch (parameter->type) {
  case SPORE_INTEGER:
    if (number != floor(number)) return _("is not an integer");
    if (fabs(number) > LARGEST_INTEGER) return _("is out of range");
    break;
  case SPORE_BOOLEAN:
    return number == 0 || number == 1 ? NULL : _("is neither true nor false");
  case SPORE_CHOICE:
    return number == floor(number) && number >= 0 && number < choice_count(parameter) ? NULL : _("is not a choice");
  default:
    break;
  }
  return number < parameter->minimum || number > parameter->maximum ? _("is out of range") : NULL;
}

/* The numbers of a value as text, whatever they are. */
static void format_numbers(const double *number, int count, char *text) {
  for (int i = 0; i < count; i++) {
    if (i > 0) *text++ = ' ';
    text += spore_number_format(number[i], text);
  }
}

bool spore_parameter_check(const SporeParameter *parameter, const SporeValue *value, SporeError *error) {
  if (value->type != parameter->type)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("%s was given a value of another type; expected the parameter's own; correct the caller"),
                           parameter->name);
  if (holds_text(parameter->type)) return check_text(parameter, value->text, error);
  int count = component_count(parameter->type);
  for (int i = 0; i < count; i++) {
    const char *fault = fault_of_number(parameter, value->number[i]);
    if (!fault) continue;
    char given[3 * SPORE_NUMBER_TEXT];
    format_numbers(value->number, count, given);
    return refuse(parameter, given, fault, error);
  }
  return true;
}

/* Text. */

static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

static const char *skip_blanks(const char *text) {
  while (is_blank(*text)) text++;
  return text;
}

/* True when [text, end) without the blanks around it is exactly `word`. */
static bool is_word(const char *text, const char *word) {
  text = skip_blanks(text);
  size_t length = strlen(text);
  while (length > 0 && is_blank(text[length - 1])) length--;
  return length == strlen(word) && memcmp(text, word, length) == 0;
}

static bool parse_numbers(const char *text, int count, double *number) {
  for (int i = 0; i < count; i++) {
    const char *start = skip_blanks(text);
    if (i > 0 && start == text) return false;
    size_t length = spore_number_read(start, strlen(start), &number[i]);
    if (length == 0) return false;
    text = start + length;
  }
  return *skip_blanks(text) == '\0';
}

static bool parse_integer(const char *text, double *number) {
  for (const char *c = text; *c; c++)
    if (*c == '.' || *c == 'e' || *c == 'E') return false;
  return parse_numbers(text, 1, number);
}

static bool parse_boolean(const char *text, double *number) {
  *number = is_word(text, "true");
  return *number || is_word(text, "false");
}

static bool parse_choice(const SporeParameter *parameter, const char *text, double *number) {
  for (int i = 0; parameter->choices[i]; i++)
    if (is_word(text, parameter->choices[i])) {
      *number = i;
      return true;
    }
  return false;
}

static bool parse_text(const SporeParameter *parameter, const char *text, SporeValue *value, SporeError *error) {
  size_t length = strlen(text);
  if (parameter->type != SPORE_TEXT) { /* names and paths: the blanks around are not part of them */
    text = skip_blanks(text);
    length = strlen(text);
    while (length > 0 && is_blank(text[length - 1])) length--;
  }
  SporeValue read = {.type = parameter->type, .text = copy_text(text, length)};
  if (!read.text) return spore_error_set(error, SPORE_ERROR_MEMORY, NULL, "%s", _("not enough memory"));
  if (!check_text(parameter, read.text, error)) {
    spore_value_clear(&read);
    return false;
  }
  *value = read;
  return true;
}

bool spore_parameter_parse(const SporeParameter *parameter, const char *text, SporeValue *value, SporeError *error) {
  if (holds_text(parameter->type)) return parse_text(parameter, text, value, error);
  SporeValue read = {.type = parameter->type};
  const char *fault = NULL;
  switch (parameter->type) {
  case SPORE_INTEGER:
    fault = parse_integer(text, read.number) ? NULL : _("is not an integer");
    break;
  case SPORE_BOOLEAN:
    fault = parse_boolean(text, read.number) ? NULL : _("is neither true nor false");
    break;
  case SPORE_CHOICE:
    fault = parse_choice(parameter, text, read.number) ? NULL : _("is not known");
    break;
  case SPORE_VECTOR:
    fault = parse_numbers(text, 3, read.number) ? NULL : _("is not three numbers");
    break;
  default:
    fault = parse_numbers(text, 1, read.number) ? NULL : _("is not a number");
    break;
  }
  for (int i = 0; !fault && i < component_count(parameter->type); i++)
    fault = fault_of_number(parameter, read.number[i]);
  if (fault) return refuse(parameter, text, fault, error);
  *value = read;
  return true;
}

int spore_parameter_format(const SporeParameter *parameter, const SporeValue *value, char *text, size_t size) {
  char numbers[3 * SPORE_NUMBER_TEXT];
  switch (parameter->type) {
  case SPORE_BOOLEAN:
    return snprintf(text, size, "%s", value->number[0] != 0 ? "true" : "false");
  case SPORE_CHOICE:
    return snprintf(text, size, "%s", parameter->choices[(int)value->number[0]]);
  case SPORE_REAL:
  case SPORE_VECTOR:
    format_numbers(value->number, component_count(parameter->type), numbers);
    break;
  case SPORE_INTEGER:
    snprintf(numbers, sizeof numbers, "%.0f", value->number[0]);
    break;
  default:
    return snprintf(text, size, "%s", value->text ? value->text : "");
  }
  return snprintf(text, size, "%s", numbers);
}

/* Structures. */

SporeValue spore_parameter_load(const SporeParameter *parameter, const void *fields) {
  const unsigned char *field = (const unsigned char *)fields + parameter->offset;
  SporeValue value = {.type = parameter->type};
  switch (parameter->type) {
  case SPORE_REAL:
    memcpy(value.number, field, sizeof(double));
    break;
  case SPORE_VECTOR:
    memcpy(value.number, field, 3 * sizeof(double));
    break;
  case SPORE_INTEGER:
    value.number[0] = (double)*(const int64_t *)(const void *)field;
    break;
  case SPORE_BOOLEAN:
    value.number[0] = *(const bool *)field;
    break;
  case SPORE_CHOICE:
    value.number[0] = *(const int *)(const void *)field;
    break;
  default:
    memcpy(&value.text, field, sizeof value.text);
    break;
  }
  return value;
}

void spore_parameter_store(const SporeParameter *parameter, const SporeValue *value, void *fields) {
  unsigned char *field = (unsigned char *)fields + parameter->offset;
  switch (parameter->type) {
  case SPORE_REAL:
    memcpy(field, value->number, sizeof(double));
    break;
  case SPORE_VECTOR:
    memcpy(field, value->number, 3 * sizeof(double));
    break;
  case SPORE_INTEGER:
    *(int64_t *)(void *)field = (int64_t)value->number[0];
    break;
  case SPORE_BOOLEAN:
    *(bool *)field = value->number[0] != 0;
    break;
  case SPORE_CHOICE:
    *(int *)(void *)field = (int)value->number[0];
    break;
  default:
    memcpy(field, &value->text, sizeof value->text);
    break;
  }
}

void spore_parameters_set_initial(const SporeParameterTable *table, void *fields) {
  for (size_t i = 0; i < table->count; i++) {
    const SporeParameter *parameter = &table->parameters[i];
    SporeValue value = {.type = parameter->type};
    memcpy(value.number, parameter->initial, sizeof value.number);
    memcpy(&value.text, &parameter->initial_text, sizeof value.text);
    spore_parameter_store(parameter, &value, fields);
  }
}

bool spore_parameters_check(const SporeParameterTable *table, const void *fields, SporeError *error) {
  for (size_t i = 0; i < table->count; i++) {
    SporeValue value = spore_parameter_load(&table->parameters[i], fields);
    if (!spore_parameter_check(&table->parameters[i], &value, error)) return false;
  }
  return true;
}
