/// @file turns.h
/// Timing two things in turn, A B A B ..., so that what disturbs the machine disturbs both: the ratio is taken
/// pair by pair, and the median of the ratios is what counts.
///
/// SPDX-License-Identifier: MIT
#ifndef BENCH_TURNS_H
#define BENCH_TURNS_H

#include <stdbool.h>
#include <stdint.h>

#include "scenes/scene.h"

/// Something that can be put back to its start and run for a number of steps.
typedef struct bench_runner {
    void *self;
    bool (*reset)(void *self, scene_error *error);
    bool (*run)(void *self, uint32_t steps, scene_error *error);
} bench_runner;

typedef struct bench_turns {
    double first_min, first_median;   ///< s per step
    double second_min, second_median; ///< s per step
    double ratio_median;              ///< median of the pairs' second / first
} bench_turns;

/// Most pairs in one measurement.
#define BENCH_MAX_REPEAT 10000u

/// Measure repeat pairs. Every sample starts from the same state, is preceded by a step that is not timed, and
/// has as many steps as fill some milliseconds.
bool bench_turns_measure(const bench_runner *first, const bench_runner *second, uint32_t repeat, bench_turns *out,
                         scene_error *error);

/// Median; sorts the values.
double bench_median(double *values, uint32_t count);

#endif
