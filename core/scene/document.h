/* The document: what the author edits. It is a tree of objects with properties from the tables. Every change is a
 * command, so that undo, the modified state and "what changed" come from one place. One thread owns a document (the GTK
 * thread, or main). */
#ifndef SPORE_SCENE_DOCUMENT_H
#define SPORE_SCENE_DOCUMENT_H

#include <glib.h>

#include "core/mesh/mesh.h"
#include "core/scene/error.h"
#include "core/scene/schema.h"
#include "core/body/tissue.h"

typedef struct SporeDocument SporeDocument;

/* An object belongs to its document, and is read through the functions below. Its id is never used again, even after
 * undo. */
typedef struct SporeObject SporeObject;

SporeDocument *spore_document_new(const SporeSchema *schema); /* schema borrowed; holds the root and its sections */
/* A copy of the scene as it is now, for another thread: it has the same ids, but no history and no comments. It shares
 * decoded assets and content that waits in no file yet. */
SporeDocument *spore_document_copy(const SporeDocument *document);
void spore_document_free(SporeDocument *document);
const SporeSchema *spore_document_schema(const SporeDocument *document);

/* Reading. */
SporeObject *spore_document_root(const SporeDocument *document);
SporeObject *spore_document_section(const SporeDocument *document, const char *element); /* always there */
SporeObject *spore_document_by_id(const SporeDocument *document, guint32 id);
/* Of an object that was removed and may come back by undo; NULL: there is none. */
const SporeObject *spore_document_removed(const SporeDocument *document, guint32 id);
/* Object of one of the kinds (element names joined by |) with that name; NULL: none. */
SporeObject *spore_document_find(const SporeDocument *document, const char *elements, const char *name);
/* By path: "bodies/liver", "bodies/liver/mechanical/corotational_tetrahedra", "solver". */
SporeObject *spore_document_by_path(const SporeDocument *document, const char *path);

guint32 spore_object_id(const SporeObject *object);
const SporeObjectType *spore_object_type(const SporeObject *object);
const char *spore_object_name(const SporeObject *object); /* NULL: this kind has none */
SporeObject *spore_object_parent(const SporeObject *object);
guint spore_object_child_count(const SporeObject *object);
SporeObject *spore_object_child(const SporeObject *object, guint index);
SporeObject *spore_object_child_of(const SporeObject *object, const char *element); /* first of that element, or NULL */
char *spore_object_path(const SporeObject *object);                                 /* g_free */
int spore_object_line(const SporeObject *object); /* in the file read; 0: not from a file */
int spore_object_column(const SporeObject *object);
/* The value in force: set by the author, or else the default. Valid until the next change. */
const SporeValue *spore_object_value(const SporeObject *object, guint property);
gboolean spore_object_is_set(const SporeObject *object, guint property);
double spore_object_number(const SporeObject *object, const char *property);    /* by name, which must exist */
SporeVec3 spore_object_vector(const SporeObject *object, const char *property); /* of a vector, likewise */
const char *spore_object_text(const SporeObject *object, const char *property); /* NULL when neither set nor default */
/* The tissue that gives a model's unset properties their values; NULL: none. */
const SporeTissue *spore_object_tissue(const SporeObject *model);
/* The object that a reference names; NULL: not set, or nothing has that name. */
SporeObject *spore_object_reference(const SporeObject *object, const char *property);
/* The asset that the property of that index names; NULL: it names none. */
SporeObject *spore_object_asset(const SporeObject *object, guint property);
/* The mechanical model of a body; NULL: it has none. */
SporeObject *spore_body_model_object(const SporeObject *body);
/* Whether a property of the object, or of a child of it, names the target. */
gboolean spore_object_refers_to(const SporeObject *object, const SporeObject *target);
/* The place for messages: "FILE:LINE:COLUMN" where the object came from a file, else its path. g_free. */
char *spore_object_where(const SporeObject *object);
/* Fills a structure of the type's table with the values in force; texts are borrowed until the next change. */
void spore_object_fields(const SporeObject *object, void *fields);

/* Changing. Each is one undo step unless inside a group. FALSE with a GError (place: object path) when refused:
 * value out of range, name taken or malformed, child not allowed, reference to nothing is allowed (check says it). */
gboolean spore_document_set(SporeDocument *document, SporeObject *object, guint property, const SporeValue *value,
                            GError **error);
gboolean spore_document_set_text(SporeDocument *document, SporeObject *object, const char *property, const char *text,
                                 GError **error); /* parses as in a file */
/* Sets a property back to its default. It is no longer written to the file. */
gboolean spore_document_unset(SporeDocument *document, SporeObject *object, guint property, GError **error);
/* New child of that element at `index` (G_MAXUINT: last, or where the fixed order wants it). A nameable one gets `name`
 * made unique ("liver", "liver-2"); NULL: from the element. */
SporeObject *spore_document_insert(SporeDocument *document, SporeObject *parent, const char *element, const char *name,
                                   guint index, GError **error);
gboolean spore_document_remove(SporeDocument *document, SporeObject *object, GError **error);
gboolean spore_document_move(SporeDocument *document, SporeObject *object, SporeObject *parent, guint index,
                             GError **error);
/* Renames an object and every reference to it, as one undo step. A name that was marked as a guess is one no more. */
gboolean spore_document_rename(SporeDocument *document, SporeObject *object, const char *name, GError **error);

/* Groups: everything between begin and end is one undo step named `label` (translated). Inside, several sets of the
 * same property merge. abort restores exactly. Groups nest; only the outermost counts. */
void spore_document_begin(SporeDocument *document, const char *label);
void spore_document_end(SporeDocument *document);
void spore_document_abort(SporeDocument *document);

gboolean spore_document_can_undo(const SporeDocument *document);
gboolean spore_document_can_redo(const SporeDocument *document);
const char *spore_document_undo_label(const SporeDocument *document); /* NULL: nothing */
const char *spore_document_redo_label(const SporeDocument *document);
void spore_document_undo(SporeDocument *document);
void spore_document_redo(SporeDocument *document);
gboolean spore_document_is_modified(const SporeDocument *document); /* against the last save or load */
/* Increases with every change, undo and redo: tells whether the document has changed since. */
guint64 spore_document_revision(const SporeDocument *document);

/* Listening. Called after each change, undo and redo included. */
typedef enum SporeChangeKind {
  SPORE_DOCUMENT_SET,      /* object, property */
  SPORE_DOCUMENT_INSERTED, /* object */
  SPORE_DOCUMENT_REMOVED,  /* object: still readable during the call */
  SPORE_DOCUMENT_MOVED,    /* object */
  SPORE_DOCUMENT_HISTORY   /* undo, redo or modified state changed; object NULL */
} SporeChangeKind;
typedef void (*SporeDocumentListener)(SporeDocument *document, SporeChangeKind kind, SporeObject *object,
                                      guint property, gpointer data);
guint spore_document_listen(SporeDocument *document, SporeDocumentListener listener, gpointer data);
void spore_document_unlisten(SporeDocument *document, guint id);

/* Files. A document has a folder once it was loaded or saved. Assets are relative to the folder, and nothing outside of
 * it can be named. Content that no file holds yet (imported meshes, generated spheres) waits in the document as a blob,
 * under the name of its future file. Saving writes the blobs that some object names. */
const char *spore_document_file(const SporeDocument *document); /* NULL: never saved */
/* The bundle (.sporez) that the document came from, whose files wait as blobs; NULL: none, or it was saved since. */
const char *spore_document_bundle(const SporeDocument *document);
void spore_document_put_blob(SporeDocument *document, const char *file, GBytes *content);
/* Content of a file that an asset names: the blob, or else the file in the folder (regular, inside the folder, at most
 * 1 GiB). */
GBytes *spore_document_read_asset(SporeDocument *document, const char *file, GError **error);
/* Whether that content is there to be read; it is not read. */
gboolean spore_document_has_file(const SporeDocument *document, const char *file);

/* Decoded assets, cached by content, shared and immutable. NULL with a GError whose place is the asset. `asset` is an
 * object of element mesh, spheres, tetrahedra or curve. Mesh vertices are in metres and in SPORE's axes. A result is
 * valid until the document is freed. core/io provides the readers (spore_io_install_readers), so that the document
 * needs no importer. */
const SporeTriangleMesh *spore_document_mesh(SporeDocument *document, SporeObject *asset, GError **error);
const SporeSphereSet *spore_document_spheres(SporeDocument *document, SporeObject *asset, GError **error);
const SporeTetrahedralMesh *spore_document_tetrahedra(SporeDocument *document, SporeObject *asset, GError **error);
const SporeCurve *spore_document_curve(SporeDocument *document, SporeObject *asset, GError **error);
/* Hash of an asset's decoded content, 16 hex digits: what source_hash holds. g_free. NULL: the asset cannot be read. */
char *spore_document_asset_hash(SporeDocument *document, SporeObject *asset);

typedef struct SporeAssetReaders {
  gboolean (*mesh)(const char *place, const char *file, GBytes *content, int unit, int frame, SporeTriangleMesh *mesh,
                   GError **error);
  gboolean (*spheres)(const char *place, const char *file, GBytes *content, SporeSphereSet *set, GError **error);
  gboolean (*tetrahedra)(const char *place, const char *file, GBytes *content, SporeTetrahedralMesh *mesh,
                         GError **error);
  gboolean (*curve)(const char *place, const char *file, GBytes *content, SporeCurve *curve, GError **error);
} SporeAssetReaders;
void spore_document_set_readers(SporeDocument *document, const SporeAssetReaders *readers);

#endif
