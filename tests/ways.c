/* Allocations by where they come from. */
#include "tests/ways.h"

#include <execinfo.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

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

#ifdef __SANITIZE_ADDRESS__
#define TWINS_MOST 200 /* of a work: a twin takes twenty times as long */

/* What was freed is kept aside for long, and each twin would copy the tables of its pages. */
const char *__asan_default_options(void);
const char *__asan_default_options(void) { return "quarantine_size_mb=4"; }
#else
#define TWINS_MOST G_MAXUINT
#endif

typedef struct Turns {
  guint64 first, last; /* number of the allocation, from 1 */
} Turns;

static GHashTable *ways;  /* of Turns, by hash of the frames; NULL: nothing is noted */
static GHashTable *known; /* hashes of the ways before */
static guint64 start;

/* How a twin ends; what the program itself ends with when something is wrong is another number. */
enum { TWIN_REFUSED = 40, TWIN_FINE, TWIN_LEAKED };

/* While twins are made: numbers of the allocations that are to fail, the next of them, and how many twins refused. */
static GArray *failing;
static guint next_failing, refused;
static bool is_twin;

static void take_twin(pid_t twin) {
  int status;
  g_assert_cmpint(waitpid(twin, &status, 0), ==, twin);
  if (!WIFEXITED(status) || (WEXITSTATUS(status) != TWIN_REFUSED && WEXITSTATUS(status) != TWIN_FINE))
    g_error("allocation %" G_GUINT64_FORMAT " failed, and the program ended so: status %d",
            g_array_index(failing, guint64, next_failing), status);
  refused += WEXITSTATUS(status) == TWIN_REFUSED;
}

/* Lets a twin of the program go on without the allocation that comes now, if it is one of those. */
static void part_from_twin(void) {
  if (!failing || next_failing == failing->len ||
      spore_allocation_count() - start + 1 < g_array_index(failing, guint64, next_failing))
    return;
  fflush(NULL);
  pid_t twin = fork();
  g_assert_cmpint(twin, >=, 0);
  if (twin == 0) {
    is_twin = true;
    failing = NULL;
    spore_allocation_fail_at(1);
    return;
  }
  take_twin(twin);
  next_failing++;
}

static void note_way(void) {
  part_from_twin();
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

static void ways_begin(void) {
  g_assert_null(ways);
  ways = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, g_free);
  if (!known) known = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, NULL);
  start = spore_allocation_count();
}

static GArray *ways_end(guint *count) {
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

/* Runs once, noting the ways; returns the allocations that are to fail. */
static GArray *run_whole(WaysWork *work, guint *count) {
  GError *error = NULL;
  ways_begin();
  bool whole = work(&error);
  g_assert_no_error(error);
  g_assert_true(whole);
  return ways_end(count);
}

/* Whether the work went on without an allocation; what it did is undone already. */
static bool went_on(bool fine, GError *error) {
  if (!fine) g_assert_error(error, SPORE_ERROR, SPORE_ERROR_MEMORY);
  g_clear_error(&error);
  return fine;
}

static void end_twin(bool fine) {
#ifdef __SANITIZE_ADDRESS__
  if (__lsan_do_recoverable_leak_check()) _exit(TWIN_LEAKED);
#endif
  _exit(fine ? TWIN_FINE : TWIN_REFUSED);
}

static void report(guint count, guint failed) {
  g_test_message("%u ways to an allocation: refused %u times of %u", count, refused, failed);
  if (failed > 0) g_assert_cmpuint(refused, >, 0);
}

/* Leaves so many, evenly. */
static void thin_out(GArray *chosen, guint most) {
  guint all = chosen->len;
  if (all <= most) return;
  for (guint i = 0; i < most; i++)
    g_array_index(chosen, guint64, i) = g_array_index(chosen, guint64, (guint)((guint64)i * all / most));
  g_array_set_size(chosen, most);
}

void ways_fail_each(WaysWork *work) {
  GError *error = NULL;
  guint count;
  g_autoptr(GArray) chosen = run_whole(work, &count);
  thin_out(chosen, TWINS_MOST);
  failing = chosen;
  next_failing = refused = 0;
  start = spore_allocation_count();
  bool fine = work(&error);
  if (is_twin) end_twin(went_on(fine, error));
  g_assert_no_error(error);
  g_assert_true(fine);
  g_assert_cmpuint(next_failing, ==, chosen->len);
  failing = NULL;
  report(count, chosen->len);
}

void ways_fail_again(WaysWork *work, guint most) {
  guint count, runs = 0;
  g_autoptr(GArray) chosen = run_whole(work, &count);
  guint stride = MAX(chosen->len / most, 1);
  refused = 0;
  for (guint i = 0; i < chosen->len; i += stride, runs++) {
    GError *error = NULL;
    spore_allocation_fail_at(g_array_index(chosen, guint64, i));
    bool fine = work(&error);
    spore_allocation_fail_at(0);
    refused += !went_on(fine, error);
  }
  report(count, runs);
}

void ways_clear(void) { g_clear_pointer(&known, g_hash_table_unref); }
