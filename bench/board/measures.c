/// @file measures.c
/// References, errors, periods, swings and times.
///
/// SPDX-License-Identifier: MIT
#include "board/measures.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/clock.h"

/// Slower methods are not followed for 10 s, and their sag at rest is not waited for, us a frame.
enum { DEAREST_LONG = 4000 };

uint32_t least_substeps(const model *m) {
    return (uint32_t)ceil(FRAME_TIME / model_stable_substep(m) / 0.9);
}

// Along the way to rest: 0 at the start, 1 at rest.
static double swing_of(const model *m, const reference *r, const model_state *state) {
    double along = 0, square = 0;
    for (uint32_t i = 0; i < m->particle_count; i++) {
        along += (state->x[i] - m->x[i]) * r->shape_x[i] + (state->y[i] - m->y[i]) * r->shape_y[i];
        square += r->shape_x[i] * r->shape_x[i] + r->shape_y[i] * r->shape_y[i];
    }
    return along / square;
}

static bool find_shape(const model *m, reference *r) {
    r->shape_x = malloc(m->particle_count * sizeof *r->shape_x);
    r->shape_y = malloc(m->particle_count * sizeof *r->shape_y);
    if (!r->shape_x || !r->shape_y || !model_settle(m, r->shape_x, r->shape_y))
        return false;
    r->sag = m->y[m->probe] - r->shape_y[m->probe];
    for (uint32_t i = 0; i < m->particle_count; i++) {
        r->shape_x[i] -= m->x[i];
        r->shape_y[i] -= m->y[i];
        if (m->inverse_mass[i] > 0)
            r->rise -= m->gravity * r->shape_y[i] / m->inverse_mass[i];
    }
    return true;
}

bool reference_find(const stage *on, const model *m, reference *made) {
    model_state state = {0};
    *made = (reference){0};
    bool good = find_shape(m, made) && model_state_begin(m, &state) && model_state_begin(m, &made->after[0]) &&
                model_state_begin(m, &made->after[1]);
    for (int i = 0; good && i < FRAMES; i++) {
        good = model_move(m, FRAME_TIME, on->reference_steps / SECOND, &state);
        made->swing[i] = swing_of(m, made, &state);
        if (i + 1 == SECOND || i + 1 == FRAMES) {
            const int at = i + 1 == FRAMES;
            made->distance[at] = model_distance(m, m->x, m->y, state.x, state.y);
            for (uint32_t j = 0; j < m->particle_count; j++) {
                made->after[at].x[j] = state.x[j];
                made->after[at].y[j] = state.y[j];
            }
        }
    }
    model_state_end(&state);
    return good;
}

void reference_free(reference *unwanted) {
    free(unwanted->shape_x);
    free(unwanted->shape_y);
    model_state_end(&unwanted->after[0]);
    model_state_end(&unwanted->after[1]);
}

// Mean time between upward crossings of the mean, in frames; NaN: there are not two.
static double period_of(const double swing[FRAMES]) {
    double mean = 0, first = NAN, last = NAN;
    int count = 0;
    for (int i = 0; i < FRAMES; i++)
        mean += swing[i] / FRAMES;
    for (int i = 1; i < FRAMES; i++)
        if (swing[i - 1] < mean && swing[i] >= mean) {
            last = i - (swing[i] - mean) / (swing[i] - swing[i - 1]);
            first = count++ == 0 ? last : first;
        }
    return count > 1 ? (last - first) / (count - 1) : NAN;
}

static double late_swing(const double swing[FRAMES]) {
    double low = INFINITY, high = -INFINITY;
    for (int i = FRAMES * 3 / 4; i < FRAMES; i++) {
        low = fmin(low, swing[i]);
        high = fmax(high, swing[i]);
    }
    return high - low;
}

// Move for 1 s and look at the time it takes; if long, go on to 10 s and look at the swing.
static void follow(const method *by, const model *m, const reference *exact, bool is_long, result *found) {
    double swing[FRAMES];
    motion run;
    model_state state = {0};
    bool good = model_state_begin(m, &state) && motion_begin(&run, by, m, found->effort, 0, FRAME_TIME);
    const double start = clock_processor_seconds();
    for (int i = 0; good && !is_long && i < SECOND; i++)
        by->frame(&run, FRAME_TIME);
    const double us = (clock_processor_seconds() - start) * 1e6 / SECOND;
    for (int i = 0; good && is_long && i < FRAMES; i++) {
        by->frame(&run, FRAME_TIME);
        motion_state(&run, by, &state);
        swing[i] = swing_of(m, exact, &state);
    }
    if (good) {
        motion_state(&run, by, &state);
        found->error[is_long] =
            model_distance(m, state.x, state.y, exact->after[is_long].x, exact->after[is_long].y) /
            exact->distance[is_long];
        if (is_long) {
            found->period = period_of(swing) / period_of(exact->swing) - 1;
            found->swing = late_swing(swing) / late_swing(exact->swing);
        } else {
            found->us = fmin(found->us, us);
            found->most_us = fmax(found->most_us, us);
        }
        motion_end(&run, by);
    }
    model_state_end(&state);
}

// Sag at rest: damped as the slowest oscillation needs it, until that has died out.
static double settled(const method *by, const model *m, uint32_t effort, double sag) {
    const double omega = 1.24 * sqrt(m->gravity / sag);
    motion run;
    model_state state = {0};
    double found = NAN;
    if (!model_state_begin(m, &state))
        return NAN;
    if (motion_begin(&run, by, m, effort, 2 * omega, FRAME_TIME)) {
        for (double time = 0; time < 13 / omega; time += FRAME_TIME)
            by->frame(&run, FRAME_TIME);
        motion_state(&run, by, &state);
        found = (m->y[m->probe] - state.y[m->probe]) / sag - 1;
        motion_end(&run, by);
    }
    model_state_end(&state);
    return found;
}

result measure(const stage *on, const method *by, const model *m, const reference *exact, uint32_t effort) {
    enum { REPEATS = 3 };
    result found = {effort, INFINITY, 0, {NAN, NAN}, NAN, NAN, NAN};
    for (int repeat = 0; repeat < REPEATS; repeat++)
        follow(by, m, exact, false, &found);
    if (found.us < DEAREST_LONG) {
        follow(by, m, exact, true, &found);
        if (on->settles)
            found.soft = settled(by, m, effort, exact->sag);
    }
    return found;
}
