/// @file system.h
/// The linear system of an implicit substep, on the rows of a topology.
///
/// The matrix is A = M + sum over springs of S, where a spring's share of its two ends' displacement d is
///
///     S (d_tip - d_base) = swing (d_tip - d_base) + pull (pull . (d_tip - d_base))
///
/// on the base, and the opposite on the tip: pull points along the spring, swing is what tension adds in every
/// direction. Kept as these three numbers, and not as the entries of the 2 x 2 matrix they make, a spring stays
/// positive semidefinite whatever the rounding: with k h^2 / m beyond 10^7, rounded entries would outweigh the
/// mass.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_H
#define MSPRINGI_SYSTEM_H

#include "topology/topology.h"

/// The factors of a spring, each one value per slot of a record, as in mspringi_part.
typedef enum mspringi_factor {
    MSPRINGI_PULL_X = 0,
    MSPRINGI_PULL_Y = 1,
    MSPRINGI_SWING = 2,
    MSPRINGI_FACTORS = 3
} mspringi_factor;

/// Where and how the springs are linearised, and what comes of it. Arrays by slot.
typedef struct mspringi_system {
    const double *x, *y;  ///< positions
    const float *vx, *vy; ///< velocities that the dampers feel
    double force_scale;   ///< what springs' stiffness and damping are multiplied with
    double damping_rate;  ///< 1/s, what a damper counts in the matrix beside a spring
    uint32_t parts;       ///< in a spring's record
    const float *lattice_springs, *rest_lengths, *chain_springs; ///< as in mspringi_sweep
    const uint32_t *rests_of_block;                              ///< as in mspringi_sweep
    const float *mass;                                           ///< scaled; 0 where there is no particle
    float *lattice_factors;                                      ///< [block][direction][factor][lane]
    float *chain_factors;                                        ///< [block][factor][lane]
    float *force_x, *force_y;                                    ///< of the springs, scaled
    float *xx, *xy, *yy;   ///< the 2 x 2 blocks on the diagonal of A, without the mass
    double *force_carry_x; ///< what the row below hands on, by column; all of them 0 between rows' ends
    double *force_carry_y;
    float *carry_xx, *carry_xy, *carry_yy; ///< likewise; xx and xy serve the product as well
} mspringi_system;

/// Rest lengths of a lattice block, [direction][lane].
static inline const float *mspringi_system_rests(const mspringi_system *system, size_t block) {
    return system->rest_lengths + (size_t)system->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
}

/// What a spring's stiffness across its direction is, as a share of that along it, if its extension is this share
/// of its length. When tense, that of its potential's second derivative. That of a compressed spring is negative,
/// which would make A indefinite: 0, then. A spring pressed to less than three quarters, which has more than one
/// side to escape to, goes over to stiffness in all directions: the quadratic model is above the potential then
/// wherever its ends go, so no step overshoots into more energy than there was.
static inline double mspringi_swing_share(double relative) {
    const double pressed = -1.5 * relative - 0.5;
    const double share = relative > pressed ? relative : pressed;
    const double positive = share > 0.0 ? share : 0.0;
    return positive < 1.0 ? positive : 1.0;
}

/// Fill factors, force and diagonal of one or more rows, all of one kind.
typedef void (*mspringi_assemble_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count);

/// Compute to = A from for one or more rows, all of one kind: x and y are (from_x, from_y).
typedef void (*mspringi_multiply_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                     const float *from_x, const float *from_y, float *to_x, float *to_y);

/// Slots of a part of a tile.
#define MSPRINGI_PART 8

/// Particles of one tile (see implicit/tiles.h) among neighbouring slots.
typedef struct mspringi_tile_part {
    uint32_t first_slot; ///< a multiple of MSPRINGI_PART
    uint32_t lanes;      ///< bit i: slot first_slot + i
} mspringi_tile_part;

/// The vectors of conjugate gradients, arrays by slot. The direction is 0 where d is.
typedef struct mspringi_iterate {
    size_t slots;
    float *solution_x, *solution_y; ///< d
    float *residual_x, *residual_y; ///< r = b - A d
    float *scaled_x, *scaled_y;     ///< D^-1 r
    float *direction_x, *direction_y;
    float *product_x, *product_y; ///< A direction
    const float *arm_x, *arm_y;   ///< from the mass centre of its tile to each particle
} mspringi_iterate;

/// Go on by alpha along the direction, and scale the new residual. Returns r . D^-1 r.
typedef float (*mspringi_advance_fn)(const mspringi_system *system, const mspringi_iterate *iterate, float alpha);

/// Returns a . b, for vectors of two coordinates.
typedef float (*mspringi_dot_fn)(size_t slots, const float *ax, const float *ay, const float *bx, const float *by);

/// Sum r over the parts of a tile: in x, in y, and its moment about the mass centre.
typedef void (*mspringi_restrict_fn)(const mspringi_iterate *iterate, const mspringi_tile_part *parts, size_t count,
                                     double *to);

/// On the parts of a tile, direction = D^-1 r + the motion of a rigid body + beta direction.
typedef void (*mspringi_turn_fn)(const mspringi_iterate *iterate, const mspringi_tile_part *parts, size_t count,
                                 const double *body, float beta);

/// The state that a substep begins with, and what rotating tiles make of it: see implicit/scheme.c.
typedef struct mspringi_flight {
    const float *x, *y, *vx, *vy, *mass;
    float h;
    float *turned_x, *turned_y; ///< of the tile's rotation beyond h v
    float *arm_x, *arm_y;       ///< from the tile's mass centre to the predicted position
} mspringi_flight;

/// Predict the rotation of the tile that has these parts.
typedef void (*mspringi_fly_fn)(const mspringi_flight *flight, const mspringi_tile_part *parts, size_t count);

typedef struct mspringi_system_kernels {
    mspringi_assemble_fn assemble_lattice[2], assemble_chain[2]; ///< [with damping]
    mspringi_multiply_fn multiply_lattice, multiply_chain;
    mspringi_advance_fn advance;
    mspringi_dot_fn dot;
    mspringi_restrict_fn restrict_to_tile;
    mspringi_turn_fn turn_tile;
    mspringi_fly_fn fly_tile;
} mspringi_system_kernels;

#endif
