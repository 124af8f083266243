/// @file spec_yield.c
/// Specification of springs that yield: before every fourth substep of a step, the first one included, those that are
/// over 0.7 of their yield strain are warm. Warm ones flow before each substep until the next look, if they are over
/// it: their rest length changes.
///
/// In single precision; springs outside of rows flow by their length in double precision.
///
/// SPDX-License-Identifier: MIT
#include "spec.h"

#include <math.h>

/// Substeps between two looks, and the share of the yield strain above which a spring is warm.
#define PERIOD 4
#define WARM_SHARE 0.7f

/// Squares of the lengths between which a spring stays as it is.
typedef struct bounds {
    float low, high;
} bounds;

// share: of the yield strain. A spring that has shrunk or grown as far as it may stays as it is, and so does one on a
// ramp.
static bounds bounds_of(const spec_spring *s, float share) {
    const float rest = s->rest_length, nominal = s->nominal;
    const float most = nominal * (1.0f + s->plastic_limit), least = nominal * (1.0f - s->plastic_limit);
    const float centre = (1.0f + s->hardening) * rest - s->hardening * nominal;
    const float whole = s->yield_strain * nominal, half = share < 1.0f ? share * whole : whole;
    const float low = centre - half, high = centre + half;
    return (bounds){rest - least > 0.0f && low > 0.0f ? low * low : -1.0f,
                    !(most - rest > 0.0f) ? INFINITY
                    : high > 0.0f         ? high * high
                                          : 0.0f};
}

static bool may_yield(const spec_spring *s) {
    return s->yield_strain < INFINITY && s->rest_length > 0.0f && !(s->ramp.seconds > 0.0);
}

static bool is_outside(bounds b, float square) {
    return square > b.high || b.low > square;
}

static bool is_in_rows(const spec_network *network, uint32_t spring) {
    const spec_sums *sums = &network->sums[network->springs[spring].a];
    bool is_there = false;
    for (uint32_t i = 0; i < SPEC_SIDES; i++) {
        is_there |= sums->rows[i] == spring;
    }
    return is_there;
}

// Squared length by first words.
static float first_square_of(const spec_network *network, const spec_spring *s) {
    const spec_vector a = network->motions[s->a].place, b = network->motions[s->b].place;
    const float x = b.x - a.x, y = b.y - a.y;
    return x * x + y * y;
}

// The new rest length of a spring of a length that is out of bounds.
static float flowed(const spec_spring *s, float square, float length) {
    const float gain = 1.0f / (1.0f + s->hardening), slope = gain * length;
    const float most = s->nominal * (1.0f + s->plastic_limit), least = s->nominal * (1.0f - s->plastic_limit);
    const float grown = slope + ((s->hardening - s->yield_strain) * s->nominal) * gain;
    const float shrunk = slope + ((s->hardening + s->yield_strain) * s->nominal) * gain;
    const float up = grown > most ? most : grown, down = shrunk < least ? least : shrunk;
    const bounds b = bounds_of(s, 1.0f);
    if (b.low > square) {
        return down < s->rest_length ? down : s->rest_length;
    }
    return square > b.high && up > s->rest_length ? up : s->rest_length;
}

void spec_look(spec_network *network, uint32_t substep) {
    for (uint32_t i = 0; i < network->spring_count && substep % PERIOD == 0; i++) {
        spec_spring *s = &network->springs[i];
        const float square = is_in_rows(network, i) ? spec_square_of(network, i) : first_square_of(network, s);
        s->is_warm = may_yield(s) && !s->is_broken && is_outside(bounds_of(s, WARM_SHARE), square);
    }
}

void spec_yield(spec_network *network) {
    for (uint32_t i = 0; i < network->spring_count; i++) {
        spec_spring *s = &network->springs[i];
        if (!s->is_warm || !(s->stiffness > 0.0f)) {
            continue;
        }
        const double x = spec_x_of(network, s->b) - spec_x_of(network, s->a);
        const double y = spec_y_of(network, s->b) - spec_y_of(network, s->a), wide = x * x + y * y;
        const bool is_by_rows = is_in_rows(network, i);
        const float square = is_by_rows ? spec_square_of(network, i) : (float)wide;
        s->rest_length = flowed(s, square, is_by_rows ? sqrtf(square) : (float)sqrt(wide));
    }
}

// Springs outside of rows cut a step where one may yield: at looks, and after each substep while one is warm.
uint32_t spec_free_of_yield(const spec_network *network, uint32_t first, uint32_t count) {
    bool may_any = false, is_any_warm = first == 0;
    for (uint32_t i = 0; i < network->spring_count; i++) {
        const spec_spring *s = &network->springs[i];
        const bounds b = bounds_of(s, WARM_SHARE);
        const bool is_other = !is_in_rows(network, i);
        may_any |= is_other && may_yield(s) && (b.high < INFINITY || b.low >= 0.0f);
        is_any_warm |= is_other && s->is_warm;
    }
    return !may_any ? count - first : is_any_warm ? 1 : PERIOD - first % PERIOD;
}
