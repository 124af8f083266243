/// @file system.h
/// Linear system of an implicit substep, on the rows of a topology.
///
/// The matrix is A = M + sum over springs of S. For a displacement d of a spring's ends, S exerts
///
///     S (d_tip - d_base) = geometric (d_tip - d_base) + pull (pull . (d_tip - d_base))
///
/// on the base, and the opposite on the tip. pull is along the spring, geometric is the isotropic geometric
/// stiffness from its tension. A spring is stored as these three numbers, not as its 2 x 2 matrix, and so stays
/// positive semidefinite in spite of rounding: with k h^2 / m above 10^7, rounded entries would outweigh the mass.
///
/// SPDX-License-Identifier: MIT
#ifndef MSPRINGI_SYSTEM_H
#define MSPRINGI_SYSTEM_H

#include "layout/topology.h"

/// Keeps gcc from unrolling a loop over the lanes of a block: four times the code without a measurable gain.
#if defined(__GNUC__) && !defined(__clang__)
#define MSPRINGI_ROLLED _Pragma("GCC unroll 1")
#else
#define MSPRINGI_ROLLED
#endif

/// Factors of a spring, each one value per slot of a record, as in mspringi_part.
typedef enum mspringi_factor {
    MSPRINGI_PULL_X = 0,
    MSPRINGI_PULL_Y = 1,
    MSPRINGI_GEOMETRIC = 2,
    MSPRINGI_FACTORS = 3
} mspringi_factor;

/// State at which the springs are linearised, and the linearised system. Arrays by slot.
typedef struct mspringi_system {
    const double *x, *y;  ///< positions
    const float *vx, *vy; ///< velocities for the dampers
    double force_scale;   ///< factor on the springs' stiffness and damping
    double damping_rate;  ///< 1/s, weight of a damping in the matrix relative to a stiffness
    uint32_t parts;       ///< number of parts in a spring's record
    const float *lattice_springs, *rest_lengths, *chain_springs; ///< as in mspringi_sweep
    const uint32_t *rests_of_block;                              ///< as in mspringi_sweep
    const float *mass;                                           ///< scaled; 0 without a particle
    float *lattice_factors;                                      ///< [block][direction][factor][lane]
    float *chain_factors;                                        ///< [block][factor][lane]
    float *force_x, *force_y;                                    ///< forces of the springs, scaled
    float *xx, *xy, *yy;                                         ///< 2 x 2 diagonal blocks of A, without the mass
    double *force_carry_x; ///< carry row from the row below, by column; all 0 outside a pass over rows
    double *force_carry_y;
    float *carry_xx, *carry_xy, *carry_yy; ///< carry rows; xx and xy also serve the product
} mspringi_system;

/// Rest lengths of a lattice block, [direction][lane].
static inline const float *mspringi_system_rests(const mspringi_system *system, size_t block) {
    return system->rest_lengths + (size_t)system->rests_of_block[block] * MSPRINGI_DIRECTIONS * MSPRINGI_WIDTH;
}

/// Geometric stiffness of a spring, relative to the stiffness along it. relative: extension over length.
///
/// For a stretched spring it is that of the potential's second derivative. A compressed one has a negative value
/// there, which would make A indefinite, so it gets 0. A spring compressed to less than three quarters, which may
/// buckle to either side, gradually becomes stiff in all directions. Then the quadratic model is above the
/// potential wherever its ends go, so no step ends with more energy than it started with.
static inline double mspringi_geometric_fraction(double relative) {
    const double pressed = -1.5 * relative - 0.5;
    const double share = relative > pressed ? relative : pressed;
    const double positive = share > 0.0 ? share : 0.0;
    return positive < 1.0 ? positive : 1.0;
}

/// Fill factors, forces and diagonal for one or more rows of one kind.
typedef void (*mspringi_assemble_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count);

/// Only compute the carry row, as assembly or product would leave it for the row above. Its old values are ignored.
typedef void (*mspringi_carry_forces_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count);
typedef void (*mspringi_carry_product_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                          const float *from_x, const float *from_y);

/// Compute to = A from for one or more rows of one kind, with from = (from_x, from_y). Returns from . to of these
/// rows.
typedef float (*mspringi_multiply_fn)(const mspringi_system *system, const mspringi_span *spans, uint32_t count,
                                      const float *from_x, const float *from_y, float *to_x, float *to_y);

/// Number of slots of a part of a tile.
#define MSPRINGI_PART 8

/// Particles of one tile (see solvers/implicit/tiles.h) among MSPRINGI_PART neighbouring slots.
typedef struct mspringi_tile_part {
    uint32_t first_slot; ///< a multiple of MSPRINGI_PART
    uint32_t lanes;      ///< bit i: slot first_slot + i
    uint32_t tile;
} mspringi_tile_part;

/// [lanes][lane] 1 if the lane's bit is set, else 0.
extern const float mspringi_part_weights[1 << MSPRINGI_PART][MSPRINGI_PART];

/// Slots of a partial sum. Sums over slots add one for each chunk, whichever worker computes it; the last chunk may
/// be shorter.
#define MSPRINGI_CHUNK 512

/// Vectors of conjugate gradients, arrays by slot. The direction is 0 where d is.
typedef struct mspringi_iterate {
    float *solution_x, *solution_y; ///< d
    float *residual_x, *residual_y; ///< r = b - A d
    float *scaled_x, *scaled_y;     ///< D^-1 r
    float *direction_x, *direction_y;
    float *product_x, *product_y; ///< A direction
    const float *arm_x, *arm_y;   ///< from the tile's centre of mass to each particle
} mspringi_iterate;

/// Add the mass to the diagonal blocks and invert them, in place; 0 without mass. Slots first to end - 1, multiples
/// of MSPRINGI_WIDTH, here and below.
typedef void (*mspringi_invert_fn)(const mspringi_system *system, size_t first, size_t end);

/// Advance d by alpha along the direction, from d = 0 in the first call, and scale the new residual. sums[i]
/// becomes r . D^-1 r of chunk i; first is a multiple of MSPRINGI_CHUNK.
typedef void (*mspringi_advance_fn)(const mspringi_system *system, const mspringi_iterate *iterate, float alpha,
                                    bool is_first, size_t first, size_t end, float *sums);

/// Sum the mass, and the moment of inertia about the centre of mass, over the parts of a tile.
typedef void (*mspringi_inertia_fn)(const mspringi_iterate *iterate, const float *mass,
                                    const mspringi_tile_part *parts, size_t count, double *to);

/// Sum r over the parts of a tile: in x, in y, and its moment about the centre of mass.
typedef void (*mspringi_restrict_fn)(const mspringi_iterate *iterate, const mspringi_tile_part *parts, size_t count,
                                     double *to);

/// Terms of a new search direction.
typedef enum mspringi_search_update {
    MSPRINGI_SEARCH_COARSE_ONLY, ///< rigid motion of the tiles
    MSPRINGI_SEARCH_RESTART,     ///< that, and D^-1 r
    MSPRINGI_SEARCH_CONTINUE,    ///< both, and beta times the last direction
    MSPRINGI_SEARCH_UPDATES
} mspringi_search_update;

/// Compute the direction in these parts, sorted by slot. Slots outside of all parts have none.
typedef void (*mspringi_search_update_fn)(const mspringi_iterate *iterate, const mspringi_tile_part *parts,
                                          size_t count, const double (*bodies)[3], float beta);

/* --------------------------------------------------------------------------------- before and after the system */

/// Rigid motion of a tile: origin is a point in it. The centre of mass is relative to that, and the rotation
/// excludes h v.
typedef struct mspringi_tile_motion {
    float origin_x, origin_y, origin_vx, origin_vy;
    float x, y, hvx, hvy, inward, sideways;
} mspringi_tile_motion;

/// State before a substep, and its prediction: see solvers/implicit/integrator.c.
typedef struct mspringi_prediction {
    const float *x, *y, *vx, *vy, *low_x, *low_y;
    const float *first_x, *first_y; ///< history
    const float *inverse_mass, *mass;
    float h;
    float first_share;          ///< weight of the history in the velocity
    float rate;                 ///< velocity for a displacement, 1/s
    float *turned_x, *turned_y; ///< displacement by the tile's rotation beyond h v; 0 without a tile
    float *arm_x, *arm_y;       ///< from the tile's centre of mass to the predicted position
    double *to_x, *to_y;        ///< predicted position
    float *start_vx, *start_vy; ///< velocity for d = 0
} mspringi_prediction;

/// mass = scale / inverse mass, or 0.
typedef void (*mspringi_scale_masses_fn)(const float *inverse_mass, float scale, float *mass, size_t first,
                                         size_t end);

/// Find the rigid motion of the tile with these parts.
typedef void (*mspringi_tile_motion_fn)(const mspringi_prediction *flight, const mspringi_tile_part *parts,
                                        size_t count, mspringi_tile_motion *to);

/// Compute turned and arm in these parts, sorted by slot.
typedef void (*mspringi_rotate_tiles_fn)(const mspringi_prediction *flight, const mspringi_tile_part *parts,
                                         size_t count, const mspringi_tile_motion *tiles);

/// Predict positions, and the velocity for d = 0.
typedef void (*mspringi_predict_fn)(const mspringi_prediction *flight, size_t first, size_t end);

/// Residual besides the springs' forces, one coordinate.
typedef struct mspringi_outside {
    const float *mass;
    const float *force;          ///< external, N; NULL: none
    const float *velocity;       ///< v*
    const float *turned;         ///< displacement of x* by rotation
    const float *first, *second; ///< history, the second for BDF2; second NULL: none
    float force_fraction, velocity_fraction, turned_fraction, first_share, second_share;
    float shift; ///< from gravity
} mspringi_outside;

/// Add it to the springs' forces in residual. The sum is 0 where d is.
typedef void (*mspringi_outside_fn)(const mspringi_outside *outside, float *residual, size_t first, size_t end);

/// Correction at the end of a substep, one coordinate.
typedef struct mspringi_correction {
    const double *predicted;
    const float *inverse_mass;
    const float *solution, *direction; ///< d = solution + alpha direction
    const float *low;                  ///< low words of the positions
    const float *first;                ///< history
    float *position, *velocity;
    float *low_velocity;                  ///< low words of the velocities; NULL: none
    float *to_low, *to_first, *to_second; ///< may alias the arrays read
    float alpha;
    float h;
    float first_share, rate; ///< as in the prediction
    float grid;              ///< as in a mspringi_sweep; 0: none
} mspringi_correction;

/// History for the next substep.
typedef enum mspringi_history_kind {
    MSPRINGI_HISTORY_NONE,            ///< implicit Euler
    MSPRINGI_HISTORY_VELOCITY_CHANGE, ///< first step of GA0
    MSPRINGI_HISTORY_ACCELERATION,    ///< GA0
    MSPRINGI_HISTORY_BDF2,            ///< BDF2
    MSPRINGI_HISTORY_KINDS
} mspringi_history_kind;

typedef void (*mspringi_correct_fn)(const mspringi_correction *landing, size_t first, size_t end);

/* ------------------------------------------------------------------------------------- momenta and energies */

/// Positions, velocities and masses by slot.
typedef struct mspringi_motion {
    const float *x, *y, *vx, *vy;
    const float *low_x, *low_y;   ///< low words of the positions
    const float *low_vx, *low_vy; ///< of the velocities; NULL: none
    const float *inverse_mass;
} mspringi_motion;

/// Sums over slots, relative to an origin with a velocity.
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

/// Sum over the slots first to end - 1, multiples of MSPRINGI_WIDTH. origin is x, y, vx, vy.
typedef void (*mspringi_moments_fn)(const mspringi_motion *motion, size_t first, size_t end, const double *origin,
                                    double *sums);

/// Sums over the springs of a row's block.
typedef struct mspringi_elastic {
    double energy; ///< J
    double length; ///< k l^2, J: scale of the rounding of lengths
} mspringi_elastic;

/// Compute the sums for each block, by number, of one or more rows of one kind.
typedef void (*mspringi_elastic_fn)(const mspringi_system *system, const mspringi_motion *motion,
                                    const mspringi_span *spans, uint32_t count, bool is_lattice,
                                    mspringi_elastic *of_block);

/* --------------------------------------------------------------------------------------------- double precision */

/// Three values for each node or edge: xx, xy and yy, one array after another.
typedef struct mspringi_blocks_double {
    double *xx, *xy, *yy;
} mspringi_blocks_double;

/// MSPRINGI_WIDTH spring slots. The spring of lane i, if any, connects the slots base + i and tip + i.
typedef struct mspringi_edge_block {
    uint32_t base, tip;
    uint32_t lanes; ///< bit i: lane i has a spring
} mspringi_edge_block;

/// Fill the off-diagonal blocks, edges from that of lane 0 on, also without a spring; add the springs to the
/// diagonal blocks. Lanes without a spring are read, and add 0.
typedef void (*mspringi_edges_fn)(const mspringi_edge_block *block, const float *factors,
                                  const mspringi_blocks_double *edges, const mspringi_blocks_double *nodes);

typedef struct mspringi_system_kernels {
    mspringi_scale_masses_fn scale_masses;
    mspringi_tile_motion_fn find_tile_motion;
    mspringi_rotate_tiles_fn rotate_tiles;
    mspringi_predict_fn predict;
    mspringi_assemble_fn assemble_lattice[2], assemble_chain[2]; ///< [with damping]
    mspringi_carry_forces_fn carry_forces[2];                    ///< of lattice rows, [with damping]
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
