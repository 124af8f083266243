/// @file settle.c
/// Bring a network to rest: measure how slow it is, then let it down gently.
///
/// Measuring: the network swings freely from rest. Whenever its kinetic energy has passed a peak (it swings through
/// where it is in balance) all velocities are set to 0. The time from rest to peak is a quarter of the slowest
/// period. Then everything is put back: a long bar that falls freely crumples where it is pinned and stays so.
///
/// Letting down: global damping at twice the slowest angular frequency is critical for the slowest motion and lets
/// all faster ones decay at the same rate. Each window of one such period gives a mean height of the probe. What
/// is left to come is extrapolated from how these means approach their limit. Means also take out the trembling
/// that single precision leaves, of about stiffness times the last place of a coordinate.
///
/// SPDX-License-Identifier: MIT
#define MSPRING_EXPERIMENTAL // for lab.h
#include "bending/settle.h"
#include "common/clock.h"

#include <massspring/massspring.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum {
    SWINGS = 4,         // that measure the period
    CALM_WINDOWS = 2,   // that must agree
    LEAST_QUARTER = 16, // steps: below that a period cannot be told from trembling
};

// A peak has passed when the energy is below this part of it.
static const double peak_passed = 0.97;
// What may be left to come, as a part of the drop, and of the network's size (the reach of single precision).
static const double drop_tolerance = 2e-5;
static const double size_tolerance = 3e-8;
// The kinetic energy that counts as rest, as a part of the first peak's.
static const double rest_energy = 1e-8;
// Windows whose energy differs by less than this part tremble evenly: there is no rest to come.
static const double even_energy = 0.2;
// Means that approach their limit more slowly than this, from window to window, creep: there is too much damping.
static const double creep = 0.9;

typedef struct settling {
    mspring_network *network;
    const settle_request *request;
    double start_y, size, mass;
    uint64_t step, measuring_steps;
    double drop, energy;
    double first_peak;
    double quarter; // of the slowest period, steps
    double *durations;
    size_t duration_count, duration_capacity;
    settle_end end;
    mspring_result result;
} settling;

// Means over a window, and how many windows in a row have been calm.
enum { WINDOWS = 4 };
typedef struct window_means {
    double drop[WINDOWS], energy[WINDOWS]; // the last one first
    int count, calm;
} window_means;

static bool note_duration(settling *state, double seconds) {
    if (state->duration_count == state->duration_capacity) {
        size_t capacity = state->duration_capacity ? 2 * state->duration_capacity : 1024;
        double *durations = realloc(state->durations, capacity * sizeof *durations);
        if (!durations)
            return false;
        state->durations = durations;
        state->duration_capacity = capacity;
    }
    state->durations[state->duration_count++] = seconds;
    return true;
}

// Height of the probe, or the mean height of all particles. Returns false when out of memory.
static bool measure_height(const mspring_network *network, mspring_id probe, double *height) {
    const bool has_probe = probe != MSPRING_NONE;
    const uint32_t count = has_probe ? 1 : mspring_network_count(network, MSPRING_PARTICLES);
    double *x = malloc(count * sizeof *x);
    double *y = malloc(count * sizeof *y);
    bool ok =
        x && y && mspring_network_get_positions(network, NULL, has_probe ? probe : 0, count, x, y, 1) == MSPRING_OK;
    double sum = 0;
    for (uint32_t i = 0; ok && i < count; i++)
        sum += y[i];
    if (ok)
        *height = sum / count;
    free(x);
    free(y);
    return ok;
}

// One step. Returns false, with the reason in end, when there are to be no more.
static bool make_step(settling *state) {
    if (state->step == state->request->most_steps) {
        state->end = SETTLE_OUT_OF_STEPS;
        return false;
    }
    mspring_energy energy = mspring_energy_default();
    double start = clock_seconds();
    mspring_result result = mspring_network_step(state->network, state->request->dt);
    double seconds = clock_seconds() - start;
    if (result == MSPRING_OK)
        result = mspring_network_get_energy(state->network, &energy);
    state->energy = energy.kinetic;
    if (result != MSPRING_OK) {
        state->end = SETTLE_UNSTABLE;
        state->result = result;
        return false;
    }
    double y = 0;
    if (!measure_height(state->network, state->request->probe, &y) || !note_duration(state, seconds)) {
        state->end = SETTLE_NO_MEMORY;
        return false;
    }
    state->step++;
    state->drop = state->start_y - y;
    settle_progress progress = {
        .measuring = state->measuring_steps == 0,
        .step = state->step,
        .drop = state->drop,
        .rms_speed = sqrt(2 * state->energy / state->mass),
    };
    if (state->request->after_step)
        state->request->after_step(state->network, &progress, state->request->user);
    return true;
}

static void stop_motion(mspring_network *network) {
    const float none = 0;
    (void)!mspring_network_set_velocities(network, NULL, 0, MSPRING_ALL, &none, &none, 0);
}

// Swings from rest until the kinetic energy has passed its peak, then stops all motion.
static bool swing(settling *state) {
    double peak = 0;
    uint64_t start = state->step;
    do {
        if (!make_step(state))
            return false;
        peak = fmax(peak, state->energy);
    } while (state->energy > peak_passed * peak || state->energy == 0);
    stop_motion(state->network);
    state->first_peak = fmax(state->first_peak, peak);
    state->quarter = fmax(state->quarter, (double)(state->step - start));
    return true;
}

// Moves on by one period of the slowest motion.
static bool pass_window(settling *state, window_means *means) {
    uint64_t steps = (uint64_t)(4 * state->quarter);
    double drop = 0;
    double energy = 0;
    for (uint64_t i = 0; i < steps; i++) {
        if (!make_step(state))
            return false;
        drop += state->drop;
        energy += state->energy;
    }
    memmove(means->drop + 1, means->drop, (WINDOWS - 1) * sizeof *means->drop);
    memmove(means->energy + 1, means->energy, (WINDOWS - 1) * sizeof *means->energy);
    means->drop[0] = drop / (double)steps;
    means->energy[0] = energy / (double)steps;
    means->count++;
    return true;
}

// How much smaller each step of the means is than the one before; 0 if they do not all go the same way, as when
// they only tremble.
static double approach(const window_means *means) {
    double last = means->drop[0] - means->drop[1];
    double before = means->drop[1] - means->drop[2];
    double first = means->drop[2] - means->drop[3];
    if (last * before <= 0 || before * first <= 0)
        return 0;
    return fmin(last / before, 0.99);
}

static bool is_calm(const settling *state, const window_means *means) {
    bool still = means->energy[0] <= rest_energy * state->first_peak;
    bool trembles_evenly = fabs(means->energy[0] - means->energy[1]) <= even_energy * means->energy[1] &&
                           fabs(means->energy[1] - means->energy[2]) <= even_energy * means->energy[2];
    return still || trembles_evenly;
}

// Sets the global damping that is critical for the slowest motion.
static bool damp(settling *state) {
    double rate = pi / (state->quarter * state->request->dt);
    mspring_settings settings = mspring_settings_default();
    mspring_result result = mspring_network_get_settings(state->network, &settings);
    settings.global_damping = (float)fmin(rate, 1e6);
    if (result == MSPRING_OK)
        result = mspring_network_set_settings(state->network, &settings);
    if (result == MSPRING_OK)
        return true;
    state->end = SETTLE_UNSTABLE;
    state->result = result;
    return false;
}

static void let_down(settling *state) {
    window_means means = {.count = 0};
    while (means.calm < CALM_WINDOWS) {
        if (!damp(state) || !pass_window(state, &means))
            return;
        if (means.count < WINDOWS)
            continue;
        // If every step is the same part of the one before, this is what they add up to.
        double part = approach(&means);
        double left = fabs(means.drop[0] - means.drop[1]) / (1 - part);
        bool near = left <= drop_tolerance * fabs(means.drop[0]) + size_tolerance * state->size;
        means.calm = near && is_calm(state, &means) ? means.calm + 1 : 0;
        if (!near && part > creep) {
            state->quarter *= 2;
            means = (window_means){.count = 0};
        }
    }
    state->drop = means.drop[0];
    state->end = SETTLE_AT_REST;
}

// Swings a few times and puts everything back.
static bool measure_period(settling *state) {
    uint32_t count = mspring_network_count(state->network, MSPRING_PARTICLES);
    double *x = malloc(count * sizeof *x);
    double *y = malloc(count * sizeof *y);
    bool ok = x && y;
    if (!ok)
        state->end = SETTLE_NO_MEMORY;
    ok = ok && mspring_network_get_positions(state->network, NULL, 0, count, x, y, 1) == MSPRING_OK;
    for (int i = 0; ok && i < SWINGS; i++)
        ok = swing(state);
    ok = ok && mspring_network_set_positions(state->network, NULL, 0, count, x, y, 1) == MSPRING_OK;
    free(x);
    free(y);
    state->quarter = fmax(state->quarter, LEAST_QUARTER);
    state->measuring_steps = state->step;
    return ok;
}

static int compare_doubles(const void *a, const void *b) {
    const double first = *(const double *)a;
    const double second = *(const double *)b;
    return (first > second) - (first < second);
}

static double median(double *values, size_t count) {
    if (count == 0)
        return 0;
    qsort(values, count, sizeof *values, compare_doubles);
    return values[count / 2];
}

// Mass of what moves, and the larger side of the box around the network.
static bool measure_mass(settling *state) {
    mspring_view view = mspring_view_default();
    mspring_body body = mspring_body_default();
    if (mspring_network_get_view(state->network, &view) != MSPRING_OK ||
        mspring_network_get_body(state->network, NULL, 0, MSPRING_ALL, &body) != MSPRING_OK ||
        !measure_height(state->network, state->request->probe, &state->start_y))
        return false;
    for (uint32_t i = 0; i < view.slot_count; i++)
        if (view.inverse_mass[i] > 0)
            state->mass += 1 / (double)view.inverse_mass[i];
    state->size = fmax(body.max_x - body.min_x, body.max_y - body.min_y);
    return true;
}

settle_result settle_network(mspring_network *network, const settle_request *request) {
    settling state = {.network = network, .request = request, .end = SETTLE_NO_MEMORY};
    if (measure_mass(&state) && measure_period(&state))
        let_down(&state);
    settle_result result = {
        .end = state.end,
        .result = state.result,
        .steps = state.step,
        .time = (double)(state.step - state.measuring_steps) * request->dt,
        .drop = state.drop,
        .median_step_s = median(state.durations, state.duration_count),
    };
    free(state.durations);
    return result;
}

settle_result settle_at_once(mspring_network *network, const settle_request *request, double substep) {
    settle_result result = {.end = SETTLE_NO_MEMORY};
    mspring_settle_def def = mspring_settle_def_default();
    mspring_settle_result found = mspring_settle_result_default();
    double before = 0;
    double after = 0;
    def.relative_substep = substep;
    double start = clock_seconds();
    if (!measure_height(network, request->probe, &before))
        return result;
    result.result = mspring_network_settle(network, &def, &found);
    if (result.result != MSPRING_OK) {
        result.end = SETTLE_NOT_FOUND;
    } else if (measure_height(network, request->probe, &after)) {
        result.end = SETTLE_AT_REST;
        result.steps = found.iterations;
        result.drop = before - after;
        result.median_step_s = (clock_seconds() - start) / fmax(1, found.iterations);
    }
    return result;
}
