/* spore-volume-list: which labels a label map holds, in the sandbox. */
#include <unistd.h>

#include "app/helpers/volume.h"
#include "core/io/helper.h"

int main(int argc, char **argv) {
  spore_helper_start(argc, argv);
  void *request, *answer;
  size_t size, answer_size;
  SporeHelperFailure failure;
  if (!spore_helper_read_request(&request, &size)) _exit(1);
  if (spore_volume_survey(request, size, &answer, &answer_size, &failure))
    spore_helper_send_answer(answer, answer_size);
  else spore_helper_send_error(failure.code, failure.message, failure.detail);
  _exit(0);
}
