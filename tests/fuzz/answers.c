/* Puts a fake helper in the place of a real one; the fake helper answers what a file holds. */
#include "answers.h"

#include <glib.h>
#include <glib/gstdio.h>
#include <unistd.h>

const char *fuzz_answer_file(const char *helper) {
  static char *answer;
  if (answer) return answer;
  g_autofree char *folder = g_dir_make_tmp("spore-fuzz-XXXXXX", NULL), *link = g_build_filename(folder, helper, NULL);
  g_assert_cmpint(symlink(FAKE_HELPER, link), ==, 0);
  g_setenv("SPORE_HELPERS", folder, TRUE);
  answer = g_build_filename(folder, "answer", NULL);
  g_setenv("SPORE_FUZZ_ANSWER", answer, TRUE);
  return answer;
}
