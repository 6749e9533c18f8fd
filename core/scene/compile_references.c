/* Resolves references of a scene to objects and bodies, and reports references that name nothing. */
#include "core/scene/compile_private.h"

#include <glib/gi18n.h>

#include "core/base/name.h"

gpointer spore_compiler_keep(SporeCompiler *compiler, gsize size) {
  gpointer memory = g_malloc0(MAX(size, 1));
  g_ptr_array_add(compiler->kept, memory);
  return memory;
}

gboolean spore_compiler_refuse(SporeCompiler *compiler, const SporeObject *object, const char *format, ...) {
  va_list arguments;
  va_start(arguments, format);
  g_autofree char *message = g_strdup_vprintf(format, arguments);
  va_end(arguments);
  g_autofree char *where = spore_object_where(object);
  return spore_error_raise(compiler->error, SPORE_ERROR_INPUT, where, "%s", message);
}

gboolean spore_compiler_pass_on(SporeCompiler *compiler, const SporeObject *object, const SporeError *fault) {
  g_autofree char *where = spore_object_where(object);
  return spore_error_raise(compiler->error, fault->code, where, "%s%s%s", fault->place, *fault->place ? ": " : "",
                           fault->message);
}

gboolean spore_compiler_say_in_scene(SporeCompiler *compiler, const SporeError *fault) {
  SporeObject *object = *fault->place ? spore_document_by_path(compiler->document, fault->place) : NULL;
  if (!object) return spore_error_propagate(fault, compiler->error);
  g_autofree char *where = spore_object_where(object);
  return spore_error_raise(compiler->error, fault->code, where, "%s", fault->message);
}

/* Nearest name among the objects that a reference may name, or NULL. */
static const char *nearest_name(const SporeDocument *document, const char *elements, const char *name) {
  g_autoptr(GPtrArray) names = g_ptr_array_new();
  const SporeObject *root = spore_document_root(document);
  for (guint s = 0; s < spore_object_child_count(root); s++) {
    const SporeObject *section = spore_object_child(root, s);
    for (guint i = 0; i < spore_object_child_count(section); i++) {
      const char *other = spore_object_name(spore_object_child(section, i));
      if (other && spore_document_find(document, elements, other)) g_ptr_array_add(names, (gpointer)other);
    }
  }
  g_ptr_array_add(names, NULL);
  return spore_name_nearest((const char *const *)names->pdata, name);
}

gboolean spore_compiler_resolve(SporeCompiler *compiler, const SporeObject *object, const char *property,
                                SporeObject **target) {
  const char *name = spore_object_text(object, property);
  *target = spore_object_reference(object, property);
  if (!name || *target) return TRUE;
  int index = spore_parameter_find(spore_object_type(object)->table, property);
  const char *elements = spore_object_type(object)->table->parameters[index].references;
  const char *nearest = nearest_name(compiler->document, elements, name);
  if (nearest)
    return spore_compiler_refuse(compiler, object,
                                 _("%s=\"%s\" names nothing; expected the name of a <%s>; did you mean \"%s\"?"),
                                 property, name, elements, nearest);
  return spore_compiler_refuse(compiler, object,
                               _("%s=\"%s\" names nothing; expected the name of a <%s>; add one or correct the name"),
                               property, name, elements);
}

gboolean spore_compiler_body_index(SporeCompiler *compiler, const SporeObject *object, const char *property,
                                   guint32 *index) {
  SporeObject *body;
  *index = SPORE_NO_BODY;
  if (!spore_compiler_resolve(compiler, object, property, &body)) return FALSE;
  guint found;
  if (body && g_ptr_array_find(compiler->objects, body, &found)) *index = found;
  return TRUE;
}
