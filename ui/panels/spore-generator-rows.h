/* The options of a generator: a row for each option in the table of the asset that it makes.
 *
 * Signals
 *   changed ()   the user set one of them                                                                            */
#ifndef SPORE_UI_PANELS_SPORE_GENERATOR_ROWS_H
#define SPORE_UI_PANELS_SPORE_GENERATOR_ROWS_H

#include <gtk/gtk.h>

#include "ui/jobs/works.h"

G_BEGIN_DECLS

#define SPORE_TYPE_GENERATOR_ROWS spore_generator_rows_get_type()
G_DECLARE_FINAL_TYPE(SporeGeneratorRows, spore_generator_rows, SPORE, GENERATOR_ROWS, GtkGrid)

/* table: of the options' fields (spore_generator_table); its parameters are kept. */
void spore_generator_rows_set_options(SporeGeneratorRows *self, const SporeParameterTable *table,
                                      const SporeGenerateOptions *options);
/* Writes the values of the rows; places are not changed. */
void spore_generator_rows_get_options(SporeGeneratorRows *self, SporeGenerateOptions *options);
/* Sets the value as if the user had. */
void spore_generator_rows_set_count(SporeGeneratorRows *self, guint count);

G_END_DECLS
#endif
