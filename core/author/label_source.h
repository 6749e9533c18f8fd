/* A label map from which tetrahedra are generated. The first user reads it, the others share it. References are
 * counted; any thread may use it. No GTK. */
#ifndef SPORE_AUTHOR_LABEL_SOURCE_H
#define SPORE_AUTHOR_LABEL_SOURCE_H

#include "core/io/label_map.h"

#define SPORE_LABEL_SOURCE_MOST 512u /* labels */

typedef struct SporeLabelSource SporeLabelSource;

SporeLabelSource *spore_label_source_new(const char *file);
/* A source of content that is in memory already. */
SporeLabelSource *spore_label_source_new_of(const char *file, GBytes *content);
/* Content of a source that was read, where a scene may keep that much; else NULL. Borrowed. */
GBytes *spore_label_source_content(const SporeLabelSource *source);
SporeLabelSource *spore_label_source_ref(SporeLabelSource *source);
void spore_label_source_unref(SporeLabelSource *source);
const char *spore_label_source_file(const SporeLabelSource *source);
/* Reads the map where that was not done yet. NULL with an error: the file is no label map, or has no labels or too
 * many. */
const SporeLabelMap *spore_label_source_read(SporeLabelSource *source, const SporeProgress *progress, GError **error);

/* Of one that was read: labels ascending. */
gsize spore_label_source_count(const SporeLabelSource *source);
guint16 spore_label_source_label(const SporeLabelSource *source, gsize i);
double spore_label_source_volume(const SporeLabelSource *source, gsize i); /* m^3, of its voxels */
/* Of the box of its voxels, along the map's axes, m. */
void spore_label_source_size(const SporeLabelSource *source, gsize i, double size[3]);
/* The name in the file, else one guessed by spore_label_guess, else "label 3", translated. g_free. */
char *spore_label_source_name(const SporeLabelSource *source, gsize i);
gboolean spore_label_source_is_guessed(const SporeLabelSource *source, gsize i);

#endif
