#include "models/tetrahedra/neo_hookean_law.h"

#define SPORE_MATERIAL neo_hookean
#define SPORE_LAW_TURNS 0

#include "models/tetrahedra/loops.h"
