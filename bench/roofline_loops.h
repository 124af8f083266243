/// @file roofline_loops.h
/// The loops of roofline_kernels.h, for the vectors that the including file defines: VECTOR, LANES, LOAD, STORE,
/// FILL, ADD, MULTIPLY, DIVIDE, SQUARE_ROOT, and TABLE, the name of the result. Included once by each of these
/// files.
///
/// SPDX-License-Identifier: MIT
#include "roofline_kernels.h"

/// Adds and multiplications in chains of their own, so that no two of them can be fused. The operands come through
/// volatile, or the compiler would know the results.
static void add_mul(uint64_t rounds, float *sink) {
    volatile float small = 1e-3f;
    volatile float one = 1.0f;
    const VECTOR term = FILL(small);
    const VECTOR factor = FILL(one);
    VECTOR a0 = term, a1 = term, a2 = term, a3 = term, a4 = term, a5 = term;
    VECTOR m0 = term, m1 = term, m2 = term, m3 = term, m4 = term, m5 = term;
    for (uint64_t i = 0; i < rounds; i++) {
        a0 = ADD(a0, term);
        m0 = MULTIPLY(m0, factor);
        a1 = ADD(a1, term);
        m1 = MULTIPLY(m1, factor);
        a2 = ADD(a2, term);
        m2 = MULTIPLY(m2, factor);
        a3 = ADD(a3, term);
        m3 = MULTIPLY(m3, factor);
        a4 = ADD(a4, term);
        m4 = MULTIPLY(m4, factor);
        a5 = ADD(a5, term);
        m5 = MULTIPLY(m5, factor);
    }
    VECTOR adds = ADD(ADD(ADD(a0, a1), ADD(a2, a3)), ADD(a4, a5));
    VECTOR products = ADD(ADD(ADD(m0, m1), ADD(m2, m3)), ADD(m4, m5));
    STORE(sink, ADD(adds, products));
}

/// Chains of x = 2 / sqrt(x), which goes to a number whose bits are no special case for a divider.
static void sqrt_div(uint64_t rounds, float *sink) {
    volatile float number = 2.0f;
    const VECTOR two = FILL(number);
    VECTOR x[ROOFLINE_PAIRS];
    for (int k = 0; k < ROOFLINE_PAIRS; k++) {
        x[k] = two;
    }
    for (uint64_t i = 0; i < rounds; i++) {
        for (int k = 0; k < ROOFLINE_PAIRS; k++) {
            x[k] = DIVIDE(two, SQUARE_ROOT(x[k]));
        }
    }
    for (int k = 1; k < ROOFLINE_PAIRS; k++) {
        x[0] = ADD(x[0], x[k]);
    }
    STORE(sink, x[0]);
}

/// Read all, write the state, compute next to nothing.
static void sweep(const float *parameters, float *state, size_t count) {
    for (size_t first = 0; first < count; first += LANES) {
        const float *from = parameters + ROOFLINE_PARAMETERS * first;
        float *to = state + ROOFLINE_STATE * first;
        VECTOR sums[ROOFLINE_STATE];
        for (int k = 0; k < ROOFLINE_STATE; k++) {
            sums[k] = LOAD(to + k * LANES);
        }
        for (int k = 0; k < ROOFLINE_PARAMETERS; k++) {
            sums[k % ROOFLINE_STATE] = ADD(sums[k % ROOFLINE_STATE], LOAD(from + k * LANES));
        }
        for (int k = 0; k < ROOFLINE_STATE; k++) {
            STORE(to + k * LANES, sums[k]);
        }
    }
}

const roofline_kernels TABLE = {.lanes = LANES, .add_mul = add_mul, .sqrt_div = sqrt_div, .sweep = sweep};
