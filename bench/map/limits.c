/// @file limits.c
/// Known limits of the solvers. A fault that falls under none of them is one that must not be.
///
/// SPDX-License-Identifier: MIT
#include "map/limits.h"

#include <stddef.h>

// The energy budget counts velocities relative to rest, and what pins give by the force on them at the end.
static bool pins_move(const map_case *what) {
    return what->solver.solver != MSPRING_SOLVER_EXPLICIT && (what->drift_x != 0 || what->drift_y != 0);
}

// The histories of the implicit and the direct solver still hold the forces of springs that have just been broken.
static bool springs_break(const map_case *what) {
    return what->solver.solver != MSPRING_SOLVER_EXPLICIT && what->break_at > 0;
}

// Energy that springs alone hold too much of goes back to where it was before the substep, but what fell meanwhile
// has its speed.
static bool is_pulled(const map_case *what) {
    return what->solver.solver != MSPRING_SOLVER_EXPLICIT &&
           (what->network.gravity_x != 0 || what->network.gravity_y != 0 || what->has_forces);
}

typedef struct limit {
    const char *name;
    map_verdict from, to; ///< faults that it explains
    bool (*applies)(const map_case *what);
} limit;

static const limit limits[] = {
    {"moving pins", MAP_GAINED, MAP_GAINED, pins_move},
    {"broken springs", MAP_GAINED, MAP_TURNED, springs_break},
    {"pulled back", MAP_GAINED, MAP_GAINED, is_pulled},
};

const char *map_known_limit(const map_case *what, map_verdict fault) {
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        if (fault >= limits[i].from && fault <= limits[i].to && limits[i].applies(what))
            return limits[i].name;
    return NULL;
}
