/// @file extremes.h
/// Small networks at the extremes of every setting, numbered, and what becomes of each: the test and the bench's
/// map of stability go over the same ones.
///
/// SPDX-License-Identifier: MIT
#ifndef EXTREMES_H
#define EXTREMES_H

#include <stdbool.h>
#include <stdint.h>

#include <massspring/massspring.h>

typedef enum extreme_shape { EXTREME_BAR, EXTREME_SHIP, EXTREME_ROPE, EXTREME_GRAPH, EXTREME_SHAPES } extreme_shape;

enum {
    EXTREME_STIFFNESSES = 15, ///< 1, 10 ... 1e14 N/m
    EXTREME_STEPS = 10,       ///< 1e-6 to 0.25 s
    EXTREME_RATIOS = 3,       ///< of the largest mass to the least, 1 kg: 1, 1e3, 1e6
    EXTREME_DAMPERS = 3,      ///< none, a tenth of critical, ten times critical, between masses of 1 kg
    EXTREME_SPACINGS = 3,     ///< 1e-6, 1, 1e6 m
    EXTREME_PLACES = 2,       ///< 0, 1e7 m from the world's origin
    /// Networks that differ in more than solver and dt.
    EXTREME_NETWORKS =
        EXTREME_SHAPES * EXTREME_STIFFNESSES * EXTREME_RATIOS * EXTREME_DAMPERS * EXTREME_SPACINGS * EXTREME_PLACES
};

/// A network, as indices of the above.
typedef struct extreme_network {
    extreme_shape shape;
    uint32_t stiffness, ratio, damper, spacing, place;
} extreme_network;

/// The network of a number below EXTREME_NETWORKS.
extreme_network extreme_network_of(uint32_t number);

const char *extreme_shape_name(extreme_shape shape);
double extreme_stiffness(uint32_t index);
double extreme_dt(uint32_t index);

/// How it is stepped.
typedef struct extreme_way {
    const char *name;
    mspring_solver solver;
    mspring_guard guard;
} extreme_way;

enum { EXTREME_WAYS = 4 };

/// The way of a number below EXTREME_WAYS: the solvers, and the explicit one with what it would refuse clamped.
extreme_way extreme_way_of(uint32_t number);

typedef enum extreme_outcome {
    EXTREME_STABLE,
    EXTREME_GUARDED,    ///< a step was refused with MSPRING_ERROR_UNSTABLE and a reason
    EXTREME_REFUSED,    ///< the network was, with a reason
    EXTREME_NOT_FINITE, ///< a coordinate or velocity came out that is not finite: must not be
    EXTREME_DIVERGED,   ///< energy came from nowhere, and nothing was said: must not be
    EXTREME_FAILED,     ///< refused with another code or without a reason: must not be
    EXTREME_OUTCOMES
} extreme_outcome;

/// Step a network under gravity, a little out of its shape, 20 times by dt, with one substep each.
/// @param text  [size] receives what went wrong, if anything did
extreme_outcome extreme_run(const extreme_network *network, extreme_way way, double dt, char *text, size_t size);

/// Find the explicit border by trying: the longest substep in which small motion does not grow, within 5 % of what
/// mspring_network_get_stable_dt() says.
/// @return measured border over the one that is predicted, to 0.1 %; 0 if the network cannot be made; 0.95 or 1.05
///         if it is that or further off
double extreme_border(const extreme_network *network);

/// How far from 1 that may be: 1 % on lattices and ropes, 3 % on graphs.
double extreme_border_within(extreme_shape shape);

#endif
