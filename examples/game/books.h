/// @file books.h
/// The books of a game: what momentum and energy came from where, and whether it is all there at the end.
///
/// SPDX-License-Identifier: MIT
#ifndef GAME_BOOKS_H
#define GAME_BOOKS_H

#include <massspring/massspring.h>

#include <stdbool.h>

/// What a network has.
typedef struct account {
    double energy;           ///< kinetic, elastic and potential, J
    double momentum[2];      ///< kg m/s
    double angular_momentum; ///< about the world's origin, kg m^2/s
} account;

typedef struct books {
    account last;
    double missing[2];      ///< momentum that the impulses of the steps do not account for, kg m/s
    double through[2];      ///< sum of the impulses' sizes, kg m/s
    double outside, edits;  ///< energy from forces outside and from edits between steps, J
    double ramps;           ///< from springs that were restored, J
    double heat, most_heat; ///< what dampers, the floor and broken springs have taken, J
    double energy_through;  ///< sum of the sizes of what came in and went out, J
    double largest_loss;    ///< farthest that heat came below the most there had been, J
} books;

/// What acted in a step: arrays by particle.
typedef struct books_step {
    uint32_t particles;
    const double *force_x, *force_y;    ///< N, held all through the step
    const double *x, *y;                ///< m, before it
    const double *after_x, *after_y;    ///< m, after it
    const float *mass;                  ///< kg
    const float *impulse_x, *impulse_y; ///< N s, of the floor
    double gravity, dt;
    bool ramps; ///< springs are on their way to their own rest lengths
} books_step;

void books_open(books *opened, const mspring_network *network);

/// Enter what an edit since the last entry has changed.
void books_edit(books *of, const mspring_network *network);

/// Enter a step.
void books_enter(books *of, const mspring_network *network, const books_step *step);

/// Print the books and check that they close: of the momentum that went through, at most this share is missing, and
/// heat never came back by more than this share of the energy.
bool books_close(const books *of, double share);

#endif
