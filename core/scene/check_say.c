/* Adds diagnostics, and walks over the objects of a scene, for all checks. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/scene/check_private.h"
#include "core/scene/document_private.h"

void spore_diagnostic_free(SporeDiagnostic *diagnostic) {
  if (!diagnostic) return;
  g_free(diagnostic->place);
  g_free(diagnostic->message);
  g_free(diagnostic->remedy);
  g_free(diagnostic->properties);
  g_free(diagnostic->value);
  g_free(diagnostic);
}

static void add(SporeCheck *check, SporeSeverity severity, const SporeObject *object, char *message,
                const char *remedy) {
  SporeDiagnostic *diagnostic = g_new0(SporeDiagnostic, 1);
  diagnostic->severity = severity;
  diagnostic->object = object && object != spore_document_root(check->document) ? spore_object_id(object) : 0;
  diagnostic->place = spore_object_where(object ? object : spore_document_root(check->document));
  diagnostic->message = message;
  diagnostic->remedy = g_strdup(remedy);
  g_ptr_array_add(check->found, diagnostic);
  check->faults += severity == SPORE_FAULT;
}

void spore_check_say(SporeCheck *check, SporeSeverity severity, const SporeObject *object, const char *remedy,
                     const char *message_format, ...) {
  va_list arguments;
  va_start(arguments, message_format);
  add(check, severity, object, g_strdup_vprintf(message_format, arguments), remedy);
  va_end(arguments);
}

void spore_check_offer(SporeCheck *check, SporeFix fix) {
  g_assert(check->found->len > 0);
  SporeDiagnostic *last = check->found->pdata[check->found->len - 1];
  last->fix = fix;
  last->fixed = last->object;
}

void spore_check_offer_set(SporeCheck *check, const SporeObject *object, const char *properties, const char *value) {
  SporeDiagnostic *last = check->found->pdata[check->found->len - 1];
  last->fix = SPORE_FIX_SET;
  last->fixed = spore_object_id(object);
  last->properties = g_strdup(properties);
  last->value = g_strdup(value);
}

/* The object that a message is about, found by the place at the message's start ("FILE:LINE:COLUMN: " or "PATH: "), or
 * NULL. */
static const SporeObject *object_at(const SporeObject *object, const char *message) {
  g_autofree char *where = spore_object_where(object);
  size_t length = strlen(where);
  if (strncmp(message, where, length) == 0 && g_str_has_prefix(message + length, ": ")) return object;
  for (guint i = 0; i < spore_object_child_count(object); i++) {
    const SporeObject *found = object_at(spore_object_child(object, i), message);
    if (found) return found;
  }
  return NULL;
}

/* Whether a property of the object names a file that is not there. */
static gboolean misses_file(const SporeDocument *document, const SporeObject *object) {
  const SporeParameterTable *table = spore_object_type(object)->table;
  for (guint i = 0; i < table->count; i++)
    if (table->parameters[i].type == SPORE_FILE && spore_object_is_set(object, i) &&
        !spore_document_has_file(document, spore_object_value(object, i)->text))
      return TRUE;
  return FALSE;
}

void spore_check_say_error(SporeCheck *check, SporeSeverity severity, const SporeObject *object, const GError *error) {
  const SporeObject *said = object_at(spore_document_root(check->document), error->message);
  const char *message = error->message;
  if (said) {
    g_autofree char *where = spore_object_where(said);
    message += strlen(where) + 2;
    object = said;
  }
  const char *end = strrchr(message, ';');
  gboolean memory = g_error_matches(error, SPORE_ERROR, SPORE_ERROR_MEMORY);
  add(check, severity, object, end ? g_strndup(message, (gsize)(end - message)) : g_strdup(message),
      end      ? end + 1 + strspn(end + 1, " ")
      : memory ? _("close other programs, or use fewer or coarser meshes")
               : _("correct it"));
  if (g_error_matches(error, SPORE_ERROR, SPORE_ERROR_FILE) && object && misses_file(check->document, object))
    spore_check_offer(check, SPORE_FIX_LOCATE);
}

void spore_check_each(SporeCheck *check, const char *section, const char *element, SporeCheckVisit visit) {
  const SporeObject *above = spore_document_section(check->document, section);
  for (guint i = 0; i < spore_object_child_count(above); i++) {
    SporeObject *object = spore_object_child(above, i);
    if (!element || strcmp(spore_object_type(object)->element, element) == 0) visit(check, object);
  }
}

gboolean spore_check_is_used(const SporeCheck *check, const SporeObject *object, const char *elements) {
  const GPtrArray *users = g_hash_table_lookup(check->users, object);
  for (guint i = 0; users && i < users->len; i++)
    if (!elements || spore_element_in_list(elements, spore_object_type(users->pdata[i])->element)) return TRUE;
  return FALSE;
}
