/* The file around the rows: its head, its checksum, and the files of other machines and versions. */
#include <string.h>

#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/base/text.h"
#include "core/runtime/runtime_private.h"

#define MAGIC "SPORERUN"
#define ORDER 0x01020304u /* reads as another number where the bytes of a word lie the other way round */
#define VERSION 1u

/* The first bytes of a file. */
typedef struct Head {
  char magic[8];
  uint32_t order, version;
  uint64_t signature; /* of the tables of rows */
  uint64_t size;      /* bytes behind the head */
  uint64_t checksum;  /* hash of these */
} Head;

void *spore_runtime_format(const SporeRuntimeScene *scene, size_t *size) {
  SporeCodec codec = {.writing = true, .at = sizeof(Head), .size = 4096};
  codec.bytes = SPORE_NEW_ARRAY(uint8_t, codec.size);
  SporeRuntimeScene copy = *scene; /* the walk takes what it may change */
  if (!codec.bytes || !spore_codec_record(&codec, &spore_rows_scene, &copy)) {
    spore_free(codec.bytes);
    return NULL;
  }
  Head head = {.order = ORDER, .version = VERSION, .signature = spore_rows_signature()};
  memcpy(head.magic, MAGIC, sizeof head.magic);
  head.size = codec.at - sizeof head;
  head.checksum = spore_hash(SPORE_HASH_INIT, codec.bytes + sizeof head, head.size);
  memcpy(codec.bytes, &head, sizeof head);
  *size = codec.at;
  return codec.bytes;
}

static bool check_head(const Head *head, const uint8_t *content, size_t size, SporeError *error) {
  if (size < sizeof *head || memcmp(head->magic, MAGIC, sizeof head->magic) != 0)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("this is no runtime file; expected one that `spore export --format runtime` wrote; export "
                             "the scene"));
  if (head->order != ORDER)
    return spore_error_set(error, SPORE_ERROR_UNSUPPORTED, NULL,
                           _("the file is damaged, or was written on a machine of the other byte order; expected one "
                             "of this machine's; export the scene here"));
  if (head->version != VERSION || head->signature != spore_rows_signature())
    return spore_error_set(error, SPORE_ERROR_UNSUPPORTED, NULL,
                           _("the file has version %u, layout %016llx; expected version %u, layout %016llx; export the "
                             "scene with the same version of SPORE"),
                           head->version, (unsigned long long)head->signature, VERSION,
                           (unsigned long long)spore_rows_signature());
  if (head->size != size - sizeof *head)
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the file has %zu bytes behind its head; expected %llu; copy it again"),
                           size - sizeof *head, (unsigned long long)head->size);
  if (head->checksum != spore_hash(SPORE_HASH_INIT, content + sizeof *head, size - sizeof *head))
    return spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                           _("the file is damaged: its checksum is another; expected the bytes that were written; copy "
                             "it again, or export the scene again"));
  return true;
}

bool spore_runtime_read(SporeRuntime *runtime, const void *content, size_t size, SporeModelRegistry registry,
                        SporeError *error) {
  Head head = {.order = 0};
  memcpy(&head, content, size < sizeof head ? size : sizeof head);
  if (!check_head(&head, content, size, error)) return false;
  SporeCodec codec = {.source = content,
                      .at = sizeof head,
                      .size = size,
                      .registry = registry,
                      .body_count = &runtime->scene.world.body_count,
                      .arena = &runtime->arena,
                      .error = error};
  if (!spore_codec_record(&codec, &spore_rows_scene, &runtime->scene)) return false;
  return codec.at == size ||
         spore_error_set(error, SPORE_ERROR_INPUT, NULL,
                         _("the file is damaged: %zu bytes are left at its end; expected none; export the scene again"),
                         size - codec.at);
}
