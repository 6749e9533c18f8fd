/* The middle line of a tubular organ, with its radius, from the organ's surface. */
#ifndef SPORE_GENERATE_CENTRELINE_CENTRELINE_H
#define SPORE_GENERATE_CENTRELINE_CENTRELINE_H

#include "core/base/progress.h"
#include "core/mesh/mesh.h"

#define SPORE_CENTRELINE_MOST_POINTS 100000u
#define SPORE_CENTRELINE_TOLERANCE 0.02 /* default */
#define SPORE_CENTRELINE_FOLLOWED 0.95  /* of the surface: a line with less cover leaves out what matters */
#define SPORE_CENTRELINE_NAMED 16       /* side branches that a report names */

typedef struct SporeCentrelineOptions {
  bool ends_given;
  double ends[2][3]; /* m, in or on the organ: the curve runs between the sections that contain them */
  size_t points;     /* of the curve, evenly spaced; 0: the number that the tolerance needs */
  double tolerance;  /* largest distance of a straight segment from the smooth line, and largest error of its radius, as
                        a fraction of the local radius; 0: SPORE_CENTRELINE_TOLERANCE */
  double *way; /* as many as the mesh has vertices, out: m from each to the curve, through the inside; where no way
                  leads, the diagonal of the organ; NULL: not wanted */
} SporeCentrelineOptions;

/* A side branch. It is not part of the curve. */
typedef struct SporeCentrelineBranch {
  double from;            /* m, along the curve */
  double length;          /* m, from the curve's side */
  double foot[3], end[3]; /* m: where the branch leaves the path through the organ's middle, and its tip */
  bool returns;           /* the branch rejoins the curve elsewhere: a loop */
} SporeCentrelineBranch;

typedef struct SporeCentrelineReport {
  double length;                              /* m, of the smooth line */
  double radius_mean, radius_min, radius_max; /* m: distance to the surface; the mean is by length. At the ends about a
                                                 third of it, because the surface itself is there */
  size_t branches;                            /* side branches longer than the curve is thick */
  SporeCentrelineBranch branch[SPORE_CENTRELINE_NAMED]; /* the longest of them, longest first */
  size_t components; /* pieces of the organ that do not touch; the curve belongs to the largest */
  double share;      /* share of the organ's volume in the piece that has the curve */
  double cover;      /* share of the whole surface, by area, within two radii of the curve through the inside */
  double inner_wall; /* share of the surface that cannot be seen from outside and was left out: the wall of the lumen */
  double offset;   /* mean distance between the curve and the centroids of its sections, over the radius: an estimate */
  double outside;  /* share of points of the curve that are outside of the organ */
  double approach; /* least distance between points of the curve that are not neighbours, over the sum of their radii:
                      below 1 loops touch; infinite if there are no such points */
  double seconds;
} SporeCentrelineReport;

/* mesh: valid. Holes, a double wall, inner walls and overlapping parts are allowed if the mesh encloses a volume.
 * The lumen of a hollow organ counts as inside. For a branched organ the longest path is taken. The same input gives
 * the same curve on any machine. *curve is empty on failure. Refused: a shape that is not a tube, no volume, ends
 * outside. */
bool spore_centreline_from_mesh(const SporeTriangleMesh *mesh, const SporeCentrelineOptions *options, SporeCurve *curve,
                                SporeCentrelineReport *report, const SporeProgress *progress, SporeError *error);

/* For a curve that was edited by hand: recomputes its radii (distance to the surface) and fills the report, except
 * branches and components, which stay 0. Points outside the organ keep their radius. */
bool spore_centreline_measure(const SporeTriangleMesh *mesh, SporeCurve *curve, SporeCentrelineReport *report,
                              SporeError *error);

/* The root of a bowel's mesentery, where nobody says where it is: a polynomial of this degree (1 straight, at most
 * SPORE_CENTRELINE_ROOT_DEGREE) in the length along the middle line, nearest to that line in the mean square; so it
 * runs through the middle of the loops, from the bowel's beginning to its end. Its points have a fifth of the line's
 * mean radius. Refused: loops around one place, which have no such middle. */
#define SPORE_CENTRELINE_ROOT_DEGREE 7
bool spore_centreline_root(const SporeCurve *line, size_t degree, SporeCurve *root, SporeError *error);

/* A root and the mesentery between it and the line, as core/mesh/mesentery.h spreads it, m. */
typedef struct SporeCentrelineRoot {
  double length;                  /* of the root */
  double shortest, mean, longest; /* of the mesentery, from the root to the line */
} SporeCentrelineRoot;
bool spore_centreline_root_measure(const SporeCurve *line, const SporeCurve *root, SporeCentrelineRoot *figures,
                                   SporeError *error);

#endif
