/* Names and parameter table of the solver's settings. */
#include "core/integrate/solver.h"

#include <math.h>

#include "core/base/text.h"

const char *const spore_integrator_names[] = {
    "explicit_euler", "symplectic_euler", "verlet", "rk4", "position_based", "implicit_euler", "implicit_midpoint",
    "bdf2",           "tr_bdf2",          "static", NULL};
const char *const spore_nonlinear_names[] = {"automatic", "newton", "broyden", NULL};
const char *const spore_linear_names[] = {"automatic", "conjugate_gradients", "cholesky", "banded", NULL};

static const SporeParameter parameters[] = {
    {.name = "time_step",
     .type = SPORE_REAL,
     .unit = "s",
     .minimum = 1e-6,
     .maximum = 0.1,
     .initial = {0.002},
     .offset = offsetof(SporeSolverFields, time_step),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Simulated time that one step covers.")},
    {.name = "integrator",
     .type = SPORE_CHOICE,
     .unit = "",
     .minimum = -HUGE_VAL,
     .maximum = HUGE_VAL,
     .initial = {SPORE_INTEGRATOR_IMPLICIT_EULER},
     .choices = spore_integrator_names,
     .offset = offsetof(SporeSolverFields, integrator),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How bodies move that do not choose for themselves.")},
    {.name = "substeps",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 1,
     .maximum = SPORE_SUBSTEPS_MAXIMUM,
     .initial = {1},
     .offset = offsetof(SporeSolverFields, substeps),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Parts that a step is integrated in, for bodies that do not choose for themselves. Contacts and links "
               "are found once a step.")},
    {.name = "error_tolerance",
     .type = SPORE_REAL,
     .unit = "m",
     .minimum = 0,
     .maximum = 1,
     .initial = {0},
     .offset = offsetof(SporeSolverFields, error_tolerance),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Error of a body's displacement that one step may make, as tr_bdf2 estimates it: it takes the step in "
               "as many parts as that needs. 0: always in one.")},
    {.name = "nonlinear",
     .type = SPORE_CHOICE,
     .unit = "",
     .minimum = -HUGE_VAL,
     .maximum = HUGE_VAL,
     .initial = {SPORE_NONLINEAR_AUTOMATIC},
     .choices = spore_nonlinear_names,
     .offset = offsetof(SporeSolverFields, nonlinear),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How an implicit step's equations are solved. broyden keeps a factor of the matrix as long as that "
               "pays; newton "
               "makes a new matrix every iteration; automatic takes broyden where the matrix is factorised.")},
    {.name = "linear",
     .type = SPORE_CHOICE,
     .unit = "",
     .minimum = -HUGE_VAL,
     .maximum = HUGE_VAL,
     .initial = {SPORE_LINEAR_AUTOMATIC},
     .choices = spore_linear_names,
     .offset = offsetof(SporeSolverFields, linear),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("How a body's linear equations are solved: by conjugate gradients, by a sparse Cholesky factor of its "
               "matrix, by one that is kept as a band where the body is a chain or a spline, or by what takes less "
               "work.")},
    {.name = "newton_iterations",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 1,
     .maximum = 1000,
     .initial = {20},
     .offset = offsetof(SporeSolverFields, newton_iterations),
     .change = SPORE_CHANGE_REBUILD,
     .doc =
         N_("Most Newton iterations that a step may take; Broyden's count half. A step that is not solved is taken "
            "again with three times as many, then in smaller ones, which may take three times as many, all together. "
            "A step of static may take 16 times as many, since a body may have far to go, and is not taken again.")},
    {.name = "linear_iterations",
     .type = SPORE_INTEGER,
     .unit = "",
     .minimum = 1,
     .maximum = 100000,
     .initial = {500},
     .offset = offsetof(SporeSolverFields, linear_iterations),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Most conjugate gradient iterations that a nonlinear iteration may take.")},
    {.name = "tolerance",
     .type = SPORE_REAL,
     .unit = "",
     .minimum = 1e-14,
     .maximum = 0.1,
     .initial = {1e-6},
     .offset = offsetof(SporeSolverFields, tolerance),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Relative residual at which an implicit step counts as solved.")},
    {.name = "maximum_speed",
     .type = SPORE_REAL,
     .unit = "m/s",
     .minimum = 1e-3,
     .maximum = 1e8,
     .initial = {1000},
     .offset = offsetof(SporeSolverFields, maximum_speed),
     .change = SPORE_CHANGE_REBUILD,
     .doc = N_("Speed above which the monitor steps in.")},
    {.name = "sleep_speed",
     .type = SPORE_REAL,
     .unit = "m/s",
     .minimum = 0,
     .maximum = 1,
     .initial = {1e-6},
     .offset = offsetof(SporeSolverFields, sleep_speed),
     .change = SPORE_CHANGE_REBUILD,
     .doc =
         N_("Bodies that stay slower than this for half a second sleep, and cost nothing, until something that moves "
            "touches them; 0: never.")},
};

const SporeParameterTable spore_solver_parameters = {parameters, sizeof parameters / sizeof *parameters,
                                                     sizeof(SporeSolverFields)};
