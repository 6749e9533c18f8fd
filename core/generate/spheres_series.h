/* Error of sphere sets against their number: where more of them stop paying. */
#ifndef SPORE_GENERATE_SPHERES_SERIES_H
#define SPORE_GENERATE_SPHERES_SERIES_H

#include "core/generate/spheres.h"

#define SPORE_SPHERES_WORTH 0.01 /* usual least gain of a doubling, of the largest depth */

/* Called with each point as soon as it is measured, on the working thread. report: valid during the call. */
typedef void SporeSpheresMeasured(void *data, size_t point, const SporeSpheresReport *report);

/* Generates and measures a set for each of the counts (1 to SPORE_SPHERES_MAXIMUM, ascending), everything else as the
 * options say. reports: count of them, out. measured: may be NULL. */
bool spore_spheres_series(const SporeSpheresSource *source, const SporeSpheresOptions *options, const size_t *counts,
                          size_t count, SporeSpheresReport *reports, SporeSpheresMeasured *measured, void *data,
                          const SporeProgress *progress, SporeError *error);

/* Index of the first point from which on doubling the number lowers the error by less than `worth` everywhere measured;
 * count where it pays to the end. Between points the error is taken to fall evenly with the logarithm of the number. */
size_t spore_enough(const size_t *counts, const double *errors, size_t count, double worth);

#endif
