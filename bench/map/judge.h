/// @file judge.h
/// What must hold in every step of a case.
///
/// SPDX-License-Identifier: MIT
#ifndef MAP_JUDGE_H
#define MAP_JUDGE_H

#include "map/watch.h"

/// What became of a case. Those from MAP_NOT_FINITE on must not be.
typedef enum map_verdict {
    MAP_HOLDS,
    MAP_GUARDED, ///< a step was rejected with MSPRING_ERROR_UNSTABLE and a reason; it held until then
    MAP_VIOLENT, ///< energy grew as it does in violent motion of explicit substeps near the border: a known limit
    MAP_RESTED,  ///< a loose particle lost energy by bounces shorter than a substep, or too many in a corner: a
                 ///< known limit
    MAP_NOT_FINITE, ///< a coordinate or velocity is not finite
    MAP_REJECTED,   ///< a step that must pass was rejected, or a call failed
    MAP_GAINED,     ///< energy from nowhere
    MAP_MOMENTUM,   ///< a free component changed its momentum
    MAP_TURNED,     ///< or its angular momentum
    MAP_SUNK,       ///< a particle is below the floor
    MAP_BOUNCED,    ///< a loose particle bounced wrongly
    MAP_WORSE,      ///< more substeps were less accurate
    MAP_CROSSED,    ///< a body got into another, or too deep
    MAP_FELL,       ///< a body fell faster or slower than gravity has it
    MAP_VERDICTS
} map_verdict;

const char *map_verdict_name(map_verdict verdict);

enum { MAP_TEXT = 256 };

/// What was when a component was last held by something.
typedef struct map_flight {
    double time, px, py, spin;
    double momentum_scale, spin_scale;
} map_flight;

typedef struct map_judge {
    const map_watch *watch;
    double start;                           ///< energy that there was, less what broken springs took along, J
    double motion;                          ///< kinetic and elastic energy at the start, J
    double potential;                       ///< J, potential energy at the start
    double fallen;                          ///< J, most that the potential energy has been below that at the start
    double rounding;                        ///< J that reading may have been off by where start is from
    double rounding_squares, angle_squares; ///< sums over substeps
    double pushed;                          ///< J, energy of overlaps that were pushed apart since then
    uint64_t substeps, since;               ///< substeps so far, and since there was as little energy as start
    double momentum_scale;                  ///< kg m/s, sum of m |v| at the start
    double could;                           ///< J that can move by now
    double growth;                          ///< largest gain of energy beyond rounding over that
    double quickest;                        ///< farthest way of a particle in a substep over the shortest spring
    map_flight flights[MAP_PARTICLES];
    double particle_start[MAP_PARTICLES], particle_fallen[MAP_PARTICLES]; ///< J: energies of loose particles
    double particle_across[MAP_PARTICLES]; ///< m/s: speeds at which they meet the one plane
    char text[MAP_TEXT];                   ///< what is wrong
} map_judge;

void map_judge_begin(map_judge *judge, const map_watch *watch);

/// Take over what breaking springs between steps changed. The watch has read the state again.
void map_judge_broken(map_judge *judge, double elastic_before);

/// Judge the state after a step of so many substeps.
map_verdict map_judge_step(map_judge *judge, uint32_t substeps);

#endif
