/* Scenes for other programs, and for running them without SPORE: the formats of `spore export` and of the editor. No
 * GTK. */
#ifndef SPORE_UI_EXPORT_EXPORT_H
#define SPORE_UI_EXPORT_EXPORT_H

#include "core/base/cancel.h"
#include "core/base/progress.h"
#include "core/haptic/track.h"
#include "core/scene/document.h"

/* One export: what is asked for, and what came of it. */
typedef struct SporeExport {
  SporeDocument *document;       /* what is exported; the caller's */
  const SporeTrack *input;       /* what moves the devices, the caller's; NULL: what the scene says */
  const char *output;            /* the file or folder to write; the caller's */
  guint64 steps;                 /* of the run, to the moment that is shown */
  guint64 stride;                /* steps from a moment to the next of a series from time 0 on; 0: the end alone */
  const SporeProgress *progress; /* or NULL */
  const SporeCancel *cancel;     /* or NULL */
  GArray *written;               /* of SporeExported */
  GPtrArray *lost, *left_out;    /* sentences, translated: what the format cannot hold; what the file does not need */
  GArray *motions;               /* of SporeExportedMotion; NULL: the format picks no key frames */
  gboolean ran;                  /* the scene was run */
  guint64 unsolved;              /* steps that were not solved as written, of the body and cause that are worst */
} SporeExport;

typedef struct SporeExported {
  char *file;
  gsize bytes;
} SporeExported;

/* How a body's motion is held by key frames. */
typedef struct SporeExportedMotion {
  char *body;
  guint keys, moments;
  double error, bound; /* m: how far what lies between two keys is from the run at most; how far it may be */
} SporeExportedMotion;

/* What a format shows of a run. */
typedef enum SporeExportMoments {
  SPORE_EXPORT_NO_MOMENT,  /* the scene as such: neither steps nor stride */
  SPORE_EXPORT_ONE_MOMENT, /* steps */
  SPORE_EXPORT_SERIES      /* both */
} SporeExportMoments;

typedef struct SporeExportFormat {
  const char *name;
  SporeExportMoments moments;
  const char *suffix; /* of the file's name, with the point; NULL: a folder is written */
  const char *label;  /* translatable, short */
  const char *doc;    /* translatable */
  gboolean (*write)(SporeExport *export, GError **error);
} SporeExportFormat;

extern const SporeExportFormat spore_export_formats[]; /* the last has no name */

/* How many files, the first ones, people are not told of one by one: a series is many, and the last one names the
 * others. *bytes: of those. */
guint spore_export_unsaid(const SporeExport *export, gsize *bytes);

/* Of an export that is zero but for what is asked for. */
void spore_export_init(SporeExport *export);
void spore_export_clear(SporeExport *export);
/* Writes output whole or not at all. FALSE with a GError; SPORE_ERROR_CANCELLED after the cancel was asked. */
gboolean spore_export_run(SporeExport *export, const SporeExportFormat *format, GError **error);

#endif
