/// @file roofline_neon.c
/// The roofline's loops for NEON.
///
/// SPDX-License-Identifier: MIT
#include <arm_neon.h>

#define TABLE bench_roofline_neon
#define VECTOR float32x4_t
#define LANES 4
#define LOAD(from) vld1q_f32(from)
#define STORE(to, value) vst1q_f32(to, value)
#define FILL(value) vdupq_n_f32(value)
#define ADD(a, b) vaddq_f32(a, b)
#define MULTIPLY(a, b) vmulq_f32(a, b)
#define DIVIDE(a, b) vdivq_f32(a, b)
#define SQUARE_ROOT(a) vsqrtq_f32(a)

#include "roofline_loops.h"
