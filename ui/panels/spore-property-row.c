/* The row of one parameter: label, editor, unit, effect of a change, and back to the default. */
#include "ui/panels/spore-property-row.h"

#include <glib/gi18n.h>
#include <math.h>

#include "core/author/edits.h"
#include "ui/document/measured-facts.h"
#include "ui/document/number-text.h"
#include "ui/panels/report.h"

#define NUMBER_CHARS 9
#define TEXT_CHARS 17
#define LEAST_CHARS 5

struct _SporePropertyRow {
  GtkBox parent;
  GtkWidget *label, *holder, *unit, *tag, *reset, *measured, *complaint;
  GtkWidget *editor;
  SporeEditorDocument *document;
  char **paths; /* of the objects that it sets, ended by NULL; the first one is shown */
  const SporeObjectType *type;
  guint property;
  char *shown; /* last text that was given to the editor */
  gboolean refreshing;
};

G_DEFINE_FINAL_TYPE(SporePropertyRow, spore_property_row, GTK_TYPE_BOX)

static const SporeParameter *parameter_of(SporePropertyRow *self) {
  return &self->type->table->parameters[self->property];
}

/* Lengths are shown in mm, as everywhere in the window, angles in degrees, and flows in ml/min. */
static gboolean is_length(const SporeParameter *parameter) { return g_str_equal(parameter->unit, "m"); }

static gboolean is_angle(const SporeParameter *parameter) { return spore_unit_is_angle(parameter->unit); }

static gboolean is_flow(const SporeParameter *parameter) { return spore_unit_is_flow(parameter->unit); }

static gboolean is_colour(const SporeParameter *parameter) {
  return parameter->type == SPORE_VECTOR && parameter->minimum == 0 && parameter->maximum == 1;
}

static SporeObject *object_at(SporePropertyRow *self, const char *path) {
  return spore_document_by_path(spore_editor_document_get(self->document), path);
}

/* The value in force as text; for an object that is not there yet the default. g_free. */
static char *text_at(SporePropertyRow *self, const char *path) {
  const SporeParameter *parameter = parameter_of(self);
  SporeObject *object = object_at(self, path);
  if (object) return spore_value_text(parameter, spore_object_value(object, self->property));
  SporeValue value = {0};
  if (!spore_parameter_initial(parameter, &value)) return g_strdup("");
  char *text = spore_value_text(parameter, &value);
  spore_value_clear(&value);
  return text;
}

/* The value that all objects have; "" where they differ. g_free. */
static char *current_text(SporePropertyRow *self) {
  g_autofree char *text = text_at(self, self->paths[0]);
  for (char **path = self->paths + 1; *path; path++) {
    g_autofree char *other = text_at(self, *path);
    if (!g_str_equal(other, text)) return g_strdup("");
  }
  return g_steal_pointer(&text);
}

/* Whether the author set it anywhere. */
static gboolean is_set(SporePropertyRow *self) {
  if (parameter_of(self)->type == SPORE_NAME) return FALSE;
  for (char **path = self->paths; *path; path++) {
    SporeObject *object = object_at(self, *path);
    if (object && spore_object_is_set(object, self->property)) return TRUE;
  }
  return FALSE;
}

/* Changing. */

static void complain(SporePropertyRow *self, const char *message) {
  GtkStyleContext *style = gtk_widget_get_style_context(self->editor);
  if (message) gtk_style_context_add_class(style, "error");
  else gtk_style_context_remove_class(style, "error");
  gtk_label_set_text(GTK_LABEL(self->complaint), message ? message : "");
  gtk_widget_set_visible(self->complaint, message != NULL);
}

/* text NULL: back to the default. */
static void change(SporePropertyRow *self, const char *text) {
  if (self->refreshing) return;
  g_autofree char *current = current_text(self);
  if (text && g_str_equal(text, current)) {
    complain(self, NULL);
    return;
  }
  /* The change may rebuild the panel and this row with it. */
  g_autoptr(SporePropertyRow) held = g_object_ref(self);
  g_autoptr(GError) error = NULL;
  const char *name = parameter_of(self)->name;
  SporeDocument *document = spore_editor_document_get(self->document);
  spore_edit_set_property_of_all(document, self->paths, name, text, &error);
  if (held->editor) complain(held, error ? error->message : NULL);
}

static void reset_clicked(GtkButton *button, SporePropertyRow *self) { change(self, NULL); }

/* Editors: one kind of widget a type. */

static gboolean is_number(SporePropertyRow *self) {
  SporeParameterType type = parameter_of(self)->type;
  return type == SPORE_REAL || type == SPORE_INTEGER || type == SPORE_VECTOR;
}

/* A number below the range that means something, which the program chooses where none is given: rest_length="-1". */
static gboolean is_automatic(const SporeParameter *parameter, const char *text) {
  return parameter->type == SPORE_REAL && parameter->minimum < 0 && parameter->initial[0] == parameter->minimum &&
         *text && g_ascii_strtod(text, NULL) == parameter->minimum;
}

/* A text of the file as the entry shows it. g_free. */
static char *entry_text(SporePropertyRow *self, const char *text) {
  if (is_automatic(parameter_of(self), text)) return g_strdup("");
  if (!is_number(self)) return g_strdup(text);
  g_autofree char *shown = is_angle(parameter_of(self)) ? spore_number_text_degrees(text)
                           : is_flow(parameter_of(self))
                               ? spore_number_text_flow(text)
                               : spore_number_text_shift(text, is_length(parameter_of(self)) ? 3 : 0);
  return spore_number_text_show(shown, spore_number_mark());
}

/* What was typed, as the file has it. g_free. */
static char *typed_text(SporePropertyRow *self, const char *typed) {
  if (!is_number(self)) return g_strstrip(g_strdup(typed));
  g_autofree char *plain = g_strdup(typed);
  gboolean flow = is_flow(parameter_of(self));
  int digits = flow                            ? spore_number_text_cut_flow(plain)
               : is_length(parameter_of(self)) ? spore_number_text_cut_length(plain)
                                               : 0;
  gboolean degrees = is_angle(parameter_of(self)) && spore_number_text_cut_angle(plain);
  g_autofree char *text = spore_number_text_read(plain, spore_number_mark());
  if (degrees) return spore_number_text_radians(text);
  if (digits == 0 && !flow) return g_steal_pointer(&text);
  g_autofree char *shifted = spore_number_text_shift(text, digits);
  return flow ? spore_number_text_from_flow(shifted) : g_steal_pointer(&shifted);
}

/* What a number may be, in the unit that is shown. NULL: anything, or no number. g_free. */
static char *range_text(const SporeParameter *parameter, const char *unit) {
  double scale = spore_unit_scale(parameter->unit), least = parameter->minimum * scale,
         most = parameter->maximum * scale;
  gboolean low = isfinite(least), high = isfinite(most);
  if (parameter->type != SPORE_REAL && parameter->type != SPORE_INTEGER && parameter->type != SPORE_VECTOR) return NULL;
  if (low && high) return g_strdup_printf(_("From %g to %g %s"), least, most, unit);
  if (low) return g_strdup_printf(_("At least %g %s"), least, unit);
  if (high) return g_strdup_printf(_("At most %g %s"), most, unit);
  return NULL;
}

/* Why numbers as the file has them are refused, in the unit that is shown: the file's is not what was typed. NULL: they
 * are not. Integers have no unit. g_free. */
static char *refusal(const SporeParameter *parameter, const char *text) {
  int count = 0, expected = parameter->type == SPORE_VECTOR ? 3 : 1;
  gboolean whole = TRUE, within = TRUE;
  g_auto(GStrv) words = g_strsplit_set(text, " \t", -1);
  if (parameter->type != SPORE_REAL && parameter->type != SPORE_VECTOR) return NULL;
  for (char **word = words; *word; word++) {
    char *end;
    double number = g_ascii_strtod(*word, &end);
    if (!**word) continue;
    whole = whole && !*end && isfinite(number);
    within = within && number >= parameter->minimum && number <= parameter->maximum;
    count++;
  }
  if (whole && within && count == expected) return NULL;
  g_autofree char *unit = spore_unit_label(parameter->unit), *range = range_text(parameter, unit);
  const char *what = whole && count == expected ? _("Out of range")
                     : expected == 3            ? _("Three numbers are expected")
                                                : _("A number is expected");
  return range ? g_strdup_printf("%s. %s", what, range) : g_strdup(what);
}

static void entry_commit(SporePropertyRow *self) {
  const char *typed = gtk_entry_get_text(GTK_ENTRY(self->editor));
  g_autofree char *text = typed_text(self, typed), *before = self->shown ? entry_text(self, self->shown) : NULL;
  if (g_strcmp0(typed, before) == 0) { /* nothing was typed; objects that differ show nothing */
    complain(self, NULL);
    return;
  }
  g_autofree char *refused = *text ? refusal(parameter_of(self), text) : NULL;
  if (refused) complain(self, refused);
  else change(self, *text == '\0' && is_number(self) ? NULL : text);
}

static gboolean entry_left(GtkWidget *entry, GdkEvent *event, SporePropertyRow *self) {
  entry_commit(self);
  return GDK_EVENT_PROPAGATE;
}

static gboolean entry_key(GtkWidget *entry, GdkEventKey *event, SporePropertyRow *self) {
  if (event->keyval != GDK_KEY_Escape) return GDK_EVENT_PROPAGATE;
  g_clear_pointer(&self->shown, g_free);
  spore_property_row_refresh(self);
  return GDK_EVENT_STOP;
}

static GtkWidget *new_entry(SporePropertyRow *self) {
  SporeParameterType type = parameter_of(self)->type;
  GtkWidget *entry = gtk_entry_new();
  gboolean number = type == SPORE_REAL || type == SPORE_INTEGER;
  /* A long label takes room from the entry, never the other way round. */
  gtk_entry_set_width_chars(GTK_ENTRY(entry), LEAST_CHARS);
  gtk_entry_set_max_width_chars(GTK_ENTRY(entry), number ? NUMBER_CHARS : TEXT_CHARS);
  if (number) gtk_entry_set_alignment(GTK_ENTRY(entry), 1);
  g_signal_connect_swapped(entry, "activate", G_CALLBACK(entry_commit), self);
  g_signal_connect(entry, "focus-out-event", G_CALLBACK(entry_left), self);
  g_signal_connect(entry, "key-press-event", G_CALLBACK(entry_key), self);
  return entry;
}

static void switch_flipped(SporePropertyRow *self) {
  change(self, gtk_switch_get_active(GTK_SWITCH(self->editor)) ? "true" : "false");
}

static GtkWidget *new_switch(SporePropertyRow *self) {
  GtkWidget *editor = gtk_switch_new();
  g_signal_connect_swapped(editor, "notify::active", G_CALLBACK(switch_flipped), self);
  return editor;
}

static void combo_chosen(SporePropertyRow *self) {
  const char *id = gtk_combo_box_get_active_id(GTK_COMBO_BOX(self->editor));
  if (id) change(self, *id ? id : NULL);
}

static GtkWidget *new_combo(SporePropertyRow *self) {
  GtkWidget *editor = gtk_combo_box_text_new();
  spore_combo_shrinks(editor, LEAST_CHARS, TEXT_CHARS);
  g_signal_connect_swapped(editor, "changed", G_CALLBACK(combo_chosen), self);
  spore_ignore_wheel(editor);
  return editor;
}

static void colour_chosen(SporePropertyRow *self) {
  GdkRGBA colour;
  char r[G_ASCII_DTOSTR_BUF_SIZE], g[G_ASCII_DTOSTR_BUF_SIZE], b[G_ASCII_DTOSTR_BUF_SIZE];
  gtk_color_chooser_get_rgba(GTK_COLOR_CHOOSER(self->editor), &colour);
  g_ascii_formatd(r, sizeof r, "%.3g", colour.red);
  g_ascii_formatd(g, sizeof g, "%.3g", colour.green);
  g_ascii_formatd(b, sizeof b, "%.3g", colour.blue);
  g_autofree char *text = g_strjoin(" ", r, g, b, NULL);
  change(self, text);
}

static GtkWidget *new_colour(SporePropertyRow *self) {
  GtkWidget *editor = gtk_color_button_new();
  g_signal_connect_swapped(editor, "color-set", G_CALLBACK(colour_chosen), self);
  return editor;
}

static GtkWidget *new_editor(SporePropertyRow *self) {
  const SporeParameter *parameter = parameter_of(self);
  if (is_colour(parameter)) return new_colour(self);
  switch (parameter->type) {
  case SPORE_BOOLEAN:
    return new_switch(self);
  case SPORE_CHOICE:
  case SPORE_REFERENCE:
    return new_combo(self);
  default:
    return new_entry(self);
  }
}

/* Showing. */

static void fill_references(SporePropertyRow *self, GtkComboBoxText *combo, const char *current) {
  SporeDocument *document = spore_editor_document_get(self->document);
  g_auto(GStrv) elements = g_strsplit(parameter_of(self)->references, "|", -1);
  SporeObject *root = spore_document_root(document);
  gboolean found = *current == '\0';
  gtk_combo_box_text_append(combo, "", _("None"));
  for (guint s = 0; s < spore_object_child_count(root); s++) {
    SporeObject *section = spore_object_child(root, s);
    for (guint i = 0; i < spore_object_child_count(section); i++) {
      SporeObject *candidate = spore_object_child(section, i);
      const char *name = spore_object_name(candidate);
      if (!name || !g_strv_contains((const char *const *)elements, spore_object_type(candidate)->element)) continue;
      gtk_combo_box_text_append(combo, name, name);
      found |= g_str_equal(name, current);
    }
  }
  if (!found) gtk_combo_box_text_append(combo, current, current); /* refers to nothing; the list of problems says so */
}

static void show_combo(SporePropertyRow *self, const char *text) {
  const SporeParameter *parameter = parameter_of(self);
  GtkComboBoxText *combo = GTK_COMBO_BOX_TEXT(self->editor);
  gtk_combo_box_text_remove_all(combo);
  if (parameter->type == SPORE_REFERENCE) fill_references(self, combo, text);
  for (int i = 0; parameter->type == SPORE_CHOICE && parameter->choices[i]; i++) {
    g_autofree char *label = spore_choice_label(parameter->choices[i]);
    gtk_combo_box_text_append(combo, parameter->choices[i], label);
  }
  gtk_combo_box_set_active_id(GTK_COMBO_BOX(combo), text);
}

static void show_value(SporePropertyRow *self, const char *text) {
  if (GTK_IS_COMBO_BOX_TEXT(self->editor)) {
    show_combo(self, text);
  } else if (GTK_IS_SWITCH(self->editor)) {
    gtk_switch_set_active(GTK_SWITCH(self->editor), g_str_equal(text, "true"));
  } else if (GTK_IS_COLOR_BUTTON(self->editor)) {
    GdkRGBA colour = {0.5, 0.5, 0.5, 1}; /* of objects that differ */
    char *end = (char *)text;
    double *const channels[] = {&colour.red, &colour.green, &colour.blue};
    for (int i = 0; *text && i < 3; i++) *channels[i] = g_ascii_strtod(end, &end);
    gtk_color_chooser_set_rgba(GTK_COLOR_CHOOSER(self->editor), &colour);
  } else {
    g_autofree char *shown = entry_text(self, text);
    gboolean automatic = is_automatic(parameter_of(self), text);
    gtk_entry_set_placeholder_text(GTK_ENTRY(self->editor), automatic ? _("automatic") : NULL);
    gtk_entry_set_text(GTK_ENTRY(self->editor), shown);
  }
}

/* Error and cost of the value, where a study measured them. */
static void show_measured(SporePropertyRow *self) {
  gboolean stale;
  g_autofree char *hint = NULL;
  g_autofree char *note = spore_measured_note(self->document, self->paths[0], parameter_of(self)->name, &hint, &stale);
  g_autofree char *text = note && stale ? g_strdup_printf(_("stale: %s"), note) : g_strdup(note);
  GtkStyleContext *style = gtk_widget_get_style_context(self->measured);
  if (stale) gtk_style_context_add_class(style, "stale");
  else gtk_style_context_remove_class(style, "stale");
  gtk_label_set_text(GTK_LABEL(self->measured), text ? text : "");
  gtk_widget_set_tooltip_text(self->measured, hint);
  gtk_widget_set_visible(self->measured, text != NULL);
}

void spore_property_row_refresh(SporePropertyRow *self) {
  g_autofree char *text = current_text(self);
  const SporeParameter *parameter = parameter_of(self);
  gboolean set = is_set(self);
  /* What the user is typing stays, unless the value itself has changed. References show other names too. */
  if (g_strcmp0(text, self->shown) != 0 || parameter->type == SPORE_REFERENCE) {
    self->refreshing = TRUE;
    show_value(self, text);
    self->refreshing = FALSE;
    complain(self, NULL);
    g_free(self->shown);
    self->shown = g_steal_pointer(&text);
  }
  show_measured(self);
  gtk_widget_set_opacity(self->reset, set ? 1 : 0);
  gtk_widget_set_sensitive(self->reset, set);
}

/* Label and hints, from the table. */

static void describe(SporePropertyRow *self) {
  static const char *const tags[] = {N_("live"), N_("rebuild"), N_("restart")};
  static const char *const hints[] = {N_("A running simulation takes the change at once"),
                                      N_("A running simulation is compiled again and goes on"),
                                      N_("A running simulation starts again from time 0")};
  const SporeParameter *parameter = parameter_of(self);
  g_autofree char *label = spore_label_of(parameter->name);
  g_autofree char *unit = spore_unit_label(parameter->unit);
  g_autofree char *range = range_text(parameter, unit);
  g_autofree char *tooltip =
      g_strconcat(parameter->doc && *parameter->doc ? _(parameter->doc) : label, range ? "\n" : NULL, range, NULL);
  if (is_angle(parameter)) {
    g_autofree char *told = g_steal_pointer(&tooltip);
    tooltip = g_strconcat(told, "\n", _("Shown in degrees; the file has radians"), NULL);
  }
  gtk_label_set_text(GTK_LABEL(self->label), label);
  gtk_widget_set_tooltip_text(self->label, tooltip);
  gtk_widget_set_tooltip_text(self->editor, tooltip);
  gtk_label_set_text(GTK_LABEL(self->unit), unit);
  gtk_label_set_text(GTK_LABEL(self->tag), _(tags[parameter->change]));
  gtk_widget_set_tooltip_text(self->tag, _(hints[parameter->change]));
  g_autofree char *class = g_strdup_printf("tag-%s", tags[parameter->change]);
  gtk_style_context_add_class(gtk_widget_get_style_context(self->tag), class);
  gtk_label_set_mnemonic_widget(GTK_LABEL(self->label), self->editor);
}

static void spore_property_row_dispose(GObject *object) {
  SporePropertyRow *self = SPORE_PROPERTY_ROW(object);
  /* A leaving entry must not commit into a panel that is being torn down. */
  if (self->editor) g_signal_handlers_disconnect_by_data(self->editor, self);
  self->editor = NULL;
  g_clear_object(&self->document);
  g_clear_pointer(&self->paths, g_strfreev);
  g_clear_pointer(&self->shown, g_free);
  G_OBJECT_CLASS(spore_property_row_parent_class)->dispose(object);
}

static void spore_property_row_class_init(SporePropertyRowClass *class) {
  GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
  G_OBJECT_CLASS(class)->dispose = spore_property_row_dispose;
  gtk_widget_class_set_template_from_resource(widget, "/org/spore/Editor/spore-property-row.ui");
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, label);
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, holder);
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, unit);
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, tag);
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, reset);
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, measured);
  gtk_widget_class_bind_template_child(widget, SporePropertyRow, complaint);
  gtk_widget_class_bind_template_callback(widget, reset_clicked);
}

static void spore_property_row_init(SporePropertyRow *self) { gtk_widget_init_template(GTK_WIDGET(self)); }

GtkWidget *spore_property_row_new(SporeEditorDocument *document, const char *path, const SporeObjectType *type,
                                  guint property) {
  const char *const paths[] = {path, NULL};
  return spore_property_row_new_of_several(document, paths, type, property);
}

GtkWidget *spore_property_row_new_of_several(SporeEditorDocument *document, const char *const *paths,
                                             const SporeObjectType *type, guint property) {
  SporePropertyRow *self = g_object_new(SPORE_TYPE_PROPERTY_ROW, NULL);
  self->document = g_object_ref(document);
  self->paths = g_strdupv((char **)paths);
  self->type = type;
  self->property = property;
  self->editor = new_editor(self);
  gtk_widget_show(self->editor);
  gtk_container_add(GTK_CONTAINER(self->holder), self->editor);
  describe(self);
  spore_property_row_refresh(self);
  return GTK_WIDGET(self);
}
