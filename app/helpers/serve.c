/* One request and its answer. */
#include "app/helpers/serve.h"

#include <unistd.h>

#include "core/io/helper.h"

void spore_helper_serve(int argc, char **argv, SporeHelperAnswer *make) {
  spore_helper_start(argc, argv);
  void *request, *answer;
  size_t size, answer_size;
  SporeHelperFailure failure;
  if (!spore_helper_read_request(&request, &size)) _exit(1);
  if (make(request, size, &answer, &answer_size, &failure)) spore_helper_send_answer(answer, answer_size);
  else spore_helper_send_error(failure.code, failure.message, failure.detail);
  _exit(0);
}
