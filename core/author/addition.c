/* Adds objects by path. */
#include "core/author/addition.h"

#include <glib/gi18n.h>
#include <string.h>

#include "core/author/edits.h"

static gboolean is_nameable(const SporeObjectType *type) {
  return type->table->count > 0 && type->table->parameters[0].type == SPORE_NAME;
}

/* Elements that the parent may hold, with the text between them. */
static char *elements_of(const SporeObjectType *parent, const char *between) {
  g_autoptr(GString) list = g_string_new(NULL);
  for (guint i = 0; parent->children && i < parent->children->len; i++) {
    const SporeObjectType *child = parent->children->pdata[i];
    g_string_append_printf(list, list->len ? "%s%s" : "%.0s%s", between, child->element);
  }
  return g_strdup(list->str);
}

static gboolean refuse_element(const SporeObject *parent, const char *element, GError **error) {
  const SporeObjectType *type = spore_object_type(parent);
  g_autofree char *list = elements_of(type, ", "), *path = spore_object_path(parent);
  const char *near = spore_object_type_nearest_child(type, element);
  if (!*list)
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, _("nothing can be added here; add to what holds it"));
  if (!near)
    return spore_error_raise(error, SPORE_ERROR_INPUT, path, _("no <%s> can be added here; expected one of: %s"),
                             element, list);
  return spore_error_raise(error, SPORE_ERROR_INPUT, path,
                           _("no <%s> can be added here; expected one of: %s; did you mean %s?"), element, list, near);
}

static SporeObject *insert(SporeDocument *document, SporeObject *parent, const char *element, const char *name,
                           GError **error) {
  const SporeObjectType *type = spore_object_type_child(spore_object_type(parent), element);
  if (!type) {
    refuse_element(parent, element, error);
    return NULL;
  }
  g_autofree char *path = spore_object_path(parent);
  if (name && !is_nameable(type)) {
    spore_error_raise(error, SPORE_ERROR_INPUT, path, _("<%s> has no name; add it without \":%s\""), element, name);
    return NULL;
  }
  if (type->model && spore_object_type(parent)->single_child) {
    SporeObject *body = spore_object_parent(parent);
    return spore_edit_set_model(document, body, element, error) ? spore_object_child_of(parent, element) : NULL;
  }
  if (spore_object_type(parent)->ordered && spore_object_child_of(parent, element)) {
    spore_error_raise(error, SPORE_ERROR_INPUT, path, _("there is one <%s> here already; change it by --set"), element);
    return NULL;
  }
  return spore_document_insert(document, parent, element, name, G_MAXUINT, error);
}

SporeObject *spore_edit_add(SporeDocument *document, const char *path, GError **error) {
  const char *slash = strrchr(path, '/');
  if (!slash || slash == path || !slash[1]) {
    spore_error_raise(error, SPORE_ERROR_INPUT, path,
                      _("this does not say where to add what; expected PLACE/ELEMENT:NAME, such as links/spring:cord"));
    return NULL;
  }
  g_autofree char *place = g_strndup(path, (gsize)(slash - path)), *element = g_strdup(slash + 1);
  char *name = strchr(element, ':');
  if (name) *name++ = '\0';
  spore_document_begin(document, _("Add"));
  SporeObject *parent = spore_edit_object_or_unit(document, place, NULL);
  if (!parent)
    spore_error_raise(error, SPORE_ERROR_INPUT, path,
                      _("there is no \"%s\" to add to; correct the name, or add it first"), place);
  SporeObject *added = parent ? insert(document, parent, element, name && *name ? name : NULL, error) : NULL;
  return spore_edit_finish(document, added != NULL) ? added : NULL;
}

/* The type of the object of that path; or of the unit that a body would have there. NULL: neither. */
static const SporeObjectType *type_of_place(SporeDocument *document, const char *path) {
  const SporeObject *object = spore_document_by_path(document, path);
  const char *slash = strrchr(path, '/');
  if (object) return spore_object_type(object);
  if (!slash) return NULL;
  g_autofree char *above = g_strndup(path, (gsize)(slash - path));
  const SporeObject *parent = spore_document_by_path(document, above);
  return parent ? spore_object_type_child(spore_object_type(parent), slash + 1) : NULL;
}

char *spore_edit_addition_for(SporeDocument *document, const char *path) {
  const char *slash = strrchr(path, '/');
  if (!slash || !slash[1]) return NULL;
  g_autofree char *place = g_strndup(path, (gsize)(slash - path));
  const SporeObjectType *type = type_of_place(document, place);
  if (!type) return spore_edit_addition_for(document, place);
  if (spore_object_type_child(type, slash + 1)) return g_strdup(path);
  if (!type->children || type->children->len == 0 || !is_nameable(type->children->pdata[0])) return NULL;
  g_autofree char *list = elements_of(type, "|");
  return g_strdup_printf("%s/%s:%s", place, list, slash + 1);
}
