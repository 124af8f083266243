/// @file settle.h
/// Bring a network to rest.
///
/// SPDX-License-Identifier: MIT
#ifndef BENDING_SETTLE_H
#define BENDING_SETTLE_H

#include <massspring/massspring.h>

#include <stdbool.h>
#include <stddef.h>

typedef struct settle_progress {
    bool measuring;   ///< how slow the network is; the positions of before come back after that
    uint64_t step;    ///< steps made so far
    double drop;      ///< how far the probe, or the mean, has come down, m
    double rms_speed; ///< of the particles that are not pinned, weighted by mass, m/s
} settle_progress;

/// Called after each step.
typedef void (*settle_step_fn)(mspring_network *network, const settle_progress *progress, void *user);

typedef struct settle_request {
    double dt;
    uint64_t most_steps;
    mspring_id probe;          ///< MSPRING_NONE: the mean of all particles
    settle_step_fn after_step; ///< or NULL
    void *user;
} settle_request;

typedef enum settle_end {
    SETTLE_AT_REST,
    SETTLE_OUT_OF_STEPS,
    SETTLE_UNSTABLE,  ///< the network says why
    SETTLE_NOT_FOUND, ///< likewise
    SETTLE_NO_MEMORY
} settle_end;

typedef struct settle_result {
    settle_end end;
    mspring_result result; ///< of the call that failed, where the network says why
    uint64_t steps;       ///< made
    double time;          ///< simulated after measuring, s
    double drop;          ///< how far the probe has come down, m
    double median_step_s; ///< median duration of a step in real time, s
} settle_result;

/// Step the network until it rests: until what the probe still has to move is too little to matter. Sets the
/// network's global damping.
settle_result settle_network(mspring_network *network, const settle_request *request);

/// Put the network where it rests, without stepping there. Relative springs are as stiff as in a substep of that
/// length. Its iterations count as steps.
settle_result settle_at_once(mspring_network *network, const settle_request *request, double substep);

/// The first particle from which no springs lead to a pinned one, so that it would fall for ever; MSPRING_NONE if
/// there is none.
mspring_result settle_find_loose(mspring_network *network, mspring_id *loose);

#endif
