/* What this machine can do, measured, and from it the least time that counted work can take. */
#ifndef SPORE_BENCH_HARDWARE_H
#define SPORE_BENCH_HARDWARE_H

#include <stddef.h>

/* GB/s of one thread reading `bytes` again and again; measured once a power of two. */
double hardware_bandwidth(size_t bytes);
/* GFLOP/s of one thread's multiplications and additions in double, by the widest vectors there are, not contracted. */
double hardware_peak(void);

#endif
