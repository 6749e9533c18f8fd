/* The middle line of a tubular organ, with its radius, from the organ's surface. */
#ifndef SPORE_GENERATE_CENTRELINE_CENTRELINE_H
#define SPORE_GENERATE_CENTRELINE_CENTRELINE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

#define SPORE_CENTRELINE_MOST_POINTS 100000u
#define SPORE_CENTRELINE_TOLERANCE 0.02 /* what a curve gets when nothing else is asked for */
#define SPORE_CENTRELINE_NAMED 16       /* side branches that a report names */

typedef struct SporeCentrelineOptions {
  bool ends_given;
  double ends[2][3]; /* m, in or on the organ: the curve runs between the sections that hold them */
  size_t points;     /* of the curve, evenly along it; 0: as many as the tolerance takes */
  double tolerance;  /* how far straight pieces leave the smooth line, and their radius it, of the radius there; 0: as
                      * SPORE_CENTRELINE_TOLERANCE */
} SporeCentrelineOptions;

/* What leaves the curve's side: it is no part of the curve. */
typedef struct SporeCentrelineBranch {
  double from;            /* m, along the curve */
  double length;          /* m, from the curve's side */
  double foot[3], end[3]; /* m: where it leaves the way through the organ's middle, and its tip */
  bool returns;           /* to the curve, elsewhere: a loop */
} SporeCentrelineBranch;

typedef struct SporeCentrelineReport {
  double length;                              /* m, of the smooth line */
  double radius_mean, radius_min, radius_max; /* m: distance to the surface, mean by length; about a third of that at
                                               * the ends, where the surface itself is */
  size_t branches;                            /* side branches longer than the curve is thick */
  SporeCentrelineBranch branch[SPORE_CENTRELINE_NAMED]; /* the longest of them, longest first */
  size_t components; /* pieces of the organ that do not touch; the curve is that of the largest */
  double share;      /* of the organ's volume, of the piece that has the curve */
  double cover;      /* of that piece's volume, what lies within two radii of the curve */
  double inner_wall; /* share of the surface that was left out as seen from nowhere outside: the lumen's wall */
  double offset;     /* mean distance between the curve and the middle of its sections, of the radius: an estimate */
  double outside;    /* share of points of the curve that are outside of the organ */
  double approach;   /* least distance between points of the curve that are no neighbours, of the sum of their radii:
                      * below   1 loops touch; infinite where it has no such points */
  double seconds;
} SporeCentrelineReport;

/* mesh: valid; holes, a double wall, inner walls and parts that overlap are allowed as long as it encloses a volume.
 * The lumen of a hollow organ counts as inside. Of a branched organ the longest way is taken. The same input gives the
 * same curve on any machine. *curve is empty on failure. Refused: what is no tube, no volume, ends outside. */
bool spore_centreline_from_mesh(const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options, SporeCurve *curve,
                                SporeCentrelineReport *report, const SporeProgress *progress, SporeError *error);

/* For a curve that was edited by hand: its radii anew (distance to the surface), and the report on it but for branches
 * and components, which stay 0. Points that are outside of the organ keep their radius. */
bool spore_centreline_measure(const SporeTriangleMesh *mesh, SporeCurve *curve, SporeCentrelineReport *report,
                              SporeError *error);

#endif
