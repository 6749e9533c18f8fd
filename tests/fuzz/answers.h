/* A helper that answers whatever it is told to: for targets that ask one. */
#ifndef SPORE_TESTS_FUZZ_ANSWERS_H
#define SPORE_TESTS_FUZZ_ANSWERS_H

/* From now on SPORE's helper of this name is fake_helper.c. Returns the file that holds what it answers. */
const char *fuzz_answer_file(const char *helper);

#endif
