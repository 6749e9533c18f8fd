/* The inside of a document: for the files of core/scene, and for core/io/scene_xml, which reads and writes what the
 * public header hides (comments, blank lines, the author's spelling of a value). */
#ifndef SPORE_SCENE_DOCUMENT_PRIVATE_H
#define SPORE_SCENE_DOCUMENT_PRIVATE_H

#include "core/scene/document.h"

/* A property of an object. */
typedef struct SporeSlot {
  gboolean set;
  guint position; /* among the set properties, in the author's order */
  SporeValue value;
  char *source; /* the value as XML, in the author's spelling; NULL: format it */
  gboolean on_new_line;
} SporeSlot;

/* A comment of the file. `lines_before`: line ends between it and what precedes it (0: on the same line). */
typedef struct SporeComment {
  char *text;
  guint lines_before;
} SporeComment;

struct SporeObject {
  guint32 id;
  const SporeObjectType *type;
  SporeDocument *document;
  SporeObject *parent; /* kept after removal, see `detached` */
  gboolean detached;   /* not among its parent's children: removed, or not yet inserted */
  GPtrArray *children; /* of SporeObject *, not owned */
  SporeSlot *slots;    /* type->table->count */
  GArray *order;       /* guint: the set properties, in the author's order */
  int line, column;
  gboolean written; /* an empty section that stood in the file stays there */
  guint lines_before;
  GArray *before; /* of SporeComment: in front of the object, travelling with it; NULL: none */
  GArray *beside; /* behind it on the same line; of the root: everything that follows it; NULL: none */
  GArray *tail;   /* before the end tag; NULL: none */
};

typedef enum SporeEditKind { SPORE_EDIT_SET, SPORE_EDIT_PLACE } SporeEditKind;

/* The other side of a change: applying an edit swaps the content of the edit with the state in force. */
typedef struct SporeEdit {
  SporeEditKind kind;
  SporeObject *object;
  gboolean created;    /* place: the object was made for this edit, and is freed with the edit */
  guint property;      /* set */
  SporeSlot slot;      /* set */
  SporeObject *parent; /* place; NULL: nowhere */
  guint index;         /* place */
} SporeEdit;

typedef struct SporeUndoStep {
  char *label;
  guint64 serial;
  GArray *edits; /* of SporeEdit */
} SporeUndoStep;

/* Content that no file holds yet. */
typedef struct SporeBlob {
  GBytes *content;
  guint64 serial; /* never given twice */
} SporeBlob;

typedef struct SporeListenerEntry {
  guint id;
  SporeDocumentListener listener;
  gpointer data;
} SporeListenerEntry;

struct SporeDocument {
  const SporeSchema *schema;
  SporeObject *root;
  GHashTable *objects; /* id -> SporeObject *, with detached objects; owns the objects */
  guint32 last_id;
  GHashTable *names;    /* name -> GPtrArray of the objects that have it; NULL: to be made anew */
  gboolean declaration; /* the file begins with <?xml ...?> */

  GPtrArray *undo, *redo; /* SporeUndoStep * */
  GArray *open;           /* edits of the open group */
  GArray *marks;          /* guint: where each nested group began in `open` */
  char *open_label;
  guint64 last_serial, saved_serial, revision;

  GArray *listeners; /* of SporeListenerEntry */
  guint last_listener;

  char *file;
  char *bundle;      /* that the document came from; NULL: none, or it has a file */
  GHashTable *blobs; /* file name -> SporeBlob * */
  guint64 last_blob;
  SporeAssetReaders readers;
  GHashTable *located; /* asset id -> where its content was last found */
  GHashTable *decoded; /* hash of content and options -> decoded asset */
};

/* Loading: without history and without checks. The reader has checked already. */
SporeObject *spore_document_load_object(SporeDocument *document, SporeObject *parent, const SporeObjectType *type,
                                        int line, int column);
/* Takes over value and source. */
void spore_document_load_value(SporeObject *object, guint property, SporeValue *value, char *source);
/* The document has a folder then, and comes from no bundle. */
void spore_document_set_file(SporeDocument *document, const char *file);
/* The document came out of that bundle: it has neither file nor folder. */
void spore_document_set_bundle(SporeDocument *document, const char *bundle);
void spore_document_mark_saved(SporeDocument *document);
void spore_comments_add(GArray **comments, const char *text, guint lines_before);

/* Notifies the listeners and increases the revision. */
void spore_document_notify(SporeDocument *document, SporeChangeKind kind, SporeObject *object, guint property);
/* Applies an edit inside the open group and keeps the edit for undo. Takes ownership of the edit's slot. */
void spore_document_edit(SporeDocument *document, SporeEdit *edit);
void spore_history_free(SporeDocument *document);
void spore_object_free(SporeObject *object);
/* A new object of the document, nowhere yet. */
SporeObject *spore_object_new(SporeDocument *document, const SporeObjectType *type);
/* Index in parent->children where an element belongs: `index` clamped, or where the fixed order wants it. */
guint spore_object_place_for(const SporeObject *parent, const SporeObjectType *type, guint index);
int spore_object_name_property(const SporeObject *object); /* -1: none */
/* After a change of names or places. */
void spore_document_forget_names(SporeDocument *document);
/* Whether `element` is one of the names joined by | in `elements`. */
gboolean spore_element_in_list(const char *elements, const char *element);

/* Opens a regular file inside the document's folder for reading. -1 with a GError. */
int spore_document_open_asset(const SporeDocument *document, const char *place, const char *file, GError **error);
void spore_assets_init(SporeDocument *document);
/* To be called before the document moves to another folder. Files that the history still names, and that are not in
 * `moved` (a set of the names that lie in the new folder too), become blobs, so that undo and redo never name a missing
 * file. */
void spore_document_keep_assets(SporeDocument *document, GHashTable *moved);
/* Shares readers, blobs and decoded assets of a document whose assets have the same ids. */
void spore_document_share_assets(SporeDocument *to, const SporeDocument *from);
void spore_assets_free(SporeDocument *document);

#endif
