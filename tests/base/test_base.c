/* core/base but for parameters: errors, memory, numbers, names, profile, hash, pool, triple buffer. */
#include <glib.h>
#include <locale.h>
#include <math.h>
#include <pthread.h>
#include <stdatomic.h>
#include <string.h>

#include "core/base/error.h"
#include "core/base/hash.h"
#include "core/base/memory.h"
#include "core/base/name.h"
#include "core/base/number.h"
#include "core/base/profile.h"
#include "core/base/threads.h"
#include "core/base/triple.h"

static void test_error(void) {
  SporeError error = SPORE_ERROR_INIT;
  g_assert_false(spore_error_set(&error, SPORE_ERROR_INPUT, NULL, "row %d", 7));
  g_assert_cmpint(error.code, ==, SPORE_ERROR_INPUT);
  g_assert_cmpstr(error.message, ==, "row 7");
  g_assert_cmpstr(error.place, ==, "");
  spore_error_at(&error, "file:1:2");
  spore_error_at(&error, "elsewhere");
  g_assert_cmpstr(error.place, ==, "file:1:2");
  g_assert_false(spore_error_set(NULL, SPORE_ERROR_INPUT, "x", "y"));
  spore_error_at(NULL, "x");
}

static void test_error_cut(void) {
  /* Characters of 2, 3 and 4 bytes at every offset from the cut. */
  static const char *const characters[] = {"\xC3\xA9", "\xE2\x82\xAC", "\xF0\x9F\xAB\x80"};
  for (size_t c = 0; c < G_N_ELEMENTS(characters); c++)
    for (int shift = 0; shift < 5; shift++) {
      GString *text = g_string_new(NULL);
      for (int i = 0; i < shift; i++) g_string_append_c(text, 'x');
      while (text->len < 700) g_string_append(text, characters[c]);
      SporeError error;
      spore_error_set(&error, SPORE_ERROR_INPUT, text->str, "%s", text->str);
      g_assert_true(g_utf8_validate(error.message, -1, NULL));
      g_assert_true(g_utf8_validate(error.place, -1, NULL));
      g_assert_cmpuint(strlen(error.message), >, sizeof error.message - 5);
      g_assert_cmpuint(strlen(error.place), >, sizeof error.place - 5);
      g_string_free(text, TRUE);
    }
}

static const char *shout(const char *text) { return strcmp(text, "quiet") == 0 ? "LOUD" : text; }

static void test_translate(void) {
  g_assert_cmpstr(spore_translate("quiet"), ==, "quiet");
  spore_set_translate(shout);
  g_assert_cmpstr(spore_translate("quiet"), ==, "LOUD");
  spore_set_translate(NULL);
}

static void test_allocate(void) {
  for (size_t count = 0; count < 200; count += 7) {
    unsigned char *memory = spore_allocate(count, 3);
    g_assert_nonnull(memory);
    g_assert_cmpuint((uintptr_t)memory % 64, ==, 0);
    for (size_t i = 0; i < 3 * count; i++) g_assert_cmpuint(memory[i], ==, 0);
    spore_free(memory);
  }
  g_assert_null(spore_allocate(SIZE_MAX / 2, 3));
  g_assert_null(spore_allocate(SIZE_MAX, 1));
  spore_free(NULL);
}

static void test_reallocate(void) {
  int *memory = spore_reallocate(NULL, 0, 3, sizeof *memory);
  for (int i = 0; i < 3; i++) memory[i] = i + 1;
  memory = spore_reallocate(memory, 3, 100, sizeof *memory);
  for (int i = 0; i < 100; i++) g_assert_cmpint(memory[i], ==, i < 3 ? i + 1 : 0);
  memory = spore_reallocate(memory, 100, 2, sizeof *memory);
  g_assert_cmpint(memory[1], ==, 2);
  spore_allocation_fail_at(1);
  g_assert_null(spore_reallocate(memory, 2, 10, sizeof *memory));
  g_assert_cmpint(memory[0], ==, 1);
  spore_free(memory);
}

/* One by one: what was there stays, what is new is zero, and without memory all is as it was. */
static void test_room_for_one(void) {
  int *memory = NULL;
  size_t capacity = 0;
  for (int i = 0; i < 20; i++) {
    memory = spore_room_for_one(memory, (size_t)i, &capacity, 5, sizeof *memory);
    for (int k = 0; k < (int)capacity; k++) g_assert_cmpint(memory[k], ==, k < i ? k + 1 : 0);
    memory[i] = i + 1;
  }
  g_assert_cmpuint(capacity, ==, 20);
  spore_allocation_fail_at(1);
  g_assert_null(spore_room_for_one(memory, 20, &capacity, 5, sizeof *memory));
  spore_allocation_fail_at(0);
  g_assert_cmpuint(capacity, ==, 20);
  g_assert_cmpint(memory[19], ==, 20);
  spore_free(memory);
}

static void test_injected_failure(void) {
  uint64_t before = spore_allocation_count();
  spore_allocation_fail_at(3);
  void *blocks[4];
  for (int i = 0; i < 4; i++) blocks[i] = spore_allocate(1, 1);
  for (int i = 0; i < 4; i++) {
    g_assert_true((blocks[i] == NULL) == (i == 2));
    spore_free(blocks[i]);
  }
  g_assert_cmpuint(spore_allocation_count() - before, ==, 4);
  spore_allocation_fail_at(1);
  spore_allocation_fail_at(0);
  void *block = spore_allocate(1, 1);
  g_assert_nonnull(block);
  spore_free(block);
}

static void check_number(double value) {
  char text[SPORE_NUMBER_TEXT];
  int length = spore_number_format(value, text);
  g_assert_cmpint(length, ==, (int)strlen(text));
  double back;
  g_assert_cmpuint(spore_number_read(text, (size_t)length, &back), ==, (size_t)length);
  g_assert_cmpmem(&back, sizeof back, &value, sizeof value);
}

static void check_numbers(void) {
  static const double values[] = {
      0,      -0.0,   1,       0.1,       1.0 / 3,           1e308, -1e308, 1.7976931348623157e308, 5e-324,
      1e-310, 1e-300, 123456., 1e15 + .5, 9007199254740993., 1e22,  1e23};
  for (size_t i = 0; i < G_N_ELEMENTS(values); i++) check_number(values[i]);
  GRand *random = g_rand_new_with_seed(1);
  for (int i = 0; i < 20000; i++) {
    uint64_t bits = (uint64_t)g_rand_int(random) << 32 | g_rand_int(random);
    double value;
    memcpy(&value, &bits, sizeof value);
    if (isfinite(value)) check_number(value);
  }
  g_rand_free(random);
}

static void check_rounded(double value, int digits, const char *expected) {
  char text[SPORE_NUMBER_TEXT];
  spore_number_format_rounded(value, digits, text);
  g_assert_cmpstr(text, ==, expected);
}

static void test_number(void) {
  check_rounded(1.0 / 3, 3, "0.333");
  check_rounded(-123456.7, 4, "-123500");
  check_rounded(999.96, 4, "1000");
  check_rounded(2e-7, 6, "2e-07");
  check_rounded(0, 2, "0");
  check_rounded(NAN, 2, "nan");
  check_numbers();
  char text[SPORE_NUMBER_TEXT];
  spore_number_format(0.1, text);
  g_assert_cmpstr(text, ==, "0.1");
  double value;
  static const struct {
    const char *text;
    size_t length;
    double value;
  } cases[] = {{"1.5 x", 3, 1.5}, {"-.5", 3, -.5},  {"+2.", 3, 2},  {"1e3", 3, 1000}, {"1e", 1, 1},
               {"1e+", 1, 1},     {"1.e2", 4, 100}, {"0x10", 1, 0}, {"1,5", 1, 1},    {"1e999", 5, INFINITY}};
  for (size_t i = 0; i < G_N_ELEMENTS(cases); i++) {
    g_assert_cmpuint(spore_number_read(cases[i].text, strlen(cases[i].text), &value), ==, cases[i].length);
    g_assert_cmpfloat(value, ==, cases[i].value);
  }
  static const char *const bad[] = {"", "-", ".", "e5", "inf", "nan", "-inf", " 1", "+-1", ".e1"};
  for (size_t i = 0; i < G_N_ELEMENTS(bad); i++)
    g_assert_cmpuint(spore_number_read(bad[i], strlen(bad[i]), &value), ==, 0);
  /* Reads no further than it is told. */
  g_assert_cmpuint(spore_number_read("12345", 2, &value), ==, 2);
  g_assert_cmpfloat(value, ==, 12);
  char *digits = g_strnfill(1500, '1');
  g_assert_cmpuint(spore_number_read(digits, 1500, &value), ==, 0);
  g_free(digits);
}

static void test_number_in_other_locale(void) {
  static const char *const names[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "de_DE.utf8", "de_DE"};
  const char *found = NULL;
  for (size_t i = 0; i < G_N_ELEMENTS(names) && !found; i++) found = setlocale(LC_NUMERIC, names[i]);
  if (!found) {
    g_test_skip("no locale with a decimal comma is installed");
    return;
  }
  check_numbers();
  double value;
  g_assert_cmpuint(spore_number_read("1.25e1", 6, &value), ==, 6);
  g_assert_cmpfloat(value, ==, 12.5);
  setlocale(LC_NUMERIC, "C");
}

static void test_name(void) {
  static const char *const good[] = {"a", "_", "liver", "left-ovary.2", "A_1"};
  static const char *const bad[] = {"", "1a", "-a", ".a", "a b", "a/b", "caf\xC3\xA9", "a\n"};
  for (size_t i = 0; i < G_N_ELEMENTS(good); i++) g_assert_true(spore_name_is_valid(good[i]));
  for (size_t i = 0; i < G_N_ELEMENTS(bad); i++) g_assert_false(spore_name_is_valid(bad[i]));
  g_assert_cmpuint(spore_name_distance("stiffness", "Stifness"), ==, 1);
  g_assert_cmpuint(spore_name_distance("ab", "ba"), ==, 1);
  g_assert_cmpuint(spore_name_distance("kitten", "sitting"), ==, 3);
  g_assert_cmpuint(spore_name_distance("", "abc"), ==, 3);
  char *longest = g_strnfill(64, 'a');
  g_assert_cmpuint(spore_name_distance(longest, "a"), ==, SIZE_MAX);
  g_free(longest);
  static const char *const names[] = {"mass", "damping", "stiffness", NULL};
  g_assert_cmpstr(spore_name_nearest(names, "dampnig"), ==, "damping");
  g_assert_cmpstr(spore_name_nearest(names, "MASS"), ==, "mass");
  g_assert_null(spore_name_nearest(names, "colour"));
  g_assert_null(spore_name_nearest(NULL, "colour"));
}

static int compare_u64(const void *a, const void *b) {
  guint64 x = *(const guint64 *)a, y = *(const guint64 *)b;
  return x < y ? -1 : x > y;
}

static void test_profile(void) {
  SporeProfilePhase *phase = g_new0(SporeProfilePhase, 1);
  SporeProfileSummary summary = spore_profile_summary(phase);
  g_assert_cmpfloat(summary.median_us, ==, 0);
  GRand *random = g_rand_new_with_seed(3);
  guint64 samples[SPORE_PROFILE_SAMPLES];
  for (int i = 0; i < 3 * SPORE_PROFILE_SAMPLES / 2; i++) {
    guint64 ns = (guint64)g_rand_int_range(random, 0, i % 3 ? 1000 : 1000000);
    samples[i % SPORE_PROFILE_SAMPLES] = ns;
    spore_profile_add(phase, ns);
  }
  g_rand_free(random);
  spore_profile_add(phase, UINT64_C(10000000000));
  samples[3 * SPORE_PROFILE_SAMPLES / 2 % SPORE_PROFILE_SAMPLES] = UINT64_C(10000000000);
  qsort(samples, SPORE_PROFILE_SAMPLES, sizeof samples[0], compare_u64);
  summary = spore_profile_summary(phase);
  g_assert_cmpfloat(summary.median_us, ==, (double)samples[(SPORE_PROFILE_SAMPLES - 1) / 2] * 1e-3);
  g_assert_cmpfloat(summary.p99_us, ==, (double)samples[(SPORE_PROFILE_SAMPLES - 1) * 99 / 100] * 1e-3);
  g_assert_cmpfloat(summary.max_us, ==, 1e7);
  for (int i = 0; i < SPORE_PROFILE_SAMPLES; i++) spore_profile_add(phase, UINT64_C(10000000000));
  summary = spore_profile_summary(phase);
  g_assert_cmpfloat(summary.median_us, ==, 1e7);
  g_assert_cmpfloat(summary.p99_us, ==, 1e7);
  g_free(phase);
  uint64_t start = spore_clock_ns();
  g_assert_cmpuint(spore_clock_ns(), >=, start);
}

static void test_hash(void) {
  unsigned char bytes[64] = {0};
  GHashTable *seen = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free, NULL);
  for (size_t size = 0; size <= sizeof bytes; size++) {
    uint64_t hash = spore_hash(SPORE_HASH_INIT, bytes, size);
    g_assert_true(g_hash_table_add(seen, g_memdup2(&hash, sizeof hash)));
  }
  for (size_t bit = 0; bit < 8 * sizeof bytes; bit++) {
    bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
    uint64_t hash = spore_hash(SPORE_HASH_INIT, bytes, sizeof bytes);
    g_assert_true(g_hash_table_add(seen, g_memdup2(&hash, sizeof hash)));
    bytes[bit / 8] ^= (unsigned char)(1 << bit % 8);
  }
  g_hash_table_destroy(seen);
  uint64_t seed = spore_hash(SPORE_HASH_INIT, "abc", 3);
  g_assert_cmpuint(spore_hash(seed, "def", 3), !=, spore_hash(SPORE_HASH_INIT, "def", 3));
  /* Written down once: state hashes are compared between machines. */
  g_assert_cmphex(spore_hash(SPORE_HASH_INIT, "spore kernel", 12), ==, UINT64_C(0xf155305f1d7e3c36));
}

typedef struct {
  double *results;
  atomic_uint calls;
} PoolWork;

static void compute(void *data, size_t index) {
  PoolWork *work = data;
  double x = (double)index;
  for (int i = 0; i < 20; i++) x = sin(x) + (double)index * 1e-3;
  work->results[index] += x;
  atomic_fetch_add(&work->calls, 1);
}

static void test_pool(void) {
  enum { COUNT = 500, ROUNDS = 200 };
  double *reference = NULL;
  for (int threads = 0; threads <= 4; threads++) {
    SporePool *pool = threads ? spore_pool_create(threads) : NULL;
    g_assert_cmpint(spore_pool_threads(pool), ==, MAX(threads, 1));
    PoolWork work = {g_new0(double, COUNT), 0};
    uint64_t allocations = spore_allocation_count();
    for (int round = 0; round < ROUNDS; round++) spore_pool_run(pool, COUNT, compute, &work);
    g_assert_cmpuint(spore_allocation_count(), ==, allocations);
    g_assert_cmpuint(work.calls, ==, COUNT * ROUNDS);
    if (reference) g_assert_cmpmem(reference, COUNT * sizeof(double), work.results, COUNT * sizeof(double));
    else reference = g_memdup2(work.results, COUNT * sizeof(double));
    g_free(work.results);
    spore_pool_free(pool);
  }
  g_free(reference);
}

/* Many short jobs of changing length, so that workers come late, sleep and are woken at every moment. */
static void test_pool_short_jobs(void) {
  SporePool *pool = spore_pool_create(3);
  PoolWork work = {g_new0(double, 16), 0};
  guint expected = 0;
  for (guint round = 0; round < 20000; round++) {
    guint count = round % 7;
    spore_pool_run(pool, count, compute, &work);
    expected += count;
    g_assert_cmpuint(work.calls, ==, expected);
    if (round % 5000 == 0) g_usleep(2000);
  }
  g_free(work.results);
  spore_pool_free(pool);
}

static void test_pool_without_memory(void) {
  for (uint64_t n = 1; n <= 2; n++) {
    spore_allocation_fail_at(n);
    g_assert_null(spore_pool_create(2));
  }
  spore_allocation_fail_at(0);
  spore_pool_free(NULL);
}

typedef struct {
  SporeTriple triple;
  uint64_t values[3][8];
} Mailbox;

static void *write_values(void *data) {
  Mailbox *mailbox = data;
  for (uint64_t n = 1; n <= 200000; n++) {
    for (int i = 0; i < 8; i++) mailbox->values[mailbox->triple.writing][i] = n;
    spore_triple_publish(&mailbox->triple);
  }
  return NULL;
}

static void test_triple(void) {
  Mailbox mailbox = {.triple = SPORE_TRIPLE_INIT};
  g_assert_false(spore_triple_acquire(&mailbox.triple));
  pthread_t writer;
  g_assert_cmpint(pthread_create(&writer, NULL, write_values, &mailbox), ==, 0);
  uint64_t last = 0;
  while (last < 200000) {
    if (!spore_triple_acquire(&mailbox.triple)) continue;
    const uint64_t *value = mailbox.values[mailbox.triple.reading];
    g_assert_cmpuint(value[0], >, last);
    for (int i = 1; i < 8; i++) g_assert_cmpuint(value[i], ==, value[0]);
    last = value[0];
  }
  pthread_join(writer, NULL);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  g_test_add_func("/base/error", test_error);
  g_test_add_func("/base/error-cut", test_error_cut);
  g_test_add_func("/base/translate", test_translate);
  g_test_add_func("/base/allocate", test_allocate);
  g_test_add_func("/base/reallocate", test_reallocate);
  g_test_add_func("/base/room-for-one", test_room_for_one);
  g_test_add_func("/base/injected-failure", test_injected_failure);
  g_test_add_func("/base/number", test_number);
  g_test_add_func("/base/number-in-other-locale", test_number_in_other_locale);
  g_test_add_func("/base/name", test_name);
  g_test_add_func("/base/profile", test_profile);
  g_test_add_func("/base/hash", test_hash);
  g_test_add_func("/base/pool", test_pool);
  g_test_add_func("/base/pool-short-jobs", test_pool_short_jobs);
  g_test_add_func("/base/pool-without-memory", test_pool_without_memory);
  g_test_add_func("/base/triple", test_triple);
  return g_test_run();
}
