/* Asset readers of the editor's documents. A mesh that a job has decoded is not decoded again on the GTK thread, which
 * would wait for the import helper. */
#ifndef SPORE_UI_DOCUMENT_ASSET_READERS_H
#define SPORE_UI_DOCUMENT_ASSET_READERS_H

#include "core/scene/document.h"

extern const SporeAssetReaders spore_editor_readers;

/* Keeps a copy of a decoded mesh for the reader, and its report; any thread. The few newest are kept. */
void spore_editor_readers_remember(GBytes *content, int unit, int frame, const SporeTriangleMesh *mesh);
/* The report of a mesh: made by the job that decoded it, where one did, else made now. FALSE: no memory. */
gboolean spore_editor_mesh_report(const SporeTriangleMesh *mesh, SporeMeshReport *report);

#endif
