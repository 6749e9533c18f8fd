/* The models of this program: an explicit list. A program that links other models makes a list of its own. */
#ifndef SPORE_MODELS_REGISTRY_H
#define SPORE_MODELS_REGISTRY_H

#include "core/body/model.h"

extern const SporeModelType spore_rigid_body;              /* a solid that does not deform */
extern const SporeModelType spore_mass_spring_net;         /* mass points of a surface, tied by springs */
extern const SporeModelType spore_deformable_surface;      /* springs of a closed surface around a virtual rigid core */
extern const SporeModelType spore_neo_hookean_tetrahedra;  /* a solid of elements for large strains */
extern const SporeModelType spore_corotational_tetrahedra; /* a solid of linear elastic elements that turn */
/* A solid of elements with the Saint Venant-Kirchhoff law. */
extern const SporeModelType spore_saint_venant_kirchhoff_tetrahedra;
extern const SporeModelType spore_linear_tetrahedra;    /* a solid of elements for small displacements */
extern const SporeModelType spore_condensed_tetrahedra; /* the same solved for its surface nodes alone */
extern const SporeModelType spore_finite_differences;   /* a solid on a regular lattice inside a closed surface */
extern const SporeModelType spore_spline_1d;            /* a thread along a spline */
extern const SporeModelType spore_intestine;            /* a tube along a spline */
extern const SporeModelType spore_spline_2d;            /* a sheet of spline patches */
extern const SporeModelType spore_lennard_jones;        /* a fluid of particles */
extern const SporeModelType spore_smoke;                /* particles that rise and dissolve */

/* All of them; NULL at the end. The first type that takes a kind of geometry is the usual choice for that kind. */
extern const SporeModelType *const spore_model_registry[];

#endif
