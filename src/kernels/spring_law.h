/// @file spring_law.h
/// Law of springs: forces and their derivatives by extension and rate of extension. Without geometry: users compute
/// lengths and directions in their own ways, for precision.
///
/// Macros, as the values are floats, doubles or vectors: times(a, b) is their product. Forces are linear in k and
/// c, which may include a factor, such as the length of a spring or the scale of a matrix. k: stiffness, N/m; c:
/// damping, N s/m; e: extension, m; rate: of e, m/s.
///
/// Three forms live elsewhere, each written to avoid cancellation: differences of energy
/// (solvers/implicit/budget_sums.c, analysis/settle/), forces across a spring, and the impulse of a clamped substep
/// (solvers/clamped/clamp.c).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SPRING_LAW_H
#define MSPRINGI_SPRING_LAW_H

/// Product of scalars.
#define MSPRINGI_TIMES(a, b) ((a) * (b))

#define MSPRINGI_LAW_FORCE(times, k, e) times(e, k)
#define MSPRINGI_LAW_DAMPING_FORCE(times, c, rate) times(rate, c)

/// Derivatives of the force by e, and of the damping force by rate.
#define MSPRINGI_LAW_ALONG(k) (k)
#define MSPRINGI_LAW_DAMPING_ALONG(c) (c)

#endif
