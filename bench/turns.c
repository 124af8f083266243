/// @file turns.c
/// Timing in turn.
///
/// SPDX-License-Identifier: MIT
#include "turns.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "machine.h"

/// A sample lasts at least so long (s): long enough that what the other side has left in the caches and branch
/// predictors no longer counts, and short enough that both samples of a pair see the same machine.
#define SAMPLE_SECONDS 0.025

/// A sample has at most so many steps, which for the smallest scenes bounds the time they simulate.
#define MAX_STEPS 4096u

static int compare_doubles(const void *left, const void *right) {
    double a = *(const double *)left;
    double b = *(const double *)right;
    return (a > b) - (a < b);
}

double bench_median(double *values, uint32_t count) {
    qsort(values, count, sizeof *values, compare_doubles);
    return count % 2 == 1 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

static bool sample(const bench_runner *runner, uint32_t steps, double *seconds, scene_error *error) {
    if (!runner->reset(runner->self, error) || !runner->run(runner->self, 1, error)) {
        return false;
    }
    double start = bench_seconds();
    if (!runner->run(runner->self, steps, error)) {
        return false;
    }
    *seconds = bench_seconds() - start;
    return true;
}

/// Find the number of steps that fill a sample.
static bool calibrate(const bench_runner *runner, uint32_t *steps, scene_error *error) {
    uint32_t count = 1;
    double seconds = 0.0;
    for (;;) {
        if (!sample(runner, count, &seconds, error)) {
            return false;
        }
        if (seconds >= SAMPLE_SECONDS || count == MAX_STEPS) {
            *steps = count;
            return true;
        }
        double wanted = ceil(1.2 * SAMPLE_SECONDS / fmax(seconds, 1e-9) * count);
        count = (uint32_t)fmin(fmax(wanted, count + 1.0), MAX_STEPS);
    }
}

bool bench_turns_measure(const bench_runner *first, const bench_runner *second, uint32_t repeat, bench_turns *out,
                         scene_error *error) {
    uint32_t first_steps = 0;
    uint32_t second_steps = 0;
    if (!calibrate(first, &first_steps, error) || !calibrate(second, &second_steps, error)) {
        return false;
    }
    double *times = malloc(3 * (size_t)repeat * sizeof *times);
    if (times == NULL) {
        snprintf(error->text, sizeof error->text, "out of memory for %u samples: use a smaller --repeat", repeat);
        return false;
    }
    double *first_times = times;
    double *second_times = times + repeat;
    double *ratios = times + 2 * (size_t)repeat;
    bool ok = true;
    for (uint32_t i = 0; i < repeat && ok; i++) {
        ok = sample(first, first_steps, &first_times[i], error) &&
             sample(second, second_steps, &second_times[i], error);
        if (ok) {
            first_times[i] /= first_steps;
            second_times[i] /= second_steps;
            ratios[i] = second_times[i] / first_times[i];
        }
    }
    if (ok) {
        out->first_median = bench_median(first_times, repeat);
        out->first_min = first_times[0];
        out->second_median = bench_median(second_times, repeat);
        out->second_min = second_times[0];
        out->ratio_median = bench_median(ratios, repeat);
    }
    free(times);
    return ok;
}
