/* The methods that the field uses today on the cases of tests/bench/peers/case.h, asked and answering as that says.
 * Besides: method=xpbd|vbd|pd|rk4 iterations=N radius=R (of Chebyshev's acceleration, vbd) order=given (springs, xpbd)
 * stiffness=K parts=N poisson_ratio=X law=neo_hookean|corotational. All is double precision, as ours is. */
#include "tests/bench/field/cases.h"

int main(int argc, char **argv) {
  CaseRun run = case_begin(argc, argv);
  System *s = case_system(&run, argc > 1 ? argv[1] : "");
  const Method *method = case_method(case_word(&run, "method", ""));
  if (!s || !method) return 2;
  const Options options = {.step_s = case_time_step(&run),
                           .iterations = (unsigned)case_number(&run, "iterations", 1),
                           .spectral_radius = case_number(&run, "radius", 0),
                           .in_order = !strcmp(case_word(&run, "order", ""), "given")};
  void *state = method->create(s, &options);
  for (unsigned count; (count = case_next_frame(&run));) {
    for (unsigned i = 0; i < count; i++) method->step(state, s);
    case_stop(&run);
    for (size_t i = 0; i < s->node_count; i++) case_node(&run, s->x[i][0], s->x[i][1], s->x[i][2]);
  }
  bool finite = true;
  for (size_t i = 0; i < s->node_count; i++)
    for (int e = 0; e < 3; e++) finite &= isfinite(s->x[i][e]) != 0;
  method->destroy(state);
  system_free(s);
  if (!finite) {
    fprintf(stderr, "the state is not finite\n");
    return 1;
  }
  case_end(&run, "");
  return 0;
}
