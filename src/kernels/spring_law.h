/// @file spring_law.h
/// What a spring does at an extension and a rate of extension: its forces, and their derivatives. Nothing of
/// geometry: lengths and directions are computed otherwise by each user, for the sake of their precision.
///
/// Macros, as the numbers are floats, doubles or vectors: times(a, b) is a product of these. Forces are linear in k
/// and c, which may therefore come with a factor, such as the length of a spring or the scale of a matrix.
/// k: stiffness, N/m; c: damping, N s/m; e: extension, m; rate: of it, m/s.
///
/// Not here, as each has a form of its own against cancellation: differences of energy
/// (solvers/implicit/budget_sums.c, analysis/settle/), what pulls across a spring, and the impulse of a clamped
/// substep (solvers/clamped/clamp.c).
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SPRING_LAW_H
#define MSPRINGI_SPRING_LAW_H

/// A product of plain numbers.
#define MSPRINGI_TIMES(a, b) ((a) * (b))

#define MSPRINGI_LAW_FORCE(times, k, e) times(e, k)
#define MSPRINGI_LAW_DAMPING_FORCE(times, c, rate) times(rate, c)

/// Derivatives of the force by e, and of the damping force by rate.
#define MSPRINGI_LAW_ALONG(k) (k)
#define MSPRINGI_LAW_DAMPING_ALONG(c) (c)

#endif
