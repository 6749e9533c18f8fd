/* Runs a target over its corpus and over mutations of it, the same ones each time. A crash, a failed assertion or a
 * sanitizer's report is the failure; the input that did it is left in a file. */
#include <glib.h>
#include <glib/gstdio.h>
#include <string.h>

#include "fuzz.h"

#define LARGEST 20000 /* bytes of a mutated input */

static GPtrArray *corpus; /* of GByteArray * */
static const char *folder;

static void load_corpus(void) {
  GError *error = NULL;
  g_autoptr(GDir) directory = g_dir_open(folder, 0, &error);
  g_assert_no_error(error);
  g_autoptr(GPtrArray) names = g_ptr_array_new_with_free_func(g_free);
  for (const char *name; (name = g_dir_read_name(directory));)
    g_ptr_array_add(names, g_build_filename(folder, name, NULL));
  g_ptr_array_sort_with_data(names, (GCompareDataFunc)(void (*)(void))g_strcmp0, NULL);
  corpus = g_ptr_array_new_with_free_func((GDestroyNotify)g_byte_array_unref);
  for (guint i = 0; i < names->len; i++) {
    char *content;
    gsize size;
    g_file_get_contents(names->pdata[i], &content, &size, &error);
    g_assert_no_error(error);
    g_ptr_array_add(corpus, g_byte_array_new_take((guint8 *)content, size));
  }
  g_assert_cmpuint(corpus->len, >, 0);
}

static guint below(GRand *random, guint limit) { return limit ? (guint)g_rand_int_range(random, 0, (gint32)limit) : 0; }

static void insert(GByteArray *input, guint at, const void *bytes, guint size) {
  if (size == 0) return;
  g_autofree guint8 *copy = g_memdup2(bytes, size);
  guint old = input->len;
  g_byte_array_set_size(input, old + size);
  memmove(input->data + at + size, input->data + at, old - at);
  memcpy(input->data + at, copy, size);
}

static void mutate(GByteArray *input, GRand *random) {
  guint at = below(random, input->len), length = below(random, 40);
  length = MIN(length, input->len - at);
  switch (below(random, 8)) {
  case 0:
    if (input->len) input->data[at] ^= (guint8)(1 << below(random, 8));
    break;
  case 1:
    if (input->len) input->data[at] = (guint8)below(random, 256);
    break;
  case 2:
    g_byte_array_remove_range(input, at, length);
    break;
  case 3:
    insert(input, below(random, input->len + 1), input->data + at, length);
    break;
  case 4:
    g_byte_array_set_size(input, at);
    break;
  case 5: { /* the end of another */
    const GByteArray *other = g_ptr_array_index(corpus, below(random, corpus->len));
    guint from = below(random, other->len);
    g_byte_array_set_size(input, at);
    g_byte_array_append(input, other->data + from, other->len - from);
    break;
  }
  default: {
    guint words = 0;
    while (fuzz_words[words]) words++;
    const char *word = fuzz_words[below(random, words)];
    if (below(random, 2)) g_byte_array_remove_range(input, at, length);
    insert(input, MIN(at, input->len), word, (guint)strlen(word));
  }
  }
}

/* From memory of exactly that size, so that a read beyond it is seen. */
static void try(const GByteArray *input, const char *trace) {
  g_file_set_contents(trace, (const char *)input->data, (gssize)input->len, NULL);
  guint8 *exact = g_malloc(input->len);
  if (input->len) memcpy(exact, input->data, input->len);
  LLVMFuzzerTestOneInput(exact, input->len);
  g_free(exact);
}

static void test_corpus(void) {
  g_autofree char *trace = g_strdup_printf("%s/%s.failed", g_get_tmp_dir(), g_get_prgname());
  for (guint i = 0; i < corpus->len; i++) try(corpus->pdata[i], trace);
  g_remove(trace);
}

static void test_mutations(void) {
  g_autofree char *trace = g_strdup_printf("%s/%s.failed", g_get_tmp_dir(), g_get_prgname());
  GRand *random = g_rand_new_with_seed(20260117);
  for (unsigned round = 0; round < fuzz_rounds; round++) {
    const GByteArray *origin = g_ptr_array_index(corpus, below(random, corpus->len));
    GByteArray *input = g_byte_array_new();
    g_byte_array_append(input, origin->data, origin->len);
    for (guint i = 1 + below(random, 6); i > 0; i--) mutate(input, random);
    if (input->len > LARGEST) g_byte_array_set_size(input, LARGEST);
    try(input, trace);
    g_byte_array_unref(input);
  }
  g_rand_free(random);
  g_remove(trace);
}

int main(int argc, char **argv) {
  g_test_init(&argc, &argv, NULL);
  folder = argc > 1 ? argv[1] : ".";
  load_corpus();
  g_test_add_func("/fuzz/corpus", test_corpus);
  g_test_add_func("/fuzz/mutations", test_mutations);
  int status = g_test_run();
  g_ptr_array_unref(corpus);
  return status;
}
