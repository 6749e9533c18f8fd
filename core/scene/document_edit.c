/* The commands of a document: each checks its arguments, then makes edits. */
#include <glib/gi18n.h>
#include <string.h>

#include "core/base/name.h"
#include "core/scene/document_private.h"

static gboolean refuse(const SporeObject *object, SporeError *from, GError **error) {
  g_autofree char *path = spore_object_path(object);
  spore_error_at(from, path);
  return spore_error_propagate(from, error);
}

static gboolean is_section(const SporeObject *object) { return object->parent && !object->parent->parent; }

static SporeObject *sibling_of_name(const SporeObject *parent, const SporeObject *apart, const char *name) {
  for (guint i = 0; i < parent->children->len; i++) {
    SporeObject *child = spore_object_child(parent, i);
    if (child != apart && g_strcmp0(spore_object_name(child), name) == 0) return child;
  }
  return NULL;
}

/* A command is an undo step of its own, or part of the open group. It opens no nested group, so that its edits merge
 * with earlier edits of the group. */
static gboolean open_step(SporeDocument *document, const char *label) {
  if (document->marks->len > 0) return FALSE;
  spore_document_begin(document, label);
  return TRUE;
}

static void close_step(SporeDocument *document, gboolean opened) {
  if (opened) spore_document_end(document);
}

/* Properties. */

/* The position of a newly set property in the author's order: behind the set properties that precede it in the table.
 */
static guint natural_position(const SporeObject *object, guint property) {
  guint position = 0;
  for (guint i = 0; i < object->order->len; i++)
    if (g_array_index(object->order, guint, i) < property) position = i + 1;
  return position;
}

/* Takes over `value`. */
static void edit_property(SporeObject *object, guint property, SporeValue *value) {
  const SporeSlot *slot = &object->slots[property];
  SporeEdit edit = {.kind = SPORE_EDIT_SET, .object = object, .property = property, .slot.set = value != NULL};
  if (value) {
    edit.slot.value = *value;
    edit.slot.on_new_line = slot->on_new_line;
    for (guint i = 0; slot->set && i < object->order->len; i++)
      if (g_array_index(object->order, guint, i) == property) edit.slot.position = i;
    if (!slot->set) edit.slot.position = natural_position(object, property);
  } else {
    edit.slot.value.type = object->type->table->parameters[property].type;
  }
  spore_document_edit(object->document, &edit);
}

static gboolean copy_value(const SporeObject *object, const SporeValue *value, SporeValue *copy, GError **error) {
  if (spore_value_copy(copy, value)) return TRUE;
  SporeError memory = SPORE_ERROR_INIT;
  spore_error_set(&memory, SPORE_ERROR_MEMORY, NULL, "%s",
                  _("not enough memory; nothing was changed; close something"));
  return refuse(object, &memory, error);
}

static gboolean set_value(SporeObject *object, guint property, const SporeValue *value, GError **error) {
  const SporeSlot *slot = &object->slots[property];
  if (slot->set && spore_value_equal(&slot->value, value)) return TRUE;
  SporeValue copy;
  if (!copy_value(object, value, &copy, error)) return FALSE;
  const char *name = object->type->table->parameters[property].name;
  g_autofree char *label = g_strdup_printf(_("Change %s"), name);
  gboolean opened = open_step(object->document, label);
  edit_property(object, property, &copy);
  close_step(object->document, opened);
  return TRUE;
}

/* Whether XML can hold the text: valid UTF-8, without the two codes that are no characters, U+FFFE and U+FFFF. */
static gboolean is_xml_text(const char *text) {
  return g_utf8_validate(text, -1, NULL) && !strstr(text, "\xEF\xBF\xBE") && !strstr(text, "\xEF\xBF\xBF");
}

gboolean spore_document_set(SporeDocument *document, SporeObject *object, guint property, const SporeValue *value,
                            GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  const SporeParameter *parameter = &object->type->table->parameters[property];
  if (!spore_parameter_check(parameter, value, &fault)) return refuse(object, &fault, error);
  if (value->text && !is_xml_text(value->text)) {
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL, _("%s is not UTF-8 text; expected that; correct it"),
                    parameter->name);
    return refuse(object, &fault, error);
  }
  if (object == document->root && !spore_format_version_check(value->text, &fault))
    return refuse(object, &fault, error);
  if (parameter->type == SPORE_NAME) return spore_document_rename(document, object, value->text, error);
  return set_value(object, property, value, error);
}

/* Path of the first property of that name in the objects below; NULL: there is none. g_free. */
static char *property_below(const SporeObject *object, const char *property) {
  for (guint i = 0; i < object->children->len; i++) {
    const SporeObject *child = spore_object_child(object, i);
    g_autofree char *path = spore_object_path(child);
    if (spore_parameter_find(child->type->table, property) >= 0) return g_strdup_printf("%s/%s", path, property);
    char *below = property_below(child, property);
    if (below) return below;
  }
  return NULL;
}

static int find_property(const SporeObject *object, const char *property, GError **error) {
  int index = spore_parameter_find(object->type->table, property);
  if (index >= 0) return index;
  SporeError fault = SPORE_ERROR_INIT;
  g_autofree char *below = property_below(object, property);
  const char *nearest = below ? below : spore_parameter_nearest(object->type->table, property);
  spore_error_set(&fault, SPORE_ERROR_INPUT, NULL,
                  nearest ? _("%s has no property \"%s\"; did you mean \"%s\"?")
                          : _("%s has no property \"%s\"; `spore models` and `spore schema` list what there is"),
                  object->type->element, property, nearest);
  refuse(object, &fault, error);
  return -1;
}

gboolean spore_document_set_text(SporeDocument *document, SporeObject *object, const char *property, const char *text,
                                 GError **error) {
  int index = find_property(object, property, error);
  if (index < 0) return FALSE;
  SporeError fault = SPORE_ERROR_INIT;
  SporeValue value;
  if (!spore_parameter_parse(&object->type->table->parameters[index], text, &value, &fault))
    return refuse(object, &fault, error);
  gboolean done = spore_document_set(document, object, (guint)index, &value, error);
  spore_value_clear(&value);
  return done;
}

gboolean spore_document_unset(SporeDocument *document, SporeObject *object, guint property, GError **error) {
  const SporeParameter *parameter = &object->type->table->parameters[property];
  if (!object->slots[property].set) return TRUE;
  if (parameter->required) {
    SporeError fault = SPORE_ERROR_INIT;
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL, _("%s has no default; it must have a value; give it another one"),
                    parameter->name);
    return refuse(object, &fault, error);
  }
  g_autofree char *label = g_strdup_printf(_("Reset %s"), parameter->name);
  gboolean opened = open_step(document, label);
  edit_property(object, property, NULL);
  close_step(document, opened);
  return TRUE;
}

/* Names. */

static void follow_references(SporeObject *object, const SporeObject *renamed, const char *old,
                              const SporeValue *name) {
  const SporeParameterTable *table = object->type->table;
  for (guint i = 0; i < table->count; i++) {
    const SporeSlot *slot = &object->slots[i];
    if (table->parameters[i].type != SPORE_REFERENCE || !slot->set || strcmp(slot->value.text, old) != 0) continue;
    if (!spore_element_in_list(table->parameters[i].references, renamed->type->element)) continue;
    SporeValue reference = {.type = SPORE_REFERENCE, .text = name->text}, copy;
    if (spore_value_copy(&copy, &reference)) edit_property(object, i, &copy);
    else g_error("not enough memory");
  }
  for (guint i = 0; i < object->children->len; i++)
    follow_references(spore_object_child(object, i), renamed, old, name);
}

/* A name that somebody gives is no guess any more. */
static void confirm_name(SporeObject *object) {
  int mark = spore_parameter_find(object->type->table, "name_guessed");
  if (mark >= 0 && object->slots[mark].set) edit_property(object, (guint)mark, NULL);
}

gboolean spore_document_rename(SporeDocument *document, SporeObject *object, const char *name, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  int property = spore_object_name_property(object);
  if (property < 0) {
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL, _("%s has no name; only objects of a list do; rename its owner"),
                    object->type->element);
    return refuse(object, &fault, error);
  }
  SporeValue wanted = {.type = SPORE_NAME, .text = (char *)name}, copy;
  if (!spore_parameter_check(&object->type->table->parameters[property], &wanted, &fault))
    return refuse(object, &fault, error);
  if (strcmp(name, spore_object_name(object)) == 0) return TRUE;
  if (sibling_of_name(object->parent, object, name)) {
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL,
                    _("the name \"%s\" is taken; expected one that is new in %s; choose another"), name,
                    object->parent->type->element);
    return refuse(object, &fault, error);
  }
  if (!copy_value(object, &wanted, &copy, error)) return FALSE;
  g_autofree char *old = g_strdup(spore_object_name(object));
  gboolean opened = open_step(document, _("Rename"));
  edit_property(object, (guint)property, &copy);
  follow_references(document->root, object, old, &object->slots[property].value);
  confirm_name(object);
  close_step(document, opened);
  return TRUE;
}

/* "liver", or "liver-2" where that is taken, ... */
static char *unique_name(const SporeObject *parent, const char *name) {
  char *unique = g_strdup(name);
  for (guint i = 2; sibling_of_name(parent, NULL, unique); i++) {
    g_free(unique);
    unique = g_strdup_printf("%s-%u", name, i);
  }
  return unique;
}

/* Places. */

guint spore_object_place_for(const SporeObject *parent, const SporeObjectType *type, guint index) {
  if (!parent->type->ordered) return MIN(index, parent->children->len);
  guint rank, place = 0;
  g_ptr_array_find(parent->type->children, type, &rank);
  for (guint i = 0; i < parent->children->len; i++) {
    guint other;
    g_ptr_array_find(parent->type->children, spore_object_child(parent, i)->type, &other);
    if (other < rank) place = i + 1;
  }
  return place;
}

static const SporeObjectType *check_child(const SporeObject *parent, const char *element, GError **error) {
  SporeError fault = SPORE_ERROR_INIT;
  const SporeObjectType *type = spore_object_type_child(parent->type, element);
  if (!type) {
    const char *nearest = spore_object_type_nearest_child(parent->type, element);
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL,
                    nearest ? _("%s cannot hold \"%s\"; did you mean \"%s\"?")
                            : _("%s cannot hold \"%s\"; `spore schema` says what goes where; choose another place"),
                    parent->type->element, element, nearest);
  } else if (parent->type->single_child && parent->children->len > 0) {
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL, _("%s already holds %s; it takes one object; remove that first"),
                    parent->type->element, spore_object_child(parent, 0)->type->element);
  } else if (parent->type->ordered && spore_object_child_of(parent, element)) {
    spore_error_set(&fault, SPORE_ERROR_INPUT, NULL, _("%s already has its %s; it takes one; change that"),
                    parent->type->element, element);
  } else {
    return type;
  }
  refuse(parent, &fault, error);
  return NULL;
}

static gboolean give_name(SporeObject *object, const SporeObject *parent, const char *name, GError **error) {
  int property = spore_object_name_property(object);
  if (property < 0) return TRUE;
  SporeError fault = SPORE_ERROR_INIT;
  g_autofree char *unique = unique_name(parent, name ? name : object->type->element);
  SporeValue value;
  if (!spore_parameter_parse(&object->type->table->parameters[property], unique, &value, &fault))
    return refuse(parent, &fault, error);
  spore_document_load_value(object, (guint)property, &value, NULL);
  return TRUE;
}

SporeObject *spore_document_insert(SporeDocument *document, SporeObject *parent, const char *element, const char *name,
                                   guint index, GError **error) {
  const SporeObjectType *type = check_child(parent, element, error);
  if (!type) return NULL;
  SporeObject *object = spore_object_new(document, type);
  if (!give_name(object, parent, name, error)) {
    g_hash_table_remove(document->objects, GUINT_TO_POINTER(object->id));
    return NULL;
  }
  g_autofree char *label = g_strdup_printf(_("Add %s"), _(type->label));
  gboolean opened = open_step(document, label);
  SporeEdit edit = {.kind = SPORE_EDIT_PLACE,
                    .object = object,
                    .created = TRUE,
                    .parent = parent,
                    .index = spore_object_place_for(parent, type, index)};
  spore_document_edit(document, &edit);
  close_step(document, opened);
  return object;
}

static gboolean check_movable(const SporeObject *object, GError **error) {
  g_assert(!object->detached);
  if (object->parent && !is_section(object)) return TRUE;
  SporeError fault = SPORE_ERROR_INIT;
  spore_error_set(&fault, SPORE_ERROR_INPUT, NULL,
                  _("%s belongs to every scene; it stays where it is; change what it holds"), object->type->element);
  return refuse(object, &fault, error);
}

gboolean spore_document_remove(SporeDocument *document, SporeObject *object, GError **error) {
  if (!check_movable(object, error)) return FALSE;
  g_autofree char *label = g_strdup_printf(_("Remove %s"), _(object->type->label));
  gboolean opened = open_step(document, label);
  SporeEdit edit = {.kind = SPORE_EDIT_PLACE, .object = object};
  spore_document_edit(document, &edit);
  close_step(document, opened);
  return TRUE;
}

gboolean spore_document_move(SporeDocument *document, SporeObject *object, SporeObject *parent, guint index,
                             GError **error) {
  if (!check_movable(object, error)) return FALSE;
  gboolean stays = parent == object->parent;
  if (!stays && !check_child(parent, object->type->element, error)) return FALSE;
  guint from, to = spore_object_place_for(parent, object->type, index);
  g_ptr_array_find(object->parent->children, object, &from);
  if (stays) {
    to = parent->type->ordered ? from : MIN(index, parent->children->len - 1);
    if (to == from) return TRUE;
  }
  g_autofree char *label = g_strdup_printf(_("Move %s"), _(object->type->label));
  gboolean opened = open_step(document, label);
  SporeEdit edit = {.kind = SPORE_EDIT_PLACE, .object = object, .parent = parent, .index = to};
  spore_document_edit(document, &edit);
  close_step(document, opened);
  return TRUE;
}
