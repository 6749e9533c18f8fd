/* Allocations by where they come from. */
#include "tests/ways.h"

#include <execinfo.h>

#include "core/base/memory.h"
#include "core/scene/error.h"

#define FRAMES 6 /* of the stack, which tell one way to an allocation from another */

void *__real_spore_allocate(size_t count, size_t size);
void *__wrap_spore_allocate(size_t count, size_t size);
void *__real_spore_reallocate(void *memory, size_t old_count, size_t count, size_t size);
void *__wrap_spore_reallocate(void *memory, size_t old_count, size_t count, size_t size);
void *__real_spore_grow(void *memory, size_t *capacity, size_t first, size_t size);
void *__wrap_spore_grow(void *memory, size_t *capacity, size_t first, size_t size);
char *__real_spore_copy_text(const char *text);
char *__wrap_spore_copy_text(const char *text);

typedef struct Turns {
  guint64 first, last; /* number of the allocation, from 1 */
} Turns;

static GHashTable *ways;  /* of Turns, by hash of the frames; NULL: nothing is noted */
static GHashTable *known; /* hashes of the ways before */
static guint64 start;

static void note_way(void) {
  if (!ways) return;
  void *frames[FRAMES + 2] = {NULL};
  int count = backtrace(frames, FRAMES + 2);
  guint64 way = 0;
  for (int i = 2; i < count; i++) way = way * 1099511628211u + (guint64)(guintptr)frames[i];
  guint64 turn = spore_allocation_count() - start + 1;
  Turns *turns = g_hash_table_lookup(ways, &way);
  if (!turns) {
    turns = g_new0(Turns, 1);
    turns->first = turn;
    g_hash_table_insert(ways, g_memdup2(&way, sizeof way), turns);
  }
  turns->last = turn;
}

void *__wrap_spore_allocate(size_t count, size_t size) {
  note_way();
  return __real_spore_allocate(count, size);
}

void *__wrap_spore_reallocate(void *memory, size_t old_count, size_t count, size_t size) {
  note_way();
  return __real_spore_reallocate(memory, old_count, count, size);
}

void *__wrap_spore_grow(void *memory, size_t *capacity, size_t first, size_t size) {
  note_way();
  return __real_spore_grow(memory, capacity, first, size);
}

char *__wrap_spore_copy_text(const char *text) {
  note_way();
  return __real_spore_copy_text(text);
}

static int compare(gconstpointer a, gconstpointer b) {
  guint64 x = *(const guint64 *)a, y = *(const guint64 *)b;
  return (x > y) - (x < y);
}

void ways_begin(void) {
  g_assert_null(ways);
  ways = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, g_free);
  if (!known) known = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, NULL);
  start = spore_allocation_count();
}

GArray *ways_end(guint *count) {
  GArray *chosen = g_array_new(FALSE, FALSE, sizeof(guint64));
  GHashTableIter iterator;
  gpointer way, turns;
  if (count) *count = g_hash_table_size(ways);
  g_hash_table_iter_init(&iterator, ways);
  while (g_hash_table_iter_next(&iterator, &way, &turns)) {
    const Turns *of = turns;
    if (!g_hash_table_add(known, g_memdup2(way, sizeof(guint64)))) continue;
    g_array_append_val(chosen, of->first);
    if (of->last > of->first) g_array_append_val(chosen, of->last);
  }
  g_clear_pointer(&ways, g_hash_table_unref);
  g_array_sort(chosen, compare);
  return chosen;
}

void ways_fail_each(WaysWork *work, guint most) {
  GError *error = NULL;
  guint count, refused = 0;
  ways_begin();
  bool whole = work(&error);
  g_assert_no_error(error);
  g_assert_true(whole);
  g_autoptr(GArray) failing = ways_end(&count);
  guint stride = MAX(failing->len / most, 1);
  for (guint i = 0; i < failing->len; i += stride) {
    spore_allocation_fail_at(g_array_index(failing, guint64, i));
    bool fine = work(&error);
    spore_allocation_fail_at(0);
    if (!fine) g_assert_error(error, SPORE_ERROR, SPORE_ERROR_MEMORY);
    refused += !fine;
    g_clear_error(&error);
  }
  g_test_message("%u ways to an allocation: refused %u times of %u", count, refused,
                 (failing->len + stride - 1) / stride);
  g_assert_cmpuint(refused, >, 0);
}

void ways_clear(void) { g_clear_pointer(&known, g_hash_table_unref); }
