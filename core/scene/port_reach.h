/* What an instrument reaches through its port: the cone that the shaft may sweep about the port, and how much of an
 * organ lies within. Of the scene as it stands at the start; whether another organ is in the way is not looked at. */
#ifndef SPORE_SCENE_PORT_REACH_H
#define SPORE_SCENE_PORT_REACH_H

#include "core/scene/document.h"

typedef struct SporePortReach {
  SporeObject *port, *body, *tool; /* body: that the shaft belongs to; tool: that is named after it, or the body */
  SporeVec3 pivot, along;          /* in the scene, m; the middle of the cone, into the patient, of length 1 */
  SporeVec3 tip;                   /* on the line of the shaft, as deep as what is drawn of the instrument */
  SporeVec3 aim;                   /* what its camera looks at, or the tip */
  double angle;                    /* half of the cone's, rad */
  double shallowest, deepest;      /* from the pivot, m */
} SporePortReach;

/* The reach of an instrument through a port of the scene. FALSE: no instrument passes through the link, or its shaft
 * has no direction. */
gboolean spore_port_reach(SporeDocument *document, SporeObject *port, SporePortReach *reach);
/* The ports that belong to an object: the port itself, those of its body, tool, jaw or camera; NULL: all. An array of
 * SporePortReach. */
GArray *spore_ports_of(SporeDocument *document, const SporeObject *object);
/* How an instrument stands once its port has moved: it turns about what it aims at, by the smallest turn that takes its
 * shaft through the pivot. *turn, unless NULL: about the aim. FALSE: the pivot is too near to the aim for that. */
gboolean spore_port_moved(const SporePortReach *reach, SporeVec3 pivot, SporePortReach *moved, SporeQuat *turn);

/* Whether the tip gets to a place of the scene, m, as far as angle and depth go. */
gboolean spore_port_reaches(const SporePortReach *reach, SporeVec3 place);
/* Which part of the drawn surface of a body lies within reach of at least one of `count` ports, 0 to 1 of its area.
 * FALSE: the body shows no mesh. */
gboolean spore_ports_share(SporeDocument *document, const SporePortReach *ports, guint count, const SporeObject *body,
                           double *share);
/* Lines that show a cone, SPORE_PORT_LINES x 2 points x 3, m: its mantle, rings across it, and the shaft. */
#define SPORE_PORT_LINES (12 + 4 * 48 + 1)
void spore_port_lines(const SporePortReach *reach, double *points);
/* A share in words, translated: "83 %"; "all" and "nothing" are said only where nothing and all are missing. g_free. */
char *spore_port_share_text(double share);

#endif
