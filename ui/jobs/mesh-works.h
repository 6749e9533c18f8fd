/* Works on meshes for a SporeJob: reading what is to be imported, changing one that is in the scene. No GTK. */
#ifndef SPORE_UI_JOBS_MESH_WORKS_H
#define SPORE_UI_JOBS_MESH_WORKS_H

#include "core/author/organ_import.h"

/* Reads, divides and mends mesh files. */
typedef struct SporeImportWork {
  char **files;
  SporeImportOptions options;
  SporeImport *import; /* out; taken by setting it to NULL */
} SporeImportWork;
SporeImportWork *spore_import_work_new(char *const *files, const SporeImportOptions *options);
gboolean spore_import_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_import_work_free(gpointer work);

/* An operation on the mesh of an asset. */
typedef struct SporeMeshWork {
  guint32 asset; /* object id */
  char *hash;    /* of what it began with */
  SporeMeshOperationKind operation;
  double argument;
  SporeTriangleMesh mesh; /* in, and out as it is read from the content */
  GBytes *content;        /* out: for spore_edit_change_mesh */
  SporeMeshChange change; /* out */
} SporeMeshWork;
/* Copies the asset's mesh. NULL with an error where it cannot be read. */
SporeMeshWork *spore_mesh_work_new(SporeDocument *document, SporeObject *asset, SporeMeshOperationKind operation,
                                   double argument, GError **error);
gboolean spore_mesh_work_run(gpointer work, const SporeProgress *progress, GError **error);
void spore_mesh_work_free(gpointer work);
/* The asset, where it still is the mesh that the work began with; NULL: the document moved on. */
SporeObject *spore_mesh_work_asset(const SporeMeshWork *work, SporeDocument *document);

#endif
