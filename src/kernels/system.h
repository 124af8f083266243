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

#include "layout/topology.h"

/// Keeps gcc from writing out a loop over the lanes of a block: four times the code, for nothing that a step
/// notices.
#if defined(__GNUC__) && !defined(__clang__)
#define MSPRINGI_ROLLED _Pragma("GCC unroll 1")
#else
#define MSPRINGI_ROLLED
#endif

/// The factors of a spring, each one value per slot of a record, as in mspringi_part.
typedef enum mspringi_factor {
    MSPRINGI_PULL_X = 0,
    MSPRINGI_PULL_Y = 1,
    MSPRINGI_GEOMETRIC = 2,
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
static inline double mspringi_geometric_fraction(double relative) {
    const double pressed = -1.5 * relative - 0.5;
    const double share = relative > pressed ? relative : pressed;
    const double positive = share > 0.0 ? share : 0.0;
    return positive < 1.0 ? positive : 1.0;
}

/// Fill factors, force and diagonal of one or more rows, all of one kind.
typedef void (*mspringi_assemble_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count);

/// Only leave in the carry row what these rows hand on to the row above, as assembling or multiplying them does.
/// Nothing is taken from the carry row.
typedef void (*mspringi_carry_forces_fn)(const mspringi_system *system, const mspringi_span *spans,
                                           uint32_t count);
typedef void (*mspringi_carry_product_fn)(const mspringi_system *system, const mspringi_span *spans,
                                            uint32_t count, const float *from_x, const float *from_y);

/// Compute to = A from for one or more rows, all of one kind: x and y are (from_x, from_y). Returns from . to of
/// these rows.
typedef float (*mspringi_multiply_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                      const float *from_x, const float *from_y, float *to_x, float *to_y);

/// Slots of a part of a tile.
#define MSPRINGI_PART 8

/// Particles of one tile (see solvers/implicit/tiles.h) among neighbouring slots.
typedef struct mspringi_tile_part {
    uint32_t first_slot; ///< a multiple of MSPRINGI_PART
    uint32_t lanes;      ///< bit i: slot first_slot + i
    uint32_t tile;
} mspringi_tile_part;

/// [lanes][lane] 1 where the bit of the lane is set, else 0.
extern const float mspringi_part_weights[1 << MSPRINGI_PART][MSPRINGI_PART];

/// A sum over slots is one of sums over so many slots each, whoever computes them: the last may be shorter.
#define MSPRINGI_CHUNK 512

/// The vectors of conjugate gradients, arrays by slot. The direction is 0 where d is.
typedef struct mspringi_iterate {
    float *solution_x, *solution_y; ///< d
    float *residual_x, *residual_y; ///< r = b - A d
    float *scaled_x, *scaled_y;     ///< D^-1 r
    float *direction_x, *direction_y;
    float *product_x, *product_y; ///< A direction
    const float *arm_x, *arm_y;   ///< from the mass centre of its tile to each particle
} mspringi_iterate;

/// Add the mass to the blocks on the diagonal and invert them, in place; 0 where there is no mass. Slots first to
/// end - 1, multiples of MSPRINGI_WIDTH, as in what follows.
typedef void (*mspringi_invert_fn)(const mspringi_system *system, size_t first, size_t end);

/// Go on by alpha along the direction, from d = 0 if it is the first advance, and scale the new residual. sums[i]
/// becomes r . D^-1 r of chunk i; first is a multiple of MSPRINGI_CHUNK.
typedef void (*mspringi_advance_fn)(const mspringi_system *system, const mspringi_iterate *iterate, float alpha,
                                    bool is_first, size_t first, size_t end, float *sums);

/// Sum mass, and the moment of inertia about the mass centre, over the parts of a tile.
typedef void (*mspringi_inertia_fn)(const mspringi_iterate *iterate, const float *mass,
                                    const mspringi_tile_part *parts, size_t count, double *to);

/// Sum r over the parts of a tile: in x, in y, and its moment about the mass centre.
typedef void (*mspringi_restrict_fn)(const mspringi_iterate *iterate, const mspringi_tile_part *parts, size_t count,
                                     double *to);

/// What there is to add up in a new direction.
typedef enum mspringi_search_update {
    MSPRINGI_SEARCH_COARSE_ONLY,  ///< the motion of the tiles as rigid bodies
    MSPRINGI_SEARCH_RESTART,  ///< that and D^-1 r
    MSPRINGI_SEARCH_CONTINUE, ///< both and beta times the direction before
    MSPRINGI_SEARCH_UPDATES
} mspringi_search_update;

/// Compute the direction at these parts, which are sorted by slot; slots that are in none of them have none.
typedef void (*mspringi_search_update_fn)(const mspringi_iterate *iterate, const mspringi_tile_part *parts, size_t count,
                                 const double (*bodies)[3], float beta);

/* --------------------------------------------------------------------------------- before and after the system */

/// How a tile flies on as a rigid body: a point in it, its mass centre from there, and the rotation less what h v
/// makes of it.
typedef struct mspringi_tile_motion {
    float origin_x, origin_y, origin_vx, origin_vy;
    float x, y, hvx, hvy, inward, sideways;
} mspringi_tile_motion;

/// The state that a substep begins with, and what is predicted of it: see solvers/implicit/integrator.c.
typedef struct mspringi_prediction {
    const float *x, *y, *vx, *vy, *low_x, *low_y;
    const float *first_x, *first_y; ///< history
    const float *inverse_mass, *mass;
    float h;
    float first_share;          ///< of the history in the velocity
    float rate;                 ///< of velocity, for a displacement
    float *turned_x, *turned_y; ///< of the tile's rotation beyond h v; 0 where there is no tile
    float *arm_x, *arm_y;       ///< from the tile's mass centre to the predicted position
    double *to_x, *to_y;        ///< predicted position
    float *start_vx, *start_vy; ///< velocity if d were 0
} mspringi_prediction;

/// mass = scale / inverse mass, or 0.
typedef void (*mspringi_scale_masses_fn)(const float *inverse_mass, float scale, float *mass, size_t first, size_t end);

/// Find how the tile that has these parts flies on.
typedef void (*mspringi_tile_motion_fn)(const mspringi_prediction *flight, const mspringi_tile_part *parts, size_t count,
                                mspringi_tile_motion *to);

/// Compute turned and arm at these parts, which are sorted by slot.
typedef void (*mspringi_rotate_tiles_fn)(const mspringi_prediction *flight, const mspringi_tile_part *parts, size_t count,
                                const mspringi_tile_motion *tiles);

/// Predict positions, and the velocity if d were 0.
typedef void (*mspringi_predict_fn)(const mspringi_prediction *flight, size_t first, size_t end);

/// What comes on the springs' force, in a coordinate.
typedef struct mspringi_outside {
    const float *mass;
    const float *force;          ///< from outside, N; NULL: none
    const float *velocity;       ///< v*
    const float *turned;         ///< by how much x* is turned on
    const float *first, *second; ///< history of BDF2; second NULL: none
    float force_fraction, velocity_fraction, turned_fraction, first_share, second_share;
    float shift; ///< gravity's
} mspringi_outside;

/// Add it to the springs' force in residual. The whole is 0 where d is.
typedef void (*mspringi_outside_fn)(const mspringi_outside *outside, float *residual, size_t first, size_t end);

/// The end of a substep, in a coordinate.
typedef struct mspringi_correction {
    const double *predicted;
    const float *start; ///< velocity if d were 0
    const float *inverse_mass;
    const float *solution, *direction; ///< d = solution + alpha direction
    const float *low;                  ///< what positions have beyond single precision
    const float *first;                ///< history
    float *position, *velocity;
    float *to_low, *to_first, *to_second; ///< may be the same arrays
    float alpha;
    float h, rate;
} mspringi_correction;

/// The history that is kept.
typedef enum mspringi_history_kind {
    MSPRINGI_HISTORY_NONE,      ///< of implicit Euler
    MSPRINGI_HISTORY_VELOCITY_CHANGE,       ///< of the first step of GA0
    MSPRINGI_HISTORY_ACCELERATION, ///< of GA0
    MSPRINGI_HISTORY_BDF2,         ///< of BDF2
    MSPRINGI_HISTORY_KINDS
} mspringi_history_kind;

typedef void (*mspringi_correct_fn)(const mspringi_correction *landing, size_t first, size_t end);

/* ------------------------------------------------------------------------------------- momenta and energies */

/// Where everything is and how it moves, by slot.
typedef struct mspringi_motion {
    const float *x, *y, *vx, *vy;
    const float *low_x, *low_y; ///< what positions have beyond single precision
    const float *inverse_mass;
} mspringi_motion;

/// Sums over slots, about an origin that has a velocity.
enum {
    MSPRINGI_MOMENT_MASS,    ///< m, kg
    MSPRINGI_MOMENT_X,       ///< m x
    MSPRINGI_MOMENT_Y,       ///< m y
    MSPRINGI_MOMENT_PX,      ///< m vx
    MSPRINGI_MOMENT_PY,      ///< m vy
    MSPRINGI_MOMENT_INERTIA, ///< m (x^2 + y^2)
    MSPRINGI_MOMENT_SPIN,    ///< m (x vy - y vx)
    MSPRINGI_MOMENT_KINETIC, ///< m (vx^2 + vy^2)
    MSPRINGI_MOMENTS
};

/// Sum up the slots first to end - 1, multiples of MSPRINGI_WIDTH. origin is x, y, vx, vy.
typedef void (*mspringi_moments_fn)(const mspringi_motion *motion, size_t first, size_t end, const double *origin,
                                    double *sums);

/// Of the springs of a row's block.
typedef struct mspringi_elastic {
    double energy; ///< J
    double length; ///< k l^2, J: what rounding of lengths goes by
} mspringi_elastic;

/// Compute that for each block, by number, of one or more rows of one kind.
typedef void (*mspringi_elastic_fn)(const mspringi_system *system, const mspringi_motion *motion,
                                    const mspringi_span *spans, uint32_t count, bool is_lattice,
                                    mspringi_elastic *of_block);

/* ------------------------------------------------------------------------------------------ in double precision */

/// Three numbers for each node or edge, xx, xy and yy, one array behind the other.
typedef struct mspringi_blocks_double {
    double *xx, *xy, *yy;
} mspringi_blocks_double;

/// MSPRINGI_WIDTH places of springs: that of lane i, if there is one, joins the slots base + i and tip + i.
typedef struct mspringi_edge_block {
    uint32_t base, tip;
    uint32_t lanes; ///< bit i: there is one
} mspringi_edge_block;

/// Fill in the blocks beside the diagonal, edges beginning at that of lane 0, also where there is no spring; add
/// the springs there are to those on the diagonal. Lanes without spring, too, are read and added to by 0.
typedef void (*mspringi_edges_fn)(const mspringi_edge_block *block, const float *factors,
                                  const mspringi_blocks_double *edges, const mspringi_blocks_double *nodes);

typedef struct mspringi_system_kernels {
    mspringi_scale_masses_fn scale_masses;
    mspringi_tile_motion_fn find_tile_motion;
    mspringi_rotate_tiles_fn rotate_tiles;
    mspringi_predict_fn predict;
    mspringi_assemble_fn assemble_lattice[2], assemble_chain[2]; ///< [with damping]
    mspringi_carry_forces_fn carry_forces[2];                ///< of lattice rows, [with damping]
    mspringi_outside_fn add_outside;
    mspringi_invert_fn invert;
    mspringi_multiply_fn multiply_lattice, multiply_chain;
    mspringi_carry_product_fn carry_product; ///< of lattice rows
    mspringi_advance_fn advance;
    mspringi_inertia_fn inertia_of_tile;
    mspringi_restrict_fn restrict_to_tile;
    mspringi_search_update_fn update_search[MSPRINGI_SEARCH_UPDATES];
    mspringi_correct_fn correct[MSPRINGI_HISTORY_KINDS];
    mspringi_moments_fn moments;
    mspringi_elastic_fn elastic;
    mspringi_edges_fn add_edges;
} mspringi_system_kernels;

#endif
