/* What a helper does that answers one request: reads it, answers or says why not, and ends. */
#ifndef SPORE_HELPERS_SERVE_H
#define SPORE_HELPERS_SERVE_H

#include <stddef.h>
#include <stdint.h>

#include "app/helpers/failure.h"

/* Makes the answer to a request of `size` bytes. false: failure is filled. */
typedef bool SporeHelperAnswer(const uint8_t *request, size_t size, void **answer, size_t *answer_size,
                               SporeHelperFailure *failure);

/* In the sandbox. Does not return. */
_Noreturn void spore_helper_serve(int argc, char **argv, SporeHelperAnswer *make);

#endif
