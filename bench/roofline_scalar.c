/// @file roofline_scalar.c
/// The roofline's loops for one number at a time.
///
/// SPDX-License-Identifier: MIT
#include <math.h>

#define TABLE bench_roofline_scalar
#define VECTOR float
#define LANES 1
#define LOAD(from) (*(from))
#define STORE(to, value) (*(to) = (value))
#define FILL(value) (value)
#define ADD(a, b) ((a) + (b))
#define MULTIPLY(a, b) ((a) * (b))
#define DIVIDE(a, b) ((a) / (b))
#define SQUARE_ROOT(a) sqrtf(a)

#include "roofline_loops.h"
