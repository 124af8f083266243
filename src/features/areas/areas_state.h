/// @file areas_state.h
/// Areas and angles of a network.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_AREAS_STATE_H
#define MSPRINGI_AREAS_STATE_H

#include "builder/builder_areas.h"
#include "store/solver.h"

typedef struct mspringi_corner {
    mspring_id particle;
    mspring_id spring; ///< to the next corner when the area was added; MSPRING_NONE: there was none
    uint32_t slot;     ///< of the particle; see mspringi_areas_refresh()
    float reach;       ///< by how much the area grew then where the particle moved outwards, m
} mspringi_corner;

/// Counters of edits, see mspringi_edits.
typedef struct mspringi_areas_seen {
    uint64_t changes, links, growth, layouts, masses;
} mspringi_areas_seen;

/// All of them.
typedef struct mspringi_areas {
    mspringi_area *list; ///< [count] in the order of ids
    size_t count, capacity;
    mspringi_corner *corners; ///< [corner_count] of the first area, of the second, and so on
    size_t corner_count, corner_capacity;
    size_t angle_count; ///< areas in the list that are angles
    mspring_id next_id;
    uint64_t changes; ///< times that any was edited

    // What follows from these, the springs and the layout; see mspringi_areas_refresh().
    mspringi_areas_seen seen;
    uint32_t swept, unswept; ///< closed areas that the explicit solver's sweeps have in them, and others
    uint32_t unringed;       ///< and those without springs all around
    uint32_t hinge_count;    ///< closed angles with springs along both arms
    double longest;          ///< substep that is stable with forces of these alone, s
    double longest_of_all;   ///< and with those of all
    float *cells;            ///< [lattice blocks][2][lane] half the force per distance at area 0, and its slope
    mspringi_field force;    ///< from outside and of areas, in a substep
} mspringi_areas;

#endif
