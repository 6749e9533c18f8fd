/* The methods, each of which moves a system by steps of h. */
#ifndef SPORE_BENCH_FIELD_METHOD_H
#define SPORE_BENCH_FIELD_METHOD_H

#include "tests/bench/field/system.h"

typedef struct Options {
  double step_s;
  unsigned iterations;    /* sweeps, or local and global solutions, a step */
  double spectral_radius; /* of Chebyshev's acceleration; 0: none */
  bool in_order;          /* springs as they come, not by colours */
} Options;

typedef struct Method {
  const char *name;
  void *(*create)(const System *s, const Options *options);
  void (*step)(void *method, System *s);
  void (*destroy)(void *method);
} Method;

/* XPBD in small steps: Macklin et al. 2016 (compliance and damping), 2019 (one sweep in each of many steps); the
 * neo-Hookean pair of constraints of an element after Macklin and Mueller 2021, solved together. */
extern const Method xpbd;
/* Vertex block descent: Chen et al. 2024. */
extern const Method vertex_block_descent;
/* Projective dynamics with a factor made once: Bouaziz et al. 2014; springs as in Liu et al. 2013. */
extern const Method projective_dynamics;
/* The classical fourth-order method, which shows that the system is ours. */
extern const Method runge_kutta;

#endif
