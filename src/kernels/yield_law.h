/// @file yield_law.h
/// Law of plastic springs in single precision, as in the kernels: see features/yield/plastic.h. The rest length r
/// of a spring of length L after flow is
///
///     stretched    r = (L + (H - y) r0) / (1 + H),  at most   (1 + P) r0
///     compressed   r = (L + (H + y) r0) / (1 + H),  at least  (1 - P) r0
///
/// so 1 / (1 + H) replaces the division. yield_sweep.h does the same in vectors, in the same order.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_YIELD_LAW_H
#define MSPRINGI_YIELD_LAW_H

#include <math.h>
#include <stdbool.h>

/// Fraction of the yield strain above which a spring is warm, so that its strip is tested in each substep.
#define MSPRINGI_WARM_SHARE 0.7f

/// Yield parameters of a spring.
typedef struct mspringi_yield_values {
    float nominal, yield_strain, hardening, plastic_limit;
    float gain; ///< 1 / (1 + hardening)
} mspringi_yield_values;

/// Squared lengths. Between low and high a spring is cold; between flow_low and flow_high it does not flow.
typedef struct mspringi_yield_bounds {
    float low, high, flow_low, flow_high;
} mspringi_yield_bounds;

/// Rest length after the return to the yield surface; rest if the spring does not flow.
static inline float mspringi_yield_rest(mspringi_yield_values v, mspringi_yield_bounds bounds, float square,
                                        float length, float rest) {
    const float slope = v.gain * length;
    const float most = v.nominal * (1.0f + v.plastic_limit), least = v.nominal * (1.0f - v.plastic_limit);
    float up = slope + ((v.hardening - v.yield_strain) * v.nominal) * v.gain;
    float down = slope + ((v.hardening + v.yield_strain) * v.nominal) * v.gain;
    up = up - most > 0.0f ? most : up;
    down = least - down > 0.0f ? least : down;
    if (bounds.flow_low - square > 0.0f)
        return rest - down > 0.0f ? down : rest;
    return square - bounds.flow_high > 0.0f && up - rest > 0.0f ? up : rest;
}

/// Length of a spring at the start of a substep that moved its ends by (way_x, way_y) relative to each other, to
/// (dx, dy). `square` is the squared length at the end; it may be more precise than these.
static inline float mspringi_yield_start(float square, float dx, float dy, float way_x, float way_y) {
    const float before = square - (way_x * ((dx + dx) - way_x) + way_y * ((dy + dy) - way_y));
    return sqrtf(before > 0.0f ? before : 0.0f);
}

/// Heat from a change of the rest length, J: the flow times the mean force before and after it, without back
/// stress. The force before belongs to `start`, the length at which the spring last acted on its particles: the
/// part of the substep beyond the yield surface has not acted yet. Solvers in which it has acted pass the present
/// length.
static inline float mspringi_yield_heat(mspringi_yield_values v, float stiffness, float start, float length,
                                        float rest, float to) {
    const float moved = to - rest, whole = 1.0f + v.hardening;
    const float excess = (0.5f * (start + length) + v.hardening * v.nominal) - whole * rest;
    return stiffness * (moved * (excess - (0.5f * whole) * moved));
}

/// Bounds of a spring with this rest length.
static inline mspringi_yield_bounds mspringi_yield_bounds_of(mspringi_yield_values v, float rest) {
    const float most = v.nominal * (1.0f + v.plastic_limit), least = v.nominal * (1.0f - v.plastic_limit);
    const float centre = (1.0f + v.hardening) * rest - v.hardening * v.nominal;
    const float half = v.yield_strain * v.nominal, warm = MSPRINGI_WARM_SHARE * half;
    const float low = centre - warm, high = centre + warm, flow_low = centre - half, flow_high = centre + half;
    const bool shrinks = rest - least > 0.0f, grows = most - rest > 0.0f;
    return (mspringi_yield_bounds){.low = shrinks && low > 0.0f ? low * low : -1.0f,
                                   .high = !grows        ? INFINITY
                                           : high > 0.0f ? high * high
                                                         : 0.0f,
                                   .flow_low = shrinks && flow_low > 0.0f ? flow_low * flow_low : -1.0f,
                                   .flow_high = !grows             ? INFINITY
                                                : flow_high > 0.0f ? flow_high * flow_high
                                                                   : 0.0f};
}

#endif
